"""What shows on a terminal that programs are planned, and how far."""

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from robolang.core.diagnostics import safe

if TYPE_CHECKING:
    from rich.status import Status

_EVERY_S = 0.1
"""Wall time between two texts, s: a program has many thousand statements."""


class PlanningProgress:
    """Shows the program that is planned in a line, and the simulated time that is planned of it."""

    def __init__(self, count: int, status: "Status | None") -> None:
        self._count, self._status = count, status
        self._name, self._shown = "", 0.0

    def begin(self, number: int, name: str) -> None:
        """Show that program ``number``, from 0, is begun."""
        self._name = safe(name) + (f", {number + 1} of {self._count}" if self._count > 1 else "")
        self._show("")

    def planned(self, time_us: int) -> None:
        """Show how much of it is planned, us of simulated time."""
        if time.monotonic() - self._shown >= _EVERY_S:
            self._show(f": {time_us / 1e6:.1f} s")

    def _show(self, planned: str) -> None:
        self._shown = time.monotonic()
        if self._status is not None:
            self._status.update(f"planning {self._name}{planned}")


@contextmanager
def planning(count: int = 1, *, quiet: bool = False) -> Iterator[PlanningProgress]:
    """Yield the progress of planning ``count`` programs; seen on a terminal alone, unless ``quiet``."""
    if quiet or sys.stderr is None or not sys.stderr.isatty():
        yield PlanningProgress(count, None)
        return
    from robolang.cli.console import Console

    with Console(stderr=True).status("planning") as status:
        yield PlanningProgress(count, status)
