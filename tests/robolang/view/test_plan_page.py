"""The page of a planned motion: every set-point at its time, findings at their places, charts in per cent of limits."""

import numpy as np
import pytest

from robolang.api.running import run
from robolang.core.diagnostics import Diagnostic, Severity
from robolang.core.source import Span
from robolang.execution.dry_run import rehearse
from robolang.planning.motion_findings import findings
from robolang.planning.path_coverage import explore
from robolang.project.project import load_project
from robolang.view.plan_page import pack_plan
from robolang.view.plan_rows import joint_angles
from runtime.core.units import DEG
from tests.robolang.view.decoding import unpacked
from tests.runtime.plant.cells import job

pytestmark = pytest.mark.physics

PICK = "programs/pick_and_place.rbl"


def planned(project):
    explored = explore(project)
    found = (*project.diagnostics, *findings(project, explored.rehearsal, None, explored.detours))
    return unpacked(pack_plan(project, explored.rehearsal, found))


def written(folder, text):
    (folder / "p.rbl").write_text(text)
    project = load_project(folder / "p.rbl")
    assert project.ok, project.diagnostics
    return project


def test_places_are_those_of_a_run_at_their_times(tmp_path):
    """The command of a run without physics passes the same places, some cycles after the plan begins."""
    text = "DELAY 0.2\nMOVE P1 + (0, 0, 90), ZONE 20\nMOVE P2 + (0, 0, 90), ZONE 20\nMOVE P3 + (0, 0, 90)\nMOVE P4\n"
    project = written(tmp_path, text)
    rehearsal = rehearse(project)
    q = joint_angles(rehearsal, np.asarray(project.cell.home), 8000)
    assert len(q) == rehearsal.total_us // 8000 + 1
    sent = run(tmp_path / "p.rbl", physics=False).log["q_cmd"][::8]
    moves = rehearsal.moves
    assert len({move.sent_us - move.begins_us for move in moves}) == 2  # one that starts from rest, two that follow
    # the first three moves are one chain, and from its first row on the run sends row after row
    first, last = moves[0].sent_us // 8000, moves[2].ends_us // 8000 - 4
    shifts = [k for k in range(8) if np.abs(sent[first + k : last + k] - q[first:last]).max() < 1e-5]
    assert len(shifts) == 1


def test_a_plan_has_the_charts_of_a_plan_against_limits():
    project = load_project(PICK)
    header, found = planned(project)
    assert header["kind"] == "plan" and header["label"] == "pick_and_place.rbl"
    assert [each["id"] for each in header["charts"]] == ["joints", "joint_speed", "joint_acc", "tool_speed", "tool"]
    for chart in header["charts"][1:3]:
        assert chart["band"] == [-100.0, 100.0]
        peaks = [
            max(abs(value) for value in found[each["signal"]][each["column"]]) * each["scale"]
            for each in chart["series"]
        ]
        assert 20.0 < max(peaks) <= 101.0
    assert max(found["tool_speed"][0]) == pytest.approx(0.5, abs=0.01)
    (chart,) = [each for each in header["charts"] if each["id"] == "tool_speed"]
    assert [each["signal"] for each in chart["series"]] == ["tool_speed", "programmed_speed"]
    programmed = np.array(found["programmed_speed"][0], dtype=float)
    assert np.unique(np.round(programmed[np.isfinite(programmed)], 4)).tolist() == [0.5]
    assert 0.3 < np.isfinite(programmed).mean() < 1.0
    assert header["duration_s"] == pytest.approx(5.296)


def test_statements_have_their_times_and_no_path_of_the_machine_is_in_the_page():
    header, _ = planned(load_project(PICK))
    meta = header["meta"]
    assert meta["program"]["name"] == "pick_and_place.rbl"
    rows = [(each["line"], each["number"], each["start_s"]) for each in meta["report"]["statements"][:3]]
    assert rows == [(5, 20, 0.0), (6, 30, pytest.approx(0.304)), (7, 40, pytest.approx(1.008))]
    assert meta["report"]["ok"] and "programs/" not in str(header)
    assert [body["name"] for body in meta["scene"]["bodies"]][:2] == ["base", "link1"]


def test_findings_stand_where_and_when_they_are(tmp_path):
    header, found = planned(written(tmp_path, "x = 1\nMOVE P2\nMOVE P1 + (0, 0, -30)\n"))
    (note,) = [each for each in header["notes"] if each["code"] == "RBL421"]
    assert (note["line"], note["severity"]) == (3, "error") and not header["meta"]["report"]["ok"]
    row = round(note["time_s"] / 0.008)
    assert [column[row] for column in found["tool"]] == pytest.approx(note["p"], abs=1e-6)


