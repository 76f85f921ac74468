"""One set of shapes: where check --motion finds the arm in itself a run is stopped there, and nowhere else."""

import json
import re

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
    margins = [built.model.pair_margin[index] for index in range(len(pairs))]
    assert margins.count(0.0) == len(built.own_pairs)
