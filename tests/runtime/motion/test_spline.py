"""Splines: what they pass, how smooth they are, their length; what no curve can pass; planned within every limit."""

import itertools
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from runtime.core.faults import Fault
from runtime.core.frames import pose, rotation_about, rotation_angle
from runtime.motion.commands import MoveLinear, MoveSpline
from runtime.motion.path import LinePath
from runtime.motion.spline_path import SplinePath
from runtime.motion.wrist.hold import frames_along
from tests.runtime.motion.motions import ROBOTS, TOOL, bench, limits_broken
from tests.together import together

S = np.linspace(0.0, 1.0, 201)
DOUBLES_NOT_BACK = (0, 1, 2, 4, 6, 8, 9, 10)
"""Seeds of curves whose share is that of their length all along."""


def random_points(seed: int, count: int = 7, step: float = 0.1, turn: float = 0.8):
    """Poses in a row, from some to ``step`` m apart, that turn by up to ``turn`` rad."""
    random = np.random.default_rng(seed)
    X = [pose((0.4, 0.1, 0.7), Rotation.random(rng=random).as_matrix())]
    for _ in range(count - 1):
        way, axis = random.normal(size=(2, 3))
        way *= step * 10.0 ** random.uniform(-1.0, 0.0) / np.linalg.norm(way)
        R = rotation_about(axis / np.linalg.norm(axis), random.uniform(0.0, turn))
        X.append(pose(X[-1][:3, 3] + way, R @ X[-1][:3, :3]))
    return X


def spline(X) -> SplinePath:
    found = SplinePath.through(X[0], X[1:])
    assert found is not None
    return found


def at_places(places, R=None) -> SplinePath:
    return spline([pose(place, R) for place in places])


@together("seed", range(20))
def test_a_spline_passes_place_and_orientation_of_every_point(seed):
    X = random_points(seed, turn=2.9)
    path = spline(X)
    found = path.poses(path.points_at)
    assert np.abs(found[:, :3, 3] - [each[:3, 3] for each in X]).max() < 1e-12
    assert max(rotation_angle(*pair) for pair in zip(found[:, :3, :3], np.array(X)[:, :3, :3], strict=True)) < 1e-12
    np.testing.assert_allclose(path.poses(np.array([0.0, 1.0])), [path.X_start, path.X_end], atol=1e-12)
    assert path.deviation(np.array([each[:3, 3] for each in X])).max() < 1e-9
    assert path.numbers == tuple(range(len(X)))


@together("seed", range(12))
def test_direction_curvature_and_turning_are_continuous_at_every_point(seed):
    """From one-sided differences of the poses alone, which knows nothing of the curve between."""
    path = spline(random_points(seed))
    h = 1e-4 * np.diff(path.points_at).min()
    steps = np.arange(4) * h
    for at in path.points_at[1:-1]:
        sides = []
        for sign in (-1.0, 1.0):
            X = path.poses(at + sign * steps)
            R = Rotation.from_matrix(X[:, :3, :3])
            turn = (R * R[0].inv()).as_rotvec()
            rows = np.concatenate([X[:, :3, 3], turn], axis=1) / (h * path.length)
            first = sign * (-11.0 * rows[0] + 18.0 * rows[1] - 9.0 * rows[2] + 2.0 * rows[3]) / 6.0
            second = (2.0 * rows[0] - 5.0 * rows[1] + 4.0 * rows[2] - rows[3]) / (h * path.length)
            sides.append((first, second))
        (before, bent_before), (after, bent_after) = sides
        np.testing.assert_allclose(before, after, atol=2e-5 * max(1.0, np.abs(after).max()))
        scale = max(path.bend, path.gain)
        np.testing.assert_allclose(bent_before, bent_after, atol=2e-3 * scale)


@together("seed", DOUBLES_NOT_BACK)
def test_the_share_of_a_path_is_that_of_its_length(seed):
    path = spline(random_points(seed))
    assert not path.returns()
    s = np.linspace(0.0, 1.0, 4001)
    places = path.points(s)
    # the chord of a short piece of curvature k is shorter than it by k^2 l^2 / 24
    step = path.length / 4000
    chords = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert (chords <= step * (1.0 + 1e-9)).all()
    assert (chords >= step * (1.0 - 1.5 * path.bend**2 * step**2 / 24.0 - 1e-9)).all()
    np.testing.assert_allclose(np.linalg.norm(path.travel(s), axis=1), 1.0, atol=1e-12)
    along = (np.diff(places, axis=0) * path.travel(0.5 * (s[1:] + s[:-1]))).sum(axis=1)
    np.testing.assert_allclose(along, step, rtol=path.bend**2 * step**2 + 1e-6)


