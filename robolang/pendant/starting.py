"""Building the controller in a thread of its own while somebody may type: numerics and physics take their time."""

import gc
from collections.abc import Callable
from threading import Event, Thread
from typing import TYPE_CHECKING

from robolang.core.defects import internal
from robolang.pendant.failure import Failure, of_fault
from runtime.core.faults import Fault

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant


class Starting:
    """The start of the controller of a pendant. ``failure``: why there is none, when it is over."""

    def __init__(self, pendant: "Pendant") -> None:
        self._pendant = pendant
        self._over = Event()
        self._then: Callable[[], None] = lambda: None
        # a daemon: leaving the prompt does not wait for a controller that nobody needs any more
        self._thread = Thread(target=self._build, daemon=True, name="starting")
        self.failure: Failure | None = None

    def begin(self, then: Callable[[], None]) -> None:
        """Begin, once; ``then`` is called in the thread when it is over."""
        if self._thread.ident is None:
            self._then = then
            self._thread.start()

    @property
    def is_over(self) -> bool:
        """Whether the controller is there, or cannot be had."""
        return self._over.is_set()

    def wait(self, seconds: float) -> bool:
        """Wait until it is over, at most so long; return whether it is."""
        return self._over.wait(seconds)

    def _build(self) -> None:
        try:
            _ = self._pendant.live
        except Fault as fault:
            self.failure = of_fault(fault)
        except Failure as failure:
            self.failure = failure
        except Exception as error:
            self.failure = of_fault(internal(error))
        # what imports leave is never garbage: searched again and again, it would delay keys by 10 ms
        gc.freeze()
        gc.enable()
        self._over.set()
        self._then()
