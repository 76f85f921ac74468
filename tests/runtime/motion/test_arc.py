"""Arcs: the circle through three points, the orientation along it, what is no arc; planned at constant speed."""

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.core.faults import Fault
from runtime.core.frames import pose, rotation_about, rotation_angle, rotation_from_rpy
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import MoveArc, MoveLinear
from runtime.motion.path import ArcPath
from runtime.motion.wrist.hold import frames_along
from tests.runtime.motion.motions import ROBOTS, TOOL, bench, limits_broken

S = np.linspace(0.0, 1.0, 101)
angles = st.floats(-3.0, 3.0)


def through(X_start, X_via, X_end) -> ArcPath:
    """The arc over three poses; of two the first."""
    return ArcPath.candidates(X_start, X_via, X_end)[0]


def on_circle(centre, R, radius: float, angle: float) -> np.ndarray:
    return np.array(centre) + R @ (radius * np.array([math.cos(angle), math.sin(angle), 0.0]))


@given(st.tuples(angles, angles, angles), st.floats(0.02, 5.0), st.floats(0.1, 6.2), st.floats(0.2, 0.8))
def test_an_arc_is_on_its_circle_passes_its_via_point_and_ends_where_it_should(rpy, radius, sweep, share):
    R = rotation_from_rpy(rpy)
    start, via, end = (on_circle((0.3, -0.2, 0.8), R, radius, a) for a in (0.0, share * sweep, sweep))
    path = through(pose(start), pose(via), pose(end))
    points = path.points(S)
    np.testing.assert_allclose(points[[0, -1]], [start, end], atol=1e-11)
    assert np.abs(np.linalg.norm(points - path.centre, axis=1) - path.radius).max() < 1e-12
    assert path.sweep == pytest.approx(sweep, abs=1e-6)
    assert path.length == pytest.approx(radius * sweep, rel=1e-6)
    np.testing.assert_allclose(points, [on_circle((0.3, -0.2, 0.8), R, radius, a) for a in S * sweep], atol=1e-9)
    assert path.deviation(via[None])[0] < 1e-11
    assert path.deviation(points).max() < 1e-11


@pytest.mark.parametrize("sweep", [0.5, 3.0, 6.0])
def test_the_orientation_turns_about_one_axis_in_proportion_and_the_via_point_has_no_say(sweep):
    R_start, R_end = rotation_from_rpy([0.1, 0.2, 0.3]), rotation_from_rpy([1.0, -0.5, 2.0])
    places = [on_circle((0.0, 0.0, 0.0), np.eye(3), 0.3, a) for a in (0.0, 0.4 * sweep, sweep)]
    path, other = (
        through(pose(places[0], R_start), pose(places[1], R), pose(places[2], R_end))
        for R in (np.eye(3), rotation_from_rpy([2.0, 1.0, -1.0]))
    )
    X = path.poses(S)
    np.testing.assert_array_equal(X, other.poses(S))
    turned = [rotation_angle(R_start, R) for R in X[:, :3, :3]]
    np.testing.assert_allclose(turned, S * rotation_angle(R_start, R_end), atol=1e-12)
    np.testing.assert_allclose(X[-1, :3, :3], R_end, atol=1e-12)


