"""Controlled stops, latching and acknowledging, on the ideal arm."""

import numpy as np
import pytest

from runtime.motion.fine import FineInterpolator
from runtime.motion.stop import stopping_rows
from tests.loop.test_controller import CELL, carried_payload, controller, down, signals


def running(cycles: int):
    robot = controller()
    robot.load(carried_payload())
    plan = robot.move(down(robot, -0.18))
    for _ in range(cycles):
        assert robot.cycle()
    return robot, plan


@pytest.mark.parametrize("cycles", [1, 5, 20, 45, 70])
def test_a_stop_ends_at_rest_on_the_path_within_joint_limits(cycles):
    robot, plan = running(cycles)
    robot.alarm("RBL530", "stopped")
    while robot.cycle():
        pass
    log = signals(robot)
    p = robot.tool_poses(log["q_cmd"])[:, :3, 3]
    assert plan.path.deviation(p).max() < 1e-5
    along = (p - plan.path.X_start[:3, 3]) @ (plan.path.X_end - plan.path.X_start)[:3, 3]
    assert np.diff(along).min() > -1e-6  # never backwards, but for the fine interpolation
    assert np.abs(log["dq_cmd"][-1]).max() < 1e-12
    for name, limit in (("dq_cmd", "speed"), ("ddq", "acceleration")):
        values = log["dq_cmd"] if name == "dq_cmd" else np.diff(log["dq_cmd"], axis=0) / 1e-3
        assert (np.abs(values) <= CELL.robot.per_axis("limits", limit) * 1.001).all()
    assert robot.recorder.cycle < len(plan.q) or cycles == 70


def test_a_stop_in_the_middle_is_as_short_as_the_joint_limits_allow():
    _, plan = running(45)
    limits = CELL.robot.per_axis("limits", "speed"), CELL.robot.per_axis("limits", "acceleration")
    fine = FineInterpolator(8, 8e-3, plan.q[0])
    rows = stopping_rows(plan.q, 45, fine, *limits)
    weaker = stopping_rows(plan.q, 45, fine, limits[0], limits[1] * 0.3)
    assert 3 <= len(rows) < len(weaker) < len(plan.q) - 45


def test_an_alarm_latches_until_it_is_acknowledged_and_then_the_arm_moves_from_where_it_stands():
    robot, _ = running(30)
    robot.alarm("RBL530", "stopped")
    with pytest.raises(RuntimeError, match="still stopping"):
        robot.acknowledge()
    with pytest.raises(RuntimeError, match="latched"):
        robot.move(down(robot))
    while robot.cycle():
        pass
    ticks = robot.recorder.tick
    assert not robot.cycle()
    assert robot.recorder.tick == ticks
    assert not robot.moving
    with pytest.raises(RuntimeError, match="latched"):
        robot.hand(True)
    robot.acknowledge()
    assert robot.alarms == []
    before = signals(robot)["q_fb"][-1]
    assert robot.cycle()
    after = signals(robot)
    assert np.abs(after["q_cmd"][-1] - before).max() < 1e-4
    assert np.abs(after["q_fb"][-1] - before).max() < 1e-4
    plan = robot.move(down(robot, 0.05))
    while robot.moving:
        assert robot.cycle()
    np.testing.assert_array_equal(robot.areas.ina, plan.q[-1])


def test_category_0_stops_at_once():
    robot, _ = running(30)
    ticks = robot.recorder.tick
    robot.alarm("RBL515", "the encoder of J1 jumped", 0)
    assert robot.halted
    assert not robot.cycle()
    assert robot.recorder.tick == ticks
    assert robot.alarms[0].category == 0
    robot.acknowledge()
    assert not robot.moving  # the interrupted move is forgotten
    q = np.array(robot.areas.ina)
    assert robot.cycle()
    np.testing.assert_array_equal(robot.areas.ina, q)
