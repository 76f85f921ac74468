"""One set of shapes: where check --motion finds the arm in itself a run is stopped there, and nowhere else."""

import json
import re
from dataclasses import replace
from typing import Any

import mujoco
import pytest

from robolang.execution.session import Session
from robolang.project.project import builtin_cell, load_project
from runtime.plant.cell_model import CellModel
from runtime.plant.mjcf import own_pairs
from tests.robolang.cli.commands import BUILTIN, PUMA, robolang

pytestmark = pytest.mark.physics

FOLDED = "10 MOVEJ JOINT(-60, 210, 25, -70, 65, -75), SPEED 30\n"
SHAPED = PUMA.read_text()
BARE = re.sub(r'^link_radius_mm.*\n|"axes\.\*\.link_radius_mm", ', "", SHAPED, flags=re.M)


def program(folder, robot):
    (folder / "arm.toml").write_text(robot)
    (folder / "p.cell.toml").write_text(
        re.sub("^robot = .*", 'robot = "arm.toml"', (BUILTIN / "cell.toml").read_text(), flags=re.M)
    )
    (folder / "p.rbl").write_text(FOLDED)
    return folder / "p.rbl"


@pytest.mark.parametrize(("robot", "code"), [(SHAPED, 1), (BARE, 0)])
def test_check_and_run_judge_an_arm_against_itself_by_the_same_shapes(tmp_path, robot, code):
    shapes = robot is SHAPED
    path = program(tmp_path, robot)
    said = robolang("check", "--motion", path, "--times", tmp_path / "times.json", code=code).stdout
    assert ("RBL424" in said) is shapes
    assert ("not checked: " in said) is not shapes
    (times,) = json.loads((tmp_path / "times.json").read_text())
    assert times["self_collision_checked"] is shapes
    result = Session(load_project(path)).run()
    assert result.ok is not shapes
    touched = [warning for warning in result.report["warnings"] if warning["code"] == "RBL537"]
    assert bool(touched) is shapes


def test_pairs_that_say_nothing_never_meet():
    """The palm of the built-in hand is in link 6, which is its own; links nearer than three joints have no pair."""
    cell = builtin_cell()
    pairs = own_pairs(cell.robot, cell.hand)
    assert ("link1", "link4") in pairs
    assert ("link1", "link3") not in pairs
    assert ("link3", "palm") in pairs
    built = CellModel.of(cell.robot, cell)
    assert 0 < len(built.own_pairs) <= len(pairs)
    names = {built.model.pair(index).name for index in range(built.model.npair)}
    assert len(names - {""}) == len(built.own_pairs)


def test_capsules_that_overlap_at_home_never_meet():
    """So thick that each link is in every other one, as links 3 and 6 are where the wrist axes meet in one point."""
    cell = builtin_cell()
    built = CellModel.of(replace(cell.robot, link_radii=(0.3,) * 6), cell)
    data: Any = mujoco.MjData(built.model)
    data.qpos[built.motors] = cell.home
    mujoco.mj_kinematics(built.model, data)
    mujoco.mj_collision(built.model, data)
    met = [{built.shapes[a], built.shapes[b]} for a, b in data.contact.geom.tolist()]
    capsules = {f"link{number}" for number in range(1, 7)}
    assert not [pair for pair in met if pair <= capsules]