def test_the_distance_from_an_arc_is_that_of_its_points_and_not_of_the_whole_circle():
    path = through(*(pose((math.cos(a), math.sin(a), 0.0)) for a in (0.0, 0.5, 1.0)))
    points = np.array(
        [[1.3, 0.0, 0.0], [0.5, 0.3, 0.0], [math.cos(0.4), math.sin(0.4), 0.2], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    )
    nearest = [np.linalg.norm(path.points(np.linspace(0, 1, 200_001)) - p, axis=1).min() for p in points]
    np.testing.assert_allclose(path.deviation(points), nearest, atol=1e-8)


@pytest.mark.parametrize(
    ("places", "words"),
    [
        (((0, 0, 0), (0.1, 0, 0), (0.3, 0, 0)), "within 0.0000 mm of one straight line"),
        (((0, 0, 0), (0.1, 4e-7, 0), (0.3, 0, 0)), "within 0.0004 mm"),
        (((0, 0, 0), (0.4, 4e-7, 0), (0.3, 0, 0)), "within 0.0003 mm"),
        (((0, 0, 0), (0, 0, 0), (0.3, 0, 0)), "start and via point of the arc are 0.0000 mm apart"),
        (((0, 0, 0), (0.3, 0, 2e-7), (0.3, 0, 0)), "via point and end of the arc are 0.0002 mm apart"),
        (((0, 0, 0), (0.1, 0.1, 0), (0, 0, 0)), "start and end of the arc"),
        (((0, 0, 0), (math.nan, 0.1, 0), (0.3, 0, 0)), "nan mm"),
    ],
)
def test_points_that_define_no_circle_are_refused_with_how_far_they_are_from_one(places, words):
    with pytest.raises(Fault, match=words) as caught:
        through(*(pose(place) for place in places))
    assert caught.value.code == "RBL416"


def test_a_very_flat_arc_still_keeps_its_digits():
    """A sagitta of 2 um over 300 mm: the centre is five kilometres away."""
    path = through(pose((0.5, 0.0, 0.5)), pose((0.65, 2e-6, 0.5)), pose((0.8, 0.0, 0.5)))
    assert path.radius == pytest.approx(0.15**2 / 2 / 2e-6, rel=1e-3)
    assert path.points(np.array([0.5]))[0, 1] == pytest.approx(2e-6, abs=1e-12)
    np.testing.assert_allclose(path.points(np.array([1.0]))[0], [0.8, 0.0, 0.5], atol=1e-12)


def planned(
    name: str,
    shape: str = "jerk",
    radius: float = 0.12,
    sweep: float = 4.0,
    turn: float = 0.5,
    override: float = 1.0,
    **options,
) -> MovePlan:
    robot = bench(name, shape)
    q = robot.home()
    X = robot.tool(q)
    across = rotation_about([0.0, 1.0, 0.0], math.pi / 2)  # a circle in a vertical plane
    centre = X[:3, 3] - across @ np.array([radius, 0.0, 0.0])
    via, end = (pose(on_circle(centre, across, radius, a), X[:3, :3]) for a in (0.45 * sweep, sweep))
    end[:3, :3] = rotation_about([1.0, 0.0, 0.0], turn) @ end[:3, :3]
    return robot.planner.plan(q, MoveArc(X_via=via, X_world_tool=end, **options), TOOL, override)


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("shape", ["jerk", "trapezoid"])
def test_every_set_point_is_on_the_circle_and_every_limit_is_kept(name, shape):
    found, robot = planned(name, shape, speed=0.3), bench(name, shape)
    X = robot.tool(found.q)
    radius = np.linalg.norm(X[:, :3, 3] - found.path.centre, axis=1)
    assert np.abs(radius - found.path.radius).max() < 1e-9
    assert found.path.deviation(X[:, :3, 3]).max() < 1e-9
    np.testing.assert_allclose(X[-1], found.path.X_end, atol=1e-9)
    np.testing.assert_array_equal(found.q[0], robot.home())
    assert limits_broken(robot, found.q) == []


@pytest.mark.parametrize("name", ROBOTS)
def test_the_speed_is_constant_in_the_middle_of_the_arc(name):
    found, robot = planned(name, speed=0.15, acceleration=0.5), bench(name)
    steps = np.diff(found.s) * found.path.length / robot.profile.period_s
    middle = steps[len(steps) // 3 : -len(steps) // 3]
    assert np.ptp(middle) < 1e-9
    assert middle[0] == pytest.approx(0.15, rel=0.01)  # whole cycles
    assert found.slowdown is None


@pytest.mark.parametrize("radius", [0.01, 0.03, 0.12])
def test_the_acceleration_towards_the_centre_and_along_the_arc_together_keep_the_limit(radius):
    """Measured on the tool points alone: their second differences."""
    robot = bench("irb2400")
    limit = robot.spec.path.acceleration * 0.4
    found = planned("irb2400", radius=radius, turn=0.0, speed=2.0, acceleration=0.4)
    points = robot.tool(found.q)[:, :3, 3]
    felt = np.linalg.norm(np.diff(points, 2, axis=0), axis=1) / robot.profile.period_s**2
    assert felt.max() <= limit * (1 + 1e-6)
    v = np.linalg.norm(np.diff(points, axis=0), axis=1).max() / robot.profile.period_s
    if radius < 0.1:  # a small circle is what limits the speed, and it is nearly used up
        assert v < 0.9 * math.sqrt(limit * radius) * 1.01
        assert v**3 / radius**2 <= robot.spec.path.jerk * 0.4 * 1.01
    else:
        assert felt.max() > 0.75 * limit


def test_time_override_and_default_speed_work_as_on_lines():
    robot = bench("puma560")
    assert (len(planned("puma560", duration=2.0).q) - 1) * robot.profile.period_s == pytest.approx(2.0)
    half = planned("puma560", speed=0.2, override=0.5)
    assert np.diff(half.s).max() * half.path.length / robot.profile.period_s == pytest.approx(0.1, rel=0.005)
    slow = planned("puma560")
    fastest = np.diff(slow.s).max() * slow.path.length / robot.profile.period_s
    assert fastest <= robot.spec.path.default_speed * (1 + 1e-9)


@pytest.mark.parametrize("options", [{"speed": 0.0}, {"speed": 9.0}, {"acceleration": 1.5}, {"duration": math.nan}])
def test_impossible_options_are_refused(options):
    with pytest.raises(Fault, match="RBL404"):
        planned("puma560", **options)


def test_an_arc_out_of_reach_and_one_out_of_range_say_where():
    with pytest.raises(Fault, match=r"RBL410: .*\d %"):
        planned("puma560", radius=0.9, sweep=3.0)
    with pytest.raises(Fault, match=r"RBL411: J\d |RBL412: .*(wrist|J5)"):
        planned("puma560", turn=3.1, wrist="keep")


def test_the_wrist_may_change_on_an_arc_and_refusals_speak_of_an_arc():
    """To the same pose with the other sign of J5: the wrist leaves the posture, the tool point stays on the circle."""
    robot = bench("irb2400")
    q = robot.home()
    X = robot.tool(q)
    end = pose(X[:3, 3] + [0.0, 0.25, 0.0], X[:3, :3])
    via = pose(X[:3, 3] + [0.0, 0.12, 0.06])
    kept = robot.planner.plan(q, MoveArc(X_via=via, X_world_tool=end), TOOL)
    assert kept.wrist is None
    target = np.array(kept.q[-1])
    target[3:] += np.array([-np.pi, -2 * target[4], np.pi]) * [1, 1, 1]
    np.testing.assert_allclose(robot.tool(target), end, atol=1e-9)
    left = robot.planner.plan(q, MoveArc(X_via=via, X_world_tool=end, q_end=target, speed=0.1), TOOL)
    assert left.wrist is not None
    np.testing.assert_allclose(left.q[-1], target, atol=1e-12)
    assert left.path.deviation(robot.tool(left.q)[:, :3, 3]).max() < 1e-9
    assert limits_broken(robot, left.q) == []
    held = robot.planner.plan(q, MoveArc(X_via=via, X_world_tool=end, q_end=target, speed=0.1, held=("TILT",)), TOOL)
    assert limits_broken(robot, held.q) == []
    lefty = next(
        each.q
        for each in robot.kinematics.solutions(robot.tool(q) @ np.linalg.inv(TOOL))
        if each.branch.arm != robot.kinematics.branch_of(q).arm
    )
    with pytest.raises(Fault, match="RBL412: "):
        robot.planner.plan(q, MoveArc(X_via=via, X_world_tool=end, q_end=lefty), TOOL)


def test_posture_is_counted_from_the_tangent():
    path = through(*(pose((math.cos(a), math.sin(a), 0.0)) for a in (0.0, 1.0, 2.0)))
    frames = frames_along(path, np.array([0.0, 0.5, 1.0]))
    np.testing.assert_allclose(frames[:, :, 0], [[-math.sin(a), math.cos(a), 0.0] for a in (0.0, 1.0, 2.0)], atol=1e-12)
    assert frames.shape == (3, 3, 3)


def test_an_arc_of_a_large_circle_takes_as_long_as_the_line():
    robot = bench("puma560")
    q = robot.home()
    X = robot.tool(q)
    end, via = (pose(X[:3, 3] + [0.0, y, 0.0], X[:3, :3]) for y in (0.2, 0.1))
    via[2, 3] += 1e-4
    line = robot.planner.plan(q, MoveLinear(X_world_tool=end, speed=0.2), TOOL)
    arc = robot.planner.plan(q, MoveArc(X_via=via, X_world_tool=end, speed=0.2), TOOL)
    assert len(arc.q) == len(line.q)


@pytest.mark.parametrize("off", [0.99999e-6, 1e-6 * (1.0 - 1e-12)])
def test_a_refusal_does_not_print_a_distance_that_would_do(off):
    for via in ([off, 0.0, 0.0], [0.05, off, 0.0]):
        with pytest.raises(Fault) as caught:
            through(pose((0.0, 0.0, 0.0)), pose(via), pose((0.1, 0.0, 0.0)))
        value, least = re.findall(r"([\d.]+) mm", caught.value.message)
        assert float(value) < float(least)
