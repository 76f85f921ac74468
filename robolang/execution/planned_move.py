"""A move with its plan, as what compares plan and program takes it, and what it finds."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import islice

from robolang.execution.target import Requested
from robolang.interpreter.effects import MoveTo
from runtime.core.frames import Array
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.chain.corner import Corner
from runtime.motion.commands import Command
from runtime.motion.motion_planner import ChainPlan
from runtime.motion.reached import Reached
from runtime.motion.speeds import Speeds


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedMove:
    """A move with its plan, and ``s`` (K,), the share of its path at its rows, alone or in a chain.

    ``speeds`` are those of its chain, in which it is move ``number``. ``corner`` and ``after``: the corner at its end
    and the plan of the next move, None: it stops there.
    """

    effect: MoveTo
    command: Command
    plan: MovePlan
    s: Array
    speeds: Speeds
    number: int
    corner: Corner | None = None
    after: MovePlan | None = None

    @property
    def reached(self) -> Reached:
        """What became of its speed."""
        return self.speeds.moves[self.number]


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedChain:
    """Moves as ``requested``, with the ``plan`` of their chain and its ``speeds``.

    ``corner`` at its end and the plan of the next move ``after`` it, which has to begin with a stop; else None.
    """

    requested: tuple[Requested, ...]
    plan: ChainPlan
    speeds: Speeds
    corner: Corner | None = None
    after: MovePlan | None = None

    def ended_before(self, following: Requested, plan: Callable[[Array, Command], MovePlan]) -> "PlannedChain":
        """Return the chain with what becomes of its end: it stops before a move that is to follow without a stop."""
        # the plan of that move is known: it was rehearsed when it was requested
        after = plan(self.plan.parts[-1].plan.q[-1], following.command)
        return replace(self, corner=Corner(radius=self.requested[-1].command.zone), after=after)


def planned_moves(planned: PlannedChain, first: int | None = None) -> Iterator[PlannedMove]:
    """Yield the ``first`` moves of a chain that has been planned, all without it."""
    chain, speeds = planned.plan, planned.speeds
    nexts = [*(part.plan for part in chain.parts[1:]), planned.after]
    rows = zip(planned.requested, chain.parts, (*chain.corners, planned.corner), nexts, strict=True)
    for number, (each, own, corner, after) in enumerate(islice(rows, first)):
        yield PlannedMove(
            effect=each.effect,
            command=each.command,
            plan=own.plan,
            s=own.s,
            speeds=speeds,
            number=number,
            corner=corner,
            after=after,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanFinding:
    """A difference between a program and its motion.

    ``remedy`` is what helps, or finds that by planning: for a finding that is shown alone. "": the remedy of the code.
    """

    code: str
    message: str
    remedy: str | Callable[[], str] = ""

    @property
    def hint(self) -> str:
        """What helps; computed each time."""
        return self.remedy if isinstance(self.remedy, str) else self.remedy()


Found = Iterator[PlanFinding]
