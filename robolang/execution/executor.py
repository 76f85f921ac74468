"""The one place where the effects of a program are carried out, on any target, without ever blocking.

``advance`` runs a program for some interpolation cycles and returns; between two calls it can be paused, stopped, fed
with a statement, moved by set-points, and taken back to a snapshot. What happens in a cycle is in ``engine``.
"""

from dataclasses import dataclass, replace
from typing import Any

from robolang.core.source import Source, Span
from robolang.evaluation.evaluator import Evaluator
from robolang.execution import adopting, regain, run_bounds
from robolang.execution.adopting import Edit
from robolang.execution.engine import Alter, Engine, StopsBefore
from robolang.execution.observer import Observer
from robolang.execution.progress import BY_HAND, Phase, PlayEnded, Progress
from robolang.execution.regain import DEFAULT_LIMITS, Displaced, RegainLimits
from robolang.execution.status import ENDED, State, Status
from robolang.execution.target import Target
from robolang.execution.trail import Trail
from robolang.execution.world import RobotWorld, WorldSnapshot
from robolang.interpreter.adopting import Lines
from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import Origin
from robolang.interpreter.fed_line import fed
from robolang.interpreter.machine import Machine
from robolang.interpreter.snapshot import MachineSnapshot
from robolang.interpreter.variables import Variables
from robolang.project.project import Project
from robolang.syntax.ast import Wait
from robolang.values.poses import Frame
from runtime.core.faults import Fault
from runtime.core.frames import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutorSnapshot:
    """The whole of a program that is carried out: a value, to be put back any number of times."""

    machine: MachineSnapshot
    world: WorldSnapshot
    target: Any
    progress: Progress


