"""Meshes and their files, for tests."""

import numpy as np

from runtime.core.mesh import Mesh


def box_mesh(size: tuple[float, float, float]) -> Mesh:
    """Return a box as triangles, counter-clockwise from outside."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * size
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    return Mesh(vertices=corners, faces=np.array(faces, dtype=np.int32))


def binary_stl(mesh: Mesh) -> bytes:
    """Return a binary STL."""
    records = np.zeros(len(mesh.faces), np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("u", "<u2")]))
    records["c"] = mesh.vertices[mesh.faces]
    return b"solid, and yet binary".ljust(80) + len(mesh.faces).to_bytes(4, "little") + records.tobytes()
