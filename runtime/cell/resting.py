"""Whether the parts of a cell can rest where its file puts them: its shape, the floor and its supports.

Two boxes overlap by the least distance that one must move to leave the other: the least overlap of their shadows on
the 15 axes of the separating axis theorem, the normals of their faces and the products of their edges (S. Gottschalk,
M. C. Lin and D. Manocha, "OBBTree", SIGGRAPH 1996). For a cylinder no finite list of axes is complete: with those of
``_directions`` the overlap is exact where the axes of both bodies are parallel, and elsewhere never too small; nor is
that of a mesh, of which the hull counts. Poses
are ``[x, y, z, rx, ry, rz]`` in mm and deg with ``R = Rz @ Ry @ Rx``. No numerics: ``robolang check`` examines every
cell.
"""

import math
from collections.abc import Sequence
from itertools import product
from typing import Protocol, Self

from runtime.core.record import Record

OVERLAP_MM = 1.0
"""A part may be this far inside another body: contacts of a simulation yield by less."""
DROP_MM = 5.0
"""A part may be this far above its support, and falls onto it."""

Vector = tuple[float, float, float]


class Outline(Protocol):
    """A convex body in its own frame."""

    @property
    def normals(self) -> tuple[Vector, ...]:
        """Unit vectors of the normals of its largest faces."""

    def reach_mm(self, direction: Vector) -> float:
        """Return how far it reaches from its middle in the direction of a unit vector, mm."""


class Box(Record):
    """A box: its name in messages, centre mm, unit vectors of its edges in the world, half of their lengths mm.

    ``is_round``: the cylinder along z that such a box encloses; ``outline``: another body that it encloses.
    """

    name: str
    centre: Vector
    axes: tuple[Vector, Vector, Vector]
    halves: Vector
    is_round: bool = False
    outline: Outline | None = None

    @classmethod
    def of(cls, name: str, size_mm: Sequence[float], pose_mm_deg: Sequence[float], is_round: bool = False) -> Self:
        """Return the box or cylinder of a size (3,) and the pose (6,) of its centre."""
        x, y, z, *angles = pose_mm_deg
        # the columns of Rz Ry Rx, written out: numpy is not imported here
        (cx, sx), (cy, sy), (cz, sz) = ((math.cos(a), math.sin(a)) for a in map(math.radians, angles))
        axes = (
            (cz * cy, sz * cy, -sy),
            (cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx),
            (cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx),
        )
        length, width, height = size_mm
        halves = (length / 2.0, width / 2.0, height / 2.0)
        return cls(name=name, centre=(x, y, z), axes=axes, halves=halves, is_round=is_round)

    def lowered(self, by: float) -> "Box":
        """Return the box further down, mm."""
        x, y, z = self.centre
        return self.replaced(centre=(x, y, z - by))

    def reach(self, direction: Vector) -> float:
        """Return how far it reaches from its centre in the direction of a unit vector, mm."""
        if self.outline is not None:
            x, y, z = (_dot(axis, direction) for axis in self.axes)
            return self.outline.reach_mm((x, y, z))
        if self.is_round:
            along = abs(_dot(self.axes[2], direction))
            return self.halves[2] * along + self.halves[0] * math.sqrt(max(0.0, 1.0 - along * along))
        return sum(half * abs(_dot(axis, direction)) for half, axis in zip(self.halves, self.axes, strict=True))

    def rims(self) -> list[Vector]:
        """Return the points from which another body is nearest: the corners, or the ends of the axis, mm."""
        signs = ((0.0, 0.0),) if self.is_round else tuple(product((-1.0, 1.0), repeat=2))
        return [
            _plus(self.centre, self.axes, (x * self.halves[0], y * self.halves[1], z * self.halves[2]))
            for x, y in signs
            for z in (-1.0, 1.0)
        ]

    @property
    def bottom(self) -> float:
        """The height of its lowest corner, mm."""
        return self.centre[2] - self.reach((0.0, 0.0, -1.0))


def unrest(part: Box, others: Sequence[Box], below: Sequence[Box]) -> str:
    """Return the reason for which a part cannot rest where it is, an empty text when it can.

    ``others`` are the bodies that it must not overlap, ``below`` those that may support it beside the floor, z = 0.
    """
    deepest = max(others, key=lambda other: overlap(part, other), default=None)
    if deepest is not None and not overlap(part, deepest) <= OVERLAP_MM:
        return f"{part.name} overlaps {deepest.name} by {overlap(part, deepest):.0f} mm"
    if not part.bottom >= -OVERLAP_MM:
        return f"{part.name} is {-part.bottom:.0f} mm below the floor, z = 0"
    # moved down it must meet a body or the floor; whether it would tip over there is not judged
    lower = part.lowered(DROP_MM)
    if lower.bottom <= 0.0 or any(overlap(lower, other) > 0.0 for other in below):
        return ""
    return f"{part.name} has no support: there is no body within {DROP_MM:g} mm below it"


def overlap(one: Box, other: Box) -> float:
    """Return how far one box must move to leave the other, mm; 0 where they do not meet."""
    # most pairs are far apart: their spheres settle it without the 15 axes
    apart = _minus(other.centre, one.centre)
    if math.hypot(*apart) >= math.hypot(*one.halves) + math.hypot(*other.halves):
        return 0.0
    directions = _directions(one, other)
    return max(0.0, min(_shadows(one, other, _dot(apart, d), d) for d in directions))


def _shadows(one: Box, other: Box, apart: float, direction: Vector) -> float:
    """Return by how much the shadows of two bodies overlap, whose centres are ``apart`` mm in that direction."""
    back = (-direction[0], -direction[1], -direction[2])
    # out on the nearer side
    return min(one.reach(direction) + other.reach(back) - apart, one.reach(back) + other.reach(direction) + apart)


def _directions(one: Box, other: Box) -> list[Vector]:
    """Return the directions in which two bodies may be apart."""
    # parallel edges give no direction of their own: the faces have it
    found = [_unit(_cross(a, b)) for a, b in product(one.axes, other.axes)]
    # a round side has a normal in every direction: that towards what is nearest to it
    for body, beside in ((one, other), (other, one)):
        if body.is_round:
            found += [_unit(_across(body, point)) for point in beside.rims()]
    for body in (one, other):
        if body.outline is not None:
            found += [_plus((0.0, 0.0, 0.0), body.axes, normal) for normal in body.outline.normals]
    return [*one.axes, *other.axes, *(each for each in found if each is not None)]


def _across(body: Box, point: Vector) -> Vector:
    """Return the vector from the axis of a cylinder to a point, at right angles to the axis, mm."""
    to, axis = _minus(point, body.centre), body.axes[2]
    along = _dot(to, axis)
    return to[0] - along * axis[0], to[1] - along * axis[1], to[2] - along * axis[2]


def _plus(point: Vector, axes: tuple[Vector, Vector, Vector], steps: Vector) -> Vector:
    x, y, z = (
        start + sum(step * axis[k] for step, axis in zip(steps, axes, strict=True)) for k, start in enumerate(point)
    )
    return x, y, z


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _unit(a: Vector) -> Vector | None:
    """Return a vector of length 1, None for edges that are parallel."""
    length = math.hypot(*a)
    return None if length < 1e-6 else (a[0] / length, a[1] / length, a[2] / length)
