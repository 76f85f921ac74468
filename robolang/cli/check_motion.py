"""The motion part of ``robolang check --motion``: findings of a rehearsal, and a table of what each line takes.

Imported with ``--motion`` only: it needs numpy, pinocchio and mujoco, which checking a text does not.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from textwrap import wrap

from robolang.analysis.analysis import Analysis
from robolang.cli import lines, speed_cells
from robolang.cli.run_table import estimates
from robolang.core.bounds import Bounds
from robolang.core.diagnostics import Diagnostic, safe
from robolang.execution.dry_run import Rehearsal
from robolang.planning.line_times import LineTime, line_times
from robolang.planning.motion_findings import DEFAULTS, LoadShare, findings, worst_loads
from robolang.planning.path_coverage import Exploration, explore
from robolang.project.project import Project, load_project
from runtime.core.tomlfile import FileFault
from runtime.robot.model.estimated import axis_key, mark
from runtime.robot.model.spec import RobotSpec

_WIDTH = 80
"""Columns of the table. Not those of the terminal: it stands in report files too."""
_NARROWEST = 12
"""Columns of the statements where numbers leave fewer than this."""
_NOTHING = 5e-4
"""A moment or inertia at the wrist below this, N m or kg m2, is printed as 0: a payload on the axis leaves 1e-17."""
_COLUMNS = (
    ("times", ""),
    ("time", "s"),
    ("path", "mm"),
    ("speed", "mm/s"),
    ("fastest", "joint %"),
    ("margin", "deg"),
    ("wrist", "deg"),
)
"""Heading and unit of the columns after the statement."""
_LIMITED = ("limited", "by")
"""The same of the column that stands there as well where a move does not reach its speed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Planned:
    """The findings in the motion of a program, the table of its times for people, and the same as plain JSON types.

    ``warnings`` are what is unlikely about its cell and the files of its robot; ``rehearsal`` is its motion, None where
    none was planned.
    """

    diagnostics: tuple[Diagnostic, ...]
    warnings: tuple[FileFault, ...] = ()
    table: str = ""
    times: dict[str, object] | None = None
    project: Project | None = None
    rehearsal: Rehearsal | None = None


def planned(
    program: Analysis | str,
    max_cycle_s: float | None,
    bounds: Bounds = DEFAULTS,
    tell: Callable[[int], None] | None = None,
) -> Planned:
    """Return the findings in the motion of a program, or of the file of one; ``Fault`` for files beside it.

    ``tell`` takes the simulated time that is planned, us.
    What the cell makes an error of the text (a load, a tool or an input that it does not have) is among them.
    """
    project = load_project(program)
    if not project.ok:
        return Planned(diagnostics=project.diagnostics, warnings=project.cell.warnings)
    explored = explore(project, tell)
    found = findings(project, explored.rehearsal, max_cycle_s, explored.detours, bounds)
    rows = line_times(project, explored.rehearsal)
    return Planned(
        diagnostics=found,
        warnings=project.cell.warnings,
        table=_table(project, explored.rehearsal, rows) + _branches(project, explored) + _shapes(project),
        times=_times(project, explored, rows),
        project=project,
        rehearsal=explored.rehearsal,
    )


def write_page(path: Path, plan: Planned, found: Sequence[Diagnostic]) -> None:
    """Write the page of a planned motion with what was found in program, motion and the files beside them.

    ``Fault`` RBL706, RBL825.
    """
    from robolang.view.page import Bundle
    from robolang.view.page import write_page as write
    from robolang.view.plan_page import pack_plan

    assert plan.project is not None and plan.rehearsal is not None, "a page shows what was planned"
    write(path, [pack_plan(plan.project, plan.rehearsal, found, plan.warnings)], Bundle.installed())


def _times(project: Project, explored: Exploration, rows: Sequence[LineTime]) -> dict[str, object]:
    shares = worst_loads(project, explored.rehearsal.kinematics, explored.rehearsal.moves)
    return {
        "program": project.source.path,
        "robot": project.cell.robot.name,
        "robot_estimated": list(project.cell.robot.estimated),
        "total_s": explored.rehearsal.total_us / 1e6,
        "complete": not explored.rehearsal.refused,
        "lines": [asdict(row) for row in rows],
        "payload": [
            {
                "joint": f"J{share.axis + 1}",
                share.name: share.value,
                "limit": share.limit,
                "unit": share.unit,
                "estimated": not share.given,
            }
            for share in shares
        ],
        "other_ways": len(explored.detours),  # the key is read by other programs: branches, in today's words
        "not_planned": _missed(project, explored),
        "self_collision_checked": bool(project.cell.robot.link_radii),
    }


def _missed(project: Project, explored: Exploration) -> list[int]:
    """Return the lines of moves that no branch reached."""
    return sorted({project.source.place(node.span.start).line for node in explored.missed})


