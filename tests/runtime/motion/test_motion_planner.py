"""Moves in a row: blended within zones and joint limits, never refused for it, and without zones as they were."""

import math
from dataclasses import replace

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import pose, rotation_about
from runtime.motion.cartesian_planner import EXCEPTION, CartesianPlanner
from runtime.motion.chain.timing import timed
from runtime.motion.commands import MAX, Command, MoveArc, MoveJoint, MoveLinear
from runtime.motion.motion_planner import ChainFault, ChainPlan
from tests.runtime.motion.motions import (
    ON_PATH,
    ROBOTS,
    TOOL,
    Bench,
    bench,
    blends_broken,
    limits_broken,
    off_path,
    random_chain,
)

ROWS = ("x", "q", "setpoints")
"""What a timed path has a row of for every cycle."""


def by(robot: Bench, *steps, zone: float = 0.0, **options) -> list[Command]:
    """Lines one after the other from home, each ``steps`` (3,) m further."""
    X = robot.tool(robot.home())
    commands: list[Command] = []
    for step in steps:
        X = pose(X[:3, 3] + np.array(step), X[:3, :3])
        commands.append(MoveLinear(X_world_tool=X, zone=zone, **options))
    return commands


def chain(robot: Bench, commands: list[Command], override: float = 1.0) -> ChainPlan:
    return robot.planner.chain(robot.home(), commands, TOOL, override)


def speeds(robot: Bench, q: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.diff(robot.tool(q)[:, :3, 3], axis=0), axis=1) / robot.profile.period_s


RIGHT_ANGLE = ((0.0, 0.15, 0.0), (0.0, 0.0, 0.15))


def test_a_blend_that_leaves_its_zone_or_a_limit_would_be_noticed():
    """The checks of this file, on rows that are wrong."""
    robot = bench("puma560")
    commands = by(robot, *RIGHT_ANGLE, zone=0.05, speed=0.5)
    found = chain(robot, commands)
    assert found.corners[0].cycles > 5
    tight = [MoveLinear(X_world_tool=each.X_world_tool, zone=0.5 * found.corners[0].reach) for each in commands]
    assert blends_broken(robot, found, tight) == [
        "path of move 0 left outside the zone",
        "path of move 1 left outside the zone",
    ]
    a, b = (part.plan.q for part in found.parts)
    fast = robot.planner.chain(robot.home(), [MoveJoint(q_end=robot.home() + 0.4), MoveJoint(q_end=robot.home())], TOOL)
    a, b = (part.plan.q for part in fast.parts)
    half = len(a) // 2
    together = a[half + 1 : -1] + b[1 : len(a) - 1 - half] - b[0]
    broken = limits_broken(robot, np.concatenate([a[: half + 1], together, b[len(a) - 1 - half :]]))
    assert "acceleration" in broken
    assert "acceleration by differences" in broken


@pytest.mark.parametrize("name", ROBOTS)
def test_without_zones_the_rows_are_those_of_the_plans_to_the_last_bit(name):
    robot, random = bench(name), np.random.default_rng(6)
    lines = CartesianPlanner(robot.spec, robot.kinematics, robot.profile)
    for _ in range(5):
        start, commands = random_chain(robot, random, 3)
        stops = [
            type(command)(**{**{f: getattr(command, f) for f in command.__slots__}, "zone": 0.0})
            for command in commands
        ]
        found = robot.planner.chain(start, stops, TOOL)
        q, rows = start, [start[None]]
        for command in stops:
            plan = robot.planner.plan(q, command, TOOL)
            rows.append(plan.q[1:])
            q = plan.q[-1]
        assert found.q.tobytes() == np.concatenate(rows).tobytes()
        assert [corner.cycles for corner in found.corners] == [0, 0]
        alone = next((each for each in commands if not isinstance(each, MoveJoint)), None)
        if alone is commands[0]:  # a zone at the end of the last move asks for nothing
            single = robot.planner.chain(start, [alone], TOOL)
            assert single.q.tobytes() == lines.plan(start, replace(alone, zone=0.0), TOOL).q.tobytes()


