"""The planner: the sampled path is straight, holds every joint limit where the servo sees it, or is refused."""

import math
import re

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import inverse, pose, pose_from_xyzrpy, rotation_about
from runtime.motion.cartesian_planner import CartesianPlanner, MovePlan
from runtime.motion.commands import MoveLinear
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.settings.profile import Profile
from tests.messages import fields

SPEC = load_builtin("puma560")
KINEMATICS = Kinematics(SPEC)
PROFILE = Profile()
TOOL = pose((0.0, 0.0, 0.1137))
DOWN = (math.pi, 0.0, math.pi)
HOME_POSE = pose_from_xyzrpy((0.48, -0.22, 0.84, *DOWN))
SPEED = SPEC.per_axis("limits", "speed")
ACCELERATION = SPEC.per_axis("limits", "acceleration")


def joints_at(X_world_tool: np.ndarray) -> np.ndarray:
    solutions = KINEMATICS.solutions(X_world_tool @ inverse(TOOL))
    return max(solutions, key=lambda solution: solution.limit_margin).q


HOME = joints_at(HOME_POSE)


def plan(x, y, z, rpy=DOWN, start=HOME, profile=PROFILE, **options) -> MovePlan:
    command = MoveLinear(X_world_tool=pose_from_xyzrpy((x, y, z, *rpy)), **options)
    return CartesianPlanner(SPEC, KINEMATICS, profile).plan(start, command, TOOL)


def seconds(result: MovePlan) -> float:
    return (len(result.q) - 1) * PROFILE.period_s


def at_the_servo(result: MovePlan) -> np.ndarray:
    return FineInterpolator(8, PROFILE.period_s, result.q[0]).expand(result.q)


MOVES = [
    {"x": 0.48, "y": -0.22, "z": 0.64},
    {"x": 0.48, "y": 0.22, "z": 0.64, "rpy": (math.pi, 0.0, -math.pi / 2)},
    {"x": 0.30, "y": 0.40, "z": 0.90, "rpy": (math.pi, 0.3, 1.0)},
    {"x": 0.48, "y": -0.22, "z": 0.84, "rpy": (math.pi, 0.0, 2.0)},
]


@pytest.mark.parametrize("move", MOVES)
@pytest.mark.parametrize("shape", ["jerk", "trapezoid"])
def test_every_set_point_is_on_the_line_and_the_end_is_exact(move, shape):
    result = plan(**move, profile=Profile(speed_shape=shape))
    X = KINEMATICS.forward(result.q) @ TOOL
    assert result.path.deviation(X[:, :3, 3]).max() < 1e-9  # 1e-6 mm
    np.testing.assert_allclose(X[-1], result.path.X_end, atol=1e-11)
    np.testing.assert_array_equal(result.q[0], HOME)
    assert (np.diff(result.s) >= 0.0).all()


@pytest.mark.parametrize("move", MOVES)
@pytest.mark.parametrize("options", [{}, {"speed": 1.0}, {"duration": 0.4}, {"acceleration": 0.3, "speed": 1.0}])
def test_no_joint_passes_its_speed_or_acceleration_at_any_tick(move, options):
    _, dq, ddq = np.abs(at_the_servo(plan(**move, **options)))
    assert (dq <= SPEED * (1 + 1e-9)).all()
    assert (ddq <= ACCELERATION * (1 + 1e-9)).all()


def past_the_waist(**options) -> MovePlan:
    """A line that passes 250 mm from axis 1: the waist has to turn fast in its middle."""
    start = joints_at(pose_from_xyzrpy((0.25, -0.35, 0.8, *DOWN)))
    return plan(0.25, 0.35, 0.8, start=start, **options)


def used(result: MovePlan) -> float:
    _, dq, ddq = np.abs(at_the_servo(result)).max(axis=1)
    return np.maximum((dq / SPEED).max(), np.sqrt((ddq / ACCELERATION).max()))


@pytest.mark.parametrize("options", [{"speed": 1.0}, {"speed": 0.8, "acceleration": 0.5}, {"duration": 1.3}])
def test_a_move_that_is_too_fast_is_slowed_until_it_just_holds_the_limit_and_says_so(options):
    result = past_the_waist(**options)
    assert 0.98 < used(result) <= 1.0
    assert result.slowdown is not None
    assert result.slowdown.axis == 0
    assert result.slowdown.factor > 1.03
    assert {"J1", "151", "deg/s"} <= fields(result.notes[0])


def test_a_time_that_is_too_short_is_said():
    result = past_the_waist(duration=1.3)
    assert {"TIME", "1.3", "s", f"{seconds(result):.3f}"} <= fields(result.notes[1])


def test_a_slow_move_is_not_slowed():
    result = plan(0.48, -0.22, 0.64, speed=0.05)
    assert result.slowdown is None
    assert result.notes == ()


def test_speed_is_reached_on_a_long_move_and_never_passed():
    result = plan(0.48, 0.22, 0.84, speed=0.2)
    v = np.linalg.norm(np.diff((KINEMATICS.forward(result.q) @ TOOL)[:, :3, 3], axis=0), axis=1) / PROFILE.period_s
    assert v.max() <= 0.2 * (1 + 1e-9)
    assert v.max() > 0.199


@pytest.mark.parametrize("duration", [1.0, 1.2345, 3.0])
def test_time_is_kept_in_whole_cycles(duration):
    result = plan(0.48, -0.22, 0.64, duration=duration)
    assert seconds(result) == pytest.approx(math.ceil(duration / 0.008) * 0.008)


