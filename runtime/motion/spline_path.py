"""The path of a SPLINE: from where the tool is through taught poses, one after another, to the last of them.

It passes place and orientation of every point, with continuous curvature and with a turning whose rate is continuous
(``runtime.motion.spline``). A point at the pose of the one before it, or of the start, is left out. What no curve can
pass is refused (RBL417): a turn of the tool at one place, and an exact half turn from one point to the next, whose
direction no point says. Where one pose is left to go to, there is no curve: that is a straight path.

``swings`` and ``returns`` are what the one who teaches has to know of a curve. Made by the planner for each move; poses
T base <- tool, m and rad.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import runtime.motion.codes  # noqa: F401 - registers what is raised here
from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen, is_half_turn, pose, quaternion, rotation_angle
from runtime.core.linear import dot, norm
from runtime.core.units import DEG
from runtime.motion.spline import ROOM, SLOW, Spline

_SAME_PLACE = 1e-6
"""Points nearer to one another, m, are at one place."""
_SAME_TURN = 1e-6
"""Orientations that differ by less, rad, are one."""
_PARTS, _MOST_PLACES = 8, 60
"""Parts of the curve between two points, and places in all, of which what is left of it is made."""
_BETWEEN = 32
"""Places between two points at which a curve is measured."""
_NEAREST = 3
"""Nodes of the curve beside a point from which its distance is sought."""
_STILL = 1e-6
"""A share of the chord's speed below which there is no direction."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Swing:
    """How far a curve leaves the straight line of ``chord`` m between two points: ``distance`` m, at most.

    ``point`` is the number of the second one, from 1; the start is 0.
    """

    point: int
    distance: float
    chord: float


