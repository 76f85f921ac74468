"""An exact half turn of the tool: which of its two directions a move takes, and that rounding does not decide it.

Rotations are checked by quaternions, which the planner does not use.
"""

import itertools
import math

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import (
    Array,
    inverse,
    pose,
    principal_axes,
    rotation_about,
    rotation_from_rpy,
    rpy_from_rotation,
)
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import Command, MoveArc, MoveJoint, MoveLinear
from runtime.motion.path import LinePath
from runtime.settings.profile import Profile, WristOptions
from tests.runtime.motion.motions import TOOL, Bench, bench

DEG = math.pi / 180.0
ROUNDING = (0.0, 1e-16, -1e-16, 1e-12, -1e-12, 1e-9, -1e-9)
AXES = ((0, 0, 1), (1, 0, 0), (0, 1, 0), (0.5, math.sqrt(0.75), 0), (1, 1, 0), (1, -1, 1))


def quaternion(R: Array) -> Array:
    """Return w, x, y, z of a rotation, by Shepperd's four cases."""
    t = np.array([np.trace(R), *np.diag(R)])
    k = int(np.argmax(t))
    if k == 0:
        found = [1 + t[0], R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]
    else:
        i, j, m = k - 1, k % 3, (k + 1) % 3
        found = [0.0] * 4
        found[0] = R[m, j] - R[j, m]
        found[1 + i], found[1 + j], found[1 + m] = 1 + 2 * R[i, i] - t[0], R[j, i] + R[i, j], R[m, i] + R[i, m]
    return np.array(found) / np.linalg.norm(found)


def turned_by(R_a: Array, R_b: Array) -> float:
    """Return the angle between two orientations, rad, from the dot product of their quaternions."""
    return 2.0 * math.acos(min(1.0, abs(float(quaternion(R_a) @ quaternion(R_b)))))


def plan(robot: Bench, q: Array, command: Command) -> MovePlan:
    return robot.planner.plan(q, command, TOOL)


def with_j6(robot: Bench, degrees: float) -> Array:
    q = robot.home()
    q[5] = degrees * DEG
    return q


def half_turned(robot: Bench, q: Array, k: tuple[float, ...] = (0, 0, 1), by: float = math.pi) -> Array:
    """Return the pose of the tool at q (n,), turned about its own axis k."""
    axis = np.array(k) / np.linalg.norm(k)
    return robot.tool(q) @ pose(rotation=rotation_about(axis, by))


@pytest.mark.parametrize("k", AXES)
@pytest.mark.parametrize("order", [1.0, -1.0])
def test_both_directions_of_a_half_turn_end_there_and_rounding_does_not_decide_which_is_first(k, order):
    axis = order * np.array(k) / np.linalg.norm(k)
    firsts = []
    for rpy in ([0.3, -0.4, 2.0], [math.pi, 0.0, 0.5], [0.0, math.pi / 2.0, -1.0]):
        R = rotation_from_rpy(rpy)
        for noise in ROUNDING:
            R_end = R @ rotation_about(axis, math.pi + noise)
            found = principal_axes(R, R_end)
            assert len(found) == 2
            for each, angle in found:
                np.testing.assert_allclose(rotation_about(each, angle) @ R, R_end, atol=1e-12)
            np.testing.assert_allclose(found[0][0], -found[1][0], atol=1e-12)
            firsts.append(R.T @ found[0][0])
    np.testing.assert_allclose(firsts, np.tile(firsts[0], (len(firsts), 1)), atol=1e-8)


@pytest.mark.parametrize("away", [2e-5, -2e-5])
def test_what_is_no_exact_half_turn_takes_the_shorter_turn(away):
    R = rotation_from_rpy([0.3, -0.4, 2.0])
    ((axis, angle),) = principal_axes(R, rotation_about([0, 0, 1], math.pi + away) @ R)
    np.testing.assert_allclose(axis, [0, 0, -math.copysign(1.0, away)], atol=1e-9)
    assert angle == pytest.approx(math.pi - 2e-5)


