"""A quantity that depends on a few joints, on a grid of their angles: multilinear between, constant outside.

Used for rotor inertias that an identification found to depend on the posture (docs/identification.md). Imports no
numerics, since the settings of a controller hold it.
"""

from bisect import bisect_right
from math import prod
from typing import Protocol, SupportsFloat

from runtime.core.record import Record


class Angles(Protocol):
    """Joint angles by their 0-based joint, rad: an array (n,), or anything that is indexed like one."""

    def __getitem__(self, joint: int, /) -> SupportsFloat: ...


class JointTable(Record):
    """Values over the angles of ``joints`` (0-based): ``grid`` rad, one rising tuple of two or more for each joint.

    ``values`` are row-major, so the angle of the last joint changes first. ``ValueError`` when the sizes do not fit.
    """

    joints: tuple[int, ...]
    grid: tuple[tuple[float, ...], ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        sizes = [len(angles) for angles in self.grid]
        if len(sizes) != len(self.joints) or min(sizes, default=0) < 2 or prod(sizes) != len(self.values):
            raise ValueError(f"{len(self.joints)} joints, a grid of {sizes} and {len(self.values)} values do not fit")

    def at(self, q: Angles) -> float:
        """Return the value at joint angles q (n,) rad, multilinear; an angle off the grid counts as its end."""
        # joint by joint, the slowest of the row-major values first: each step leaves one value for every grid point of
        # the joints to come
        values = self.values
        for joint, angles in zip(self.joints, self.grid, strict=True):
            angle, size = float(q[joint]), len(values) // len(angles)
            cell = min(max(bisect_right(angles, angle) - 1, 0), len(angles) - 2)
            share = (min(max(angle, angles[0]), angles[-1]) - angles[cell]) / (angles[cell + 1] - angles[cell])
            low, high = values[cell * size : (cell + 1) * size], values[(cell + 1) * size : (cell + 2) * size]
            values = tuple((1.0 - share) * a + share * b for a, b in zip(low, high, strict=True))
        return values[0]

    @property
    def mean(self) -> float:
        """Mean of the values, each grid point alike."""
        return sum(self.values) / len(self.values)
