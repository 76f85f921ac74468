"""The one place where the effects of a program are carried out, on any target, without ever blocking.

``advance`` runs a program for some interpolation cycles and returns; between two calls it can be paused, stopped, fed
with a statement, and taken back to a snapshot. What is the same for the controller, a dry run and pulse tables is here:
the world that a program reads, moves that are kept since they blend into the next one, when motion has to end, the
longest run, the end at STOP, and requests that are refused: these go back to the program (ON ERROR).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, assert_never

from robolang.core.source import Source, Span
from robolang.execution import lowering, run_bounds
from robolang.execution.observer import Observer
from robolang.execution.progress import Aside, End, Phase, Progress
from robolang.execution.status import State, Status
from robolang.execution.target import Requested, Target
from robolang.execution.world import WorldSnapshot
from robolang.interpreter.branch_oracle import Decisions
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
    origin_of,
)
from robolang.interpreter.events import Done, Event, Failed, FedEnded, LineBegun
from robolang.interpreter.fed_line import fed_line
from robolang.interpreter.machine import Machine
from robolang.interpreter.snapshot import MachineSnapshot
from robolang.interpreter.variables import Variables
from robolang.project.project import Project
from robolang.syntax.ast import Wait
from robolang.values.poses import Frame
from runtime.core.faults import Fault
from runtime.motion.motion_planner import tracked

Alter: TypeAlias = Callable[[Effect], Effect | None]
"""Changes an effect before it is carried out, None: leaves it out (``compare``)."""


Lasting: TypeAlias = SetPayload | SetWrist | SetSeam | SetTool | SetOutput
"""Effects that last; mypy refuses a new one that is carried out neither as one of these nor by ``_carry_out``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutorSnapshot:
    """The whole of a program that is carried out: a value, to be put back any number of times."""

    machine: MachineSnapshot
    world: WorldSnapshot
    target: Any
    progress: Any


