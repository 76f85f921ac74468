"""What a run says of touches: parts that are pushed, obstacles that are struck, parts that slip out of the hand.

Short programs on MuJoCo in the built-in cell with other parts. How far a part was moved is held against the pose of its
free body before and after the run.
"""

import re

import numpy as np
import pytest

from robolang.execution.session import Session
from tests.messages import fields
from tests.runtime.plant.cells import BESIDE, GRIP, LEDGE, LET_GO, OWN, job

pytestmark = pytest.mark.physics

LIGHT = (*OWN[:4], 0.5, *OWN[5:])
"""The part so light that pushing it is no collision for the drives, and does not keep the arm from its place."""


def ran(folder, text, *parts, **cell):
    """Run a program; its report, and the displacement of the centre of each part in mm."""
    session = Session(job(folder, text, *parts, **cell))
    before = session.controller.plant.parts()
    report = session.run().report
    after = session.controller.plant.parts()
    return report, {name: 1e3 * float(np.linalg.norm(after[name][:3, 3] - before[name][:3, 3])) for name in before}


def said(report):
    """Code and line of each warning, then of each alarm."""
    return [(item["code"], item["line"]) for item in (*report["warnings"], *report["alarms"])]


def pushed(report):
    """Every touch of the report with the line of its statement."""
    return [(entry["line"], touch) for entry in report["statements"] for touch in entry["touched"]]


ALLOWED = {
    "carry and place on the table": (GRIP + "MOVE P5\nMOVE P4\nMOVE P3\n" + LET_GO + "MOVE P4\n", [OWN]),
    "place on a part": (
        GRIP + "MOVE P5\nMOVE P1 + (0, 150, 85)\nMOVE P1 + (0, 150, 80)\n" + LET_GO + "MOVE P1 + (0, 150, 180)\n",
        [OWN, ("low", 60, 60, 80, 1.5, 480, -70, 640)],
    ),
    "take from a part": (
        "MOVE P1 + (0, 0, 80)\nHAND ON\nLOAD (0, 0, 95), 2.3\nMOVE P1 + (0, 0, 150)\n",
        [("part", 60, 40, 80, 1.5, 480, -220, 720), ("low", 60, 60, 80, 1.5, 480, -220, 640)],
    ),
    "the fingers centre the part": ("MOVE P1 + (0, 10, 0)\nHAND ON\nLOAD (0, 0, 95), 2.3\nMOVE P5\n", [OWN]),
    "a hand closed on nothing presses on a part": (
        "MOVE P1 + (0, 0, 150)\nHAND ON\nMOVE P1 + (0, 0, 59.9), SPEED 50\nMOVE P5\n",
        [OWN],
    ),
    "a part dropped on the table": (GRIP + "MOVE P1 + (0, 0, 30)\n" + LET_GO + "MOVE P5\nDELAY 0.3\n", [OWN]),
}


WARNED = {"a hand closed on nothing presses on a part": [("RBL441", 3)]}


@pytest.mark.parametrize("case", ALLOWED)
def test_what_a_program_is_there_for_is_no_finding(tmp_path, case):
    text, parts = ALLOWED[case]
    report, moved = ran(tmp_path, text, *parts)
    assert said(report) == WARNED.get(case, [])
    assert pushed(report) == []
    assert moved.get("low", 0.0) < 0.5


def test_a_neighbour_is_pushed_by_open_fingers(tmp_path):
    """The outer face of a finger is 48 mm from the tool point, that of the part 20 mm from its centre: 13 mm deep."""
    text = BESIDE + "MOVE P1 + (0, 55, 0), SPEED 50\nMOVE P1 + (0, 80, 0)\n"
    report, moved = ran(tmp_path, text, LIGHT)
    assert said(report) == [("RBL535", 4)]
    ((line, touch),) = pushed(report)
    assert (line, touch["what"]) == (4, "part")
    assert any("right finger" in by for by in touch["by"])
    assert touch["moved_mm"] == pytest.approx(13.0, abs=0.6)
    assert touch["moved_mm"] == pytest.approx(moved["part"], abs=0.1)
    assert re.search(rf"\bpart\b.*\b{touch['moved_mm']:.1f} mm", report["warnings"][0]["message"])
    assert report["ok"]


def test_a_push_of_less_than_half_a_millimetre_is_no_finding(tmp_path):
    text = BESIDE + "MOVE P1 + (0, 67.8, 0), SPEED 50\nMOVE P1 + (0, 80, 0)\n"
    report, moved = ran(tmp_path, text, OWN)
    assert 0.0 < moved["part"] < 0.5
    assert said(report) == []
    assert pushed(report) == []


def test_a_part_that_is_knocked_over_counts_to_where_it_comes_to_rest(tmp_path):
    """It falls while the arm is on its way back, in a statement that does not touch it."""
    tall = ("tall", 30, 30, 200, 0.5, 480, -220, 700)
    text = "MOVE P5 + (0, 90, 0)\nMOVE P1 + (0, 90, 120)\nMOVE P1 + (0, 30, 120)\nMOVE P1 + (0, 92, 120)\nDELAY 1\n"
    report, moved = ran(tmp_path, text, tall)
    assert [code for code, _ in said(report)] == ["RBL535"]
    ((line, touch),) = pushed(report)
    assert line == 4
    assert moved["tall"] > 80.0
    assert touch["moved_mm"] == pytest.approx(moved["tall"], abs=5.0)
    assert touch["turned_deg"] > 80.0


