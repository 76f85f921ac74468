"""Meshes of files: STL, binary or text, and OBJ. Anybody may have written them.

A file is read whole and bounded, and counts of what follows are checked against its size before anything is made of
them. What is not one of the two, or is damaged, is no mesh; the text of ``MeshError`` says why.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np

from runtime.core.bounded_files import RefusedError, read_bounded
from runtime.core.frames import Array, frozen
from runtime.core.mesh import Mesh

MESH_ENDINGS = (".stl", ".obj")
"""Endings of the mesh files that are read."""
MOST_BYTES = 30_000_000
"""Size of a mesh file, bytes: an STL of 600,000 triangles."""
FARTHEST = 1e6
"""No number of a mesh is larger, in the unit of the file: a kilometre in mm."""

_HEADER, _RECORD = 80, 50
# normal, three corners, and two bytes that nobody uses
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("unused", "<u2")])


class MeshError(Exception):
    """A file that gives no mesh; the text says why, as a sentence about the file."""


def read_mesh(path: Path, most: int | None = None) -> Mesh:
    """Return the mesh of a file, in the file's unit; ``MeshError``, also for more than ``most`` triangles."""
    if path.suffix.lower() not in MESH_ENDINGS:
        raise MeshError(f"is neither {' nor '.join(MESH_ENDINGS)}")
    try:
        raw = read_bounded(path, MOST_BYTES)
    except RefusedError as error:
        # its own text names no path
        size = f"is larger than {MOST_BYTES // 1_000_000} MB" if error.size else f"cannot be read: {error.reason}"
        raise MeshError(size) from None
    corners, faces = _obj(raw) if path.suffix.lower() == ".obj" else _stl(raw)
    if not len(faces):
        raise MeshError("has no triangles")
    # before they are sorted, which takes longest
    if most is not None and len(faces) > most:
        raise MeshError(f"has {len(faces)} triangles, more than {most}")
    if not (np.abs(corners) <= FARTHEST).all():  # NaN too
        raise MeshError(f"has a number that is not within {FARTHEST:g}")
    return _joined(corners, faces)


def _joined(corners: Array, faces: Array) -> Mesh:
    """Return a mesh without double vertices: an STL gives each triangle its own three."""
    vertices, which = np.unique(corners, axis=0, return_inverse=True)
    indices = which.reshape(-1)[faces.astype(np.int64)]
    a, b, c = indices.T
    whole = (a != b) & (b != c) & (c != a)
    if not whole.any():
        raise MeshError("has no triangles")
    return Mesh(vertices=frozen(vertices), faces=indices[whole].astype(np.int32))


def _stl(raw: bytes) -> tuple[Array, Array]:
    """Return corners (3 t, 3) and their numbers (t, 3)."""
    count = int.from_bytes(raw[_HEADER : _HEADER + 4], "little")
    # by its size, not by its first word: binary files may begin with "solid" too
    if len(raw) == _HEADER + 4 + _RECORD * count:
        triangles = np.frombuffer(raw, _TRIANGLE, count, _HEADER + 4)["corners"]
        # a NaN of the kind that signals is refused below as any other; numpy would warn of it first
        with np.errstate(invalid="ignore"):
            corners = triangles.reshape(-1, 3).astype(np.float64)
    elif raw[:5].lower() == b"solid":
        corners = _numbers([line[1:] for line in _lines(raw) if line[:1] == ["vertex"]])
    else:
        raise MeshError("is no STL: its size is not that of its triangles")
    if len(corners) % 3:
        raise MeshError("is cut off: its last triangle is not whole")
    return corners, np.arange(len(corners), dtype=np.float64).reshape(-1, 3)


def _obj(raw: bytes) -> tuple[Array, Array]:
    """Return vertices (v, 3) and triangles (t, 3); faces with more corners become fans."""
    rows: list[list[str]] = []
    faces: list[tuple[int, int, int]] = []
    for line in _lines(raw):
        if line[:1] == ["v"]:
            rows.append(line[1:4])
        elif line[:1] == ["f"]:
            ring = [_corner(word, len(rows)) for word in line[1:]]
            faces += [(ring[0], one, other) for one, other in pairwise(ring[1:])]
    return _numbers(rows), np.array(faces, dtype=np.float64).reshape(-1, 3)


def _corner(word: str, count: int) -> int:
    """Return the number, from 0, of the vertex of ``v``, ``v/t`` or ``v/t/n``; negative ones count from the last."""
    try:
        number = int(word.split("/")[0])
    except ValueError:
        number = 0
    index = number - 1 if number > 0 else count + number
    if number == 0 or not 0 <= index < count:
        raise MeshError("has a face without its vertices")
    return index


def _lines(raw: bytes) -> list[list[str]]:
    return [line.split() for line in raw.decode("latin-1").splitlines()]


def _numbers(rows: list[list[str]]) -> Array:
    try:
        return np.array([[float(word) for word in row] for row in rows], dtype=np.float64).reshape(-1, 3)
    except ValueError:
        raise MeshError("has a vertex that is not three numbers") from None
