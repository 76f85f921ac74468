"""Scenes: the bodies and shapes of a cell, their JSON, and what is refused of a JSON that anybody may have written."""

import copy
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from runtime.appearance import surroundings
from runtime.appearance.cell_scene import scene_of
from runtime.appearance.mechanisms import machine_scene
from runtime.appearance.scene import ROLES, Scene, SceneBody, SceneJoint, Shape, View
from runtime.appearance.stance import Stance, world_poses
from runtime.cell.body_mesh import read_body_mesh
from runtime.core.faults import Fault
from runtime.core.frames import pose
from runtime.core.mesh import Mesh
from runtime.pulses.mechanism import library, load_builtin
from tests.runtime.from_texts import load_cell
from tests.runtime.meshes import angle_bracket, binary_stl, prism

CELL = load_cell(Path("programs/pick_and_place.cell.toml"))
TRIANGLE = Mesh(vertices=np.eye(3), faces=np.array([[0, 1, 2]], dtype=np.int32))
SCENE = Scene(
    robot="two",
    reach=1.5,
    bodies=(
        SceneBody(name="base", parent=None, X_parent_body=np.eye(4)),
        SceneBody(
            name="arm",
            parent="base",
            X_parent_body=pose([0.0, 0.0, 0.1]),
            joint=SceneJoint(kind="revolute", axis=np.array([0.0, 0.0, 1.0]), source="axis", index=0),
        ),
    ),
    shapes=(
        Shape(body="arm", kind="box", X_body_shape=np.eye(4), size=(0.1, 0.2, 0.3), role="body", name="<b>"),
        Shape(body="base", kind="mesh", X_body_shape=np.eye(4), size=(), role="cover", mesh="m"),
    ),
    colours=dict.fromkeys(ROLES, "#102030"),
    meshes={"m": TRIANGLE},
    camera=View(position=np.array([2.0, 0.0, 1.0]), target=np.zeros(3)),
)


def test_a_scene_comes_back_from_its_json():
    value = json.loads(json.dumps(SCENE.as_json(), allow_nan=False))
    again = Scene.from_json(value)
    assert again.as_json() == value
    assert (again.bodies[1].parent, again.bodies[1].joint.index, again.shapes[0].size) == ("base", 0, (0.1, 0.2, 0.3))
    assert again.meshes["m"].faces.tolist() == [[0, 1, 2]]


def test_the_scene_of_a_cell_names_its_bodies_parents_first():
    scene = scene_of(CELL, {"P1": pose([0.1, 0.2, 0.3])})
    names = [body.name for body in scene.bodies]
    assert names == [
        "base",
        *(f"link{k}" for k in range(1, 7)),
        "flange",
        "tool",
        "finger_left",
        "finger_right",
        "part:part",
        "obstacle:table",
    ]
    assert all(body.parent is None or body.parent in names[:k] for k, body in enumerate(scene.bodies))
    sources = [(body.joint.source, body.joint.index) for body in scene.bodies if body.joint]
    assert sources == [*(("axis", k) for k in range(6)), ("finger", 0), ("finger", 1), ("part", 0)]
    assert [mark.name for mark in scene.points] == ["P1"]
    value = json.loads(json.dumps(scene.as_json()))
    assert Scene.from_json(value).as_json() == value


def _set(path, value):
    def change(scene):
        *folders, last = path
        for each in folders:
            scene = scene[each]
        scene[last] = value

    return change


def _unset(*path):
    def change(scene):
        *folders, last = path
        for each in folders:
            scene = scene[each]
        del scene[last]

    return change


IDENTITY = np.eye(4).tolist()
TORN = [[2.0 * x for x in row] for row in IDENTITY]
MIRROR = np.diag([1.0, 1.0, -1.0, 1.0]).tolist()
LONG = "x" * 201


