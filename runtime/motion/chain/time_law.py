r"""The time on a path: where the arm is on it, x(t), from how fast it may be at each place; its jerk bounded by a mean.

``rates`` gives b = (dx/dt)^2 on a grid, so the law passes from point to point at a constant acceleration. Its
acceleration has steps. The motion that runs is its mean over the last T seconds,

    X(t) = 1/T int_{t-T}^{t} x(t') dt'

whose speed and acceleration are means of those of x, and whose jerk is the change of the acceleration within T, over T.
T is the time in which a joint may build up its acceleration, a / j. So where the acceleration changes by no more than a
within T, j is kept; ``eased`` gives the law the room for that: a top speed lasts T at least, and the speed of a narrow
place is kept for T/2 before and after it. From rest to rest this is the motion of constant jerk that is the fastest of
all, as long as the acceleration reaches a at all. Called by ``timing``; x m, t s.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array

_STANDS = 1e-300
"""A speed in place of none, so that nothing is divided by it; at two points in a row there is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeLaw:
    """A law x(t) through a grid: places ``x`` (M + 1,), speeds ``v`` there, times ``t`` s from 0."""

    x: Array
    v: Array
    t: Array

    @classmethod
    def of(cls, x: Array, b: Array) -> "TimeLaw":
        """Return the law of b (M + 1,), (m/s)^2, on a grid x (M + 1,)."""
        v = np.sqrt(b)
        lasts = 2.0 * np.diff(x) / np.maximum(v[:-1] + v[1:], _STANDS)
        return cls(x=x, v=v, t=np.concatenate([[0.0], np.cumsum(lasts)]))

    @property
    def seconds(self) -> float:
        """When the law ends, s."""
        return float(self.t[-1])

    def then(self, rest: "TimeLaw") -> "TimeLaw":
        """Return this law with another one, which begins where this one ends, in place of its last point."""
        return TimeLaw(
            x=np.concatenate([self.x[:-1], rest.x]),
            v=np.concatenate([self.v[:-1], rest.v]),
            t=np.concatenate([self.t[:-1], rest.t + (self.seconds - rest.t[0])]),
        )

    def until(self, seconds: float) -> "TimeLaw":
        """Return the law up to a time within it, s, which is a point of it then."""
        at = np.array([seconds])
        count = int(np.searchsorted(self.t, seconds, side="left"))
        k, passed = self._segment(at)
        speed = self.v[k] + self._gain[k] * passed
        return TimeLaw(
            x=np.append(self.x[:count], self._place(at)),
            v=np.append(self.v[:count], speed),
            t=np.append(self.t[:count], seconds),
        )

    def since(self, seconds: float) -> "TimeLaw":
        """Return the law from its last point before a time on."""
        first = max(int(np.searchsorted(self.t, seconds, side="right")) - 1, 0)
        return TimeLaw(x=self.x[first:], v=self.v[first:], t=self.t[first:])

    def counted(self, place: float, seconds: float) -> "TimeLaw":
        """Return the law with places and times, s, that count from others of it."""
        return TimeLaw(x=self.x - place, v=self.v, t=self.t - seconds)

    def slower(self, factor: float) -> "TimeLaw":
        """Return the law in so many times its time."""
        return TimeLaw(x=self.x, v=self.v / factor, t=self.t * factor)

    def stretch(self, period_s: float, mean_s: float) -> float:
        """Return the factor by which the mean over ``mean_s`` takes longer in whole cycles of ``period_s``."""
        return self._cycles(period_s, mean_s) * period_s / (self.seconds + mean_s)

    def sampled(self, period_s: float, mean_s: float) -> Array:
        """Return X (N + 1,), one a cycle of ``period_s``: the mean over ``mean_s``, stretched to whole cycles."""
        return self._means(np.linspace(0.0, self.seconds + mean_s, self._cycles(period_s, mean_s) + 1), mean_s)

    def going_on(self, period_s: float, mean_s: float) -> Array:
        """Return X (N + 1,) from time 0 on of a law that began before, one a cycle; it ends within the last."""
        return self._means(period_s * np.arange(self._cycles(period_s, mean_s) + 1, dtype=np.float64), mean_s)

    def _cycles(self, period_s: float, mean_s: float) -> int:
        return max(1, int(np.ceil((self.seconds + mean_s) / period_s - 1e-9)))

    def _means(self, times: Array, mean_s: float) -> Array:
        # the mean at rest before the start and after the end: the law stands there
        found = self._mean(times, mean_s) if mean_s > 0.0 else self._place(times)
        found[-1] = self.x[-1]
        # to the last bit where the arm is
        if not self.t[0] < 0.0:
            found[0] = self.x[0]
        return np.asarray(np.clip(np.maximum.accumulate(found), self.x[0], self.x[-1]))

    @property
    def _gain(self) -> Array:
        """The acceleration (M,) from point to point."""
        return np.asarray(np.diff(self.v) / np.maximum(np.diff(self.t), _STANDS))

    def _segment(self, times: Array) -> tuple[NDArray[np.intp], Array]:
        """Return the segment (N,) of every time within the law, and the time passed in it."""
        k = np.clip(np.searchsorted(self.t, times, side="right") - 1, 0, len(self.t) - 2)
        return k, times - self.t[k]

    def _place(self, times: Array) -> Array:
        k, passed = self._segment(np.clip(times, self.t[0], self.seconds))
        return np.asarray(self.x[k] + self.v[k] * passed + 0.5 * self._gain[k] * passed**2)

    def _mean(self, times: Array, mean_s: float) -> Array:
        lasts, gain = np.diff(self.t), self._gain
        # from the middle of the path: an integral of large places would lose the digits of a small difference
        origin = 0.5 * (self.x[0] + self.x[-1])
        off = self.x - origin
        parts = off[:-1] * lasts + self.v[:-1] * lasts**2 / 2.0 + gain * lasts**3 / 6.0
        whole = np.concatenate([[0.0], np.cumsum(parts)])

        def integral(at: Array) -> Array:
            inside = np.clip(at, self.t[0], self.seconds)
            k, passed = self._segment(inside)
            within = whole[k] + off[k] * passed + self.v[k] * passed**2 / 2.0 + gain[k] * passed**3 / 6.0
            # it stands before its start and after its end
            at_rest = np.where(at < self.t[0], off[0], off[-1]) * (at - inside)
            return np.asarray(within + at_rest)

        return np.asarray(origin + (integral(times) - integral(times - mean_s)) / mean_s)