@pytest.mark.parametrize("name", ["puma560", "irb2400", "manutec_r3"])
@pytest.mark.parametrize("rounding", [0.0, 1e-12, -1e-12])
def test_where_one_direction_leaves_the_range_the_other_is_taken(name, rounding):
    robot = bench(name)
    upper = robot.spec.upper[5] / DEG
    for start in (upper - 20.0, 20.0 - upper):
        q = with_j6(robot, start)
        found = plan(robot, q, MoveLinear(X_world_tool=half_turned(robot, q, by=math.pi + rounding)))
        assert found.q[-1, 5] / DEG == pytest.approx(start - math.copysign(180.0, start), abs=1e-6)
        np.testing.assert_allclose(found.q[:, :5], np.tile(q[:5], (len(found.q), 1)), atol=1e-9)


@pytest.mark.parametrize(("start", "end"), [(40.0, -140.0), (-40.0, 140.0), (0.0, None), (0.004, None), (-0.004, None)])
@pytest.mark.parametrize("rounding", ROUNDING)
def test_where_both_keep_the_range_the_end_farther_from_its_ends_is_taken_or_always_the_same(start, end, rounding):
    robot = bench("puma560")
    q = with_j6(robot, start)
    for kind in (MoveLinear, MoveJoint):
        found = plan(robot, q, kind(X_world_tool=half_turned(robot, q, by=math.pi + rounding))).q[-1, 5] / DEG
        assert found == pytest.approx(start + 180.0 if end is None else end, abs=1e-6)


def test_of_more_joints_only_those_count_in_which_the_ends_differ():
    """J5 is 15 deg from its end in either direction: nearer than J6, which decides."""
    robot = bench("puma560")
    q = with_j6(robot, 30.0)
    q[4] = robot.spec.upper[4] - 15.0 * DEG
    assert plan(robot, q, MoveLinear(X_world_tool=half_turned(robot, q))).q[-1, 5] / DEG == pytest.approx(-150.0)


@pytest.mark.parametrize("wrist", ["keep", "auto"])
def test_a_half_turn_to_taught_joint_angles_goes_the_direction_that_ends_there(wrist):
    robot = bench("puma560")
    for start in (-80.0, 0.0, 80.0):
        for way in (180.0, -180.0):
            q, end = with_j6(robot, start), with_j6(robot, start + way)
            found = plan(robot, q, MoveLinear(X_world_tool=robot.tool(end), q_end=end, wrist=wrist))
            np.testing.assert_allclose(found.q[-1], end, atol=1e-8)
            assert found.wrist is None


def test_all_pairs_of_half_turned_orientations_run_where_one_direction_keeps_the_range():
    """Twenty-four orientations, each half a turn from others about one of three axes; from everywhere in the range."""
    robot = bench("puma560")
    random = np.random.default_rng(13)
    ran = 0
    for k, j6 in itertools.product(AXES[:3], (-250.0, -190.0, -100.0, -10.0, 10.0, 100.0, 190.0, 250.0)):
        q = with_j6(robot, j6)
        q[:3] += random.uniform(-0.1, 0.1, 3)
        X = half_turned(robot, q, k)
        inside = []
        for axis, angle in principal_axes(robot.tool(q)[:3, :3], X[:3, :3]):
            R = rotation_about(axis, np.linspace(0.0, angle, 200)) @ robot.tool(q)[:3, :3]
            rows = robot.kinematics.inverse_branch(
                pose(np.tile(X[:3, 3], (200, 1)), R) @ inverse(TOOL), robot.kinematics.branch_of(q), q
            )
            rows = np.unwrap(rows, axis=0) + 0.0
            steady = np.isfinite(rows).all() and np.abs(np.diff(rows, axis=0)).max() < 0.3
            inside.append(steady and bool((robot.kinematics.limit_margin(rows) > 1e-3).all()))
        try:
            found = plan(robot, q, MoveLinear(X_world_tool=X))
        except Fault:
            assert not any(inside), (k, j6)
            continue
        ran += any(inside)
        np.testing.assert_allclose(robot.tool(found.q[-1]), X, atol=1e-9)
        if any(inside):
            turned = [turned_by(R, X[:3, :3]) for R in robot.tool(found.q)[:, :3, :3]]
            np.testing.assert_allclose(turned, math.pi * (1.0 - found.s), atol=1e-6)
    assert ran >= 8


