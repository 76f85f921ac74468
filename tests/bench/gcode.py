"""G-code as moves: what a milling program asks of a look-ahead, for the planner to be measured on.

Read are G0 to G3 in the planes G17, G18, G19, with G20, G21, G90, G91, G90.1, G91.1, G61, G61.1, G64, F, parameters and
expressions. A helix, a spiral and an arc of many turns become short lines. Words of spindle, coolant and tools do
nothing, but for a stop where the machine would wait; everything else is an ``UnsupportedError``. Written from the
description of RS274/NGC (T. Kramer et al., NISTIR 6556, 2000). mm, mm/s.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.frames import Array
from tests.bench.gcode_words import UnsupportedError, Words

INCH = 25.4
NOTHING_MM = 1e-3
"""A move of less, mm, is none, and an arc that is flatter is a line."""
STEP = math.radians(5.0)
"""Turn of each of the short lines that a helix or a spiral becomes."""
MOST_TURN = math.radians(120.0)
"""Turn of an arc at most: it goes through three points, which must lie apart."""
ROUND = 1e-4
"""Share of the radius by which the ends of an arc may differ in their distance from its centre."""
PLANES = {17.0: (0, 1, 2), 18.0: (2, 0, 1), 19.0: (1, 2, 0)}
"""The two axes of each plane in the order in which angles rise, and the one across it."""
STOPS = {0.0, 1.0, 6.0}
"""M words at which the machine waits."""
ENDS = {2.0, 30.0}
NO_MOTION_G = {4.0, 8.0, 40.0, 43.0, 49.0, 53.0, 54.0, 55.0, 56.0, 92.1, 94.0, 98.0, 99.0}
"""G words without a motion; offsets of an empty table are none. G4 waits."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cut:
    """A move of the tool point to ``end`` (3,) mm, on the arc over ``via`` (3,) where there is one.

    ``feed`` mm/s, None: as fast as the machine can. ``tolerance`` mm: by how much the tool may miss the corner at its
    end, 0: it stops there, None: by as much as helps.
    """

    end: Array
    via: Array | None = None
    feed: float | None
    tolerance: float | None


