"""Keeps a program that people watch at a share of wall time."""

import math
import time

from runtime.control.clock import wall_s

LATE_S = 0.1
"""What a program is late by more than this, s, is lost: it is not caught up with at speed."""


class Pace:
    """Waits until each cycle is due; ``factor``: simulated seconds in one of wall time."""

    def __init__(self, factor: float = 1.0) -> None:
        self.factor = factor
        self._due_s = float("-inf")

    def wait(self, cycle_s: float, fastest: float = math.inf) -> None:
        """Wait for the end of a cycle of ``cycle_s`` simulated seconds that has been run; ``fastest``: the most that
        ``factor`` counts."""
        now = wall_s()
        # after a pause, or a jog that was planned for long, time begins anew
        if not now - self._due_s <= LATE_S:
            self._due_s = now
        self._due_s += cycle_s / min(self.factor, fastest)
        if self._due_s > now:
            time.sleep(self._due_s - now)
