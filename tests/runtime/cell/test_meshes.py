"""Parts and obstacles that are meshes: what a cell file has of them, and what is refused."""

import os
import sys

import numpy as np
import pytest

from robolang.project.builtin import cell_text
from runtime.cell import body_mesh, mesh_keys
from runtime.cell.cell import build
from runtime.cell.cell_file import parse_cell_file, read_cell_file
from runtime.core.mesh import Mesh
from runtime.core.mesh_files import read_mesh
from runtime.core.tomlfile import FileFault, Source
from tests.runtime.meshes import angle_bracket, binary_stl, box_mesh, frame, prism

SIZE = "size_mm = [60, 40, 80]"
HEX = prism(6, 20.0, 80.0)
BOX = box_mesh((60.0, 40.0, 80.0))
INWARDS = Mesh(vertices=BOX.vertices, faces=BOX.faces[:, ::-1])
TWICE = Mesh(vertices=BOX.vertices, faces=np.vstack([BOX.faces, BOX.faces]))
OPEN = Mesh(vertices=BOX.vertices, faces=BOX.faces[1:])


def cell(folder, mesh=BOX, keys='file = "part.stl"', name="part.stl", more=""):
    """The built-in cell with a mesh for its part, in a file."""
    if mesh is not None:
        (folder / name).write_bytes(mesh if isinstance(mesh, bytes) else binary_stl(mesh))
    text = cell_text()
    assert SIZE in text
    path = folder / "demo.cell.toml"
    path.write_text(text.replace(SIZE, f'shape = "mesh"\n{keys}') + more)
    return path


def refused(path):
    with pytest.raises(FileFault) as caught:
        read_cell_file(path)
    fault = caught.value
    assert fault.path == str(path)
    return fault.code, path.read_text().splitlines()[fault.line - 1].split(" ")[0]


def test_a_mesh_in_si_about_the_middle_of_its_box(tmp_path):
    far = Mesh(vertices=HEX.vertices + [500.0, -200.0, 30.0], faces=HEX.faces)
    file = read_cell_file(cell(tmp_path, far))
    assert (file.warnings, file.meshes) == ((), ("part.stl",))
    part = build(file).parts[0]
    width = 0.04 * np.cos(np.pi / 6)
    np.testing.assert_allclose(part.size, [0.04, width, 0.08], atol=1e-8)
    np.testing.assert_allclose(
        [part.mesh.mesh.vertices.min(axis=0), part.mesh.mesh.vertices.max(axis=0)],
        [-part.size / 2, part.size / 2],
        atol=1e-8,
    )
    assert part.cog == pytest.approx(np.zeros(3), abs=1e-8)
    assert part.mesh.filled == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(("scale", "size"), [("1", 0.06), ("1.0", 0.06), ("25.4", 0.06 * 25.4), ("0.5", 0.03)])
def test_the_scale_makes_the_numbers_of_the_file_mm(tmp_path, scale, size):
    spec = build(read_cell_file(cell(tmp_path, keys=f'file = "part.stl"\nscale = {scale}')))
    assert spec.parts[0].size[0] == pytest.approx(size)
    assert np.ptp(spec.parts[0].mesh.mesh.vertices[:, 0]) == pytest.approx(size)


def test_a_file_that_several_bodies_name_is_read_once(tmp_path):
    more = '\n[[obstacles]]\nname = "o{}"\nshape = "mesh"\nfile = "part.stl"\npose_mm_deg = [0, 900, {}, 0, 0, 0]\n'
    spec = build(read_cell_file(cell(tmp_path, more=more.format(1, 100) + more.format(2, 900))))
    assert spec.obstacles[-1].mesh is spec.obstacles[-2].mesh is spec.parts[0].mesh


def test_a_file_that_is_refused_is_read_once_and_refused_wherever_it_is_named(tmp_path, monkeypatch):
    read = []
    monkeypatch.setattr(body_mesh, "read_mesh", lambda *given: read.append(given) or read_mesh(*given))
    more = '\n[[obstacles]]\nname = "o"\nshape = "mesh"\nfile = "part.stl"\npose_mm_deg = [0, 900, 100, 0, 0, 0]\n'
    path = cell(tmp_path, OPEN, more=more)
    with pytest.raises(FileFault) as caught:
        read_cell_file(path)
    assert [fault.code for fault in caught.value.all] == ["RBL644"] * 2
    assert len({str(fault) for fault in caught.value.all}) == 2
    assert len(read) == 1


def test_a_file_in_a_folder_of_the_cell_and_an_obj(tmp_path):
    (tmp_path / "meshes").mkdir()
    vertices = [f"v {x!r} {y!r} {z!r}" for x, y, z in BOX.vertices.tolist()]
    raw = "\n".join([*vertices, *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in BOX.faces.tolist())]).encode()
    path = cell(tmp_path, raw, 'file = "meshes/part.obj"', "meshes/part.obj")
    assert build(read_cell_file(path)).parts[0].size[2] == pytest.approx(0.08)


def nan_stl():
    return b"solid\n" + b"vertex 0 0 nan\nvertex 1 0 0\nvertex 1 1 0\n"


