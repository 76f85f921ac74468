"""The motion that a program will make, planned without making it: a rehearsal in the time that the plans say.

The program is executed as in a run, by the same interpreter, lowering and planner, with simulated inputs, on a clock
that each statement moves on by what it takes: a move by its set-points, a HAND by its dwell, a DELAY by its time, all
in whole interpolation cycles. Only servo and physics are missing, and with them the time in which an arm comes into
position. A request that cannot be carried out goes to ON ERROR, as it would; one that nothing catches ends the
rehearsal: where the arm would be after it is not known.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Span
from robolang.execution import lowering
from robolang.execution.alarms import calls
from robolang.execution.plan_memory import PlanMemory
from robolang.execution.world import RobotWorld
from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import (
    Drain,
    Effect,
    Halt,
    MoveTo,
    Pass,
    SetHand,
    SetOutput,
    SetPayload,
    SetSeam,
    SetTool,
    SetWrist,
)
from robolang.interpreter.machine import Machine
from robolang.interpreter.program_fault import ProgramFault
from robolang.project.project import Project
from robolang.syntax.ast import Delay, Wait
from runtime.core.faults import Fault, lookup
from runtime.core.frames import Array
from runtime.motion.blend import Corner
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import Command
from runtime.motion.motion_planner import tracked
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.payload import NO_PAYLOAD, Payload

MAX_CHAIN = 200
"""Most moves that blend into one another without a stop: a program that never stops is carried out nevertheless."""
MAX_RUN_US = 1_800_000_000
"""Longest run, us of simulated time: about a kilobyte of log is kept for every tick."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RehearsedMove:
    """A move of the rehearsal: its effect and plan, and when it begins and ends, us.

    ``q`` (K, n) rad are its set-points as they are carried out, blends included, row 0 of them row ``first`` of the
    plan. ``payload`` is the one declared last, ``corner`` what became of the blend into the next move, None where it
    stops.
    """

    effect: MoveTo
    plan: MovePlan
    command: Command
    begins_us: int
    ends_us: int
    q: Array
    first: int
    payload: Payload
    corner: Corner | None

    def share(self, row: int) -> float:
        """Return how far the move has come at a row of ``q``, in % of its way."""
        return 100.0 * float(self.plan.s[min(max(row + self.first, 0), len(self.plan.s) - 1)])


@dataclass(frozen=True, slots=True, kw_only=True)
class RehearsedHand:
    """A HAND of the rehearsal: its effect, ``after`` how many moves it comes, and q (n,) rad where the arm then is."""

    effect: SetHand
    after: int
    q: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Rehearsal:
    """What a rehearsal found: ``moves`` and ``hands`` in order, ``total_us``, and the refusal that ended it.

    ``times_us`` and ``runs`` give by line of the file what statements that take time took, and how often they ran;
    ``tried`` the places of all moves that were asked for, those that were refused and caught by ON ERROR among them.
    ``kinematics`` are those that it was planned with.
    """

    moves: tuple[RehearsedMove, ...]
    hands: tuple[RehearsedHand, ...]
    times_us: dict[int, int]
    total_us: int
    refused: tuple[Diagnostic, ...]
    tried: frozenset[Span]
    runs: Mapping[int, int]
    kinematics: Kinematics


def motion_check(project: Project, plans: PlanMemory | None = None) -> tuple[Diagnostic, ...]:
    """Return what keeps a checked program from being started: RBL3xx, RBL4xx, and loops and runs without an end.

    ``plans`` keeps what is planned, for the run.

    An error of its calculations or a WAIT that times out is none of that: it comes in the run, where it comes.
    """
    return tuple(item for item in rehearse(project, plans=plans).refused if lookup(item.code).prevents_run)


def rehearse(
    project: Project, *, decisions: Decisions | None = None, plans: PlanMemory | None = None, most_us: int | None = None
) -> Rehearsal:
    """Plan a checked program from its first statement to its last, or to what cannot be carried out.

    ``decisions`` may send conditions another way, ``plans`` may know plans already, ``most_us`` ends it earlier than
    ``MAX_RUN_US``.
    """
    return _Rehearsal(
        project,
        plans or PlanMemory(project),
        decisions or Decisions(),
        MAX_RUN_US if most_us is None else most_us,
    ).run()


