import json
import os

import pytest

from runtime.robot.files.loader import load_builtin
from runtime.robot.files.robot_file import library
from tests.messages import fields
from tests.robolang.cli.commands import PUMA, robolang
from tests.runtime.robot.models import SIX


def test_the_library_is_listed():
    text = robolang("robot", "list").stdout
    assert max(map(len, text.splitlines())) <= 80
    rows = [line.split() for line in text.splitlines()]
    assert ["irb2400", "ABB", "IRB", "2400/10", "6", "1630", "10", "bodies,", "accelerations,"] in rows
    assert ["manutec_r3", "Manutec", "r3", "6", "1690", "15", "ranges,", "jerks,", "drives,"] in rows
    found = json.loads(robolang("robot", "list", "--json").stdout)
    assert [row["name"] for row in found] == library()
    assert found[3] == {
        "name": "puma560",
        "title": "Unimation Puma 560",
        "axes": 6,
        "reach_mm": 880.0,
        "rated_payload_kg": 2.5,
        "estimated": ["speeds", "accelerations", "jerks", "drives", "loops", "path limits", "link radii"],
    }


def test_a_robot_is_given_as_json(tmp_path):
    found = json.loads(robolang("robot", "show", "puma560", "--json").stdout)
    axis = found["axes"][1]
    assert axis["motor"]["gear_ratio"] == 107.815
    assert axis["mass_kg"] == 17.4
    assert axis["range_deg"] == pytest.approx([-45.0, 225.0])
    assert axis["max_jerk_deg_s3"] == pytest.approx(10 * axis["max_acceleration_deg_s2"])
    assert axis["motor"]["joint_stiffness_nm_rad"] is None
    assert found["estimated"]["axes.6.servo.position_bandwidth_rad_s"] == ""
    assert "axes.2.motor.torque_constant_nm_a" not in found["estimated"]
    assert found["drives"] is True
    arm = tmp_path / "six.urdf"
    arm.write_text(SIX)
    found = json.loads(robolang("robot", "show", arm, "--json").stdout)
    assert found["drives"] is False
    assert found["estimated"]["axes.1.motor.gear_ratio"]


def test_estimates_are_marked_and_their_rules_are_listed(tmp_path):
    arm = tmp_path / "six.urdf"
    arm.write_text(SIX)
    robolang("robot", "import", arm, "--estimate")
    text = robolang("robot", "show", arm).stdout
    assert max(map(len, text.splitlines())) <= 80
    rows = [line.split() for line in text.splitlines()]
    limits = next(row for row in rows if row[:2] == ["J1", "j1"])
    assert limits[5] == "171.887"  # the speed of the file
    assert limits[6].startswith("~")
    assert limits[7] == f"~{10 * float(limits[6][1:]):g}"
    assert ["J6", "~35", "~140", "~500", "~131072"] in rows
    assert "motor.gear_ratio of J1 to J6 (6): motor at 315 rad/s" in " ".join(text.split())


def test_a_name_of_no_value_in_the_list_of_estimates_is_refused(tmp_path):
    path = tmp_path / "r.toml"
    for name in ("axes.*.gears", "axes.7.max_torque_nm"):
        path.write_text(PUMA.read_text().replace('"path.*"', f'"{name}"'))
        error = robolang("robot", "show", path, code=2).stderr
        assert "r.toml:17:1: error RBL610" in error
        assert name in fields(error)


def test_every_column_fits_80_characters_uncut():
    text = robolang("robot", "show", "puma560").stdout
    assert "…" not in text
    assert max(map(len, text.splitlines())) <= 80
    spec = load_builtin("puma560")
    for axis in spec.axes:
        motor = axis.motor
        for number in (motor.gear_ratio, motor.rotor_inertia, motor.viscous_friction, axis.limits.torque):
            assert f" {number:g} " in text.replace("~", " ")
        assert " {:g}/{:g} ".format(*motor.coulomb_friction) in text
        assert f"{axis.name} " in text
    loops = next(
        line for line in text.splitlines()[text.splitlines().index("Servo loops ".ljust(60)) :] if " J1 " in line
    )
    assert loops.split() == ["J1", "~30", "~120", "~300", "~131072"]
    bodies = [line.split() for line in text.splitlines() if line.startswith(" J3 ")][-1]
    assert bodies == ["J3", "4.8", "0", "70", "164.15", "0.066", "0.0125", "0.086", "0.06975", "0.01625", "0.086"]


@pytest.mark.parametrize("name", library())
def test_every_robot_is_shown_within_80_characters(name):
    text = robolang("robot", "show", name).stdout
    assert "…" not in text
    assert max(map(len, text.splitlines())) <= 80
    words, spec = " ".join(text.split()), load_builtin(name)
    assert all(note in words for note in (*spec.sources, *spec.notes))


