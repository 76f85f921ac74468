"""``robolang run PROG``: a program on the controller and the physics, with progress, a table and files to keep.

Progress, warnings and errors go to stderr, the table to stdout. Output files are opened before the run.
``--quiet`` leaves warnings out, but not with ``--strict``: what makes the exit code 1 is shown.
"""

import json
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolang.cli.controller_settings import settings_of
from robolang.cli.errors import DIAGNOSTICS, MOTION, STORAGE, reported, say
from robolang.cli.live_options import FollowOptions, check_follow, followed, pages_of, remain
from robolang.cli.options import CellOptions, RunControllerOptions, RunProgram
from robolang.cli.output import echo, show_finding
from robolang.cli.outputs import check_outputs
from robolang.cli.refuse import refuse
from robolang.cli.rewrite import read
from robolang.cli.run_options import OutputOptions, RunOptions
from robolang.cli.signals import handled
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.cli.refuse import Accepted
    from robolang.core.diagnostics import Diagnostic
    from robolang.execution.outlook import PlannedStep
    from robolang.execution.plan_memory import PlanMemory
    from robolang.execution.session import RunResult, Session
    from robolang.project.project import Project


_MOST_SHOWN = 3
"""Warnings of one code that are printed for one statement; a loop may raise thousands. The report has all."""


def run(
    program: RunProgram,
    files: CellOptions,
    controller: RunControllerOptions,
    simulation: RunOptions,
    output: OutputOptions,
    follow: FollowOptions,
) -> None:
    """Run a program on the controller and the simulated arm.

    Example: robolang run pick_and_place.rbl --log run.npz --html run.html

    Exit codes: 0 done; 1 the program has errors, with --strict also warnings; 2 a file or an option cannot be used; 3 a
    move was refused, or the run ended with an alarm; 4 a file cannot be written; 130 or 143 stopped by a signal.
    """
    settings = settings_of(controller)
    with reported():
        # the program first: where it is misspelt, its files have the wrong names, too
        analysis = read(program)
        _check_outputs(program, files, output)
        check_follow(follow)
        if simulation.until_line is not None and follow.view:
            raise OptionValueError("--until-line", "a page that follows the run pauses it; leave out --view")
        from robolang.project.project import load_project

        # planning a long program takes its time, and there is no session yet that a signal could stop
        with _before_motion():
            project = load_project(analysis, files.cell, files.robot, profile=controller.profile, options=settings)
            from robolang.execution.plan_memory import PlanMemory

            plans = PlanMemory(project)
            accepted = _accepted(project, plans, simulation, output)
        with _ran(project, plans, accepted.steps, simulation, output, follow) as (result, ended, code):
            code = code or _code_of(result, output, warned=accepted.warned)
            _print(project, result, output)
            if not output.quiet and not output.as_json:
                from robolang.cli.verdict import verdict

                echo(verdict(result, ended, code))
    if code:
        raise SystemExit(code)


def _accepted(project: "Project", plans: "PlanMemory", simulation: RunOptions, output: OutputOptions) -> "Accepted":
    """Return what is known of a program that may run; leave with what is wrong of one that may not."""
    if simulation.until_line is not None:
        from robolang.analysis.named_lines import stop_of

        # a line that is none is found before the motion is planned
        stop_of(project.analysis, simulation.until_line)
    try:
        return refuse(project, warnings=output.warnings, plans=plans, most_us=simulation.most_us)
    except SystemExit:
        if not output.quiet:
            from robolang.cli.verdict import REFUSED

            echo(REFUSED, err=True)
        raise


@contextmanager
def _ran(
    project: "Project",
    plans: "PlanMemory",
    steps: "tuple[PlannedStep, ...]",
    simulation: RunOptions,
    output: OutputOptions,
    follow: FollowOptions,
) -> "Iterator[tuple[RunResult, str, int]]":
    """Run the program and write its files; yield the result, how it ended, and the exit code of a file or a
    signal, or 0.

    Pages of a live view that are still there then show the end of the run.
    """
    from robolang.cli.run_progress import shown
    from robolang.execution.observer import Observers
    from robolang.execution.session import Session

    pages = pages_of(follow)
    with ExitStack() as serving:
        with shown(output.quiet, steps) as progress:
            observer = progress if pages is None else Observers(progress, pages.frames)
            # old rows beside the log or the page, where there must be room anyway; a live page may ask for them, too
            beside = output.log or output.html
            kept = pages is not None if beside is None else beside.absolute().parent
            physics, realtime = not simulation.no_physics, simulation.realtime
            session = Session(
                project,
                physics=physics,
                realtime=realtime,
                observer=observer,
                plans=plans,
                log=kept,
                most_us=simulation.most_us,
            )
            session.record.kept_for = _kept_for(output, follow)
            progress.err = output.as_json
            progress.follow(session.controller)
            # a page is waited for
            with _before_motion():
                run_session = serving.enter_context(followed(session, pages, follow))
            if simulation.until_line is not None:
                run_session = _until(session, simulation.until_line)
            # until the files are written: a signal must not cut them off
            with _signals(session) as stopped:
                result = run_session()
                code = _write(result, output)
        yield result, _ended(session, simulation), code or (128 + stopped[0] if stopped else 0)
        if pages is not None and not stopped:
            remain(pages)


