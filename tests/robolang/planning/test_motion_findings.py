"""What a rehearsal shows beyond refusals, program by program on the built-in cell, with place, value and limit."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from robolang.core.diagnostics import Severity
from robolang.execution.dry_run import rehearse
from robolang.planning import motion_findings
from robolang.planning.motion_findings import LoadShare, findings, worst_loads
from robolang.project.project import builtin_cell, load_project
from runtime.core.units import DEG
from runtime.plant.shapes import Shapes
from runtime.robot.model.axis_kind import REVOLUTE
from tests.messages import fields, numbers

pytestmark = pytest.mark.physics


def looked_at(folder, text, robot=None):
    (folder / "p.rbl").write_text(text)
    project = load_project(folder / "p.rbl", robot=robot)
    assert project.ok, project.diagnostics
    return project, rehearse(project)


def found(folder, text, code):
    """Line and message of each finding of a code, and its severity."""
    project, rehearsal = looked_at(folder, text)
    return [
        (project.source.place(item.span.start).line, item.message, item.severity)
        for item in findings(project, rehearsal)
        if item.code == code
    ]


def test_a_program_that_is_well_has_none(tmp_path):
    text = "LOAD empty\nSPEED 250\nMOVE P1\nHAND ON\nLOAD hand_and_part\nMOVE P2, ZONE 20\nMOVE P3\n"
    assert findings(*looked_at(tmp_path, text)) == ()


def test_the_first_obstacle_on_the_way_blended_or_not(tmp_path):
    ((line, message, severity),) = found(tmp_path, "MOVE P2\nMOVE P1 + (0, 0, -30)\n", "RBL421")
    assert (line, severity) == (2, Severity.ERROR)
    assert 80.0 <= numbers(message)[0] < 100.0
    assert re.search(r"\bpad_\w+\b.*\btable\b", message)
    # the corner over the edge of the table is cut: the blended way goes where neither move does
    over = "MOVE P1 + (0, 0, 40)\nMOVE P1 + (0, 0, 3), ZONE 30\nMOVE P1 + (60, 0, 40)\n"
    assert found(tmp_path, over, "RBL421") == []


def test_the_arm_in_itself(tmp_path):
    text = "MOVEJ JOINT(2, -25, -190, 70, -58, -45), SPEED 20\nMOVEJ JOINT(2, -25, -199, 70, -58, -45)\n"
    said = found(tmp_path, text, "RBL424")
    assert said
    assert all(re.search(r"\d+\.\d %.*\b(pad_left|shank_left|palm)\b.*\blink1\b", each) for _, each, _ in said)
    assert {severity for *_, severity in said} == {Severity.ERROR}


def test_what_always_meets_is_not_looked_at():
    cell = builtin_cell()
    shapes = Shapes(cell.robot, cell)
    assert shapes.folded(cell.home) is None
    assert shapes.folded(np.array([2.0, -25.0, -199.0, 70.0, -58.0, -45.0]) * DEG) is not None


def test_a_zone_without_room(tmp_path):
    text = "MOVE P1 + (0, 0, 60)\nMOVE P1 + (0, 0, 100), ZONE 30\nMOVE P1 + (100, 0, 100)\n"
    ((line, message, severity),) = found(tmp_path, text, "RBL414")
    assert (line, severity) == (2, Severity.WARNING)
    assert numbers(message)[:2] == [30, 40.0]
    assert "mm" in fields(message)
    assert found(tmp_path, text.replace("ZONE 30", "ZONE 20"), "RBL414") == []
    longer = text.replace("100), ZONE 30", "120), ZONE 30").replace(
        "MOVE P1 + (100, 0, 100)", "MOVE P1 + (100, 0, 120)"
    )
    assert found(tmp_path, longer, "RBL414") == []


def test_a_path_near_a_straight_wrist(tmp_path):
    start = "MOVEJ JOINT(0, 60, -190, 0, -1.5, 0)\nMOVE HERE + (20, 0, 0), WRIST KEEP\n"
    ((line, message, severity),) = found(tmp_path, start, "RBL427")
    assert (line, severity) == (2, Severity.WARNING)
    assert re.search(r"\b\d\.\d\d deg\b.*\bwrist\b", message)
    assert found(tmp_path, "MOVEJ JOINT(0, 60, -190, 0, -1.5, 0)\n", "RBL427") == []  # joints pass there freely


def test_a_wrist_that_changes_is_named_unless_the_program_says_so(tmp_path):
    text = "MOVEJ JOINT(0, 60, -190, 20, -8, 0)\nMOVE JOINT(10, 60, -190, 20, 8, 0){}\n"
    ((line, message, _),) = found(tmp_path, text.format(""), "RBL428")
    assert line == 2
    start, end, turned = numbers(message)[:3]
    assert 0.0 <= start < end <= 100.0
    assert turned > 0.0
    assert found(tmp_path, text.format(", WRIST AUTO"), "RBL428") == []
    assert found(tmp_path, "WRIST AUTO\n" + text.format(""), "RBL428") == []


def test_a_move_that_cannot_keep_its_speed(tmp_path):
    text = "MOVEJ JOINT(0, 60, -190, 0, -20, 0)\nMOVE HERE * (0, 0, 0, 0, 0, 150){}\n"
    ((line, message, _),) = found(tmp_path, text.format(", TIME 0.3"), "RBL429")
    assert line == 2
    assert {"s", "1.184", "0.3", "TIME", "150.0", "deg", "180", "deg/s"} <= fields(message)
    assert found(tmp_path, text.format(""), "RBL429") == []
    fast = "MOVEJ JOINT(0, 60, -190, 0, -3, 0)\nMOVE HERE + (0, 100, 0), SPEED 900, WRIST KEEP\n"
    ((_, message, _),) = found(tmp_path, fast, "RBL429")
    assert {"mm/s", "SPEED", "900", "s"} <= fields(message)
    assert re.search(r"\bJ\d\b.*\b(speed|acceleration|jerk)\b", message)


def test_a_time_is_asked_for_under_the_override(tmp_path):
    assert found(tmp_path, "OVERRIDE 50\nMOVE P2, TIME 2\n", "RBL429") == []


def test_an_end_in_other_joint_angles_is_named(tmp_path):
    text = "MOVEJ JOINT(0, 60, -190, -30, -30, 0)\nMOVE JOINT(10, 60, -190, 150, 30, 180), WRIST KEEP\n"
    ((line, message, _),) = found(tmp_path, text, "RBL419")
    assert line == 2
    assert re.search(r"\bJ\d\b.* -?\d+\.\d deg.* -?\d+\.\d deg", message)
    assert {"WRIST", "KEEP"} <= fields(message)


def test_a_wrist_statement_ends_no_blend_in_the_rehearsal_either(tmp_path):
    from robolang.execution.session import Session

    text = "LOAD empty\nSPEED 200\nZONE 20\nMOVE P2\nWRIST KEEP\nMOVE P5\n"
    project, rehearsal = looked_at(tmp_path, text)
    run = Session(project, physics=False).run()
    assert abs(rehearsal.total_us - round(run.report["sim_time_s"] * 1e6)) <= 8000


HEAVY = "LOAD ({}, 0, 60), 2.4, ({}, {}, {}, 0, 0, 0)\nMOVE P1\nMOVE P2\n"


def test_a_payload_that_overloads_the_wrist(tmp_path):
    """9.81 x 2.4 x 0.6 = 14.1 N m about J6 where it is upright: J5 and J6 are estimated to hold 10.05 and 10.65."""
    text = "LOAD (600, 0, 60), 2.4\nMOVEJ JOINT(0, 60, -190, 0, 60, 0)\nMOVEJ JOINT(0, 90, -90, 90, 90, 0)\n"
    said = {line: message for line, message, _ in found(tmp_path, text, "RBL425")}
    assert said
    assert all("N m" in message for message in said.values())
    assert found(tmp_path, HEAVY.format(0, 0.01, 0.01, 0.01), "RBL426") == []
    inertia = found(tmp_path, HEAVY.format(0, 0.2, 0.2, 0.2), "RBL426")
    assert [severity for *_, severity in inertia] == [Severity.WARNING]  # one for a statement, the worst axis
    _, mass, axis, value, over, limit = numbers(inertia[0][1])
    assert (mass, axis, over) == (2.4, 5, 0.0594)
    assert value == pytest.approx(limit + over, abs=0.002)


@pytest.mark.parametrize(
    ("value", "limit", "over"),
    [(2.95e-40, 0.0, False), (0.15 + 1e-12, 0.15, False), (0.152, 0.15, True), (1e-3, 0.0, True), (math.nan, 1, True)],
)
def test_what_is_over_a_limit_is_over_it_in_the_digits_shown(tmp_path, monkeypatch, value, limit, over):
    project, rehearsal = looked_at(tmp_path, "LOAD empty\nMOVE P1\n")
    share = LoadShare(
        axis=4, what="inertia", value=value, limit=limit, given=True, move=rehearsal.moves[0], row=0, kind=REVOLUTE
    )
    monkeypatch.setattr(motion_findings, "worst_loads", lambda *_: [share])
    said = [item.message for item in findings(project, rehearsal) if item.code == "RBL426"]
    assert len(said) == over
    assert all(f"{value:.3g} kg m2, " in message and f" {value - limit:.3g} kg m2" in message for message in said)


def test_published_ratings_make_it_an_error(tmp_path):
    text = "LOAD (0, 0, 1300), 14\nMOVEJ JOINT(0, 20, 20, 0, 60, 0)\n"
    (tmp_path / "p.points.toml").write_text("schema = 1\n")
    (tmp_path / "p.rbl").write_text(text)
    cell = Path(__file__).parents[3] / "programs/manutec_pick_and_place.cell.toml"
    (tmp_path / "p.cell.toml").write_text(cell.read_text())
    project = load_project(tmp_path / "p.rbl")
    said = [item for item in findings(project, rehearse(project)) if item.code in ("RBL425", "RBL426")]
    assert {item.severity for item in said} == {Severity.ERROR}
    assert any("59 N m" in item.message for item in said)


@pytest.mark.parametrize("mass", [0.0, 1.0])
def test_worst_loads_are_of_what_is_declared(tmp_path, mass):
    project, rehearsal = looked_at(tmp_path, f"LOAD (0, 0, 100), {mass}\nMOVE P1\nMOVE P2\n")
    shares = worst_loads(project, rehearsal.kinematics, rehearsal.moves)
    inertia = {share.axis: share.value for share in shares if share.what == "inertia"}
    if mass:
        assert inertia[4] == pytest.approx(mass * 0.1**2, rel=1e-6)  # J5 has it across, whatever the posture
    else:
        assert shares == []
