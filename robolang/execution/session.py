"""A run: the interpreter's effects carried out, one at a time, by a controller over a plant.

The session is the only place that resumes the interpreter. A statement ends when its effect has: a MOVE when the
command has come to rest and the arm is in position, a HAND after its dwell, a LOAD at once. Before anything moves,
the whole program is planned once (``motion_check``), so a plannable fault is found while the arm stands still.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from robolang.core.diagnostics import Diagnostic, Severity, render
from robolang.core.source import Span
from robolang.execution import lowering
from robolang.execution.alarms import as_diagnostic
from robolang.execution.dry_run import MAX_CHAIN, MAX_RUN_US, motion_check
from robolang.execution.plan_findings import PlanFindings, PlannedMove
from robolang.execution.plan_memory import PlanMemory
from robolang.execution.report import build_report
from robolang.execution.result import RunRecord, RunResult, StatementRun
from robolang.execution.rig import Rig
from robolang.execution.world import RobotWorld
from robolang.interpreter.effects import (
    Drain,
    Effect,
    Halt,
    MoveTo,
    Origin,
    Pass,
    SetHand,
    SetOutput,
    SetPayload,
    SetSeam,
    SetTool,
    SetWrist,
    Show,
)
from robolang.interpreter.machine import Machine
from robolang.interpreter.program_fault import ProgramFault
from robolang.project.project import Project, load_project
from robolang.syntax.ast import Wait
from robolang.syntax.unparse import describe
from runtime.cell.seam_sensor import SeamSensor
from runtime.control.clock import wall_s
from runtime.core.faults import Fault
from runtime.core.units import MM
from runtime.motion.commands import Command
from runtime.motion.motion_planner import ChainPlan
from runtime.motion.seam import SeamTracker
from runtime.settings.profile import ServoMode


class ProgramError(Exception):
    """A program that must not run; ``diagnostics`` say why, ``planned`` whether planning found it."""

    def __init__(self, project: Project, diagnostics: tuple[Diagnostic, ...], planned: bool = False) -> None:
        super().__init__("\n".join(render(item, project.source) for item in diagnostics))
        self.project = project
        self.diagnostics = diagnostics
        self.planned = planned


Progress = Callable[[StatementRun, int], None]
"""Told of the running statement and the simulated time in us: at its start, and every few cycles."""

Alter = Callable[[Effect], Effect | None]
"""Changes what a program asks for before it is carried out, None: leaves it out (``compare``)."""

LAMPS = ("", "WRIST", "WRIST HOLD")
"""What the lamp shows by ``wrist_mode``."""

_PROGRESS_CYCLES = 25


class Session:
    """One run of one project."""

    def __init__(
        self,
        project: Project,
        *,
        physics: bool = True,
        realtime: bool = False,
        progress: Progress | None = None,
        alter: Alter | None = None,
        show: Callable[[str], None] | None = None,
        plans: PlanMemory | None = None,
    ) -> None:
        """``plans`` are those of the check before the run: what begins as it did there is not planned again."""
        if not project.ok:
            raise ProgramError(project, project.diagnostics)
        self.project = project
        self._alter = alter or (lambda effect: effect)
        self._progress = progress or (lambda statement, time_us: None)
        self._show = show or (lambda text: None)
        self._stop_requested = self._halt_requested = False
        self._tracker: SeamTracker | None = None
        self.running = False
        """Whether the program runs or the arm still stops."""
        plans = plans or PlanMemory(project)
        self.controller = Rig.of(project, physics, realtime=realtime, plans=plans).controller
        self.record = RunRecord(project=project, controller=self.controller, physics=physics)
        self.world = RobotWorld(project.points, project.cell, plans.kinematics, lambda: self.controller.time_us)
        self._machine = Machine(project.program, self.world, project.points.names)
        self._chain: list[tuple[MoveTo, Command]] = []
        self._plans = PlanFindings(project, plans.kinematics)
        self._warned: set[tuple[str, Span]] = set()

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
        self._run_program()
        self.running = False
        self.controller.warn_of_touches()
        log = self.controller.recorder.signals(self.controller.tool_poses)
        report = build_report(self.record, log, wall_s() - started)
        alarms, warnings = (
            tuple(as_diagnostic(alarm, severity) for alarm in found)
            for found, severity in (
                (self.controller.alarms, Severity.ERROR),
                (self.controller.warnings, Severity.WARNING),
            )
        )
        return RunResult(ok=not alarms, alarms=alarms, warnings=warnings, report=report, log=log)

    def _run_program(self) -> None:
        """Take one effect after another; a request that cannot be carried out goes back to the program (ON ERROR)."""
        program = self._machine.run()
        fault: Fault | None = None
        while True:
            try:
                effect = next(program) if fault is None else program.throw(fault)
            except StopIteration:
                self._finish_motion()
                return
            except ProgramFault as uncaught:
                if self._finish_motion():
                    self._end_with(uncaught)
                return
            fault = None
            altered = self._alter(effect)
            if altered is None:
                continue
            try:
                if not self._take(altered):
                    return
            except Fault as refused:
                if self.controller.alarms:
                    return
                fault = refused

    def _end_with(self, fault: ProgramFault) -> None:
        self.controller.statement = fault.origin
        self.controller.alarm(fault.code, fault.message, hint=fault.hint, calls=fault.calls)
        self._come_to_rest()

    def _take(self, effect: Effect) -> bool:
        """Carry out an effect, or keep a move that the next one may blend into; False when the run is over."""
        if isinstance(effect, MoveTo):
            return self._move(effect)
        if isinstance(effect, SetWrist):
            return self._run_statement(effect)
        if not self._finish_motion():
            return False
        if isinstance(effect, Drain):
            return True
        return self._run_statement(effect) and not (isinstance(effect, Halt) and effect.word == "STOP")

    # --- motion ------------------------------------------------------------------------------------------------------

    def _move(self, effect: MoveTo) -> bool:
        """Plan a move where the one before ends; it runs at once, or with the next one where it has a zone."""
        command = _without_zone(lowering.move(effect, self.world.around), self._tracker is not None)
        if self._chain or command.zone > 0.0:  # refused here, where the program can answer, and not when it runs
            plan = self.controller.rehearse(self.world.q_last, command)
            self.world.q_last = plan.q[-1]
            self._chain.append((effect, command))
            goes_on = command.zone > 0.0 and len(plan.q) > 1 and len(self._chain) < MAX_CHAIN
            return True if goes_on else self._finish_motion()
        self._chain.append((effect, command))
        return self._finish_motion()

    def _finish_motion(self) -> bool:
        """Run the moves that are kept; False when the run is over."""
        if not self._chain:
            return not self.controller.alarms
        chain, self._chain = self._chain, []
        self.controller.statement = chain[0][0].origin
        plan = self.controller.move_chain([command for _, command in chain], [effect.origin for effect, _ in chain])
        runs = [self._begin(effect) for effect, _ in chain]
        for run, part in zip(runs, plan.parts, strict=True):
            run.path, run.notes = part.path, [*run.notes, *part.notes]
            run.planned_s = part.planned_s
            run.wrist, run.seam, run.begun = part.wrist, self._tracker, False
        self._warn(chain, plan)
        self._cycles(self._follow(runs), *runs)
        self.world.q_last = np.array(self.controller.areas.ina)
        for run in runs:
            run.end_tick = run.end_tick or self.controller.recorder.tick
        return not self.controller.alarms

    def _warn(self, chain: Sequence[tuple[MoveTo, Command]], plan: ChainPlan) -> None:
        """Warn where the motion is not the one that the program states, once for a code and a statement."""
        plans = [part.plan for part in plan.parts]
        rows = zip(chain, plans, (*plan.corners, None), (*plans[1:], None), strict=True)
        for (effect, command), own, corner, after in rows:
            move = PlannedMove(effect=effect, command=command, plan=own, corner=corner, after=after)
            for found in self._plans.of(move):
                if (found.code, effect.span) not in self._warned:
                    self._warned.add((found.code, effect.span))
                    self.controller.warn(found.code, found.message, found.hint, effect.origin)

    def _begin(self, effect: Effect) -> StatementRun:
        run = StatementRun(origin=effect.origin, text=describe(effect.node), first_tick=self.controller.recorder.tick)
        self.record.statements.append(run)
        return run

    def _begin_again(self, effect: Effect) -> StatementRun | None:
        """Return the record of a WAIT that goes on: each of its cycles is an effect."""
        last = self.record.statements[-1] if self.record.statements else None
        if not isinstance(effect.node, Wait) or last is None or last.end_tick != self.controller.recorder.tick:
            return None
        return last if last.origin.span == effect.span else None

    def _follow(self, runs: list[StatementRun]) -> Iterator[None]:
        """Yield once for every cycle of a chain of moves, until the arm is in position."""
        controller, profile = self.controller, self.project.profile
        self._progress(runs[0], controller.time_us)
        lost = 0 if runs[0].seam is None else runs[0].seam.lost
        if not controller.moving:  # it is there already; a loop of such moves takes time all the same
            yield
        while controller.moving:
            yield
            run = self._reach(runs)
            run.lamp = LAMPS[controller.wrist_mode]
            run.lost = 0 if run.seam is None else run.seam.lost - lost
            if controller.recorder.cycle % _PROGRESS_CYCLES == 0:
                self._progress(run, controller.time_us)
        waited_us = 0
        while not controller.position_error <= profile.in_position:
            if waited_us >= profile.settle_timeout_us:
                error = np.degrees(controller.position_error)
                controller.warn("RBL523", f"not in position: {error:.3f} deg left after {waited_us / 1e6:g} s")
                return
            waited_us += profile.period_us
            yield

    def _reach(self, runs: list[StatementRun]) -> StatementRun:
        """Return the move of a chain whose set-point is sent next; it begins when the one before it ends."""
        tick, at = self.controller.recorder.tick, self.controller.chain_index
        runs[0].begun = tick > runs[0].first_tick
        if not runs[at].begun and runs[0].begun:
            for before, run in pairwise(runs[: at + 1]):
                if not run.begun:
                    before.end_tick = run.first_tick = tick
                    run.begun = True
            self._progress(runs[at], self.controller.time_us)
        return runs[at]

    # --- everything else ---------------------------------------------------------------------------------------------

    def _run_statement(self, effect: Effect) -> bool:
        controller = self.controller
        controller.statement = effect.origin
        run = self._begin_again(effect) or self._begin(effect)
        self._progress(run, controller.time_us)
        self._cycles(self._carry_out(effect, run), run)
        run.end_tick = controller.recorder.tick
        return not controller.alarms

    def _cycles(self, each: Iterator[None], *runs: StatementRun) -> None:
        """Run one cycle for every step; stop the arm when it was asked for or an alarm has been raised.

        ``runs``: one statement, or the moves of a chain.
        """
        controller = self.controller
        for _ in each:
            if self._stop_requested or not controller.cycle() or controller.alarms:
                break
            if controller.time_us >= MAX_RUN_US:
                assert isinstance(controller.statement, Origin)
                fault = self._machine.too_long(controller.statement, MAX_RUN_US / 1e6)
                controller.alarm(fault.code, fault.message, hint=fault.hint, statement=fault.origin)
            if controller.recorder.cycle % _PROGRESS_CYCLES == 0 and runs[0].path is None:
                self._progress(runs[0], controller.time_us)
        if runs[0].planned_s is not None:
            self._reach(list(runs))
        if self._stop_requested and not controller.alarms:
            controller.alarm("RBL530", "the run was stopped from outside")
        if controller.alarms:
            self._come_to_rest()

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
        elif isinstance(effect, SetHand):
            yield from self._hand(effect, run)
        elif isinstance(effect, SetSeam):
            self._seam(effect)
        elif isinstance(effect, SetTool):
            self.world.X_flange_tool = lowering.tool(effect.tool, self.project.cell)
            self.controller.use_tool(self.world.X_flange_tool)
        elif isinstance(effect, SetOutput):
            self.world.set_output(effect.output, effect.value, effect.seconds)
        elif isinstance(effect, Pass):
            yield from self._pass(effect.seconds)
        elif isinstance(effect, Show):
            self.record.shown.append((self.controller.time_us / 1_000_000, effect.text))
            self._show(effect.text)
        elif isinstance(effect, Halt):
            stops = effect.word == "STOP"
            run.notes.append("the program stops here" if stops else "nobody is there to wait for: goes on")

    def _pass(self, seconds: float) -> Iterator[None]:
        """Let time pass, at least one cycle."""
        for _ in range(max(1, -(-round(seconds * 1e6) // self.project.profile.period_us))):
            yield

    def _load(self, effect: SetPayload) -> None:
        payload = lowering.payload(effect, self.project.cell)
        self.controller.load(payload)
        self.record.payloads.append(
            {
                "time_s": self.controller.time_us / 1_000_000,
                "line": effect.line,
                "number": effect.number,
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

    def _hand(self, effect: SetHand, run: StatementRun) -> Iterator[None]:
        self.controller.hand(effect.closed)
        wait_us = round(lowering.dwell_s(effect, self.project.cell) * 1e6)
        for _ in range(0, wait_us, self.project.profile.period_us):
            yield
        holding = self.controller.plant.hand().holding
        if effect.closed:
            run.notes.append(f"holds '{holding}'" if holding else "closed on nothing")


def _without_zone(command: Command, tracked: bool) -> Command:
    """Return a command that stops where a seam is followed: nothing blends there."""
    return replace(command, zone=0.0) if tracked and command.zone > 0.0 else command


def run(
    program: Path | str,
    *,
    cell: Path | str | None = None,
    robot: str | None = None,
    servo: ServoMode | None = None,
    physics: bool = True,
    realtime: bool = False,
    progress: Progress | None = None,
) -> RunResult:
    """Run a program file and return its result.

    ``cell``, ``robot`` and ``servo`` replace what the files beside the program say (see ``project``); ``physics``
    False runs on the ideal arm without MuJoCo; ``realtime`` keeps wall time; ``progress`` is told where the run is.

    Raises ``ProgramError`` when the program has errors or a move cannot be planned, ``FileFault`` or ``Fault`` when a
    file cannot be used: in all these cases nothing has moved. A fault while running gives ``ok = False``.
    """
    project = load_project(program, cell, robot, servo)
    if not project.ok:
        raise ProgramError(project, project.diagnostics)
    plans = PlanMemory(project)
    refused = motion_check(project, plans)
    if refused:
        raise ProgramError(project, refused, planned=True)
    return Session(project, physics=physics, realtime=realtime, progress=progress, plans=plans).run()


__all__ = ["ProgramError", "Progress", "RunResult", "Session", "StatementRun", "run"]
