"""Meshes as parts: MuJoCo has their hull and their mass properties; they rest, are held and are sealed on."""

from dataclasses import replace
from itertools import count

import mujoco
import numpy as np
import pytest

from runtime.cell.body_mesh import read_body_mesh
from runtime.cell.sealing import seals
from runtime.core.frames import inverse, pose_from_xyzrpy
from runtime.core.mesh import Mesh
from runtime.core.units import DEG
from runtime.plant.inertia import part_inertia
from runtime.plant.mjcf import build_mjcf
from runtime.plant.rigid_plant import RigidPlant
from runtime.robot.model.arm_model import ArmModel
from tests.runtime.meshes import angle_bracket, binary_stl, box_mesh, extruded, frame, prism
from tests.runtime.plant.test_plant_grasp import CELL, Rig, slip
from tests.runtime.plant.test_suction import cell as cup_cell
from tests.runtime.plant.test_suction import over

pytestmark = pytest.mark.physics

NUMBERS = count()


def part_of(folder, mesh, **changes):
    """The part of the cell as a mesh, in mm, that rests on the table."""
    path = folder / f"m{next(NUMBERS)}.stl"
    path.write_bytes(binary_stl(mesh))
    body = read_body_mesh(path, path.name, 1.0)
    X = np.array(CELL.parts[0].X_world_part)
    X[2, 3] = 0.6 + body.size[2] / 2.0
    return replace(CELL.parts[0], shape="mesh", mesh=body, size=body.size, X_world_part=X, **changes)


def model(part):
    return mujoco.MjModel.from_xml_string(build_mjcf(CELL.robot, replace(CELL, parts=(part,))))


@pytest.mark.parametrize("mesh", [angle_bracket(60.0, 8.0, 40.0), frame(60.0, 30.0, 20.0), prism(6, 20.0, 80.0)])
def test_mass_properties_are_those_that_mujoco_has_of_the_mesh_itself(tmp_path, mesh):
    part = part_of(tmp_path, mesh, mass=1.5)
    own = part.mesh.mesh
    vertex, face = (" ".join(map(repr, each.ravel().tolist())) for each in (own.vertices, own.faces))
    exact = mujoco.MjModel.from_xml_string(
        f'<mujoco><asset><mesh name="m" inertia="exact" vertex="{vertex}" face="{face}"/></asset><worldbody><body>'
        '<geom type="mesh" mesh="m" mass="1.5"/></body></worldbody></mujoco>'
    )
    ours = model(part)
    assert ours.body_ipos[-1] == pytest.approx(exact.body_ipos[1], abs=1e-8)
    assert sorted(ours.body_inertia[-1]) == pytest.approx(sorted(exact.body_inertia[1]), rel=1e-5)
    assert sorted(np.linalg.eigvalsh(part_inertia(part))) == pytest.approx(sorted(exact.body_inertia[1]), rel=1e-5)


def test_contacts_are_those_of_the_hull_at_its_place(tmp_path):
    """MuJoCo turns a mesh into its principal axes: the geom has to be where the part is all the same."""
    part = part_of(tmp_path, angle_bracket(60.0, 8.0, 40.0))
    ours = model(part)
    data = mujoco.MjData(ours)
    mujoco.mj_kinematics(ours, data)
    geom = ours.geom("part:part").id
    first, number = ours.mesh_vertadr[0], ours.mesh_vertnum[0]
    corners = ours.mesh_vert[first : first + number] @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
    expected = part.mesh.hull.vertices + part.X_world_part[:3, 3]
    assert number == len(expected) == 10
    assert np.abs(corners[:, None] - expected).max(axis=2).min(axis=1).max() < 1e-6


@pytest.mark.parametrize(
    ("mesh", "width"), [(prism(6, 20.0, 80.0), 0.04 * np.cos(np.pi / 6)), (box_mesh((60.0, 40.0, 80.0)), 0.04)]
)
def test_it_rests_is_centred_and_stays_in_the_hand(tmp_path, mesh, width):
    part = part_of(tmp_path, mesh)
    part.X_world_part[1, 3] += 0.01
    X = np.array(part.X_world_part)
    rig = Rig(replace(CELL, parts=(part,)))
    rig.hold(0.3)
    moved, turned = slip(X, rig.plant.parts()["part"])
    assert (moved < 1e-5, turned < 1e-4) == (True, True), (moved, turned)
    rig.pick()
    assert (rig.plant.hand().holding, rig.plant.hand().opening) == ("part", pytest.approx(width, abs=1e-4))
    held = rig.part_in_tool()
    assert held[1, 3] == pytest.approx(0.0, abs=1e-5)
    rig.carries(True)
    rig.go(480.0, -220.0, 850.0)
    moved, turned = slip(held, rig.part_in_tool())
    assert (moved < 1e-4, turned < 0.05 * DEG) == (True, True), (moved, turned)


FRAME, PLATE, HEX = frame(60.0, 20.0, 40.0), box_mesh((60.0, 40.0, 40.0)), prism(6, 20.0, 40.0)
STEP = angle_bracket(60.0, 30.0, 40.0)


