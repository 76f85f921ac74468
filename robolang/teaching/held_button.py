"""The dead-man of a button on a page: a jog runs while its button sends that it is held, and no longer.

Unlike a terminal (``dead_man``) a page has a true press and release. What is lost is the last message: of a page that
stalls, a browser that ends, a network that breaks. So the page repeats that the button is held, and without such a
sign for ``ALIVE_S`` the jog has to stop. What has expired, or was released, cannot be revived: a jog begins with a
press alone.

Two threads share a ``HeldButton``: one hands over what the page sends, the other asks in each cycle ``holds``. A press
is one frozen value, replaced by one assignment. The caller gives the time of every event; no clock is read here. s.
"""

import math
from dataclasses import dataclass, replace

from robolang.teaching.dead_man import ALIVE_S


@dataclass(frozen=True, slots=True, kw_only=True)
class Press:
    """A button that is held: of which ``page``, which ``jog`` of it, and when that was last seen."""

    page: int
    jog: int
    seen_s: float

    def alive(self, now_s: float) -> bool:
        """Return whether the button counts as held at ``now_s``; not at a time that is none, or before it was seen."""
        return 0.0 <= now_s - self.seen_s <= ALIVE_S


class HeldButton:
    """The one button that is held, if any."""

    def __init__(self) -> None:
        self._press: Press | None = None

    def press(self, page: int, jog: int, now_s: float) -> Press:
        """Hold a button from now on; one that was held before is released."""
        # one at a time: who presses a second button has let go of the first, or does not mean it
        self._press = press = Press(page=page, jog=jog, seen_s=now_s)
        return press

    def keep(self, page: int, jog: int, now_s: float) -> bool:
        """Take note that a button is still held; False, and it is released, where that comes too late."""
        press = self._press
        # also a sign that comes after its release: it must not begin the jog anew
        if press is None or (press.page, press.jog) != (page, jog):
            return False
        alive = press.alive(now_s)
        # one that was never seen: no time revives it, and it is known that nobody has released it
        self._press = replace(press, seen_s=now_s if alive else -math.inf)
        return alive

    def release(self, page: int | None = None, jog: int | None = None) -> None:
        """Release the button of a jog, of a page, or whichever is held."""
        press = self._press
        if press is not None and page in (None, press.page) and jog in (None, press.jog):
            self._press = None

    def holds(self, begun: Press, now_s: float) -> bool:
        """Return whether the jog of a press may go on at ``now_s``."""
        # read once: the other thread may replace it in between
        press = self._press
        return press is not None and (press.page, press.jog) == (begun.page, begun.jog) and press.alive(now_s)

    def lapsed(self, begun: Press, now_s: float) -> bool:
        """Return whether the jog of a press has to stop at ``now_s`` since signs are missing, and not by a release."""
        press = self._press
        same = press is not None and (press.page, press.jog) == (begun.page, begun.jog)
        return same and not self.holds(begun, now_s)
