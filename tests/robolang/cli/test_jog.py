"""``robolang jog``: jogs from the start state of a cell, and what is printed and refused."""

import json

import numpy as np
import pytest

from robolang.project.project import load_project
from tests.robolang.cli.commands import ROOT, flat, robolang

PICK = ROOT / "programs" / "pick_and_place.rbl"
IRB = ROOT / "programs" / "manutec_pick_and_place.rbl"


def jog(*words, code=0):
    """The jogs that are printed."""
    result = robolang("jog", "--no-physics", "--json", *words, code=code)
    return json.loads(result.stdout)["jogs"]


def test_joints_and_pose_after_each_jog():
    start, first, second, third = jog(PICK, "J3", "+5", "X", "-10.5", "rz", "2")
    home = np.rad2deg(load_project(PICK).cell.home)
    assert (start["jog"], first["jog"], second["jog"], third["jog"]) == (None, "J3 +5", "X -10.5", "RZ +2")
    assert start["joints"] == pytest.approx(home, abs=1e-9)
    assert start["pose"] == pytest.approx([480, -220, 840, 180, 0, 180], abs=1e-4)
    assert np.subtract(first["joints"], start["joints"]) == pytest.approx([0, 0, 5, 0, 0, 0], abs=1e-9)
    assert np.subtract(second["pose"], first["pose"]) == pytest.approx([-10.5, 0, 0, 0, 0, 0], abs=1e-6)
    assert third["pose"][:3] == pytest.approx(second["pose"][:3], abs=1e-6)
    assert abs(abs(third["pose"][5] - second["pose"][5]) - 2.0) < 1e-6


@pytest.mark.physics
def test_with_physics_the_command_is_the_same():
    words = (PICK, "J1", "3", "Z", "-5")
    moved = json.loads(robolang("jog", "--json", *words).stdout)["jogs"]
    assert moved == jog(*words)


@pytest.mark.physics
@pytest.mark.parametrize("words", [("X", "10"), ("Z", "-20")])
def test_a_first_jog_in_the_built_in_cell_has_no_warning(tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    assert robolang("jog", *words).stderr == ""


def test_other_frames_starts_and_arms():
    _, tool = jog("--frame", "tool", "Z", "20")
    assert tool["pose"][2] == pytest.approx(820, abs=1e-4)
    start, end = jog("--joints", "0,80,-180,0,-70,0", "J1", "-1")
    assert start["joints"] == pytest.approx([0, 80, -180, 0, -70, 0])
    assert end["joints"][0] == pytest.approx(-1)
    start, _ = jog(IRB, "J1", "1")
    assert start["joints"] == pytest.approx(np.rad2deg(load_project(IRB).cell.home))
    assert len(jog("--robot", "puma560", "J6", "1")) == 2


def test_the_table_has_a_row_for_each_jog_and_units():
    lines = robolang("jog", "--no-physics", "J3", "+5", "X", "-10").stdout.splitlines()
    assert lines[0].split() == ["jog", *(f"J{i}" for i in range(1, 7)), "X", "Y", "Z", "RX", "RY", "RZ"]
    assert lines[1].split() == ["deg"] * 6 + ["mm"] * 3 + ["deg"] * 3
    assert [line.split()[0] for line in lines[3:6]] == ["start", "J3", "X"]
    assert lines[3].split()[7:10] == ["480.000", "-220.000", "840.000"]


@pytest.mark.parametrize(
    ("words", "code"),
    [(("J1", "1", "J2", "500", "J1", "1"), "RBL411"), (("J1", "1", "X", "3000", "J1", "1"), "RBL41")],
)
def test_a_jog_that_is_refused_ends_the_jogs(words, code):
    result = robolang("jog", "--no-physics", "--json", PICK, *words, code=3)
    assert f"error {code}" in result.stderr
    assert [row["jog"] for row in json.loads(result.stdout)["jogs"]] == [None, "J1 +1"]


@pytest.mark.parametrize(
    "words",
    [
        ("J1",),
        ("J9", "1"),
        ("J1", "nan"),
        ("J1", "1", "Q", "2"),
        ("J1", "inf"),
        ("J1", "1e9"),
        (PICK,),
        ("--joints", "0,0", "J1", "1"),
        ("--joints", "0,80,-180,0,-70,nan", "J1", "1"),
        ("--joints", "0,80,-180,0,-70,9999", "J1", "1"),
        ("--speed", "nan", "J1", "1"),
        ("--speed", "0.5", "J1", "1"),
        ("--frame", "user", "J1", "1"),
        ("nowhere.rbl", "J1", "1"),
    ],
)
def test_what_is_no_jog_is_refused_before_anything_moves(words):
    result = robolang("jog", "--no-physics", *words, code=2)
    assert "RBL70" in flat(result.stderr)
    assert result.stdout == ""