def test_a_loop_over_a_pallet_turns_the_same_in_every_row():
    """Poses as a program computes them, through the angles of RX RY RZ; the wrist stays on one side of its middle."""
    robot = bench("puma560")
    q = with_j6(robot, 60.0)
    turns = []
    for row in range(12):
        start = plan(robot, q, MoveJoint(X_world_tool=pose((0.0, 0.01 * row, 0.0)) @ robot.tool(q))).q[-1]
        X = robot.tool(start)
        again = pose(X[:3, 3], rotation_from_rpy(rpy_from_rotation(X[:3, :3])))
        end = plan(robot, start, MoveLinear(X_world_tool=again @ pose(rotation=rotation_about([0, 0, 1], math.pi))))
        back = plan(robot, end.q[-1], MoveLinear(X_world_tool=again))
        turns.append((end.q[-1, 5] - start[5], back.q[-1, 5] - end.q[-1, 5]))
    np.testing.assert_allclose(turns, np.tile([-math.pi, math.pi], (12, 1)), atol=1e-6)


def test_an_arc_makes_a_half_turn_in_the_direction_that_keeps_the_range():
    robot = bench("puma560")
    for start in (200.0, -200.0):
        q = with_j6(robot, start)
        X = robot.tool(q)
        via, end = (pose(X[:3, 3] + np.array(by)) for by in ((0.02, 0.02, 0.0), (0.04, 0.0, 0.0)))
        end[:3, :3] = half_turned(robot, q)[:3, :3]
        found = plan(robot, q, MoveArc(X_via=via, X_world_tool=end))
        assert (found.q[-1, 5] - q[5]) * start < 0.0
        assert (robot.kinematics.limit_margin(found.q) > 0.0).all()


def test_three_angles_that_are_each_interpolated_have_every_direction_as_well():
    robot = bench("puma560")
    profile = Profile(wrist=WristOptions(posture="rpy"))
    from runtime.motion.motion_planner import MotionPlanner

    planner = MotionPlanner(robot.spec, robot.kinematics, profile)
    for start in (200.0, -200.0):
        q = with_j6(robot, start)
        found = planner.plan(q, MoveLinear(X_world_tool=half_turned(robot, q)), TOOL)
        assert (robot.kinematics.limit_margin(found.q) > 0.0).all()
    paths = LinePath.candidates(pose(), pose(rotation=rotation_from_rpy([math.pi, 0.2, -math.pi])), "rpy")
    assert sorted(np.sign(path.rpy[1][[0, 2]]).tolist() for path in paths) == [[-1, -1], [-1, 1], [1, -1], [1, 1]]


@pytest.mark.parametrize("rounding", ROUNDING)
def test_angles_that_a_program_reads_have_no_sign_by_rounding(rounding):
    R = rotation_from_rpy([math.pi + rounding, 0.0, -math.pi + rounding])
    np.testing.assert_allclose(rpy_from_rotation(R)[[0, 2]], [math.pi, math.pi], atol=1e-8)


@pytest.mark.parametrize("rounding", ROUNDING)
@pytest.mark.parametrize(("near", "end"), [(-170.0, -180.0), (170.0, 180.0), (0.0, 180.0)])
def test_a_point_taught_without_turns_at_half_a_turn_is_the_nearer_of_both_ends(near, end, rounding):
    robot = bench("puma560")
    q_point = with_j6(robot, 180.0 + rounding / DEG)
    command = MoveJoint(X_world_tool=robot.tool(q_point), turns=(0,) * 6)
    assert plan(robot, with_j6(robot, near), command).q[-1, 5] / DEG == pytest.approx(end, abs=1e-6)