@dataclass(frozen=True, slots=True, kw_only=True)
class SplinePath:
    """A move on ``curve``; ``points_at`` (K + 1,) shares of the path at its start and at each of its points.

    ``numbers`` (K + 1,) says which of the given points these are, from 1, 0 the start; ``pairs`` which were left out:
    its number, and that of the one before it at the same place. ``length`` m; ``angle`` rad is what the tool would turn
    at the largest rate of its turning per length. ``bend`` 1/m and ``gain`` rad/m2: the largest second derivatives of
    place and orientation by length, the first of which is the curvature.
    """

    X_start: Array
    X_end: Array
    length: float
    angle: float
    curve: Spline
    points_at: Array
    numbers: tuple[int, ...]
    pairs: tuple[tuple[int, int], ...]
    bend: float
    gain: float
    rpy: None = None

    @classmethod
    def through(cls, X_start: Array, X_points: Sequence[Array]) -> "SplinePath | None":
        """Return the curve from a pose (4, 4) through others, None where fewer than two are left; ``Fault`` RBL417."""
        X, numbers, pairs = _distinct([X_start, *X_points])
        if len(X) < 3:
            return None
        places = np.stack([each[:3, 3] for each in X])
        quaternions = [quaternion(each[:3, :3]) for each in X]
        # both signs are one orientation: the nearer one is the shorter turn
        for k in range(1, len(quaternions)):
            if dot(quaternions[k - 1], quaternions[k]) < 0.0:
                quaternions[k] = -quaternions[k]
        turns = [rotation_angle(one[:3, :3], other[:3, :3]) for one, other in itertools.pairwise(X)]
        chords = np.linalg.norm(np.diff(places, axis=0), axis=1)
        knots = np.concatenate([[0.0], np.cumsum(np.maximum(chords, ROOM * np.array(turns)))])
        curve = Spline.through(knots, np.concatenate([places, np.stack(quaternions)], axis=1))
        bend, rate, gain = _largest(curve)
        return cls(
            X_start=frozen(X_start),
            X_end=frozen(X[-1]),
            length=curve.length,
            angle=rate * curve.length,
            curve=curve,
            points_at=frozen(curve.at_points / curve.length),
            numbers=numbers,
            pairs=pairs,
            bend=bend,
            gain=gain,
        )

    @property
    def radius(self) -> float:
        """The smallest radius of curvature, m."""
        return 1.0 / self.bend if self.bend > 0.0 else math.inf

    def largest_about(self, s: Array) -> tuple[Array, Array, Array]:
        """Return the largest curvature, 1/m, rate of turning, rad/m, and its derivative, rad/m2, about shares s (N,).

        Each (N,), between the share before and the one after it; s rises.
        """
        fine = _fine(self.curve)
        at = np.interp(fine, self.curve.nodes, self.curve.lengths) / self.length
        low = np.maximum(np.searchsorted(at, np.append(s[:1], s[:-1])) - 1, 0)
        high = np.minimum(np.searchsorted(at, np.append(s[1:], s[-1:]), side="right") + 1, len(at) - 1)
        edges = np.stack([low, np.maximum(high, low + 1)], axis=1).ravel()
        # of two edges in a row the first part is between them, and the second one of no interest
        bend, rate, gain = (np.maximum.reduceat(np.append(each, 0.0), edges)[::2] for each in _sizes(self.curve, fine))
        return bend, rate, gain

    def turning_speed(self, acceleration: float) -> float:
        """Return the speed m/s on the curve at which its turning alone takes an angular ``acceleration``, rad/s2."""
        return math.sqrt(acceleration / self.gain) if self.gain > 0.0 else math.inf

    @property
    def name(self) -> str:
        """The path as messages name it."""
        return "spline"

    @property
    def move(self) -> str:
        """A move on it as messages name it."""
        return "move on a spline"

    def poses(self, s: Array) -> Array:
        """Return the poses (N, 4, 4) at path parameters s (N,) in [0, 1]."""
        values = self._at(s)
        return pose(values[:, :3], _rotations(values[:, 3:]))

    def points(self, s: Array) -> Array:
        """Return the places (N, 3) m of the tool point at path parameters s (N,)."""
        return self._at(s)[:, :3]

    def travel(self, s: Array) -> Array:
        """Return the unit tangents (N, 3) at path parameters s (N,); where the curve turns back, of what follows."""
        u = self.curve.parameter(np.asarray(s) * self.length)
        first, second = (each[:, :3] for each in self.curve.at(u)[1:])
        still = np.abs(first).max(axis=1, keepdims=True) <= _STILL
        ahead = np.where(still, second, first)
        return np.asarray(ahead / np.sqrt((ahead**2).sum(axis=1))[:, None])

    def deviation(self, points: Array) -> Array:
        """Return the distance (N,) m of points (N, 3) from the curve."""
        # here and not above: see ``runtime.motion.spline``
        from scipy.spatial import KDTree

        places = self.curve.at(self.curve.nodes)[0][:, :3]
        # several nodes of each: where the curve is closed or crosses itself, the nearest one may be of the wrong part
        nodes = self.curve.nodes[np.asarray(KDTree(places).query(points, _NEAREST)[1], dtype=np.intp)]
        return np.asarray(np.min([self._distance(points, u) for u in nodes.T], axis=0))

    def _distance(self, points: Array, u: Array) -> Array:
        """Return the distances (N,) of points (N, 3) from the curve near to u (N,)."""
        for _ in range(3):
            # Newton's step without the curvature: from a near node three of them reach rounding
            value, first, _ = (each[:, :3] for each in self.curve.at(u))
            step = ((points - value) * first).sum(axis=1) / np.maximum((first**2).sum(axis=1), SLOW**2)
            u = np.clip(u + step, self.curve.knots[0], self.curve.knots[-1])
        return np.asarray(np.linalg.norm(points - self.curve.at(u)[0][:, :3], axis=1))

    def places_within(self, low: float, high: float) -> list[float]:
        """Return shares between two others through which a spline is nearly this curve: points, and some between these.

        Of a usual curve it differs by some thousandths of what that is from straight pieces.
        """
        ends = self.points_at
        parts = max(1, min(_PARTS, _MOST_PLACES // (len(ends) - 1)))
        shares = (ends[:-1] + np.linspace(0.0, 1.0, parts, endpoint=False)[:, None] * np.diff(ends)).T.ravel()
        inner = shares[(shares > low) & (shares < high)]
        # a program that is recorded has them in one line
        even = np.linspace(low, high, _MOST_PLACES + 2)[1:-1]
        found: list[float] = (inner if 0 < len(inner) <= _MOST_PLACES else even).tolist()
        return found

    def swings(self) -> tuple[Swing, ...]:
        """Return how far the curve is from the straight line between each two points, in order."""
        found = []
        knots, share = self.curve.knots, np.linspace(0.0, 1.0, _BETWEEN + 1)
        for k, (first, last) in enumerate(itertools.pairwise(knots.tolist())):
            places = self.curve.at(first + share * (last - first))[0][:, :3]
            off, chord = places - places[0], places[-1] - places[0]
            along = np.clip((off * chord).sum(axis=1) / dot(chord, chord), 0.0, 1.0)
            distance = np.linalg.norm(off - along[:, None] * chord, axis=1).max()
            found.append(Swing(point=self.numbers[k + 1], distance=float(distance), chord=norm(chord)))
        return tuple(found)

    def returns(self) -> tuple[int, ...]:
        """Return the numbers of the points near which the curve doubles back, so that the tool is slow there."""
        nodes = self.curve.nodes[self._still()]
        nearest: list[int] = np.abs(nodes[:, None] - self.curve.knots).argmin(axis=1).tolist()
        return tuple(self.numbers[k] for k in sorted(set(nearest)))

    def cusps(self) -> Array:
        """Return the shares (N,) of the path at which the curve doubles back."""
        return np.asarray(self.curve.lengths[self._still()] / self.length)

    def _still(self) -> NDArray[np.bool_]:
        """Return at which nodes of the curve the tool point hardly moves."""
        first = self.curve.at(self.curve.nodes)[1][:, :3]
        return np.asarray(~((first**2).sum(axis=1) >= SLOW**2))

    def _at(self, s: Array) -> Array:
        return self.curve.at(self.curve.parameter(np.asarray(s) * self.length))[0]


def _distinct(X: Sequence[Array]) -> tuple[list[Array], tuple[int, ...], tuple[tuple[int, int], ...]]:
    """Return poses without those that are the one before them, their numbers, and pairs at one place; RBL417."""
    kept, pairs = [0], []
    # each is compared with the last one that is kept, so that many small steps do not add up to a gap
    for number in range(1, len(X)):
        if _moves(X[kept[-1]], X[number], f"from {_point(kept[-1])} to {_point(number)} of the spline"):
            kept.append(number)
        else:
            pairs.append((number, kept[-1]))
    if len(kept) > 1:
        # where the last one is left out: the move ends as taught, to the last bit
        kept[-1] = len(X) - 1
    return [X[number] for number in kept], tuple(kept), tuple(pairs)


def _moves(before: Array, after: Array, which: str) -> bool:
    """Return whether two poses are at two places; ``Fault`` RBL417 where no curve joins them."""
    distance, turn = norm(after[:3, 3] - before[:3, 3]), rotation_angle(before[:3, :3], after[:3, :3])
    if not (math.isfinite(distance) and math.isfinite(turn)):
        raise Fault("RBL417", f"{which} the distance is {distance} m and the turn {turn} rad")
    if not distance >= _SAME_PLACE:
        if not turn <= _SAME_TURN:
            raise Fault(
                "RBL417",
                f"{which} the tool would turn by {turn / DEG:.3f} deg at one place",
                "Turn the tool in a MOVE of its own, before or after the spline, or teach the points apart.",
            )
        return False
    if is_half_turn(turn):
        raise Fault(
            "RBL417",
            f"{which} the tool makes half a turn, and both directions are equally short",
            "Teach a point between them, with the orientation on the side where the tool is to turn.",
        )
    return True


def _point(number: int) -> str:
    return f"point {number}" if number else "the start"


def _largest(curve: Spline) -> tuple[float, float, float]:
    """Return the largest curvature, the largest rate of turning and its largest derivative, by length."""
    bend, rate, gain = (float(each.max()) for each in _sizes(curve, _fine(curve)))
    return bend, rate, gain


def _fine(curve: Spline) -> Array:
    """Return places u (N,), several in every step of a curve, rising."""
    nodes = curve.nodes
    between = nodes[:-1, None] + np.linspace(0.0, 0.75, 4) * np.diff(nodes)[:, None]
    return np.append(between.ravel(), nodes[-1])


def _sizes(curve: Spline, u: Array) -> tuple[Array, Array, Array]:
    """Return curvature, rate of turning and its derivative (N,) at u (N,), by length."""
    first, second = curve.by_length(u)
    turning, change = _turning(curve.at(u)[0][:, 3:], first[:, 3:], second[:, 3:])
    bend, rate, gain = (np.linalg.norm(each, axis=1) for each in (second[:, :3], turning, change))
    return np.asarray(bend), np.asarray(rate), np.asarray(gain)


def _turning(q: Array, dq: Array, ddq: Array) -> tuple[Array, Array]:
    """Return the vector of the turning (N, 3) of quaternions q (N, 4) of any length, and its derivative.

    w = 2 Im(q' conj(q)) / |q|^2, of which the length of q cancels out.
    """
    square = (q * q).sum(axis=1)[:, None]
    w = 2.0 * _imaginary(dq, q) / square
    # of q' conj(q') the imaginary part is none
    return w, 2.0 * _imaginary(ddq, q) / square - w * (2.0 * (q * dq).sum(axis=1)[:, None] / square)


def _imaginary(a: Array, b: Array) -> Array:
    """Return the imaginary part (N, 3) of a conj(b), quaternions (N, 4)."""
    return np.asarray(b[:, :1] * a[:, 1:] - a[:, :1] * b[:, 1:] - np.cross(a[:, 1:], b[:, 1:]))


def _rotations(q: Array) -> Array:
    """Return the rotations (N, 3, 3) of quaternions (N, 4), w x y z, of any length but 0."""
    w, x, y, z = (q / np.linalg.norm(q, axis=1)[:, None]).T
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
