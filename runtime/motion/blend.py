"""Blending two moves at the corner between them: one accelerates while the other brakes, and nothing stops.

The last m cycles of a move A and the first m of a move B, which begins where A ends, run at the same time. They are
superposed in joint space, row by row:

    q(i) = q_A(N_A - m + i) + q_B(i) - q_B(0),   i = 0 .. m

So i = 0 is a row of A and i = m a row of B: before and after, both are exactly as planned, and the whole takes m cycles
less. m is the largest number for which, in all of these cycles,

    zone           every tool point is within the zone's radius of the corner
    joints         position, speed and acceleration of every joint keep its limits at every servo tick
    tool           the tool point is not faster than in A's second and B's first half alone; it is not accelerated more,
                   and the tool does not turn faster, than there or than the robot's paths may
    room           m is at most half the cycles of either move, so that two blends never meet

Without the rule for the tool two slow moves in line would pass the corner at the sum of their speeds, since their
braking distance is far less than the zone. Jerk is not checked: that of the tool point may be the sum of that of both
moves. m shrinks to 0, where the arm stops at the corner, rather than fail.
m is searched by halving. Whether m holds is not strictly monotonic in m, so every candidate is verified as a whole,
and of those that held the largest is taken; a larger one may have been missed. About ten candidates of 0.2 ms each.
Called by ``MotionPlanner.join`` for every corner of a chain; m, rad, s.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array, rotation_angles
from runtime.core.linear import matmul
from runtime.motion.fine_interpolator import through
from runtime.motion.path_ik import RANGE_TOLERANCE, Arm
from runtime.motion.speed_cap import SpeedCap
from runtime.motion.time_scaling import Pace

_SLACK = 1.0 + 1e-9
"""Rounding of the joints' limits: single moves are planned to the limit itself."""

_TOOL_SLACK = 1.0 + 1e-6
"""And of the tool's: differences of poses lose more digits than joint angles do."""

