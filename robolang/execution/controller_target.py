"""Effects carried out by a controller over its plant, with the record of what became of each statement.

A statement ends when its effect has: a MOVE when the command has come to rest and the arm is in position, a HAND after
its dwell, a LOAD at once. ``goes_on`` is called between two cycles, so all that it waits for is plain data here.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from robolang.execution.activity import Activity, Left, Motion, Pause, TargetSnapshot
from robolang.execution.grasp import note_grasp
from robolang.execution.kept_log import check_log
from robolang.execution.lowering import tracker
from robolang.execution.measured import measured
from robolang.execution.observer import Observer
from robolang.execution.plan_warnings import PlanWarnings
from robolang.execution.planned_move import PlannedChain, planned_moves
from robolang.execution.result import GOES_ON, LAMPS, RunRecord, StatementRun
from robolang.execution.statement_rows import (
    copied,
    note_plan,
    note_rest,
    payload_row,
    rest_of,
    row_of,
    stopped,
    straight_path,
)
from robolang.execution.tape import Tape
from robolang.execution.target import Requested
from robolang.execution.world import RobotWorld
from robolang.interpreter.effects import (
    Drain,
    Effect,
    Halt,
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
from robolang.interpreter.events import Failed
from robolang.project.project import Project
from robolang.syntax.ast import Wait
from runtime.core.faults import Alarm, Fault
from runtime.core.frames import Array
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import Command
from runtime.motion.motion_planner import ChainPlan
from runtime.motion.seam import SeamTracker
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.payload import Payload

_NOBODY = Observer()


class ControllerTarget:
    """Carries effects out by the controller of a record. ``tracker`` is the seam tracker in force."""

    def __init__(self, record: RunRecord, kinematics: Kinematics, observer: Observer) -> None:
        self._record, self._observer = record, observer
        self._project = record.project
        self.world = RobotWorld(record.project.points, record.project.cell, kinematics, lambda: self.time_us)
        """What the program reads of robot and cell."""
        self._warnings = PlanWarnings(record.project, kinematics)
        self._statements = Tape(record.statements, copied)
        self._payloads, self._shown = Tape(record.payloads), Tape(record.shown)
        self._activity: Activity = None

    # --- time --------------------------------------------------------------------------------------------------------

    @property
    def statement(self) -> Origin | None:
        """Statement that is carried out."""
        found = self._record.controller.statement
        assert found is None or isinstance(found, Origin)  # nothing else is given to the controller
        return found

    @statement.setter
    def statement(self, origin: Origin | None) -> None:
        self._record.controller.statement = origin

    @property
    def time_us(self) -> int:
        """Simulated time, us."""
        return self._record.controller.time_us

    @property
    def alarms(self) -> Sequence[Alarm]:
        """Latched alarms, the one that stops the arm first."""
        return self._record.controller.alarms

    @property
    def at_rest(self) -> bool:
        """Whether the brakes hold the arm."""
        return self._record.controller.halted

    @property
    def q(self) -> Array:
        """Commanded joint angles (n,) rad."""
        return np.array(self._record.controller.areas.ina)

    @property
    def move_reached(self) -> int:
        """Which move of the chain the set-point in force belongs to, from 0."""
        return self._record.controller.chain_index

    def measured(self, key: str, index: int) -> float | None:
        """Return what an axis, from 1, measures; None: no function of axes has this name. ``Fault`` RBL507."""
        return measured(self._record.controller, key, index)

    @property
    def silent(self) -> bool:
        """Whether cycles of the past are run once more: no observer sees them, and no clock paces them."""
        return not self._record.controller.paced

    @silent.setter
    def silent(self, silent: bool) -> None:
        self._record.controller.paced = not silent

    @property
    def _seen(self) -> Observer:
        return _NOBODY if self.silent else self._observer

    def goes_on(self) -> bool:
        """Return whether the statement needs another cycle."""
        activity = self._activity
        if isinstance(activity, Motion):
            return self._moves_on(activity)
        if activity is None or activity.cycles == 0:
            if activity is not None and activity.grasp:
                # noted when the dwell is over, in which the fingers close
                record = self._record
                note_grasp(record.statements[activity.run], record.controller, self._project.cell)
            return False
        self._activity = replace(activity, cycles=activity.cycles - 1)
        return True

    def _moves_on(self, motion: Motion) -> bool:
        controller, profile = self._record.controller, self._project.profile
        runs = self._record.statements[motion.first : motion.last + 1]
        if motion.sent:
            run = self._reach(runs)
            run.lamp = LAMPS[controller.wrist_mode]
            run.lost = 0 if run.seam is None else self._lost - motion.lost
        if controller.moving or not motion.sent:  # where the arm is already it takes a cycle, so that no loop is idle
            self._activity = replace(motion, sent=True)
            return True
        if controller.position_error <= profile.in_position:
            return False
        # a warning and no alarm: dry friction can hold an axis short of its end for ever
        if motion.waited_us >= profile.settle_timeout_us:
            left, waited_s = controller.spec.largest(controller.position_errors), motion.waited_us / 1e6
            controller.warn("RBL523", f"not in position: {left} left after {waited_s:g} s")
            return False
        self._activity = replace(motion, waited_us=motion.waited_us + profile.period_us)
        return True

    def _reach(self, runs: list[StatementRun]) -> StatementRun:
        """Return the move of a chain whose set-point is sent next; it begins when the one before it ends."""
        motion = self._activity
        assert isinstance(motion, Motion)
        tick, at = self._record.controller.recorder.tick, self.move_reached - motion.skipped
        runs[0].begun = tick > runs[0].first_tick
        if not runs[at].begun and runs[0].begun:
            for before, run in pairwise(runs[: at + 1]):
                if not run.begun:
                    before.end_tick = run.first_tick = tick
                    run.begun = True
            self._seen.run_began(runs[at], self.time_us)
        return runs[at]

    def cycle(self) -> bool:
        """Run one cycle of the controller; False when the brakes hold the arm."""
        going = self._record.controller.cycle()
        check_log(self._record)
        motion = self._activity
        # after an alarm ``goes_on`` is not called: the move whose set-point was sent last is noted here
        if isinstance(motion, Motion) and self.alarms:
            self._reach(self._record.statements[motion.first : motion.last + 1])
        return going

    def finish(self) -> None:
        """End the statements of the activity at this tick."""
        if not self.alarms:
            self._close()
        activity, self._activity = self._activity, None
        tick, statements = self._record.controller.recorder.tick, self._record.statements
        if isinstance(activity, Motion):
            for run in statements[activity.first : activity.last + 1]:
                if run.ended:  # within a chain a move has ended where the next one began
                    continue
                run.end_tick = tick
                if run.begun and (self.alarms or run.effect is None):
                    note_rest(run, self.q, self.world.around)
        elif activity is not None:
            statements[activity.run].end_tick = tick

    def brake(self, *, at_once: bool) -> None:
        """Let a controlled stop go on for a cycle, or end it here."""
        if at_once:
            self._record.controller.halt()
        self._record.controller.cycle()

    def hold(self) -> bool:
        """Bring the move that runs to rest on its path; returns whether the command rests."""
        return self._record.controller.hold()

    def go_on(self) -> None:
        """Resume the move where it rests."""
        self._record.controller.go_on()

    def set_aside(self) -> Left:
        """Interrupt a wait or a motion; its statement ends here.

        What is left of a wait counts to it again when it ends; what is left of a motion is recorded as another one.
        """
        activity, statements = self._activity, self._record.statements
        if not isinstance(activity, Motion):
            self.finish()
            return Left(activity=activity)
        motion = self._record.controller.set_aside()
        self._activity = None
        if motion.ended:  # it has only to come into position
            return Left(activity=activity, motion=motion)
        at = activity.first + self.move_reached - activity.skipped
        rest = tuple(statements[at:])
        for run in [each for each in statements[activity.first : at + 1] if not each.ended]:
            run.end_tick = self._record.controller.recorder.tick
        del statements[at + rest[0].begun :]  # those that have not begun come after what is done meanwhile
        first, *others = map(copied, rest)
        if first.begun:
            note_rest(rest[0], self.q, self.world.around)
            first.effect = rest_of(first, self.q, self.world.around)
        return Left(activity=activity, motion=motion, rest=(first, *others))

    def take_up(self, left: Left) -> None:
        """Go on with a wait, or with a motion, which rests until ``go_on``."""
        activity, statements = left.activity, self._record.statements
        if left.motion is not None:
            self._record.controller.take_up(left.motion)
        if left.rest and isinstance(activity, Motion):
            tick, first = self._record.controller.recorder.tick, len(statements)
            # rows of their own: what was measured meanwhile is not of these moves
            statements += [replace(copied(run), first_tick=tick, end_tick=GOES_ON, begun=False) for run in left.rest]
            activity = replace(activity, first=first, last=len(statements) - 1, skipped=self.move_reached)
        elif isinstance(activity, Pause):
            self._statements.change(activity.run)
        self._activity = activity

    def play(self, rows: Array, origin: Origin, text: str) -> None:
        """Start given set-points; ``Fault`` RBL404, 411, 544, and nothing is recorded."""
        controller = self._record.controller
        if controller.tracker is not None:
            raise Fault("RBL544", f"the arm follows the seam sensor {controller.tracker.name}")
        q_before = self.q
        controller.play(rows)
        self.statement = origin
        run = StatementRun(origin=origin, text=text, first_tick=controller.recorder.tick, begun=False)
        q = np.concatenate([q_before[None], rows])
        run.path, run.planned_s = straight_path(q, controller.tool_poses(q)), len(rows) * self._project.profile.period_s
        self._record.statements.append(run)
        last = len(self._record.statements) - 1
        self._activity = Motion(first=last, last=last, lost=self._lost)
        self._seen.run_began(run, self.time_us)

    def abandon(self) -> None:
        """Forget what is left of the set-points."""
        self._record.controller.set_aside()

    def stop(self) -> None:
        """Raise RBL530."""
        self._record.controller.alarm("RBL530", "the run was stopped from outside")

    def acknowledge(self) -> None:
        """Release the brakes; the record keeps the alarms."""
        alarms = list(self.alarms)  # a copy, since the controller forgets them
        self._record.controller.acknowledge()
        self._record.acknowledged += alarms
        for run in self._record.statements[-1:]:
            if run.rest is not None:  # where the brakes have left the arm
                note_rest(run, self.q, self.world.around)

    def fail(self, fault: Failed) -> None:
        """Raise the alarm of a fault that the program does not catch."""
        self._record.controller.alarm(
            fault.code, fault.message, hint=fault.hint, statement=fault.origin, calls=fault.calls
        )

    def refuse(self, effect: Effect, fault: Fault) -> None:
        """Do nothing: the program answers."""

    # --- effects -----------------------------------------------------------------------------------------------------

    def begin(self, effect: Effect) -> None:
        """Accept every effect."""

    def rehearse(self, q_start: Array, command: Command) -> MovePlan:
        """Return the plan of a move without starting it; ``Fault`` RBL4xx."""
        return self._record.controller.rehearse(q_start, command)

    def move(self, chain: Sequence[Requested], *, more: bool = False) -> None:
        """Plan moves from the commanded position and start them; ``ChainFault`` RBL4xx."""
        controller, commands = self._record.controller, [each.command for each in chain]
        self.statement = chain[0].effect.origin
        # planned before it is recorded: a chain that is refused leaves no statement in the record
        plan = controller.move_chain(commands, [each.effect.origin for each in chain], more=more)
        first = len(self._record.statements)
        self._record_moves(Motion(first=first, last=first, lost=self._lost), tuple(chain), plan, len(chain), more=more)
        self._seen.run_began(self._record.statements[first], self.time_us)

    @property
    def more_due(self) -> bool:
        """Whether more moves are to follow now, so that those that run go on without a stop."""
        return isinstance(self._activity, Motion) and self._record.controller.requests.more_due

    def extend(self, chain: Sequence[Requested], *, more: bool) -> int:
        """Plan moves after those that run; ``Fault`` RBL404 where these cannot go on."""
        controller, motion = self._record.controller, self._activity
        assert isinstance(motion, Motion) and motion.open is not None  # else no more is due
        commands, origins = [each.command for each in chain], [each.effect.origin for each in chain]
        try:
            plan, over = controller.requests.extend(commands, origins)
        except Fault:
            self._activity = replace(motion, open=motion.open.ended_before(chain[0], self.rehearse))
            raise
        # of the others corners and speeds are those of a stop that does not come
        self._warnings.warn(planned_moves(motion.open, over), controller)
        requested = (*motion.open.requested[over:], *chain)
        begins, skipped = motion.first + max(0, over - motion.skipped), max(0, motion.skipped - over)
        self._record_moves(replace(motion, first=begins, skipped=skipped), requested, plan, len(chain), more=more)
        return over

    def _record_moves(
        self, motion: Motion, requested: tuple[Requested, ...], plan: ChainPlan, count: int, *, more: bool
    ) -> None:
        """Record the last ``count`` moves of a chain, and what is planned of all of them."""
        statements, seam = self._record.statements, None if self._tracker is None else self._tracker.name
        speeds = self._record.controller.requests.speeds(plan, [each.command for each in requested])
        planned = PlannedChain(requested=requested, plan=plan, speeds=speeds)
        for each in requested[-count:]:
            run = self._record_run(each.effect)
            # a move has begun when its first set-point is sent (``_reach``)
            run.seam, run.begun = seam, False
        note_plan(statements[motion.first :], planned, motion.skipped, count)
        self._activity = replace(motion, last=len(statements) - 1, open=planned)
        if not more:
            self._close()

    def _close(self) -> None:
        """Judge the moves that nothing follows any more without a stop."""
        motion = self._activity
        if isinstance(motion, Motion) and motion.open is not None:
            stopped(self._record.statements[motion.last])
            self._warnings.warn(planned_moves(motion.open), self._record.controller)
            self._activity = replace(motion, open=None)

    @property
    def _tracker(self) -> SeamTracker | None:
        return self._record.controller.tracker

    @property
    def _lost(self) -> int:
        return 0 if self._tracker is None else self._tracker.lost

    def _record_run(self, effect: Effect) -> StatementRun:
        tick = self._record.controller.recorder.tick
        run = row_of(effect, tick, self.world.around.points)
        self._record.statements.append(run)
        return run

    def _start(self, effect: Effect, cycles: int = 0, *, grasp: bool = False) -> StatementRun:
        """Begin a statement that takes so many cycles, or go on with a WAIT: each of its cycles is an effect."""
        self.statement = effect.origin
        statements, tick = self._record.statements, self._record.controller.recorder.tick
        goes_on = bool(statements) and isinstance(effect.node, Wait) and statements[-1].end_tick == tick
        begins = not (goes_on and statements[-1].origin == effect.origin)
        if begins:
            self._record_run(effect)
        self._activity = Pause(run=len(statements) - 1, cycles=cycles, grasp=grasp)
        if begins:
            self._seen.run_began(statements[-1], self.time_us)
        return statements[-1]

    def wrist(self, effect: SetWrist) -> None:
        """Note WRIST in the record."""
        self._start(effect)

    def drain(self, effect: Drain) -> None:
        """Do nothing: motion has ended."""

    def load(self, effect: SetPayload, payload: Payload) -> None:
        """Store the payload in SDA, and in the record."""
        self._start(effect)
        self._record.controller.load(payload)
        self._record.payloads.append(payload_row(effect, payload, self.time_us / 1_000_000))

    def hand(self, effect: SetHand, cycles: int) -> None:
        """Switch the tool drive circuit."""
        self._start(effect, cycles, grasp=effect.closed)
        self._record.controller.hand(effect.closed)

    def seam(self, effect: SetSeam) -> None:
        """Give the controller a tracker of a sensor of the cell, or none."""
        self._start(effect)
        self._record.controller.seam(tracker(effect, self._project))

    def tool(self, effect: SetTool, X_flange_tool: Array) -> None:
        """Use another tool."""
        self._start(effect)
        self._record.controller.use_tool(X_flange_tool)

    def output(self, effect: SetOutput) -> None:
        """Note OUT in the record."""
        self._start(effect)

    def wait(self, effect: Pass, cycles: int) -> None:
        """Let cycles pass."""
        self._start(effect, cycles)

    def show(self, effect: Show) -> None:
        """Keep what PRINT shows."""
        self._start(effect)
        self._record.shown.append((self.time_us / 1_000_000, effect.text))
        self._seen.printed(effect.text)

    def halt(self, effect: Halt) -> None:
        """Note STOP or PAUSE in the record."""
        stops = effect.word == "STOP"
        self._start(effect).notes.append("the program stops here" if stops else "nobody is there to wait for: goes on")

    # --- an edited program -------------------------------------------------------------------------------------------

    def adopt(self, project: Project) -> None:
        """Go on with an edited project of the same robot."""
        self._project = self._record.project = project

    def rename(self, place: Callable[[Origin], Origin]) -> None:
        """Name the statements of record, alarms, warnings and moves by their places in an edited text."""
        record = self._record
        # replaced and not changed: snapshots from before the edit share them
        record.statements[:] = [replace(copied(run), origin=place(run.origin)) for run in record.statements]
        # another tape: blocks of the old one belong to snapshots from before
        self._statements = Tape(record.statements, copied)
        record.acknowledged[:] = [
            alarm.replaced(statement=place(alarm.statement)) if isinstance(alarm.statement, Origin) else alarm
            for alarm in record.acknowledged
        ]
        self._warnings.rename(place)
        record.controller.rename(lambda line: place(line) if isinstance(line, Origin) else line)

    def renamed(self, left: Left, place: Callable[[Origin], Origin]) -> Left:
        """Return what was set aside, its statements named anew."""
        rest = tuple(replace(copied(run), origin=place(run.origin)) for run in left.rest)
        motion = left.motion
        if motion is not None:
            names = [place(line) if isinstance(line, Origin) else line for line in motion.statements]
            motion = replace(motion, statements=tuple(names))
        return replace(left, motion=motion, rest=rest)

    # --- snapshots ---------------------------------------------------------------------------------------------------

    @property
    def _settled(self) -> int:
        """How many statements of the record do not change any more."""
        activity, last = self._activity, len(self._record.statements) - 1  # the last one may be a WAIT that goes on
        first = last if activity is None else activity.first if isinstance(activity, Motion) else activity.run
        return max(0, min(first, last))

    def snapshot(self) -> TargetSnapshot:
        """Return controller, plant and record as a value."""
        record = self._record
        return TargetSnapshot(
            controller=record.controller.snapshot(),
            statements=self._statements.snapshot(self._settled),
            payloads=self._payloads.snapshot(len(record.payloads)),
            shown=self._shown.snapshot(len(record.shown)),
            acknowledged=tuple(record.acknowledged),
            activity=self._activity,
            warned=self._warnings.given,
        )

    def restore(self, snapshot: TargetSnapshot) -> None:
        """Put a snapshot back."""
        record = self._record
        record.controller.restore(snapshot.controller)
        self._statements.restore(snapshot.statements)
        self._payloads.restore(snapshot.payloads)
        self._shown.restore(snapshot.shown)
        record.acknowledged[:] = snapshot.acknowledged
        self._activity, self._warnings.given = snapshot.activity, snapshot.warned
