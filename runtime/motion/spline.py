r"""A cubic spline through points, and its length: what the path of a SPLINE is made of.

Between two points in a row each coordinate is a cubic of u, which grows from point to point by the length of the chord,
or by ``ROOM`` for every rad that the tool turns where that is more. First and second derivatives are continuous at the
points. On the first and on the last piece the second derivative is constant, so that the curvature goes on to both
ends; points of a straight line give that line.

A pose is seven coordinates: the place, and the unit quaternion of the orientation, which is made of length one again
where it is read. So the orientation has continuous derivatives too, needs no axes, and turns about one axis where the
taught poses do.

The length along the curve is l(u) = int g(|p'|) du with

    g(x) = x  for x >= c,        g(x) = c (3/8 + 3/4 y^2 - 1/8 y^4),  y = x/c,  below

|p'| is near 1 on a curve through taught points. Where the curve doubles back it passes through 0: there g does not, so
that u(l) keeps continuous derivatives, and the tool comes to rest and returns. l(u) is integrated step by step (Gauss,
five points) and solved for u (Newton), to rounding.

The slopes at the points are scipy's (``CubicSpline``, whose tridiagonal solution is the same bytes on every processor;
docs/decisions/0069). Made by ``runtime.motion.spline_path``; m, rad.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array, frozen

ROOM = 0.02
"""Length that a turn of one rad counts for at least, m."""
SLOW = 0.25
"""c: share of the chord's speed below which the curve doubles back."""
_STEPS = 16
"""Steps of the integral between two points."""
_NEWTON = 3
_NODES, _WEIGHTS = (
    np.array([0.0, -1.0, 1.0, -1.0, 1.0])
    * np.sqrt(5.0 + np.array([0.0, -2.0, -2.0, 2.0, 2.0]) * math.sqrt(10.0 / 7.0))
    / 3.0,
    (322.0 + np.array([0.0, 13.0, 13.0, -13.0, -13.0]) * math.sqrt(70.0)) / 900.0,
)
_WEIGHTS[0] = 128.0 / 225.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Spline:
    """A curve of 7 coordinates through points (K + 1, 7) at ``knots`` u (K + 1,): a place, m, and a quaternion.

    ``cubics`` (4, K, 7): coefficients of the powers of w, 0 to 1 from one point to the next. ``nodes`` (M + 1,) are
    places u, ``lengths`` (M + 1,) l there.
    """

    knots: Array
    cubics: Array
    nodes: Array
    lengths: Array

    @classmethod
    def through(cls, knots: Array, values: Array) -> "Spline":
        """Return the curve through values (K + 1, 7) at rising knots (K + 1,), K > 0."""
        h = np.diff(knots)[:, None]
        slopes = _slopes(knots, values)
        first, last, change = h * slopes[:-1], h * slopes[1:], np.diff(values, axis=0)
        cubics = np.stack([values[:-1], first, 3.0 * change - 2.0 * first - last, first + last - 2.0 * change])
        steps = np.arange(_STEPS) / _STEPS
        nodes = np.append((knots[:-1, None] + h * steps).ravel(), knots[-1])
        bare = cls(knots=frozen(knots), cubics=frozen(cubics), nodes=frozen(nodes), lengths=nodes)
        lengths = np.concatenate([[0.0], np.cumsum(bare._passed(nodes[:-1], nodes[1:]))])
        return replace(bare, lengths=frozen(lengths))

    @property
    def length(self) -> float:
        """Length of the whole curve, m."""
        return float(self.lengths[-1])

    @property
    def at_points(self) -> Array:
        """Lengths l (K + 1,) at which the curve passes its points."""
        return self.lengths[::_STEPS]

    def parameter(self, length: Array) -> Array:
        """Return u (N,) where lengths l (N,) are passed."""
        # within one step l(u) is nearly straight, so Newton converges from the secant
        k = np.clip(np.searchsorted(self.lengths, length, side="right") - 1, 0, len(self.lengths) - 2)
        low, high = self.nodes[k], self.nodes[k + 1]
        rest = length - self.lengths[k]
        u = low + (high - low) * rest / np.diff(self.lengths)[k]
        for _ in range(_NEWTON):
            u = np.clip(u - (self._passed(low, u) - rest) / self._speeds(u)[0], low, high)
        return np.asarray(u)

    def _passed(self, start: Array, end: Array) -> Array:
        """Return the lengths (N,) from u ``start`` (N,) to ``end`` (N,), within a step each."""
        half = 0.5 * (end - start)
        between = (start + half)[:, None] + half[:, None] * _NODES
        speeds = self._speeds(between.ravel())[0].reshape(between.shape)
        return np.asarray(half * (speeds * _WEIGHTS).sum(axis=1))

    def at(self, u: Array) -> tuple[Array, Array, Array]:
        """Return the seven coordinates at u (N,), and their first and second derivatives by u, each (N, 7)."""
        k, w, h = self._local(u)
        c0, c1, c2, c3 = self.cubics[:, k]
        value = c0 + w * (c1 + w * (c2 + w * c3))
        return value, (c1 + w * (2.0 * c2 + w * 3.0 * c3)) / h, (2.0 * c2 + w * 6.0 * c3) / h**2

    def _local(self, u: Array) -> tuple[NDArray[np.intp], Array, Array]:
        k = np.clip(np.searchsorted(self.knots, u, side="right") - 1, 0, len(self.knots) - 2)
        h = np.diff(self.knots)[k]
        return k, np.clip((u - self.knots[k]) / h, 0.0, 1.0)[:, None], h[:, None]

    def by_length(self, u: Array) -> tuple[Array, Array]:
        """Return the first and the second derivative by l of the seven coordinates at u (N,), both (N, 7)."""
        _, first, second = self.at(u)
        g, dg = (each[:, None] for each in self._speeds(u))
        return first / g, (second - first * (dg / g)) / g**2

    def _speeds(self, u: Array) -> tuple[Array, Array]:
        """Return g and its derivative by u at u (N,)."""
        _, first, second = self.at(u)
        square = (first[:, :3] ** 2).sum(axis=1)
        gain = (first[:, :3] * second[:, :3]).sum(axis=1)
        speed, y = np.sqrt(square), square / SLOW**2
        low = SLOW * (0.375 + 0.75 * y - 0.125 * y**2), (1.5 - 0.5 * y) * gain / SLOW
        fast = y >= 1.0
        return np.where(fast, speed, low[0]), np.where(fast, gain / np.maximum(speed, SLOW), low[1])


def _slopes(knots: Array, values: Array) -> Array:
    """Return the derivatives (K + 1, 7) at the knots of the spline whose ends have no third derivative."""
    if len(knots) == 2:
        return np.repeat(np.diff(values, axis=0) / np.diff(knots), 2, axis=0)
    # here and not above: scipy takes 0.7 s to import, and few programs have a SPLINE
    from scipy.interpolate import CubicSpline

    # a spline is linear in the second derivatives at its ends, which scipy takes as numbers: three splines give those
    # that equal the ones beside them
    free = CubicSpline(knots, values, bc_type="natural")
    none = np.zeros(len(knots))
    bent = [CubicSpline(knots, none, bc_type=((2, first), (2, 1.0 - first))) for first in (1.0, 0.0)]
    beside = knots[[1, -2]]
    (a, b), (c, d) = np.eye(2) - np.stack([each(beside, 2) for each in bent], axis=1)
    first, last = free(beside, 2)
    ends = np.stack([d * first - b * last, a * last - c * first]) / (a * d - b * c)
    return np.asarray(free(knots, 1) + sum(each(knots, 1)[:, None] * end for each, end in zip(bent, ends, strict=True)))
