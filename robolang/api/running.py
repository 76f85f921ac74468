"""What a program does: planned, or run on the controller and the arm."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Unpack

from robolang.analysis.named_lines import stop_of
from robolang.core import tables
from robolang.core.calls import checked, refuse
from robolang.core.diagnostics import Diagnostic
from robolang.execution.dry_run import rehearse
from robolang.execution.observer import Observer
from robolang.execution.plan_memory import PlanMemory
from robolang.execution.result import RunResult
from robolang.execution.session import ProgramError, Session
from robolang.execution.stepping import run_to
from robolang.planning.line_times import LineTime, line_times
from robolang.project.arguments import Files, PathLike
from robolang.project.project import Project


def read_project(program: PathLike | Project, files: Files) -> Project:
    """Return a project, read with ``Project.load`` unless it is one; then it takes no files (``Fault`` RBL703)."""
    if not isinstance(program, Project):
        return Project.load(program, **files)
    given = next((name for name, value in files.items() if value is not None), None)
    if given is not None:
        refuse(given, "a project has its files and settings already")
    return program


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """What a program will do, planned without physics, as ``robolang check --motion`` plans it.

    ``ok``: nothing keeps it from being run; else ``refused`` says what. ``lines``: what each line takes. ``seconds``:
    the cycle time, s, up to what is refused.
    """

    ok: bool
    seconds: float
    lines: tuple[LineTime, ...]
    refused: tuple[Diagnostic, ...]

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` with a row for each line; ``ImportError`` without pandas."""
        return tables.to_pandas(self._columns())

    def to_polars(self) -> Any:
        """Return a ``polars.DataFrame`` with a row for each line; ``ImportError`` without polars."""
        return tables.to_polars(self._columns())

    def _columns(self) -> dict[str, list[Any]]:
        return {name: [getattr(line, name) for line in self.lines] for name in LineTime.__dataclass_fields__}


@checked
def plan(
    program: PathLike | Project,
    *,
    max_time_s: float | None = None,
    **files: Unpack[Files],
) -> Plan:
    """Plan a program without moving anything: does it reach, and how long does it take?

    Raises ``ProgramError`` for a text with errors, ``FileFault`` or ``Fault`` for what cannot be used.
    """
    read = _runnable(read_project(program, files))
    rehearsal = rehearse(read, most_us=_most_us(max_time_s), every_round=max_time_s is not None)
    return Plan(
        ok=not rehearsal.preventing,
        seconds=rehearsal.total_us / 1e6,
        lines=tuple(line_times(read, rehearsal)),
        refused=rehearsal.preventing,
    )


@checked
def run(
    program: PathLike | Project,
    *,
    physics: bool = True,
    realtime: bool = False,
    log: bool | Path = True,
    max_time_s: float | None = None,
    until_line: int | str | None = None,
    observer: Observer | None = None,
    **files: Unpack[Files],
) -> RunResult:
    """Run a program on the controller and the arm, and return its result.

    Args:
        program: a program file, or a project.
        physics: whether the arm is that of MuJoCo; False: the ideal one.
        realtime: whether the run keeps to wall time.
        log: whether signals are kept; a folder holds what does not fit in memory. False: the report alone is made.
        max_time_s: the simulated time, s, after which the run ends with RBL509; None: a run of more than 1800 s is
            refused.
        until_line: the run ends before this line: its number, or a label as ``"*NAME"``.
        observer: sees what happens, when it happens.
        **files: ``cell``, ``robot``, ``profile``, ``settings`` and ``servo`` replace what the files beside the program
            say.

    Raises ``ProgramError`` when the program has errors or a move cannot be planned, ``FileFault`` or ``Fault`` when a
    file or an argument cannot be used: in all these cases nothing has moved. A fault while running gives ``ok`` False.
    """
    read, most_us = _runnable(read_project(program, files)), _most_us(max_time_s)
    # before the planning, which takes its time
    row = None if until_line is None else stop_of(read.analysis, str(until_line))
    plans = PlanMemory(read)
    rehearsal = rehearse(read, plans=plans, most_us=most_us, every_round=most_us is not None)
    refused = rehearsal.preventing_within(most_us)
    if refused:
        raise ProgramError(read, refused, planned=True)
    session = Session(
        read, physics=physics, realtime=realtime, observer=observer, plans=plans, log=log, most_us=most_us
    )
    return session.run(None if row is None else lambda: run_to(session.executor, row))


def _runnable(read: Project) -> Project:
    if not read.ok:
        raise ProgramError(read, read.diagnostics)
    return read


def _most_us(seconds: float | None) -> int | None:
    if seconds is None:
        return None
    # written so that NaN is refused too
    most = seconds * 1e6
    if not 1.0 <= most < math.inf:
        refuse("max_time_s", f"{seconds:g} s is no time that a run can take")
    return round(most)
