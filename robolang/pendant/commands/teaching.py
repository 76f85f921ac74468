"""Commands that teach: points from where the arm stands, changed, copied, renamed, and the table of them."""

from typing import TYPE_CHECKING, cast

from robolang.analysis.named_lines import name_of
from robolang.pendant.command import Command, Group, Offer
from robolang.pendant.failure import failure
from robolang.pendant.output import Column, Table
from robolang.pendant.words import misused, nothing, without_flag

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant
    from robolang.project.points import Point
    from robolang.teaching.taught import Kind, Taught

_TEACH, _TOUCHUP = "teach NAME [joints|pose] [--yes]", "touchup NAME [--yes]"
_GO, _COPY, _RENAME = "go NAME [straight]", "copy NAME NEW [+ (x, y, z)]", "rename NAME NEW"


def _teach(pendant: "Pendant", rest: str) -> None:
    rest, yes = without_flag(rest, "--yes")
    words = rest.split()
    if not 1 <= len(words) <= 2 or words[1:] not in ([], ["joints"], ["pose"]):
        raise misused(_TEACH, f"a name is expected, found '{rest}'")
    kind = cast("Kind | None", words[1] if len(words) == 2 else None)
    _take(pendant, words[0], kind, yes)


def _touchup(pendant: "Pendant", rest: str) -> None:
    rest, yes = without_flag(rest, "--yes")
    if len(rest.split()) != 1:
        raise misused(_TOUCHUP, f"the name of a point is expected, found '{rest}'")
    # a slip of the name must not make a new point: teach does that
    pendant.point(rest)
    _take(pendant, rest, None, yes)


def _take(pendant: "Pendant", name: str, kind: "Kind | None", yes: bool) -> None:
    """Teach a point where the arm stands; one that is taught already only after its change has been shown."""
    from robolang.teaching.points_document import set_point
    from robolang.teaching.taught import taught_point

    live = pendant.live
    old = live.project.points.get(name)
    taught = taught_point(name, kind, live.q, live.around, frame=live.executor.frame, old=old)
    # shown before it is asked: once it is replaced, where the old point was is gone
    if old is not None:
        taught = _spelled(taught, old.name)
        _show_change(pendant, old, taught.point)
        pendant.confirm(f"Replace {old.name}?", yes)
    new = set_point(pendant.desk.documents, taught.point, live.project.cell.robot.name)
    pendant.change(new, f"{'teach' if old is None else 'touch up'} {taught.point.name}")
    pendant.output.line(_described(taught.point))
    for note in taught.notes:
        pendant.output.line(f"  note: {note}")


def _spelled(taught: "Taught", name: str) -> "Taught":
    from dataclasses import replace

    return replace(taught, point=taught.point.replaced(name=name))


def _described(point: "Point") -> str:
    """Return a point as one line: its kind and values, and under which tool and frame it was taught."""
    values = ", ".join(f"{value:g}" for value in point.pose or point.joints or ())
    parts = [f"{point.name} = {'JOINT' if point.pose is None else 'POSE'}({values})"]
    if point.pose is not None:
        parts.append(f"frame {point.frame or 'WORLD'}, tool {point.tool or 'of the hand'}")
    if point.configuration:
        parts.append(" ".join(point.configuration))
    return "  ".join(parts)


def _show_change(pendant: "Pendant", old: "Point", new: "Point") -> None:
    from robolang.teaching.touch_up import change

    live = pendant.live
    found = change(old, new, live.q, live.around)
    names = ("dX", "dY", "dZ", "dRX", "dRY", "dRZ")
    units = ("mm",) * 3 + ("deg",) * 3
    columns = tuple(Column(heading=name, unit=unit, number=True) for name, unit in zip(names, units, strict=True))
    rows = (tuple(f"{round(value, 3) + 0.0:.3f}" for value in found.by),)
    pendant.output.line(
        f"{old.name} in the frame {found.frame or 'WORLD'}: {found.distance:.3f} mm, {found.angle:.3f} deg"
    )
    pendant.output.table(Table(columns=columns, rows=rows))
    # a small move of the tool may be a large one of the joints, near a singularity or by another configuration
    if found.joints is not None:
        joints = "  ".join(f"J{i + 1} {round(value, 3) + 0.0:+.3f}" for i, value in enumerate(found.joints))
        pendant.output.line(f"joints, deg: {joints}")
    for before, after in found.configuration:
        pendant.output.line(f"the configuration changes: {before} to {after}")
    if found.unreached is not None:
        pendant.output.line(f"the old point is not reached: {found.unreached.code} {found.unreached.message}")


