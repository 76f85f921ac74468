"""The convex hull of points: quickhull (C. B. Barber, D. P. Dobkin and H. Huhdanpaa, "The Quickhull Algorithm for
Convex Hulls", ACM Transactions on Mathematical Software, 1996).

A face has the points that are over it and over no face before. The highest of them replaces all faces that it sees by
new ones between itself and their rim, which take over their points.

The points are first put on a grid of whole numbers, so that no rounding decides which side of a face a point is on:
faces of CAD programs have many points in one plane, and slivers whose normals would be noise.
"""

from collections.abc import Sequence

import numpy as np
from numpy import einsum
from numpy.typing import NDArray

from runtime.core.frames import Array, frozen
from runtime.core.mesh import Mesh

GRID = 2**20
"""Steps of the grid along the longest edge of the box: the largest for which a volume of three edges fits 64 bits."""

Whole = NDArray[np.int64]
Corners = tuple[int, int, int]
Vector = tuple[int, int, int]


def hull_of(points: Array) -> Mesh | None:
    """Return the convex hull of points (n, 3) as triangles; None where all are in one plane."""
    low, extent = points.min(axis=0), float(np.ptp(points, axis=0).max())
    if not extent > 0.0:
        return None
    whole = np.rint((points - low) * (GRID / extent)).astype(np.int64)
    # points that fall onto one place of the grid are one
    whole, which = np.unique(whole, axis=0, return_index=True)
    faces = _Hull(whole).faces()
    if faces is None:
        return None
    # of the points themselves, not of their places on the grid, and without those that are inside
    used, corners = np.unique(which[faces], return_inverse=True)
    return Mesh(vertices=frozen(points[used]), faces=corners.reshape(-1, 3).astype(np.int32))


class _Hull:
    """Faces by number: their corners, planes and the points over each."""

    def __init__(self, points: Whole) -> None:
        self._points = points
        self._places: list[Vector] = [(x, y, z) for x, y, z in points.tolist()]
        self._corners: dict[int, Corners] = {}
        self._planes: dict[int, tuple[Vector, int]] = {}
        self._over: dict[int, Whole] = {}
        self._beside: dict[tuple[int, int], int] = {}  # by an edge, the face that has it counter-clockwise
        self._count = 0

    def faces(self) -> NDArray[np.int64] | None:
        """Return the corners (f, 3) of the faces, counter-clockwise from outside; None for points in one plane."""
        first = self._first()
        if first is None:
            return None
        a, b, c, d = first
        todo = self._cover([(a, b, c), (a, d, b), (b, d, c), (c, d, a)], np.arange(len(self._points)))
        # the newest face first: its points are near, and what it replaces is soon forgotten
        while todo:
            # a face that has been replaced has no points any more
            if len(self._over.get(todo[-1], ())):
                todo += self._grow(todo.pop())
            else:
                todo.pop()
        return np.array(list(self._corners.values()))

    def _first(self) -> tuple[int, int, int, int] | None:
        """Return four points that are far apart; the first three are counter-clockwise from outside."""
        # as floats: these only have to be far apart, and squares would not fit
        points = self._points.astype(np.float64)
        a = int(points[:, 0].argmin())
        b = int(((points - points[a]) ** 2).sum(axis=1).argmax())
        c = int((np.cross(points - points[a], points[b] - points[a]) ** 2).sum(axis=1).argmax())
        heights = self._heights([self._plane((a, b, c))], np.arange(len(points)))[0]
        d = int(np.abs(heights).argmax())
        if heights[d] == 0:
            return None
        return (a, b, c, d) if heights[d] < 0 else (a, c, b, d)

    def _plane(self, corners: Corners) -> tuple[Vector, int]:
        """Return the normal and the offset of a face, in steps of the grid to the second and third power."""
        # written out: numpy takes ten times as long for three numbers
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (self._places[corner] for corner in corners)
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        return (x, y, z), x * ax + y * ay + z * az

    def _grow(self, face: int) -> list[int]:
        over = self._over[face]
        top = int(over[self._heights([self._planes[face]], over)[0].argmax()])
        seen = self._seen(face, top)
        # an edge of the rim has a face that stays on its other side
        rim = [edge for each in seen for edge in _edges(self._corners[each]) if self._beside[edge[::-1]] not in seen]
        left = np.concatenate([self._over[each] for each in seen])
        for each in seen:
            for edge in _edges(self._corners.pop(each)):
                del self._beside[edge]
            del self._planes[each], self._over[each]
        return self._cover([(one, other, top) for one, other in rim], left[left != top])

    def _seen(self, face: int, top: int) -> set[int]:
        """Return the faces that a point sees, and those in whose plane it is, which would be left in line with it."""
        seen, todo = {face}, [face]
        x, y, z = self._places[top]
        while todo:
            for one, other in _edges(self._corners[todo.pop()]):
                beside = self._beside[other, one]
                if beside in seen:
                    continue
                (nx, ny, nz), offset = self._planes[beside]
                if nx * x + ny * y + nz * z >= offset:
                    seen.add(beside)
                    todo.append(beside)
        return seen

    def _heights(self, planes: Sequence[tuple[Vector, int]], points: Whole) -> Whole:
        """Return how high points are over planes (planes, points): exact, since differences keep within 64 bits."""
        normals = np.array([normal for normal, _ in planes], dtype=np.int64)
        offsets = np.array([offset for _, offset in planes], dtype=np.int64)
        heights: Whole = einsum("fk,pk->fp", normals, self._points[points]) - offsets[:, None]
        return heights

    def _cover(self, faces: Sequence[Corners], points: Whole) -> list[int]:
        """Add faces, give each the points over it that none before has, and return their numbers."""
        planes = [self._plane(corners) for corners in faces]
        over = self._heights(planes, points) > 0 if len(points) else np.zeros((len(faces), 0), dtype=np.bool_)
        # the first face that has a point; of one that is over none, no face is right
        owner = np.where(over.any(axis=0), over.argmax(axis=0), -1)
        added = range(self._count, self._count + len(faces))
        self._count += len(faces)
        for k, (face, corners) in enumerate(zip(added, faces, strict=True)):
            self._corners[face], self._planes[face] = corners, planes[k]
            self._over[face] = points[owner == k] if len(points) else points
            self._beside.update(dict.fromkeys(_edges(corners), face))
        return list(added)


def _edges(corners: Corners) -> tuple[tuple[int, int], tuple[int, int], tuple[int, int]]:
    a, b, c = corners
    return (a, b), (b, c), (c, a)
