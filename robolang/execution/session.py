"""A run: a program on the controller and its plant, from power-up to its report and log.

Before anything moves the whole program is planned once (``motion_check``), so a plannable fault is found while the arm
stands still; the plans are kept for the run.
"""

from collections.abc import Callable
from pathlib import Path

from robolang.core.diagnostics import Diagnostic, Severity, render
from robolang.execution.alarms import as_diagnostic
from robolang.execution.controller_target import ControllerTarget
from robolang.execution.executor import Alter, Executor
from robolang.execution.log_meta import meta_of
from robolang.execution.measures import Measures
from robolang.execution.observer import Observer
from robolang.execution.plan_memory import PlanMemory
from robolang.execution.report import build_report
from robolang.execution.result import RunRecord, RunResult, StatementRun
from robolang.execution.rig import Rig
from robolang.execution.status import ENDED
from robolang.execution.world import RobotWorld
from robolang.logs.log import Log
from robolang.logs.not_kept import NotKept
from robolang.project.project import Project
from runtime.control.clock import wall_s
from runtime.control.controller import Controller
from runtime.control.spill import Spill


class ProgramError(Exception):
    """A program that must not run; ``diagnostics`` say why, ``planned`` whether planning found it."""

    def __init__(self, project: Project, diagnostics: tuple[Diagnostic, ...], planned: bool = False) -> None:
        super().__init__("\n".join(render(item, project.source) for item in diagnostics))
        self.project = project
        self.diagnostics = diagnostics
        self.planned = planned


_CYCLES = 100
"""Cycles between two checks whether the program has ended; a stop is taken in each cycle."""


class Session:
    """One run of one project. ``executor`` carries it out: use it to pause, feed or take back what ``run`` would do."""

    def __init__(
        self,
        project: Project,
        *,
        physics: bool = True,
        realtime: bool = False,
        observer: Observer | None = None,
        alter: Alter | None = None,
        plans: PlanMemory | None = None,
        log: Path | bool = True,
        most_us: int | None = None,
    ) -> None:
        """``plans`` are those of the check before the run: what begins as it did there is not planned again.

        ``log``: whether the log is kept; what is old of it goes into a temporary file, a folder says where. False: the
        report alone is made, the signals cannot be read (RBL822), and nothing can be taken back. ``most_us``: the
        longest simulated time, us (RBL509); None: that of ``run_bounds``.
        """
        if not project.ok:
            raise ProgramError(project, project.diagnostics)
        self.project = project
        self.running = False
        """Whether the program runs or the arm still stops."""
        plans = plans or PlanMemory(project)
        controller = Rig.of(project, physics, realtime=realtime, plans=plans).controller
        self.record = RunRecord(project=project, controller=controller, physics=physics)
        self._measures = Measures(self.record)
        if isinstance(log, Path):
            controller.recorder.spill = Spill(log)
        if log is False:
            controller.recorder.fold = self._measures.take
        observer = observer or Observer()
        target = ControllerTarget(self.record, plans.kinematics, observer)
        self.executor = Executor(project, target, alter=alter, observer=observer, most_us=most_us)

    @property
    def controller(self) -> Controller:
        """The controller of the run."""
        return self.record.controller

    @property
    def world(self) -> RobotWorld:
        """What the program reads of robot and cell."""
        return self.executor.world

    def request_stop(self) -> None:
        """Request a controlled stop from the next cycle on; safe to call from a signal handler."""
        self.executor.stop()

    def request_halt(self) -> None:
        """Request the end of the run at the next cycle, at once (category 0); safe to call from a signal handler."""
        self.executor.halt()

    def run(self, drive: Callable[[], None] | None = None) -> RunResult:
        """Execute the program to its end, a fault or a stop; the log is complete in every case.

        ``drive`` advances ``executor`` to its end; None: without a pause.
        """
        started = wall_s()
        self.running = True
        (drive or self._advance)()
        self.running = False
        return self.result(wall_s() - started)

    def _advance(self) -> None:
        while self.executor.advance(_CYCLES).state not in ENDED:
            pass

    def result(self, wall_s: float) -> RunResult:
        """Return what has become of the run so far, which took ``wall_s`` seconds of wall time; the run may go on."""
        # touches are complete at the end of a run: those up to now are in the result, and not kept
        before = list(self.controller.warnings)
        # first: the report lists the warnings
        self.controller.warn_of_touches()
        recorder = self.controller.recorder
        recorded = recorder.recorded()
        report = build_report(self.record, self._measures.complete(recorded), wall_s)
        # what was dropped must not look like a short log
        rows = recorded if recorder.fold is None else NotKept()
        log = Log(rows, meta_of(self.record, self.world.signals, report))
        alarms, warnings = (
            tuple(as_diagnostic(alarm, severity) for alarm in found)
            for found, severity in (
                (self.record.alarms, Severity.ERROR),
                (self.controller.warnings, Severity.WARNING),
            )
        )
        self.controller.warnings[:] = before
        return RunResult(ok=not alarms, alarms=alarms, warnings=warnings, report=report, log=log)


__all__ = ["ProgramError", "RunResult", "Session", "StatementRun"]