def _kept_for(output: OutputOptions, follow: FollowOptions) -> str:
    """Return the options for which what is recorded is kept, in words."""
    given = {"--log": output.log is not None, "--html": output.html is not None, "--view": follow.view}
    return " and ".join(name for name, one in given.items() if one)


def _until(session: "Session", line: str) -> "Callable[[], RunResult]":
    """Return what runs a session until a line is due."""
    from robolang.analysis.named_lines import stop_of
    from robolang.execution.stepping import run_to

    row = stop_of(session.project.analysis, line)
    return lambda: session.run(lambda: run_to(session.executor, row))


def _ended(session: "Session", simulation: RunOptions) -> str:
    """Return how a run ended, in words."""
    from robolang.execution.status import State

    status, line = session.executor.status, simulation.until_line
    if status.state is State.PAUSED:
        return f"ended before line {line}"
    if session.record.alarms:
        return f"ended with {session.record.alarms[0].code}"
    return "ran to its end" if line is None else f"ran to its end, never to line {line},"


def _check_outputs(program: str, files: CellOptions, output: OutputOptions) -> None:
    """Refuse outputs of a wrong kind or that would overwrite an input or each other, and try to write them."""
    report, log, html = output.report, output.log, output.html
    if html is not None and html.suffix != ".html":
        raise OptionValueError("--html", f"'{html}' must end in .html")
    if log is not None and log.suffix not in (".npz", ".mcap"):
        raise OptionValueError("--log", f"'{log}' must end in .npz or .mcap")
    # a slip in the order of the words must not cost a program: it is there only once
    if report is not None and report.suffix in (".rbl", ".toml"):
        raise OptionValueError("--report", f"'{report}' would be a program or a cell file; name a .json file")
    check_outputs({"--report": report, "--log": log, "--html": html}, [program, files.cell, files.robot])


def _code_of(result: "RunResult", output: OutputOptions, *, warned: bool) -> int:
    """Return the exit code of a run; ``warned``: there were warnings before it."""
    if any(alarm.code == "RBL706" for alarm in result.alarms):
        return STORAGE
    if not result.ok:
        return MOTION
    return DIAGNOSTICS if output.strict and (warned or result.warnings) else 0


def _write(result: "RunResult", output: OutputOptions) -> int:
    """Write report, log and page, each of them even if another cannot be written; return the exit code."""
    from robolang.core.storage import write_json
    from robolang.logs.files import write_log
    from runtime.core.faults import Fault

    writers: list[tuple[Path | None, Callable[[Path], None]]] = [
        (output.report, lambda path: write_json(path, result.report)),
        (output.log, lambda path: write_log(path, result.log)),
        (output.html, lambda path: _write_page(path, result)),
    ]
    code = 0  # a full disk takes the log, and may still take the report
    for path, write in writers:
        if path is not None:
            try:
                write(path)
            except Fault as fault:
                code = say(fault)
    return code


def _write_page(path: Path, result: "RunResult") -> None:
    from robolang.view.page import Bundle, write_page
    from robolang.view.run_page import pack_run

    name = str(result.log.needed_meta()["program"]["name"])
    write_page(path, [pack_run(result.log, name)], Bundle.installed())


def _print(project: "Project", result: "RunResult", output: OutputOptions) -> None:
    """Print the table or the report, then what went wrong."""
    if output.as_json:
        from robolang.core.storage import strict

        # one line: a report of a long program is for programs to read
        echo(json.dumps(strict(result.report), ensure_ascii=False, allow_nan=False))
    elif not output.quiet:
        from robolang.cli.run_table import print_result

        print_result(result.report, every=output.every, worst=output.worst)
    _print_alarms(project, result, warnings=output.warnings)


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

    show_finding(render(item.replaced(message=f"{when}: {item.message}"), project.source))


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

    with handled(handle):
        yield received


@contextmanager
def _before_motion() -> Iterator[None]:
    """While the program is read and its motion checked a signal ends the command: nothing to stop, and no log yet."""
    received: list[int] = []

    def leave(number: int, _frame: object) -> None:
        received.append(number)
        sys.exit(128 + number)

    try:
        with handled(leave):
            yield
    finally:
        # not within the handler: the signal may have come while this stream was being written
        for number in received[:1]:
            name = signal.Signals(number).name
            echo(f"stopped by {name} before the program began: nothing has moved, no file was written", err=True)