def test_a_touch_that_goes_on_is_told_for_each_statement(tmp_path):
    text = BESIDE + "MOVE P1 + (0, 60, 0), SPEED 50\nMOVE P1 + (0, 55, 0), SPEED 50\n"
    report, moved = ran(tmp_path, text, OWN)
    assert [row for row in said(report) if row[0] != "RBL523"] == [("RBL535", 4), ("RBL535", 5)]
    times = [item["time_s"] for item in report["warnings"]]
    assert times == sorted(times)
    assert sum(touch["moved_mm"] for _, touch in pushed(report)) == pytest.approx(moved["part"], abs=0.1)


def test_a_pushed_part_pushes_another(tmp_path):
    text = BESIDE + "MOVE P1 + (0, 55, 0), SPEED 50\n"
    report, moved = ran(tmp_path, text, LIGHT, ("other", 60, 40, 80, 0.5, 480, -265, 640))
    found = {touch["what"]: touch for _, touch in pushed(report)}
    assert found["other"]["by"] == ["part"]
    assert found["other"]["moved_mm"] == pytest.approx(moved["other"], abs=0.1)
    assert moved["other"] == pytest.approx(8.0, abs=0.6)


def test_a_held_part_pushes_another(tmp_path):
    """The part in the hand reaches 40 mm further down than the pads do."""
    text = GRIP + "MOVE P1 + (0, 0, 30)\nMOVE P1 + (0, 50, 30), SPEED 50\nMOVE P1 + (0, 0, 30)\n"
    report, moved = ran(tmp_path, text, OWN, ("other", 60, 40, 40, 0.5, 480, -150, 620))
    assert said(report)[0] == ("RBL535", 6)
    (line, touch), *_ = pushed(report)
    assert (line, touch["by"], touch["what"]) == (6, ["part"], "other")
    assert touch["moved_mm"] == pytest.approx(moved["other"], abs=0.2)


def test_a_part_that_the_hand_is_stopped_by(tmp_path):
    """The finger comes down on its edge: it cannot give way, and the torques say that something is there."""
    report, moved = ran(tmp_path, "MOVE P5 + (0, 44, 0)\nMOVE P1 + (0, 44, 10), SPEED 60\n", OWN)
    assert moved["part"] < 0.5
    assert ("RBL535", 3) in said(report)
    assert {code for code, _ in said(report)} & {"RBL511", "RBL512", "RBL515", "RBL516"}
    assert re.search(r"right finger.*\bpart\b", report["warnings"][0]["message"])


def test_an_obstacle_is_struck_by_a_finger(tmp_path):
    text = "MOVE P1 + (0, 150, 0)\nMOVE P1 + (0, 150, -20.3), SPEED 20\nMOVE P1 + (0, 150, 0)\n"
    report, _ = ran(tmp_path, text, OWN)
    assert said(report)[0] == ("RBL537", 3)
    assert re.search(r"finger.*\btable\b", report["warnings"][0]["message"])
    assert pushed(report)[0][1]["what"] == "table"


def test_a_held_part_slides_along_an_obstacle(tmp_path):
    text = GRIP + "MOVE P1 + (0, 0, 60.9)\nMOVE P1 + (0, 150, 60.9), SPEED 100\n"
    report, _ = ran(tmp_path, text, OWN, obstacles=LEDGE)
    assert said(report)[0] == ("RBL537", 6)
    assert re.search(r"\bpart\b.*\bledge\b", report["warnings"][0]["message"])


def test_a_part_is_pulled_over_the_table(tmp_path):
    report, _ = ran(tmp_path, GRIP + "MOVE P1 + (0, 20, 0), SPEED 50\n", OWN)
    assert said(report)[0] == ("RBL537", 5)
    assert pushed(report)[0][1]["slid_mm"] == pytest.approx(20.0, abs=0.6)


@pytest.mark.parametrize(("mass", "force"), [(0.2, 2.0), (1.5, 14.5)])
def test_a_part_is_lost_whatever_its_mass(tmp_path, mass, force):
    """The grip holds its weight, 2 mu F = 1.2 F, by a little, and not the fast move."""
    load = f"LOAD (0, 0, 95), {0.8 + mass}\n"
    text = f"MOVE P1\nHAND ON\n{load}MOVE P5\nMOVEJ P2, ACCEL 100\nMOVEJ P5, ACCEL 100\nMOVEJ P2, ACCEL 100\n"
    report, _ = ran(tmp_path, text, (*OWN[:4], mass, *OWN[5:]), grip_force_n=force)
    ((code, line),) = said({**report, "warnings": []})
    assert code == "RBL536"
    assert line in (5, 6, 7, 8)
    assert report["alarms"][0]["category"] == 1
    assert "3" in fields(report["alarms"][0]["message"])
    assert not report["ok"]
