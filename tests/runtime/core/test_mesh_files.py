"""Mesh files, which anybody may have written."""

import numpy as np
import pytest

from runtime.core import mesh_files
from runtime.core.mesh_files import MeshError, read_mesh
from tests.runtime.meshes import binary_stl, box_mesh

BOX = box_mesh((2.0, 3.0, 4.0))
BINARY = binary_stl(BOX)


def ascii_stl(mesh):
    facets = [
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"  VERTEX {x!r} {y!r} {z!r}\n".lower() for x, y, z in mesh.vertices[face].tolist())
        + "endloop\nendfacet\n"
        for face in mesh.faces
    ]
    return ("solid box\n" + "".join(facets) + "endsolid box\n").encode()


def obj(mesh, last=str):
    vertices = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist()]
    faces = [f"f {a + 1}//7 {b + 1}/2 {last(c + 1)}" for a, b, c in mesh.faces.tolist()]
    return "\n".join(["# a box", "mtllib ../../secret.mtl", *vertices, "usemtl x", *faces]).encode()


def written(tmp_path, name, raw):
    path = tmp_path / name
    path.write_bytes(raw)
    return path


def volume(mesh):
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0


@pytest.mark.parametrize(
    ("name", "raw"),
    [
        ("box.stl", BINARY),
        ("BOX.STL", ascii_stl(BOX)),
        ("box.obj", obj(BOX)),
        ("box.obj", obj(BOX, last=lambda number: str(number - 9))),
        ("crlf.obj", obj(BOX).replace(b"\n", b"\r\n")),
    ],
)
def test_a_box_is_read_with_eight_vertices_and_its_faces_outwards(tmp_path, name, raw):
    mesh = read_mesh(written(tmp_path, name, raw))
    assert (mesh.vertices.shape, mesh.faces.shape) == ((8, 3), (12, 3))
    assert volume(mesh) == pytest.approx(24.0)


def test_a_face_of_many_corners_becomes_a_fan(tmp_path):
    raw = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
    mesh = read_mesh(written(tmp_path, "quad.obj", raw))
    assert len(mesh.faces) == 2


@pytest.mark.parametrize(
    ("name", "raw"),
    [
        ("box.dae", b"<COLLADA/>"),
        ("box.stl.exe", BINARY),
        ("cut.stl", BINARY[:-1]),
        ("long.stl", BINARY + b"x"),
        ("huge.stl", BINARY[:80] + b"\xff\xff\xff\xff"),
        ("empty.stl", b""),
        ("none.stl", BINARY[:80] + bytes(4)),
        ("text.stl", b"solid\nvertex 0 0 zero\n"),
        ("two.stl", b"solid\nvertex 0 0 0\nvertex 1 0 0\n"),
        ("short.stl", b"solid\nvertex 0 0\nvertex 1 0 0\nvertex 1 1 0\n"),
        ("nan.stl", b"solid\nvertex 0 0 nan\nvertex 1 0 0\nvertex 1 1 0\n"),
        ("signalling_nan.stl", BINARY[:96] + b"\x01\x00\xa0\x7f" + BINARY[100:]),
        ("far.stl", b"solid\nvertex 0 0 1e9\nvertex 1 0 0\nvertex 1 1 0\n"),
        ("line.stl", b"solid\nvertex 0 0 0\nvertex 0 0 0\nvertex 1 1 0\n"),
        ("no_face.obj", b"v 0 0 0\n"),
        ("beyond.obj", b"v 0 0 0\nf 1 2 3\n"),
        ("before.obj", b"v 0 0 0\nf -1 -2 -3\n"),
        ("zero.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 0 1 2\n"),
        ("word.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf a b c\n"),
        ("binary.obj", BINARY),
    ],
)
def test_what_is_no_mesh_is_refused(tmp_path, name, raw):
    with pytest.raises(MeshError):
        read_mesh(written(tmp_path, name, raw))


def test_files_that_are_none_or_too_large_are_refused(tmp_path, monkeypatch):
    with pytest.raises(MeshError):
        read_mesh(tmp_path / "absent.stl")
    (tmp_path / "folder.stl").mkdir()
    with pytest.raises(MeshError):
        read_mesh(tmp_path / "folder.stl")
    monkeypatch.setattr(mesh_files, "MOST_BYTES", len(BINARY) - 1)
    with pytest.raises(MeshError):
        read_mesh(written(tmp_path, "box.stl", BINARY))
