r"""How fast the bends of a path may be passed with a bounded jerk of the joints.

At a steady speed v the set-points lie delta = v h apart, h the cycle, and their jerk is the third difference

    D3(x, delta) / h^3,    D3 = S(x + 3 delta / 2) - 3 S(x + delta / 2) + 3 S(x - delta / 2) - S(x - 3 delta / 2)

with S the joints along the path. That is q''' v^3 where a bend is long, and less where it is passed within a cycle or
two. Of all speeds up to the programmed one the largest is taken below which none passes the jerk: at some faster speed
the set-points may fall on places alike, which is luck. Called by ``timing``; x m, t s.
"""

import numpy as np

from runtime.core.frames import Array

_LEVELS = 0.88 ** np.arange(24)
"""Shares of the programmed speed that are tried: from all of it down to a twentieth."""
_WELL_WITHIN = 0.97
"""Share of the jerk up to which bends take it: the rest is left to changes of speed."""


def bend_speeds(x: Array, across: Array, fastest: Array, jerk: Array, period_s: float) -> Array:
    """Return the speed (M + 1,) at most on a grid x (M + 1,), up to ``fastest`` (M + 1,).

    ``across`` (M + 1, n) is the second derivative of the joints by x, ``jerk`` (n,) their limits, rad/s3.
    """
    # not from the joints at the places themselves: that would solve the arm a hundred times over
    course = _Course(x, across)
    most = _WELL_WITHIN * jerk * period_s**3
    shares = np.empty((len(_LEVELS), len(x)))
    for k, level in enumerate(_LEVELS.tolist()):
        apart = level * fastest * period_s
        third = course.at(x + 1.5 * apart) - course.at(x - 1.5 * apart)
        third -= 3.0 * (course.at(x + 0.5 * apart) - course.at(x - 0.5 * apart))
        shares[k] = (np.abs(third) / most).max(axis=1)
    return fastest * _steady(shares)


def _steady(shares: Array) -> Array:
    """Return the largest level (M + 1,), between those tried, below which no share (L, M + 1) is above 1."""
    bad = ~(shares <= 1.0)
    # the first bad one from the slowest upwards
    last = len(_LEVELS) - 1
    lowest = np.where(bad.any(axis=0), last - np.argmax(bad[::-1], axis=0), -1)
    found = np.where(lowest < 0, 1.0, _LEVELS[-1])
    between = np.flatnonzero((lowest >= 0) & (lowest < last))
    low, high = shares[lowest[between] + 1, between], shares[lowest[between], between]
    # shares grow by a power of the speed from level to level
    rest = np.log(np.maximum(low, 1e-12)) / np.log(np.maximum(low, 1e-12) / high)
    found[between] = _LEVELS[lowest[between] + 1] ** (1.0 - rest) * _LEVELS[lowest[between]] ** rest
    return np.asarray(found)


class _Course:
    """Joints S(x) whose second derivative (M + 1, n) is linear between the places of a grid x (M + 1,)."""

    def __init__(self, x: Array, across: Array) -> None:
        self._x, self._bend = x, across
        h = np.diff(x)[:, None]
        self._bending = np.diff(across, axis=0) / h
        slopes = 0.5 * h * (across[:-1] + across[1:])
        self._slope = np.concatenate([np.zeros_like(across[:1]), np.cumsum(slopes, axis=0)])
        steps = h * self._slope[:-1] + h**2 * (across[:-1] / 3.0 + across[1:] / 6.0)
        self._place = np.concatenate([np.zeros_like(across[:1]), np.cumsum(steps, axis=0)])

    def at(self, x: Array) -> Array:
        """Return S (N, n) at x (N,); before the start and after the end it goes straight on."""
        inside = np.clip(x, self._x[0], self._x[-1])
        k = np.clip(np.searchsorted(self._x, inside, side="right") - 1, 0, len(self._x) - 2)
        t = (inside - self._x[k])[:, None]
        bend, bending = self._bend[k], self._bending[k]
        place = self._place[k] + t * (self._slope[k] + t * (0.5 * bend + t * bending / 6.0))
        slope = self._slope[k] + t * (bend + 0.5 * t * bending)
        return np.asarray(place + (x - inside)[:, None] * slope)
