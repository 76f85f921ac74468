"""What a closed mesh encloses: its volume, and centre and inertia at uniform density, from its triangles alone.

Each triangle and the origin span a tetrahedron, whose volume has the sign of the side that the triangle faces; the
integrals of all add up to those of the solid, wherever the origin is (F. Tonon, "Explicit exact formulas for the 3-D
tetrahedron inertia tensor", Journal of Mathematics and Statistics, 2004).
"""

from dataclasses import dataclass

import numpy as np
from numpy import einsum

from runtime.core.frames import Array, frozen
from runtime.core.mesh import Mesh

THINNEST = 1e-6
"""Least share of the box around a mesh that it encloses; rounding makes as much of a sheet."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """``volume`` m3, ``cog`` (3,) m, and ``gyration`` (3, 3) m2: the inertia of 1 kg about ``cog``, as in ``Body``."""

    volume: float
    cog: Array
    gyration: Array


class NoSolidError(Exception):
    """A mesh that encloses nothing; the text says why, as a sentence about the mesh."""


def solid_of(mesh: Mesh) -> Solid:
    """Return what a mesh encloses; ``NoSolidError`` where it is open, turned inside out or flat."""
    if loose := open_edges(mesh):
        raise NoSolidError(f"is not closed: {loose} of its edges do not join two triangles that face the same side")
    # about its middle: far from the origin the digits of a small mesh would be lost
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    middle = (low + high) / 2.0
    corners = mesh.vertices[mesh.faces] - middle
    volumes = einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    volume = float(volumes.sum())
    if not abs(volume) > THINNEST * float(np.prod(high - low)):
        raise NoSolidError("encloses no volume")
    if not volume > 0.0:
        raise NoSolidError("is inside out: its triangles face inwards")
    sums = corners.sum(axis=1)
    cog = einsum("i,ij->j", volumes, sums) / (4.0 * volume)
    products = einsum("i,ij,ik->jk", volumes, sums, sums) + einsum("i,icj,ick->jk", volumes, corners, corners)
    # about the centre: the products are those about the middle of the box
    spread = products / (20.0 * volume) - np.outer(cog, cog)
    return Solid(volume=volume, cog=frozen(middle + cog), gyration=frozen(np.trace(spread) * np.eye(3) - spread))


def open_edges(mesh: Mesh) -> int:
    """Return how many edges have no triangle on their other side that faces the same side."""
    ends = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64)
    # one number for each edge, whichever end comes first
    numbers = ends.min(axis=1) * len(mesh.vertices) + ends.max(axis=1)
    edges, which = np.unique(numbers, return_inverse=True)
    # by counts, not by pairs: two solids that touch in an edge have four triangles there
    turns = np.bincount(which, np.where(ends[:, 0] < ends[:, 1], 1.0, -1.0), len(edges))
    return int((turns != 0.0).sum())
