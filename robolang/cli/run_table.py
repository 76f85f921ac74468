"""The tables that ``robolang run`` prints: one row for each line of the program, one line for each fact of the run.

A line that was carried out several times has one row: when it first began, the sum of its times, its largest errors.
The columns of numbers are as wide as their widest number; the statements get what is left of the line and are the
only thing that is ever cut.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from rich import box
from rich.table import Table

from robolang.cli import lines, speed_cells
from robolang.cli.console import Console
from robolang.core.diagnostics import safe
from robolang.execution.speed_keys import of_runs
from runtime.robot.model.estimated import decisive, groups


class _Column(NamedTuple):
    """A column of numbers: heading, key of a statement, how it is printed, and the one number of several."""

    heading: str
    key: str
    form: str
    of: Callable[[Sequence[float]], float] = max


_COLUMNS = (
    _Column("start\n\ns", "start_s", "{:.3f}", min),
    _Column("time\n\ns", "duration_s", "{:.3f}", sum),
    _Column("joint\nerror\ndeg", "joint_error_deg", "{:.4f}"),
    _Column("slide\nerror\nmm", "joint_error_mm", "{:.4f}"),
    _Column("tool\nerror\nmm", "tool_error_mm", "{:.3f}"),
    _Column("path\nerror\nmm", "path_deviation_mm", "{:.3f}"),
    _Column("peak\ntorque\n%", "peak_torque_pct", "{:.0f}"),
)
_SPEEDS = (_Column("speed\n\nmm/s", "speed", "{}"), _Column("limited\nby\n", "limited_by", "{}"))
"""What is programmed of moves and reached: in columns where the terminal is wide enough."""
_TIMES = _Column("times\n\n", "times", "{:.0f}", sum)
_NARROWEST, _WIDEST = 12, 40
_ROOMY = 104
"""Columns of a terminal from which on the table has the speeds as well."""


def print_result(report: dict[str, Any], *, every: bool = False, worst: bool = False) -> None:
    """Print the report of a run; ``every``: each statement that was carried out, ``worst``: the largest tool error
    first."""
    console = Console()
    console.print(safe(f"{report['program']} on {report['robot']}"), style="italic", soft_wrap=True)
    rows = [{**statement, "times": 1, "speed": speed_cells.cell(statement)} for statement in report["statements"]]
    rows = rows if every else _by_line(rows)
    if worst:
        # what has no error has taken no time, and comes last
        rows.sort(key=lambda row: -1.0 if row["tool_error_mm"] is None else row["tool_error_mm"], reverse=True)
    console.print(_statements(rows, console.width))
    narrow = console.width < _ROOMY
    for note in dict.fromkeys(f"  {lines.name(row)}: {note}" for row in rows for note in _notes(row, narrow=narrow)):
        console.print(note)
    for line in _facts(report):
        console.print(line)


def _notes(row: Mapping[str, Any], *, narrow: bool) -> list[str]:
    """Return the notes of a row, with what keeps it from its speed where no column shows that."""
    # most short moves do not reach their speed, which is no news
    limited = narrow and row["limited_by"] not in (None, "length")
    return [*row["notes"], *([speed_cells.sentence(row)] if limited else [])]


def _by_line(statements: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return one row for each line and text, in the order in which they were first reached."""
    found: dict[tuple[Any, ...], list[Mapping[str, Any]]] = {}
    for statement in statements:
        # one that was cut off before it began says so in a row of its own
        found.setdefault((statement["line"], statement["text"], statement["begun"]), []).append(statement)
    return [_together(rows) for rows in found.values()]


