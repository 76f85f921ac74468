"""The dead-man of jogging with keys: a terminal tells that a key is pressed, and never that it is released.

One press is one step. A key that is held repeats: from its second repeat on the jog goes on, and it stops ``ALIVE_S``
after the last one. Another key, Esc and Space stop at once. Nothing is queued: what is pressed while a step runs is
dropped, so that no motion follows a release (a held key goes on when its step has ended).

The caller gives the time of every event; no clock is read here. s.
"""

from dataclasses import dataclass
from enum import Enum

ALIVE_S = 0.2
"""Time after the last repeat in which a jog goes on, s."""

FIRST_REPEAT_S = 0.7
"""Terminals begin to repeat a held key after less than this, s; the repeats then follow within ``ALIVE_S``."""

CONTINUOUS_FROM = 2
"""The repeat from which a held key moves the arm continuously."""

STOP_KEYS = ("escape", " ")
"""Keys that stop whatever runs."""


class Act(Enum):
    """What a key is to do."""

    STEP = "step"
    """Jog by one step."""
    GO_ON = "go on"
    """Jog as far as it goes, until the dead-man expires."""
    STOP = "stop"
    """Bring the arm to rest, beginning in the next cycle."""
    NOTHING = "nothing"
    """Leave it as it is."""


@dataclass(slots=True)
class DeadMan:
    """Which key is held, for how many repeats, and when it was last seen. Axes are keys; other keys are no concern."""

    key: str = ""
    repeats: int = 0
    seen_s: float = 0.0
    continuous: bool = False
    stopping: bool = False

    def press(self, key: str, now_s: float, *, moving: bool) -> Act:
        """Return what an event of a key at ``now_s`` is to do while the arm moves or stands."""
        if not moving:
            self.continuous = self.stopping = False
        if key in STOP_KEYS:
            self.key, self.repeats = "", 0
            return self._stop(moving)
        # expired: a repeat that comes late must not revive it. Another key: who reaches for it means the first to end
        if moving and (key != self.key or self.expired(now_s)):
            self.key, self.repeats = "", 0
            return self._stop(moving)
        self._count(key, now_s)
        return self._go(moving)

    def _go(self, moving: bool) -> Act:
        if moving:
            return Act.NOTHING
        if self.repeats >= CONTINUOUS_FROM:
            self.continuous = True
            return Act.GO_ON
        return Act.STEP

    def _count(self, key: str, now_s: float) -> None:
        since = now_s - self.seen_s
        # the pause before the first repeat is longer than those between repeats; later such a pause is another press
        most = ALIVE_S if self.repeats else FIRST_REPEAT_S
        held = key == self.key and 0.0 <= since <= most
        self.repeats = self.repeats + 1 if held else 0
        self.key, self.seen_s = key, now_s

    def expired(self, now_s: float) -> bool:
        """Return whether a continuous jog has to stop at ``now_s``: its key was last seen too long ago."""
        return self.continuous and not 0.0 <= now_s - self.seen_s <= ALIVE_S

    def stop(self) -> None:
        """Take note that the arm is brought to rest: expired, or the terminal is lost. No repeat revives the jog."""
        self.key, self.repeats = "", 0
        self._stop(True)

    def _stop(self, moving: bool) -> Act:
        self.continuous = False
        # one stop is enough: the keys that follow it while the arm brakes are dropped
        stops = moving and not self.stopping
        self.stopping = moving
        return Act.STOP if stops else Act.NOTHING
