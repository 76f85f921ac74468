"""The meshes of an imported arm: found in the folder of the model and nowhere else, placed, and made coarser."""

import numpy as np
import pytest

from runtime.appearance import own_meshes as module
from runtime.appearance.cell_scene import scene_of
from runtime.appearance.own_meshes import mesh_files, own_meshes
from runtime.core.frames import frozen, pose, rotation_about
from runtime.core.tomlfile import Source
from runtime.robot.files.importer import load_file, parse_model
from runtime.robot.model.spec import LinkMesh
from tests.runtime.appearance.robots import MESHED, cell_with
from tests.runtime.meshes import binary_stl, box_mesh
from tests.runtime.robot.models import chain, inertial

BOX = binary_stl(box_mesh((2.0, 3.0, 4.0)))
TURN = pose([0.0, 0.0, 1.0], rotation_about([0.0, 1.0, 0.0], np.pi / 2.0))


def named(folder, file, *, link=1, X=TURN, scale=(0.1, 0.1, 0.1)):
    return LinkMesh(link=link, file=file, folder=str(folder), X_link_mesh=frozen(X), scale=frozen(scale))


@pytest.fixture
def folder(tmp_path):
    inside = tmp_path / "model"
    (inside / "meshes").mkdir(parents=True)
    (inside / "meshes" / "box.stl").write_bytes(BOX)
    (tmp_path / "secret.stl").write_bytes(BOX)
    return inside


@pytest.mark.parametrize(
    "file", ["meshes/box.stl", "package://arm/meshes/box.stl", "model://arm/meshes/box.stl", "package://meshes/box.stl"]
)
def test_a_mesh_is_found_scaled_and_placed(folder, file):
    found = own_meshes((named(folder, file),))
    assert found.notes == ()
    ((link, _, mesh),) = found.links
    assert link == 1
    # x of the link is z of the file, 4 long; z of the link is -x of the file, 2 long, one above
    np.testing.assert_allclose(mesh.vertices.max(axis=0), [0.2, 0.15, 1.1], atol=1e-7)
    np.testing.assert_allclose(mesh.vertices.min(axis=0), [-0.2, -0.15, 0.9], atol=1e-7)


@pytest.mark.parametrize(
    "file",
    [
        "../secret.stl",
        "package://../secret.stl",
        "package://arm/../../secret.stl",
        "/etc/passwd.stl",
        "C:/secret.stl",
        "meshes/absent.stl",
        "meshes/link.stl",
        "meshes/nul\0.stl",
        "meshes",
    ],
)
def test_nothing_outside_of_the_folder_is_opened(folder, file):
    (folder / "meshes" / "link.stl").symlink_to(folder.parent / "secret.stl")
    found = own_meshes((named(folder, file),))
    assert found.links == ()
    assert mesh_files((named(folder, file),)) == {}
    assert len(found.notes) == 1
    assert found.notes[0].startswith(file)


def test_the_files_of_meshes_are_named_from_the_folder_of_the_model(folder, monkeypatch):
    (folder / "meshes" / "other.obj").write_bytes(b"v 0 0 0")
    (folder / "meshes" / "notes.txt").write_bytes(b"not a mesh")
    files = ("package://arm/meshes/box.stl", "meshes/box.stl", "meshes/other.obj", "meshes/notes.txt")
    meshes = tuple(named(folder, file) for file in files)
    assert mesh_files(meshes) == {"meshes/box.stl": BOX, "meshes/other.obj": b"v 0 0 0"}
    monkeypatch.setattr(module, "MOST_COPIED", len(BOX))
    assert mesh_files(meshes) == {"meshes/box.stl": BOX}


def test_a_link_that_lacks_one_of_its_meshes_has_none(folder):
    meshes = [
        named(folder, "meshes/box.stl", link=1),
        named(folder, "meshes/box.dae", link=1),
        named(folder, "meshes/box.stl", link=2),
    ]
    found = own_meshes(tuple(meshes))
    assert [link for link, _, _ in found.links] == [2]
    assert len(found.notes) == 1


