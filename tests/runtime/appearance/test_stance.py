"""Where the bodies of a scene are."""

from pathlib import Path

import numpy as np
import pytest

from runtime.appearance.cell_scene import scene_of
from runtime.appearance.stance import Stance, world_poses
from runtime.core.frames import rotation_about
from runtime.robot.kinematics.kinematics import Kinematics
from tests.runtime.from_texts import load_cell


@pytest.mark.parametrize("name", ["pick_and_place", "manutec_pick_and_place"])
def test_the_tool_of_a_scene_is_where_kinematics_has_it(name):
    cell = load_cell(Path(f"programs/{name}.cell.toml"))
    scene, kinematics = scene_of(cell), Kinematics(cell.robot)
    for q in (cell.home, np.linspace(-1.0, 1.0, cell.robot.n)):
        expected = kinematics.forward(q) @ cell.hand.X_flange_tool
        np.testing.assert_allclose(world_poses(scene, Stance(axes=q))["tool"], expected, atol=1e-12)


def test_fingers_open_and_parts_are_where_their_poses_are():
    cell = load_cell(Path("programs/pick_and_place.cell.toml"))
    turn = rotation_about([0.0, 0.0, 1.0], 0.5)
    quaternion = [np.cos(0.25), 0.0, 0.0, np.sin(0.25)]
    stance = Stance(axes=cell.home, fingers=(0.01, 0.02), parts=[[1.0, 2.0, 3.0, *quaternion]])
    poses = world_poses(scene_of(cell), stance)
    apart = np.linalg.inv(poses["finger_right"]) @ poses["finger_left"]
    np.testing.assert_allclose(apart[:3, 3], [0.0, 0.03, 0.0], atol=1e-12)
    np.testing.assert_allclose(poses["part:part"][:3, :3], turn, atol=1e-12)
    np.testing.assert_allclose(poses["part:part"][:3, 3], [1.0, 2.0, 3.0])


def test_without_values_all_is_where_the_scene_has_it():
    cell = load_cell(Path("programs/pick_and_place.cell.toml"))
    poses = world_poses(scene_of(cell), Stance())
    np.testing.assert_array_equal(poses["part:part"], cell.parts[0].X_world_part)
    np.testing.assert_allclose(poses["link2"][:3, 3], [0.0, 0.0, 0.672], atol=1e-12)