@pytest.mark.parametrize("zone", [0.002, 0.01, 0.05])
def test_a_corner_is_cut_within_its_zone_and_the_time_saved_grows_with_it(zone):
    robot = bench("irb2400")
    found = chain(robot, by(robot, *RIGHT_ANGLE, zone=zone, speed=0.4))
    (corner,) = found.corners
    assert corner.reach == pytest.approx(zone, rel=1e-6)
    assert 0.0 < corner.deviation < corner.reach / math.sqrt(2.0) + 1e-9
    assert len(found.q) < sum(len(part.plan.q) - 1 for part in found.parts) + 1
    smaller = chain(robot, by(robot, *RIGHT_ANGLE, zone=0.5 * zone, speed=0.4))
    assert len(smaller.q) > len(found.q)
    points = robot.tool(found.q)[:, :3, 3]
    middle = robot.tool(found.parts[0].plan.q[-1])[:3, 3]
    assert np.linalg.norm(points - middle, axis=1).min() == pytest.approx(corner.deviation, abs=1e-3)


@pytest.mark.parametrize("speed", [0.05, 0.1, 0.5])
@pytest.mark.parametrize("step", [(0.0, 0.15, 0.0), (0.0, 0.0, 0.15), (0.0, -0.15, 0.0)])
def test_the_tool_is_never_faster_in_a_blend_than_on_its_ways(speed, step):
    """In line, round a corner and straight back; a slow move brakes on a fraction of its zone."""
    robot = bench("irb2400")
    found = chain(robot, by(robot, (0.0, 0.15, 0.0), step, zone=0.06, speed=speed))
    assert speeds(robot, found.q).max() <= speed * (1 + 1e-6)
    assert found.corners[0].cycles > 0


def test_in_line_the_tool_keeps_its_speed():
    robot = bench("irb2400")
    found = chain(robot, by(robot, *[(0.0, 0.1, 0.0)] * 3, zone=0.05, speed=0.2))
    for corner, part in zip(found.corners, found.parts, strict=False):
        middle = speeds(robot, found.q[part.last - 3 : part.last + 3])
        assert middle.min() > 0.995 * 0.2
        assert corner.deviation < 1e-9
    assert limits_broken(robot, found.setpoints) == []


def test_two_corners_never_meet_and_half_a_move_is_the_most_that_one_takes():
    robot = bench("irb2400")
    found = chain(robot, by(robot, (0.0, 0.02, 0.0), (0.0, 0.0, 0.02), (0.0, -0.02, 0.0), zone=0.08, speed=1.0))
    assert [corner.reach for corner in found.corners] == pytest.approx([0.01, 0.01], rel=1e-6)
    assert limits_broken(robot, found.setpoints) == []