def test_meshes_beyond_those_of_a_scene_are_left_out(folder, monkeypatch):
    monkeypatch.setattr(module, "MOST_MESHES", 2)
    found = own_meshes(tuple(named(folder, "meshes/box.stl", link=link) for link in (1, 2, 3)))
    assert ([link for link, _, _ in found.links], len(found.notes)) == ([1, 2], 1)


@pytest.mark.parametrize("scale", [(100.0, 1.0, 1.0), (0.1, 0.1, float("nan"))])
def test_a_mesh_of_another_unit_is_left_out(folder, scale):
    found = own_meshes((named(folder, "meshes/box.stl", scale=scale),))
    assert (found.links, len(found.notes)) == ((), 1)


def test_a_mirrored_mesh_keeps_its_faces_outwards(folder):
    ((_, _, mesh),) = own_meshes((named(folder, "meshes/box.stl", scale=(0.1, -0.1, 0.1), X=np.eye(4)),)).links
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0.0


def test_a_fine_mesh_is_made_coarser_and_keeps_its_form(folder, monkeypatch):
    (folder / "ball.obj").write_text(ball())
    monkeypatch.setattr(module, "MOST_FACES", 1000)
    ((_, _, mesh),) = own_meshes((named(folder, "ball.obj", X=np.eye(4), scale=(1.0, 1.0, 1.0)),)).links
    assert 200 < len(mesh.faces) <= 1000
    assert np.linalg.norm(mesh.vertices, axis=1).min() > 0.9
    assert np.linalg.norm(mesh.vertices, axis=1).max() <= 1.0 + 1e-9


def ball():
    """A ball with a radius of 1, as an OBJ of 3481 squares."""
    angles = np.linspace(0.0, np.pi, 60)
    ring = np.stack([np.sin(angles), np.zeros(60), np.cos(angles)], axis=1)
    lines = [f"v {x * np.cos(t)} {x * np.sin(t)} {z}" for t in np.linspace(0, 2 * np.pi, 60) for x, _, z in ring]
    faces = [
        f"f {60 * k + j + 1} {60 * k + j + 2} {60 * k + j + 62} {60 * k + j + 61}" for k in range(59) for j in range(59)
    ]
    return "\n".join([*lines, *faces])


def test_a_small_mesh_beside_a_fine_one_becomes_its_box(folder, monkeypatch):
    (folder / "ball.obj").write_text(ball())
    monkeypatch.setattr(module, "MOST_FACES", 1000)
    fine = named(folder, "ball.obj", X=np.eye(4), scale=(1.0, 1.0, 1.0))
    screw = named(folder, "meshes/box.stl", link=2, X=np.eye(4), scale=(1e-3, 1e-3, 1e-3))
    (_, _, large), (link, _, small) = own_meshes((fine, screw)).links
    assert (link, len(large.faces) <= 1000) == (2, True)
    np.testing.assert_allclose(np.ptp(small.vertices, axis=0), [2e-3, 3e-3, 4e-3], atol=1e-9)
    a, b, c = np.moveaxis(small.vertices[small.faces], 1, 0)
    # closed, and its faces are outwards
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0 == pytest.approx(24e-9)


def test_links_with_meshes_show_them_and_others_shapes(tmp_path):
    cell = cell_with("seven_meshes", tmp_path)
    scene = scene_of(cell)
    kinds = {name: {s.kind for s in scene.shapes if s.body == name} for name in ("base", "link1", "link3", "link4")}
    assert kinds["link1"] == kinds["link4"] == {"mesh"}
    assert "mesh" not in kinds["base"] | kinds["link3"]
    assert len(scene.meshes) == len(MESHED)
    assert load_file(tmp_path / "seven_meshes.urdf").meshes[0].folder == str(tmp_path)