@pytest.mark.parametrize(
    ("change", "place"),
    [
        (_unset("bodies"), "scene"),
        (_set(["bodies"], {}), "scene.bodies"),
        (_set(["bodies"], [{}] * 50_001), "scene.bodies"),
        (_set(["bodies", 0], 7), "scene.bodies[0]"),
        (_set(["bodies", 0, "name"], LONG), "scene.bodies[0].name"),
        (_set(["bodies", 0, "name"], None), "scene.bodies[0].name"),
        (_set(["bodies", 1, "name"], "base"), "scene.bodies[1]"),
        (_set(["bodies", 0, "parent"], "arm"), "scene.bodies[0].parent"),
        (_set(["bodies", 1, "parent"], "arm"), "scene.bodies[1].parent"),
        (_set(["bodies", 1, "X"], IDENTITY[:3]), "scene.bodies[1].X"),
        (_set(["bodies", 1, "X"], TORN), "scene.bodies[1].X"),
        (_set(["bodies", 1, "X"], MIRROR), "scene.bodies[1].X"),
        (_set(["bodies", 1, "X", 0, 3], float("nan")), "scene.bodies[1].X"),
        (_set(["bodies", 1, "X", 0, 3], 1e5), "scene.bodies[1].X"),
        (_set(["bodies", 1, "X", 0, 3], "1"), "scene.bodies[1].X"),
        (_set(["bodies", 1, "X", 0, 3], True), "scene.bodies[1].X"),
        (_set(["bodies", 1, "X", 0, 3], 10**400), "scene.bodies[1].X"),
        (_set(["bodies", 1, "X", 0], [1.0]), "scene.bodies[1].X"),
        (_set(["bodies", 1, "X", 3, 0], 0.5), "scene.bodies[1].X"),
        (_set(["bodies", 1, "joint", "kind"], "ball"), "scene.bodies[1].joint.kind"),
        (_set(["bodies", 1, "joint", "axis"], [0, 0, 0.5]), "scene.bodies[1].joint.axis"),
        (_set(["bodies", 1, "joint", "axis"], [0, 0, float("nan")]), "scene.bodies[1].joint.axis"),
        (_set(["bodies", 1, "joint", "source"], "wind"), "scene.bodies[1].joint.source"),
        (_set(["bodies", 1, "joint", "index"], -1), "scene.bodies[1].joint.index"),
        (_set(["bodies", 1, "joint", "index"], True), "scene.bodies[1].joint.index"),
        (_set(["bodies", 1, "joint", "index"], 0.0), "scene.bodies[1].joint.index"),
        (_set(["shapes", 0, "body"], "leg"), "scene.shapes[0].body"),
        (_set(["shapes", 0, "kind"], "torus"), "scene.shapes[0].kind"),
        (_set(["shapes", 0, "size"], [1.0]), "scene.shapes[0].size"),
        (_set(["shapes", 0, "size"], [1.0, 1.0, -1.0]), "scene.shapes[0].size"),
        (_set(["shapes", 0, "size"], [1.0, 0.0, 1.0]), "scene.shapes[0].size"),
        (_set(["shapes", 0, "size"], [1.0, 5e-324, 1.0]), "scene.shapes[0].size"),
        (_set(["shapes", 0, "size"], [1.0, 1.0, float("nan")]), "scene.shapes[0].size"),
        (_set(["shapes", 0, "size", 0], float("inf")), "scene.shapes[0].size"),
        (_set(["shapes", 0, "colour"], "red"), "scene.shapes[0].colour"),
        (_set(["shapes", 0, "mesh"], "m"), "scene.shapes[0].mesh"),
        (_set(["shapes", 1, "mesh"], None), "scene.shapes[1].mesh"),
        (_set(["shapes", 1, "mesh"], "other"), "scene.shapes[1].mesh"),
        (_set(["shapes", 1, "mesh"], []), "scene.shapes[1].mesh"),
        (_set(["colours", "body"], "red"), "scene.colours.body"),
        (_set(["colours", "body"], "#10203g"), "scene.colours.body"),
        (_set(["colours", "body"], "#102030;x"), "scene.colours.body"),
        (_unset("colours", "body"), "scene.colours"),
        (_set(["colours"], [1]), "scene.colours"),
        (_set(["meshes", "m", "faces"], [[0, 1, 3]]), "scene.meshes.m.faces"),
        (_set(["meshes", "m", "faces"], [[0, 1, -1]]), "scene.meshes.m.faces"),
        (_set(["meshes", "m", "faces"], [[0, 1, 0.5]]), "scene.meshes.m.faces"),
        (_set(["meshes", "m", "faces"], [[0, 1]]), "scene.meshes.m.faces"),
        (_set(["meshes", "m", "vertices"], []), "scene.meshes.m.vertices"),
        (_set(["meshes"], {LONG: {}}), "a name in scene.meshes"),
        (_set(["reach"], 0.0), "scene.reach"),
        (_set(["reach"], 1e-300), "scene.reach"),
        (_set(["reach"], float("nan")), "scene.reach"),
        (_set(["reach"], None), "scene.reach"),
        (_set(["frames"], [{"name": "F", "X": TORN}]), "scene.frames[0].X"),
        (_set(["points"], "P1"), "scene.points"),
        (_set(["camera", "position"], [0, 0, 0]), "scene.camera"),
        (_set(["camera", "position"], [0, 0, float("nan")]), "scene.camera.position"),
        (_unset("camera", "target"), "scene.camera"),
        (_unset("camera"), "scene"),
    ],
)
def test_a_scene_that_is_none_is_refused_at_its_place(change, place):
    value = copy.deepcopy(SCENE.as_json())
    change(value)
    with pytest.raises(Fault) as refused:
        Scene.from_json(value)
    assert refused.value.code == "RBL833"
    assert refused.value.message.startswith(f"{place} ")


