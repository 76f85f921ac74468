"""The flat faces of a mesh, on which a suction cup can seal: triangles side by side in one plane, and their outline."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy import einsum

from runtime.cell.body_mesh import BodyMesh
from runtime.core.frames import Array
from runtime.core.linear import dot, matmul
from runtime.core.mesh import Mesh
from runtime.core.units import DEG

FLAT = 1e-4
"""How far the corners of a face may be off its plane, m: a lip bridges ten times as much."""
AWAY = 120.0 * DEG
"""Angle from which on a triangle in the plane of a face is one of the other side of a thin sheet, rad."""
SHORTEST = 1e-9
"""Length of an edge that counts, m."""
SMALLEST = 0.7e-6
"""Area below which no cup of 1 mm fits on a face, m2."""
ROUNDING = 1e-6
"""How far a rim may be over the outline, m: numbers of STL files have seven digits."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FlatFace:
    """A face in the frame of its part: outward ``normal`` (3,), its ``offset`` m from the origin, and ``outline``.

    ``axes`` (2, 3) are unit vectors in its plane; ``outline`` (k, 2, 2) m are the ends of its edges in them, those of
    holes among them.
    """

    normal: Array
    offset: float
    axes: Array
    outline: Array

    def holds(self, place: Array, radius: float) -> bool:
        """Return whether a disc about ``place`` (3,) m is wholly on the face: no edge is under it."""
        centre = matmul(self.axes, place)
        start, along = self.outline[:, 0] - centre, self.outline[:, 1] - self.outline[:, 0]
        # the point of each edge that is nearest to the middle of the disc
        share = -einsum("ij,ij->i", start, along) / einsum("ij,ij->i", along, along)
        nearest = start + np.clip(share, 0.0, 1.0)[:, None] * along
        if not (einsum("ij,ij->i", nearest, nearest) >= max(radius - ROUNDING, 0.0) ** 2).all():
            return False
        # inside where a ray to the right crosses the outline an odd number of times
        end = start + along
        crosses = (start[:, 1] > 0.0) != (end[:, 1] > 0.0)
        right = start[crosses, 0] - start[crosses, 1] * along[crosses, 0] / along[crosses, 1] > 0.0
        return bool(np.count_nonzero(right) % 2)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FlatFaces:
    """The faces of a mesh and their ``normals`` (k, 3)."""

    faces: tuple[FlatFace, ...]
    normals: Array

    def towards(self, direction: Array, askew: float) -> list[FlatFace]:
        """Return the faces that look against a direction (3,), by at most an angle, rad."""
        looking = matmul(self.normals, direction) <= -np.cos(askew)
        return [self.faces[k] for k in np.flatnonzero(looking).tolist()]


@lru_cache(maxsize=256)
def flat_faces(body: BodyMesh) -> FlatFaces:
    """Return the flat faces of a mesh that a cup may seal on, the largest first."""
    faces = tuple(_Faces(body.mesh).found())
    return FlatFaces(faces=faces, normals=np.array([face.normal for face in faces]).reshape(-1, 3))


class _Faces:
    """Triangles, of which each belongs to one face."""

    def __init__(self, mesh: Mesh) -> None:
        self._mesh = mesh
        a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
        across = np.cross(b - a, c - a)
        lengths = np.sqrt(einsum("ij,ij->i", across, across))
        self._areas = lengths / 2.0
        self._normals = across / np.where(lengths > 0.0, lengths, 1.0)[:, None]
        self._edges = [[(a, b), (b, c), (c, a)] for a, b, c in mesh.faces.tolist()]
        self._owners: dict[tuple[int, int], list[int]] = {}
        for triangle, edges in enumerate(self._edges):
            for edge in edges:
                self._owners.setdefault(edge, []).append(triangle)
        self._left = set(range(len(self._edges)))

    def found(self) -> list[FlatFace]:
        """Return the faces; each begins at the largest triangle that is left."""
        faces = []
        for seed in np.argsort(-self._areas, kind="stable").tolist():
            if seed in self._left and self._areas[seed] > 0.0:
                face = self._grown(seed)
                if self._areas[face].sum() >= SMALLEST:
                    faces.append(self._face(seed, face))
        return faces

    def _grown(self, seed: int) -> list[int]:
        """Return the triangles in the plane of one that are left, from it on over their edges, and take them."""
        normal = self._normals[seed]
        offset = dot(normal, self._mesh.vertices[self._mesh.faces[seed, 0]])
        face, todo = [seed], [seed]
        self._left.discard(seed)
        while todo:
            for one, other in self._edges[todo.pop()]:
                for beside in self._owners.get((other, one), ()):
                    if beside in self._left and self._belongs(beside, normal, offset):
                        self._left.discard(beside)
                        face.append(beside)
                        todo.append(beside)
        return sorted(face)

    def _belongs(self, triangle: int, normal: Array, offset: float) -> bool:
        corners = self._mesh.vertices[self._mesh.faces[triangle]]
        near = bool((np.abs(matmul(corners, normal) - offset) <= FLAT).all())
        # whatever else its direction: the walls of a step that is as low are bridged too
        return near and dot(self._normals[triangle], normal) >= np.cos(AWAY)

    def _face(self, seed: int, face: list[int]) -> FlatFace:
        normal = self._normals[seed]
        # any direction in the plane will do; the one that is least along the normal is surely none of zero length
        first = np.cross(normal, np.eye(3)[int(np.abs(normal).argmin())])
        first /= np.sqrt(dot(first, first))
        axes = np.stack([first, np.cross(normal, first)])
        inner = {edge for triangle in face for edge in self._edges[triangle]}
        # an edge between two triangles of the face is in it in both directions
        outline = sorted(edge for edge in inner if edge[::-1] not in inner)
        corners = self._mesh.vertices[np.array(outline)]
        offset = dot(normal, self._mesh.vertices[self._mesh.faces[seed, 0]])
        ends = matmul(corners, axes.T)
        # the edges at the ends of a low step stand upright: seen from above they are points
        lengths = np.abs(ends[:, 1] - ends[:, 0]).max(axis=1)
        return FlatFace(normal=normal, offset=offset, axes=axes, outline=ends[lengths > SHORTEST])
