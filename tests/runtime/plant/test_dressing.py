"""Shapes for pictures on the model of physics: nothing that moves is changed."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from runtime.appearance.cell_scene import scene_of
from runtime.plant.dressing import GROUP, dressed
from runtime.plant.mjcf import build_mjcf
from tests.runtime.from_texts import load_cell

STEPS = 3000

pytestmark = pytest.mark.physics


@pytest.mark.parametrize("name", ["pick_and_place", "manutec_pick_and_place"])
def test_physics_with_a_scene_is_physics_without_one_to_the_last_bit(name):
    cell = load_cell(Path(f"programs/{name}.cell.toml"))
    text = build_mjcf(cell.robot, cell)
    plain: Any = mujoco.MjModel.from_xml_string(text)
    shown: Any = mujoco.MjModel.from_xml_string(dressed(text, scene_of(cell)))
    assert shown.ngeom > plain.ngeom + 20
    for field in ("body_mass", "body_inertia", "body_ipos", "body_iquat", "dof_armature", "qpos0"):
        assert getattr(shown, field).tobytes() == getattr(plain, field).tobytes(), field
    states, touched = [], 0
    for model in (plain, shown):
        data: Any = mujoco.MjData(model)
        data.qpos[: cell.robot.n] = cell.home
        for _ in range(STEPS):
            mujoco.mj_step(model, data)
            touched += data.ncon
        states.append((data.qpos.tobytes(), data.qvel.tobytes(), touched))
    # the part on its table, and the arm that nothing holds: both touch
    assert states[0][2] > STEPS
    assert states[1] == (*states[0][:2], 2 * states[0][2])


def test_shapes_of_a_scene_move_with_the_bodies_of_physics():
    cell = load_cell(Path("programs/pick_and_place.cell.toml"))
    scene = scene_of(cell)
    model: Any = mujoco.MjModel.from_xml_string(dressed(build_mjcf(cell.robot, cell), scene))
    owners = {str(model.geom(k).name): str(model.body(model.geom_bodyid[k]).name) for k in range(model.ngeom)}
    of = {"base": "world", "flange": "hand", "tool": "hand", "obstacle:table": "world"}
    for index, shape in enumerate(scene.shapes):
        assert owners[f"shape{index}"] in (of.get(shape.body, shape.body), f"link{cell.robot.n}")
    seen = model.geom_group == GROUP
    assert (model.geom_contype[seen] == 0).all()
    assert (model.geom_conaffinity[seen] == 0).all()
    assert set(np.unique(model.geom_group).tolist()) == {0, GROUP, 3}
