"""Jogs as they are typed, their settings, and their plans for a live controller."""

import math

import numpy as np
import pytest

from robolang.teaching.jog_remarks import remarks
from robolang.teaching.jogging import (
    ANGULAR_STEPS,
    FRAMES,
    LINEAR_STEPS,
    JogRequest,
    JogSettings,
    axes_of,
    plan_jog,
    read_jog,
)
from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import pose, rotation_about
from runtime.core.units import DEG, MM
from runtime.motion.speed_cap import MANUAL_SPEED
from tests.messages import fields
from tests.runtime.control.script import controller


def moved(robot: Controller, request: JogRequest, settings: JogSettings, X_user=None):
    """Poses of the tool before and after a jog that the controller plays."""
    before = robot.tool_poses(np.array(robot.areas.ina))
    robot.speed_cap = MANUAL_SPEED
    robot.play(plan_jog(robot, request, settings, X_user).rows)
    while robot.moving:
        assert robot.cycle(), robot.alarms
    return before, robot.tool_poses(np.array(robot.areas.ina))


@pytest.mark.parametrize(
    ("text", "axis", "amount"),
    [
        ("J3 +5", "J3", 5.0),
        ("X -10", "X", -10.0),
        ("rz 2", "RZ", 2.0),
        ("Z - 0.5", "Z", -0.5),
        ("y .25", "Y", 0.25),
        ("J6 1e2", "J6", 100.0),
    ],
)
def test_what_is_typed(text, axis, amount):
    assert read_jog(text, 6) == JogRequest(axis=axis, amount=amount)


@pytest.mark.parametrize(
    ("text", "code", "names"),
    [
        ("", "RBL720", {"RZ"}),
        ("J7 5", "RBL720", {"J7", "J6"}),
        ("J0 5", "RBL720", {"J0"}),
        ("W 5", "RBL720", {"W"}),
        ("X", "RBL720", {"X", "mm"}),
        ("RX five", "RBL720", {"five"}),
        ("X nan", "RBL720", {"nan"}),
        ("X inf", "RBL720", {"inf"}),
        ("X 1e999", "RBL720", {"1e999"}),
        ("X 1_0", "RBL720", {"1_0"}),
        ("X 1 2 x", "RBL720", {"12x"}),
        ("X 0", "RBL404", {"X", "0", "mm"}),
        ("X 20000", "RBL404", {"20000", "10000", "mm"}),
        ("J1 721", "RBL404", {"721", "720", "deg"}),
    ],
)
def test_what_is_no_jog_is_refused(text, code, names):
    with pytest.raises(Fault) as refused:
        read_jog(text, 6)
    said = fields(f"{refused.value.message} {refused.value.hint}")
    assert refused.value.code == code
    assert all(name in said or name in refused.value.message + refused.value.hint for name in names)


def test_an_arm_of_seven_axes_has_seven_joints_to_jog():
    assert axes_of(7)[6] == "J7" and read_jog("J7 5", 7).unit == "deg"


def test_settings_go_through_frames_and_steps_and_end_there():
    settings = JogSettings()
    assert settings.frame == "world" and settings.speed == 25.0
    seen = [settings := settings.next_frame() for _ in FRAMES]
    assert [each.frame for each in seen] == ["base", "tool", "user", "joint", "world"]
    for angular, steps in ((False, LINEAR_STEPS), (True, ANGULAR_STEPS)):
        axis = "RX" if angular else "X"
        assert settings.stepped(-9, angular=angular).step(axis) == steps[0]
        assert settings.stepped(9, angular=angular).step(axis) == steps[-1]
    assert settings.stepped(1, angular=True).step("J1") == 10.0
    assert settings.with_frame("TOOL").frame == "tool"


@pytest.mark.parametrize("percent", [0.0, 0.99, 100.01, -5.0, math.nan, math.inf])
def test_a_speed_out_of_range_is_refused(percent):
    with pytest.raises(Fault) as refused:
        JogSettings().with_speed(percent)
    assert refused.value.code == "RBL404"
    with pytest.raises(ValueError):
        JogSettings(speed=percent)