@pytest.mark.parametrize("places", [np.linspace(0.0, 0.4, 6), np.array([0.0, 0.001, 0.2, 0.21, 0.4])])
def test_points_of_a_straight_line_give_that_line_run_evenly(places):
    path = at_places([(x, 2.0 * x, 0.5 - x) for x in places])
    s = np.linspace(0.0, 1.0, 101)
    line = np.array([0.0, 0.0, 0.5]) + 0.4 * s[:, None] * [1.0, 2.0, -1.0]
    np.testing.assert_allclose(path.points(s), line, atol=1e-13)
    assert path.length == pytest.approx(0.4 * math.sqrt(6.0), rel=1e-12)
    assert path.radius > 1e6
    assert max(swing.distance for swing in path.swings()) < 1e-12


def test_points_of_a_circle_come_to_the_circle_as_a_cubic_spline_does():
    """Half the distance between points: a sixteenth of the error between two points far from the ends, where it is
    h^4 / (384 r^3) and less, and an eighth at the ends."""
    radius, errors = 0.1, []
    for count in (9, 17, 33):
        angles = np.linspace(0.0, 2.0 * math.pi, count)
        path = at_places(radius * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1))
        s = np.linspace(0.0, 1.0, 2001)
        off = np.abs(np.linalg.norm(path.points(s), axis=1) - radius)
        h = 2.0 * radius * math.sin(math.pi / (count - 1))
        inner = off[np.abs(s - 0.5) < 0.1]
        errors.append((off.max(), inner.max()))
        assert path.length == pytest.approx(2.0 * math.pi * radius, rel=2e-2 * (8.0 / (count - 1)) ** 3)
        assert path.radius == pytest.approx(radius, rel=0.3 * 8.0 / (count - 1))
    for (ends, inner), (finer_ends, finer_inner) in itertools.pairwise(errors):
        assert finer_ends < ends / 7.0
        assert finer_inner < inner / 12.0
    assert finer_inner < 1.05 * h**4 / (384.0 * radius**3)


def test_a_tool_that_turns_evenly_about_one_axis_does_so_on_the_spline():
    axis = np.array([0.6, 0.0, 0.8])
    path = spline([pose((0.05 * k, 0.0, 0.0), rotation_about(axis, 0.3 * k)) for k in range(6)])
    s = np.linspace(0.0, 1.0, 101)
    turned = Rotation.from_matrix(path.poses(s)[:, :3, :3]).as_rotvec()
    np.testing.assert_allclose(turned, 1.5 * s[:, None] * axis, atol=3e-4)
    assert path.angle == pytest.approx(1.5, rel=0.01)


@together("seed", (0, 6))
def test_the_largest_rates_are_those_of_the_path(seed):
    path = spline(random_points(seed, turn=2.9))
    s = np.linspace(0.0, 1.0, 20_001)
    X = path.poses(s)
    R = Rotation.from_matrix(X[:, :3, :3])
    step = path.length / 20_000
    rate = (R[1:] * R[:-1].inv()).as_rotvec() / step
    bend = np.linalg.norm(np.diff(X[:, :3, 3], 2, axis=0), axis=1).max() / step**2
    assert path.bend == pytest.approx(bend, rel=0.1)
    assert path.angle / path.length == pytest.approx(np.linalg.norm(rate, axis=1).max(), rel=0.1)
    assert path.gain == pytest.approx(np.linalg.norm(np.diff(rate, axis=0), axis=1).max() / step, rel=0.1)


def test_a_curve_that_doubles_back_comes_to_rest_there_and_names_the_point():
    path = at_places([(0.3, 0.0, 0.5), (0.4, 0.0, 0.5), (0.3, 0.0, 0.5)])
    assert path.returns() == (1,)
    s = np.linspace(0.0, 1.0, 20_001)
    speeds = np.linalg.norm(np.diff(path.points(s), axis=0), axis=1) * 20_000 / path.length
    assert speeds.min() < 0.02
    assert speeds.max() == pytest.approx(1.0, abs=1e-6)
    assert np.isfinite(path.travel(path.points_at)).all()
    # bounded: that of a corner would grow with the number of samples
    bend = np.linalg.norm(np.diff(path.points(s), 2, axis=0), axis=1).max() * (20_000 / path.length) ** 2
    assert path.bend == pytest.approx(bend, rel=0.01)
    assert at_places([(0.3, 0.0, 0.5), (0.4, 0.0, 0.5), (0.4, 0.1, 0.5)]).returns() == ()


