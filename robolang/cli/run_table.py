"""The tables that ``robolang run`` prints: one row per statement, one line per fact of the run."""

from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table

_COLUMNS = (
    ("start\n\ns", "start_s", "{:.3f}"),
    ("time\n\ns", "duration_s", "{:.3f}"),
    ("joint\nerror\ndeg", "joint_error_deg", "{:.4f}"),
    ("tool\nerror\nmm", "tool_error_mm", "{:.3f}"),
    ("off\npath\nmm", "path_deviation_mm", "{:.3f}"),
    ("peak\ntorque\n%", "peak_torque_pct", "{:.0f}"),
)


def print_result(report: dict[str, Any]) -> None:
    """Print the report of a run."""
    console = Console()
    console.print(_statements(report))
    for statement in report["statements"]:
        for note in statement["notes"]:
            console.print(f"  line {_number(statement)}: {note}", highlight=False, markup=False)
    for line in _facts(report):
        console.print(line, highlight=False, markup=False)


def _number(statement: dict[str, Any]) -> int:
    return int(statement["line"] if statement["number"] is None else statement["number"])


def _statements(report: dict[str, Any]) -> Table:
    title = f"{report['program']} on {report['robot']}"
    table = Table(box=box.SIMPLE_HEAD, title=title, title_justify="left", padding=(0, 1, 0, 0))
    table.add_column("line", justify="right", no_wrap=True, min_width=4)
    table.add_column("statement", overflow="ellipsis", no_wrap=True, min_width=20, max_width=28)
    for heading, _, _ in _COLUMNS:
        table.add_column(heading, justify="right", no_wrap=True)
    for statement in report["statements"]:
        cells = [
            "" if statement[key] is None else form.format(statement[key]) for _, key, form in _COLUMNS
        ]
        table.add_row(str(_number(statement)), statement["text"], *cells)
    return table


def _facts(report: dict[str, Any]) -> list[str]:
    dynamics = report["dynamics"]
    lines = [
        f"{report['sim_time_s']:.3f} s simulated in {report['wall_time_s']:.2f} s "
        f"({report['realtime_factor']:.1f} x real time), {report['cycles']} cycles of 8 ms, "
        f"{report['overruns']} overruns",
        f"dynamics task: each axis refreshed every {dynamics['refresh_mean_ms']:.1f} ms, "
        f"at most {dynamics['refresh_max_ms']:.1f} ms",
    ]
    for name, entry in report["objects"].items():
        x, y, z, rx, ry, rz = (round(value, 3) + 0.0 for value in entry["pose_mm_deg"])
        lines.append(f"{name}: at ({x:.3f}, {y:.3f}, {z:.3f}) mm, turned ({rx:.3f}, {ry:.3f}, {rz:.3f}) deg")
    return lines
