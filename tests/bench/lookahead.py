r"""The time of a trapezoid look-ahead for lines and arcs: what a planner of the tool alone could reach.

The path is the programmed one, but for a chord across each corner: from d before it to d after it, d the zone, or half
of the shorter of its two moves where that is less. Along it the speed is at most that of each move, and v^2 <= a r on
an arc; at both ends of a chord it is at most

    v^2 <= c a d / sin(turn / 2)

Between, it changes by the acceleration a at most. No jerk, no joints, no cycles. c = 1 is the speed of the parabola
that joins the two directions under a: the ideal look-ahead, with one speed before and after a corner. With c = 2 no
motion on the inner side of the corner can be faster: it has to lose the speed v sin(turn / 2) against the corner within
d sin(turn / 2). So that is a lower bound for every motion that is on the path outside of its zones. m, s.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array

STRAIGHT = 1e-6
"""A turn of less, rad, is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stretch:
    """A move of the tool: its ``points`` (2 or 3, 3) m, ``speed`` m/s, and the ``zone`` m at its end, 0 for a stop."""

    points: Array
    speed: float
    zone: float

    @property
    def radius(self) -> float:
        """Radius of the circle through three points, infinite for a line."""
        if len(self.points) < 3:
            return math.inf
        a, b, c = self.points
        area = float(np.linalg.norm(np.cross(b - a, c - a)))
        sides = [float(np.linalg.norm(end - start)) for start, end in ((a, b), (b, c), (a, c))]
        return math.prod(sides) / (2.0 * area)

    @property
    def length(self) -> float:
        """Length of the line or the arc."""
        start, *_, end = self.points
        if len(self.points) < 3:
            return float(np.linalg.norm(end - start))
        # the angle at the point between is half of the arc that lies on the other side
        first, second = start - self.points[1], end - self.points[1]
        cosine = float(first @ second / np.linalg.norm(first) / np.linalg.norm(second))
        return 2.0 * self.radius * (math.pi - math.acos(float(np.clip(cosine, -1.0, 1.0))))

    def direction(self, *, at_end: bool) -> Array:
        """Return the unit vector (3,) in which it starts or ends."""
        if len(self.points) < 3:
            way = self.points[-1] - self.points[0]
        else:
            # two chords of a circle from one of its points, each over its length, differ by what the circle bends
            here, via, other = self.points[::-1] if at_end else self.points
            first, second = via - here, other - here
            way = first / (first @ first) - second / (second @ second)
            way = -way if at_end else way
        return np.asarray(way / np.linalg.norm(way))


def seconds(stretches: Sequence[Stretch], acceleration: float, corner: float = 1.0) -> float:
    """Return the least time from rest to rest; ``corner`` is c."""
    ways = [each for each in stretches if each.length > 0.0]
    lengths = np.array([each.length for each in ways])
    most = np.array([least(each.speed, math.sqrt(acceleration * each.radius)) for each in ways])
    cuts = [_cut(*pair, acceleration, corner) for pair in itertools.pairwise(ways)]
    steps, speeds, nodes = [], [], [0.0]
    for k, length in enumerate(lengths.tolist()):
        used = sum(cut[0] for cut in cuts[max(k - 1, 0) : k + 1])
        steps.append(float(np.maximum(length - used, 0.0)))
        speeds.append(float(most[k]))
        if k < len(cuts):
            _, chord, slow = cuts[k]
            faster = float(np.maximum(most[k], most[k + 1]))
            node = least(slow, faster)
            steps.append(chord)
            speeds.append(faster)
            nodes += [node, node]
    return _time(steps, speeds, [*nodes, 0.0], acceleration)


def least(*values: float) -> float:
    """Return the least of values, NaN where one is."""
    return float(np.min(values))


def _cut(first: Stretch, second: Stretch, acceleration: float, corner: float) -> tuple[float, float, float]:
    """Return d, the chord across the corner between two stretches, and the speed at both of its ends."""
    before, after = first.direction(at_end=True), second.direction(at_end=False)
    turn = math.atan2(float(np.linalg.norm(np.cross(before, after))), float(before @ after))
    if not first.zone > 0.0:
        return 0.0, 0.0, 0.0
    half = least(first.zone, 0.5 * first.length, 0.5 * second.length)
    if turn < STRAIGHT:
        return half, 2.0 * half, math.inf
    bend = math.sin(0.5 * turn)
    return half, 2.0 * half * math.cos(0.5 * turn), math.sqrt(corner * acceleration * half / bend)


def _time(steps: Sequence[float], speeds: Sequence[float], nodes: Sequence[float], acceleration: float) -> float:
    """Return the time over steps with a top speed each, and a top speed at each of the nodes between them."""
    v = list(nodes)
    for k in range(1, len(v)):
        v[k] = least(v[k], speeds[k - 1], math.sqrt(v[k - 1] ** 2 + 2.0 * acceleration * steps[k - 1]))
    for k in range(len(v) - 2, -1, -1):
        v[k] = least(v[k], speeds[k], math.sqrt(v[k + 1] ** 2 + 2.0 * acceleration * steps[k]))
    return sum(_step(*each, acceleration) for each in zip(steps, speeds, v, v[1:], strict=False))


def _step(length: float, speed: float, start: float, end: float, acceleration: float) -> float:
    """Return the least time over a length between two speeds."""
    if not length > 0.0:
        return 0.0
    peak = least(speed, math.sqrt(0.5 * (start**2 + end**2) + acceleration * length))
    ramps = (2.0 * peak - start - end) / acceleration
    cruise = length - (2.0 * peak**2 - start**2 - end**2) / (2.0 * acceleration)
    return ramps + float(np.maximum(cruise, 0.0)) / peak
