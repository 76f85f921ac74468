"""Cases about robot files: what looks like another arm, what cannot be one, and every turn of a pose."""

import json
from pathlib import Path

import pytest

from tests.robolang.cli.commands import places, robolang

HERE = Path(__file__).parent
AT = "824.279,405.912,949.109,123.512,-33.314,138.411"
JOINTS = "20,30,-40,50,60,70"


def arm(case):
    return HERE / case / "a.urdf"


def ik(robot, pose):
    return json.loads(robolang("kin", "ik", "--robot", robot, "--pose", pose, "--json").stdout)


def fk(robot, joints):
    return json.loads(robolang("kin", "fk", "--robot", robot, "--joints", joints, "--json").stdout)["pose_mm_deg"]


def comma(values):
    return ",".join(map(repr, values))


@pytest.mark.parametrize("command", ["robot show {}", "robot import {} -o {}", "kin fk --robot {} --joints " + JOINTS])
def test_reports_13_limits_in_degrees_are_doubted_once(command, tmp_path):
    words = command.format(arm("reports_13_urdf_limits_in_degrees"), tmp_path / "a.robot.toml").split()
    said = robolang(*words).stderr
    assert places(said) == [(5, 132, "RBL627")]
    assert all(f"J{axis} j{axis} " in said for axis in (1, 2, 4))
    assert "-9740.28 to 9740.28 deg" in said


def test_reports_15_mass_without_inertia_is_refused():
    case = arm("reports_15_urdf_zero_inertia")
    shown = robolang("robot", "show", case, code=2)
    assert "RBL606" in shown.stdout
    assert places(shown.stderr) == [(8, 1, "RBL606")]
    assert places(robolang("kin", "fk", "--robot", case, "--joints", JOINTS, code=2).stderr) == [(8, 1, "RBL606")]


def test_reports_16_every_turn_in_the_range_is_an_answer():
    found = ik(arm("reports_16_ik_other_turns"), AT)
    turns = [[round(angle) for angle in joints] for joints in found["solutions"][0]["turns_deg"]]
    assert sorted(turns) == [[20, 30, -40, 50, 60, 70], [20, 30, -40, 50, 60, 430]]
    assert found["complete"]
    assert found["not_listed"] == 0
    table = robolang("kin", "ik", "--robot", arm("reports_16_ik_other_turns"), "--pose", AT).stdout
    assert all(f" {angle} " in table for angle in ("70.00", "430.00", "-81.62"))


@pytest.mark.parametrize(("j5", "count"), [(0.0, 7), (1e-7, 8)])
def test_reports_41_a_straight_wrist_has_one_answer_for_two(j5, count):
    target = fk("irb2400", f"10,20,-10,30,{j5!r},40")
    found = ik("irb2400", comma(target))["solutions"]
    assert len(found) == count
    for solution in found:
        for joints in solution["turns_deg"]:
            assert fk("irb2400", comma(joints)) == pytest.approx(target, abs=1e-9)
    first = found[0]["joints_deg"]
    assert first[3] + first[5] == pytest.approx(70.0, abs=1e-6)
    assert first[4] == pytest.approx(j5, abs=1e-9)
    assert j5 == 0.0 or any(s["joints_deg"][3::2] == pytest.approx([30.0, 40.0], abs=1e-5) for s in found)


@pytest.mark.parametrize(
    ("case", "pose"),
    [
        ("reports_43_urdf_negative_axis", [-4.757, 104.167, 1378.979, 73.732, 3.998, 152.539]),
        ("reports_49_urdf_bom_crlf", [824.279, 405.912, 949.109, 123.512, -33.314, 138.411]),
        ("reports_50_urdf_axis_rpy", [824.279, 405.912, 949.109, 123.512, -33.314, 138.411]),
    ],
)
def test_reports_where_the_flange_is(case, pose):
    assert fk(arm(case), JOINTS) == pytest.approx(pose, abs=5e-4)


@pytest.mark.parametrize(
    ("case", "place", "named"),
    [
        ("reports_44_urdf_triangle", (9, 1, "RBL606"), "J3 j3"),
        ("reports_46_urdf_mimic", (9, 125, "RBL621"), "'j3'"),
        ("reports_47_urdf_continuous", (15, 1, "RBL608"), "J6 j6"),
    ],
)
def test_reports_what_is_refused(case, place, named):
    said = robolang("kin", "fk", "--robot", arm(case), "--joints", JOINTS, code=2).stderr
    assert places(said) == [place]
    assert named in said