@pytest.mark.parametrize("value", [None, 7, "scene", [], {}])
def test_what_is_no_object_is_no_scene(value):
    with pytest.raises(Fault) as refused:
        Scene.from_json(value)
    assert refused.value.code == "RBL833"


def test_more_vertices_than_a_picture_can_have_are_refused():
    value = SCENE.as_json()
    half = [[0.0, 0.0, 0.0]] * 150_001
    value["meshes"] = {name: {"vertices": half, "faces": [[0, 1, 2]]} for name in ("m", "n")}
    with pytest.raises(Fault) as refused:
        Scene.from_json(value)
    assert (refused.value.code, refused.value.message.split(" ")[0]) == ("RBL833", "scene.meshes.n")


def test_a_cylinder_is_drawn_as_one():
    part = replace(CELL.parts[0], shape="cylinder", size=np.array([0.04, 0.04, 0.1]))
    post = replace(CELL.obstacles[0], shape="cylinder", size=np.array([0.06, 0.06, 0.2]))
    shapes = {shape.body: shape for shape in scene_of(replace(CELL, parts=(part,), obstacles=(post,))).shapes}
    for body, size in ((f"part:{part.name}", (0.02, 0.02, 0.1)), (f"obstacle:{post.name}", (0.03, 0.03, 0.2))):
        assert (shapes[body].kind, shapes[body].size) == ("cylinder", pytest.approx(size))
        np.testing.assert_allclose(shapes[body].X_body_shape, np.eye(4), atol=1e-12)


def test_a_mesh_is_drawn_as_it_is_and_once_for_all_bodies(tmp_path):
    """Not its hull; and a log keeps it, since its file may be gone."""
    (tmp_path / "l bracket.stl").write_bytes(binary_stl(angle_bracket(60.0, 6.0, 40.0)))
    body = read_body_mesh(tmp_path / "l bracket.stl", "l bracket.stl", 1.0)
    part = replace(CELL.parts[0], shape="mesh", mesh=body, size=body.size)
    post = replace(CELL.obstacles[0], shape="mesh", mesh=body, size=body.size)
    (tmp_path / "l bracket.stl").unlink()
    scene = Scene.from_json(json.loads(json.dumps(scene_of(replace(CELL, parts=(part,), obstacles=(post,))).as_json())))
    shapes = {shape.body: shape for shape in scene.shapes}
    for name, role in ((f"part:{part.name}", "part"), (f"obstacle:{post.name}", "obstacle")):
        shape = shapes[name]
        assert (shape.kind, shape.role, shape.mesh) == ("mesh", role, "cell:0:l bracket")
        np.testing.assert_allclose(shape.X_body_shape, np.eye(4), atol=1e-12)
    (mesh,) = scene.meshes.values()
    np.testing.assert_allclose(mesh.vertices, body.mesh.vertices, atol=1e-5)
    assert (mesh.faces == body.mesh.faces).all()


