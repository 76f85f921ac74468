"""Joint moves: synchronised, straight in joint space, at the limits and never beyond, to the solution meant."""

import math

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import inverse
from runtime.motion.cartesian_planner import FOLLOWS, MovePlan
from runtime.motion.commands import MoveJoint
from runtime.motion.joint_planner import changed
from tests.campaign import size
from tests.messages import fields
from tests.runtime.motion.motions import ROBOTS, TOOL, bench, limits_broken

DEG = math.pi / 180.0


def ways(name: str) -> list[tuple[np.ndarray, np.ndarray]]:
    """Moves of one joint, of all, short, long."""
    spec, random = bench(name).spec, np.random.default_rng(1)
    found = []
    for share in (0.01, 0.1, 0.5, 0.95):
        start, end = random.uniform(spec.lower, spec.upper, (2, spec.n))
        found.append((start, start + share * (end - start)))
    found.append((bench(name).home(), bench(name).home() + np.eye(spec.n)[2] * 0.4))
    return found


def plan(name: str, start: np.ndarray, shape: str = "jerk", override: float = 1.0, **options) -> MovePlan:
    return bench(name, shape).planner.plan(start, MoveJoint(**options), TOOL, override)


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("shape", ["jerk", "trapezoid"])
@pytest.mark.parametrize("options", [{}, {"speed": 0.3, "acceleration": 0.5}, {"duration": 2.5}])
def test_all_joints_start_and_end_together_and_go_straight_in_joint_space(name, shape, options):
    for start, end in ways(name):
        found = plan(name, start, shape, q_end=end, **options)
        np.testing.assert_array_equal(found.q[0], start)
        np.testing.assert_array_equal(found.q[-1], end)
        shares = (found.q - start)[:, np.abs(end - start) > 1e-9] / (end - start)[np.abs(end - start) > 1e-9]
        np.testing.assert_allclose(shares, np.broadcast_to(found.s[:, None], shares.shape), atol=1e-9)
        assert (np.diff(found.s) > 0.0).all()
        assert limits_broken(bench(name, shape), found.q) == []


@pytest.mark.parametrize("name", ROBOTS)
def test_a_long_move_reaches_the_speed_limit_of_the_slowest_joint_to_one_per_cent(name):
    robot = bench(name)
    start, end = (robot.spec.lower + share * (robot.spec.upper - robot.spec.lower) for share in (0.05, 0.95))
    _, dq, ddq = np.abs(robot.at_the_servo(plan(name, start, q_end=end).q)).max(axis=1)
    assert (dq / robot.speed).max() > 0.99
    assert (ddq / robot.acceleration).max() > 0.9


@pytest.mark.parametrize("share", [0.1, 0.5])
def test_speed_acceleration_and_override_are_shares_of_the_limits(share):
    robot = bench("puma560")
    start, end = (robot.spec.lower + part * (robot.spec.upper - robot.spec.lower) for part in (0.1, 0.9))
    for options in ({"speed": share}, {"override": share}):
        _, dq, _ = np.abs(robot.at_the_servo(plan("puma560", start, q_end=end, **options).q)).max(axis=1)
        assert (dq / robot.speed).max() == pytest.approx(share, rel=0.01)
    _, _, ddq = np.abs(robot.at_the_servo(plan("puma560", start, q_end=end, acceleration=share).q)).max(axis=1)
    assert (ddq / robot.acceleration).max() == pytest.approx(share, rel=0.06)
    fast, slow = (
        np.abs(robot.at_the_servo(plan("puma560", start, q_end=end, override=o).q)[2]).max(axis=0) for o in (1.0, share)
    )
    assert (slow / fast).min() > 1.4 * share  # an override leaves the acceleration as it is, but for its time to rise


def test_time_is_kept_or_said_to_be_too_short():
    robot = bench("irb2400")
    q = robot.home()
    found = plan("irb2400", q, q_end=q + 0.2, duration=3.0)
    assert (len(found.q) - 1) * robot.profile.period_s == pytest.approx(3.0)
    assert found.notes == ()
    short = plan("irb2400", q, q_end=q + 0.2, duration=0.1)
    assert {"TIME", "0.1", "s"} <= fields(short.notes[0])
    assert (len(plan("irb2400", q, q_end=q + 0.2, duration=3.0, override=0.5).q) - 1) == 750


def test_a_move_to_where_the_arm_stands_needs_no_cycle_and_has_no_path():
    q = bench("puma560").home()
    found = plan("puma560", q, q_end=q)
    assert (len(found.q), len(found.notes), found.path, found.wrist) == (1, 1, None, None)
    assert (plan("puma560", q, q_end=q + 0.1).modes == FOLLOWS).all()


@pytest.mark.parametrize("name", ROBOTS)
def test_a_pose_is_reached_in_the_configuration_of_the_start_where_that_can_be_in_least_time(name):
    """Against all solutions of all whole turns, listed without the planner."""
    robot, random = bench(name), np.random.default_rng(2)
    spec = robot.spec
    for _ in range(size(40, 10)):
        start, meant = random.uniform(spec.lower, spec.upper, (2, spec.n))
        X = robot.tool(meant)
        found = robot.planner.joints.end(start, MoveJoint(X_world_tool=X), TOOL)
        np.testing.assert_allclose(robot.tool(found), X, atol=1e-9)
        best, kept_best, here = math.inf, math.inf, robot.kinematics.branch_of(start)
        for solution in robot.kinematics.solutions(X @ inverse(TOOL), start):
            for turns in np.ndindex(*([3] * spec.n)):
                q = solution.q + 2.0 * np.pi * (np.array(turns) - 1)
                if (q >= spec.lower).all() and (q <= spec.upper).all():
                    time = float((np.abs(q - start) / robot.speed).max())
                    best = min(best, time)
                    kept_best = min(kept_best, time if solution.branch == here else math.inf)
        expected = kept_best if kept_best < math.inf else best
        assert float((np.abs(found - start) / robot.speed).max()) == pytest.approx(expected, abs=1e-9)


