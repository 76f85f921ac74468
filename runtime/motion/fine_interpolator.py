"""Fine interpolation: a command at every servo tick from a set-point every 8 ms.

The command is the uniform cubic B-spline whose control points are the set-points. Between knots k and k + 1, u in
[0, 1] the share of the cycle that has passed, it is

    q(u) = [ (1-u)^3 c_{k-1} + (3u^3 - 6u^2 + 4) c_k + (-3u^3 + 3u^2 + 3u + 1) c_{k+1} + u^3 c_{k+2} ] / 6

so it is continuous to the acceleration, and with h the cycle, everywhere and not only at ticks,

    position      within the least and the largest of the four set-points around it
    speed         a mean of three differences    (c_{k+1} - c_k) / h
    acceleration  on the straight line between two second differences (c_{k+1} - 2 c_k + c_{k-1}) / h^2
    jerk          the third difference (c_{k+2} - 3 c_{k+1} + 3 c_k - c_{k-1}) / h^3, constant in a cycle

Set-points whose differences keep the limits of a joint are therefore a command that keeps them (docs/decisions/0066).
At the knots the command is ``(c_{k-1} + 4 c_k + c_{k+1}) / 6``, beside the set-point by h^2/6 of the acceleration;
``through`` gives the set-points of a command that passes given places.

A segment needs the set-point after its end, so it is played one cycle after its end arrived (docs/timing.md); one more
segment leaves rest and one enters it. A tick plays the value of its own start, so commands and readings of a tick
belong to the same instant. One constant matrix holds positions, speeds and accelerations of all ticks. rad; called once
a cycle by the controller, and over whole moves by the planners.
"""

from functools import cache

import numpy as np

from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.state import Stateful

_PASSES = 60
"""Rounds of ``through`` at most: each leaves 2/3 of the roughest error, and next to nothing of that of a motion."""

_FEW = 48
"""Up to so many inner places are solved at once."""

_THERE = 1e-15
"""An error of less, rad, is rounding."""