def test_gear_springs_are_shown_where_there_are_any():
    assert "Gear springs" not in robolang("robot", "show", "puma560").stdout
    lines = robolang("robot", "show", "manutec_r3").stdout.splitlines()
    start = lines.index(next(line for line in lines if line.startswith("Gear springs")))
    rows = [line.split() for line in lines[start:] if line.startswith(" J")][:6]
    # 43 N m/rad and 0.005 N m s/rad at the motor, times 105^2; 9 A x 1.1616 N m/A x 105 over the stiffness
    assert rows[0] == ["J1", "474075", "55.125", "0.133"]
    assert rows[1] == ["J2", "352800", "441", "0.357"]
    assert rows[3] == ["J4", "rigid"]


def test_a_body_published_as_a_point_is_shown_with_what_it_was_given():
    words = " ".join(robolang("robot", "show", "manutec_r3").stdout.split())
    assert "J6: 1e-12 kg m2 " in words
    assert "J1: 0.58 kg m2 " in words


def test_corrections_sources_and_notes_are_given_in_full():
    words = " ".join(robolang("robot", "show", "puma560").stdout.split())
    spec = load_builtin("puma560")
    for text in (*spec.sources, *spec.notes, *(correction.reason for correction in spec.corrections)):
        assert text in words
    assert "J3: 0.00375 kg m2 " in words
    assert "J1: 0.175 kg m2 " in words
    assert "1e-06 kg" in words


def test_a_robot_file_is_shown_like_a_built_in_one():
    assert robolang("robot", "show", PUMA).stdout == robolang("robot", "show", "puma560").stdout


def test_words_of_a_robot_file_are_printed_and_not_obeyed(tmp_path):
    path = tmp_path / "r.toml"
    text = PUMA.read_text().replace('"waist"', '"[/red] :smile: \\u001b[2J"')
    path.write_text(text.replace('"Unimation', '"\\u001b[2J[bold]Unimation', 1))
    shown = robolang("robot", "show", path).stdout
    assert "[/red] :smile: \ufffd[2J" in shown
    assert "puma560: \ufffd[2J[bold]Unimation" in shown
    assert "\x1b" not in shown


def test_long_names_and_numbers_are_folded_and_never_cut(tmp_path):
    path = tmp_path / "r.toml"
    text = PUMA.read_text().replace('"shoulder"', f'"{"long " * 20}"')
    for old, new in (
        ("coulomb_friction_nm = [0.395, 0.435]", "coulomb_friction_nm = [0.00395678, 0.00435678]"),
        ("gear_ratio = -62.6111", "gear_ratio = -1234.56"),
        ("viscous_friction_nm_s = 1.48e-3", "viscous_friction_nm_s = 1.48765e-5"),
        ("rotor_inertia_kg_m2 = 200e-6", "rotor_inertia_kg_m2 = 1.23456e-5"),
    ):
        text = text.replace(old, new, 1)
    path.write_text(text)
    shown = robolang("robot", "show", path).stdout
    assert "…" not in shown
    assert max(map(len, shown.splitlines())) <= 80
    assert shown.count("long ") + shown.count("long\n") >= 20
    assert all(part in shown for part in ("-1234.56", "1.48765e-05", "1.23456e-05"))


def test_a_xacro_is_answered_with_what_to_do():
    error = robolang("robot", "show", "arm.urdf.xacro", code=2).stderr
    assert "RBL708" in error
    assert "xacro arm.urdf.xacro > arm.urdf" in " ".join(error.split())


def test_a_robot_in_capitals_is_answered_with_its_name():
    # once as the answer, once in the list
    assert robolang("robot", "show", "PUMA560", code=2).stderr.count("puma560") == 2


@pytest.mark.parametrize(
    ("name", "code", "said"),
    [
        ("puma56", "RBL708", "puma560"),
        ("nothing", "RBL708", "irb2400 manutec_r3 puma560"),
        ("", "RBL708", "irb2400 manutec_r3 puma560"),
        ("none.toml", "RBL600", "none.toml"),
        ("folder.toml", "RBL600", ""),
        ("pipe.toml", "RBL600", ""),
        ("empty.toml", "RBL608", "schema"),
        ("short.toml", "RBL601", "short.toml"),
    ],
)
def test_a_robot_that_cannot_be_shown(tmp_path, monkeypatch, name, code, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.toml").mkdir()
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "empty.toml").touch()
    (tmp_path / "short.toml").write_bytes(PUMA.read_bytes().partition(b"0.126")[0])
    result = robolang("robot", "show", name, code=2)
    assert code in result.stderr
    assert set(said.split()) <= fields(result.stderr)
    assert "help: " in result.stderr
    assert result.stdout == ""
