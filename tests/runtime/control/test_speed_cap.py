"""A controller under a speed cap: moves, blends and given rows, commanded and as the arm moves."""

import dataclasses

import numpy as np
import pytest

from robolang.execution.rig import fitted, plant_of
from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.motion.commands import MoveJoint
from runtime.motion.speed_cap import MANUAL_SPEED, PLANNED
from runtime.settings.profile import Profile
from tests.runtime.control.script import CELL, EMPTY, at, controller
from tests.runtime.control.test_given_rows import turned

EMPTY_CELL = dataclasses.replace(CELL, obstacles=(), parts=())
"""Nothing to touch."""


def fastest(robot: Controller, signal: str) -> float:
    """The largest speed of tool point and flange over the ticks of the log, from places alone, m/s."""
    q = robot.signals()[signal]
    flange = robot.kinematics.forward(q)
    places = np.stack([(flange @ robot.X_flange_tool)[:, :3, 3], flange[:, :3, 3]])
    return float(np.linalg.norm(np.diff(places, axis=1), axis=2).max()) * 1000.0


def finish(robot: Controller) -> None:
    while robot.moving:
        assert robot.cycle(), robot.alarms


@pytest.mark.parametrize("plant", ["rigid", pytest.param("mujoco", marks=pytest.mark.physics)])
def test_moves_under_the_cap_keep_it_as_commanded_and_as_the_arm_moves(plant):
    profile = fitted(Profile(), plant == "mujoco")
    robot = Controller(
        CELL.robot, plant_of(EMPTY_CELL, profile.tick_s, plant == "mujoco"), profile, CELL.hand.X_flange_tool
    )
    robot.load(EMPTY)
    while robot.time_us < 100_000:
        robot.cycle()
    robot.speed_cap = MANUAL_SPEED
    robot.move_chain([at(400, -200, 300, 0.8, zone=0.05), at(400, 200, 300, 0.8, zone=0.05), at(350, 0, 400, 0.8)])
    finish(robot)
    robot.move(MoveJoint(q_end=np.array(robot.areas.ina) + np.array([0.8, 0.0, 0.2, 0.2, 0.2, 0.2])))
    finish(robot)
    assert 0.9 * PLANNED * MANUAL_SPEED < fastest(robot, "q_cmd") <= PLANNED * MANUAL_SPEED
    assert fastest(robot, "q_link") <= MANUAL_SPEED


def test_given_rows_over_the_cap_are_refused_checked_or_not_and_nothing_moves():
    robot = controller("rigid")
    robot.speed_cap = MANUAL_SPEED
    rows = turned(robot, 20.0)
    for checked in (True, False):
        with pytest.raises(Fault) as refused:
            robot.play(rows, checked)
        assert refused.value.code == "RBL404" and not robot.moving
    robot.play(turned(robot, 20.0, cycles=400))
    finish(robot)
    assert fastest(robot, "q_cmd") <= PLANNED * MANUAL_SPEED
    robot.speed_cap = None
    robot.play(turned(robot, 20.0))


def test_a_step_of_the_reference_is_refused_under_a_cap():
    robot = controller("rigid")
    robot.speed_cap = MANUAL_SPEED
    with pytest.raises(Fault) as refused:
        robot.jump(np.array(robot.areas.ina))
    assert refused.value.code == "RBL404"


@pytest.mark.parametrize("cap", [0.0, -1.0, np.nan, np.inf])
def test_a_cap_that_is_no_speed_is_refused(cap):
    robot = controller("rigid")
    with pytest.raises(ValueError):
        robot.speed_cap = cap
    assert robot.speed_cap is None


def test_the_cap_is_part_of_a_snapshot():
    robot = controller("rigid")
    robot.speed_cap = MANUAL_SPEED
    before = robot.snapshot()
    robot.speed_cap = None
    robot.restore(before)
    assert robot.speed_cap == MANUAL_SPEED
