"""What every command that runs a program does first: say what is wrong with it and leave."""

from typing import TYPE_CHECKING

from robolang.cli.errors import DIAGNOSTICS, exit_code, say_warnings
from robolang.cli.output import echo

if TYPE_CHECKING:
    from robolang.execution.plan_memory import PlanMemory
    from robolang.project.project import Project


def refuse(project: "Project", *, warnings: bool = True, plans: "PlanMemory | None" = None) -> bool:
    """Print the diagnostics and what is unlikely about the robot and the cell.

    Leave when the text has errors or a motion cannot be planned. ``warnings`` False: print errors only. ``plans``
    keeps what is planned, for the run. Returns whether there are warnings, printed or not.
    """
    from robolang.core.diagnostics import Severity, render

    if warnings:
        say_warnings(project.cell.warnings)
    for item in project.diagnostics:
        if warnings or item.severity is Severity.ERROR:
            echo(render(item, project.source), err=True)
    if not project.ok:
        raise SystemExit(DIAGNOSTICS)
    from robolang.execution.dry_run import motion_check

    refused = motion_check(project, plans)
    for item in refused:
        echo(render(item, project.source), err=True)
    if refused:
        raise SystemExit(exit_code(refused[0].code))
    # counted although not printed: --strict needs them with --quiet too
    unlikely = bool(project.cell.warnings)
    return unlikely or any(item.severity is Severity.WARNING for item in project.diagnostics)
