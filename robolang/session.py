"""A run: the interpreter's effects carried out, one at a time, by a controller over a plant.

The session is the only place that resumes the interpreter. A statement ends when its effect has: a MOVE when the
command has come to rest and the arm is in position, a HAND after its dwell, a LOAD at once. Before anything moves,
the whole program is planned once (``motion_check``), so a plannable fault is found while the arm stands still.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from robolang import lowering
from robolang.diagnostics import Diagnostic, render
from robolang.effects import Effect, MoveTo, SetHand, SetPayload, SetSeam
from robolang.interpreter import execute
from robolang.nodes import Program
from robolang.printer import describe
from robolang.project import Project, load_project
from robolang.report import build_report
from robolang.result import RunRecord, RunResult, StatementRun
from runtime.clock import PacedClock, VirtualClock, wall_s
from runtime.controller import Controller
from runtime.faults import Fault
from runtime.motion.seam import SeamTracker
from runtime.plant.plant import Plant
from runtime.plant.seam_sensor import SeamSensor
from runtime.profile import ServoMode
from runtime.robot.kinematics import Kinematics
from runtime.units import MM


class ProgramError(Exception):
    """A program that must not run; ``diagnostics`` say why, ``planned`` whether planning found it."""

    def __init__(self, project: Project, diagnostics: tuple[Diagnostic, ...], planned: bool = False) -> None:
        super().__init__("\n".join(render(item, project.source) for item in diagnostics))
        self.project = project
        self.diagnostics = diagnostics
        self.planned = planned


Progress = Callable[[StatementRun, int], None]
"""Told of the running statement and the simulated time in us: at its start, and every few cycles."""

Effects = Callable[[Program], Iterator[Effect]]
"""Yields the effects of a program: the interpreter, or one that changes what the program declares (``compare``)."""

LAMPS = ("", "WRIST", "WRIST HOLD")
"""What the lamp shows by ``wrist_mode``."""

_PROGRESS_CYCLES = 25

MAX_RUN_US = 1_800_000_000
"""Longest run, us of simulated time: about a kilobyte of log is kept for every tick."""


class Session:
    """One run of one project."""

    def __init__(self, project: Project, *, physics: bool = True, realtime: bool = False,
                 progress: Progress | None = None, effects: Effects = execute) -> None:  # fmt: skip
        if not project.ok:
            raise ProgramError(project, project.diagnostics)
        self.project = project
        self._effects = effects
        self._progress = progress or (lambda statement, time_us: None)
        self._stop_requested = self._halt_requested = False
        self._tracker: SeamTracker | None = None
        self.running = False
        """Whether the program runs or the arm still stops."""
        cell, profile = project.cell, project.profile
        known = profile.supervision.friction
        friction = (1.0 if known is None else known) if physics else 0.0
        profile = replace(profile, supervision=replace(profile.supervision, friction=friction))
        if not physics:  # the ideal arm has no friction and no gear springs, so there is nothing to compensate
            servo = replace(profile.servo, friction_compensation=0.0, spring_compensation=0.0, gravity_lead=0.0)
            profile = replace(profile, servo=servo)
        self._kinematics = Kinematics(cell.robot)
        clock = PacedClock(profile.period_us) if realtime else VirtualClock()
        self.controller = Controller(
            cell.robot, make_plant(project, physics), profile, cell.hand.X_flange_tool, clock, self._kinematics
        )
        self.record = RunRecord(project=project, controller=self.controller, physics=physics)

    def request_stop(self) -> None:
        """Ask the run for a controlled stop from the next cycle on; safe to call from a signal handler."""
        self._stop_requested = True

    def request_halt(self) -> None:
        """Ask the run to end at the next cycle, at once (category 0); safe to call from a signal handler."""
        self._stop_requested = self._halt_requested = True

    def run(self) -> RunResult:
        """Execute the program to its end, a fault or a stop; the log is complete in every case."""
        started = wall_s()
        self.running = True
        for effect in self._effects(self.project.program):
            if not self._run_statement(effect):
                break
        self.running = False
        log = self.controller.recorder.signals(self.controller.tool_poses)
        report = build_report(self.record, log, wall_s() - started)
        return RunResult(ok=not self.controller.alarms, report=report, log=log)

    def _run_statement(self, effect: Effect) -> bool:
        controller = self.controller
        run = StatementRun(
            line=effect.line, number=effect.number, text=describe(effect.node), first_tick=controller.recorder.tick
        )
        self.record.statements.append(run)
        controller.line = effect.number if effect.number is not None else effect.line
        self._progress(run, controller.time_us)
        try:
            for _ in self._carry_out(effect, run):
                if self._stop_requested or not controller.cycle() or controller.alarms:
                    break
                if controller.time_us >= MAX_RUN_US:
                    controller.alarm("RBL509", f"the run has lasted {MAX_RUN_US / 1e6:g} s of simulated time")
                if controller.recorder.cycle % _PROGRESS_CYCLES == 0:
                    self._progress(run, controller.time_us)
        except Fault as fault:
            controller.alarm(fault.code, fault.message)
        if self._stop_requested and not controller.alarms:
            controller.alarm("RBL530", "the run was stopped from outside")
        if controller.alarms:
            self._come_to_rest()
        run.end_tick = controller.recorder.tick
        return not controller.alarms

    def _come_to_rest(self) -> None:
        """Let the controlled stop run to its end, unless it has to end at once."""
        controller = self.controller
        while not controller.halted:
            if self._halt_requested:
                controller.halt()
            controller.cycle()

    def _carry_out(self, effect: Effect, run: StatementRun) -> Iterator[None]:
        """Start an effect and yield once for every cycle it needs."""
        if isinstance(effect, SetPayload):
            self._load(effect)
        elif isinstance(effect, MoveTo):
            yield from self._move(effect, run)
        elif isinstance(effect, SetHand):
            yield from self._hand(effect, run)
        elif isinstance(effect, SetSeam):
            self._seam(effect)

    def _load(self, effect: SetPayload) -> None:
        payload = lowering.payload(effect, self.project.cell)
        self.controller.load(payload)
        self.record.payloads.append(
            {
                "time_s": self.controller.time_us / 1_000_000,
                "line": self.controller.line,
                "mass_kg": payload.mass,
                "cog_mm": [float(x) for x in np.round(payload.cog / MM, 9)],
            }
        )

    def _seam(self, effect: SetSeam) -> None:
        """SEAM ON and OFF; the setting of WRIST is in each MOVE and needs nothing here."""
        self._tracker = None
        if effect.sensor is not None:
            spec = {name.upper(): each for name, each in self.project.cell.sensors.items()}[effect.sensor]
            read = SeamSensor(spec).read
            self._tracker = SeamTracker(effect.sensor, spec.limits, self.project.profile.period_s, read)
        self.controller.seam(self._tracker)

    def _move(self, effect: MoveTo, run: StatementRun) -> Iterator[None]:
        controller, profile = self.controller, self.project.profile
        command = lowering.move(effect, self.project.points, self.project.cell, self._kinematics)
        plan = controller.move(command)
        run.path = plan.path
        run.planned_s = (len(plan.q) - 1) * profile.period_us / 1_000_000
        run.notes += plan.notes
        run.wrist, run.seam = plan.wrist, self._tracker
        lost = 0 if run.seam is None else run.seam.lost
        while controller.moving:
            yield
            run.lamp = LAMPS[controller.wrist_mode]
            run.lost = 0 if run.seam is None else run.seam.lost - lost
        waited_us = 0
        while not controller.position_error <= profile.in_position:
            if waited_us >= profile.settle_timeout_us:
                error = np.degrees(controller.position_error)
                run.notes.append(f"RBL523 not in position: {error:.3f} deg left after {waited_us / 1e6:g} s")
                return
            waited_us += profile.period_us
            yield

    def _hand(self, effect: SetHand, run: StatementRun) -> Iterator[None]:
        self.controller.hand(effect.closed)
        wait_us = round(lowering.dwell_s(effect, self.project.cell) * 1e6)
        for _ in range(0, wait_us, self.project.profile.period_us):
            yield
        holding = self.controller.plant.hand().holding
        if effect.closed:
            run.notes.append(f"holds '{holding}'" if holding else "closed on nothing")


def make_plant(project: Project, physics: bool) -> Plant:
    """Return the plant of a run: MuJoCo, or the ideal arm."""
    cell, tick_s = project.cell, project.profile.tick_s
    if physics:
        from runtime.plant.mujoco_plant import MujocoPlant

        return MujocoPlant(cell.robot, cell, tick_s)
    from runtime.plant.rigid_plant import RigidPlant

    return RigidPlant(cell.robot, cell, tick_s)


def run(program: Path | str, *, cell: Path | str | None = None, robot: str | None = None,
        servo: ServoMode | None = None, physics: bool = True, realtime: bool = False,
        progress: Progress | None = None) -> RunResult:  # fmt: skip
    """Run a program file and return its result.

    ``cell``, ``robot`` and ``servo`` replace what the files beside the program say (see ``project``); ``physics``
    False runs on the ideal arm without MuJoCo; ``realtime`` keeps wall time; ``progress`` is told where the run is.

    Raises ``ProgramError`` when the program has errors or a move cannot be planned, ``FileFault`` or ``Fault`` when a
    file cannot be used: in all these cases nothing has moved. A fault while running gives ``ok = False``.
    """
    from robolang.motion_check import motion_check

    project = load_project(program, cell, robot, servo)
    if not project.ok:
        raise ProgramError(project, project.diagnostics)
    refused = motion_check(project)
    if refused:
        raise ProgramError(project, refused, planned=True)
    return Session(project, physics=physics, realtime=realtime, progress=progress).run()


__all__ = ["ProgramError", "Progress", "RunResult", "Session", "StatementRun", "make_plant", "run"]