def test_a_frame_that_is_none_is_refused():
    with pytest.raises(Fault) as refused:
        JogSettings().with_frame("table")
    assert refused.value.code == "RBL720" and "table" in fields(refused.value.message)
    with pytest.raises(ValueError):
        JogSettings(linear_step=2.0)


@pytest.mark.parametrize("direction", range(3))
@pytest.mark.parametrize("frame", FRAMES)
def test_a_straight_jog_goes_along_the_axis_of_its_frame(frame, direction):
    robot = controller("rigid")
    X_user = pose((0.1, 0.2, 0.0), rotation_about(np.array([0.0, 0.6, 0.8]), 0.7))
    axes = {"tool": robot.tool_poses(np.array(robot.areas.ina)), "user": X_user}.get(frame, np.eye(4))
    settings = JogSettings(frame=frame, speed=100.0)
    before, after = moved(robot, JogRequest(axis="XYZ"[direction], amount=10.0), settings, X_user)
    np.testing.assert_allclose(after[:3, 3] - before[:3, 3], 10 * MM * axes[:3, direction], atol=1e-7)
    np.testing.assert_allclose(after[:3, :3], before[:3, :3], atol=1e-6)


@pytest.mark.parametrize("direction", range(3))
@pytest.mark.parametrize("frame", ["world", "tool"])
def test_a_turn_goes_about_the_axis_of_its_frame_through_the_tool_point(frame, direction):
    robot = controller("rigid")
    axes = robot.tool_poses(np.array(robot.areas.ina)) if frame == "tool" else np.eye(4)
    settings = JogSettings(frame=frame, speed=100.0)
    before, after = moved(robot, JogRequest(axis=("RX", "RY", "RZ")[direction], amount=-5.0), settings)
    np.testing.assert_allclose(after[:3, 3], before[:3, 3], atol=1e-7)
    turned = rotation_about(axes[:3, direction], -5.0 * DEG) @ before[:3, :3]
    np.testing.assert_allclose(after[:3, :3], turned, atol=1e-6)


def test_a_joint_is_jogged_in_every_frame():
    for frame in FRAMES:
        robot = controller("rigid")
        q = np.array(robot.areas.ina)
        moved(robot, JogRequest(axis="J2", amount=-3.0), JogSettings(frame=frame))
        np.testing.assert_allclose(np.array(robot.areas.ina) - q, [0.0, -3.0 * DEG, 0.0, 0.0, 0.0, 0.0], atol=1e-12)


def test_the_speed_is_a_share():
    robot = controller("rigid")
    slow, fast = (
        plan_jog(robot, JogRequest(axis="Z", amount=-50.0), JogSettings(speed=speed)) for speed in (10.0, 100.0)
    )
    assert slow.seconds > 4.0 * fast.seconds


def test_a_jog_while_the_arm_moves_is_refused():
    robot = controller("rigid")
    robot.play(plan_jog(robot, JogRequest(axis="Z", amount=-10.0), JogSettings()).rows)
    with pytest.raises(Fault) as refused:
        plan_jog(robot, JogRequest(axis="Z", amount=-10.0), JogSettings())
    assert refused.value.code == "RBL720"


def test_what_ends_a_held_jog_and_slows_it_is_named_with_numbers():
    robot = controller("rigid")
    request = JogRequest(axis="J3", amount=math.inf)
    plan = plan_jog(robot, request, JogSettings(speed=100.0))
    (line,) = remarks(request, plan)
    assert {"J3", f"{robot.spec.upper[2] / DEG:g}", "deg"} <= fields(line)
    typed = JogRequest(axis="Z", amount=-5.0)
    assert remarks(typed, plan_jog(robot, typed, JogSettings())) == ()
    q = np.array(robot.areas.ina)
    q[4] = 0.3 * DEG
    robot.areas.ina = q
    for axis in ("X", "Y"):
        near = JogRequest(axis=axis, amount=5.0)
        for line in remarks(near, plan_jog(robot, near, JogSettings(speed=100.0))):
            assert fields(line) & {"J4", "J6"} and "mm" in fields(line)