class Machine:
    """What holds while a program is read; ``cuts`` are the moves from the origin on."""

    def __init__(self) -> None:
        self.cuts: list[Cut] = []
        self._at = np.zeros(3)
        self._unit, self._feed = INCH, 0.0
        self._relative, self._centres_absolute = False, False
        self._plane = PLANES[17.0]
        self._motion: float | None = None
        self._tolerance: float | None = None
        self._parameters: dict[str, float] = {}

    def line(self, text: str) -> bool:
        """Carry out a line; False where the program ends."""
        words = Words(text, self._parameters)
        if words.other_axes:
            raise UnsupportedError(f"the axes {words.other_axes}")
        self._modes(words)
        self._move(words)
        if any(code in STOPS for code in words.m) or 4.0 in words.g:
            self._stop()
        return not any(code in ENDS for code in words.m)

    def _modes(self, words: Words) -> None:
        for code in words.g:
            self._mode(code)
        if "p" in words.values and 64.0 in words.g:
            self._tolerance = words.values["p"] * self._unit
        if "f" in words.values:
            self._feed = words.values["f"] * self._unit / 60.0

    def _mode(self, code: float) -> None:
        if code in (0.0, 1.0, 2.0, 3.0):
            self._motion = code
        elif code == 80.0:
            self._motion = None
        elif code in PLANES:
            self._plane = PLANES[code]
        elif code in (20.0, 21.0):
            self._unit = INCH if code == 20.0 else 1.0
        elif code in (90.0, 91.0):
            self._relative = code == 91.0
        elif code in (90.1, 91.1):
            self._centres_absolute = code == 90.1
        elif code in (61.0, 61.1, 64.0):
            self._tolerance = None if code == 64.0 else 0.0
        elif code not in NO_MOTION_G:
            raise UnsupportedError(f"G{code:g}")

    def _move(self, words: Words) -> None:
        named = [axis for axis in "xyz" if axis in words.values]
        on_arc = self._motion in (2.0, 3.0) and any(each in words.values for each in "ijkr")
        if not named and not on_arc:
            return
        if self._motion is None:
            raise UnsupportedError("a place without a motion")
        end = self._at.copy()
        for axis in named:
            value = words.values[axis] * self._unit
            k = "xyz".index(axis)
            end[k] = end[k] + value if self._relative else value
        if self._motion in (2.0, 3.0):
            self._arc(words, end)
        else:
            self._to(end)
        self._at = end

    def _to(self, end: Array, via: Array | None = None) -> None:
        feed = None if self._motion == 0.0 else self._feed
        if feed is not None and not feed > 0.0:
            raise UnsupportedError("a feed of 0")
        self.cuts.append(Cut(end=end, via=via, feed=feed, tolerance=self._tolerance))

    def _stop(self) -> None:
        if self.cuts:
            self.cuts[-1] = replace(self.cuts[-1], tolerance=0.0)

    def _arc(self, words: Words, end: Array) -> None:
        sign = 1.0 if self._motion == 3.0 else -1.0
        centre = self._centre(words, end, sign)
        first, second, across = self._plane
        a, b = self._at - centre, end - centre
        angle = math.atan2(a[second], a[first])
        sweep = (sign * (math.atan2(b[second], b[first]) - angle)) % (2.0 * math.pi)
        sweep = 2.0 * math.pi if sweep < 1e-9 else sweep
        sweep += 2.0 * math.pi * (words.values.get("p", 1.0) - 1.0)
        radii = math.hypot(a[first], a[second]), math.hypot(b[first], b[second])
        start, flat = self._at, abs(end[across] - self._at[across]) < NOTHING_MM
        is_round = flat and abs(radii[1] - radii[0]) <= ROUND * radii[0] + NOTHING_MM

        def at(share: float) -> Array:
            radius, turned = radii[0] + share * (radii[1] - radii[0]), angle + sign * sweep * share
            point = start + share * (end - start)
            point[first] = centre[first] + radius * math.cos(turned)
            point[second] = centre[second] + radius * math.sin(turned)
            return np.asarray(point)

        pieces = math.ceil(sweep / (MOST_TURN if is_round else STEP) - 1e-9)
        bent = is_round and radii[0] * (1.0 - math.cos(0.5 * sweep / pieces)) > NOTHING_MM
        for k in range(pieces):
            until = end if k == pieces - 1 else at((k + 1) / pieces)
            self._to(until, at((k + 0.5) / pieces) if bent else None)

    def _centre(self, words: Words, end: Array, sign: float) -> Array:
        first, second, _ = self._plane
        centre = self._at.copy()
        if "r" not in words.values:
            for k, name in ((first, "ijk"[first]), (second, "ijk"[second])):
                offset = words.values.get(name, 0.0) * self._unit
                centre[k] = offset if self._centres_absolute else centre[k] + offset
            return centre
        radius = words.values["r"] * self._unit
        along = np.array([end[first] - self._at[first], end[second] - self._at[second]])
        chord = float(np.hypot(*along))
        if not chord >= NOTHING_MM:
            raise UnsupportedError("an arc by its radius that ends where it starts")
        height = math.sqrt(np.maximum(radius**2 - 0.25 * chord**2, 0.0)) * math.copysign(sign, sign * radius)
        centre[first] += 0.5 * along[0] - height * along[1] / chord
        centre[second] += 0.5 * along[1] + height * along[0] / chord
        return centre


def read(text: str) -> list[Cut]:
    """Return the moves of a program from the origin on; ``UnsupportedError`` names what has no counterpart here."""
    machine = Machine()
    for line in lines(text):
        if not machine.line(line):
            break
    return machine.cuts


def lines(text: str) -> Iterator[str]:
    """Yield what a program says, line by line, without comments and blanks."""
    for line in text.splitlines():
        bare = re.sub(r"\s", "", re.sub(r"\([^)]*\)|;.*", "", line)).lower()
        # a slash before a line leaves it out where the operator says so
        if bare and not bare.startswith(("%", "/")):
            yield bare