def test_a_swing_is_measured_from_the_straight_line_between_two_points():
    path = at_places([(0.0, 0.0, 0.0), (0.2, 0.0, 0.0), (0.2, 0.02, 0.0), (0.0, 0.02, 0.0)])
    swings = path.swings()
    assert [swing.point for swing in swings] == [1, 2, 3]
    s = np.linspace(path.points_at[1], path.points_at[2], 2001)
    # beyond the ends of the chord the nearest end counts
    places = path.points(s)
    off = np.hypot(places[:, 0] - 0.2, np.maximum(np.maximum(-places[:, 1], places[:, 1] - 0.02), 0.0))
    assert swings[1].distance == pytest.approx(off.max(), rel=0.01)
    assert swings[1].chord == pytest.approx(0.02)


def test_points_that_are_where_the_one_before_is_are_left_out_and_the_end_stays_as_taught():
    start, end = pose((0.3, 0.0, 0.5)), pose((0.5, 0.1, 0.5 + 5e-7))
    path = spline([start, start, pose((0.4, 0.1, 0.5)), pose((0.4, 0.1, 0.5)), pose((0.5, 0.1, 0.5)), end])
    assert path.numbers == (0, 2, 5)
    np.testing.assert_array_equal(path.X_end, end)
    assert SplinePath.through(start, (start, start)) is None
    assert SplinePath.through(start, (start, end)) is None


A, B = (0.3, 0.0, 0.5), (0.4, 0.0, 0.5)


@pytest.mark.parametrize(
    ("X", "words"),
    [
        ([pose(A), pose(B), pose(B, rotation_about([0, 0, 1], 0.2)), pose(A)], "from point 1 to point 2 .* 11.459 deg"),
        ([pose(A), pose(A, rotation_about([0, 0, 1], 0.2)), pose(B)], "from the start to point 1 .* 11.459 deg"),
        ([pose(A), pose(B), pose(A, rotation_about([0, 0, 1], math.pi))], "from point 1 to point 2 .* half a turn"),
        ([pose(A), pose((math.nan, 0.0, 0.0)), pose(B)], "nan m"),
    ],
)
def test_what_no_curve_can_pass_is_refused_with_the_points(X, words):
    with pytest.raises(Fault, match=words) as caught:
        SplinePath.through(X[0], X[1:])
    assert caught.value.code == "RBL417"


def test_a_thousand_points_in_a_row():
    angles = np.linspace(0.0, 20.0, 1001)
    path = at_places(np.stack([0.3 * np.cos(angles), 0.3 * np.sin(angles), 0.01 * angles], axis=1))
    assert path.length == pytest.approx(20.0 * math.hypot(0.3, 0.01), rel=1e-6)
    s = np.linspace(0.0, 1.0, 5001)
    assert np.abs(np.linalg.norm(path.points(s)[:, :2], axis=1) - 0.3).max() < 1e-7
    assert path.deviation(path.points(s) + [0.0, 0.0, 1e-4]).max() == pytest.approx(1e-4, rel=1e-3)


def test_the_distance_from_a_closed_curve_is_that_of_its_nearest_part():
    places = [(0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.1, 0.1, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.0)]
    path = at_places(places)
    points = path.points(np.linspace(0.0, 1.0, 997)) + [0.0, 0.0, 1e-4]
    np.testing.assert_allclose(path.deviation(points), 1e-4, rtol=1e-6)


@together("cut", [(0.1, 1.0), (0.37, 1.0), (0.99, 1.0), (0.0, 0.3), (0.0, 0.7)])
def test_what_is_left_of_a_curve_is_that_curve(cut):
    angles = np.linspace(0.0, 3.5, 9)
    path = at_places(np.stack([0.1 * np.cos(angles), 0.1 * np.sin(angles), 0.01 * angles], axis=1))
    shares = path.places_within(*cut)
    assert 0 < len(shares) <= 60
    assert cut[0] < min(shares) and max(shares) < cut[1]
    rest = spline(list(path.poses(np.array([cut[0], *shares, cut[1]]))))
    assert path.deviation(rest.points(S)).max() < 2e-6