@pytest.mark.parametrize(
    ("mesh", "X_part_tool", "expected"),
    [
        (PLATE, over(0, 0, 0), True),
        (PLATE, over(14.9, 4.9, 0.9, 0, 0, 30), True),
        (PLATE, over(15.1, 0, 0), False),
        (PLATE, over(0, 5.1, 0), False),
        (PLATE, over(0, 0, 1.1), False),
        (PLATE, over(0, 0, -1.9), True),
        (PLATE, over(0, 0, -2.1), False),
        (PLATE, over(0, 0, 0, 4.5, 0, 0), False),
        (PLATE, over(0, 0, np.nan), False),
        (PLATE, over(0, np.nan, 0), False),
        (PLATE, pose_from_xyzrpy([0.0, 0.02, 0.0, 90 * DEG, 0.0, 0.0]), True),
        (PLATE, pose_from_xyzrpy([0.0, -0.02, 0.0, 90 * DEG, 0.0, 0.0]), False),
        (HEX, over(0, 0, 0), True),
        (HEX, over(2.0, 0, 0), True),
        (HEX, over(0, 2.5, 0), False),  # 17.3 mm from the middle to a side
        (FRAME, over(0, 0, 0), False),  # over the hole
        (FRAME, over(20, 0, 0), False),  # 20 mm are left of the plate, the rim needs 30
        (frame(100.0, 20.0, 40.0), over(30, 0, 0), True),
        (frame(100.0, 20.0, 40.0), over(24, 0, 0), False),
        (frame(100.0, 50.0, 40.0), over(0, 0, 0), False),
        (STEP, over(-15, -15, 0), True),
        (STEP, over(15, -15, 0), True),
        (STEP, over(15, 15, 0), False),  # in the corner that goes in, where the hull has a face
    ],
)
def test_a_cup_seals_on_flat_faces_of_the_mesh_itself(tmp_path, mesh, X_part_tool, expected):
    part = part_of(tmp_path, mesh)
    assert seals(cup_cell().hand, X_part_tool, part, np.eye(4)) is expected


def test_a_round_side_is_no_flat_face(tmp_path):
    part = part_of(tmp_path, prism(180, 20.0, 40.0))
    hand = cup_cell().hand
    assert seals(hand, over(0, 0, 0), part, np.eye(4))
    assert not seals(hand, pose_from_xyzrpy([0.0, 0.02, 0.0, 90 * DEG, 0.0, 0.0]), part, np.eye(4))
    # a face of triangles that are flat to a hundredth of a millimetre
    noisy = box_mesh((60.0, 40.0, 40.0))
    corners = noisy.vertices + np.random.default_rng(3).uniform(-0.01, 0.01, (8, 3))
    assert seals(hand, over(0, 0, 0), part_of(tmp_path, Mesh(vertices=corners, faces=noisy.faces)), np.eye(4))


@pytest.mark.parametrize(("step", "expected"), [(0.05, True), (0.15, False)])
def test_a_step_under_the_rim_is_bridged_or_not(tmp_path, step, expected):
    """Its top is ``step`` mm lower for y under 0."""
    corners = [(-30, 0), (30, 0), (30, 40), (0, 40), (0, 40 - step), (-30, 40 - step)]
    solid = extruded(corners, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 5)], 40.0)
    mesh = Mesh(vertices=solid.vertices[:, [2, 0, 1]], faces=solid.faces)  # the profile from x y to y z
    assert seals(cup_cell().hand, over(0, 0, 0), part_of(tmp_path, mesh), np.eye(4)) is expected
    assert seals(cup_cell().hand, over(0, 15, 0), part_of(tmp_path, mesh), np.eye(4))


@pytest.mark.parametrize(("slope", "expected"), [(0.05 * DEG, True), (0.75 * DEG, False)])
def test_a_ridge_under_the_rim_is_bridged_or_not(tmp_path, slope, expected):
    down = 30.0 * np.tan(slope)
    corners = [(-30, 0), (30, 0), (30, 40 - down), (0, 40), (-30, 40 - down)]
    solid = extruded(corners, [(0, 1, 3), (1, 2, 3), (0, 3, 4)], 40.0)
    mesh = Mesh(vertices=solid.vertices[:, [2, 0, 1]], faces=solid.faces)
    assert seals(cup_cell().hand, over(0, 0, 0), part_of(tmp_path, mesh), np.eye(4)) is expected


def test_a_cup_holds_a_large_l_at_its_corner(tmp_path):
    """The force is along the cup, the centre of gravity 40 mm off the middle of the box: it neither tips nor slides."""
    part = part_of(tmp_path, angle_bracket(160.0, 32.0, 40.0), mass=0.3)
    assert np.hypot(*part.cog[:2]) > 0.035
    X = np.array(part.X_world_part)
    X[:2, 3] = 0.48 + 0.064, -0.22 + 0.064
    rig = Rig(cup_cell(part, force=60.0, X_world_part=X))
    rig.go(480.0, -220.0, 640.0)
    rig.close(True)
    held = rig.part_in_tool()
    rig.go(480.0, -220.0, 700.0)
    moved, turned = slip(held, rig.part_in_tool())
    assert (rig.plant.hand().holding, moved < 1e-4, turned < 0.05 * DEG) == ("part", True, True), (moved, turned)


def test_without_physics_the_arm_carries_an_l_at_its_centre_of_gravity(tmp_path, monkeypatch):
    part, loads = part_of(tmp_path, STEP), []
    monkeypatch.setattr(ArmModel, "set_payload", lambda self, payload: loads.append(payload))
    cell = cup_cell(part)
    plant = RigidPlant(CELL.robot, cell)
    plant._parts["part"] = plant._X_world_tool() @ inverse(over(-15, -15, 0))
    plant.close_hand(True)
    assert plant.gripped() == ("part",)
    hand = cell.hand
    centre = (hand.X_flange_tool @ plant._X_tool_part @ np.append(part.cog, 1.0))[:3]
    expected = (hand.mass * hand.cog + part.mass * centre) / (hand.mass + part.mass)
    np.testing.assert_allclose(loads[-1].cog, expected, atol=1e-12)
