r"""The path of the tool point: a line, an arc or a spline; orientation by one of two laws.

    T(s) = [ R(s) , p(s) ; 0 1 ],   s in [0, 1]
    line   p(s) = p_start + s (p_end - p_start)
    arc    p(s) = p_start + r sin(a) t - 2 r sin^2(a/2) u,   a = s phi

    axis   R(s) = Rot(k, s Theta) R_start          about the rotation principal axis: JPH06190750A Fig 6, 200 to 208
    rpy    R(s) = Rz Ry Rx of (rx, ry, rz)(s)      the three angles of a taught pose, each linear in its shorter
                                                   direction: CN103429397A, S1; on lines only

``axis`` turns about one fixed axis at a constant rate, whatever frame the angles are counted in; ``rpy`` depends on the
frame and may swing far where RY is near 90 deg. Both end exactly as taught. At an exact half turn two directions are
equally short: ``candidates`` has a path for each, and the planner takes one (``runtime.motion.half_turn``).

An arc lies on the circle through its start, a via point and its end: u points from the centre to the start, t along the
circle there. The form above does not subtract the large coordinates of a far centre. The normal

    n = (p_via - p_start) x (p_end - p_start) / |..|,    t = n x u

makes the arc from the start over the via point to the end a positive turn about it, so phi in (0, 2 pi) needs no case
for arcs over half a turn. The orientation of the via point is not used. Three points define no circle where two of them
coincide or all are on a line: refused (RBL416) when their triangle is flatter than ``FLATTEST``.

A spline passes taught poses, orientations included: ``runtime.motion.spline_path``.

Made by the planner for each move; poses T base <- tool, m and rad.
"""

import itertools
import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

import runtime.motion.codes  # noqa: F401 - registers what is raised here
from runtime.core.faults import Fault
from runtime.core.frames import (
    Array,
    frozen,
    is_half_turn,
    pose,
    principal_axes,
    rotation_about,
    rotation_from_rpy,
    rpy_from_rotation,
)
from runtime.core.linear import dot, matmul, norm
from runtime.core.rounding import beside
from runtime.core.units import MM
from runtime.motion.spline_path import SplinePath
from runtime.settings.profile import PostureLaw

NOTHING_TO_DO = 1e-9
"""A move of less, m and rad, ends where it starts: it gets no rows."""

FLATTEST = 1e-6
"""Least height of the triangle of start, via point and end over its longest side, m."""

_AT_END = 1e-3
"""Share of a path over which its direction at an end is taken."""

