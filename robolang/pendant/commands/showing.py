"""Commands that show: where the arm is, where the program is, its names, its text; and inputs that are forced."""

from typing import TYPE_CHECKING

from robolang.pendant.command import Command, Group, Offer
from robolang.pendant.numbers import pose_text
from robolang.pendant.output import Column, Listing, Table
from robolang.pendant.words import misused, nothing, whole
from robolang.values.poses import Frame, Place, Value

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant

_AROUND = 10
"""Lines that ``list`` shows around the current one."""


def _pos(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "pos")
    arm = pendant.live.arm
    # an arm with both kinds of axis names the unit in each row
    unit, *others = dict.fromkeys(arm.units)
    unit = "" if others else unit
    columns = (
        Column(heading="joint"),
        Column(heading="angle", unit=unit, number=True),
        Column(heading="range", unit=unit, number=True),
        Column(heading="to the limit", unit=unit, number=True),
    )
    rows = tuple(
        (
            f"J{i + 1}" if unit else f"J{i + 1}, {arm.units[i]}",
            f"{angle:.3f}",
            f"{low:g} .. {high:g}",
            f"{min(angle - low, high - angle):.3f}",
        )
        for i, (angle, (low, high)) in enumerate(zip(arm.joints, arm.ranges, strict=True))
    )
    pendant.output.table(Table(columns=columns, rows=rows))
    for name, six in (("tool in the frame", arm.tool_in_frame), ("tool in the world", arm.tool_in_world)):
        pendant.output.line(f"{name}: {pose_text(six)}")
    pendant.output.line(
        f"frame {shown(arm.frame, 'WORLD')}   tool {shown(arm.tool, 'of the hand')}   {arm.configuration}".rstrip()
    )


def shown(frame: Frame, default: str) -> str:
    """Return a frame or a tool by its name, or by its numbers."""
    if isinstance(frame, str):
        return frame or default
    return "(" + ", ".join(f"{value:g}" for value in frame) + ")"


def _vars(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "vars")
    executor = pendant.live.executor
    # the main program first, as the calls were made
    rows: list[tuple[str, ...]] = []
    for depth, names in enumerate(executor.variables):
        where = "main" if depth == 0 else f"call {depth}"
        rows += [(where, key, value_text(value)) for key, value in sorted(names.values.items())]
        rows += [(where, f"{key}({len(array) - 1})", _elements(array)) for key, array in sorted(names.arrays.items())]
    if not rows:
        pendant.output.line("no name has a value")
        return
    columns = (Column(heading="scope"), Column(heading="name"), Column(heading="value"))
    pendant.output.table(Table(columns=columns, rows=tuple(rows)))


def value_text(value: Value) -> str:
    """Return a value as the prompt shows it."""
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, float):
        return f"{value:.10g}"
    return _place(value)


def _place(place: Place) -> str:
    base = place.point or ("HERE" if place.last else "")
    if place.joints is not None:
        base = "JOINT(" + ", ".join(f"{value:g}" for value in place.joints) + ")"
    elif place.pose is not None:
        base = "POSE(" + ", ".join(f"{value:g}" for value in place.pose) + ")"
    shifts = ((" + " if each.kind == "frame" else " * ", each.by) for each in place.shifts)
    return base + "".join(f"{sign}({', '.join(f'{x:g}' for x in by)})" for sign, by in shifts)


def _elements(array: object) -> str:
    values = list(array)  # type: ignore[call-overload]
    # an array may have a million elements
    most = 8
    text = ", ".join(map(value_text, values[:most]))
    return f"{text}, ..." if len(values) > most else text


