"""The motion part of ``robolang check --motion``: findings of a rehearsal, and a table of what each line takes.

Imported where it is asked for: it needs numpy, pinocchio and mujoco, which checking a text does not.
"""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass

from robolang.analysis.analysis import Analysis
from robolang.cli import lines
from robolang.core.bounds import Bounds
from robolang.core.diagnostics import Diagnostic, safe
from robolang.execution.dry_run import Rehearsal
from robolang.planning.line_times import LineTime, line_times
from robolang.planning.motion_findings import DEFAULTS, findings, worst_loads
from robolang.planning.path_coverage import Exploration, explore
from robolang.project.project import Project, load_project
from runtime.core.tomlfile import FileFault

_STATEMENT = 30
_NOTHING = 5e-4


@contextmanager
def told(count: int) -> Iterator[Callable[[int, str], None]]:
    """Yield what is to be told which of ``count`` programs is planned; on a terminal a live line says so."""
    if count < 2 or sys.stderr is None or not sys.stderr.isatty():
        yield lambda number, name: None
        return
    from robolang.cli.console import Console

    with Console(stderr=True).status("planning") as status:
        yield lambda number, name: status.update(f"planning {safe(name)}, {number + 1} of {count}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Planned:
    """The findings in the motion of a program, the table of its times for people, and the same as plain JSON types.

    ``warnings`` are what is unlikely about its cell and the files of its robot.
    """

    diagnostics: tuple[Diagnostic, ...]
    warnings: tuple[FileFault, ...] = ()
    table: str = ""
    times: dict[str, object] | None = None


def planned(program: Analysis | str, max_cycle_s: float | None, bounds: Bounds = DEFAULTS) -> Planned:
    """Return what planning the motion of a program, or of the file of one, shows; ``Fault`` for files beside it.

    What the cell makes an error of the text (a load, a tool or an input that it does not have) is among them.
    """
    project = load_project(program)
    if not project.ok:
        return Planned(diagnostics=project.diagnostics, warnings=project.cell.warnings)
    explored = explore(project)
    found = findings(project, explored.rehearsal, max_cycle_s, explored.detours, bounds)
    rows = line_times(project, explored.rehearsal)
    return Planned(
        diagnostics=found,
        warnings=project.cell.warnings,
        table=_table(project, explored.rehearsal, rows) + _ways(project, explored) + _shapes(project),
        times=_times(project, explored, rows),
    )


def _times(project: Project, explored: Exploration, rows: Sequence[LineTime]) -> dict[str, object]:
    shares = worst_loads(project, explored.rehearsal.kinematics, explored.rehearsal.moves)
    return {
        "program": project.source.path,
        "robot": project.cell.robot.name,
        "total_s": explored.rehearsal.total_us / 1e6,
        "complete": not explored.rehearsal.refused,
        "lines": [asdict(row) for row in rows],
        "payload": [
            {
                "joint": f"J{share.axis + 1}",
                share.what: share.value,
                "limit": share.limit,
                "unit": share.unit,
                "estimated": not share.given,
            }
            for share in shares
        ],
        "other_ways": len(explored.detours),
        "not_planned": _missed(project, explored),
        "self_collision_checked": bool(project.cell.robot.link_radii),
    }


def _missed(project: Project, explored: Exploration) -> list[int]:
    """Return the lines of moves that no way led to."""
    return sorted({project.source.place(node.span.start).line for node in explored.missed})


def _table(project: Project, rehearsal: Rehearsal, rows: Sequence[LineTime]) -> str:
    where = lines.headings([asdict(row) for row in rows])
    table = [
        f"{safe(project.source.path)} on {project.cell.robot.name}, planned without physics",
        f"{_where(where)}  {'statement':<{_STATEMENT}} {'times':>5} {'time, s':>8} {'path, mm':>8} {'fastest':>11} "
        f"{'to range':>9} {'wrist':>9}",
        *(_row(row, where) for row in rows),
        f"{_where([''] * len(where))}  {'total':<{_STATEMENT}} {'':>5} {rehearsal.total_us / 1e6:8.3f}",
        *_wrist(project, rehearsal),
    ]
    return "\n".join(line.rstrip() for line in table) + "\n"


def _where(cells: Sequence[str]) -> str:
    return " ".join(f"{cell:>5}" for cell in cells)


def _ways(project: Project, explored: Exploration) -> str:
    """Return what to say of the ways through the program: how many were planned, and which moves on none of them."""
    text = ""
    if explored.detours:
        ways = len(explored.detours)
        text += f"and {ways} other branch{'es' * (ways > 1)}, where inputs, time or errors decide\n"
    if explored.missed:
        missed = ", ".join(map(str, _missed(project, explored)))
        text += f"not planned, since no branch reached them: the moves in line {missed}\n"
    return text


def _shapes(project: Project) -> str:
    """Return what to say of an arm whose shapes are not known."""
    robot = project.cell.robot
    if robot.link_radii:
        return ""
    return (
        f"not checked: the arm against itself, since {safe(robot.name)} has no shapes (link_radius_mm); against "
        "obstacles its links are taken as thin capsules\n"
    )


def _wrist(project: Project, rehearsal: Rehearsal) -> list[str]:
    """Return the lines that say what the payload asks of the wrist in its worst posture, and of what; ~ estimated."""
    shares = worst_loads(project, rehearsal.kinematics, rehearsal.moves)
    said_of = []
    for what in ("moment", "inertia"):
        said = [
            f"J{share.axis + 1} {share.value if share.value >= _NOTHING else 0:.3g} of "
            f"{'' if share.given else '~'}{share.limit:.3g}"
            for share in shares
            if share.what == what
        ]
        if said:
            unit = next(share.unit for share in shares if share.what == what)
            said_of.append(f"{what} of the payload at the wrist, worst posture: {', '.join(said)} {unit}")
    return said_of


def _row(row: LineTime, where: tuple[str, ...]) -> str:
    text = safe(row.text)
    text = text if len(text) <= _STATEMENT else f"{text[: _STATEMENT - 1]}…"
    way = "" if row.length_mm is None else f"{row.length_mm:.1f}"
    fastest = "" if row.speed_pct is None else f"{row.joint} {row.speed_pct:4.0f} %"
    margin = "" if row.margin_deg is None else f"{row.margin_deg:.1f} deg"
    wrist = "" if row.wrist_deg is None else f"{row.wrist_deg:.1f} deg"
    at = _where(lines.cells(asdict(row), where))
    return f"{at}  {text:<{_STATEMENT}} {row.count:>5} {row.seconds:8.3f} {way:>8} {fastest:>11} {margin:>9} {wrist:>9}"
