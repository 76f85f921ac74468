"""Controller settings: cell, profile file and options over one another, and where each value came from."""

import json

import pytest

from tests.messages import fields, heads
from tests.robolang.cli.commands import BUILTIN, flat, robolang

CELL = (BUILTIN / "cell.toml").read_text()


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "cell.toml").write_text(CELL + "\n[controller]\nservo_period_ms = 0.5\nin_position_deg = 0.1\n")
    (tmp_path / "p.rbl").write_text("HAND OFF\n")
    (tmp_path / "f.toml").write_text(
        "schema = 1\n[controller]\nservo_period_ms = 0.25\n[controller.servo]\nmode = 'fixed'\n"
    )
    return tmp_path


def settings(*words):
    found = json.loads(robolang("config", "show", "--json", *words).stdout)
    return {row["key"]: (row["value"], row["unit"], row["from"]) for row in found["settings"]}


def test_each_layer_lies_over_the_one_before(folder):
    shown = settings(
        folder / "p.rbl",
        "--profile",
        folder / "f.toml",
        "--fixed-at",
        "max",
        "--set",
        "servo.position_bandwidth_rad_s=[1,2,3,4,5,6]",
    )
    assert shown["settle_timeout_s"] == (0.4, "s", "default")
    cell_line = CELL.count("\n") + 4
    assert shown["in_position_deg"] == (0.1, "deg", f"{folder / 'cell.toml'}:{cell_line}")
    assert shown["servo_period_ms"] == (0.25, "ms", f"{folder / 'f.toml'}:3")
    assert shown["servo.mode"] == ("fixed", "", "--fixed-at")
    assert shown["servo.fixed_at"] == ("max", "", "--fixed-at")
    assert shown["servo.position_bandwidth_rad_s"] == ([1, 2, 3, 4, 5, 6], "1/s", "--set")
    assert shown["servo.velocity_bandwidth_rad_s"] == ([120.0] * 6, "1/s", "robot puma560")
    assert "servo.coupling" in robolang("config", "show").stdout


BAD = [
    (["--servo", "off"], "RBL703 --servo off"),
    (["--servo", "scheduled", "--fixed-at", "min"], "RBL703 --fixed-at"),
    (["--servo-period", "2"], "RBL703 --servo-period"),
    (["--set", "gain"], "RBL703 --set"),
    (["--set", "servo.gain=1"], "RBL609 --set servo.gain"),
    (["--set", "in_position_deg=nan"], "RBL604 --set in_position_deg"),
    (["--set", "servo.mode=4"], "RBL613 --set"),
    (["--set", "servo.velocity_bandwidth_rad_s=[1,2]"], "RBL613 --set servo.velocity_bandwidth_rad_s 2"),
    (["--set", "servo.velocity_bandwidth_rad_s=2000"], "RBL616 --set velocity_bandwidth_rad_s 2000 J1"),
    (["--fixed-at", "max", "--set", "servo.velocity_bandwidth_rad_s=1000"], "RBL616 --set"),
    (["--fixed-at", "min", "--coupling", "full"], "RBL605 --coupling"),
    (
        ["--feedforward", "measured", "--set", "servo.velocity_feedforward=1"],
        "RBL616 --set controller.servo.velocity_feedforward",
    ),
    (
        ["--feedforward", "measured", "--fixed-at", "max", "--set", "servo.acceleration_feedforward=0.6"],
        "RBL616 --set",
    ),
]


@pytest.mark.parametrize(("words", "said"), BAD, ids=[" ".join(case[0]) for case in BAD])
def test_a_value_that_cannot_be_used_names_its_option(words, said):
    assert set(said.split()) <= fields(flat(robolang("config", "show", *words, code=2).stderr))