def _weights(u: Array) -> Array:
    """Return (..., 4): the share of the set-points (c_-1, c_0, c_1, c_2) in the position at u in [0, 1]."""
    return np.stack([(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3], axis=-1) / 6.0


def _speed_weights(u: Array) -> Array:
    """Return the derivatives d/du of ``_weights``."""
    return 0.5 * np.stack([-((1 - u) ** 2), 3 * u**2 - 4 * u, -3 * u**2 + 2 * u + 1, u**2], axis=-1)


def _acceleration_weights(u: Array) -> Array:
    """Return the second derivatives of ``_weights``."""
    return np.stack([1 - u, 3 * u - 2, 1 - 3 * u, u], axis=-1)


def through(positions: Array) -> Array:
    """Return the set-points (N + 1, n) of a command that passes ``positions`` (N + 1, n) at its knots.

    The first and the last are set-points already, which stay: those at which it rests, or that it shares with another
    motion. A command that rests there passes knots 0 and N beside by a sixth of the first and the last step, along it.
    """
    setpoints = np.array(positions, dtype=np.float64)
    inner = setpoints[1:-1]
    # most moves of a long program are short, and rounds would be most of the work of planning them
    if 0 < len(inner) <= _FEW:
        ends = np.zeros_like(inner)
        ends[0] = setpoints[0] / 6.0
        ends[-1] += setpoints[-1] / 6.0
        setpoints[1:-1] = matmul(_inverse(len(inner)), inner - ends)
        return setpoints
    # by rounds, not by a banded solver: the matrix is its diagonal but for what a motion bends in a cycle
    for _ in range(_PASSES):
        off = positions[1:-1] - (setpoints[:-2] + 4.0 * inner + setpoints[2:]) / 6.0
        inner += off
        if not np.abs(off).max(initial=0.0) > _THERE:
            break
    return setpoints


@cache
def _inverse(count: int) -> Array:
    """Return the inverse (count, count) of the matrix with rows (1, 4, 1) / 6.

    With cosh t = 2 it is 6 (-1)^(i+j) sinh(i t) sinh((count + 1 - j) t) / (sinh t sinh((count + 1) t)) for i <= j.
    """
    places = np.arange(1, count + 1)
    rising = np.sinh(np.arccosh(2.0) * np.arange(count + 2))
    low, high = np.minimum(places[:, None], places), np.maximum(places[:, None], places)
    signs = np.where((places[:, None] + places) % 2 == 0, 6.0, -6.0)
    # products of small numbers only: this is used for few places
    return np.asarray(signs * rising[low] * rising[count + 1 - high] / (rising[1] * rising[count + 1]))


class FineInterpolator(Stateful):
    """Plays the segments between set-points tick by tick, ``ticks`` in a cycle of ``period_s``, from rest at q (n,)."""

    BUFFERS = ("_points",)
    VALUES = ("_jumped",)

    def __init__(self, ticks: int, period_s: float, q: Array) -> None:
        # u = 0 is included and u = 1 is not: a tick plays the value of its own start, the end belongs to the next cycle
        u = np.arange(ticks) / ticks
        self.ticks, self.period_s = ticks, period_s
        self._weights = np.concatenate(
            [_weights(u), _speed_weights(u) / period_s, _acceleration_weights(u) / period_s**2]
        )
        self._points = np.tile(np.asarray(q, dtype=np.float64), (4, 1))
        self._jumped = False

    def push(self, setpoint: Array) -> Array:
        """Take the set-point (n,) of this cycle; return (3, ticks, n): positions, speeds, accelerations."""
        points = self._points
        points[:3] = points[1:]
        points[3] = setpoint
        if self._jumped:
            if (points == setpoint).all():
                motion = np.zeros((3, self.ticks, len(setpoint)))
                motion[0] = setpoint  # exactly: the weights of a segment add up to 1 only to rounding
                return motion
            self._jumped = False
        return matmul(self._weights, points).reshape(3, self.ticks, -1)

    def hold(self, q: Array) -> None:
        """Stand still at joint angles q (n,): the set-points in the pipeline are dropped."""
        self._points[:] = q
        self._jumped = False

    def jump(self, q: Array) -> None:
        """Command joint angles q (n,) at once and exactly, without speed, until another set-point comes."""
        self._points[:] = q
        self._jumped = True

    @staticmethod
    def weights(u: Array) -> Array:
        """Return (..., 4): the share of the set-points (c_-1, c_0, c_1, c_2) in the position at u in [0, 1]."""
        return _weights(u)

    @property
    def settled(self) -> bool:
        """Whether the output stands still at the last set-point."""
        # equal to the bit: at rest the same row is pushed again, nothing is computed anew
        return bool((self._points[1:] == self._points[0]).all())

    def expand(self, setpoints: Array) -> Array:
        """Return (3, (N + 2) * ticks, n) for a whole sequence (N + 1, n) that starts and ends at rest.

        The same numbers as pushing the set-points after the first one by one and then the last one twice more: what
        the servo sees of a move, with the segments in which it leaves and enters rest. Used by the planner.
        """
        return self.continue_(np.concatenate([setpoints[:1], setpoints[:1], setpoints]))

    def after(self, setpoints: Array) -> Array:
        """Return (3, (K + 2) * ticks, n) of set-points (K, n) that follow those in the pipeline; the last is held."""
        return self.continue_(np.concatenate([self._points[1:], setpoints]))

    def rates(self, setpoints: Array) -> tuple[Array, Array]:
        """Return bounds of speed (N - 1, n) and of acceleration (N - 2, n) between set-points (N, n).

        They hold at ticks and between them: speed k for the segments that set-points k and k + 1 touch, acceleration k
        where set-point k + 1 is passed, which is where it is largest.
        """
        steps = np.diff(setpoints, axis=0)
        return np.abs(steps) / self.period_s, np.abs(np.diff(steps, axis=0)) / self.period_s**2

    def peaks(self, setpoints: Array) -> tuple[Array, Array]:
        """Return the bounds (n,) of speed and acceleration of a whole sequence (N + 1, n) from rest to rest."""
        speed, acceleration = self.rates(np.concatenate([setpoints[:1], setpoints, setpoints[-1:]]))
        return speed.max(axis=0), acceleration.max(axis=0)

    def extremes(self, setpoints: Array) -> tuple[Array, Array, Array, Array]:
        """Return bounds (n,) of position, lowest and highest, of speed and of acceleration, within a continued motion.

        They hold from the second of the set-points (N, n), N at least 3, to the last but one.
        """
        speed, acceleration = self.rates(setpoints)
        return setpoints.min(axis=0), setpoints.max(axis=0), speed.max(axis=0), acceleration.max(axis=0)

    def continue_(self, setpoints: Array) -> Array:
        """Return (3, (N - 1) * ticks, n) for set-points (N, n) of which the first three are already in the pipeline.

        The last one is held until the command stands there. As ``expand``, but continuing a motion.
        """
        return self.within(np.concatenate([setpoints, setpoints[-1:], setpoints[-1:]]))

    def within(self, setpoints: Array) -> Array:
        """Return (3, (N - 3) * ticks, n) from the second of set-points (N, n) to the last but one, within a motion."""
        segments = len(setpoints) - 3
        windows = np.stack([setpoints[k : k + segments] for k in range(4)], axis=1)
        out = matmul(self._weights, windows).reshape(segments, 3, self.ticks, -1)
        return np.asarray(np.moveaxis(out, 1, 0).reshape(3, segments * self.ticks, -1))
