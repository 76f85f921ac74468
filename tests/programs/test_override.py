"""OVERRIDE in programs on the ideal arm: every speed of every kind of move, in the run as in the rehearsal."""

import numpy as np
import pytest

from robolang.execution.dry_run import rehearse
from robolang.execution.session import Session
from robolang.project.project import load_project
from robolang.pulse_tables.export import ExportRequest, export
from tests.campaign import some

HAND = "LOAD (0, 0, 60), 0.8"
MOVES: dict[str, tuple[str, str, float]] = {
    "joints": ("JOINT(-100, 80, -180, 0, -70, 0)", "MOVEJ JOINT(100, 60, -160, 20, -60, 40)", np.inf),
    "joints in a time": (
        "JOINT(-100, 80, -180, 0, -70, 0)",
        "MOVEJ JOINT(100, 60, -160, 20, -60, 40), TIME 0.1",
        np.inf,
    ),
    "line": ("P1", "MOVE P1 + (0, 300, 100), SPEED 150", 0.15),
    "line that joints slow": ("P1", "MOVE P1 * (0, 200, 0, 0, -60, 90), SPEED 1000, WRIST KEEP", 1.0),
    "line in too short a time": ("P1", "MOVE P1 + (0, 300, 100), TIME 0.1", 1.0),
    "turn": ("P1", "MOVE P1 * (0, 0, 0, 0, 0, 80), SPEED 1000", 1.0),
    "arc": ("P1", "MOVEC P1 + (0, 150, 100), P1 + (0, 300, 0), SPEED 150", 0.15),
    "approach": ("P1", "APPROACH P1 + (0, 300, 0), 200, SPEED 150", 0.15),
    "depart": ("P1", "DEPART 250, SPEED 150", 0.15),
}
"""Of each kind where it starts, the move, and the speed of the tool that it asks for, m/s."""


def loaded(tmp_path, text):
    path = tmp_path / "p.rbl"
    path.write_text(text)
    project = load_project(path)
    assert project.ok, project.diagnostics
    return project


def ran(tmp_path, text):
    session = Session(loaded(tmp_path, text), physics=False)
    result = session.run()
    assert result.ok, result.report["alarms"]
    return session, result


def speeds(session, result, line):
    """The largest speeds of the move of a line: each joint rad/s, tool m/s, turning rad/s."""
    log = result.log
    q = log["q_cmd"][log["number"] == line][::8]
    X = session.controller.tool_poses(q)
    turn = np.einsum("kji,kjl->kil", X[:-1, :3, :3], X[1:, :3, :3])
    angle = np.arccos(np.clip((np.trace(turn, axis1=1, axis2=2) - 1.0) / 2.0, -1.0, 1.0))
    joints, tool = np.abs(np.diff(q, axis=0)).max(axis=0), np.linalg.norm(np.diff(X[:, :3, 3], axis=0), axis=1).max()
    return np.array([*joints, tool, angle.max()]) / 8e-3


@pytest.mark.parametrize("share", some([0.5, 0.25], 1))
@pytest.mark.parametrize("kind", MOVES)
def test_every_speed_keeps_its_share_and_one_uses_it(tmp_path, kind, share):
    start, move, asked = MOVES[kind]
    session, result = ran(tmp_path, f"5 {HAND}\n10 MOVEJ {start}\n20 OVERRIDE {100 * share}\n30 {move}\n")
    robot = session.project.cell.robot
    most = share * np.array(
        [*robot.per_axis("limits", "speed"), asked, robot.path.rotation_speed if asked < np.inf else np.inf]
    )
    used = speeds(session, result, 30) / most
    assert 0.97 < used.max() <= 1.001
    dq = np.abs(result.log["dq_cmd"][result.log["number"] == 30]).max(axis=0)
    assert (dq <= most[:6] * 1.001).all()


