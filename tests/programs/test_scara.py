"""The SCARA picks a part with MuJoCo; poses that four axes cannot take are refused before anything moves."""

import json
from pathlib import Path

import numpy as np
import pytest

from robolang.execution.dry_run import rehearse
from robolang.project.project import load_project
from tests.programs.runs import run
from tests.robolang.cli.commands import robolang

FOLDER = Path(__file__).parents[2] / "programs" / "scara"
CELL = FOLDER / "pick.cell.toml"


@pytest.fixture(scope="module")
def ran():
    return run("scara/pick.rbl")


@pytest.mark.physics
def test_the_part_is_carried_and_put_down(ran):
    report = ran[1].report
    assert report["ok"]
    assert report["warnings"] == []
    assert report["objects"]["part"]["pose_mm_deg"][:3] == pytest.approx([440.0, -160.0, 105.0], abs=0.5)


@pytest.mark.physics
def test_the_error_of_the_slide_has_a_key_of_its_own(ran):
    rows = [row for row in ran[1].report["statements"] if row["joint_error_mm"] is not None]
    log = ran[1].log
    off = np.abs(log["q_cmd"] - log["q_link"])
    assert max(row["joint_error_mm"] for row in rows) == pytest.approx(1e3 * off[:, 2].max(), rel=0.3)
    assert max(row["joint_error_deg"] for row in rows) == pytest.approx(np.degrees(off[:, [0, 1, 3]].max()), rel=0.3)


def planned(tmp_path, text):
    (tmp_path / "p.rbl").write_text(text)
    (tmp_path / "p.cell.toml").write_text(CELL.read_text())
    return rehearse(load_project(tmp_path / "p.rbl"))


@pytest.mark.parametrize("word", ["MOVE", "MOVEJ"])
@pytest.mark.parametrize("turn", ["170, 0, 0", "180, 5, 0", "0, 0, 0"])
def test_a_pose_that_four_axes_cannot_take_is_refused(tmp_path, word, turn):
    refused = planned(tmp_path, f"{word} POSE(440, -160, 167, {turn})\n").refused
    assert [item.code for item in refused] == ["RBL410"]
    assert "HERE" in refused[0].hint and "4 axes" in refused[0].hint


def test_joints_and_limits_are_in_mm(tmp_path):
    q = planned(tmp_path, "MOVEJ JOINT(0, 40, 150, 10)\n").moves[-1].q[-1]
    assert q == pytest.approx([0.0, np.radians(40), 0.15, np.radians(10)])
    (code,) = {item.code for item in planned(tmp_path, "MOVEJ JOINT(0, 40, 211, 10)\n").refused}
    assert code == "RBL309"


def test_what_is_in_degrees_alone_refuses_a_slide_with_its_reason():
    error = robolang("identify", "cobra600", code=2).stderr
    assert "RBL703" in error
    assert "J3" in error


def test_no_axis_of_a_scara_that_turns_feels_weight():
    assert "RBL411" in robolang("weigh", FOLDER / "pick.rbl", code=3).stderr


@pytest.mark.physics
def test_a_comparison_has_the_errors_of_the_slide_under_keys_of_their_own():
    found = robolang("compare", FOLDER / "pick.rbl", "--only", "scheduled,load-omitted", "--json").stdout
    scheduled, omitted = json.loads(found)["variants"]
    # without LOAD the weight of the hand is not held: the quill hangs lower, the other axes feel nothing of it
    assert omitted["droop_mm"] > 5.0 * scheduled["droop_mm"]
    assert omitted["joint_error_mm"] > 5.0 * scheduled["joint_error_mm"] > 0.0
    assert omitted["joint_error_deg"] == pytest.approx(scheduled["joint_error_deg"], rel=0.2)
    # the tool hangs where the quill does
    hangs = omitted["moves"][-1]
    assert hangs["left_mm"] == pytest.approx(abs(hangs["droop"][2]), rel=0.1)
    assert omitted["joint_error_mm"] >= omitted["droop_mm"]
    axes = scheduled["per_axis"]
    assert axes["units"] == ["deg", "deg", "mm", "deg"]
    assert axes["joint_error"][2] == scheduled["joint_error_mm"]
    assert max(axes["joint_rms"][0], axes["joint_rms"][1], axes["joint_rms"][3]) == scheduled["joint_rms_deg"]
    assert not [key for key in (*axes, *scheduled["moves"][0]) if "deg" in key]
    text = robolang("compare", FOLDER / "pick.rbl", "--only", "scheduled").stdout
    assert f"{scheduled['joint_error_mm']:.4f}" in text