def _table(project: Project, rehearsal: Rehearsal, rows: Sequence[LineTime]) -> str:
    where = lines.headings([asdict(row) for row in rows])
    blank, (names, units) = [""] * len(where), zip(*_COLUMNS, strict=True)
    limited = [speed_cells.limited(asdict(row)) for row in rows]
    cells = [
        [*where, "statement", *names, _LIMITED[0]],
        [*blank, "", *units, _LIMITED[1]],
        *(
            [*lines.cells(asdict(row), where), safe(row.text), *_cells(row, project.cell.robot), by]
            for row, by in zip(rows, limited, strict=True)
        ),
        [*blank, "total", "", f"{rehearsal.total_us / 1e6:.3f}", *[""] * (len(names) - 1)],
    ]
    if not any(limited) or _room(cells, len(where)) < _NARROWEST:
        cells = [row[:-1] for row in cells]
    facts = estimates(list(project.cell.robot.estimated))
    wrapped = [each for line in facts for each in wrap(line, _WIDTH)]
    table = [
        f"{safe(project.source.path)} on {project.cell.robot.name}, planned without physics",
        *_aligned(cells, len(where)),
        *_wrist(project, rehearsal),
        *wrapped,
    ]
    return "\n".join(line.rstrip() for line in table) + "\n"


def _aligned(rows: Sequence[Sequence[str]], statement: int) -> Iterator[str]:
    """Yield the lines of a table: numbers as wide as they need, the column ``statement`` with the room that is left."""
    widths = _widths(rows)
    widths[statement] = max(_NARROWEST, min(widths[statement], _room(rows, statement)))
    for row in rows:
        text, width = row[statement], widths[statement]
        cut = text if len(text) <= width else f"{text[: width - 1]}…"
        cells = [f"{cell:>{width}}" for cell, width in zip(row, widths, strict=True)]
        cells[statement] = f" {cut:<{width}}"
        yield f" {' '.join(cells)}"


def _widths(rows: Sequence[Sequence[str]]) -> list[int]:
    return [max(map(len, column)) for column in zip(*rows, strict=True)]


def _room(rows: Sequence[Sequence[str]], statement: int) -> int:
    """Return how wide the column ``statement`` may be so that the table is as wide as a report."""
    widths = _widths(rows)
    # a space between columns, two at the statement
    return _WIDTH - sum(widths) + widths[statement] - len(widths) - 1


def _branches(project: Project, explored: Exploration) -> str:
    """Return how many other branches were planned, and which moves on none of them."""
    text = ""
    if explored.detours:
        count = len(explored.detours)
        text += f"and {count} other branch{'es' * (count > 1)}, where inputs, time or errors decide\n"
    if explored.missed:
        missed = ", ".join(map(str, _missed(project, explored)))
        text += f"not planned, since {_why_missed(project, explored)}: the moves in line {missed}\n"
    return text


def _why_missed(project: Project, explored: Exploration) -> str:
    errors = sorted({project.source.place(item.span.start).line for item in explored.rehearsal.refused})
    if not errors:
        return "no branch reached them"
    return f"planning ends at the error in line {', '.join(map(str, errors))} and no other branch reached them"


def _shapes(project: Project) -> str:
    """Return what is not checked for an arm whose shapes are not known."""
    robot = project.cell.robot
    if robot.link_radii:
        return ""
    return (
        f"not checked: the arm against itself, since {safe(robot.name)} has no shapes (link_radius_mm);\n"
        "against obstacles its links are taken as thin capsules\n"
    )


def _wrist(project: Project, rehearsal: Rehearsal) -> list[str]:
    """Return the lines with moment and inertia of the payload at the wrist in its worst posture, and their limits."""
    shares = worst_loads(project, rehearsal.kinematics, rehearsal.moves)
    found = [
        f"  {name:<8} {', '.join(map(_share, of_it))} {of_it[0].unit}"
        for name in ("moment", "inertia", "weight", "mass")
        if (of_it := [share for share in shares if share.name == name])
    ]
    return ["payload at the wrist, worst posture (~: limit estimated from the drive)", *found] if found else []


def _share(share: LoadShare) -> str:
    value = share.value if share.value >= _NOTHING else 0
    return f"J{share.axis + 1} {value:.3g} of {'' if share.given else '~'}{share.limit:.3g}"


def _mark(robot: RobotSpec, axis: int) -> str:
    return mark(robot.estimated, axis_key(axis, robot.axes[axis].kind.speed_key))


def _cells(row: LineTime, robot: RobotSpec) -> tuple[str, ...]:
    # the share of a limit that is an estimate is no better than the limit
    known = "" if row.joint == "" else _mark(robot, int(row.joint[1:]) - 1)
    return (
        str(row.count),
        f"{row.seconds:.3f}",
        "" if row.length_mm is None else f"{row.length_mm:.1f}",
        speed_cells.cell(asdict(row)),
        "" if row.speed_pct is None else f"{row.joint} {f'{known}{row.speed_pct:.0f}':>4}",
        ", ".join(
            f"{least:.1f}{mm}" for least, mm in ((row.margin_deg, ""), (row.margin_mm, " mm")) if least is not None
        ),
        "" if row.wrist_deg is None else f"{row.wrist_deg:.1f}",
    )
