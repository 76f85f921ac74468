"""The motion that a program will make, planned without making it: a rehearsal in the time of the plans.

The program is executed as in a run, by the same interpreter, lowering and planner, with simulated inputs, on a clock
that each statement moves on by what it takes: a move by its set-points, a HAND by its dwell, a DELAY by its time, all
in whole interpolation cycles. Only servo and physics are missing, and with them the time in which an arm comes into
position. A request that cannot be carried out goes to ON ERROR, as it would; one that nothing catches ends the
rehearsal: where the arm would be after it is not known.
"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Span
from robolang.execution import run_bounds
from robolang.execution.alarms import failure
from robolang.execution.executor import Executor
from robolang.execution.outlook import PlannedStep, waits
from robolang.execution.plan_memory import PlanMemory
from robolang.execution.planned_move import PlannedChain, planned_moves
from robolang.execution.repetition import NotedWorld, Repetition
from robolang.execution.status import ENDED, State
from robolang.execution.target import Requested, Untimed
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
)
from robolang.interpreter.events import Failed
from robolang.project.project import Project
from robolang.syntax.ast import Delay, Wait
from runtime.core.faults import Fault, lookup
from runtime.core.frames import Array
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.chain.corner import Corner
from runtime.motion.commands import Command
from runtime.motion.motion_planner import ChainPlan
from runtime.motion.speeds import Speeds
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.payload import NO_PAYLOAD, Payload


@dataclass(frozen=True, slots=True, kw_only=True)
class RehearsedMove:
    """A move of the rehearsal: its effect and plan, when it begins and ends, us, and its tool (4, 4).

    ``q`` (K, n) rad is where it goes, corners included, ``s`` (K,) the share of its path. Row 0 is sent at ``sent_us``:
    when the move begins, or in the cycle before it where it follows another. ``payload`` is the one declared last,
    ``corner`` what became of the corner to the next move, None where it stops. ``speeds`` are those of its chain, in
    which it is move ``number``.
    """

    effect: MoveTo
    plan: MovePlan
    command: Command
    begins_us: int
    ends_us: int
    sent_us: int
    q: Array
    s: Array
    X_flange_tool: Array
    payload: Payload
    corner: Corner | None
    speeds: Speeds
    number: int

    def share(self, row: int) -> float:
        """Return how far the move has come at a row of ``q``, in % of its path."""
        return 100.0 * float(self.s[row])


@dataclass(frozen=True, slots=True, kw_only=True)
class RehearsedHand:
    """A HAND of the rehearsal: its effect, ``after`` how many moves it comes and when it begins, us.

    The arm then is at q (n,) rad, with this tool (4, 4).
    """

    effect: SetHand
    after: int
    begins_us: int
    q: Array
    X_flange_tool: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Rehearsal:
    """What a rehearsal found: ``moves`` and ``hands`` in order, ``total_us``, and the refusal that ended it.

    ``times_us`` and ``runs`` give by line of the file what statements that take time took, and how often they ran;
    ``reached`` the places of all moves that the program came to, with those that were refused and caught by ON ERROR.
    ``kinematics`` are those that it was planned with, ``steps`` what takes time, in order.
    """

    moves: tuple[RehearsedMove, ...]
    hands: tuple[RehearsedHand, ...]
    times_us: dict[int, int]
    total_us: int
    refused: tuple[Diagnostic, ...]
    reached: frozenset[Span]
    runs: Mapping[int, int]
    kinematics: Kinematics
    steps: tuple[PlannedStep, ...]

    @property
    def preventing(self) -> tuple[Diagnostic, ...]:
        """What keeps the program from being started: RBL3xx, RBL4xx, and loops and runs without an end."""
        return tuple(item for item in self.refused if lookup(item.code).prevents_run)

    def preventing_within(self, most_us: int | None) -> tuple[Diagnostic, ...]:
        """What keeps a run of at most ``most_us`` from being started; None: of the usual time.

        One that is longer than somebody chose to wait is run up to there, an endless one as well (RBL509).
        """
        return tuple(item for item in self.preventing if most_us is None or item.code != "RBL509")


def motion_check(project: Project, plans: PlanMemory | None = None) -> tuple[Diagnostic, ...]:
    """Return what keeps a checked program from being started: RBL3xx, RBL4xx, and loops and runs without an end.

    ``plans`` keeps what is planned, for the run.

    Runtime errors (arithmetic, WAIT timeouts) are not reported here; they occur during the run.
    """
    return rehearse(project, plans=plans).preventing


def rehearse(
    project: Project,
    *,
    decisions: Decisions | None = None,
    plans: PlanMemory | None = None,
    most_us: int | None = None,
    every_round: bool = False,
    tell: Callable[[int], None] | None = None,
) -> Rehearsal:
    """Plan a checked program from its first statement to its last, or to what cannot be carried out.

    ``decisions`` may force conditions to another branch, ``plans`` may know plans already, ``most_us`` ends it earlier
    than ``run_bounds``. A loop that repeats itself for ever is planned for some rounds (RBL509); ``every_round``: up to
    that time. ``tell`` is called again and again with the simulated time that is planned, us.
    """
    plans = plans or PlanMemory(project)
    most_us = run_bounds.MAX_RUN_US if most_us is None else most_us
    target = _DryRun(project, plans, most_us)
    executor = _Executor(project, target, decisions=decisions, most_us=most_us)
    repetition = executor.watched(target, every_round=every_round, tell=tell)
    # paused where it repeats itself, and moves that were kept have come to their end
    while executor.advance().state not in ENDED | {State.PAUSED}:
        pass
    if repetition.found is not None and not target.refused:
        target.fail(repetition.found)
    return Rehearsal(
        moves=tuple(target.moves),
        hands=tuple(target.hands),
        times_us=target.times_us,
        total_us=target.time_us,
        refused=target.refused,
        reached=frozenset(target.reached),
        runs=dict(target.runs),
        kinematics=plans.kinematics,
        steps=tuple(target.steps),
    )


class _Executor(Executor):
    def watched(self, target: "_DryRun", *, every_round: bool, tell: Callable[[int], None] | None) -> Repetition:
        """Return what sees from now on whether the program repeats itself."""
        found = Repetition(self.project.program, self._engine.machine, target, every_round=every_round, tell=tell)
        self.stops_before = found
        return found


class _DryRun(Untimed):
    """The target of a rehearsal: its time goes on at once by the times of the plans."""

    def __init__(self, project: Project, plans: PlanMemory, most_us: int) -> None:
        cell = project.cell
        self._period_us, self._plans, self._most_us = project.profile.period_us, plans, most_us
        self.time_us = 0
        self.world = NotedWorld(project.points, cell, plans.kinematics, lambda: self.time_us)
        self.statement: Origin | None = None
        self._X_flange_tool = cell.hand.X_flange_tool
        self._payload = NO_PAYLOAD
        self.spent = 0
        self._q: Array = np.array(cell.home)
        self.moves: list[RehearsedMove] = []
        self.hands: list[RehearsedHand] = []
        self.reached: set[Span] = set()
        self.runs: Counter[int] = Counter()
        self.times_us: dict[int, int] = {}
        self.steps: list[PlannedStep] = []
        self.refused: tuple[Diagnostic, ...] = ()
        self._open: PlannedChain | None = None
        self._starts_us = self._passed = 0

    @property
    def q(self) -> Array:
        """Joint angles (n,) rad at which motion has ended."""
        return self._q

    def fail(self, fault: Failed) -> None:
        """Keep the fault that ends the rehearsal."""
        self.refused = (failure(fault),)

    def refuse(self, effect: Effect, fault: Fault) -> None:
        """Do nothing: the program answers."""

    # --- effects -----------------------------------------------------------------------------------------------------

    def begin(self, effect: Effect) -> None:
        """Count what takes time; a WAIT passes time cycle by cycle, but lets motion end once."""
        if isinstance(effect, MoveTo):
            # before it is planned: a move that is refused has been reached too
            self.reached.add(effect.span)
        if (
            isinstance(effect, MoveTo | SetHand)
            or isinstance(effect.node, Delay)
            or (isinstance(effect, Drain) and isinstance(effect.node, Wait))
        ):
            self.runs[effect.line] += 1
            self.spent += 1

    def rehearse(self, q_start: Array, command: Command) -> MovePlan:
        """Return the plan of a move."""
        return self._plans.plan(q_start, command, self._X_flange_tool)

    def move(self, chain: Sequence[Requested], *, more: bool = False) -> None:
        """Let moves pass: they are blended, and the command needs some cycles more to come to rest."""
        commands = [each.command for each in chain]
        plan = self._plans.chain(self._q, commands, self._X_flange_tool, more=more)
        self._keep(tuple(chain), plan, starts_us=self.time_us)
        if not more:
            self._pass()

    @property
    def more_due(self) -> bool:
        """Whether more moves are to follow those that have been planned."""
        plan = None if self._open is None else self._open.plan
        return plan is not None and plan.tail is not None and plan.tail.more_at is not None

    def extend(self, chain: Sequence[Requested], *, more: bool) -> int:
        """Let the moves pass that are over when more of them are planned; ``Fault`` RBL404 where these cannot go on."""
        planned = self._open
        assert planned is not None
        assert planned.plan.tail is not None
        at = planned.plan.tail.more_at
        assert at is not None
        try:
            commands = [each.command for each in chain]
            plan, over = self._plans.extend(planned.plan, at, commands, self._X_flange_tool)
        except Fault:
            # they stop at their end, and the time of the others begins there
            self._open = planned.ended_before(chain[0], self.rehearse)
            self._pass()
            raise
        starts_us = self._starts_us + (planned.plan.parts[over].first if over else 0) * self._period_us
        self._pass(over)
        self._keep((*planned.requested[over:], *chain), plan, starts_us=starts_us)
        if not more:
            self._pass()
        return over

    def finish(self) -> None:
        """Let the moves pass that nothing follows any more."""
        self._pass()

    def _keep(self, requested: tuple[Requested, ...], plan: ChainPlan, *, starts_us: int) -> None:
        """Keep a chain whose row 0 is sent at a time, until its moves pass."""
        speeds = Speeds(self._plans, plan, [each.command for each in requested], self._X_flange_tool)
        self._open, self._starts_us = PlannedChain(requested=requested, plan=plan, speeds=speeds), starts_us
        self._q = np.array(plan.parts[-1].plan.q[-1])

    def _pass(self, count: int | None = None) -> None:
        """Let so many moves pass, all without it: then the command comes to rest."""
        # what is left of it after these is part of the next plan
        planned, self._open = self._open, None
        if planned is None or self.time_us >= self._most_us:
            return
        plan = planned.plan
        # one for each row that is sent, the first as well where the arm stands there
        cycles = np.bincount(plan.command, minlength=len(plan.parts))
        cycles[0] -= self._passed
        if count is None:
            cycles[-1] += REST_CYCLES - 1 if len(plan.q) > 1 else 0
        if count != 0:
            self._passed = int(count is not None)
        for move, spent in zip(planned_moves(planned, count), cycles.tolist(), strict=False):
            begins, part = self.time_us, plan.parts[move.number]
            self._spend(move.effect, spent)
            if self.time_us >= self._most_us:  # the executor ends it there, and a run ends within this move as well
                return
            self.moves.append(
                RehearsedMove(
                    effect=move.effect,
                    plan=part.plan,
                    command=move.command,
                    begins_us=begins,
                    ends_us=self.time_us,
                    sent_us=self._starts_us + part.first * self._period_us,
                    corner=move.corner,
                    q=plan.q[part.first : part.last + 1],
                    s=part.s,
                    X_flange_tool=self._X_flange_tool,
                    payload=self._payload,
                    speeds=planned.speeds,
                    number=move.number,
                )
            )

    def _spend(self, effect: Effect, cycles: int) -> None:
        self.statement = effect.origin
        spent = cycles * self._period_us
        self.times_us[effect.line] = self.times_us.get(effect.line, 0) + spent
        self._note_step(effect, self.time_us + spent)
        self.time_us += spent

    def _note_step(self, effect: Effect, ends_us: int) -> None:
        origin, begins_us, waiting = effect.origin, self.time_us, waits(effect)
        # a WAIT passes its time cycle by cycle, and is one step
        if waiting and self.steps and self.steps[-1].waits and self.steps[-1].origin == origin:
            begins_us = self.steps.pop().begins_us
        self.steps.append(PlannedStep(origin=origin, begins_us=begins_us, ends_us=ends_us, waits=waiting))

    def wrist(self, effect: SetWrist) -> None:
        """Do nothing: each move carries the setting that holds for it."""

    def drain(self, effect: Drain) -> None:
        """Do nothing: motion has ended."""

    def load(self, effect: SetPayload, payload: Payload) -> None:
        """Keep the payload for the moves that follow."""
        self._payload = payload

    def hand(self, effect: SetHand, cycles: int) -> None:
        """Keep where the hand moves, and let it dwell."""
        self.hands.append(
            RehearsedHand(
                effect=effect,
                after=len(self.moves),
                begins_us=self.time_us,
                q=self._q,
                X_flange_tool=self._X_flange_tool,
            )
        )
        self._spend(effect, cycles)

    def seam(self, effect: SetSeam) -> None:
        """Do nothing: what a sensor will see is not known."""

    def tool(self, effect: SetTool, X_flange_tool: Array) -> None:
        """Plan with another tool."""
        self._X_flange_tool = X_flange_tool

    def output(self, effect: SetOutput) -> None:
        """Do nothing: its signal has been set."""

    def wait(self, effect: Pass, cycles: int) -> None:
        """Let cycles pass."""
        self._spend(effect, cycles)

    def show(self, effect: Show) -> None:
        """Show nothing."""

    def halt(self, effect: Halt) -> None:
        """Do nothing: the program ends itself."""


REST_CYCLES = 4
"""Cycles from the last set-point of a move to where the fine interpolator stands still, and the program goes on."""
