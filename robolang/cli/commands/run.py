"""``robolang run PROG``: a program on the controller and the physics, with progress, a table and files to keep.

Progress, warnings and errors go to stderr, the table to stdout. Output files are tried before the run.

Exit codes: 0; 3 the run ended with an alarm; with ``--strict`` 1 where it ended well and there were warnings.
``--quiet`` leaves warnings out, but not with ``--strict``: what makes the exit code 1 is shown.
"""

import os
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from robolang.cli import servo_options as o
from robolang.cli.errors import DIAGNOSTICS, MOTION, reader_may_leave, reported, say
from robolang.cli.refuse import refuse
from robolang.cli.values import OptionValueError

if TYPE_CHECKING:
    from robolang.core.diagnostics import Diagnostic
    from robolang.execution.session import RunResult, Session
    from robolang.project.project import Project


_MOST_SHOWN = 3
"""Warnings of one code that are printed for one statement; a loop may raise thousands. The report has all."""


def run(
    program: Annotated[str, typer.Argument(metavar="PROG", help="Program file (.rbl).")],
    cell: Annotated[str | None, typer.Option(help="Cell file (.toml); default: the one beside the program.")] = None,
    robot: Annotated[str | None, typer.Option(help="Built-in robot or robot file, in place of the cell's.")] = None,
    profile: o.ProfileFile = None,
    servo: o.Servo = None,
    fixed_at: o.FixedAt = None,
    coupling: o.Coupling = None,
    feedforward: o.Feedforward = None,
    load_mode: o.LoadMode = None,
    servo_period: o.ServoPeriod = None,
    compensation: o.Compensation = None,
    settings: o.Set = None,
    no_physics: Annotated[bool, typer.Option("--no-physics", help="Ideal arm instead of MuJoCo.")] = False,
    realtime: Annotated[bool, typer.Option("--realtime", help="Keep wall time.")] = False,
    report: Annotated[Path | None, typer.Option(help="Write the report as JSON.")] = None,
    log: Annotated[Path | None, typer.Option(help="Write every signal: .npz (numpy) or .mcap (log viewers).")] = None,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 1 when the run has warnings.")] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", help="Print nothing but errors, and warnings only with --strict.")
    ] = False,
) -> None:
    """Run a program on the controller and the physics."""
    options = o.controller_options(
        servo=servo,
        fixed_at=fixed_at,
        coupling=coupling,
        feedforward=feedforward,
        load_mode=load_mode,
        servo_period=servo_period,
        settings=settings,
        compensation=compensation,
    )
    with reported():
        _check_outputs(program, report, log)
        from robolang.project.project import load_project

        with _handled(_left_before_motion):
            project = load_project(program, cell, robot, profile=profile, options=options)
            from robolang.execution.plan_memory import PlanMemory

            plans = PlanMemory(project)
            warned = refuse(project, warnings=strict or not quiet, plans=plans)
        from robolang.cli.run_progress import shown
        from robolang.execution.session import Session

        with shown(quiet) as progress:
            session = Session(project, physics=not no_physics, realtime=realtime, observer=progress, plans=plans)
            with _signals(session) as stopped:  # until the files are written: a signal must not cut them off
                result = session.run()
                code = _write(result, report, log)
        if not quiet:
            from robolang.cli.run_table import print_result

            with reader_may_leave():
                print_result(result.report)
        _print_alarms(project, result, warnings=strict or not quiet)
    if stopped and not code:
        code = 128 + stopped[0]
    if code or not result.ok:
        raise typer.Exit(code or MOTION)
    if strict and (warned or result.warnings):
        raise typer.Exit(DIAGNOSTICS)


def _check_outputs(program: str, report: Path | None, log: Path | None) -> None:
    """Refuse outputs of a wrong kind or that would overwrite an input or each other, and try to write them."""
    if log is not None and log.suffix not in (".npz", ".mcap"):
        raise OptionValueError("--log", f"'{log}' must end in .npz or .mcap")
    if report is not None and report.suffix in (".rbl", ".toml"):
        raise OptionValueError("--report", f"'{report}' would be a program or a cell file; name a .json file")
    taken = {os.path.realpath(program)}
    for option, path in (("--report", report), ("--log", log)):
        if path is None:
            continue
        if os.path.realpath(path) in taken:
            raise OptionValueError(option, f"'{path}' is the program or another output of this run")
        taken.add(os.path.realpath(path))
    from robolang.core.storage import check_writable

    for path in (report, log):
        if path is not None:
            check_writable(path)


def _write(result: "RunResult", report: Path | None, log: Path | None) -> int:
    """Write the files that were asked for; what cannot be written is said and does not keep the other from it."""
    from robolang.core.storage import write_json
    from robolang.execution.runlog import write_log
    from runtime.core.faults import Fault

    writers: list[tuple[Path | None, Callable[[Path], None]]] = [
        (report, lambda path: write_json(path, result.report)),
        (log, lambda path: write_log(path, result.log)),
    ]
    code = 0
    for path, write in writers:
        if path is not None:
            try:
                write(path)
            except Fault as fault:
                code = say(fault)
    return code


def _print_alarms(project: "Project", result: "RunResult", *, warnings: bool) -> None:
    """Print what went wrong in a run at its statements; of the same code at one of them the first ``_MOST_SHOWN``."""
    report: Any = result.report
    counts = Counter((item.code, item.span) for item in result.warnings)
    shown: Counter[object] = Counter()
    for item, row in zip(result.warnings, report["warnings"], strict=True) if warnings else ():
        key = item.code, item.span
        shown[key] += 1
        if shown[key] <= _MOST_SHOWN:
            more = counts[key] - _MOST_SHOWN if shown[key] == _MOST_SHOWN else 0
            _print_at(project, item, f"at {row['time_s']:.3f} s{f', and {more} more times here' if more > 0 else ''}")
    for item, row in zip(result.alarms, report["alarms"], strict=True):
        _print_at(project, item, f"at {row['time_s']:.3f} s")


def _print_at(project: "Project", item: "Diagnostic", when: str) -> None:
    from robolang.core.diagnostics import render

    typer.echo(render(replace(item, message=f"{when}: {item.message}"), project.source), err=True)


@contextmanager
def _signals(session: "Session") -> Iterator[list[int]]:
    """First Ctrl-C or SIGTERM: controlled stop; the second: stop at once; both with a complete log.

    A signal too many, or a second one when the arm already stands, leaves at once. Yields those received.
    """
    received: list[int] = []

    def handle(number: int, _frame: object) -> None:
        received.append(number)
        if len(received) == 1:
            session.request_stop()
        elif len(received) == 2 and session.running:
            session.request_halt()
        else:
            sys.exit(128 + number)

    with _handled(handle):
        yield received


def _left_before_motion(number: int, _frame: object) -> None:
    """End the command while the program is read and its motion checked: there is nothing to stop and no log yet."""
    name = signal.Signals(number).name
    typer.echo(f"stopped by {name} before the program began: nothing has moved, no file was written", err=True)
    sys.exit(128 + number)


@contextmanager
def _handled(handle: Callable[[int, object], None]) -> Iterator[None]:
    """Have SIGINT and SIGTERM handled."""
    before = {number: signal.signal(number, handle) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