def _together(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    # what is no number is the same in all rows of a line
    together = dict(rows[0])
    for column in (_TIMES, *_columns(rows)):
        numbers = [row[column.key] for row in rows if row[column.key] is not None]
        together[column.key] = column.of(numbers) if numbers else None
    together |= of_runs(rows)
    return {**together, "speed": speed_cells.cell(together), "notes": [note for row in rows for note in row["notes"]]}


def _columns(statements: Sequence[Mapping[str, Any]]) -> tuple[_Column, ...]:
    """Return the columns that these statements have: an arm whose axes all turn has no error of a slide."""
    # a run of nothing has none either
    keys = statements[0] if statements else {column.key for column in _COLUMNS} - {"joint_error_mm"}
    return tuple(column for column in _COLUMNS if column.key in keys)


def _shown(statements: Sequence[Mapping[str, Any]], width: int) -> tuple[_Column, ...]:
    """Return the columns of a table that is ``width`` wide."""
    # a program without loops has no need of the times
    times = [_TIMES] if any(row["times"] > 1 for row in statements) else []
    # nor one without moves of their speeds
    speeds = [each for each in _SPEEDS if width >= _ROOMY and any(row.get(each.key) for row in statements)]
    return (*times, *_columns(statements), *speeds)


def _statements(statements: Sequence[Mapping[str, Any]], width: int) -> Table:
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    where = lines.headings(statements)
    columns = _shown(statements, width)
    for heading in where:
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("statement", no_wrap=True)
    for column in columns:
        table.add_column(column.heading, justify="right", no_wrap=True)
    rows = [[*lines.cells(statement, where), *_cells(statement, columns)] for statement in statements]
    # cut here and not by rich, which would shrink the columns of numbers too
    headings = [*where, "", *(max(column.heading.split("\n"), key=len) for column in columns)]
    room, at = _room(rows, headings, len(where), width), len(where)
    for row in rows:
        text = row[at]
        row[at] = text if len(text) <= room else f"{text[: room - 1]}…"
        table.add_row(*row)
    return table


def _cells(statement: Mapping[str, Any], columns: Sequence[_Column]) -> list[str]:
    numbers = ["" if statement[column.key] is None else column.form.format(statement[column.key]) for column in columns]
    # a move may be planned ahead and be cut off by an alarm or a stop before it
    if not statement["begun"]:
        numbers[columns.index(_COLUMNS[0])] = "not begun"
    return [safe(statement["text"]), *numbers]


def _room(rows: list[list[str]], headings: list[str], at: int, width: int) -> int:
    """Return how wide the statements, in column ``at``, may be so that the table is not wider than the console."""
    widths = [max(map(len, column)) for column in zip(headings, *rows, strict=True)]
    taken = sum(widths) - widths[at] + 2 * len(widths) + 1  # two spaces between columns, and those at the edges
    return min(max(width - taken, _NARROWEST), _WIDEST)


def counted(count: int, noun: str) -> str:
    """Return a count with its noun."""
    return f"{count} {noun}{'s' * (count != 1)}"


def estimates(names: Sequence[str]) -> list[str]:
    """Return the line about the values of a robot that are estimates, none where no torque and no error follows from
    them; ``names`` as in ``RobotSpec.estimated``."""
    return [f"estimated ({len(names)} values): {', '.join(groups(names))}"] if decisive(names) else []


def _facts(report: dict[str, Any]) -> list[str]:
    dynamics, cycles = report["dynamics"], report["cycles"]
    lines = [
        f"cycle time {report['sim_time_s']:.3f} s; simulated in {report['wall_time_s']:.2f} s "
        f"({report['realtime_factor']:.1f} x real time)"
    ]
    ran = f"{counted(cycles, 'cycle')} of 8 ms, {counted(report['overruns'], 'overrun')}"
    if cycles:
        ran += f"; inertia of each axis every {dynamics['refresh_mean_ms']:.1f} to {dynamics['refresh_max_ms']:.1f} ms"
    lines.append(ran)
    lines += estimates(report["robot_estimated"])
    for name, entry in report["objects"].items():
        # adding zero turns a rounded -0.0 into 0.0
        x, y, z, rx, ry, rz = (round(value, 3) + 0.0 for value in entry["pose_mm_deg"])
        lines.append(f"{name}: at ({x:.3f}, {y:.3f}, {z:.3f}) mm, turned ({rx:.3f}, {ry:.3f}, {rz:.3f}) deg")
    return lines