def _points(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "points")
    from robolang.teaching.point_table import point_table

    live = pendant.live
    program = pendant.desk.analysis.program
    found = point_table(live.around, live.q, pendant.desk.analysis)
    if not found:
        pendant.output.line("no point is taught")
        return
    columns = (
        Column(heading="point"),
        Column(heading="kind"),
        Column(heading="frame"),
        Column(heading="tool"),
        Column(heading="configuration"),
        Column(heading="to the limit", unit="deg", number=True),
        Column(heading="reached now"),
        Column(heading="used in lines"),
        Column(heading="comment"),
    )
    rows = []
    for row in found:
        margin = "" if row.posture is None else f"{row.posture.limit.margin:.1f}"
        reached = "yes" if row.fault is None else f"no: {row.fault.code}"
        lines = ", ".join(name_of(program, line) for line in row.lines)
        point = row.point
        rows.append(
            (point.name, row.kind, point.frame, point.tool, row.configuration, margin, reached, lines, point.comment)
        )
    pendant.output.table(Table(columns=columns, rows=tuple(rows)))


def _go(pendant: "Pendant", rest: str) -> None:
    words = rest.split()
    if not 1 <= len(words) <= 2 or words[1:] not in ([], ["straight"]):
        raise misused(_GO, f"the name of a point is expected, found '{rest}'")
    # spelled as it is taught: the line may be recorded
    name = pendant.point(words[0]).name
    pendant.carry_out(f"{'MOVE' if len(words) == 2 else 'MOVEJ'} {name}")


def _copy(pendant: "Pendant", rest: str) -> None:
    from robolang.teaching.copied import copied
    from robolang.teaching.points_document import set_point

    words = rest.split(maxsplit=2)
    if len(words) < 2:
        raise misused(_COPY, f"two names are expected, found '{rest}'")
    live = pendant.live
    old, new = pendant.point(words[0]), words[1]
    if live.project.points.get(new) is not None:
        raise failure("RBL808", f"there is a point {new} already", "Give another name, or del the point first.")
    # the rest of the line: an offset has blanks, and the parser of the language reads it
    offset = words[2] if len(words) > 2 else ""
    taught = copied(new, old, offset, live.around, frame=live.executor.frame, world=live.executor.world)
    pendant.change(set_point(pendant.desk.documents, taught.point), f"copy {old.name} to {new}")
    pendant.output.line(_described(taught.point))
    for note in taught.notes:
        pendant.output.line(f"  note: {note}")


def _del(pendant: "Pendant", rest: str) -> None:
    from robolang.teaching.points_document import remove_point

    if len(rest.split()) != 1:
        raise misused("del NAME", f"the name of a point is expected, found '{rest}'")
    point = pendant.point(rest)
    pendant.edit(remove_point(pendant.desk.documents, point.name), f"delete {point.name}")
    pendant.output.line(f"{point.name} is deleted; undo brings it back")


def _rename(pendant: "Pendant", rest: str) -> None:
    from robolang.teaching.renaming import rename_point

    words = rest.split()
    if len(words) != 2:
        raise misused(_RENAME, f"two names are expected, found '{rest}'")
    point = pendant.point(words[0])
    pendant.edit(rename_point(pendant.desk.documents, point.name, words[1]), f"rename {point.name}")
    pendant.output.line(f"{point.name} is {words[1]} now")


COMMANDS = (
    Command(
        word="teach",
        form=_TEACH,
        help="Teach a point where the arm stands.",
        group=Group.TEACH,
        do=_teach,
        offers=(Offer.POINT,),
        words=("joints", "pose", "--yes"),
        more="Without a kind a new point is a pose where a frame of the cell is in force, and joints elsewhere.\n"
        "A point that is taught already keeps its kind, frame, tool and comment; it is replaced after a question,\n"
        "in a script with --yes.",
    ),
    Command(
        word="touchup",
        form=_TOUCHUP,
        help="Teach a point anew, after its change is shown.",
        group=Group.TEACH,
        do=_touchup,
        offers=(Offer.POINT,),
        words=("--yes",),
    ),
    Command(
        word="points",
        form="points",
        help="Show the points: where they are used, and whether the arm reaches them.",
        group=Group.TEACH,
        do=_points,
    ),
    Command(
        word="go",
        form=_GO,
        help="Move to a point, all joints together or straight.",
        group=Group.MOTION,
        do=_go,
        offers=(Offer.POINT,),
        words=("straight",),
    ),
    Command(
        word="copy",
        form=_COPY,
        help="Copy a point, with an offset in the frame (+) or the tool (*).",
        group=Group.TEACH,
        do=_copy,
        offers=(Offer.POINT,),
    ),
    Command(
        word="del",
        form="del NAME",
        help="Delete a point.",
        group=Group.TEACH,
        do=_del,
        offers=(Offer.POINT,),
    ),
    Command(
        word="rename",
        form=_RENAME,
        help="Rename a point in program, points and cell.",
        group=Group.TEACH,
        do=_rename,
        offers=(Offer.POINT,),
    ),
)