def test_a_spring_compensation_that_feeds_back_too_much_is_located_in_the_profile(tmp_path):
    """Ka + Kv Kp K2 D/Kc < 1 with a soft gear: 120 * 30 * 2 * 2.9 kg m2 / 1e4 N m/rad is 2.1 on J1."""
    from tests.robolang.cli.commands import PUMA

    robot = tmp_path / "soft.toml"
    robot.write_text(
        PUMA.read_text().replace(
            "coulomb_friction_nm", "joint_stiffness_nm_rad = 1e4\njoint_damping_nm_s_rad = 5\ncoulomb_friction_nm"
        )
    )
    profile = tmp_path / "f.toml"
    text = "schema = 1\n[controller.servo]\nfeedforward = 'measured'\nspring_compensation = {}\n"
    profile.write_text(text.format(2.0))
    said = robolang("config", "show", "--robot", robot, "--profile", profile, code=2).stderr
    assert f"{profile}:4:1: error RBL616" in said
    assert "Kv Kp K2 D/Kc" in said
    profile.write_text(text.format(0.2))
    robolang("config", "show", "--robot", robot, "--profile", profile)


def test_step_prints_its_figures_and_writes_a_plot(tmp_path):
    words = ["step", "--robot", "puma560", "--axis", "2", "--joints", "0,0,-90,0,0,0", "--payload", "2.5,0,0,100"]
    shown = robolang(*words, "--plot", tmp_path / "a.svg")
    assert "overshoot" in shown.stdout
    assert (tmp_path / "a.svg").read_text().startswith("<svg")
    found = json.loads(robolang(*words, "--json", "--load", "0,0,0,0", "--size", "0", "--coupling", "diagonal").stdout)
    assert found["droop_deg"] > 0.05
    assert found["overshoot_pct"] is None
    assert {"2.5", "kg"} <= fields(robolang(*words[:-1], "5,0,0,100").stderr)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--axis", "7"], "1 6"),
        (["--axis", "1", "--joints", "1,2"], "6"),
        (["--axis", "7", "--size", "1000"], "RBL703 --size"),
        (["--axis", "1", "--joints", "161,0,0,0,0,0"], "RBL703 --joints 1 J1 161"),
        (["--axis", "2", "--joints", "0,0,46,0,0,0"], "RBL703 --joints 3 J3 46"),
        (["--axis", "1", "--joints", "159,0,0,0,0,0", "--size", "1.5"], "RBL703 --size J1 160.5"),
        (["--axis", "1", "--lock-others", "--plant", "mujoco"], "RBL703 --lock-others"),
        (["--axis", "1", "--payload", "-1,0,0,0"], "RBL703 --payload -1 kg"),
        (["--axis", "1", "--size", "nan"], "RBL703 --size"),
        (["--axis", "1", "--plot", "a.png"], "RBL703 --plot"),
    ],
)
def test_step_refuses_what_it_cannot_do(words, said):
    assert set(said.split()) <= fields(flat(robolang("step", "--robot", "puma560", *words, code=2).stderr))


@pytest.mark.parametrize(
    ("key", "near"),
    [
        ("servo.gravity", {"servo.gravity_compensation", "servo.gravity_lead"}),
        ("gravity_compensation", {"servo.gravity_compensation"}),
        ("servo.velocity_feedforwrd", {"servo.velocity_feedforward"}),
        ("servo.nothing", set()),
        ("servo.", set()),
    ],
)
def test_a_key_that_does_not_exist_is_answered_with_those_it_may_stand_for(key, near):
    assert fields(robolang("config", "show", "--set", f"{key}=0", code=2).stderr) == {"RBL609", "--set", key, *near}


def test_a_program_that_is_missing_has_the_code_that_a_run_gives_it(folder):
    (folder / "near.rbl").touch()
    for word in ("none.rbl", "near"):
        shown, ran = (robolang(*words, folder / word, code=2).stderr for words in (("config", "show"), ("run",)))
        assert shown == ran
        assert heads(shown) == [f"{folder / word}:1:1: error RBL701"]


def test_a_folder_has_no_line_and_no_column(folder):
    assert robolang("run", folder, code=2).stderr.startswith(f"{folder}: error RBL702 ")
    assert robolang("run", folder / "p.rbl", "--cell", folder, code=2).stderr.startswith(f"{folder}: error RBL600 ")
