"""Commands that measure the cell with the arm: frames from three points, tools from touches of one tip."""

from typing import TYPE_CHECKING

from robolang.pendant.command import Command, Group, Offer
from robolang.pendant.failure import failure
from robolang.pendant.numbers import pose_text
from robolang.pendant.output import Column, Table
from robolang.pendant.words import misused, without_flag

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant
    from robolang.teaching.touches import Touch
    from runtime.dynamics.payload_identification import WeighedPayload

_FRAME = "teachframe NAME ORIGIN ON_X ON_XY [--yes]"
_WEIGH = "weigh [NAME]"
_TOOL = "teachtool NAME P1 P2 P3 [P4 ...] [--yes]"


def _teachframe(pendant: "Pendant", rest: str) -> None:
    from robolang.teaching.cell_document import set_frame
    from robolang.teaching.frames import frame_of
    from robolang.teaching.postures import taught_place
    from robolang.teaching.touches import Touch

    rest, yes = without_flag(rest, "--yes")
    words = rest.split()
    if len(words) != 4:
        raise misused(_FRAME, f"the name of a frame and three points are expected, found '{rest}'")
    live = pendant.live
    points = [pendant.point(word) for word in words[1:]]
    origin, on_x, on_xy = (Touch(name=point.name, X=taught_place(point, live.around)) for point in points)
    pose = frame_of(origin, on_x, on_xy)
    pendant.output.line(f"{words[0]}: {pose_text(pose)}")
    _refuse_taken(pendant, "frame", words[0], yes)
    pendant.change(set_frame(pendant.desk.documents, words[0], pose), f"frame {words[0]}")


def _teachtool(pendant: "Pendant", rest: str) -> None:
    from robolang.execution import lowering
    from robolang.teaching.cell_document import set_tool
    from robolang.teaching.tools import tool_tip

    rest, yes = without_flag(rest, "--yes")
    words = rest.split()
    if len(words) < 2:
        raise misused(_TOOL, f"the name of a tool and its touches are expected, found '{rest}'")
    name = words[0]
    touches = _touches(pendant, words[1:])
    found = tool_tip(touches)
    cell = pendant.project.cell
    # the tip has no orientation: that of the tool of this name stays, else that of the hand's own
    X = next((X for key, X in cell.tools.items() if key.upper() == name.upper()), cell.hand.X_flange_tool)
    # nothing is written before the numbers have been shown: a bad touch is seen by its residual
    pose = (*found.tip, *lowering.six_of(X)[3:])
    pendant.output.line(f"{name}: {pose_text(pose)}")
    rows = tuple((touch.name, f"{each:.3f}") for touch, each in zip(touches, found.residuals, strict=True))
    columns = (Column(heading="touch"), Column(heading="residual", unit="mm", number=True))
    pendant.output.table(Table(columns=columns, rows=rows))
    pendant.output.line(
        f"residual {found.rms:.3f} mm (root mean square), {found.worst:.3f} mm at most; the tip is known to "
        f"{found.uncertainty:.3f} mm"
    )
    _refuse_taken(pendant, "tool", name, yes)
    pendant.change(set_tool(pendant.desk.documents, name, pose), f"tool {name}")


def _touches(pendant: "Pendant", names: list[str]) -> "list[Touch]":
    """Return where the flange stood at each point."""
    from robolang.teaching.postures import reached_point
    from robolang.teaching.touches import Touch

    live = pendant.live
    found = []
    for name in names:
        point = pendant.point(name)
        # by the joints: a pose is one of the tool, which is what is to be measured
        q = reached_point(point, live.around, live.q)
        found.append(Touch(name=point.name, X=live.controller.kinematics.forward(q)))
    return found


def _weigh(pendant: "Pendant", rest: str) -> None:
    from robolang.teaching.cell_document import set_load
    from robolang.teaching.weighing import weigh_plan, weigh_result

    if len(rest.split()) > 1:
        raise misused(_WEIGH, f"found '{rest}'")
    if rest:
        # a name that cannot be is refused before the arm moves
        set_load(pendant.desk.documents, rest, 0.0, (0.0, 0.0, 0.0))
    live = pendant.live
    live.refuse_latched()
    pendant.to_manual()
    plan = weigh_plan(live.controller)
    pendant.output.line(f"the arm swings about its posture for {plan.seconds:.1f} s; keep 200 mm free")
    rows = live.weigh(plan.rows)
    if rows is None:
        raise failure("RBL809", "the motion was stopped before its end, and nothing is known of the payload")
    result = weigh_result(plan, rows, physics=pendant.choice.physics)
    found, load = result.found, result.load
    if load.text is None:
        raise failure(load.code, load.note)
    pendant.output.line(f"{load.text}    (+- {found.mass_sd:.3f} kg)")
    if load.note:
        pendant.output.line(f"  note: {load.note}")
    # declared at once: from here on the servo knows what it carries
    pendant.carry_out(load.text)
    if rest:
        _write_load(pendant, rest, found)


def _write_load(pendant: "Pendant", name: str, found: "WeighedPayload") -> None:
    from robolang.teaching.cell_document import set_load
    from runtime.core.units import MM

    cog = (0.0, 0.0, 0.0) if found.cog is None else tuple(float(value) / MM for value in found.cog)
    pendant.change(set_load(pendant.desk.documents, name, found.mass, cog), f"load {name}")
    pendant.output.line(f"LOAD {name} is in the cell file")


def _refuse_taken(pendant: "Pendant", what: str, name: str, yes: bool) -> None:
    cell = pendant.project.cell
    known = cell.frames if what == "frame" else cell.tools
    if any(key.upper() == name.upper() for key in known):
        pendant.confirm(f"Replace the {what} {name}?", yes)


COMMANDS = (
    Command(
        word="teachframe",
        form=_FRAME,
        help="Measure a frame from three points: its origin, one on X, one beside it.",
        group=Group.TEACH,
        do=_teachframe,
        offers=(Offer.FRAME, Offer.POINT),
        words=("--yes",),
        more="The frame is written into the cell file. The third point lies on the side of +Y.",
    ),
    Command(
        word="teachtool",
        form=_TOOL,
        help="Measure the tip of a tool from four touches of one fixed tip.",
        group=Group.TEACH,
        do=_teachtool,
        offers=(Offer.TOOL, Offer.POINT),
        words=("--yes",),
        more="Touch the tip with the flange tilted to different sides, by 30 deg or more. The orientation of the tool\n"
        "is not measured: it stays, and that of a new tool is the one of the hand.",
    ),
    Command(
        word="weigh",
        form=_WEIGH,
        help="Weigh what the arm carries by a short motion, and declare it by LOAD.",
        group=Group.TEACH,
        do=_weigh,
        offers=(Offer.LOAD,),
        more="Keep 200 mm free about the arm and its load: it swings about its posture. With a name the load is\n"
        "written into the cell file too, for LOAD NAME.",
    ),
)