@pytest.mark.parametrize("kind", MOVES)
def test_the_rehearsal_takes_as_long_as_the_run(tmp_path, kind):
    start, move, _ = MOVES[kind]
    session, result = ran(tmp_path, f"{HAND}\nMOVEJ {start}\nOVERRIDE 30\n{move}\n")
    assert rehearse(session.project).total_us == pytest.approx(result.report["sim_time_s"] * 1e6, abs=8000.0)


def test_a_joint_move_takes_twice_the_time_at_its_speed(tmp_path):
    """J1 goes 200 deg at its 151 deg/s, or at half of it.

    At a constant speed v that takes way / v; gaining and losing it adds v / a and the time in which a builds up.
    """
    start, move = "JOINT(-100, 80, -180, 0, -70, 0)", "MOVEJ JOINT(100, 80, -180, 0, -70, 0)"
    times = []
    for share in (100, 50):
        session, result = ran(tmp_path, f"5 {HAND}\n10 MOVEJ {start}\n20 OVERRIDE {share}\n30 {move}\n")
        limits = session.project.cell.robot.axes[0].limits
        dq = np.abs(result.log["dq_cmd"][result.log["number"] == 30][:, 0])
        assert 0.99 < dq.max() / (limits.speed * share / 100.0) <= 1.001
        times.append(result.report["statements"][-1]["planned_s"])
    whole, ramps = np.radians(200.0) / limits.speed, 0.5 * limits.speed / limits.acceleration
    assert times[1] - times[0] == pytest.approx(whole - ramps, abs=0.03)
    assert times[1] > 1.6 * times[0]


def test_a_time_becomes_longer(tmp_path):
    for move in ("MOVE P1 + (0, 300, 0)", "MOVEJ P1 + (0, 300, 0)", "MOVEC P1 + (0, 150, 50), P1 + (0, 300, 0)"):
        _, result = ran(tmp_path, f"{HAND}\nMOVEJ P1\nOVERRIDE 40\n{move}, TIME 2\n")
        assert result.report["statements"][-1]["planned_s"] == pytest.approx(5.0, abs=0.008)


def test_an_override_that_changes_within_a_chain(tmp_path):
    """Each move has its own; in a corner the speed goes over from one to the other. The arm does not stop for it."""
    text = (
        f"5 {HAND}\n10 MOVEJ P1\n20 MOVEJ P1 + (0, 200, 0), ZONE 50\n30 OVERRIDE 20\n"
        "40 MOVEJ P1 + (0, 200, 150), ZONE 50\n50 OVERRIDE 100\n60 MOVEJ P1 + (0, 0, 150)\n"
    )
    session, result = ran(tmp_path, text)
    log, limits = result.log, session.project.cell.robot.per_axis("limits", "speed")
    of = {line: (np.abs(log["dq_cmd"][log["number"] == line]) / limits).max(axis=1) for line in (20, 40, 60)}
    middle = len(of[40]) // 2
    assert of[40][middle - 50 : middle + 50].max() <= 0.2 * 1.001
    assert min(of[20].max(), of[60].max()) > 0.3
    between = (log["number"][1:] != log["number"][:-1]) & np.isin(log["number"][1:], (40, 60))
    standing = np.abs(log["dq_cmd"][1:][between]).max(axis=1)
    assert (standing > 1e-3).all()
    assert rehearse(session.project).total_us == pytest.approx(result.report["sim_time_s"] * 1e6, abs=8000.0)


@pytest.mark.parametrize(
    "move",
    [
        "MOVE P1 + (0, 300, 0), SPEED 150",
        "MOVE P1 + (0, 300, 0), TIME 3",
        "MOVE P1 + (-100, 500, 0), SPEED 1000, WRIST KEEP",
    ],
)
def test_pulses_are_slower_as_the_run_is(tmp_path, move):
    whole, half = (
        export(loaded(tmp_path, f"MOVE P1\nOVERRIDE {share}\n{move}\n"), ExportRequest()).moves[-1].pulses
        for share in (100, 50)
    )
    fast, slow = (np.array(pulses.highest_hz(0.01)) for pulses in (whole, half))
    assert 0.48 < slow.max() / fast.max() < 0.52
    assert half.count > 1.4 * whole.count