def _list(pendant: "Pendant", rest: str) -> None:
    rows = pendant.desk.analysis.source.line_spans
    text = pendant.desk.analysis.source.text
    if not text.strip():
        pendant.output.line("the program has no lines")
        return
    current = pendant.current
    at = None if current is None else current.source_line
    first, last = _range(pendant, rest, at, pendant.rows)
    shown = tuple(text[rows[row - 1].start : rows[row - 1].end] for row in range(first, last + 1))
    pendant.output.program(
        Listing(rows=shown, first=first, current=at, numbered=pendant.has_numbers, marks=frozenset(pendant.breaks))
    )


def _range(pendant: "Pendant", rest: str, current: int | None, count: int) -> tuple[int, int]:
    """Return the first and the last row, from 1, to show of ``count``."""
    named = [pendant.line_of(word).source_line for word in rest.replace("-", " ").split()]
    if len(named) > 2:
        raise misused("list [LINE [LINE]]", f"found '{rest}'")
    if len(named) == 2:
        return named[0], named[1]
    # a short program is shown whole: where it stands is seen at once
    around = named[0] if named else current
    if around is None or (not named and count <= 4 * _AROUND):
        return 1, count
    return max(1, around - _AROUND), min(count, around + _AROUND)


def _in(pendant: "Pendant", rest: str) -> None:
    form = "in N on|off|auto"
    words = rest.lower().split()
    world = pendant.live.executor.world
    if not words:
        _show_inputs(pendant)
        return
    if len(words) != 2 or words[1] not in ("on", "off", "auto"):
        raise misused(form, f"found '{rest}'")
    number = whole(words[0], form, "the input", 1, 1024)
    # the executor does not see it, so the place before it is kept here
    pendant.live.timeline.mark(f"in {rest}")
    state = {"on": 1.0, "off": 0.0, "auto": None}[words[1]]
    world.signals.force(number, state, round(world.seconds() * 1e6))
    # shown in words: after auto an input may change by itself
    by = "as the cell file says" if words[1] == "auto" else f"forced {words[1].upper()}"
    pendant.output.line(f"input {number}: {by}")


def _show_inputs(pendant: "Pendant") -> None:
    world = pendant.live.executor.world
    rows = tuple(
        (str(number), f"{world.input(number):g}", "forced" if number in world.signals.forced else "")
        for number in sorted(pendant.live.project.cell.inputs)
    )
    if not rows:
        pendant.output.line("the cell has no inputs")
        return
    columns = (Column(heading="input", number=True), Column(heading="state", number=True), Column(heading=""))
    pendant.output.table(Table(columns=columns, rows=rows))


def _view(pendant: "Pendant", rest: str) -> None:
    if rest.lower() not in ("", "off"):
        raise misused("view [off]", f"found '{rest}'")
    if rest:
        pendant.pictures.close()
        pendant.output.line("the live picture is closed")
        return
    pendant.output.line(f"live picture: {pendant.pictures.open(pendant.live)}")


COMMANDS = (
    Command(
        word="pos",
        form="pos",
        help="Show joints, tool pose, frame and tool.",
        group=Group.SHOW,
        do=_pos,
    ),
    Command(
        word="vars",
        form="vars",
        help="Show the names that have a value.",
        group=Group.SHOW,
        do=_vars,
    ),
    Command(
        word="list",
        form="list [LINE [LINE]]",
        help="Show the program, with an arrow at the statement that comes next.",
        group=Group.SHOW,
        do=_list,
        offers=(Offer.LINE,),
        needs_arm=False,
    ),
    Command(
        word="view",
        form="view [off]",
        help="Show the arm live in a browser, beside the prompt.",
        group=Group.SHOW,
        do=_view,
        words=("off",),
        more="The page only shows: the prompt moves the arm. Its address holds a token; whoever has it can watch.",
    ),
    Command(
        word="in",
        form="in [N on|off|auto]",
        help="Force an input of the cell, or show all inputs.",
        group=Group.RUN,
        do=_in,
        offers=(Offer.INPUT,),
        words=("on", "off", "auto"),
        more="auto gives the input back to the cell file. IN(N) in a statement or an expression reads it.",
    ),
)