def test_where_only_another_configuration_is_in_range_the_soonest_of_all_is_taken():
    """J5 keeps its sign only with J4 or J6 out of their ranges."""
    robot = bench("irb2400")
    q = robot.home()
    meant = q.copy()
    meant[4] = -q[4]
    command = MoveJoint(X_world_tool=robot.tool(meant), configuration=())
    assert changed(robot.kinematics, q, robot.planner.joints.end(q, command, TOOL), command) == ()
    forced = MoveJoint(X_world_tool=robot.tool(meant), configuration=("FLIP",))
    end = robot.planner.joints.end(q, forced, TOOL)
    assert changed(robot.kinematics, q, end, command) == (("NOFLIP", "FLIP"),)
    assert changed(robot.kinematics, q, end, forced) == ()  # asked for
    assert changed(robot.kinematics, q, end, MoveJoint(q_end=end)) == ()  # joint angles say all


@pytest.mark.parametrize("j5", [0.0, 1e-16, -1e-16, 0.001 * DEG, -0.001 * DEG])
def test_a_straight_wrist_is_in_both_configurations_whatever_rounding_says(j5):
    """The soonest solution has the sign of J5 that needs no half turn of J4."""
    robot = bench("puma560")
    q, meant = robot.home(), robot.home()
    q[4] = j5
    for end in (40.0, -40.0):
        meant[4] = end * DEG
        command = MoveJoint(X_world_tool=robot.tool(meant))
        np.testing.assert_allclose(robot.planner.joints.end(q, command, TOOL), meant, atol=1e-9)
        assert changed(robot.kinematics, q, meant, command) == ()


def test_configuration_and_turns_of_a_taught_point_are_kept():
    robot = bench("irb2400")
    q = robot.home()
    X = robot.tool(q)
    here = robot.kinematics.branch_of(q)
    near = robot.planner.joints.end(q, MoveJoint(X_world_tool=X), TOOL)
    np.testing.assert_allclose(near, q, atol=1e-9)
    flipped = "FLIP" if "NOFLIP" in str(here) else "NOFLIP"
    other = robot.planner.joints.end(q, MoveJoint(X_world_tool=X, configuration=(flipped,)), TOOL)
    assert str(robot.kinematics.branch_of(other)).split()[2] == flipped
    np.testing.assert_allclose(robot.tool(other), X, atol=1e-9)
    turned = robot.planner.joints.end(
        q, MoveJoint(X_world_tool=X, configuration=tuple(str(here).split()), turns=(0, 0, 0, 0, 0, 1)), TOOL
    )
    np.testing.assert_allclose(turned - q, [0.0, 0.0, 0.0, 0.0, 0.0, 2.0 * np.pi], atol=1e-9)
    joints = robot.planner.joints.end(q, MoveJoint(X_world_tool=X, q_end=q + 0.1), TOOL)
    np.testing.assert_array_equal(joints, q + 0.1)  # joint angles say more than a pose


def refusal(name: str, start: np.ndarray, **options) -> Fault:
    with pytest.raises(Fault) as caught:
        plan(name, start, **options)
    return caught.value


def test_refusals_name_what_is_wrong():
    robot = bench("puma560")
    q = robot.home()
    far = robot.tool(q).copy()
    far[0, 3] += 3.0
    fault = refusal("puma560", q, X_world_tool=far)
    assert fault.code == "RBL410"
    assert "puma560" in fields(fault.message)
    beyond = q.copy()
    beyond[0] = 170.0 * DEG
    fault = refusal("puma560", q, q_end=beyond)
    assert fault.code == "RBL411"
    assert {"J1", "160", "deg", "10"} <= fields(fault.message)
    assert refusal("puma560", q, q_end=q * np.nan).code == "RBL411"
    fault = refusal("puma560", q, X_world_tool=robot.tool(q), configuration=("LEFTY", "UPSIDE"))
    assert fault.code == "RBL412"
    assert {"LEFTY", "UPSIDE"} <= fields(fault.message)
    fault = refusal("puma560", q, X_world_tool=robot.tool(q), turns=(1,))
    assert fault.code == "RBL411"
    assert "J1" in fields(fault.message)


@pytest.mark.parametrize(
    "options",
    [
        {"speed": 0.0},
        {"speed": 1.01},
        {"speed": math.nan},
        {"acceleration": 0.0},
        {"acceleration": 2.0},
        {"duration": 0.0},
        {"duration": math.inf},
        {"duration": 601.0},
    ],
)
def test_impossible_options_are_refused(options):
    q = bench("puma560").home()
    assert refusal("puma560", q, q_end=q + 0.1, **options).code == "RBL404"


def test_a_move_to_nowhere_and_a_zone_that_is_none_are_misuse():
    with pytest.raises(ValueError, match=r"joint.*pose"):
        MoveJoint()
    for zone in (-1e-9, math.nan, math.inf):
        with pytest.raises(ValueError, match="zone"):
            MoveJoint(q_end=np.zeros(6), zone=zone)