def test_many_triangles_of_bodies_are_made_fewer(tmp_path, monkeypatch):
    monkeypatch.setattr(surroundings, "MOST_FACES", 500)
    (tmp_path / "round.stl").write_bytes(binary_stl(prism(400, 200.0, 40.0)))
    body = read_body_mesh(tmp_path / "round.stl", "round.stl", 1.0)
    scene = scene_of(replace(CELL, parts=(replace(CELL.parts[0], shape="mesh", mesh=body, size=body.size),)))
    (mesh,) = scene.meshes.values()
    assert 100 < len(mesh.faces) <= 500 < len(body.mesh.faces)


def test_a_cup_is_drawn_from_the_palm_to_the_tool_point():
    pad = np.array([0.015, 0.015, 0.03])
    cell = replace(CELL, hand=replace(CELL.hand, kind="suction", pad=pad, stroke=0.0, finger_length=0.04))
    scene = Scene.from_json(scene_of(cell).as_json())
    assert not [body.name for body in scene.bodies if body.name.startswith("finger")]
    (cup,) = (shape for shape in scene.shapes if shape.name == "cup")
    ends = cup.X_body_shape[2, 3] + np.array([-0.5, 0.5]) * cup.size[2]
    assert (cup.body, *ends, cup.size[1]) == ("tool", pytest.approx(-0.02), pytest.approx(0.0), 0.015)


def test_whatever_a_cell_holds_its_scene_can_be_read_again():
    robot = replace(CELL.robot, name="n" * 5000)
    obstacles = tuple(replace(CELL.obstacles[0], name=f"o{k}") for k in range(1500))
    points = {"P" * 5000: np.eye(4)} | {f"P{k}": np.eye(4) for k in range(12_000)}
    value = scene_of(replace(CELL, robot=robot, obstacles=obstacles), points).as_json()
    assert Scene.from_json(value).as_json() == value


@pytest.mark.parametrize("name", library())
def test_the_scene_of_a_machine_moves_its_tool_as_the_machine_does(name):
    machine = replace(load_builtin(name), fixed=(("z", 0.25),) if name == "xy" else ())
    scene = Scene.from_json(machine_scene(machine).as_json())
    rng = np.random.default_rng(3)
    for _ in range(10):
        q = np.array([rng.uniform(joint.lower, joint.upper) for joint in machine.joints])
        tool = world_poses(scene, Stance(axes=q))["tool"]
        np.testing.assert_allclose(tool[:3, 3], machine.points(q[None])[0], atol=1e-8)
    kinds = [body.joint.kind for body in scene.bodies if body.joint]
    assert sorted(kinds) == sorted("revolute" if joint.rotary else "prismatic" for joint in machine.joints)


def test_a_scara_with_a_short_z_has_a_quill():
    scara = load_builtin("scara")
    joints = tuple(replace(joint, upper=0.2) if joint.name == "z" else joint for joint in scara.joints)
    scene = machine_scene(replace(scara, joints=joints))
    parents = {body.name: body.parent for body in scene.bodies}
    assert (parents["z"], parents["theta1"]) == ("theta2", "base")
    assert {body.name: body.parent for body in machine_scene(scara).bodies}["theta1"] == "z"
    q = np.array([0.4, -0.7, 0.1, 0.3])
    tool = world_poses(scene, Stance(axes=q))["tool"]
    np.testing.assert_allclose(tool[:3, 3], scara.points(q[None])[0], atol=1e-12)
