"""Controlled stops, latching and acknowledging, on the ideal arm."""

import numpy as np
import pytest

from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.stop import stopping_rows
from tests.faults.devices import BadPlant
from tests.runtime.control.test_controller import CELL, carried_payload, controller, down, signals


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
    with pytest.raises(RuntimeError, match="stopping"):
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


def stopped_with_drive(kind: str, axis: int, cycles: int = 30):
    """Return a robot on a moving path whose drive of an axis goes wrong in the tick in which it is told to stop."""
    robot, _ = running(cycles)
    robot.plant = BadPlant(robot.plant, kind, axis, 0)
    robot.alarm("RBL530", "stopped")
    while robot.cycle():
        pass
    return robot


def test_an_axis_that_does_not_follow_its_stop_is_named_and_the_brakes_hold_at_once():
    robot = stopped_with_drive("dead", 1)
    first, second = robot.alarms
    assert (first.code, second.code, second.axis) == ("RBL530", "RBL518", 1)
    assert second.category == 0
    assert robot.halted
    log = signals(robot)
    error = np.abs(log["q_cmd"][-1] - log["q_fb"][-1])[1]
    assert error > np.radians(3.0)  # three times the limit of the following error, 1 deg and more in motion


class Trembling:
    """A plant whose second joint never comes to rest: it turns to and fro at ``speed`` rad/s."""

    def __init__(self, good, speed: float) -> None:
        self.good, self.speed, self.tick = good, speed, 0

    def __getattr__(self, name: str):
        return getattr(self.good, name)

    def step(self, tau) -> bool:
        went = self.good.step(tau)
        self.tick += 1
        self.good.q[1] += self.speed * 1e-3 * (1 if self.tick // 2 % 2 else -1)
        return went


@pytest.mark.parametrize(("speed", "waits"), [(0.0, False), (0.3, True)])
def test_the_brakes_hold_an_arm_that_stands_and_one_that_does_not_after_half_a_second(speed, waits):
    robot = controller()
    robot.plant = Trembling(robot.plant, speed)
    robot.load(carried_payload())
    for _ in range(20):
        robot.cycle()
    robot.alarm("RBL530", "stopped")  # the command stands already
    began = robot.time_us
    while robot.cycle():
        pass
    assert [alarm.code for alarm in robot.alarms] == ["RBL530"]
    lasted = robot.time_us - began
    assert 500_000 <= lasted <= 520_000 if waits else lasted <= 40_000


def test_after_an_acknowledgement_an_arm_holds_where_it_stands_and_is_watched_anew():
    robot = stopped_with_drive("dead", 1)
    stood = np.array(robot.plant.q)
    robot.plant = robot.plant.good
    robot.plant.dq[:] = 0.0
    robot.acknowledge()
    assert (robot.alarms, robot.halted, robot.moving) == ([], False, False)
    for _ in range(60):
        assert robot.cycle()
    assert robot.alarms == []
    assert np.abs(robot.plant.q - stood).max() < np.radians(0.1)
    robot.acknowledge()  # nothing to acknowledge: nothing happens
    assert robot.cycle()


def test_a_state_that_is_no_number_cannot_be_acknowledged():
    robot, _ = running(10)
    robot.plant.dq[2] = np.nan
    while robot.cycle():
        pass
    assert robot.alarms[0].code == "RBL510"
    with pytest.raises(RuntimeError, match="valid"):
        robot.acknowledge()