def eased(x: Array, b: Array, mean_s: float) -> Array:
    """Return b (M + 1,) lowered so that each of its tops lasts ``mean_s`` at least; the first of b stays."""
    whole = np.sqrt(b)
    v = whole.copy()
    for first, last in sorted(_tops(v), key=lambda top: -whole[top[0]]):
        _cut(x, v, first, last, mean_s)
    return np.asarray(np.where(v < whole, v**2, b))


def narrow(x: Array, b: Array, mean_s: float) -> Array:
    """Return the largest b (M + 1,) that keeps the speed of a narrow place for half of ``mean_s`` on either side."""
    v = np.sqrt(b)
    low = v.copy()
    for first, last in _tops(-v):
        if first == 0 or last == len(v) - 1:
            continue
        reach = 0.5 * v[first] * mean_s
        around = slice(np.searchsorted(x, x[first] - reach), np.searchsorted(x, x[last] + reach, side="right"))
        low[around] = np.minimum(low[around], v[first])
    return np.asarray(low**2)


def _tops(v: Array) -> list[tuple[int, int]]:
    """Return the first and the last point of every top: values in a row that are alike, with less on either side."""
    runs = np.flatnonzero(np.concatenate([[True], v[1:] != v[:-1]]))
    value = v[runs]
    higher = np.ones((2, len(runs)), dtype=bool)
    higher[0, 1:], higher[1, :-1] = value[1:] > value[:-1], value[:-1] > value[1:]
    lasts = np.append(runs[1:] - 1, len(v) - 1)
    return [(int(runs[k]), int(lasts[k])) for k in np.flatnonzero(higher.all(axis=0))]


def _cut(x: Array, v: Array, first: int, last: int, mean_s: float) -> None:
    """Lower v about a top until what is cut off lasts ``mean_s`` at the speed that is left."""
    level, end = float(v[first]), len(v) - 1
    # where the path begins in motion, the law before it goes on: how long its top has lasted is not known here
    while first > 0 and x[last] - x[first] < level * mean_s:
        before = float(v[first - 1])
        after = float(v[last + 1]) if last < end else 0.0
        # a level between two points of the grid: what is above it may be wider than these points, never less wide
        beside, fits = max(before, after), float(x[last] - x[first]) / mean_s
        if fits > beside:
            level = fits
            break
        level = beside
        if before >= after:
            first -= 1
        else:
            last += 1
    v[first : last + 1] = np.minimum(v[first : last + 1], np.maximum(level, v[0] if first == 0 else 0.0))
