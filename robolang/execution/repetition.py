"""Whether a program that is rehearsed goes round for ever, doing the same in every round.

At each jump back the state of the program is compared with that of its last visit there: the names that it acts on (not
what it only counts and prints), loops, calls and settings, and where the arm is. Where it is the same twice in a row,
and nothing was read between that time may change, every round that follows is the one before, and no longer rehearsal
shows anything new. Tool, load and the like need no comparison: a round that sets them sets them to the same again.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from robolang.analysis.facts import parts_of
from robolang.analysis.reads import reads
from robolang.execution.world import RobotWorld
from robolang.interpreter.events import Failed, LineBegun
from robolang.interpreter.machine import Machine
from robolang.interpreter.scope import Scope
from robolang.syntax.ast import Print, Program
from runtime.core.frames import Array

_ALIKE = 2
"""Rounds that end as they began, until a loop counts as one that repeats: parts lie elsewhere after the first."""
_SAME = 1e-9
"""Joints that differ by less are the same, rad or m: an answer of iterations depends on where they began."""
_REMEDY = (
    "Give the loop an end that a simulation reaches: a count of rounds, TIMER, or an input of the cell; or let "
    "'robolang run --max-time 60' run it for 60 s."
)


class NotedWorld(RobotWorld):
    """A world that counts in ``changing`` what was read of it that time alone may change."""

    changing = 0

    def input(self, number: int) -> float:
        """Return the state of an input; ``Fault`` RBL534."""
        found = super().input(number)
        self.changing += not self.signals.is_settled(number, self._now_us())
        return found

    def seconds(self) -> float:
        """Return the time since the program began, s."""
        self.changing += 1
        return super().seconds()


class Rehearsing(Protocol):
    """What is watched of a target: its world and its time, and how many effects took time."""

    world: NotedWorld
    time_us: int
    spent: int


@dataclass(frozen=True, slots=True, kw_only=True)
class _Visit:
    """A jump back to a place: the state there, and in how many rounds since the arm has done what it did before."""

    state: tuple[object, ...]
    q: Array
    changing: int
    spent: int
    alike: int


class Repetition:
    """A hook of ``Executor.stops_before`` that stops a program which repeats itself, unless ``every_round`` is wanted.

    At every statement ``tell`` is called with the time, us.
    """

    def __init__(
        self,
        program: Program,
        machine: Machine,
        target: Rehearsing,
        *,
        every_round: bool,
        tell: Callable[[int], None] | None,
    ) -> None:
        self._machine, self._target, self._every_round, self._tell = machine, target, every_round, tell
        self._acts_on = _acted_on(program)
        self._last = -1
        self._visits: dict[int, _Visit] = {}
        self.found: Failed | None = None
        """The fault of a program that repeats; None: none has been seen."""

    def __call__(self, due: LineBegun) -> bool:
        """Return whether the program repeats itself at a statement that is due."""
        if self._tell is not None:
            self._tell(self._target.time_us)
        at, last = due.span.start, self._last
        self._last = at
        if at <= last and not self._every_round:
            self._visit(due)
        return self.found is not None

    def _visit(self, due: LineBegun) -> None:
        target, before = self._target, self._visits.get(due.span.start)
        # a round that takes no time changes names alone; it has a bound of its own (RBL508)
        if before is not None and before.spent == target.spent:
            return
        now = _Visit(
            state=self._state(),
            q=np.array(target.world.q_last),
            changing=target.world.changing,
            spent=target.spent,
            alike=0,
        )
        if before is not None and _repeats(before, now):
            now = replace(now, alike=before.alike + 1)
        self._visits[due.span.start] = now
        if now.alike >= _ALIKE:
            self.found = self._fault(due)

    def _state(self) -> tuple[object, ...]:
        """Return what the next statements depend on; what is counted for the bounds of a program is no part of it."""
        kept = self._machine.snapshot()
        scopes = [self._of_names(scope) for scope in kept.scopes]
        return (kept.cursor, kept.suspended, scopes, kept.settings, kept.frame, kept.error, kept.decisions)

    def _of_names(self, scope: Scope) -> Scope:
        values = {key: value for key, value in scope.values.items() if key in self._acts_on}
        return replace(scope, values=values, cells=0, texts=0)

    def _fault(self, due: LineBegun) -> Failed:
        loop = self._machine.loop
        origin, rounds = (due, _ALIKE) if loop is None else loop
        message = (
            f"this loop never ends: it has gone round {rounds} times, and nothing that it depends on changes any more, "
            "so all further rounds are the same; they are not planned"
        )
        return Failed(code="RBL509", message=message, hint=_REMEDY, origin=origin, calls=self._machine.calls)


def _acted_on(program: Program) -> frozenset[str]:
    """Return the names that statements read, but for PRINT, and for one that only counts itself on."""
    nodes = (node for line in program.statements for node in parts_of(line.statement))
    return frozenset(key for node in nodes if not isinstance(node, Print) for key in reads(node))


def _repeats(before: _Visit, now: _Visit) -> bool:
    same = before.changing == now.changing and bool(np.abs(before.q - now.q).max() <= _SAME)
    return same and before.state == now.state
