"""Where a program stops among its statements: steps, a line, breakpoints.

Each is data, and ``hit`` is a pure function of them and of where the program is. ``StopsAt`` is the hook for
``Executor.stops_before``. Calls are counted by their level, the CALLs and GOSUBs that have not come back, so a step
over a SUB that calls itself ends after the outermost of these calls.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias, assert_never

from robolang.core.source import Source
from robolang.execution.executor import Executor
from robolang.execution.status import ENDED, State
from robolang.execution.watching import expression
from robolang.interpreter.events import LineBegun
from runtime.core.faults import Fault

_CYCLES = 100
"""Cycles between two checks whether a program has stopped; it stops where it has to in any case."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Into:
    """Stops before the next statement, wherever it is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Over:
    """Stops before the next statement that is not inside of a call beyond ``level``: calls count as one statement."""

    level: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Out:
    """Stops when the call of ``level`` has come back, at level 0 nowhere."""

    level: int


@dataclass(frozen=True, slots=True, kw_only=True)
class To:
    """Stops before a line of the file, from 1."""

    line: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Breakpoint:
    """Stops before a line of the file, from 1, each time; with a ``condition`` where that is true, not 0.

    Where the condition has no value it stops as well, so that nobody waits for a stop that cannot come.
    """

    line: int
    condition: str = ""


Stop: TypeAlias = Into | Over | Out | To | Breakpoint


@dataclass(frozen=True, slots=True, kw_only=True)
class Hit:
    """Why a program has stopped; ``fault``: of the condition."""

    stop: Stop
    fault: Fault | None = None


def over(executor: Executor) -> Over:
    """Return the step over the statement at which a program stands."""
    return Over(level=executor.level)


def out(executor: Executor) -> Out:
    """Return the step out of the call in which a program stands."""
    return Out(level=executor.level)


def run_to(executor: Executor, line: int) -> None:
    """Run a program until the statement of a line of the file, from 1, is due, or it ends."""
    executor.stops_before = StopsAt(executor, [To(line=line)])
    # paused where it is due, and nothing is left to be done there
    while executor.advance(_CYCLES).state not in ENDED | {State.PAUSED}:
        pass
    executor.stops_before = None


def hit(executor: Executor, begun: LineBegun, stops: Sequence[Stop]) -> Hit | None:
    """Return which of the stops holds at a statement that is due, the first in order; None: none does."""
    return next((found for stop in stops if (found := _judged(executor, begun, stop)) is not None), None)


def _judged(executor: Executor, begun: LineBegun, stop: Stop) -> Hit | None:
    match stop:
        case Into():
            holds = True
        case Over():
            holds = executor.level <= stop.level
        case Out():
            holds = executor.level < stop.level
        case To():
            holds = begun.line == stop.line
        case Breakpoint():
            return _breaks(executor, stop) if begun.line == stop.line else None
        case _:
            assert_never(stop)
    return Hit(stop=stop) if holds else None


def _breaks(executor: Executor, stop: Breakpoint) -> Hit | None:
    # at every round of a loop: the text is short, and reading it takes less than a cycle
    try:
        return Hit(stop=stop) if not stop.condition or _is_true(executor, stop.condition) else None
    except Fault as fault:
        return Hit(stop=stop, fault=fault)


def _is_true(executor: Executor, condition: str) -> bool:
    return executor.evaluator.true(expression(Source("condition", condition)))


class StopsAt:
    """The hook of an executor for some stops; ``last``: why the program has stopped, None: it has not."""

    def __init__(self, executor: Executor, stops: Sequence[Stop]) -> None:
        self._executor, self._stops = executor, tuple(stops)
        self.last: Hit | None = None

    def __call__(self, begun: LineBegun) -> bool:
        """Return whether the program is paused before a statement."""
        self.last = hit(self._executor, begun, self._stops)
        return self.last is not None
