"""What stops a command or a program that runs in the foreground of a terminal: keys, and the signals of ``Signals``.

Esc and Space stop on the path, as the first Ctrl-C does. A terminal that goes away stops the arm as well.
"""

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from robolang.pendant.interrupts import Interrupt, Signals
from robolang.pendant.keyboard import Keyboard

STOPPING = frozenset({"escape", "space"})


class Foreground(Signals):
    """Requests to stop by keys and signals; ``watch`` is called in every cycle, to show where motion is."""

    def __init__(self, keyboard: Keyboard, watch: Callable[[], None] = lambda: None) -> None:
        super().__init__()
        self.keyboard, self.watch = keyboard, watch
        self.judge: Callable[[list[str]], bool] = lambda pressed: not STOPPING.isdisjoint(pressed)
        """Whether keys that were pressed since the last cycle, perhaps none, stop what runs."""
        self.stopped = False
        """Whether a stop has been requested since this was last set to False."""

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Read keys without echo, and handle the signals."""
        with super().watched(), self.keyboard.direct():
            yield

    def take(self) -> Interrupt | None:
        """Return what was requested since the last call."""
        self.watch()
        pressed = self.keyboard.pressed()
        if self.keyboard.closed:
            self.hang_up()
        # Ctrl-C counts twice within a second, these do not: a held key repeats
        request = super().take() or (Interrupt.STOP if self.judge(pressed) else None)
        self.stopped |= request is not None
        return request

    def hang_up(self) -> None:
        """Note that the terminal has gone."""
        self.lose(signal.SIGHUP)