def test_a_finding_of_another_branch_has_a_place_and_no_time(tmp_path):
    text = "MOVE P5\nIF IN(1) = 1 THEN MOVE P5 ELSE MOVE P1 + (0, 0, -30)\n"
    project = job(tmp_path, text, obstacles="[inputs.1]\nchanges = [[0, 1]]\n")
    header, _ = planned(project)
    (note,) = [each for each in header["notes"] if each["code"] == "RBL421"]
    assert note["time_s"] is None and len(note["p"]) == 3


def test_a_finding_in_the_text_stands_where_its_line_begins(tmp_path):
    project = written(tmp_path, "DELAY 0.4\nMOVE P1\nMOVE P2\n")
    item = Diagnostic(code="RBL226", severity=Severity.WARNING, message="no speed", span=Span(11, 13))
    header, _ = unpacked(pack_plan(project, rehearse(project), [item]))
    (note,) = header["notes"]
    assert (note["line"], note["time_s"], note["p"], note["severity"]) == (2, pytest.approx(0.4), None, "warning")


def test_the_tool_is_that_of_each_move(tmp_path):
    project = written(tmp_path, "MOVE P1 + (0, 0, 90)\nTOOL POSE(0, 0, 300, 0, 0, 0)\nMOVEJ HERE + (0, 0, 20)\n")
    rehearsal = rehearse(project)
    _, found = unpacked(pack_plan(project, rehearsal, ()))
    X_world_flange = rehearsal.kinematics.forward(rehearsal.moves[-1].q[-1])
    expected = X_world_flange[:3, 3] + 0.3 * X_world_flange[:3, 2]
    assert [column[-1] for column in found["tool"]] == pytest.approx(expected.tolist(), abs=1e-6)


def test_a_change_of_tool_is_no_speed_in_a_plan(tmp_path):
    """As in the log of the same program; a tool point that jumps by 0.3 m in a cycle would have 37 m/s."""
    tools = "TOOL POSE(0, 0, 300, 0, 0, 0)\nMOVEJ HERE + (0, 0, 20)\nTOOL FLANGE\nMOVE HERE + (0, 0, 20)\n"
    project = written(tmp_path, f"MOVE P1 + (0, 0, 90)\n{tools}")
    _, found = unpacked(pack_plan(project, rehearse(project), ()))
    recorded = run(tmp_path / "p.rbl", physics=False).log["tool_speed"]
    assert max(found["tool_speed"][0]) == pytest.approx(max(recorded), rel=0.02)
    tool = np.array(found["tool"]).T
    assert np.linalg.norm(np.diff(tool, axis=0), axis=1).max() > 0.2


def test_a_program_without_motion_has_a_page_and_margins_of_home(tmp_path):
    project = written(tmp_path, "x = 1\n")
    header, found = unpacked(pack_plan(project, rehearse(project), ()))
    assert header["duration_s"] == 0.0 and len(found["q_link"][0]) == 1
    home = np.asarray(project.cell.home) / DEG
    assert [column[0] / DEG for column in found["q_link"]] == pytest.approx(home.tolist())
    assert all(each["at_s"] == 0.0 for each in header["joints"])


def test_a_part_goes_with_the_hand_that_grips_it_and_stays_where_it_is_let_go():
    """As in a run with physics, to what the fingers push it."""
    header, found = planned(load_project(PICK))
    assert next(each["dt"] for each in header["signals"] if each["name"] == "parts") == pytest.approx(0.016)
    part, recorded = np.array(found["parts"]).T, run(PICK).log["parts"][:, 0]
    assert np.abs(part[0] - recorded[0]).max() < 1e-3
    assert np.abs(part[-1, :3] - recorded[-1, :3]).max() < 2e-3
    assert np.ptp(part[:, :3], axis=0) == pytest.approx(np.ptp(recorded[:, :3], axis=0), abs=3e-3)
    left, right = found["fingers"]
    assert left == right and left[0] == pytest.approx(0.04) and min(left) == pytest.approx(0.02, abs=1e-3)


def test_quaternions_of_a_part_that_turns_have_no_jump(tmp_path):
    turn = "MOVEJ POSE(480, -220, 740, 180, 0, {})\n"
    text = "MOVE P1\nHAND ON\nMOVE P1 + (0, 0, 100)\n" + turn.format(60) + turn.format(-60)
    _, found = planned(written(tmp_path, text))
    turns = np.array(found["parts"][3:7]).T
    assert np.ptp(turns, axis=0).max() > 0.5
    assert np.abs(np.diff(turns, axis=0)).max() < 0.2


def test_a_part_that_is_known_no_more_stays_where_it_was(tmp_path):
    """It is let go high over the table, so that it falls."""
    _, found = planned(written(tmp_path, "MOVE P1\nHAND ON\nMOVE P1 + (0, 0, 150)\nHAND OFF\nMOVE P5\n"))
    heights = found["parts"][2]
    assert heights[-1] == heights[-10] == pytest.approx(max(heights), abs=1e-3) and np.ptp(heights) > 0.1
