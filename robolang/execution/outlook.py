"""How much simulated time a run has left, by the rehearsal that was made before it.

A run follows its rehearsal statement by statement and is slower by what the arm needs to come into position. What takes
time and has begun is therefore found among the planned steps, and what is left is the plan of those that follow. A WAIT
takes as long as its inputs make it take: it may be in the run, in the rehearsal or in both. Once another statement
begins than the planned one, nothing is known of the rest, and nothing is guessed.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from robolang.execution.result import StatementRun
from robolang.interpreter.effects import Effect, MoveTo, Origin, Pass, SetHand
from robolang.syntax.ast import Wait


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedStep:
    """A statement that takes time in a rehearsal, us; ``waits``: it is a WAIT, whose time is that of its inputs."""

    origin: Origin
    begins_us: int
    ends_us: int
    waits: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeLeft:
    """Simulated time that a run has left, s; ``waiting``: after a WAIT that takes longer than planned."""

    seconds: float
    waiting: bool


def waits(effect: Effect | None) -> bool:
    """Return whether an effect is one of a WAIT."""
    return isinstance(effect, Pass) and isinstance(effect.node, Wait)


class Outlook:
    """Follows a run along its planned steps."""

    def __init__(self, steps: Sequence[PlannedStep]) -> None:
        self._steps = steps
        self._next = 0
        self._waits = self._lost = False
        self._begun_us = self._planned_us = 0

    def began(self, run: StatementRun, time_us: int) -> None:
        """Take note of a statement that begins to be carried out."""
        if not isinstance(run.effect, MoveTo | SetHand | Pass):
            return
        self._begun_us, self._planned_us, self._waits = time_us, 0, waits(run.effect)
        # a planned WAIT may have been true at once in the run, since its arm is later
        at = self._next
        while at < len(self._steps) and self._steps[at].origin != run.origin and self._steps[at].waits:
            at += 1
        if at < len(self._steps) and self._steps[at].origin == run.origin:
            self._next = at + 1
            self._planned_us = self._steps[at].ends_us - self._steps[at].begins_us
        elif not self._waits:
            self._lost = True

    def left(self, time_us: int) -> TimeLeft | None:
        """Return what is left at a simulated time; None: the run has left the steps that were planned."""
        if self._lost:
            return None
        before_us = self._steps[self._next - 1].ends_us if self._next else 0
        after_us = self._steps[-1].ends_us - before_us if self._steps else 0
        own_us = self._begun_us + self._planned_us - time_us
        return TimeLeft(seconds=(after_us + max(0, own_us)) / 1e6, waiting=self._waits and own_us < 0)