MJCF = """<mujoco model="two">
<compiler angle="radian" meshdir="meshes"/>
<default><mesh scale="0.1 0.1 0.1"/><default class="seen"><geom type="mesh" group="2"/></default>
<default class="met"><geom type="mesh" group="3"/></default></default>
<asset><mesh file="box.stl"/><mesh name="other" file="sub/x.obj" scale="1 2 3"/>
<mesh name="inline" vertex="0 0 0"/></asset>
<worldbody><geom class="seen" mesh="other"/>
<body name="a" pos="0 0 1"><joint name="j1" axis="0 1 0" pos="0 0 0.5" range="-1 1"/>
<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
<geom class="seen" mesh="box" pos="0 0 0.25"/><geom class="met" mesh="box"/><geom type="mesh" mesh="inline"/>
<body name="b" pos="0 0 1"><joint name="j2" axis="1 0 0" range="-1 1"/>
<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></body></worldbody></mujoco>"""


def test_an_mjcf_gives_the_meshes_that_mujoco_shows():
    meshes = parse_model(Source("model/two.xml", MJCF)).meshes
    assert [(mesh.link, mesh.file, mesh.folder) for mesh in meshes] == [
        (0, "meshes/sub/x.obj", "model"),
        (1, "meshes/box.stl", "model"),
    ]
    np.testing.assert_array_equal(meshes[0].scale, [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(meshes[1].scale, [0.1, 0.1, 0.1])
    # in the frame of the axis: z along the hinge, origin at its anchor, half a metre above the body
    np.testing.assert_allclose(meshes[1].X_link_mesh[:3, 3], [0.0, 0.25, 0.0], atol=1e-12)


def test_an_urdf_gives_the_meshes_of_all_that_is_fixed_together():
    text = f"""<robot name="r"><link name="l0"><visual><geometry><mesh filename="a.stl"/></geometry></visual>
<visual><geometry><box size="1 1 1"/></geometry></visual><visual/></link>
<joint name="j1" type="revolute"><parent link="l0"/><child link="l1"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint><link name="l1">{inertial()}</link>
<joint name="f" type="fixed"><parent link="l1"/><child link="cap"/><origin xyz="0 0 0.5"/></joint>
<link name="cap"><visual><origin xyz="0.1 0 0"/><geometry>
<mesh filename="b.dae" scale="2 2 2"/></geometry></visual></link>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0 0 1"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint><link name="l2">{inertial()}</link></robot>"""
    meshes = parse_model(Source("arm.urdf", text)).meshes
    assert [(mesh.link, mesh.file) for mesh in meshes] == [(0, "a.stl"), (1, "b.dae")]
    np.testing.assert_allclose(meshes[1].X_link_mesh[:3, 3], [0.1, 0.0, 0.5])


@pytest.mark.parametrize(
    ("visual", "collision", "shown"),
    [
        (["a.dae"], ["a.stl"], ["a.stl"]),
        (["a.dae", "b.stl"], ["a.STL", "b.obj"], ["a.STL", "b.obj"]),
        (["a.stl"], ["b.stl"], ["a.stl"]),
        (["a.dae"], ["a.dae"], ["a.dae"]),
        (["a.dae"], [], ["a.dae"]),
        ([], ["a.stl"], []),
    ],
)
def test_meshes_for_collisions_stand_in_for_those_that_are_not_read(visual, collision, shown):
    shapes = [("visual", file) for file in visual] + [("collision", file) for file in collision]
    text = "".join(f'<{kind}><geometry><mesh filename="{file}"/></geometry></{kind}>' for kind, file in shapes)
    frames = [((0, 0, 1), (0, 0, 0), (0, 0, 1)), ((0, 0, 1), (0, 0, 0), (1, 0, 0))]
    model = chain(frames).replace('<link name="l0"/>', f'<link name="l0">{text}</link>')
    assert [mesh.file for mesh in parse_model(Source("arm.urdf", model)).meshes] == shown
