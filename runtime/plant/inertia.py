"""Moments of inertia of the uniform solids that parts and hands are made of, about their centres of gravity, kg m2."""

import numpy as np

from runtime.cell.cell import PartSpec
from runtime.core.frames import Array


def part_inertia(part: PartSpec) -> Array:
    """Return the inertia (3, 3) of a part about its centre of gravity."""
    if part.mesh is not None:
        return np.asarray(part.mass * part.mesh.solid.gyration)
    return (cylinder_inertia if part.shape == "cylinder" else box_inertia)(part.mass, part.size)


def box_inertia(mass: float, size: Array) -> Array:
    """Return the inertia (3, 3) kg m2 of a uniform box of ``size`` (3,) m about its centre."""
    squares = np.asarray(size, dtype=np.float64) ** 2
    return np.diag(mass / 12.0 * (squares.sum() - squares))


def cylinder_inertia(mass: float, size: Array) -> Array:
    """Return the inertia (3, 3) kg m2 of a uniform cylinder along z in a box of ``size`` (3,) m about its centre."""
    radius, height = float(size[0]) / 2.0, float(size[2])
    across = mass * (3.0 * radius**2 + height**2) / 12.0
    return np.diag([across, across, mass * radius**2 / 2.0])
