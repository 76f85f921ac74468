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


def extruded(corners, triangles, height: float) -> Mesh:
    """Return the solid over ``triangles`` of flat ``corners`` (n, 2), from z = 0 to a height; no corner is inside."""
    flat, count = np.array(corners, dtype=float), len(corners)
    vertices = np.vstack([np.c_[flat, np.zeros(count)], np.c_[flat, np.full(count, height)]])
    ends = [edge for a, b, c in triangles for edge in ((a, b), (b, c), (c, a))]
    rim = [(a, b) for a, b in ends if (b, a) not in ends]
    faces = [(c, b, a) for a, b, c in triangles]
    faces += [(a + count, b + count, c + count) for a, b, c in triangles]
    faces += [face for a, b in rim for face in ((a, b, b + count), (a, b + count, a + count))]
    return Mesh(vertices=vertices, faces=np.array(faces, dtype=np.int32))


def prism(sides: int, radius: float, height: float) -> Mesh:
    """Return a regular prism; a corner of its base is on x."""
    angles = np.arange(sides) * 2.0 * np.pi / sides
    fan = [(0, k, k + 1) for k in range(1, sides - 1)]
    return extruded(radius * np.c_[np.cos(angles), np.sin(angles)], fan, height)


def angle_bracket(leg: float, thickness: float, width: float) -> Mesh:
    """Return an L of two legs along x and y, ``width`` high."""
    corners = [(0, 0), (leg, 0), (leg, thickness), (thickness, thickness), (thickness, leg), (0, leg)]
    return extruded(corners, [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)], width)


def frame(outer: float, inner: float, height: float) -> Mesh:
    """Return a square plate with a square hole through its middle."""
    squares = [(half * x, half * y) for half in (outer / 2, inner / 2) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    ring = [face for k in range(4) for face in ((k, (k + 1) % 4, 4 + k), ((k + 1) % 4, 4 + (k + 1) % 4, 4 + k))]
    return extruded(squares, ring, height)