@pytest.mark.parametrize(
    ("mesh", "keys", "expected"),
    [
        (None, 'file = "part.stl"', ("RBL643", "file")),
        (b"no mesh", 'file = "part.stl"', ("RBL643", "file")),
        (nan_stl(), 'file = "part.stl"', ("RBL643", "file")),
        (binary_stl(BOX)[:-7], 'file = "part.stl"', ("RBL643", "file")),
        (BOX, 'file = "part.step"', ("RBL643", "file")),
        (BOX, 'file = ""', ("RBL643", "file")),
        (OPEN, 'file = "part.stl"', ("RBL644", "file")),
        (TWICE, 'file = "part.stl"', ("RBL644", "file")),
        (INWARDS, 'file = "part.stl"', ("RBL644", "file")),
        (Mesh(vertices=BOX.vertices * [1, 1, 0], faces=BOX.faces), 'file = "part.stl"', ("RBL644", "file")),
        (BOX, 'file = "part.stl"\nscale = 1000', ("RBL605", "scale")),
        (BOX, 'file = "part.stl"\nscale = 0.001', ("RBL605", "scale")),
        (Mesh(vertices=BOX.vertices / 1000.0, faces=BOX.faces), 'file = "part.stl"', ("RBL605", "file")),
        (BOX, 'file = "part.stl"\nscale = 0', ("RBL605", "scale")),
        (BOX, 'file = "part.stl"\nscale = -1', ("RBL605", "scale")),
        (BOX, 'file = "part.stl"\nscale = nan', ("RBL604", "scale")),
        (BOX, 'file = "../part.stl"', ("RBL602", "file")),
        (BOX, 'file = "/etc/part.stl"', ("RBL602", "file")),
        (BOX, "file = 7", ("RBL613", "file")),
        (BOX, 'file = "part.stl"\nfilled = 1', ("RBL613", "filled")),
        (BOX, 'file = "part.stl"\nsize_mm = [1, 1, 1]', ("RBL609", "size_mm")),
    ],
)
def test_what_is_no_solid_of_a_size_is_refused_at_its_key(tmp_path, mesh, keys, expected):
    assert refused(cell(tmp_path, mesh, keys)) == expected


def test_other_kinds_of_files_are_refused(tmp_path):
    os.mkfifo(tmp_path / "part.stl")
    assert refused(cell(tmp_path, None)) == ("RBL643", "file")
    outside = tmp_path / "outside.stl"
    outside.write_bytes(binary_stl(BOX))
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "part.stl").symlink_to(outside)
    assert refused(cell(inner, None)) == ("RBL602", "file")
    (inner / "part.stl").unlink()
    (inner / "part.stl").mkdir()
    assert refused(cell(inner, None)) == ("RBL643", "file")


def test_more_triangles_and_files_than_are_read_are_refused(tmp_path, monkeypatch):
    fine = prism(5100, 20.0, 80.0)
    assert len(fine.faces) > 20_000
    assert refused(cell(tmp_path, fine)) == ("RBL643", "file")
    monkeypatch.setattr(mesh_keys, "MOST_FILES", 0)
    assert refused(cell(tmp_path)) == ("RBL643", "file")


def test_a_cell_held_as_text_names_no_file(tmp_path):
    text = cell(tmp_path).read_text()
    with pytest.raises(FileFault) as caught:
        parse_cell_file(Source("demo.cell.toml", text))
    assert caught.value.code == "RBL602"


def test_errors_of_a_mesh_and_of_other_parts_are_found_at_once(tmp_path):
    path = cell(tmp_path, OPEN)
    path.write_text(path.read_text().replace("dwell_s = 0.3", "dwell_s = -1"))
    with pytest.raises(FileFault) as caught:
        read_cell_file(path)
    assert {fault.code for fault in caught.value.all} == {"RBL605", "RBL644"}


@pytest.mark.parametrize(
    ("mesh", "keys", "codes"),
    [
        (angle_bracket(60.0, 6.0, 80.0), 'file = "part.stl"', ["RBL645"]),
        (angle_bracket(60.0, 6.0, 80.0), 'file = "part.stl"\nfilled = true', []),
        (frame(40.0, 16.0, 80.0), 'file = "part.stl"', []),  # 1 / (1 - 0.16) = 1.19
        (frame(40.0, 16.4, 80.0), 'file = "part.stl"', ["RBL645"]),
        (HEX, 'file = "part.stl"', []),
    ],
)
def test_a_shape_that_contacts_fill_is_noted(tmp_path, mesh, keys, codes):
    path = cell(tmp_path, mesh, keys)
    found = read_cell_file(path).doubts
    assert [fault.code for fault in found] == codes
    assert all(path.read_text().splitlines()[fault.line - 1].startswith("file") for fault in found)


@pytest.mark.parametrize(
    ("x", "z", "wrong"),
    [(480, 640, False), (480, 647, True), (480, 630, True), (310, 640, False), (300, 640, False), (313, 640, True)],
)
def test_where_a_mesh_rests_its_hull_counts(tmp_path, x, z, wrong):
    """A wedge of 80 mm beside an obstacle of the same kind, hypotenuse to hypotenuse."""
    wedge = Mesh(
        vertices=np.array([(x, y, z) for y in (-20.0, 20.0) for x, z in ((0, 0), (80, 0), (0, 80))]),
        faces=np.array([(0, 1, 2), (3, 5, 4), (0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (2, 5, 3), (2, 3, 0)]),
    )
    more = '\n[[obstacles]]\nname = "w"\nshape = "mesh"\nfile = "part.stl"\npose_mm_deg = [310, -220, 640, 0, 180, 0]\n'
    path = cell(tmp_path, wedge, more=more)
    path.write_text(path.read_text().replace("[480, -220, 640, 0, 0, 0]", f"[{x}, -220, {z}, 0, 0, 0]"))
    assert [fault.code for fault in read_cell_file(path).doubts] == ["RBL640"] * wrong


def test_a_cell_without_meshes_needs_no_numerics():
    import subprocess

    code = (
        "import sys; from robolang.project.discovery import builtin_cell_file; builtin_cell_file(); "
        "sys.exit('numpy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
