"""Meshes with fewer triangles: those that are shown go into every log."""

import math

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array, frozen
from runtime.core.mesh import Mesh

FINEST, GROWTH = 1e-3, 1.1
"""Cell of the finest grid that makes meshes coarser, m, and the least factor from one to the next."""


def coarser(meshes: list[Mesh], most: int) -> list[Mesh]:
    """Return meshes of at most ``most`` faces in all: the vertices in one cell of a grid become one.

    All have one grid, so that no link of a robot is coarser than another.
    """
    cell, found = FINEST, meshes
    # always from the meshes themselves: errors of one grid would add to those of the next
    while (faces := sum(len(mesh.faces) for mesh in found)) > most:
        # of a surface, four times as many faces are left by a grid half as wide
        cell *= max(GROWTH, math.sqrt(faces / most)) if found is not meshes else 1.0
        found = [_snapped(mesh, cell) for mesh in meshes]
    return found


def _snapped(mesh: Mesh, cell: float) -> Mesh:
    low = mesh.vertices.min(axis=0)
    # one number for each cell, since numpy sorts numbers much faster than rows
    cells = np.floor((mesh.vertices - low) / cell).astype(np.int64)
    _, which, counts = np.unique(_numbered(cells), return_inverse=True, return_counts=True)
    middle = np.stack([np.bincount(which, mesh.vertices[:, k]) for k in range(3)], axis=1) / counts[:, None]
    faces = which[mesh.faces]
    a, b, c = faces.T
    kept = faces[(a != b) & (b != c) & (c != a)]
    # what is thinner than a cell is folded onto itself: each triangle stays once
    _, first = np.unique(_numbered(np.sort(kept, axis=1)), return_index=True)
    if not len(first):
        # a screw beside a housing is less than a cell: its box is seen, and a mesh without faces is none
        return _box(low, mesh.vertices.max(axis=0))
    return Mesh(vertices=frozen(middle), faces=kept[np.sort(first)].astype(np.int32))


def _box(low: Array, high: Array) -> Mesh:
    """Return a box between two corners (3,)."""
    corners = [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    return Mesh(vertices=frozen(corners), faces=np.array(faces, dtype=np.int32))


def _numbered(rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return one number for each row of three, each below 2^21."""
    return np.asarray((rows[:, 0] << 42) | (rows[:, 1] << 21) | rows[:, 2])