class Executor:
    """Carries a program out on a target."""

    def __init__(
        self,
        project: Project,
        target: Target,
        *,
        decisions: Decisions | None = None,
        alter: Alter | None = None,
        observer: Observer | None = None,
        most_us: int | None = None,
    ) -> None:
        """``decisions`` may force the branches of conditions; ``most_us`` ends the run earlier than usual."""
        self._project, self._target = project, target
        self.world = target.world
        self._alter = alter or (lambda effect: effect)
        self._observer = observer or Observer()
        self._most_us = run_bounds.MAX_RUN_US if most_us is None else most_us
        self._machine = Machine(project.program, self.world, project.points.names, decisions)
        self._now = Progress(ends_us=self._most_us)
        self._stop_requested = self._halt_requested = False

    # --- from outside ------------------------------------------------------------------------------------------------

    def advance(self, cycles: int = 1) -> Status:
        """Run at most so many interpolation cycles; fewer when the program is paused or ends."""
        for _ in range(cycles):
            if not self._ready():
                break
            self._cycle()
        return self.status

    @property
    def status(self) -> Status:
        """Where the program stands now."""
        target = self._target
        return Status(
            state=self._state,
            statement=target.statement,
            time_us=target.time_us,
            fault=self._now.fault,
            alarm=next(iter(target.alarms), None),
        )

    @property
    def origin(self) -> Origin | None:
        """The statement that the program has come to, ahead of the motion where moves blend; None at its end."""
        return self._machine.origin

    @property
    def calls(self) -> tuple[Origin, ...]:
        """The CALLs and GOSUBs that have not come back, the outermost first."""
        return self._machine.calls

    @property
    def variables(self) -> tuple[Variables, ...]:
        """The names of the main program, then of each CALL that has not come back, the innermost last."""
        return self._machine.variables

    @property
    def frame(self) -> Frame:
        """The frame that FRAME has set: its key in the cell, its pose in the world, or "", the world."""
        return self._machine.frame

    @property
    def _state(self) -> State:
        now = self._now
        if now.phase is Phase.OVER:
            failed = bool(self._target.alarms) or (now.fault is not None and not now.fault.fed)
            # a requested stop first: on a controller it is an alarm as well (RBL530)
            return State.STOPPED if self._stop_requested else State.ALARM if failed else State.DONE
        if now.resting:
            return State.PAUSED
        waits = now.phase is Phase.BUSY and any(isinstance(each.node, Wait) for each in now.doing)
        return State.WAITING if waits else State.RUNNING

    def pause(self) -> None:
        """Let the arm come to rest on its path, and the program stand; simulated time stands still from then on."""
        self._now.pausing = self._now.phase in (Phase.READY, Phase.BUSY)
        self._now.resumed = False

    def resume(self) -> None:
        """Go on after ``pause``, on the path where the arm stands."""
        self._now.resumed = self._now.pausing

    def stop(self) -> None:
        """Stop the arm on its path and end the program (category 1), from the next cycle on; nothing when it is over.

        Safe to call from a signal handler.
        """
        if self._now.phase is not Phase.OVER:
            self._stop_requested = True

    def halt(self) -> None:
        """Stop at once and end the program (category 0), as ``stop`` does."""
        if self._now.phase is not Phase.OVER:
            # a stop as well: only ``brake`` makes a difference between the two
            self._stop_requested = self._halt_requested = True

    def feed(self, statement: str | Source) -> None:
        """Carry out one more statement where the program stands; when it is over, the program is paused there.

        A ``Source`` has the name that messages give as its place. ``FileFault`` with that place for a text that is not
        one statement, ``Fault`` for a statement that cannot stand alone, ``RuntimeError`` while the program runs, where
        the arm rests within a move, and after an alarm. Nothing has changed then.
        """
        line = fed_line(statement if isinstance(statement, Source) else Source("fed statement", statement))
        now = self._now
        interrupts = self._interrupts_a_wait()
        depth = self._machine.depth
        self._machine.feed(line)
        # a wait of a fed CALL that a handler or a jump has left is not taken up
        now.aside = tuple(each for each in now.aside if each.depth < depth)
        if interrupts:
            interrupted, left = self._target.statement, self._target.set_aside()
            now.aside += (Aside(depth=depth, doing=now.doing, statement=interrupted, left=left),)
            now.doing = ()
        now.phase, now.fault = Phase.READY, None
        now.pausing = now.resting = now.resumed = False

    def _interrupts_a_wait(self) -> bool:
        """Return whether a statement that is fed now interrupts a wait; ``RuntimeError`` where none can be fed."""
        now = self._now
        # after an alarm ``acknowledge`` comes first (decision 0037)
        if now.phase is Phase.OVER and self._state is not State.DONE:
            raise RuntimeError("the program has been ended by an alarm or a stop")
        waits = now.phase is Phase.BUSY and now.resting
        if waits and any(isinstance(each, MoveTo) for each in now.doing):  # the rest of its plan begins where it is
            raise RuntimeError("the arm rests within a move; resume the move to its end first")
        if now.due is not None or not (waits or now.phase in (Phase.READY, Phase.OVER)):
            raise RuntimeError("a statement is being carried out; pause the program first")
        return waits

    def acknowledge(self) -> None:
        """Take note of the alarm that has ended the program: the servos hold the arm where it stands.

        The program stays ended: the move that was interrupted is not taken up, and no seam is followed. Statements can
        be fed, and may take as long as a run. ``RuntimeError`` while the program runs or the arm still stops, and when
        the state of the plant is no longer valid.
        """
        if self._now.phase is not Phase.OVER:
            raise RuntimeError("the program still runs, or the arm is still stopping")
        self._target.acknowledge()
        self._machine.end()
        self.world.q_last = self._target.q  # where the brakes have left the arm, not where the move would have ended
        # as long again: after a run that was too long (RBL509) every statement that is fed would be too late
        self._now = Progress(phase=Phase.OVER, ends_us=self._target.time_us + self._most_us)
        self._stop_requested = self._halt_requested = False

    def snapshot(self) -> ExecutorSnapshot:
        """Return the whole state: machine, world, target with its record, and what is kept here."""
        return ExecutorSnapshot(
            machine=self._machine.snapshot(),
            world=self.world.snapshot(),
            target=self._target.snapshot(),
            # a copy, since the run goes on in this one
            progress=(replace(self._now), self._stop_requested, self._halt_requested),
        )

    def restore(self, snapshot: ExecutorSnapshot) -> None:
        """Go back, or on, to a snapshot; from there the same bytes follow."""
        self._machine.restore(snapshot.machine)
        self.world.restore(snapshot.world)
        self._target.restore(snapshot.target)
        now, self._stop_requested, self._halt_requested = snapshot.progress
        self._now = replace(now)  # a copy: the snapshot can be put back again

    # --- cycles ------------------------------------------------------------------------------------------------------

    def _ready(self) -> bool:
        """Carry out what takes no time; return whether there is a cycle to run."""
        now = self._now
        while True:
            if now.pausing and not self._interrupted():
                return not now.resting
            if not self._went_on():
                return now.phase is not Phase.OVER

    def _went_on(self) -> bool:
        """Do one thing that takes no time, if there is one; else a cycle is due, or the program is over."""
        target, now = self._target, self._now
        match now.phase:
            case Phase.READY:
                self._go_on()
            case Phase.BUSY:
                # ``goes_on`` first: it notes what the last cycle did, also where a stop ends the effect
                if target.goes_on() and not self._stop_requested:
                    return False
                self._end_effects()
            case Phase.STOPPING:
                if not target.at_rest:
                    return False
                self._finish()
                now.phase = Phase.OVER
            case Phase.OVER:
                return False
            case _:
                assert_never(now.phase)
        return True

    def _interrupted(self) -> bool:
        """Pause or go on; return whether the program goes on, else the arm comes to rest or rests (``resting``)."""
        now = self._now
        if now.phase not in (Phase.READY, Phase.BUSY) or self._stop_requested:
            now.pausing = now.resting = False
            if now.phase is Phase.READY:
                self._end_effects()
            return True
        if now.due is not None and now.phase is Phase.READY:  # in the middle of a statement
            return True
        now.resting = self._target.hold()
        if now.resting and now.resumed:
            self._target.go_on()
            now.pausing = now.resting = now.resumed = False
        return not now.pausing

    def _cycle(self) -> None:
        target, now = self._target, self._now
        if now.phase is Phase.STOPPING:
            target.brake(at_once=self._halt_requested)  # read in each cycle: a second Ctrl-C comes during the stop
        elif not target.cycle() or target.alarms:
            self._end_effects()
        elif target.time_us >= now.ends_us:
            now.fault = self._too_long()
            target.fail(now.fault)
        self._observer.cycle_done(target.time_us)

    def _end_effects(self) -> None:
        """End the effects whose cycles are over, or that an alarm or a stop has ended."""
        now, target = self._now, self._target
        if self._stop_requested and not target.alarms:
            if target.statement is None:  # before the first statement: an alarm has a place
                target.statement = self._first
            target.stop()
            now.phase = Phase.STOPPING  # also where no cycle runs: the arm rests
        if target.alarms:
            self._observer.alarm(target.alarms[0])
            now.phase = Phase.STOPPING
        elif target.time_us >= now.ends_us:
            self._fail(self._too_long())
        elif now.phase is Phase.BUSY:
            self._finish()
            now.phase = Phase.READY

    def _finish(self) -> None:
        now = self._now
        self._target.finish()
        if any(isinstance(each, MoveTo) for each in now.doing):
            self.world.q_last = self._target.q
        for each in now.doing:
            self._observer.effect_done(each)
        now.doing = ()

    @property
    def _first(self) -> Origin:
        """The first statement of the program, or the start of a text without one."""
        for line in self._project.program.statements:
            return origin_of(line, line.statement or line)
        return Origin(line=1, span=Span(0, 0))

    def _too_long(self) -> Failed:
        statement = self._target.statement
        assert statement is not None  # something has been started
        fault = self._machine.too_long(statement, self._now.ends_us / 1e6)
        return _failed(fault, fault.origin)

    def _fail(self, fault: Failed) -> None:
        """End with a fault that the program does not catch."""
        self._now.fault, self._now.phase = fault, Phase.STOPPING
        self._target.fail(fault)
        # a target without a controller (``Untimed``) has none
        for alarm in self._target.alarms[:1]:
            self._observer.alarm(alarm)

    # --- the program -------------------------------------------------------------------------------------------------

    def _go_on(self) -> None:
        """Take what the program requests next, or what was due after the motion that has ended."""
        now = self._now
        try:
            if now.due is not None:
                self._arrive(now.due)
            else:
                self._take(self._machine.step())
        except Fault as fault:
            self._refuse(fault)

    def _take(self, event: Event) -> None:
        now = self._now
        match event:
            case LineBegun():
                self._observer.statement_began(event)
            case Done() | Failed() | FedEnded():
                self._after_motion(event)
            case _:
                now.request = effect = self._alter(event)
                if effect is not None:
                    self._target.begin(effect)
                    # WRIST does not wait for the moves before it: each move carries the setting that holds for it
                    if isinstance(effect, MoveTo | SetWrist):
                        self._carry_out(effect)
                    else:
                        self._after_motion(effect)

    def _after_motion(self, due: Effect | End) -> None:
        """Let the moves that are kept run first, if there are any."""
        self._now.due = due
        if self._now.chain:
            self._start_chain()
        else:
            self._arrive(due)

    def _arrive(self, due: Effect | End) -> None:
        now = self._now
        now.due = None
        match due:
            case Done():
                now.phase = Phase.OVER
                self._stop_requested = self._halt_requested = False  # a signal that came in the meantime is too late
            case FedEnded():
                now.pausing = True
                if not due.led:
                    self._take_up()
            case Failed():
                if due.fed:
                    now.fault, now.pausing = due, True
                    self._take_up()
                else:
                    self._target.statement = due.origin
                    self._fail(due)
            case _:
                self._carry_out(due)

    def _take_up(self) -> None:
        """Go on with the wait that the fed statement has interrupted, if it has."""
        now = self._now
        if now.aside and now.aside[-1].depth == self._machine.depth:
            *others, aside = now.aside
            now.aside, now.phase, now.doing = tuple(others), Phase.BUSY, aside.doing
            self._target.statement = aside.statement
            self._target.take_up(aside.left)

    def _refuse(self, fault: Fault) -> None:
        """Give a request that cannot be carried out back to the program, which may catch the fault (ON ERROR)."""
        now = self._now
        due, now.due, now.doing = now.due, None, ()
        now.phase = Phase.READY
        # the moves that were kept to the end: no statement is left that could answer
        if now.request is None or isinstance(due, Done | Failed | FedEnded):
            self._fail(_failed(fault, self._target.statement))
        else:
            self._target.refuse(now.request, fault)
            self._machine.refuse(fault)

    # --- effects -----------------------------------------------------------------------------------------------------

    def _carry_out(self, effect: Effect) -> None:
        """Start an effect on the target, in SI."""
        target, now = self._target, self._now
        if self._stop_requested and not isinstance(effect, MoveTo):  # a move is planned, and stopped before it begins
            target.statement = target.statement or effect.origin
            self._end_effects()
            return
        now.phase, now.doing = Phase.BUSY, (effect,)
        match effect:
            case MoveTo():
                self._move(effect)
            case SetHand():
                target.hand(effect, self._cycles(lowering.dwell_s(effect, self._project.cell)))
            case Pass():
                # a cycle at least: a WAIT that reads the time would never end if its clock stood still
                target.wait(effect, max(1, self._cycles(effect.seconds)))
            case Drain():
                target.drain(effect)
                now.phase, now.doing = Phase.READY, ()
            case Show():
                target.show(effect)
            case Halt():
                target.halt(effect)
            case _:
                self._set(effect)

    def _set(self, effect: Lasting) -> None:
        """Change what holds for the statements that follow, from now on."""
        target, cell = self._target, self._project.cell
        match effect:
            case SetPayload():
                target.load(effect, lowering.payload(effect, cell))
            case SetWrist():
                target.wrist(effect)
            case SetSeam():
                target.seam(effect)
                self._now.tracked = effect.sensor is not None
            case SetTool():
                self.world.tool, self.world.X_flange_tool = effect.tool, lowering.tool(effect.tool, cell)
                target.tool(effect, self.world.X_flange_tool)
            case SetOutput():
                self.world.set_output(effect.output, effect.value, effect.seconds)
                target.output(effect)
            case _:
                assert_never(effect)

    def _cycles(self, seconds: float) -> int:
        # rounded up, from whole us: a rounding error of calculated seconds must not cost a cycle
        return -(-round(seconds * 1e6) // self._project.profile.period_us)

    def _move(self, effect: MoveTo) -> None:
        """Start a move, or keep it where the next one may blend into it; it begins where the one before ends."""
        now, world = self._now, self.world
        command = lowering.move(effect, world.around)
        if now.tracked:
            command = tracked(command)
        blends = command.zone > 0.0
        if blends or now.chain:  # planned here, where the program can answer a refusal, and not when the chain runs
            plan = self._target.rehearse(world.q_last, command)
            world.q_last = plan.q[-1]
            # a move that goes nowhere has one row and no room for a blend
            blends = blends and len(plan.q) > 1 and len(now.chain) + 1 < run_bounds.MAX_CHAIN
        now.chain = (*now.chain, Requested(effect=effect, command=command))
        if blends:
            now.phase, now.doing = Phase.READY, ()
        else:
            self._start_chain()

    def _start_chain(self) -> None:
        now = self._now
        chain, now.chain = now.chain, ()
        now.phase, now.doing = Phase.BUSY, tuple(each.effect for each in chain)
        self._target.move(chain)


def _failed(fault: Fault, origin: Origin | None) -> Failed:
    assert origin is not None  # something has been started
    return Failed(code=fault.code, message=fault.message, hint=fault.hint, origin=origin)