EDIT = "edit"
"""The label of the place before an edited program was adopted."""


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
        machine = Machine(project.program, target.world, project.points.names, decisions)
        self._engine = Engine(project, target, machine, alter=alter, observer=observer or Observer())
        self._most_us = run_bounds.MAX_RUN_US if most_us is None else most_us
        self._engine.now.ends_us = self._most_us

    # --- where it stands ---------------------------------------------------------------------------------------------

    @property
    def project(self) -> Project:
        """The program that is carried out, with its files."""
        return self._engine.project

    @property
    def world(self) -> RobotWorld:
        """What the program reads of robot and cell."""
        return self._engine.world

    @property
    def status(self) -> Status:
        """Where the program stands now."""
        target = self._engine.target
        return Status(
            state=self._state,
            statement=target.statement,
            time_us=target.time_us,
            fault=self._engine.now.fault,
            alarm=next(iter(target.alarms), None),
        )

    @property
    def _state(self) -> State:
        now = self._engine.now
        if now.phase is Phase.OVER:
            failed = bool(self._engine.target.alarms) or (now.fault is not None and not now.fault.fed)
            # a requested stop first: on a controller it is an alarm as well (RBL530)
            return State.STOPPED if now.stop_requested else State.ALARM if failed else State.DONE
        if now.resting:
            return State.PAUSED
        waits = now.phase is Phase.BUSY and any(isinstance(each.node, Wait) for each in now.doing)
        return State.WAITING if waits else State.RUNNING

    @property
    def time_us(self) -> int:
        """Simulated time, us."""
        return self._engine.target.time_us

    @property
    def origin(self) -> Origin | None:
        """The statement that the program has come to, ahead of the motion where moves blend; None at its end."""
        return self._engine.machine.origin

    @property
    def calls(self) -> tuple[Origin, ...]:
        """The CALLs and GOSUBs that have not come back, the outermost first."""
        return self._engine.machine.calls

    @property
    def variables(self) -> tuple[Variables, ...]:
        """The names of the main program, then of each CALL that has not come back, the innermost last."""
        return self._engine.machine.variables

    @property
    def frame(self) -> Frame:
        """The frame that FRAME has set: its key in the cell, its pose in the world, or "", the world."""
        return self._engine.machine.frame

    @property
    def level(self) -> int:
        """How many CALLs and GOSUBs have not come back, those that were fed included."""
        return self._engine.machine.level

    @property
    def evaluator(self) -> Evaluator:
        """Values of expressions in the scope where the program is, with the arm where it is commanded to be now.

        It changes nothing, and also knows the functions of axes (``measured``); see ``watching.evaluate``.
        """
        target = self._engine.target
        return self._engine.machine.evaluator(self.world.at(target.q), target.measured)

    @property
    def is_over(self) -> bool:
        """Whether nothing of the program is left: also where a statement was fed, or the arm moved, after its end."""
        now = self._engine.now
        return self._engine.machine.over and not now.aside and now.phase is not Phase.BUSY

    @property
    def interrupted(self) -> bool:
        """Whether ``begin_again`` can put the program back before a statement that an alarm has interrupted."""
        return self._engine.now.failed is not None

    @property
    def interrupted_line(self) -> int | None:
        """The line of the file with the statement that ``begin_again`` goes back to; None: nothing is interrupted."""
        failed = self._engine.now.failed
        return None if failed is None else self._engine.machine.line_of(failed)

    @property
    def plays(self) -> bool:
        """Whether a motion of ``play`` has not ended."""
        return self._engine.now.playing

    @property
    def displaced(self) -> Displaced | None:
        """How far the arm is from where it has left the path of a motion that is interrupted; None: of none."""
        engine, now = self._engine, self._engine.now
        if now.phase is Phase.BUSY and now.moves and now.resting:
            return Displaced()
        held = engine.held
        return None if held is None or not held.is_motion else regain.displacement(self.world, held.q, engine.target.q)

    @property
    def strayed(self) -> Displaced | None:
        """How far set-points have brought the arm from where the program stood between two statements; None: nowhere.

        A program that has not begun may begin anywhere; a move that is fed is meant to leave that place.
        """
        now = self._engine.now
        return None if now.stood is None else regain.displacement(self.world, now.stood, self._engine.target.q)

    # --- stops -------------------------------------------------------------------------------------------------------

    @property
    def stops_before(self) -> StopsBefore | None:
        """What decides at each statement of the program whether it is paused before it; None: nowhere.

        It is not called for a statement that is fed, and once only for each time that a statement is due. Moves that
        were kept for a blend come to their end first, so the arm stops where the program says; without such moves a
        run with pauses is the run without, to the byte. A hook that returns True from the first statement on holds a
        program that has not begun.
        """
        return self._engine.stops_before

    @stops_before.setter
    def stops_before(self, hook: StopsBefore | None) -> None:
        self._engine.stops_before = hook

    def follow(self, trail: Trail | None) -> None:
        """Let a trail see where the program can be returned to; None: no more."""
        self._engine.trail = trail

    @property
    def silent(self) -> bool:
        """Whether cycles of the past are run once more: no observer sees them, and no clock paces them."""
        return self._engine.target.silent

    @silent.setter
    def silent(self, silent: bool) -> None:
        self._engine.target.silent = silent

    # --- from outside ------------------------------------------------------------------------------------------------

    def advance(self, cycles: int = 1) -> Status:
        """Run at most so many interpolation cycles; fewer when the program is paused or ends."""
        for _ in range(cycles):
            if not self._engine.ready():
                break
            self._engine.cycle()
        return self.status

    def pause(self) -> None:
        """Let the arm come to rest on its path, and the program stand; simulated time stands still from then on."""
        now = self._engine.now
        if not now.resting:
            self._disturbed()
        now.pausing = now.phase in (Phase.READY, Phase.BUSY)
        now.resumed = False

    def stand(self) -> None:
        """Pause the program where a statement is due, and where nothing moves: after ``restore``, or from a trail."""
        now = self._engine.now
        now.pausing = now.resting = True
        now.resumed = False

    def resume(self) -> None:
        """Go on after ``pause``, on the path where the arm stands; ``Fault`` RBL540 where it has left that path.

        Nothing has moved then: ``regain`` returns to the path.
        """
        engine, now = self._engine, self._engine.now
        held = engine.held if now.resting and now.phase is Phase.READY else None
        if held is not None:
            self._refuse_displaced()
        self._leaves("")
        if not now.playing:
            now.stood = None
        if now.fault is not None and now.fault.fed:
            now.fault = None  # of a statement that was fed, and no reason why what comes now should have failed
        if held is not None:
            engine.take_up(held)
        now.resumed = now.pausing

    def _refuse_displaced(self) -> None:
        far = self.displaced
        if far is not None and far.is_away:
            raise Fault("RBL540", f"the arm is {far} away from where its path was left")

    def stop(self) -> None:
        """Stop the arm on its path and end the program (category 1), from the next cycle on; nothing when it is over.

        Safe to call from a signal handler.
        """
        if self._engine.now.phase is not Phase.OVER:
            self._ends("stop")
            self._engine.now.stop_requested = True

    def halt(self) -> None:
        """Stop at once and end the program (category 0), as ``stop`` does."""
        now = self._engine.now
        if now.phase is not Phase.OVER:
            self._ends("halt")
            # a stop as well: only ``brake`` makes a difference between the two
            now.stop_requested = now.halt_requested = True

    def feed(self, statement: str | Source) -> None:
        """Carry out one more statement, or lines of whole blocks, where the program stands; then it is paused there.

        Within a move, which then is not taken up before ``resume``: see ``displaced``. A ``Source`` has the name that
        messages give as its place. ``FileFault`` with that place for a text that is not whole statements, ``Fault`` for
        a statement that cannot stand alone, ``RuntimeError`` while the program runs and after an alarm. Nothing has
        changed then.
        """
        source = statement if isinstance(statement, Source) else Source("fed statement", statement)
        text = fed(source)
        self._refuse_running()
        engine, now = self._engine, self._engine.now
        engine.machine.check_fed(text)
        self._leaves(source.text)
        # before the machine takes the line, since that suspends the statement which is interrupted
        interrupts, again = now.phase is Phase.BUSY, engine.interrupted_at()
        engine.machine.feed(text)
        depth = engine.machine.depth - 1
        # what a fed CALL has interrupted is not taken up when a handler or a jump has left that call
        now.aside = tuple(each for each in now.aside if each.depth <= depth)
        if interrupts:
            engine.set_aside(depth, again)
        self._act(Phase.READY)

    def _refuse_running(self) -> None:
        """Refuse to act on a program that runs, or that an alarm has ended; ``RuntimeError``."""
        now = self._engine.now
        # after an alarm ``acknowledge`` comes first (decision 0037)
        if now.phase is Phase.OVER and self._state is not State.DONE:
            raise RuntimeError("the program has been ended by an alarm or a stop")
        if now.playing:
            raise RuntimeError("a motion of its own has not ended; resume or abandon it first")
        stands = now.resting or now.phase is Phase.OVER or (now.phase is Phase.READY and now.due is None)
        if not stands:
            raise RuntimeError("a statement is being carried out; pause the program first")

    def _act(self, phase: Phase) -> None:
        now = self._engine.now
        now.phase, now.fault = phase, None
        now.pausing = now.resting = now.resumed = False

    def play(self, rows: Array, origin: Origin | None, text: str) -> None:
        """Send joint set-points (K, n) rad, one in each cycle, where the program stands; then it is paused there.

        Between two statements, in a wait, within a move that rests, and after the end. ``origin`` and ``text`` are what
        log, alarms and record have for it; None: a place in ``text``. ``pause`` brings it to rest from the next cycle
        on, ``resume`` goes on with it, ``abandon`` forgets the rest. ``Fault`` RBL404 or RBL411 for rows that joints
        cannot follow, RBL544 where a seam is followed; ``RuntimeError`` as ``feed``, ``ValueError`` for rows of another
        shape. Nothing has changed then.
        """
        self._refuse_running()
        engine, now = self._engine, self._engine.now
        self._leaves(text)
        interrupts, before = now.phase is Phase.BUSY, self.snapshot()
        stood = engine.target.q if now.stood is None and engine.stands_between else now.stood
        if interrupts:
            engine.set_aside(engine.machine.depth, engine.interrupted_at())
        place = origin or Origin(line=0, span=Span(0, len(text)), source=Source(BY_HAND, text))
        try:
            engine.target.play(rows, place, text)
        except Exception:  # whatever it is: a refusal must leave the motion where it rests
            if interrupts:
                self.restore(before)
            raise
        self._act(Phase.BUSY)
        engine.now.playing, engine.now.due, engine.now.stood = True, PlayEnded(), stood

    def abandon(self) -> None:
        """Forget what is left of ``play`` where the arm rests; ``RuntimeError`` while it moves."""
        now = self._engine.now
        if not (now.playing and now.resting):
            raise RuntimeError("no motion of its own rests; pause it first")
        self._leaves("abandon")
        self._engine.abandon()

    def regain(self, limits: RegainLimits = DEFAULT_LIMITS) -> bool:
        """Bring the arm slowly back to where it has left the path of the interrupted motion; False: it is there.

        Between two statements to where it stood before set-points moved it (``strayed``). The program is paused there,
        and ``resume`` goes on as planned. ``Fault`` RBL541 where the arm is farther away than the limits; RBL4xx where
        it cannot return; ``RuntimeError`` where there is no such place. Nothing has changed then.
        """
        held, stood = self._engine.held, self._engine.now.stood
        on_path = self.displaced
        far = on_path or self.strayed
        if far is None:
            raise RuntimeError("no motion is interrupted, and the arm was not moved between two statements")
        q, origin = (stood, None) if held is None or on_path is None else (held.q, held.statement)
        if not far.is_away or q is None:
            return False
        regain.refuse_beyond(limits, far, "its path was left" if on_path else "the program stood")
        rows = regain.returning(self._engine.target, q, self.project.profile.period_s)
        self.play(rows, origin, "regain the path" if on_path else "return to where the program stood")
        return True

    def acknowledge(self) -> None:
        """Take note of the alarm that has ended the program: the servos hold the arm where it stands.

        The program stays ended: the move that was interrupted is not taken up, and no seam is followed. Statements can
        be fed, and may take as long as a run; ``begin_again`` goes back into the program. ``RuntimeError`` while the
        program runs or the arm still stops, and when the state of the plant is no longer valid.
        """
        engine, now = self._engine, self._engine.now
        if now.phase is not Phase.OVER:
            raise RuntimeError("the program still runs, or the arm is still stopping")
        was_done = self._state is State.DONE  # nothing to note, and what was interrupted before stays so
        self._leaves("acknowledge")
        engine.target.acknowledge()
        if now.again is not None:
            # now and not in ``begin_again``: what is fed from here on counts
            engine.machine.restore(now.again)
        place = engine.machine.end()
        self.world.q_last = engine.target.q  # where the brakes have left the arm, not where the move would have ended
        # as long again: after a run that was too long (RBL509) every statement that is fed would be too late
        engine.now = Progress(
            phase=Phase.OVER,
            ends_us=engine.target.time_us + self._most_us,
            failed=now.failed if was_done else place,
            begun=now.begun,
            stood=now.stood,
        )

    def begin_again(self) -> None:
        """Put the program back before the statement that an alarm, a stop or a fault has interrupted, and pause it.

        ``resume`` carries the statement out anew, from where the arm stands: of moves that blend the one that was
        running, of what was fed the statement of the program at which it was fed; a WAIT begins its time anew. Names
        keep what has been assigned to them since. ``Fault`` RBL542 where nothing was interrupted, before
        ``acknowledge``, and when the CALL or GOSUB that it was in has been left since.
        """
        now = self._engine.now
        if now.failed is None:
            raise Fault("RBL542", "no statement has been interrupted by an alarm that is acknowledged")
        self._refuse_running()
        self._leaves("begin again")
        if not self._engine.machine.begin_again(now.failed):
            raise Fault("RBL542", "the CALL or GOSUB in which the statement was interrupted has been left")
        self._act(Phase.READY)
        now.failed = None
        self.stand()

    def restart(self) -> None:
        """Put the program before its first statement, and pause it there: arm, names, settings and signals stay.

        What was interrupted is not taken up. ``RuntimeError`` as ``feed``.
        """
        self._refuse_running()
        self._leaves("restart")
        engine, now = self._engine, self._engine.now
        if now.phase is Phase.BUSY:  # the target lets go of a motion that rests, or of a wait
            engine.set_aside(engine.machine.depth, None)
        engine.machine.restart()
        engine.now = Progress(ends_us=engine.target.time_us + self._most_us)
        self.stand()

    # --- an edited program -------------------------------------------------------------------------------------------

    def adopt(self, project: Project, lines: Lines) -> None:
        """Go on with an edited program, or with other taught points, where the program stands.

        ``lines`` says where the lines of the old program went. The program stands before the same statement, in the
        same calls, loops and handlers; a statement at which it stands may change or go. What is carried out goes on as
        it was planned. Points, frames and tools hold from the next statement on. ``Fault`` RBL543 where a line that the
        program is inside of is gone; ``RuntimeError`` while the program runs, ``ValueError`` for a project with errors
        or of another robot. Nothing has changed then.
        """
        if self._state not in ENDED and not self._engine.now.resting:
            raise RuntimeError("a statement is being carried out; pause the program first")
        if not project.ok or project.cell.robot.name != self.project.cell.robot.name:
            raise ValueError("the program has errors, or is of another robot")
        edit = Edit(old=self.project, new=project, lines=lines)
        adoption = adopting.prepared(self._engine, edit)  # all that may be refused comes before the first change
        self._leaves(EDIT)
        adopting.adopt(self._engine, adoption)
        if self._engine.trail is not None:
            self._engine.trail.adopts(edit)

    def move_to(self, edit: Edit) -> None:
        """Move the state to the edited program, as ``adopt`` does, unseen by a trail; ``Fault`` RBL543."""
        adopting.adopt(self._engine, adopting.prepared(self._engine, edit))

    def become(self, project: Project) -> None:
        """Take a project whose program has not begun, so that a snapshot of it can be restored."""
        adopting.become(self._engine, project)

    # --- snapshots ---------------------------------------------------------------------------------------------------

    def snapshot(self) -> ExecutorSnapshot:
        """Return the whole state: machine, world, target with its record, and what is kept here."""
        engine = self._engine
        return ExecutorSnapshot(
            machine=engine.machine.snapshot(),
            world=self.world.snapshot(),
            target=engine.target.snapshot(),
            # a copy, since the run goes on in this one
            progress=replace(engine.now),
        )

    def restore(self, snapshot: ExecutorSnapshot) -> None:
        """Go back, or on, to a snapshot; from there the same bytes follow."""
        engine = self._engine
        engine.machine.restore(snapshot.machine)
        self.world.restore(snapshot.world)
        engine.target.restore(snapshot.target)
        engine.now = replace(snapshot.progress)  # a copy: the snapshot can be put back again

    def _leaves(self, label: str) -> None:
        trail = self._engine.trail
        if trail is not None and (self._engine.now.resting or self._engine.now.phase is Phase.OVER):
            trail.leaves(label)

    def _ends(self, label: str) -> None:
        # where it runs a signal handler has called this, and no snapshot can be taken within a cycle
        self._leaves(label)
        self._disturbed()

    def _disturbed(self) -> None:
        if self._engine.trail is not None:
            self._engine.trail.disturbed()


__all__ = ["Alter", "Displaced", "Executor", "ExecutorSnapshot", "RegainLimits", "StopsBefore"]
