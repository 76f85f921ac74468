"""A mesh as the shape of a part or an obstacle: placed in its box, with what it encloses and its convex hull.

Contacts are those of the hull; mass, flat faces for a cup and pictures are those of the mesh itself.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import einsum

from runtime.core.frames import Array, frozen
from runtime.core.hull import hull_of
from runtime.core.linear import matmul
from runtime.core.mesh import Mesh
from runtime.core.mesh_files import read_mesh
from runtime.core.solid import NoSolidError, Solid, solid_of
from runtime.core.units import MM

MOST_TRIANGLES = 20_000
"""Triangles of a mesh: the hull of a ball of so many takes a second, and a log holds them all."""
ROUNDING = 1e-3
"""Share by which the volume of a hull may be less than it is: its corners are on a grid."""
MOST_NORMALS = 40
"""Directions in which ``resting`` looks for a gap beside a mesh: those of its largest faces."""


# by identity: a mesh is read once for all bodies that name it, and arrays have no hash
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BodyMesh:
    """``mesh`` in m, about the middle of the box around it, whose edges are ``size`` (3,) m.

    ``solid`` is what it encloses; ``hull`` is its convex hull, of ``hull_volume`` m3, and ``normals`` are those of the
    largest faces of the hull, as unit vectors. ``name``: the file as the cell has it.
    """

    name: str
    mesh: Mesh
    size: Array
    solid: Solid
    hull: Mesh
    hull_volume: float
    normals: tuple[tuple[float, float, float], ...]

    @property
    def filled(self) -> float:
        """The volume of the hull over that of the mesh: 1 where it is convex."""
        return self.hull_volume / self.solid.volume

    def reach_mm(self, direction: tuple[float, float, float]) -> float:
        """Return how far it reaches in the direction of a unit vector, from its middle, mm."""
        return float(matmul(self.hull.vertices, np.array(direction)).max() / MM)


def read_body_mesh(path: Path, name: str, scale: float) -> BodyMesh:
    """Return the mesh of a file; ``scale`` makes its numbers mm. ``MeshError``, ``NoSolidError``."""
    read = read_mesh(path, MOST_TRIANGLES)
    low, high = read.vertices.min(axis=0), read.vertices.max(axis=0)
    # about the middle first: a part that was drawn far from the origin keeps its digits
    vertices = (read.vertices - (low + high) / 2.0) * (scale * MM)
    mesh = Mesh(vertices=frozen(vertices), faces=read.faces)
    solid, hull = solid_of(mesh), hull_of(mesh.vertices)
    if hull is None:
        raise NoSolidError("encloses no volume")
    hull_volume = solid_of(hull).volume
    # one shell over another, as a file has that was exported twice, would count twice in centre and inertia
    if not solid.volume <= hull_volume * (1.0 + ROUNDING):
        raise NoSolidError("overlaps itself: it encloses more than its convex hull")
    return BodyMesh(
        name=name,
        mesh=mesh,
        size=frozen((high - low) * (scale * MM)),
        solid=solid,
        hull=hull,
        hull_volume=hull_volume,
        normals=_normals(hull),
    )


def _normals(hull: Mesh) -> tuple[tuple[float, float, float], ...]:
    """Return the normals of the largest faces, each once: a flat face has many triangles."""
    a, b, c = np.moveaxis(hull.vertices[hull.faces], 1, 0)
    across = np.cross(b - a, c - a)
    lengths = np.sqrt(einsum("ij,ij->i", across, across))
    largest = np.argsort(-lengths, kind="stable")[: np.count_nonzero(lengths)]
    units = across[largest] / lengths[largest, None]
    # compared as rounded: the triangles of one face differ in the last digits, and the largest of them is exact
    first = np.sort(np.unique(np.round(units, 3), axis=0, return_index=True)[1])[:MOST_NORMALS]
    return tuple((x, y, z) for x, y, z in units[first].tolist())