@pytest.mark.parametrize("zone", [0.003, 0.012])
def test_a_polyline_with_zones_longer_than_its_moves_bends_evenly_within_them(zone):
    """Chords of a circle, 9 deg apart: where the zones reach from corner to corner, the tool runs on a smooth curve."""
    robot, radius, step, speed = bench("irb2400"), 0.06, math.radians(9.0), 0.1
    places = [radius * np.array([0.0, math.sin(k * step), 1.0 - math.cos(k * step)]) for k in range(21)]
    found = chain(robot, by(robot, *np.diff(places, axis=0), zone=zone, speed=speed))
    assert limits_broken(robot, found.setpoints) == []
    points = robot.tool(found.q)[:, :3, 3]
    corners = robot.tool(np.array([part.plan.q[-1] for part in found.parts]))[:, :3, 3]
    to_corner = np.linalg.norm(points[:, None] - corners, axis=2).min(axis=1)
    on_line = np.min([part.path.deviation(points) for part in found.parts], axis=0)
    assert (to_corner[on_line > ON_PATH] <= zone).all()
    middle = slice(len(points) // 3, 2 * len(points) // 3)
    turned = np.linalg.norm(np.diff(points, 2, axis=0), axis=1)[middle] / robot.profile.period_s**2
    even = turned.max() / (speed**2 / radius)
    # between zones of 3 mm the lines are kept, and half of a move alone would bend 1.5 times as the circle
    assert bool(even < 1.2) == (zone > 0.0047)


def test_rows_commands_shares_and_parts_belong_together():
    robot = bench("puma560")
    found = chain(robot, by(robot, *RIGHT_ANGLE, (0.0, -0.1, 0.0), zone=0.03, speed=0.4))
    assert (np.diff(found.command) >= 0).all()
    assert found.parts[0].first == 0
    assert found.parts[-1].last == len(found.q) - 1
    for index, part in enumerate(found.parts):
        assert index == 0 or found.parts[index - 1].last == part.first
        rows = np.flatnonzero(found.command == index)
        assert (rows[0] == 0 or rows[0] == part.first + 1, rows[-1]) == (True, part.last)
        assert len(part.s) == part.last - part.first + 1
        assert (np.diff(part.s) >= 0.0).all()
        off, _ = off_path(robot, found, part, index)
        assert 0 < len(off) < len(rows)
        on = np.setdiff1d(rows, off)
        there = part.path.points(part.s[on - part.first])
        np.testing.assert_allclose(robot.tool(found.q[on])[:, :3, 3], there, atol=2e-6)
    assert sum(part.planned_s for part in found.parts) == pytest.approx((len(found.q) - 1) * robot.profile.period_s)


def test_outside_of_zones_the_command_is_on_the_lines():
    robot = bench("irb2400")
    found = chain(robot, by(robot, *RIGHT_ANGLE, (0.0, -0.1, 0.0), zone=0.03, speed=0.5))
    played = robot.tool(robot.at_the_servo(found.setpoints)[0][::8])[:, :3, 3]
    corners = [robot.tool(part.plan.q[-1])[:3, 3] for part in found.parts[:-1]]
    outside = np.min([np.linalg.norm(played - corner, axis=1) for corner in corners], axis=0) > 0.03
    off = np.min([part.path.deviation(played) for part in found.parts], axis=0)
    assert outside.sum() > 20
    assert off[outside].max() < 1e-9
    assert off.max() > 1e-3


def test_wrist_modes_of_a_chain_are_those_of_the_places_where_the_wrist_is_away():
    """A line whose wrist goes to other end angles, then one that keeps them."""
    robot = bench("irb2400")
    start, end = np.radians([-20, 10, 30, 10, 65, -15]), np.radians([0, -10, 45, -55, -65, 85])
    first = MoveLinear(X_world_tool=robot.tool(end), q_end=end, speed=0.3, zone=0.05)
    X = robot.tool(end)
    second = MoveLinear(X_world_tool=pose(X[:3, 3] + [0.0, 0.0, 0.05], X[:3, :3]), speed=0.3)
    found = robot.planner.chain(start, [first, second], TOOL)
    plan, part = found.parts[0].plan, found.parts[0]
    assert plan.wrist is not None
    away = (part.s[1:] > plan.s[plan.wrist.row]) & (part.s[1:] <= plan.s[plan.wrist.row_end])
    np.testing.assert_array_equal(found.modes[1 : part.last + 1] == EXCEPTION, away)
    assert away.any() and not away.all()
    assert (found.modes[part.last + 1 :] == found.parts[1].plan.modes[-1]).all()
    assert len(found.modes) == len(found.command) == len(found.q)
    assert limits_broken(robot, found.setpoints) == []


def test_a_move_with_nothing_to_do_ends_a_blend_and_counts_as_a_move():
    robot = bench("puma560")
    first, second = by(robot, *RIGHT_ANGLE, zone=0.03, speed=0.4)
    found = chain(robot, [first, first, second, second])
    assert [corner.cycles for corner in found.corners] == [0, 0, 0]
    assert [part.planned_s > 0.0 for part in found.parts] == [True, False, True, False]
    assert found.command[-1] == 3
    assert len(found.notes) == 2
    nothing = robot.planner.chain(robot.home(), [MoveJoint(q_end=robot.home())] * 2, TOOL)
    assert (len(nothing.q), nothing.command.tolist()) == (1, [1])


def test_the_move_that_is_refused_is_named():
    robot = bench("puma560")
    commands = by(robot, (0.0, 0.1, 0.0), (0.0, 0.0, 0.1), (3.0, 0.0, 0.0), zone=0.02)
    with pytest.raises(ChainFault, match="RBL410") as caught:
        chain(robot, commands)
    assert caught.value.index == 2
    assert isinstance(caught.value, Fault)
    with pytest.raises(ChainFault, match="RBL416") as caught:
        chain(robot, [commands[0], MoveArc(X_via=commands[0].X_world_tool, X_world_tool=commands[1].X_world_tool)])
    assert caught.value.index == 1
    with pytest.raises(ValueError, match="one"):
        chain(robot, [])


@pytest.mark.parametrize("override", [0.1, 0.5])
def test_an_override_scales_every_speed_and_takes_the_same_way(override):
    """A line, a turn on the spot, a joint move, an arc, and a line that changes its wrist."""
    robot = bench("irb2400")
    q, J1 = robot.home(), 1.5 * np.eye(6)[0]
    X = robot.tool(q)
    turned = pose(X[:3, 3], rotation_about([0.0, 0.0, 1.0], 1.0) @ X[:3, :3])
    aside = pose(X[:3, 3] + [0.0, 0.3, 0.0], X[:3, :3])
    for command in (
        MoveLinear(X_world_tool=aside),
        MoveLinear(X_world_tool=turned),
        MoveJoint(q_end=q + J1),
        MoveArc(X_via=pose(X[:3, 3] + [0.0, 0.1, 0.1]), X_world_tool=aside),
    ):
        whole, part = (robot.planner.plan(q, command, TOOL, each) for each in (1.0, override))
        assert limits_broken(robot, part.setpoints, override) == []
        asked = (
            robot.speed[0] / 1.5
            if isinstance(command, MoveJoint)
            else robot.planner.lines.curve(q, command, TOOL).limits.speed
        )
        assert 0.95 < np.diff(part.s).max() / robot.profile.period_s / (override * asked) <= 1.0 + 1e-6
        assert len(part.q) > len(whole.q)
    change = np.radians([0, -10, 45, -55, -65, 85])
    command = MoveLinear(X_world_tool=robot.tool(change), q_end=change, speed=0.3)
    whole, part = (
        robot.planner.plan(np.radians([-20, 10, 30, 10, 65, -15]), command, TOOL, each) for each in (1.0, override)
    )
    assert part.wrist is not None
    assert part.wrist.condition == whole.wrist.condition
    assert part.wrist.share == pytest.approx(whole.wrist.share, abs=0.02)
    timed = robot.planner.plan(q, MoveLinear(X_world_tool=aside, duration=1.0), TOOL, override)
    assert (len(timed.q) - 1) * robot.profile.period_s == pytest.approx(1.0 / override, abs=0.008)


def test_a_chain_under_an_override_blends_within_the_lower_speeds():
    robot = bench("irb2400")
    commands = by(robot, *RIGHT_ANGLE, zone=0.05, speed=0.4)
    found = chain(robot, commands, 0.3)
    assert found.corners[0].cycles > 0
    assert limits_broken(robot, found.setpoints, 0.3) == []
    assert speeds(robot, found.q).max() <= 0.3 * 0.4 * (1 + 1e-6)


@pytest.mark.parametrize("kinds", ["joint joint", "line joint", "joint arc", "arc line"])
def test_all_kinds_blend_with_each_other(kinds):
    robot = bench("puma560")
    q, X = robot.home(), robot.tool(robot.home())
    middle, end = (pose(X[:3, 3] + np.array(step), X[:3, :3]) for step in ((0.0, 0.15, 0.05), (0.0, 0.2, -0.1)))

    def move(kind: str, X_here: np.ndarray, X_end: np.ndarray) -> Command:
        if kind == "arc":
            via = pose(0.5 * (X_here + X_end)[:3, 3] + [0.03, 0.0, 0.0])
            return MoveArc(X_via=via, X_world_tool=X_end, zone=0.04, speed=0.3)
        return (
            MoveJoint(X_world_tool=X_end, zone=0.04, speed=0.5)
            if kind == "joint"
            else MoveLinear(X_world_tool=X_end, zone=0.04, speed=0.3)
        )

    first, second = kinds.split()
    commands = [move(first, X, middle), move(second, middle, end)]
    found = robot.planner.chain(q, commands, TOOL)
    assert found.corners[0].cycles > 4
    assert limits_broken(robot, found.setpoints) == []
    assert blends_broken(robot, found, commands) == []


@pytest.mark.parametrize("overrides", [(1.0, 0.3), (0.3, 1.0), (0.3, 0.3)])
@pytest.mark.parametrize("kind", ["line", "joint"])
def test_where_overrides_differ_the_speed_goes_over_in_the_corner(kind, overrides):
    robot = bench("irb2400")
    q = robot.home()
    ends = (q + 0.6 * np.eye(6)[0], q + 0.6 * np.eye(6)[0] + 0.5 * np.eye(6)[1])
    commands: list[Command] = [
        MoveJoint(q_end=end, zone=0.1, override=share)
        if kind == "joint"
        else MoveLinear(X_world_tool=robot.tool(end), zone=0.1, speed=1.0, override=share)
        for end, share in zip(ends, overrides, strict=True)
    ]
    found = robot.planner.chain(q, commands, TOOL)
    assert found.corners[0].cycles > 0
    assert limits_broken(robot, found.setpoints) == []
    dq = (np.abs(np.diff(found.q, axis=0)) / robot.profile.period_s / robot.speed).max(axis=1)
    off = [off_path(robot, found, part, index)[0] for index, part in enumerate(found.parts)]
    ends = (dq[: off[0].min() - 1], dq[off[1].max() + 1 :])
    for rows, share in zip(ends, overrides, strict=True):
        assert rows.max() <= share * (1 + 1e-6)
    assert dq.max() <= max(overrides) * (1 + 1e-6)
    twice = robot.planner.chain(q, commands, TOOL, 0.5)  # and another one for all of them
    assert [part.plan.override for part in twice.parts] == [0.5 * share for share in overrides]


@pytest.mark.parametrize("override", [0.0, -0.1, 1.001, math.nan])
def test_an_override_that_is_no_share_is_misuse(override):
    with pytest.raises(ValueError, match="share"):
        MoveJoint(q_end=np.zeros(6), override=override)


def test_a_chain_that_cannot_be_timed_stops_at_its_corners(monkeypatch):
    robot = bench("puma560")
    commands = by(robot, *RIGHT_ANGLE, zone=0.03, speed=0.4)

    def refused(*_, **__):
        raise Fault("RBL404", "test")

    monkeypatch.setattr("runtime.motion.chain.paced.timed", refused)
    found = chain(robot, commands)
    assert [corner.cycles for corner in found.corners] == [0]
    assert found.corners[0].radius == 0.03
    plans = [part.plan.q for part in found.parts]
    np.testing.assert_array_equal(found.q, np.concatenate([plans[0], plans[1][1:]]))
    assert [part.last - part.first for part in found.parts] == [len(rows) - 1 for rows in plans]


@pytest.mark.parametrize("decimals", [2, 3, 4, 5, 6, 10])
def test_zones_that_leave_next_to_nothing_of_a_move_keep_its_speed(decimals):
    """A circle in pieces of 2 mm, whose lengths differ by the last decimal of their points.

    Without a limit of jerk, which the straight piece of 0.2 mm that the first zone leaves of each would pass.
    """
    robot = bench("irb2400", "trapezoid")
    X = robot.tool(robot.home())
    angles = np.arange(31) * 2.0 / 30.0
    circle = np.round(30.0 * np.stack([0 * angles, np.sin(angles), 1.0 - np.cos(angles)], axis=1), decimals) * 1e-3
    times = []
    for zone in (0.0009, 0.001, 0.005):
        commands = [
            MoveLinear(X_world_tool=pose(X[:3, 3] + point, X[:3, :3]), speed=0.2, zone=zone) for point in circle[1:]
        ]
        times.append(len(robot.planner.chain(robot.home(), commands, TOOL).q) - 1)
    assert max(times) <= min(times) + 2
    assert max(times) * robot.profile.period_s < 0.060 / 0.2 + 0.15


def test_a_chain_that_keeps_no_cap_stops_at_its_corners(monkeypatch):
    """Moves alone keep it: the planner finds their overrides itself."""
    robot = bench("puma560")
    commands = by(robot, *RIGHT_ANGLE, zone=0.03, speed=0.4)
    found = robot.planner.chain(robot.home(), commands, TOOL, cap=0.25)
    assert found.corners[0].cycles > 0

    def fast(*given, **named):
        found = timed(*given, **named)
        rows = [*range(0, len(found.x) - 1, 2), len(found.x) - 1]
        return replace(found, **{name: getattr(found, name)[rows] for name in ROWS})

    monkeypatch.setattr("runtime.motion.chain.paced.timed", fast)
    monkeypatch.setattr("runtime.motion.chain.paced._TIMES", 1)
    found = robot.planner.chain(robot.home(), commands, TOOL, cap=0.25)
    assert found.corners[0].cycles == 0
    assert speeds(robot, found.q).max() <= 0.25


def test_a_chain_that_takes_longer_than_its_moves_alone_stops_at_its_corners(monkeypatch):
    robot = bench("puma560")
    commands = by(robot, *RIGHT_ANGLE, zone=0.03, speed=0.4)

    def slow(*given, **named):
        found = timed(*given, **named)
        return replace(found, **{name: np.repeat(getattr(found, name), 2, axis=0) for name in ROWS})

    monkeypatch.setattr("runtime.motion.chain.paced.timed", slow)
    found = chain(robot, commands)
    assert [corner.cycles for corner in found.corners] == [0]
    assert len(found.q) - 1 == sum(len(part.plan.q) - 1 for part in found.parts)


@pytest.mark.parametrize("name", ROBOTS)
def test_more_acceleration_and_the_trapezoid_are_never_slower(name):
    """ACCEL 50, 75, 100 and MAX in this order, each with and without a limit of jerk."""
    smooth, hard = bench(name), bench(name, "trapezoid")
    X = smooth.tool(smooth.home())
    for step in ((0.0, 0.02, 0.01), (0.0, 0.2, -0.05)):
        end = pose(X[:3, 3] + np.array(step), X[:3, :3])
        moves = [MoveLinear(X_world_tool=end, speed=0.8, acceleration=share) for share in (0.5, 0.75, 1.0, MAX)]
        cycles = [[len(robot.planner.plan(robot.home(), each, TOOL).q) for each in moves] for robot in (smooth, hard)]
        assert [sorted(row, reverse=True) for row in cycles] == cycles
        assert (np.array(cycles[1]) < np.array(cycles[0])).all()
        assert cycles[0][0] > cycles[0][2]
        assert limits_broken(hard, hard.planner.plan(hard.home(), moves[-1], TOOL).setpoints) == []