FULL_CIRCLE = (
    "A full circle takes two MOVECs: one over a point of the circle to the point opposite to the start, and one over a "
    "point of the other half back to the start."
)
"""What would help where an arc ends where it starts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinePath:
    """A straight move between two poses of the same frame pair; ``length`` m, ``angle`` rad about ``axis`` (3,).

    ``rpy`` (2, 3) rad holds the angles at the start and the change of each, for the posture law of that name, else
    None.
    """

    X_start: Array
    X_end: Array
    axis: Array
    angle: float
    length: float
    rpy: Array | None = None

    @classmethod
    def between(cls, X_start: Array, X_end: Array, posture: PostureLaw = "axis") -> "LinePath":
        """Return the straight path from one pose (4, 4) to another; of several the first."""
        return cls.candidates(X_start, X_end, posture)[0]

    @classmethod
    def candidates(cls, X_start: Array, X_end: Array, posture: PostureLaw = "axis") -> tuple["LinePath", ...]:
        """Return the straight path from one pose (4, 4) to another: several where a half turn has two directions."""
        rotations = principal_axes(X_start[:3, :3], X_end[:3, :3])
        length = norm(X_end[:3, 3] - X_start[:3, 3])
        ends = frozen(X_start), frozen(X_end)
        if posture == "axis":
            return tuple(
                cls(X_start=ends[0], X_end=ends[1], axis=frozen(axis), angle=angle, length=length)
                for axis, angle in rotations
            )
        axis, angle = rotations[0]
        start, end = rpy_from_rotation(X_start[:3, :3]), rpy_from_rotation(X_end[:3, :3])
        turns = [np.array(turn) for turn in itertools.product(*map(_shortest_turns, (end - start).tolist()))]
        # ``angle`` bounds the turning: the rate of a posture by three angles is at most the sum of their rates
        return tuple(
            cls(
                X_start=ends[0],
                X_end=ends[1],
                axis=frozen(axis),
                length=length,
                rpy=frozen([start, turn]),
                angle=float(np.maximum(angle, np.abs(turn).sum())),
            )
            for turn in turns
        )

    @property
    def name(self) -> str:
        """The path as messages name it."""
        return "straight path"

    @property
    def move(self) -> str:
        """A move on it as messages name it."""
        return "straight move"

    def poses(self, s: Array) -> Array:
        """Return the poses (N, 4, 4) at path parameters s (N,) in [0, 1]."""
        if self.rpy is None:
            R = matmul(rotation_about(self.axis, s * self.angle), self.X_start[:3, :3])
        else:
            R = rotation_from_rpy(self.rpy[0] + s[:, None] * self.rpy[1])
        return pose(self.points(s), R)

    def points(self, s: Array) -> Array:
        """Return the places (N, 3) m of the tool point at path parameters s (N,)."""
        start, end = self.X_start[:3, 3], self.X_end[:3, 3]
        return np.asarray(start + s[:, None] * (end - start))

    def deviation(self, points: Array) -> Array:
        """Return the distance (N,) m of points (N, 3) from the straight segment."""
        start, end = self.X_start[:3, 3], self.X_end[:3, 3]
        along = np.zeros(len(points))
        if self.length > 0.0:  # a move that only turns has a segment of one point
            along = np.clip(matmul(points - start, end - start) / self.length**2, 0.0, 1.0)
        return np.asarray(np.linalg.norm(points - (start + along[:, None] * (end - start)), axis=1))


@dataclass(frozen=True, slots=True, kw_only=True)
class ArcPath:
    """An arc of ``radius`` m about ``centre`` (3,): ``sweep`` phi rad from ``outward`` u (3,) towards ``along`` t (3,).

    ``length`` m is that of the arc, ``angle`` rad about ``axis`` (3,) what the tool turns. Else as ``LinePath``.
    """

    X_start: Array
    X_end: Array
    axis: Array
    angle: float
    length: float
    centre: Array
    outward: Array
    along: Array
    sweep: float
    radius: float
    rpy: None = None

    @classmethod
    def candidates(cls, X_start: Array, X_via: Array, X_end: Array) -> tuple["ArcPath", ...]:
        """Return the arc from one pose (4, 4) over the place of a second to a third; ``Fault`` RBL416.

        Twice where the tool makes a half turn, which has two directions.
        """
        start, via, end = (X[:3, 3] for X in (X_start, X_via, X_end))
        _check_points(start, via, end)
        first, last = via - start, end - start
        normal = np.cross(first, last)
        twice_area = norm(normal)
        # where the perpendicular bisectors of both sides meet
        to_centre = np.cross(dot(last, last) * first - dot(first, first) * last, -normal) / (2.0 * twice_area**2)
        radius = norm(to_centre)
        outward = -to_centre / radius
        along = np.cross(normal / twice_area, outward)
        # tangent and chord are half the arc apart
        sweep = 2.0 * math.atan2(-dot(last, outward), dot(last, along))
        return tuple(
            cls(
                X_start=frozen(X_start),
                X_end=frozen(X_end),
                axis=frozen(axis),
                angle=angle,
                length=radius * sweep,
                centre=frozen(start + to_centre),
                outward=frozen(outward),
                along=frozen(along),
                sweep=sweep,
                radius=radius,
            )
            for axis, angle in principal_axes(X_start[:3, :3], X_end[:3, :3])
        )

    @property
    def name(self) -> str:
        """The path as messages name it."""
        return "arc"

    @property
    def move(self) -> str:
        """A move on it as messages name it."""
        return "move on an arc"

    def poses(self, s: Array) -> Array:
        """Return the poses (N, 4, 4) at path parameters s (N,) in [0, 1]."""
        return pose(self.points(s), matmul(rotation_about(self.axis, s * self.angle), self.X_start[:3, :3]))

    def points(self, s: Array) -> Array:
        """Return the places (N, 3) m of the tool point at path parameters s (N,)."""
        # 1 - cos a as 2 sin^2 (a / 2): the difference would lose the digits of a small angle on a large radius
        a = (s * self.sweep)[:, None]
        off = np.sin(a) * self.along - 2.0 * np.sin(0.5 * a) ** 2 * self.outward
        return np.asarray(self.X_start[:3, 3] + self.radius * off)

    def travel(self, s: Array) -> Array:
        """Return the unit tangents (N, 3) at path parameters s (N,)."""
        a = (s * self.sweep)[:, None]
        return np.asarray(np.cos(a) * self.along - np.sin(a) * self.outward)

    def deviation(self, points: Array) -> Array:
        """Return the distance (N,) m of points (N, 3) from the arc, its ends included."""
        off = points - self.centre
        x, y = matmul(off, self.outward), matmul(off, self.along)
        on_circle = np.hypot(np.hypot(x, y) - self.radius, matmul(off, np.cross(self.outward, self.along)))
        to_ends = [np.linalg.norm(points - X[:3, 3], axis=1) for X in (self.X_start, self.X_end)]
        # nearest to the circle only where the direction from the centre lies within the sweep, else to an end
        beside = np.mod(np.arctan2(y, x), 2.0 * math.pi) <= self.sweep
        return np.asarray(np.where(beside, on_circle, np.minimum(*to_ends)))


Path: TypeAlias = LinePath | ArcPath | SplinePath


def turn_between(before: Path, after: Path) -> float:
    """Return the angle, rad, between the end of one path and the start of the next."""
    ends = before.points(np.array([1.0 - _AT_END, 1.0])), after.points(np.array([0.0, _AT_END]))
    first, second = (points[1] - points[0] for points in ends)
    return math.atan2(norm(np.cross(first, second)), dot(first, second))


def _shortest_turns(turn: float) -> tuple[float, ...]:
    """Return the shortest of all angles that differ from ``turn`` rad by whole turns: two at half a turn."""
    shortest = turn - 2.0 * math.pi * round(turn / (2.0 * math.pi))
    if not is_half_turn(shortest):
        return (shortest,)
    # both directions, the positive one first (docs/decisions/0030)
    positive = shortest % (2.0 * math.pi)
    return positive, positive - 2.0 * math.pi


def _check_points(start: Array, via: Array, end: Array) -> None:
    """Refuse points through which there is no circle; ``Fault`` RBL416."""
    sides = {"start and via point": via - start, "via point and end": end - via, "start and end": end - start}
    lengths = {name: norm(side) for name, side in sides.items()}
    # a side of no length is named by its points; otherwise the height of the triangle says whether all are on one line
    for name, length in lengths.items():
        if not length >= FLATTEST:
            apart, least = beside(length / MM, FLATTEST / MM, form=".4f")
            raise Fault(
                "RBL416",
                f"{name} of the arc are {apart} mm apart: a circle takes at least {least} mm",
                FULL_CIRCLE if name == "start and end" else "",
            )
    height = norm(np.cross(via - start, end - start)) / max(lengths.values())
    if not height >= FLATTEST:
        off, least = beside(height / MM, FLATTEST / MM, form=".4f")
        raise Fault(
            "RBL416",
            f"start, via point and end of the arc are within {off} mm of one straight line: a circle "
            f"takes at least {least} mm",
        )
