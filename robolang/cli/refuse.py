"""What every command that runs a program does first: say what is wrong with it and leave."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robolang.cli.builtin_cell import note_builtin_cell
from robolang.cli.errors import DIAGNOSTICS, exit_code, say_warnings
from robolang.cli.output import show_finding

if TYPE_CHECKING:
    from robolang.execution.outlook import PlannedStep
    from robolang.execution.plan_memory import PlanMemory
    from robolang.project.project import Project


@dataclass(frozen=True, slots=True, kw_only=True)
class Accepted:
    """A program that may run: whether there are warnings, printed or not, and what its rehearsal takes time for."""

    warned: bool
    steps: "tuple[PlannedStep, ...]"


def refuse_text(project: "Project", *, warnings: bool = True) -> None:
    """Print the diagnostics and what is unlikely about the robot and the cell; leave when the text has errors."""
    from robolang.core.diagnostics import Severity, render

    if warnings:
        say_warnings(project.cell.warnings)
    for item in project.diagnostics:
        if warnings or item.severity is Severity.ERROR:
            show_finding(render(item, project.source))
    if not project.ok:
        note_builtin_cell(project.analysis, project.diagnostics)
        raise SystemExit(DIAGNOSTICS)


def refuse(
    project: "Project", *, warnings: bool = True, plans: "PlanMemory | None" = None, most_us: int | None = None
) -> Accepted:
    """Print the diagnostics and what is unlikely about the robot and the cell.

    Leave when the text has errors or a motion cannot be planned. ``warnings`` False: print errors only. ``plans``
    keeps what is planned, for the run. ``most_us``: the longest simulated time, us; None: the usual one.
    """
    from robolang.core.diagnostics import Severity, render

    refuse_text(project, warnings=warnings)
    from robolang.cli.planning_progress import planning
    from robolang.execution.dry_run import rehearse

    with planning(quiet=not warnings) as progress:
        progress.begin(0, project.source.path)
        # a time that somebody chose to wait is run in full
        rehearsal = rehearse(
            project, plans=plans, most_us=most_us, every_round=most_us is not None, tell=progress.planned
        )
    preventing = rehearsal.preventing_within(most_us)
    for item in preventing:
        show_finding(render(item, project.source))
    if preventing:
        raise SystemExit(exit_code(preventing[0].code))
    # counted although not printed: --strict needs them with --quiet too
    unlikely = bool(project.cell.warnings)
    return Accepted(
        warned=unlikely or any(item.severity is Severity.WARNING for item in project.diagnostics), steps=rehearsal.steps
    )
