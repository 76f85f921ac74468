"""``robolang run PROG``: a program on the controller and the physics, with progress, a table and files to keep.

Progress and errors go to stderr, the table to stdout. Output files are tried before the run and written whole.
"""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from robolang.cli.errors import DIAGNOSTICS, MOTION, exit_code, render, reported
from robolang.cli.values import OptionValueError

if TYPE_CHECKING:
    from robolang.project import Project
    from robolang.session import Progress, RunResult, Session, StatementRun


def run(
    program: Annotated[str, typer.Argument(metavar="PROG", help="Program file (.rbl).")],
    cell: Annotated[str | None, typer.Option(help="Cell file (.toml); default: the one beside the program.")] = None,
    robot: Annotated[str | None, typer.Option(help="Built-in robot or robot file, in place of the cell's.")] = None,
    servo: Annotated[
        str | None, typer.Option(help="Servo gains: 'scheduled' follow the inertia, 'fixed' do not.")
    ] = None,
    no_physics: Annotated[bool, typer.Option("--no-physics", help="Ideal arm instead of MuJoCo.")] = False,
    realtime: Annotated[bool, typer.Option("--realtime", help="Keep wall time.")] = False,
    report: Annotated[Path | None, typer.Option(help="Write the report as JSON.")] = None,
    log: Annotated[Path | None, typer.Option(help="Write every signal: .npz (numpy) or .mcap (log viewers).")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print nothing but errors.")] = False,
) -> None:
    """Run a program on the controller and the physics."""
    if servo not in (None, "scheduled", "fixed"):
        raise OptionValueError("--servo", f"'{servo}' is not one of scheduled, fixed")
    if log is not None and log.suffix not in (".npz", ".mcap"):
        raise OptionValueError("--log", f"'{log}' must end in .npz or .mcap")
    with reported():
        from robolang.project import load_project
        from robolang.storage import check_writable

        for path in (report, log):
            if path is not None:
                check_writable(path)
        project = load_project(program, cell, robot, servo)  # type: ignore[arg-type]
        _refuse(project)
        from robolang.session import Session

        with _progress(quiet) as progress:
            session = Session(project, physics=not no_physics, realtime=realtime, progress=progress)
            with _signals(session) as stopped:
                result = session.run()
        _write(result, report, log)
        if not quiet:
            from robolang.cli.run_table import print_result

            print_result(result.report)
        _print_alarms(project, result)
    if stopped:
        raise typer.Exit(128 + stopped[0])
    if not result.ok:
        raise typer.Exit(MOTION)


def _refuse(project: "Project") -> None:
    """Print the diagnostics; leave with 1 when the text has errors, with 3 when a motion cannot be planned."""
    for item in project.diagnostics:
        typer.echo(render(item, project.source), err=True)
    if not project.ok:
        raise typer.Exit(DIAGNOSTICS)
    from robolang.motion_check import motion_check

    refused = motion_check(project)
    for item in refused:
        typer.echo(render(item, project.source), err=True)
    if refused:
        raise typer.Exit(exit_code(refused[0].code))


def _write(result: "RunResult", report: Path | None, log: Path | None) -> None:
    from robolang.runlog import write_log
    from robolang.storage import write_json

    if report is not None:
        write_json(report, result.report)
    if log is not None:
        write_log(log, result.log)


def _print_alarms(project: "Project", result: "RunResult") -> None:
    alarms: Any = result.report["alarms"]
    statements: Any = result.report["statements"]
    for alarm in alarms:
        where = f"{project.source.path}:{statements[-1]['line']}:1" if statements else project.source.path
        typer.echo(
            f"{where}: error {alarm['code']} at {alarm['time_s']:.3f} s: {alarm['message']}\n  help: {alarm['hint']}",
            err=True,
        )


@contextmanager
def _signals(session: "Session") -> Iterator[list[int]]:
    """First Ctrl-C or SIGTERM: end the run with a complete log; the second: leave at once. Yields those received."""
    received: list[int] = []

    def handle(number: int, _frame: object) -> None:
        if received:
            sys.exit(128 + number)
        received.append(number)
        session.request_stop()

    before = {number: signal.signal(number, handle) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def _progress(quiet: bool) -> Iterator["Progress"]:
    """Yield the progress function: a live line on a terminal, one line per statement elsewhere."""
    if quiet:
        yield lambda statement, time_us: None
        return
    if not sys.stderr.isatty():
        shown: list[StatementRun] = []

        def print_line(statement: "StatementRun", time_us: int) -> None:
            if not shown or shown[-1] is not statement:
                shown.append(statement)
                typer.echo(_status(statement, time_us), err=True)

        yield print_line
        return
    from rich.console import Console

    with Console(stderr=True).status("starting") as status:
        yield lambda statement, time_us: status.update(_status(statement, time_us))


def _status(statement: "StatementRun", time_us: int) -> str:
    number = statement.number if statement.number is not None else statement.line
    return f"{time_us / 1e6:9.3f} s  line {number:<4} {statement.text}"
