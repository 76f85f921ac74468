"""The tables that ``robolang run`` prints: one row per statement, one line per fact of the run.

The columns of numbers are as wide as their widest number; the statements get what is left of the line and are the
only thing that is ever cut.
"""

from typing import Any

from rich import box
from rich.table import Table

from robolang.cli import lines
from robolang.cli.console import Console
from robolang.core.diagnostics import safe

_COLUMNS = (
    ("start\n\ns", "start_s", "{:.3f}"),
    ("time\n\ns", "duration_s", "{:.3f}"),
    ("joint\nerror\ndeg", "joint_error_deg", "{:.4f}"),
    ("tool\nerror\nmm", "tool_error_mm", "{:.3f}"),
    ("path\nerror\nmm", "path_deviation_mm", "{:.3f}"),
    ("peak\ntorque\n%", "peak_torque_pct", "{:.0f}"),
)
_NARROWEST, _WIDEST = 12, 40


def print_result(report: dict[str, Any]) -> None:
    """Print the report of a run."""
    console = Console()
    console.print(safe(f"{report['program']} on {report['robot']}"), style="italic", soft_wrap=True)
    console.print(_statements(report, console.width))
    for statement in report["statements"]:
        for note in statement["notes"]:
            console.print(f"  {lines.name(statement)}: {note}")
    for line in _facts(report):
        console.print(line)


def _statements(report: dict[str, Any], width: int) -> Table:
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    statements = report["statements"]
    where = lines.headings(statements)
    for heading in where:
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("statement", no_wrap=True)
    for heading, _, _ in _COLUMNS:
        table.add_column(heading, justify="right", no_wrap=True)
    rows = [[*lines.cells(statement, where), *_cells(statement)] for statement in statements]
    # cut here and not by rich, which would shrink the columns of numbers too
    room, at = _room(rows, where, width), len(where)
    for row in rows:
        text = row[at]
        row[at] = text if len(text) <= room else f"{text[: room - 1]}…"
        table.add_row(*row)
    return table


def _cells(statement: dict[str, Any]) -> list[str]:
    numbers = ["" if statement[key] is None else form.format(statement[key]) for _, key, form in _COLUMNS]
    # a move may be planned ahead and be cut off by an alarm or a stop before it
    if not statement["begun"]:
        numbers[0] = "not begun"
    return [safe(statement["text"]), *numbers]


def _room(rows: list[list[str]], where: tuple[str, ...], width: int) -> int:
    """Return how wide a statement may be so that the table is not wider than the console."""
    headings = [*where, "", *(max(heading.split("\n"), key=len) for heading, _, _ in _COLUMNS)]
    widths = [max(map(len, column)) for column in zip(headings, *rows, strict=True)]
    taken = sum(widths) - widths[len(where)] + 2 * len(widths) + 1  # two spaces between columns, and those at the edges
    return min(max(width - taken, _NARROWEST), _WIDEST)


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}{'s' * (count != 1)}"


def _facts(report: dict[str, Any]) -> list[str]:
    dynamics = report["dynamics"]
    lines = [
        f"{report['sim_time_s']:.3f} s simulated in {report['wall_time_s']:.2f} s "
        f"({report['realtime_factor']:.1f} x real time), {_counted(report['cycles'], 'cycle')} of 8 ms, "
        f"{_counted(report['overruns'], 'overrun')}"
    ]
    if report["cycles"]:
        lines.append(
            f"dynamics task: each axis refreshed every {dynamics['refresh_mean_ms']:.1f} ms, "
            f"at most {dynamics['refresh_max_ms']:.1f} ms"
        )
    for name, entry in report["objects"].items():
        # adding zero turns a rounded -0.0 into 0.0
        x, y, z, rx, ry, rz = (round(value, 3) + 0.0 for value in entry["pose_mm_deg"])
        lines.append(f"{name}: at ({x:.3f}, {y:.3f}, {z:.3f}) mm, turned ({rx:.3f}, {ry:.3f}, {rz:.3f}) deg")
    return lines
