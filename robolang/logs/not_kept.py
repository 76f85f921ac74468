"""The rows of a run that was carried out without a log: there are none, and who asks for one learns why."""

from typing import NoReturn

import robolang.core.codes  # noqa: F401 - RBL822 must be registered
from runtime.core.faults import Fault
from runtime.core.frames import Array


class NotKept:
    """No rows: ``runtime.control.signals.Rows`` of which each is a ``Fault`` RBL822."""

    @property
    def ticks(self) -> int:
        """Refuse."""
        self._refuse()

    cycles = frames = ticks_per_cycle = tick_us = ticks

    @property
    def tools(self) -> tuple[Array, ...]:
        """Refuse."""
        self._refuse()

    def read(self, name: str, first: int, last: int) -> Array:
        """Refuse."""
        self._refuse()

    @staticmethod
    def _refuse() -> NoReturn:
        raise Fault("RBL822", "the signals of this run were not kept")
