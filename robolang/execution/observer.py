"""What can be observed of a program while it is carried out: a class whose methods do nothing.

Hand an observer to ``Executor`` or ``Session``. Observers see; they change nothing, so a run
with one gives the same log as a run without.
"""

from robolang.execution.result import StatementRun
from robolang.interpreter.effects import Effect
from robolang.interpreter.events import LineBegun
from runtime.core.faults import Alarm


class Observer:
    """Watches a program; every method is empty, so that an observer overrides those that it needs."""

    def statement_began(self, statement: LineBegun) -> None:
        """See a statement of the program that is due, assignments too; nothing of it has happened."""

    def run_began(self, run: StatementRun, time_us: int) -> None:
        """See that a statement begins to be carried out; of moves that blend each when its first set-point is sent."""

    def effect_done(self, effect: Effect) -> None:
        """See that an effect has been carried out; a WAIT has one in each cycle."""

    def cycle_done(self, time_us: int) -> None:
        """See that an interpolation cycle has been run, up to this simulated time."""

    def alarm(self, alarm: Alarm) -> None:
        """See the alarm that ends the program; the arm may still be stopping."""

    def printed(self, text: str) -> None:
        """See a line that PRINT shows."""


class Observers(Observer):
    """Several observers of one program, in this order; more may be added while it runs."""

    def __init__(self, *observers: Observer) -> None:
        self._all = observers

    def add(self, observer: Observer) -> None:
        """Let one more see what happens from now on."""
        # a new tuple: the program may be in the middle of the old one
        self._all = (*self._all, observer)

    def statement_began(self, statement: LineBegun) -> None:
        """Pass it on."""
        for each in self._all:
            each.statement_began(statement)

    def run_began(self, run: StatementRun, time_us: int) -> None:
        """Pass it on."""
        for each in self._all:
            each.run_began(run, time_us)

    def effect_done(self, effect: Effect) -> None:
        """Pass it on."""
        for each in self._all:
            each.effect_done(effect)

    def cycle_done(self, time_us: int) -> None:
        """Pass it on."""
        for each in self._all:
            each.cycle_done(time_us)

    def alarm(self, alarm: Alarm) -> None:
        """Pass it on."""
        for each in self._all:
            each.alarm(alarm)

    def printed(self, text: str) -> None:
        """Pass it on."""
        for each in self._all:
            each.printed(text)
