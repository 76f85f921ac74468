"""The programs of programs/wrist on MuJoCo: they end as taught, on their line, and say what the wrist did."""

from pathlib import Path

import numpy as np
import pytest

from robolang.execution.observer import Observer
from robolang.execution.session import Session
from robolang.project.project import load_project
from runtime.core.units import MM
from runtime.motion.seam import superposed
from tests.messages import fields
from tests.programs import runs
from tests.robolang.cli.commands import robolang

FOLDER = Path(__file__).parents[2] / "programs" / "wrist"
MOVES = {"e1": (0, -10, 45, -55, -65, 85), "e2": (25, 15, 0, -45, 10, 35), "e3": (-15, -10, 0, 30, -10, 50)}


def run(name: str, folder: Path = FOLDER, **options):
    if folder == FOLDER and not options:
        return runs.run(f"wrist/{name}.rbl")
    session = Session(load_project(folder / f"{name}.rbl"), **options)
    return session, session.run()


@pytest.fixture(scope="module", params=MOVES)
def done(request):
    return request.param, *run(request.param)


@pytest.mark.physics
def test_the_move_ends_as_taught_on_its_line_with_the_scheduled_servo(done):
    name, session, result = done
    assert result.ok and session.project.diagnostics == ()
    move = result.report["statements"][-1]
    assert np.degrees(result.log["q_link"][-1]) == pytest.approx(MOVES[name], abs=0.02)
    assert np.abs(np.degrees(result.log["q_plan"][-1]) - MOVES[name]).max() < 1e-9
    assert move["path_deviation_mm"] < 0.3
    assert move["tool_error_mm"] < 0.35
    sent = np.flatnonzero(result.log["number"] == 20)
    planned = result.log["q_cmd"][np.minimum(sent + 16, len(result.log["t"]) - 1)][::8]
    places = session.controller.tool_poses(planned)[:, :3, 3]
    assert session.record.statements[-1].path.deviation(places).max() < 1e-9


@pytest.mark.physics
def test_the_event_of_the_wrist_is_in_the_report_and_the_log(done):
    name, _, result = done
    event, mode, t = result.report["statements"][-1]["wrist"], result.log["wrist_mode"], result.log["t"]
    on = np.flatnonzero(mode == 1)
    assert event["start_s"] == pytest.approx(t[on[0]])
    assert event["end_s"] == pytest.approx(t[on[-1]] + 0.001)
    assert set(np.diff(on)) == {1}  # once, from the switch on
    assert event["condition"] in ("C1", "C3", "C4", "C6")
    assert event["axis"] in (4, 5, 6)
    assert 0.0 <= event["from_path_pct"] < event["to_path_pct"] <= 100.0
    assert event["posture_deviation_deg"] < (45.0 if name == "e1" else 1.5)
    assert f"{event['posture_deviation_deg']:.1f} deg" in result.report["statements"][-1]["notes"][0]


def copy(tmp_path: Path, name: str, *edits: tuple[str, str, str]) -> Path:
    """Copy a program and the files beside it, each edit (suffix, old, new) applied."""
    for suffix in (".rbl", ".cell.toml", ".points.toml"):
        text = (FOLDER / f"{name}{suffix}").read_text("utf-8")
        for where, old, new in edits:
            if where == suffix:
                assert old in text
                text = text.replace(old, new)
        (tmp_path / f"{name}{suffix}").write_text(text, "utf-8")
    return tmp_path


def test_wrist_keep_as_a_statement_and_as_an_option(tmp_path):
    for new in ("15 WRIST KEEP\n20 MOVE P2", "20 MOVE P2, WRIST KEEP"):
        copy(tmp_path, "e1", (".rbl", "20 MOVE P2", new), (".rbl", ", WRIST AUTO", ""))
        _, result = run("e1", folder=tmp_path, physics=False)
        assert np.degrees(result.log["q_plan"][-1, 3:]) == pytest.approx((125, 65, -95))
        assert not result.log["wrist_mode"].any()
        move = result.report["statements"][-1]
        assert move["wrist"] is None
        assert "wrist" in move["notes"][0]


def test_hold_is_mode_2_and_is_said(tmp_path):
    copy(tmp_path, "seam", (".rbl", "20 SEAM ON, torch\n", ""), (".rbl", "SPEED 150", "SPEED 100"))
    _, result = run("seam", folder=tmp_path, physics=False)
    moves = result.report["statements"]
    assert moves[-1]["wrist"]["held"] in ([], ["TILT"])
    modes = set(result.log["wrist_mode"][result.log["number"] == 50])
    assert modes <= {0, 1, 2}
    assert (2 in modes) == (moves[-1]["wrist"]["held"] == ["TILT"])


