"""``robolang robot import`` and the way of a model file through the commands."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.project.project import builtin_cell, load_any_robot, load_project
from runtime.cell.seam_sensor import SensorSpec
from runtime.cell.sensor_file import read_sensor_file
from runtime.core.frames import frozen
from runtime.core.tomlfile import FileFault, Source, load_table
from tests.messages import fields, numbers
from tests.robolang.cli.commands import flat, places, robolang
from tests.runtime.robot.models import ANGLES, SEVEN, SIX, fill

HOME = np.array([0.0, 0.5, 0.0, -1.4, 0.0, 0.9, 0.0])


@pytest.fixture
def seven(tmp_path):
    path = tmp_path / "seven.urdf"
    path.write_text(SEVEN.read_text())
    return path


def test_import_writes_what_is_known_and_marks_the_rest(seven):
    said = robolang("robot", "import", seven).stdout
    sidecar = seven.with_name("seven.robot.toml")
    assert 85 in numbers(flat(said))
    text = sidecar.read_text()
    assert text.count("MISSING:") == 85
    assert "max_torque_nm = 320.0" in text
    with pytest.raises(FileFault, match="RBL608"):
        load_any_robot(str(seven))
    sidecar.write_text(fill(text))
    assert load_any_robot(str(seven)).n == 7
    assert "joint_7" in robolang("robot", "show", seven).stdout


def test_import_writes_over_a_file_only_when_told(seven):
    sidecar = seven.with_name("seven.robot.toml")
    sidecar.write_text("mine")
    error = robolang("robot", "import", seven, code=4).stderr
    assert "RBL706" in error
    assert "--force" in error
    assert sidecar.read_text() == "mine"
    robolang("robot", "import", seven, "--force")
    assert "joint_7" in sidecar.read_text()
    other = seven.with_name("other.toml")
    robolang("robot", "import", seven, "-o", other)
    assert other.read_text() == sidecar.read_text()
    assert sorted(path.name for path in seven.parent.iterdir()) == ["other.toml", "seven.robot.toml", "seven.urdf"]


def test_import_takes_the_flange_that_is_named(tmp_path):
    path = tmp_path / "angles.xml"
    path.write_text(ANGLES.read_text())
    robolang("robot", "import", path, "--flange", "tip")
    assert 'flange = "tip"' in path.with_name("angles.robot.toml").read_text()
    assert "RBL610" in robolang("robot", "import", path, "--flange", "top", "--force", code=2).stderr


def test_a_model_that_cannot_be_read_is_reported_with_its_place(tmp_path):
    path = tmp_path / "bad.xml"
    path.write_text("<mujoco>\n <!DOCTYPE x>\n</mujoco>")
    for words in (("import", path), ("show", path)):
        assert "bad.xml:2:" in robolang("robot", *words, code=2).stderr
    assert "RBL600" in robolang("robot", "import", tmp_path / "none.urdf", code=2).stderr
    assert list(tmp_path.iterdir()) == [path]


def test_show_says_what_a_model_has_and_that_it_has_no_drives(seven):
    text = robolang("robot", "show", seven).stdout
    assert max(map(len, text.splitlines())) <= 80
    words = flat(text)
    assert {"robolang robot import", "seven.robot.toml"} <= fields(words)
    assert "Drives: none" in words
    assert "Newton" in words
    assert "J4 joint_4 -120 .. 120 129.998 176" in words


def test_a_model_with_impossible_bodies_is_shown_and_called_an_error(seven):
    lines = SEVEN.read_text().splitlines()
    at = [n for n, line in enumerate(lines) if "<inertia " in line][1:3]
    for n in at:
        lines[n] = re.sub(r'ixx="[^"]*"', 'ixx="9"', lines[n])
    seven.write_text("\n".join(lines))
    found = robolang("robot", "show", seven, code=2)
    assert [code for _, _, code in places(found.stderr)] == ["RBL606", "RBL606"]
    assert found.stderr.count("  help: ") == 2
    assert {"RBL606", "J4", "joint_4"} <= fields(flat(found.stdout))  # the tables are printed all the same


CELL = """\
schema = 1
robot = "six.urdf"
[home]
joints_deg = [0, 20, 30, 0, -60, 0]
[hand]
mass_kg = 0.2
cog_mm = [0, 0, 60]
tcp_mm_deg = [0, 0, 113.7, 0, 0, 0]
stroke_mm = 80
grip_force_n = 120
dwell_s = 0.3
pad_mm = [20, 8, 40]
finger_length_mm = 52
"""


def test_an_arm_without_drives_moves_as_an_ideal_one_and_physics_are_refused(tmp_path):
    arm = tmp_path / "six.urdf"
    arm.write_text(SIX)
    program = tmp_path / "a.rbl"
    program.write_text("MOVEJ JOINT(10, 0, 0, 0, -90, 0)\n")
    error = robolang("run", "--robot", arm, program, code=2).stderr
    assert "six.urdf:3:1: error RBL608" in error
    # a command that works from where one is, wherever the file lies
    assert {f"robolang robot import {arm} --estimate", "six.robot.toml", "--no-physics"} <= fields(error)
    robolang("run", "--robot", arm, "--no-physics", program)
    program.with_suffix(".cell.toml").write_text(CELL)
    robolang("check", "--motion", program)
    assert robolang("run", program, code=2).stderr == error
    with pytest.raises(FileFault, match="RBL608"):
        load_any_robot(str(arm))
    lines = robolang("robot", "import", arm, "--estimate").stdout.splitlines()
    assert " 92 " in lines[0]  # as many as a run counts
    assert len(lines) == 5  # what was written, a heading, and the three that matter most
    assert all(re.search(r"^  [a-z_.]+ (halved|doubled): .* becomes ", line) for line in lines[2:])
    said = robolang("run", program, "--report", tmp_path / "r.json").stdout
    names = json.loads((tmp_path / "r.json").read_text())["robot_estimated"]
    assert len(names) == 92
    assert "axes.1.motor.gear_ratio" in names
    assert "axes.1.max_speed_deg_s" not in names
    assert "axes.1.max_jerk_deg_s3" in names
    assert "estimated (92 values)" in flat(said)
    plan = robolang("check", "--motion", program).stdout
    assert "estimated (92 values)" in plan
    arm.write_text(SIX.replace(' velocity="3.0"', "").replace(' velocity="3"', ""))
    robolang("robot", "import", arm, "--estimate", "--force")
    assert re.search(r" J\d +~\d+ ", robolang("check", "--motion", program).stdout)
    assert "axes.1.max_speed_deg_s" in json.loads(robolang("robot", "show", arm, "--json").stdout)["estimated"]


SENSOR = 'kind = "ramp"\ndeviation_mm_deg = [3, 0, 2, 0, 0, 0]\nover_mm = 200\n'


def seven_session(seven, text):
    """Return the session of a program on the arm of seven axes, in a cell with a seam sensor."""
    robolang("robot", "import", seven)
    sidecar = seven.with_name("seven.robot.toml")
    sidecar.write_text(fill(sidecar.read_text()))
    program = seven.with_name("a.rbl")
    program.write_text(text)
    seven.with_name("a.points.toml").write_text(
        "schema = 1\n[points.P1]\npose = [450, 150, 500, 180, 0, 180]\n"
        "[points.P2]\npose = [450, -150, 500, 180, 0, 180]\n"
    )
    project = load_project(program)
    robot = load_any_robot(str(seven))
    sensor = SensorSpec.of(read_sensor_file(load_table(Source("cell.toml", SENSOR)), None))
    cell = replace(builtin_cell(), robot=robot, home=frozen(HOME), sensors={"CAM": sensor})
    return Session(replace(project, cell=cell, diagnostics=()), physics=False)


def test_a_seven_axis_arm_follows_a_seam_in_its_posture(seven):
    session = seven_session(seven, "MOVE P1, SPEED 200\nSEAM ON, CAM\nMOVE P2, SPEED 150\n")
    result = session.run()
    assert result.ok, result.report
    log = result.log
    np.testing.assert_allclose(log["seam_deviation"][-1, :3], [0.003, 0.0, 0.002], atol=1e-4)
    np.testing.assert_allclose(session.controller.tool_poses(log["q_cmd"][-1])[:3, 3], [0.453, -0.15, 0.502], atol=1e-4)
    assert not log["wrist_mode"].any()


def test_a_seven_axis_arm_carries_out_moves(seven):
    result = seven_session(seven, "MOVE P1, SPEED 200\nMOVE P2, SPEED 150\n").run()
    assert result.ok, result.report
    line, X = result.log["line"], result.log["X_world_tool_fb"]
    first, second = X[line == 1], X[line == 2]
    for here, y in ((first[-1], 0.15), (second[-1], -0.15)):
        np.testing.assert_allclose(here[:3, 3], [0.45, y, 0.5], atol=1e-3)
        np.testing.assert_allclose(here[:3, 2], [0.0, 0.0, -1.0], atol=1e-3)
    assert np.abs(second[:, 0, 3] - 0.45).max() < 1e-3  # straight, all the way
    assert np.abs(second[:, 2, 3] - 0.5).max() < 1e-3