def test_a_move_to_where_the_tool_stands_needs_no_cycle():
    result = plan(0.48, -0.22, 0.84)
    assert len(result.q) == 1
    assert len(result.notes) == 1


def test_a_pure_rotation_turns_about_the_standing_tool_point():
    result = plan(0.48, -0.22, 0.84, rpy=(math.pi, 0.0, 2.0))
    p = (KINEMATICS.forward(result.q) @ TOOL)[:, :3, 3]
    assert np.abs(p - HOME_POSE[:3, 3]).max() < 1e-11
    assert len(result.q) > 20


def refusal(*args, **kwargs) -> Fault:
    with pytest.raises(Fault) as caught:
        plan(*args, **kwargs)
    return caught.value


def test_out_of_reach_names_the_place_on_the_path():
    fault = refusal(1.4, 0.0, 0.8)
    assert fault.code == "RBL410"
    assert "%" in fields(fault.message)
    assert "puma560" in fault.message


def test_past_a_joint_limit_names_joint_limit_and_excess():
    fault = refusal(0.48, -0.22, 0.84, rpy=(math.pi, math.pi / 2.2, 0.0), wrist="keep")
    assert fault.code == "RBL411"
    joint = int(fault.message[1]) - 1
    assert f"{math.degrees(SPEC.lower[joint]):g} deg" in fault.message or (
        f"{math.degrees(SPEC.upper[joint]):g} deg" in fault.message
    )
    assert " by " in fault.message


def test_a_line_through_the_straight_wrist_is_refused_before_it_moves():
    """From J5 = -40 to J5 = +40 deg with the arm at rest: the wrist would have to pass J5 = 0."""
    q_start = HOME.copy()
    q_end = HOME.copy()
    q_start[4], q_end[4] = math.radians(-40.0), math.radians(40.0)
    X_end = KINEMATICS.forward(q_end) @ TOOL
    with pytest.raises(Fault) as caught:
        CartesianPlanner(SPEC, KINEMATICS, PROFILE).plan(q_start, MoveLinear(X_world_tool=X_end, wrist="keep"), TOOL)
    assert caught.value.code in ("RBL411", "RBL412")


def past_the_straight_wrist(bend_deg: float, **options) -> MovePlan:
    """Turn the hand by 50 deg so that in the middle J5 comes within ``bend_deg`` of the singularity."""
    q_middle = HOME.copy()
    q_middle[3:] = np.radians([30.0, -bend_deg, 20.0])
    X_middle = KINEMATICS.forward(q_middle) @ TOOL
    across = X_middle[:3, :3] @ rotation_about([0, 0, 1], math.radians(-20.0)) @ np.array([1.0, 0.0, 0.0])
    ends = [X_middle.copy(), X_middle.copy()]
    for X, angle in zip(ends, (-25.0, 25.0), strict=True):
        X[:3, :3] = rotation_about(across, math.radians(angle)) @ X[:3, :3]
    start = KINEMATICS.inverse_branch(ends[0] @ inverse(TOOL), KINEMATICS.branch_of(q_middle), q_middle)
    command = MoveLinear(X_world_tool=ends[1], wrist="keep", **options)
    return CartesianPlanner(SPEC, KINEMATICS, PROFILE).plan(start, command, TOOL)


def test_a_line_past_the_wrist_singularity_is_slowed_far_from_it_and_refused_close_to_it():
    slowed = past_the_straight_wrist(8.0, speed=1.0)
    assert slowed.slowdown is not None
    assert 1.5 < slowed.slowdown.factor < 2.0  # as a whole it would take 2.3 times its time
    with pytest.raises(Fault) as caught:
        past_the_straight_wrist(0.2, speed=1.0)
    assert caught.value.code == "RBL412"
    place = float(re.search(r"([0-9.]+) %", caught.value.message)[1])
    assert place == pytest.approx(50.0, abs=3.0)


@pytest.mark.parametrize(
    "options",
    [
        {"speed": 0.0},
        {"speed": -1.0},
        {"speed": math.nan},
        {"speed": 5.0},
        {"acceleration": 0.0},
        {"acceleration": 1.5},
        {"duration": 0.0},
        {"duration": math.inf},
        {"duration": math.nan},
    ],
)
def test_impossible_options_are_refused(options):
    assert refusal(0.48, -0.22, 0.64, **options).code == "RBL404"


@pytest.mark.parametrize("beyond_deg", [0.01, 1.0])
def test_the_range_is_kept_to_a_hair_at_the_servo(beyond_deg):
    """J1 turned to just inside its range is planned, to just outside is refused, whatever lies between set-points."""

    def end(angle: float) -> np.ndarray:
        q = HOME.copy()
        q[0] = angle
        return KINEMATICS.forward(q) @ TOOL

    start = HOME.copy()
    start[0] = SPEC.upper[0] - 0.3
    planner = CartesianPlanner(SPEC, KINEMATICS, Profile(speed_shape="trapezoid"))
    inside = planner.plan(start, MoveLinear(X_world_tool=end(SPEC.upper[0] - math.radians(0.05))), TOOL)
    assert at_the_servo(inside)[0][:, 0].max() <= SPEC.upper[0]
    with pytest.raises(Fault, match="RBL411: J1"):
        planner.plan(start, MoveLinear(X_world_tool=end(SPEC.upper[0] + math.radians(beyond_deg))), TOOL)
