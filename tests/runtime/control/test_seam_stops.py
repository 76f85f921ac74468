"""Stops, acknowledgement and arms of other sizes under a seam sensor, on the ideal arm."""

import dataclasses

import numpy as np
import pytest

from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import pose
from runtime.core.units import DEG, MM
from runtime.motion.commands import MoveLinear
from runtime.motion.seam import SeamLimits, SeamTracker
from runtime.plant.rigid_plant import RigidPlant
from runtime.robot.files.loader import load_builtin
from runtime.settings.profile import Profile, ServoOptions
from tests.runtime.control.test_controller import CELL as BUILTIN

SPEC = load_builtin("irb2400")
TOOL = pose((0.0, 0.0, 0.2))
P1, P2 = np.radians([0.0, 0.0, 0.0, 10.0, 40.0, 20.0]), np.radians([20.0, 0.0, 0.0, 10.0, 40.0, 20.0])
PROFILE = Profile(servo=ServoOptions(friction_compensation=0.0))


def controller(spec=SPEC, home=P1) -> Controller:
    cell = dataclasses.replace(BUILTIN, robot=spec, home=home)
    return Controller(spec, RigidPlant(spec, cell, PROFILE.tick_s), PROFILE, TOOL)


def tracker(read, limits: SeamLimits | None = None) -> SeamTracker:
    return SeamTracker("torch", limits or SeamLimits(), PROFILE.period_s, read)


def move(robot: Controller, q: np.ndarray, speed: float = 0.1) -> None:
    robot.move(MoveLinear(X_world_tool=robot.kinematics.forward(q) @ TOOL, q_end=q, speed=speed))


def cycles(robot: Controller, count: int) -> int:
    """Run at most so many cycles while the command moves or an alarm is seen to its end; return how many ran."""
    for k in range(count):
        if not robot.cycle() or not robot.moving:
            return k
    return count


def noisy(mm: float, seed: int = 3):
    random = np.random.default_rng(seed)
    return lambda way, travel: np.append(random.normal(size=3) * mm * MM, np.zeros(3))


@pytest.mark.parametrize(("mm", "filter_s"), [(0.05, 0.0), (0.5, 0.0), (1.0, 0.01), (3.0, 0.04)])
def test_a_stop_under_a_noisy_sensor_stops(mm, filter_s):
    """What has been sent may be rougher than the joints' limits; the stop must not wait for that to pass."""
    robot = controller()
    robot.seam(tracker(noisy(mm), SeamLimits(filter_s=filter_s)))
    move(robot, P2)
    cycles(robot, 125)
    if not robot.alarms:
        robot.alarm("RBL530", "stopped")
    assert cycles(robot, 200) < 60
    assert robot.halted


def test_a_fault_of_the_sensor_stops_within_a_short_way():
    robot = controller()
    random = np.random.default_rng(1)

    def read(way, travel):
        return np.append([0.0, 0.0, 0.03 * (way > 0.03)], random.normal(size=3) * 0.1 * DEG)

    robot.seam(tracker(read))
    move(robot, P2)
    while not robot.alarms:
        robot.cycle()
    at = robot.tool_poses(np.array(robot.areas.ina))[:3, 3]
    cycles(robot, 300)
    assert robot.alarms[0].code == "RBL524"
    assert np.linalg.norm(robot.tool_poses(np.array(robot.areas.ina))[:3, 3] - at) < 0.02


def stopped(read=lambda way, travel: np.array([0, 0, 3 * MM, 0, 0, 0]), after: int = 150) -> Controller:
    """Return a controller whose tracked move was stopped and acknowledged."""
    robot = controller()
    robot.seam(tracker(read))
    move(robot, P2)
    cycles(robot, after)
    robot.alarm("RBL530", "stopped")
    cycles(robot, 300)
    assert robot.halted
    robot.acknowledge()
    return robot


@pytest.mark.parametrize("after", [60, 150, 420])
def test_after_a_stop_the_next_move_begins_where_the_arm_stands_and_without_the_sensor(after):
    robot = stopped(after=after)
    before = np.array(robot.areas.ina)
    assert not robot.seam_deviation.any()
    move(robot, P1)
    first = robot.recorder.tick
    while robot.moving:
        assert robot.cycle(), robot.alarms
    q = robot.signals()["q_cmd"][first:]
    np.testing.assert_allclose(q[0], before, atol=1e-12)
    acceleration = np.abs(np.diff(q, 2, axis=0)).max(axis=0) / 0.001**2
    assert (acceleration <= SPEC.per_axis("limits", "acceleration") * 1.01).all()
    np.testing.assert_allclose(q[-1], P1, atol=1e-9)


def test_a_fault_of_a_sensor_is_raised_once():
    robot = controller()
    robot.seam(tracker(lambda way, travel: np.array([0, 0, 0.5 * (way > 0.02), 0, 0, 0])))
    move(robot, P2)
    while not robot.halted:
        robot.cycle()
    assert [alarm.code for alarm in robot.alarms] == ["RBL524"]
    robot.acknowledge()
    move(robot, P1)
    while robot.moving:
        assert robot.cycle(), robot.alarms
    assert robot.alarms == []


def test_a_move_right_after_an_acknowledgement_is_not_stopped_for_old_dynamics():
    robot = stopped()
    move(robot, P1)
    for _ in range(40):
        assert robot.cycle(), robot.alarms


def test_wrist_mode_is_that_of_the_motion_also_around_a_stop():
    robot = controller(home=np.radians((15, 20, 10, -70, -10, 5)))
    move(robot, np.radians((25, 15, 0, -45, 10, 35)), speed=0.069)
    cycles(robot, 300)
    assert robot.wrist_mode == 1
    robot.halt()
    robot.alarm("RBL530", "stopped")
    assert robot.wrist_mode == 0
    robot.acknowledge()
    for _ in range(3):
        robot.cycle()
    mode = robot.signals()["wrist_mode"]
    assert mode[2000] == 1
    assert mode[-1] == 0


def test_consecutive_moves_on_one_seam_keep_the_deviation():
    robot = controller()
    robot.seam(tracker(lambda way, travel: np.array([0, 0, 4 * MM, 0, 0, 0])))
    for q in (P2, P1):
        move(robot, q)
        while robot.moving:
            assert robot.cycle(), robot.alarms
        at = robot.tool_poses(np.array(robot.areas.ina))[:3, 3]
        np.testing.assert_allclose(at, (robot.kinematics.forward(q) @ TOOL)[:3, 3] + [0, 0, 4 * MM], atol=1e-6)
    assert np.abs(np.diff(robot.signals()["q_cmd"], axis=0)).max() < 1e-3


def test_an_end_that_is_out_of_reach_for_a_moment_is_not_lost():
    """With a deviation of 5 m neither the point nor the end has a solution; the end stays where it was."""
    robot = controller()
    robot.seam(tracker(lambda way, travel: np.zeros(6)))
    move(robot, P2)
    cycles(robot, 100)
    going = robot.requests.interpolator.seam
    end = going.q_end.copy()
    going._tracker.freeze(np.array([0.0, 0.0, 5.0, 0.0, 0.0, 0.0]))
    with pytest.raises(Fault, match="RBL526"):
        going.row(120)
    np.testing.assert_array_equal(going.q_end, end)
