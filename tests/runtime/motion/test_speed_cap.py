"""The cap on speed: tool point and flange keep below it at every servo tick, and without it nothing changes."""

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import pose, rotation_about
from runtime.motion.commands import MoveJoint, MoveLinear
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.motion_planner import ChainFault
from runtime.motion.speed_cap import MANUAL_SPEED, PLANNED, SpeedCap, speeds
from tests.campaign import size
from tests.messages import fields
from tests.runtime.motion.motions import ROBOTS, TOOL, bench, limits_broken, random_chain

FINE = FineInterpolator(8, 8e-3, np.zeros(6))


def fastest(robot, rows, X=TOOL):
    """The largest speeds (2,) of tool point and flange: differences of their places at the ticks, over the ticks."""
    q = robot.at_the_servo(rows)[0]
    flange = robot.kinematics.forward(q)
    tick_s = robot.profile.period_s / robot.profile.ticks_per_cycle
    places = np.stack([(flange @ X)[:, :3, 3], flange[:, :3, 3]])
    return np.linalg.norm(np.diff(places, axis=1), axis=2).max(axis=1) / tick_s


@pytest.mark.parametrize("name", ROBOTS)
def test_the_speeds_are_those_of_the_places(name):
    robot, random, h = bench(name), np.random.default_rng(3), 1e-6
    q, dq = random.uniform(-1.0, 1.0, (2, 20, robot.spec.n))
    places = [robot.kinematics.forward(q + k * h * dq) for k in (-1.0, 1.0)]
    expected = [
        np.linalg.norm((places[1] @ X - places[0] @ X)[:, :3, 3], axis=1) / (2.0 * h) for X in (TOOL, np.eye(4))
    ]
    np.testing.assert_allclose(speeds(robot.kinematics, q, dq, TOOL), expected, rtol=1e-6)


@pytest.mark.parametrize("name", ROBOTS)
def test_every_chain_keeps_the_cap_and_ends_where_it_would(name):
    robot, random = bench(name), np.random.default_rng(44)
    reached = 0
    for _ in range(size(60, 4)):
        start, commands = random_chain(robot, random, 3)
        full = robot.planner.chain(start, commands, TOOL)
        capped = robot.planner.chain(start, commands, TOOL, cap=MANUAL_SPEED)
        most = fastest(robot, capped.setpoints).max()
        assert most <= MANUAL_SPEED * PLANNED
        assert not limits_broken(robot, capped.setpoints)
        for part, whole in zip(capped.parts, full.parts, strict=True):
            np.testing.assert_allclose(part.plan.q[-1], whole.plan.q[-1], atol=1e-9)
        reached += most >= 0.98 * MANUAL_SPEED * PLANNED  # not merely slow
    assert reached > 0


def test_without_a_cap_and_under_one_that_is_not_passed_the_rows_are_the_same_bytes():
    robot = bench("puma560")
    start, commands = random_chain(robot, np.random.default_rng(5), 3)
    full = robot.planner.chain(start, commands, TOOL)
    assert robot.planner.chain(start, commands, TOOL, cap=100.0).q.tobytes() == full.q.tobytes()


def test_the_flange_rules_where_the_tool_turns_about_its_point():
    robot = bench("puma560")
    far = pose((0.0, 0.0, 0.4))
    X = robot.kinematics.forward(robot.home()) @ far
    command = MoveLinear(X_world_tool=pose(X[:3, 3], X[:3, :3] @ rotation_about(np.array([0.0, 1.0, 0.0]), 0.6)))
    full = robot.planner.plan(robot.home(), command, far)
    capped = robot.planner.plan(robot.home(), command, far, cap=0.1)
    assert fastest(robot, full.q, far)[1] > 0.1
    tool, flange = fastest(robot, capped.q, far)
    assert tool < 1e-4 and 0.08 < flange <= 0.1 * PLANNED
    assert fields(capped.notes[-1]) >= {"100", "mm/s"}


def test_a_programmed_time_grows_and_a_move_to_where_the_arm_is_stays_nothing():
    robot = bench("puma560")
    end = robot.home() + np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    capped = robot.planner.plan(robot.home(), MoveJoint(q_end=end, duration=1.0), TOOL, cap=MANUAL_SPEED)
    assert (len(capped.q) - 1) * robot.profile.period_s > 2.0
    nothing = robot.planner.plan(robot.home(), MoveJoint(q_end=robot.home()), TOOL, cap=MANUAL_SPEED)
    assert len(nothing.q) == 1


def test_a_cap_that_no_speed_keeps_is_refused_at_its_move():
    robot = bench("puma560")
    commands = [MoveJoint(q_end=robot.home()), MoveJoint(q_end=robot.home() + 0.5)]
    with pytest.raises(ChainFault) as refused:
        robot.planner.chain(robot.home(), commands, TOOL, cap=1e-9)
    assert refused.value.code == "RBL404" and refused.value.index == 1


@pytest.mark.parametrize("speed", [np.nan, 1.01 * PLANNED])
def test_a_motion_over_the_cap_is_refused_with_its_numbers(speed):
    robot = bench("puma560")
    cap = SpeedCap(most=0.25, kinematics=robot.kinematics, fine=FINE, X_flange_tool=TOOL)
    q = np.array([robot.home()])
    dq = np.array([[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
    dq *= 0.25 * speed / speeds(robot.kinematics, q, dq, TOOL).max()
    motion = np.stack([q, dq, dq])
    assert not cap.kept(motion)
    with pytest.raises(Fault) as refused:
        cap.check(motion)
    assert refused.value.code == "RBL404" and fields(refused.value.message) >= {"237.5", "mm/s"}
