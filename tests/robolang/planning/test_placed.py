"""Where and when a finding in the motion is: the tool point on its path, and the time of the rehearsal."""

import numpy as np
import pytest

from robolang.execution.dry_run import rehearse
from robolang.planning.motion_findings import findings
from robolang.planning.path_coverage import explore
from robolang.planning.placed import Placed
from robolang.project.project import load_project
from tests.messages import numbers
from tests.runtime.plant.cells import job

pytestmark = pytest.mark.physics


def placed(folder, text, code):
    (folder / "p.rbl").write_text(text)
    project = load_project(folder / "p.rbl")
    assert project.ok, project.diagnostics
    rehearsal = rehearse(project)
    (item,) = (item for item in findings(project, rehearsal) if item.code == code)
    return item, rehearsal


def test_an_obstacle_is_met_at_its_share_of_the_straight_path_and_at_that_time(tmp_path):
    item, rehearsal = placed(tmp_path, "DELAY 0.4\nMOVE P2\nMOVE P1 + (0, 0, -30)\n", "RBL421")
    first, second = rehearsal.moves
    start, end = first.plan.path.X_end[:3, 3], second.plan.path.X_end[:3, 3]
    share = numbers(item.message)[0] / 100.0
    assert np.abs(start + share * (end - start) - item.p).max() <= 1e-3 * np.linalg.norm(end - start)
    row = (item.time_us - second.begins_us) / 8000
    assert row == int(row) and second.share(int(row)) == pytest.approx(100.0 * share, abs=0.05)


def test_a_tool_of_the_program_counts(tmp_path):
    item, rehearsal = placed(tmp_path, "MOVE P1 + (0, 0, 100)\nTOOL POSE(0, 0, 250, 0, 0, 0)\nHAND ON\n", "RBL441")
    X_world_flange = rehearsal.kinematics.forward(rehearsal.moves[0].q[-1])
    assert item.p == pytest.approx((X_world_flange[:3, 3] + 0.25 * X_world_flange[:3, 2]).tolist(), abs=1e-9)


def test_what_is_on_another_branch_has_a_place_and_no_time(tmp_path):
    text = "IF IN(1) = 1 THEN MOVE P5 ELSE MOVE P1 + (0, 0, -30)\n"
    project = job(tmp_path, text, obstacles="[inputs.1]\nchanges = [[0, 1]]\n")
    explored = explore(project)
    (item,) = findings(project, explored.rehearsal, None, explored.detours)
    assert isinstance(item, Placed) and item.time_us is None and len(item.p) == 3


def test_what_ends_the_planning_is_where_the_arm_then_stands(tmp_path):
    item, rehearsal = placed(tmp_path, "MOVE P1\nMOVE P1 + (9000, 0, 0)\n", "RBL410")
    (move,) = rehearsal.moves
    assert item.p == pytest.approx(move.plan.path.X_end[:3, 3].tolist(), abs=1e-6)
    assert item.time_us == move.ends_us


def test_an_empty_grip_is_where_the_hand_closes(tmp_path):
    item, rehearsal = placed(tmp_path, "MOVE P1 + (0, 0, 100)\nDELAY 0.2\nHAND ON\n", "RBL441")
    (move,) = rehearsal.moves
    assert item.p == pytest.approx(move.plan.path.X_end[:3, 3].tolist(), abs=1e-6)
    assert item.time_us == move.ends_us + 200_000


def test_a_singular_posture_is_at_its_share_of_the_path(tmp_path):
    text = "MOVEJ JOINT(0, 60, -190, 0, -6, 0)\nMOVE HERE + (0, 0, -40), WRIST KEEP\n"
    item, rehearsal = placed(tmp_path, text, "RBL427")
    path, share = rehearsal.moves[1].plan.path, numbers(item.message)[0] / 100.0
    start, end = path.X_start[:3, 3], path.X_end[:3, 3]
    assert 0.1 < share and np.abs(start + share * (end - start) - item.p).max() <= 1e-3 * np.linalg.norm(end - start)