class _Rehearsal:
    """A rehearsal under way."""

    def __init__(self, project: Project, planner: PlanMemory, decisions: Decisions, most_us: int) -> None:
        cell = project.cell
        self._project, self._period_us, self._planner = project, project.profile.period_us, planner
        self._most_us = most_us
        self._now_us = 0
        self._world = RobotWorld(project.points, cell, planner.kinematics, lambda: self._now_us)
        self._machine = Machine(project.program, self._world, project.points.names, decisions)
        self._tracked = False
        self._payload = NO_PAYLOAD
        self._chain: list[tuple[MoveTo, Command, MovePlan]] = []
        self._q_next: Array = np.array(cell.home)
        self._moves: list[RehearsedMove] = []
        self._hands: list[RehearsedHand] = []
        self._tried: set[Span] = set()
        self._runs: Counter[int] = Counter()
        self._times: dict[int, int] = {}

    def run(self) -> Rehearsal:
        """Rehearse to the end."""
        program = self._machine.run()
        fault: Fault | None = None
        refused: tuple[Diagnostic, ...] = ()
        while True:
            try:
                effect = next(program) if fault is None else program.throw(fault)
            except StopIteration:
                break
            except ProgramFault as uncaught:
                refused = (
                    Diagnostic(
                        code=uncaught.code,
                        message=uncaught.message,
                        span=uncaught.origin.span,
                        hint=uncaught.hint,
                        related=calls(uncaught.calls),
                    ),
                )
                break
            fault = None
            try:
                if not self._take(effect):
                    break
            except Fault as found:
                fault = found
        self._finish_motion()
        return Rehearsal(
            moves=tuple(self._moves),
            hands=tuple(self._hands),
            times_us=self._times,
            total_us=self._now_us,
            refused=refused,
            tried=frozenset(self._tried),
            runs=dict(self._runs),
            kinematics=self._planner.kinematics,
        )

    def _take(self, effect: Effect) -> bool:
        # a WAIT passes time cycle by cycle, but lets motion end once
        if (
            isinstance(effect, MoveTo | SetHand)
            or isinstance(effect.node, Delay)
            or (isinstance(effect, Drain) and isinstance(effect.node, Wait))
        ):
            self._runs[effect.line] += 1
        if isinstance(effect, MoveTo):
            self._move(effect)
            return True
        if isinstance(effect, SetWrist):  # each move carries what it says, so nothing has to end for it
            return True
        self._finish_motion()
        if isinstance(effect, SetPayload):
            self._payload = lowering.payload(effect, self._project.cell)
        elif isinstance(effect, SetHand):
            seconds = lowering.dwell_s(effect, self._project.cell)
            self._hands.append(RehearsedHand(effect=effect, after=len(self._moves), q=self._q_next))
            self._spend(effect, -(-round(seconds * 1e6) // self._period_us))
        elif isinstance(effect, Pass):
            self._spend(effect, max(1, -(-round(effect.seconds * 1e6) // self._period_us)))
        elif isinstance(effect, SetSeam):
            self._tracked = effect.sensor is not None
        elif isinstance(effect, SetTool):
            self._world.X_flange_tool = lowering.tool(effect.tool, self._project.cell)
        elif isinstance(effect, SetOutput):
            self._world.set_output(effect.output, effect.value, effect.seconds)
        return not (isinstance(effect, Halt) and effect.word == "STOP")

    def _spend(self, effect: Effect, cycles: int) -> None:
        spent = cycles * self._period_us
        self._times[effect.line] = self._times.get(effect.line, 0) + spent
        self._now_us += spent
        if self._now_us >= self._most_us:
            raise self._machine.too_long(effect.origin, self._most_us / 1e6)

    def _move(self, effect: MoveTo) -> None:
        self._tried.add(effect.span)
        self._world.q_last = self._q_next
        command = lowering.move(effect, self._world.around)
        if self._tracked:
            command = tracked(command)
        plan = self._planner.plan(self._q_next, command, self._world.X_flange_tool)
        self._q_next = np.array(plan.q[-1])
        self._chain.append((effect, command, plan))
        if not command.zone > 0.0 or len(plan.q) == 1 or len(self._chain) >= MAX_CHAIN:
            self._finish_motion()

    def _finish_motion(self) -> None:
        """Let the moves that are kept pass: they are blended, and the command needs two cycles more to come to rest."""
        if not self._chain:
            return
        chain, self._chain = self._chain, []
        joined = self._planner.join(
            [plan for *_, plan in chain], [command.zone for _, command, _ in chain], self._world.X_flange_tool
        )
        begins = self._now_us
        cycles = np.bincount(joined.command, minlength=len(chain))  # one for each row that is sent, the first as well
        cycles[-1] += REST_CYCLES - 1 if len(joined.q) > 1 else 0
        each = zip(chain, joined.parts, [*joined.corners, None], cycles.tolist(), strict=True)
        for (effect, command, plan), part, corner, spent in each:
            self._spend(effect, spent)
            self._moves.append(
                RehearsedMove(
                    effect=effect,
                    plan=plan,
                    command=command,
                    begins_us=begins,
                    ends_us=self._now_us,
                    corner=corner,
                    q=joined.q[part.first : part.last + 1],
                    first=part.first - part.offset,
                    payload=self._payload,
                )
            )
            begins = self._now_us
        self._world.q_last = self._q_next


REST_CYCLES = 4
"""Cycles from the last set-point of a move to where the fine interpolator stands still, and the program goes on."""