@pytest.mark.physics
def test_the_seam_is_followed_and_the_end_is_where_the_sensor_saw_it():
    session, result = run("seam")
    assert result.ok
    weld = result.report["statements"][2]
    assert weld["seam"]["sensor"] == "TORCH"
    assert 5.5 < weld["seam"]["largest_mm"] < 6.2
    assert 1.9 < weld["seam"]["largest_deg"] < 2.05
    assert weld["seam"]["lost_readings"] > 10
    assert weld["path_deviation_mm"] < 0.3  # from the line that the sensor saw
    rows = np.flatnonzero(result.log["number"] == 30)
    last, deviation = result.log["q_plan"][rows[-1]], result.log["seam_deviation"][rows[-1]]
    taught = session.controller.tool_poses(np.radians(MOVES["e2"]))
    np.testing.assert_allclose(session.controller.tool_poses(last), superposed(taught, deviation), atol=1e-9)
    assert np.abs(np.degrees(last) - MOVES["e2"]).max() < 15.0
    assert not result.log["seam_deviation"][result.log["number"] == 50].any()


@pytest.mark.parametrize(
    ("edit", "code", "said"),
    [
        ((".cell.toml", "lost = 0.05", "lost = 0.05\nmost_mm = 3"), "RBL524", "3 mm"),
        ((".cell.toml", "lost = 0.05", "lost = 1.0"), "RBL525", "104 ms"),
        ((".cell.toml", "[0, 5, -3, 0, 0, 2]", "[0, 0, 900, 0, 0, 0]\nmost_mm = 1000"), "RBL526", ""),
    ],
)
def test_a_seam_that_cannot_be_followed_stops_the_arm_on_its_path_at_the_line(tmp_path, edit, code, said):
    copy(tmp_path, "seam", edit)
    session, result = run("seam", folder=tmp_path, physics=False)
    assert not result.ok
    alarm = result.report["alarms"][0]
    assert (alarm["code"], alarm["number"], alarm["category"]) == (code, 30, 1)
    assert set(said.split()) <= fields(alarm["message"])
    spec = session.controller.spec
    t, q = result.log["t"], result.log["q_cmd"]
    assert t[-1] > alarm["time_s"]
    assert np.abs(np.diff(q[-4:], axis=0)).max() < 1e-12  # it stands
    assert (np.abs(np.diff(q, axis=0)) / 0.001 <= spec.per_axis("limits", "speed") * 1.25).all()


def test_a_stop_from_outside_during_a_tracked_move_ends_at_rest_on_the_seam():
    project = load_project(FOLDER / "seam.rbl")

    class Stop(Observer):
        def cycle_done(self, time_us):
            if time_us > 1_500_000:
                session.request_stop()

    session = Session(project, physics=False, observer=Stop())
    result = session.run()
    assert [alarm["code"] for alarm in result.report["alarms"]] == ["RBL530"]
    log = result.log
    rows = np.flatnonzero(log["t"] > 1.5)
    tool = session.controller.tool_poses(log["q_cmd"][rows])[:, :3, 3]
    path = session.record.statements[-1].path
    off = path.deviation(tool - log["seam_deviation"][rows, :3])
    assert off.max() < 0.1 * MM
    assert np.abs(np.diff(log["q_cmd"][-4:], axis=0)).max() < 1e-12
    _, dq = log["q_cmd"], np.diff(log["q_cmd"], axis=0) / 0.001
    assert np.abs(np.diff(dq, axis=0) / 0.001).max() < np.radians(4000.0)


def test_the_lamp_is_in_the_progress_lines_of_the_command(tmp_path):
    shown = robolang("run", FOLDER / "e1.rbl", "--no-physics").stderr
    assert "[WRIST]  MOVE P2" in shown
    held = robolang("run", FOLDER / "seam.rbl", "--no-physics").stderr
    assert "(number 30) [WRIST]  MOVE P2" in held


def test_two_runs_under_a_noisy_sensor_give_the_same_log():
    logs = [run("seam", physics=False)[1].log for _ in range(2)]
    for name, values in logs[0].items():
        np.testing.assert_array_equal(values, logs[1][name])
