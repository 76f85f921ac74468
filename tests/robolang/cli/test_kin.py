import json
import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

from robolang.cli.commands.kin import MOST_TURNS, app
from robolang.cli.usage import OptionValueError
from robolang.cli.values import numbers, outside
from runtime.core.frames import pose_from_xyzrpy, xyzrpy_from_pose
from runtime.core.units import DEG, MM
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.axis_kind import REVOLUTE
from tests.messages import fields
from tests.messages import numbers as numbers_of
from tests.robolang.cli.commands import flat, robolang
from tests.runtime.robot.models import SEVEN

LIBRARY = Path(__file__).parents[3] / "runtime" / "robot" / "library"
JOINTS = "10,60,150,-20,40,30"


def run(*words, exit_code=0):
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == exit_code, result.output + result.stderr
    return result


def fk(joints=JOINTS, *words):
    return json.loads(run("fk", "--robot", "puma560", "--joints", joints, "--json", *words).stdout)["pose_mm_deg"]


def ik(values, *words):
    pose = ",".join(map(repr, values))
    return json.loads(run("ik", "--robot", "puma560", "--pose", pose, "--json", *words).stdout)["solutions"]


def test_fk_prints_the_pose_in_full_precision():
    X = Kinematics(load_builtin("puma560")).forward(np.array([float(v) for v in JOINTS.split(",")]) * DEG)
    expected = xyzrpy_from_pose(X) / [MM, MM, MM, DEG, DEG, DEG]
    assert fk() == pytest.approx(list(expected), abs=1e-12)


def test_fk_of_qn_is_the_published_pose():
    assert fk("0,45,180,0,45,0")[:3] == pytest.approx([596.3, -150.05, 657.65], abs=0.05)


def test_fk_of_joints_outside_their_ranges_is_a_warning_at_each_of_them():
    # the ranges of J2 and J3 are -45 to 225 and -225 to 45 deg
    result = run("fk", "--robot", "puma560", "--joints", "0,-45.001,180,0,45,0", "--json")
    warnings = re.findall(r"^warning RBL309 --joints, number (\d): (.*)\n  help: .", result.stderr, re.M)
    assert [(int(position), numbers_of(said)[1:]) for position, said in warnings] == [
        (2, [-45.001, -45.0, 225.0]),
        (3, [180.0, -225.0, 45.0]),
    ]
    assert len(json.loads(result.stdout)["pose_mm_deg"]) == 6
    assert run("fk", "--robot", "puma560", "--joints", "0,-45,45,0,45,0").stderr == ""


def test_angles_outside_are_found_in_every_comparison_and_rounding_is_none():
    low, high = np.array([-1.0, -1.0, -1.0, np.nan]), np.array([1.0, 1.0, 1.0, 1.0])
    arm = SimpleNamespace(lower=low, upper=high, axes=[SimpleNamespace(kind=REVOLUTE)] * 4)
    found = outside(np.array([1.0 + 1e-12, np.nan, -1.1, 0.0]), arm)
    assert [joint for joint, _ in found] == [1, 2, 3]


def test_fk_has_no_negative_zeros():
    result = run("fk", "--robot", "puma560", "--joints", "0,0,0,0,0,0", "--json")
    assert "-0.0" not in result.stdout
    assert json.loads(result.stdout)["pose_mm_deg"] == pytest.approx([452.1, -150.05, 1103.8, 0, 0, 0], abs=1e-9)


@pytest.mark.parametrize("words", [("--joints", "-10,20,30,0,40,50"), ("--joints=-10,20,30,0,40,50",)])
def test_a_negative_first_number_is_a_value(words):
    result = run("fk", "--robot", "puma560", "--json", *words)
    assert json.loads(result.stdout)["pose_mm_deg"] == fk("-10, 20, 30, 0, 40, 50")


def test_a_tool_is_beyond_the_flange_in_fk_and_ik():
    bare, tool = fk(), "10,-20,150,0,90,0"
    with_tool = fk(JOINTS, "--tool", tool)
    X_flange_tool = pose_from_xyzrpy([0.01, -0.02, 0.15, 0.0, np.pi / 2, 0.0])
    X_base_tool = pose_from_xyzrpy(np.array(bare) * [MM, MM, MM, DEG, DEG, DEG]) @ X_flange_tool
    assert np.array(with_tool[:3]) * MM == pytest.approx(X_base_tool[:3, 3], abs=1e-12)
    assert np.linalg.norm(np.subtract(with_tool[:3], bare[:3])) == pytest.approx(np.linalg.norm([10, 20, 150]))
    for a, b in zip(ik(with_tool, "--tool", tool), ik(bare), strict=True):
        assert a["joints_deg"] == pytest.approx(b["joints_deg"], abs=1e-9)