_NOTHING = 1e-12
"""Differences of positions below this are rounding, m and rad."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Corner:
    """A corner as planned: its ``radius``, m, as programmed, and ``cycles`` in which both moves run (0: it stops).

    ``reach`` m: how far from the corner the tool leaves or joins the paths, at most; ``deviation`` m: by how much it
    misses the corner.
    """

    radius: float
    cycles: int = 0
    reach: float = 0.0
    deviation: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class _Tool:
    """How fast a tool moves between rows, largest values: m and rad per cycle, m per cycle squared."""

    speed: float
    turning: float
    acceleration: float

    @classmethod
    def of(cls, X: Array) -> "_Tool":
        """Return the largest values over poses (N, 4, 4), one a cycle, N at least 3."""
        steps = np.diff(X[:, :3, 3], axis=0)
        return cls(
            speed=_longest(steps),
            acceleration=_longest(np.diff(steps, axis=0)),
            turning=float(rotation_angles(X[:-1, :3, :3], X[1:, :3, :3]).max()),
        )

    def within(self, most: "_Tool") -> bool:
        """Return whether nothing is larger than in another."""
        pairs = ((self.speed, most.speed), (self.turning, most.turning), (self.acceleration, most.acceleration))
        return all(value <= limit * _TOOL_SLACK + _NOTHING for value, limit in pairs)

    @classmethod
    def most(cls, *tools: "_Tool") -> "_Tool":
        """Return the largest value of each kind."""
        rows = np.array([(each.speed, each.turning, each.acceleration) for each in tools])
        speed, turning, acceleration = rows.max(axis=0).tolist()
        return cls(speed=speed, turning=turning, acceleration=acceleration)


def overlapped(a: Array, b: Array, m: int) -> Array:
    """Return rows a (N_A + 1, n) and b (N_B + 1, n), which begin where a ends, with m cycles run at the same time."""
    end = len(a) - 1
    # rows 0 and m of the overlap are taken from a and b themselves, not from the sum: no rounding on either side
    return np.concatenate([a[: end - m + 1], a[end - m + 1 : end] + (b[1:m] - b[0]), b[max(m, 1) :]])


@dataclass(frozen=True, slots=True, kw_only=True)
class BlendLimits:
    """What a blend may do: the joints' limits of ``pace``, and what the tool may in any case.

    ``acceleration`` m/s2 of the tool point, ``turning`` rad/s of the tool; ``cap`` on its speed and the flange's.
    """

    pace: Pace
    acceleration: float
    turning: float
    cap: SpeedCap | None = None

    def of_tool(self) -> _Tool:
        """Return the limits of the tool per cycle; its speed is bounded by the moves alone."""
        period_s = self.pace.period_s
        return _Tool(speed=0.0, turning=self.turning * period_s, acceleration=self.acceleration * period_s**2)


def blend(
    a: Array, b: Array, halves: tuple[int, int], zone: float, arm: Arm, limits: BlendLimits
) -> tuple[Array, Corner]:
    """Return rows a (N_A + 1, n) rad of a motion joined with b (N_B + 1, n), which begin where a ends, and the corner.

    ``halves``: cycles of the second half of a's last move and of the first half of b; ``zone`` m, its radius.
    """
    if not (zone > 0.0 and min(halves) > 0):
        return overlapped(a, b, 0), Corner(radius=zone)
    before, after = _poses(arm, a[-halves[0] - 1 :]), _poses(arm, b[: halves[1] + 1])
    corner = after[0, :3, 3]
    room = min(_inside(before[::-1], corner, zone), _inside(after, corner, zone))
    if room == 0:
        return overlapped(a, b, 0), Corner(radius=zone)
    # one row more at either end, so that accelerating from rest and braking to it count as well
    allowed = _Tool.most(
        _Tool.of(np.concatenate([before, before[-1:]])),
        _Tool.of(np.concatenate([after[:1], after])),
        limits.of_tool(),
    )

    def holds(m: int) -> bool:
        # the first and the last of these are no set-points, and what they are off fades to a millionth within ten
        setpoints = through(_around(a, b, m, 12))[10:-10]
        if not _joints_hold(setpoints, arm, limits.pace):
            return False
        # the rule for the tool below knows neither the flange nor what lies between rows
        if limits.cap is not None and not limits.cap.kept(arm.fine.within(setpoints)):
            return False
        X = _poses(arm, _around(a, b, m))
        # the two rows on either side lie on the paths of a and b: they count for the speed, not for the zone
        return bool((_distances(X[2:-2], corner) <= zone).all()) and _Tool.of(X).within(allowed)

    m = _largest(room, holds)
    joined = overlapped(a, b, m)
    if m == 0:
        return joined, Corner(radius=zone)
    points = _poses(arm, joined[len(a) - 1 - m : len(a)])[:, :3, 3]
    return joined, Corner(
        radius=zone,
        cycles=m,
        reach=float(np.linalg.norm(points - corner, axis=1).max()),
        deviation=_passed(points, corner),
    )


def _largest(most: int, holds: Callable[[int], bool]) -> int:
    """Return a number up to ``most`` that holds, 0 where none is found: the largest, where that is monotonic."""
    good, bad, m = 0, most + 1, most
    while bad - good > 1:
        if holds(m):
            good = m
        else:
            bad = m
        m = (good + bad) // 2
    return good


def _around(a: Array, b: Array, m: int, margin: int = 2) -> Array:
    """Return the rows of a blend with ``margin`` of a before it and as many of b after it, at rest where they end.

    A segment of the fine interpolation depends on four set-points, so two neighbours on either side are affected.
    """
    end = len(a) - 1
    before = a[np.maximum(np.arange(end - m - margin, end - m + 1), 0)]
    after = b[np.minimum(np.arange(m, m + margin + 1), len(b) - 1)]
    return np.concatenate([before, a[end - m + 1 : end] + (b[1:m] - b[0]), after])


def _joints_hold(setpoints: Array, arm: Arm, pace: Pace) -> bool:
    """Return whether set-points (N, n) keep range, speed and acceleration of every joint at every servo tick."""
    lowest, highest, speed, acceleration = pace.fine.extremes(setpoints)
    inside = (lowest >= arm.spec.lower - RANGE_TOLERANCE) & (highest <= arm.spec.upper + RANGE_TOLERANCE)
    slow = (speed <= pace.speed * _SLACK) & (acceleration <= pace.acceleration * _SLACK)
    return bool((inside & slow).all())


def _inside(X: Array, corner: Array, zone: float) -> int:
    """Return how many of the poses (N + 1, 4, 4) after the first are in the zone without leaving it."""
    out = ~(_distances(X, corner) <= zone)
    return int(np.argmax(out)) - 1 if out.any() else len(X) - 1


def _poses(arm: Arm, q: Array) -> Array:
    return np.asarray(matmul(arm.kinematics.forward(q), arm.X_flange_tool))


def _distances(X: Array, corner: Array) -> Array:
    return np.asarray(np.linalg.norm(X[:, :3, 3] - corner, axis=1))


def _longest(vectors: Array) -> float:
    return float(np.linalg.norm(vectors, axis=1).max())


def _passed(points: Array, corner: Array) -> float:
    """Return the least distance, m, of the corner from the polyline through points (N, 3)."""
    steps, off = np.diff(points, axis=0), corner - points[:-1]
    squares = np.maximum((steps**2).sum(axis=1), _NOTHING**2)
    share = np.clip((steps * off).sum(axis=1) / squares, 0.0, 1.0)
    return float(np.linalg.norm(off - share[:, None] * steps, axis=1).min())
