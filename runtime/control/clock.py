"""Clocks: virtual time runs as fast as it can, paced time waits for wall time. No other module reads the wall clock."""

import time
from typing import Protocol


class Clock(Protocol):
    """Gets the start of every cycle, and may wait for it."""

    def wait_until(self, t_us: int) -> bool:
        """Wait until simulated time ``t_us`` is due; True when it was already late by more than a cycle."""

    def restart(self) -> None:
        """Forget where wall time was: simulated time goes on from another instant."""


class VirtualClock:
    """Never waits: simulated time is whatever the controller says."""

    def wait_until(self, t_us: int) -> bool:
        """Return at once."""
        return False

    def restart(self) -> None:
        """Do nothing: no wall time is kept."""


class PacedClock:
    """Keeps simulated time at wall time (``--realtime``); a cycle that starts late by a period is an overrun."""

    def __init__(self, period_us: int) -> None:
        self._late_s = period_us * 1e-6
        self._origin: float | None = None

    def wait_until(self, t_us: int) -> bool:
        """Sleep until ``t_us`` of wall time have passed since the first call; True when late by a period."""
        now = time.monotonic()
        if self._origin is None:
            # not at 0: after ``restart`` simulated time goes on from where the snapshot was
            self._origin = now - t_us * 1e-6
        ahead = self._origin + t_us * 1e-6 - now
        if ahead > 0.0:
            time.sleep(ahead)
            return False
        if -ahead <= self._late_s:
            return False
        self._origin -= ahead  # count a late start once, then go on from here
        return True

    def restart(self) -> None:
        """Begin anew with the next cycle."""
        self._origin = None


def wall_s() -> float:
    """Return seconds of a monotonic wall clock, for reports of the real-time factor."""
    return time.monotonic()