def test_ik_lists_every_branch_by_margin_and_each_leads_back():
    target = fk()
    solutions = ik(target)
    assert len(solutions) == len({s["branch"] for s in solutions}) == 8
    margins = [s["limit_margin_deg"] for s in solutions]
    assert margins == sorted(margins, reverse=True)
    assert margins[0] > 0.0 > margins[-1]
    for solution in solutions:
        assert fk(",".join(map(repr, solution["joints_deg"]))) == pytest.approx(target, abs=1e-9)
    # J3 at 150 deg is outside -225..45, but -210 is the same posture and 15 deg inside
    own = next(s for s in solutions if s["branch"] == "RIGHTY ABOVE NOFLIP")
    assert own["joints_deg"] == pytest.approx([10, 60, -210, -20, 40, 30], abs=1e-9)
    assert own["limit_margin_deg"] == pytest.approx(15.0, abs=1e-9)


def test_out_of_reach_is_exit_code_1_with_an_empty_list():
    result = run("ik", "--robot", "puma560", "--pose", "2000,0,500,0,0,0", "--json", exit_code=1)
    assert json.loads(result.stdout) == {"solutions": [], "complete": True, "not_listed": 0}
    assert "RBL410 out-of-reach" in result.stderr
    result = run("ik", "--robot", "puma560", "--pose", "2000,0,500,0,0,0", exit_code=1)
    assert result.stdout == ""
    assert "RBL410" in result.stderr


def test_a_pose_that_is_reached_outside_the_ranges_alone_is_out_of_reach():
    words = ("ik", "--robot", "puma560", "--pose", "590,-163,569,-170,91,14")
    result = run(*words, exit_code=1)
    assert "-16.86" in result.stdout  # the nearest one, and what it lacks
    assert "RBL411" in result.stderr
    solutions = json.loads(run(*words, "--json", exit_code=1).stdout)["solutions"]
    assert max(each["limit_margin_deg"] for each in solutions) < 0.0


def test_the_tables_fit_80_columns_uncut_and_name_their_units():
    table = run("ik", "--robot", "puma560", "--pose", "-300,200,900,10,170,20").stdout
    assert all(word in table for word in ("LEFTY ABOVE NOFLIP", "-212.26", "J6", "deg", "margin", "-61.92"))
    assert "…" not in table
    assert max(map(len, table.splitlines())) <= 80
    table = run("fk", "--robot", "puma560", "--joints", "0,45,180,0,45,0").stdout
    assert all(word in table for word in ("596.303", "-150.050", "mm", "deg"))


def test_every_turn_of_a_pose_is_listed_and_more_are_counted(tmp_path):
    wide = re.sub(r"range_deg = .*", "range_deg = [-1080, 1080]", (LIBRARY / "puma560.toml").read_text())
    (tmp_path / "wide.toml").write_text(wide)
    pose = ",".join(map(repr, fk()))
    result = run("ik", "--robot", tmp_path / "wide.toml", "--pose", pose, "--json")
    found = json.loads(result.stdout)
    turns = [joints for solution in found["solutions"] for joints in solution["turns_deg"]]
    assert len(turns) == MOST_TURNS + len(found["solutions"])
    assert len(turns) + found["not_listed"] == 8 * 6**6  # of each joint six turns, but where one is at a multiple
    assert len({tuple(np.round(joints, 6)) for joints in turns}) == len(turns)
    assert np.abs(turns).max() <= 1080.0
    assert "RBL627" in result.stderr


def test_a_numeric_search_says_that_solutions_may_be_missing():
    target = json.loads(run("fk", "--robot", SEVEN, "--joints", "0,30,0,60,0,40,0", "--json").stdout)["pose_mm_deg"]
    pose = ",".join(map(repr, target))
    assert json.loads(run("ik", "--robot", SEVEN, "--pose", pose, "--json").stdout)["complete"] is False
    assert "missing" in run("ik", "--robot", SEVEN, "--pose", pose).stdout
    assert "numeric" in run("ik", "--robot", SEVEN, "--pose", "3000,0,0,0,0,0", exit_code=1).stderr
    assert "missing" not in run("ik", "--robot", "puma560", "--pose", ",".join(map(repr, fk()))).stdout