def planned(name: str, shape: str = "jerk", override: float = 1.0, turn: float = 0.3, size: float = 1.0, **options):
    robot = bench(name, shape)
    q = robot.home()
    X = robot.tool(q)
    offsets = [(0.0, 0.05, 0.02), (0.02, 0.1, 0.06), (0.03, 0.15, 0.05), (0.0, 0.2, 0.0)]
    points = [
        pose(X[:3, 3] + size * np.array(offset), rotation_about([0.0, 0.6, 0.8], turn * math.sin(k)) @ X[:3, :3])
        for k, offset in enumerate(offsets, start=1)
    ]
    move = MoveSpline(X_through=tuple(points[:-1]), X_world_tool=points[-1], **options)
    return robot.planner.plan(q, move, TOOL, override)


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("shape", ["jerk", "trapezoid"])
def test_every_set_point_is_on_the_spline_and_every_limit_is_kept(name, shape):
    found, robot = planned(name, shape, speed=0.5), bench(name, shape)
    X = robot.tool(found.q)
    assert found.path.deviation(X[:, :3, 3]).max() < 1e-9
    np.testing.assert_allclose(X, found.path.poses(found.s), atol=1e-9)
    np.testing.assert_array_equal(found.q[0], robot.home())
    assert limits_broken(robot, found.q) == []


@together("case", [(0.1, 0.0), (0.2, 0.1), (1.0, 0.8), (0.5, 1.2)])
def test_acceleration_and_that_of_turning_keep_the_limits_where_the_curve_is_tight(case):
    """Measured on the tool alone: differences of its places and of its turning."""
    size, turn = case
    robot = bench("irb2400")
    found = planned("irb2400", size=size, turn=turn, speed=2.0, acceleration=0.3)
    X = robot.tool(found.q)
    felt = np.linalg.norm(np.diff(X[:, :3, 3], 2, axis=0), axis=1).max() / robot.profile.period_s**2
    assert felt <= 0.3 * robot.spec.path.acceleration * (1 + 1e-6)
    R = Rotation.from_matrix(X[:, :3, :3])
    rate = (R[1:] * R[:-1].inv()).as_rotvec() / robot.profile.period_s
    assert np.linalg.norm(rate, axis=1).max() <= robot.spec.path.rotation_speed * 1.01
    felt = np.linalg.norm(np.diff(rate, axis=0), axis=1).max() / robot.profile.period_s
    assert felt <= 0.3 * robot.spec.path.rotation_acceleration * 1.25


def along(offsets, **options):
    """The plan of a spline through places off the tool's, m, its steps, m/s, and their changes, m/s2."""
    robot = bench("irb2400")
    q = robot.home()
    X = robot.tool(q)
    points = [pose(X[:3, 3] + np.array(each), X[:3, :3]) for each in offsets]
    found = robot.planner.plan(q, MoveSpline(X_through=tuple(points[:-1]), X_world_tool=points[-1], **options), TOOL)
    places, period_s = robot.tool(found.q)[:, :3, 3], robot.profile.period_s
    return found, *(np.linalg.norm(np.diff(places, k, axis=0), axis=1) / period_s**k for k in (1, 2))


@together(
    "offsets", [[(0.0, 0.1, 0.0), (0.0, 0.0, 0.0)], [(0, 0.15, 0), (0, 0.155, 0.005), (0, 0.15, 0.01), (0, 0, 0.01)]]
)
def test_a_spline_is_slow_where_it_bends_and_nowhere_else(offsets):
    found, speed, felt = along(offsets, speed=0.2)
    limit = bench("irb2400").spec.path.acceleration
    assert felt.max() <= limit * (1 + 1e-6)
    tight = math.sqrt(limit * found.path.radius)
    assert tight < 0.1
    middle = len(speed) // 2
    assert speed[middle - 3 : middle + 3].max() < 1.1 * tight
    assert np.count_nonzero(speed > 0.198) > 0.4 * len(speed)


