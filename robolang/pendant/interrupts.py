"""What stops motion from outside: signals here, keys of a terminal in ``keys``.

The first Ctrl-C stops the motion on its path and keeps the prompt; a second one within a second stops at once (category
0). A terminal that is closed, or SIGTERM, stops on the path as well, and then the prompt ends.
"""

import signal
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from enum import Enum, auto
from typing import Protocol

from runtime.control.clock import wall_s

AT_ONCE_S = 1.0
"""A second Ctrl-C within so many seconds of wall time stops at once."""


class Interrupt(Enum):
    """A request to stop: on the path, or at once."""

    STOP = auto()
    HALT = auto()


class Interrupts(Protocol):
    """Where requests to stop come from while the arm moves."""

    lost: bool
    """Whether the terminal is gone or the process is to end: the prompt ends after the stop."""

    def watched(self) -> AbstractContextManager[None]:
        """Watch while the arm moves."""

    def take(self) -> Interrupt | None:
        """Return what was requested since the last call; called in every cycle."""


class Signals:
    """Requests by SIGINT, and by SIGTERM and SIGHUP, which end the prompt after the stop."""

    def __init__(self) -> None:
        self.lost = False
        self.signal = 0
        """The signal that ends the prompt, 0 for none."""
        self._last_s = float("-inf")
        self._request: Interrupt | None = None

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Handle the signals as requests; outside of this Ctrl-C is a KeyboardInterrupt."""
        # SIGHUP: the terminal was closed while the arm moves; without a handler the process would end in motion
        handlers = {signal.SIGINT: self._interrupted, signal.SIGTERM: self._ended, signal.SIGHUP: self._ended}
        before = {number: signal.signal(number, handle) for number, handle in handlers.items()}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    @contextmanager
    def ending(self) -> Iterator[None]:
        """Let SIGTERM and SIGHUP end the prompt while nothing moves, too: ``lost``, and ``KeyboardInterrupt``."""

        def end(number: int, _frame: object) -> None:
            self.lose(number)
            raise KeyboardInterrupt

        before = {number: signal.signal(number, end) for number in (signal.SIGTERM, signal.SIGHUP)}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def take(self) -> Interrupt | None:
        """Return what was requested since the last call."""
        # taken once: a request that stays would stop the next motion as well
        request, self._request = self._request, None
        return request

    def request(self) -> None:
        """Request a stop on the path, or at once when the last request is younger than ``AT_ONCE_S``."""
        # wall time, since it is a person who presses the key twice
        now = wall_s()
        self._request = Interrupt.HALT if now - self._last_s < AT_ONCE_S else Interrupt.STOP
        self._last_s = now

    def _interrupted(self, _number: int, _frame: object) -> None:
        self.request()

    def lose(self, number: int) -> None:
        """Note that the prompt has to end by a signal; the first one counts."""
        self.signal = self.signal or number
        if not self.lost:
            self.lost, self._request = True, Interrupt.STOP

    def _ended(self, number: int, _frame: object) -> None:
        self.lose(number)


class ScriptSignals(Signals):
    """Signals of a script: Ctrl-C ends it too, after the stop, since nobody is there for its next line."""

    def _interrupted(self, number: int, _frame: object) -> None:
        self.request()
        self.signal, self.lost = self.signal or number, True