def test_a_robot_file_is_a_robot(tmp_path):
    path = LIBRARY / "puma560.toml"
    assert json.loads(run("fk", "--robot", path, "--joints", JOINTS, "--json").stdout)["pose_mm_deg"] == fk()
    broken = tmp_path / "broken.toml"
    broken.write_text(path.read_text().replace("b_m = -0.15005", "b_m = 0.15005"))
    assert "RBL615" in run("fk", "--robot", broken, "--joints", JOINTS, exit_code=2).stderr
    assert "RBL600" in run("ik", "--robot", tmp_path / "none.toml", "--pose", JOINTS, exit_code=2).stderr


def test_a_robot_file_without_a_closed_form_gets_the_one_that_its_axes_have(tmp_path):
    text = (LIBRARY / "puma560.toml").read_text()
    start, end = text.index("[kinematics.opw]"), text.index("[path]")
    (tmp_path / "open.toml").write_text(text[:start] + text[end:])
    pose = ",".join(map(repr, fk()))
    found = json.loads(run("ik", "--robot", tmp_path / "open.toml", "--pose", pose, "--json").stdout)["solutions"]
    assert {s["branch"] for s in found} == {s["branch"] for s in ik(fk())}


def test_a_model_file_needs_no_drives():
    given = run("fk", "--robot", SEVEN, "--joints", "0,30,0,60,0,40,0", "--json").stdout
    pose = json.loads(given)["pose_mm_deg"]
    found = json.loads(run("ik", "--robot", SEVEN, "--pose", ",".join(map(str, pose)), "--json").stdout)["solutions"]
    assert found
    for solution in found:
        assert solution["branch"] == "NUMERIC"
        joints = ",".join(map(str, solution["joints_deg"]))
        again = json.loads(run("fk", "--robot", SEVEN, "--joints", joints, "--json").stdout)["pose_mm_deg"]
        assert again == pytest.approx(pose, abs=1e-6)
    assert "RBL410" in run("ik", "--robot", SEVEN, "--pose", "3000,0,0,0,0,0", exit_code=1).stderr
    assert "RBL600" in run("fk", "--robot", "none.urdf", "--joints", "0", exit_code=2).stderr


def test_an_unknown_robot_is_answered_with_the_known_ones():
    message = run("fk", "--robot", "puma", "--joints", JOINTS, exit_code=2).stderr
    assert "puma" in fields(message)
    assert "puma560" in message


@pytest.mark.parametrize(
    ("text", "where"),
    [
        ("1,2,nan,4,5,6", "number 3: "),
        ("1,2,3,inf,5,6", "number 4: "),
        ("1,2,3,4,5,1e999", "number 6: "),
        ("-1e10,2,3,4,5,6", "number 1: "),
        ("1,x,3,4,5,6", "number 2: "),
        ("1,,3,4,5,6", "number 2: "),
        ("1,2,3", " 3 "),
        ("1,2,3,4,5,6,7", " 7 "),
        ("", " 1 "),
    ],
)
@pytest.mark.parametrize("option", ["--joints", "--pose", "--tool"])
def test_a_value_that_cannot_be_used_is_located(option, text, where):
    command = "ik" if option == "--pose" else "fk"
    words = ["--joints", JOINTS] if option == "--tool" else []
    message = run(command, "--robot", "puma560", *words, f"{option}={text}", exit_code=2).stderr
    assert "RBL703" in message
    assert option in message
    assert where in flat(message)


def test_numbers_carry_their_code_and_place():
    assert numbers("1, -2.5e1", option="--x", names=("a", "b")) == (1.0, -25.0)
    with pytest.raises(OptionValueError) as caught:
        numbers("1," + "9" * 400, option="--x", names=("a", "b"))
    assert (caught.value.code, caught.value.option, caught.value.position) == ("RBL703", "--x", 2)
    assert len(str(caught.value)) < 100
    for text in ("nan", "-inf"):
        with pytest.raises(OptionValueError, match="finite"):
            numbers(text, option="--x", names=("a",))


def test_importing_the_commands_loads_no_numerics():
    heavy = ("numpy", "pinocchio", "mujoco", "ruckig")
    code = f"import sys, robolang.cli.commands.kin; print([m for m in {heavy} if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "[]\n"


@pytest.mark.parametrize("joints", ["0 45 -180 0 45 0", "0 -.5 0 0 0 0"])
def test_numbers_with_spaces_between_them_are_answered_with_a_code(joints):
    assert "RBL703 -" in robolang("kin", "fk", "--joints", *joints.split(), code=2).stderr
    assert "RBL703" not in robolang("kin", "fk", "-x", code=2).stderr