def test_a_curve_that_bends_ever_anew_keeps_the_acceleration_of_the_tool():
    offsets = [(0.015, 0.054, -0.008), (0.008, 0.083, -0.033), (-0.002, 0.113, -0.014), (0.0, 0.126, -0.07)]
    _, _, felt = along([*offsets, (0.032, 0.096, -0.123)], speed=1.0, acceleration=0.5)
    assert felt.max() <= 0.5 * bench("irb2400").spec.path.acceleration * 1.01


def test_the_wrist_may_change_on_a_spline():
    """To the same pose with the other sign of J5: the wrist leaves the posture, the tool point stays on the curve."""
    robot, offsets = bench("irb2400"), [(0.0, 0.06, 0.05), (0.0, 0.18, 0.05), (0.0, 0.25, 0.0)]
    kept = along(offsets)[0]
    target = kept.q[-1] + [0.0, 0.0, 0.0, -np.pi, -2.0 * kept.q[-1][4], np.pi]
    left = along(offsets, q_end=target, speed=0.1)[0]
    assert kept.wrist is None and left.wrist is not None
    np.testing.assert_allclose(left.q[-1], target, atol=1e-12)
    assert left.path.deviation(robot.tool(left.q)[:, :3, 3]).max() < 1e-9
    assert limits_broken(robot, left.q) == []


def test_speed_and_override_of_a_spline_are_those_of_its_tool_point():
    for override in (1.0, 0.5):
        found, robot = planned("irb2400", override=override, speed=0.1, turn=0.0), bench("irb2400")
        steps = np.diff(found.s) * found.path.length / robot.profile.period_s
        middle = steps[len(steps) // 3 : -len(steps) // 3]
        assert np.ptp(middle) < 1e-9
        assert middle[0] == pytest.approx(0.1 * override, rel=0.01)


def test_a_spline_blends_with_the_moves_before_and_after_it():
    robot = bench("irb2400")
    q = robot.home()
    X = robot.tool(q)
    at = [pose(X[:3, 3] + np.array(off), X[:3, :3]) for off in itertools.product((0.0, 0.1), (0.05, 0.15), (0.0, 0.1))]
    chain = [
        MoveLinear(X_world_tool=at[0], speed=0.2, zone=0.02),
        MoveSpline(X_through=(at[1], at[3]), X_world_tool=at[2], speed=0.2, zone=0.02),
        MoveLinear(X_world_tool=at[6], speed=0.2),
    ]
    found = robot.planner.chain(q, chain, TOOL)
    assert limits_broken(robot, found.q) == []
    assert [corner.cycles > 0 for corner in found.corners] == [True, True]
    assert all(corner.reach <= 0.02 * (1 + 1e-9) for corner in found.corners)
    points = robot.tool(found.q)[:, :3, 3]
    paths = [part.path for part in found.parts]
    near = np.minimum(*(np.linalg.norm(points - at[k][:3, 3], axis=1) for k in (0, 2))) <= 0.02
    off = np.min([path.deviation(points) for path in paths], axis=0)
    assert off[~near].max() < 1e-9


def test_a_spline_whose_points_are_one_place_is_a_straight_move():
    robot = bench("puma560")
    q = robot.home()
    here = robot.tool(q)
    there = pose(here[:3, 3] + [0.0, 0.1, 0.0], here[:3, :3])
    found = robot.planner.plan(q, MoveSpline(X_through=(here,), X_world_tool=there), TOOL)
    assert isinstance(found.path, LinePath)
    assert len(robot.planner.plan(q, MoveSpline(X_through=(here,), X_world_tool=here), TOOL).q) == 1


def test_a_point_out_of_reach_is_refused_with_the_share_of_the_path():
    robot = bench("puma560")
    q = robot.home()
    X = robot.tool(q)
    far = [pose(X[:3, 3] + np.array(off), X[:3, :3]) for off in ((0.1, 0.0, 0.0), (2.0, 0.0, 0.0), (0.1, 0.1, 0.0))]
    with pytest.raises(Fault, match=r"at \d+\.\d % .* puma560") as caught:
        robot.planner.plan(q, MoveSpline(X_through=tuple(far[:-1]), X_world_tool=far[-1], wrist="keep"), TOOL)
    assert caught.value.code == "RBL410"


def test_the_frame_of_travel_turns_with_the_tangent():
    path = at_places([(math.cos(a), math.sin(a), 0.0) for a in (0.0, 0.5, 1.0, 1.5)])
    np.testing.assert_allclose(frames_along(path, path.points_at)[:, :, 0], path.travel(path.points_at), atol=1e-12)
