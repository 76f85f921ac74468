"""Chains that go on over more moves while they run: the same motion, within all limits, at no greater cost of time."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import Array, pose
from runtime.motion.chaining import Joined
from runtime.motion.commands import MoveLinear
from runtime.motion.extension import _then
from runtime.motion.limit_use import Taken, limit_use
from runtime.motion.motion_planner import ChainPlan
from runtime.motion.speeds import Speeds
from tests.campaign import size
from tests.runtime.motion.chains import Chain, broken, random_chain
from tests.runtime.motion.motions import TOOL, Bench, bench
from tests.runtime.motion.windows import windowed

ROBOTS = ("puma560", "irb2400", "manutec_r3")


def circle(robot: Bench, count: int, *, zone: float = 0.012, speed: float = 0.15) -> list[MoveLinear]:
    """Chords of 3.5 mm, round and round on 100 mm."""
    X, angles = robot.tool(robot.home()), np.radians(4.0 * np.arange(1, count + 1))
    offs = 0.05 * np.stack([0.0 * angles, np.sin(angles), 1.0 - np.cos(angles)], axis=1)
    return [MoveLinear(X_world_tool=pose(X[:3, 3] + off, X[:3, :3]), speed=speed, zone=zone) for off in offs]


@pytest.mark.parametrize("name", ROBOTS)
def test_random_chains_keep_limits_and_zones_where_they_are_planned_a_few_moves_ahead(name):
    robot, random = bench(name), np.random.default_rng(8)
    cycles = whole = 0
    for _ in range(size(40, 2)):
        run = random_chain(robot, random, 12)
        run = replace(run, commands=tuple(replace(each, zone=max(each.zone, 0.002)) for each in run.commands))
        found = windowed(robot, run.start, run.commands, 6, 4)
        assert not broken(robot, run, found.plan).total()
        cycles += len(found.plan.setpoints)
        whole += len(robot.planner.chain(run.start, run.commands, TOOL).q)
    # the few moves that are known are too few to gain a speed for long ones
    assert cycles <= 1.1 * whole


@pytest.mark.parametrize("name", ROBOTS)
def test_a_circle_that_is_planned_ahead_takes_no_longer_and_stands_nowhere(name):
    robot = bench(name)
    commands = circle(robot, 240)
    found = windowed(robot, robot.home(), commands, 100, 70)
    whole = robot.planner.chain(robot.home(), commands, TOOL)
    assert not found.stops
    assert abs(len(found.plan.setpoints) - len(whole.q)) <= 3
    tool = robot.tool(found.plan.setpoints)[:, :3, 3]
    speeds = np.linalg.norm(np.diff(tool, axis=0), axis=1) / robot.profile.period_s
    assert speeds[20:-20].min() > 0.14
    # what has been run is left out, so no plan grows with the motion
    assert max(found.lengths) <= 100 + 70


def test_rows_up_to_the_one_that_is_reached_stay_to_the_last_bit():
    robot = bench("puma560")
    commands = circle(robot, 260)
    plan = robot.planner.chain(robot.home(), commands[:150], TOOL, more=True)
    at = plan.tail.more_at
    grown, left_out = robot.planner.extend(plan, at, commands[150:], TOOL)
    first = plan.parts[left_out].first
    assert left_out > 50
    np.testing.assert_array_equal(grown.setpoints[: at - first + 1], plan.setpoints[first : at + 1])
    np.testing.assert_array_equal(grown.command[1 : at - first + 1], plan.command[first + 1 : at + 1] - left_out)
    # the change comes later, and what is made of the rows before it is the same up to rounding
    np.testing.assert_allclose(grown.setpoints[at - first :][1:9], plan.setpoints[at:][1:9], rtol=0.0, atol=1e-10)
    assert [part.plan for part in grown.parts[: 150 - left_out]] == [part.plan for part in plan.parts[left_out:]]
    again, _ = robot.planner.extend(plan, at, commands[150:], TOOL)
    assert again.setpoints.tobytes() == grown.setpoints.tobytes()


def test_a_motion_goes_on_from_any_row_that_leaves_it_room_and_is_refused_from_others():
    robot = bench("puma560")
    commands = circle(robot, 60)
    plan = robot.planner.chain(robot.home(), commands[:40], TOOL, more=True)
    run = Chain(start=robot.home(), commands=tuple(commands), ends=(), alone=())
    ends = [robot.home()]
    for command in commands:
        ends.append(robot.planner.plan(ends[-1], command, TOOL).q[-1])
    run = replace(run, ends=tuple(ends))
    refused = 0
    for at in range(len(plan.q) // 3, len(plan.q), 9):
        try:
            grown, left_out = robot.planner.extend(plan, at, commands[40:], TOOL)
        except Fault as fault:
            assert fault.code == "RBL404"
            refused += 1
            continue
        first = plan.parts[left_out].first if left_out else 0
        rows = np.concatenate([plan.setpoints[:first], grown.setpoints])
        numbers = np.concatenate([plan.command[:first], grown.command + left_out])
        assert not broken(robot, run, replace(grown, setpoints=rows, command=numbers)).total(), at
    assert 0 < refused < 8


def test_a_path_that_is_too_short_to_change_begins_anew_with_what_follows():
    robot = bench("puma560")
    X = robot.tool(robot.home())
    far = MoveLinear(X_world_tool=pose(X[:3, 3] + (0.0, 0.1, 0.0), X[:3, :3]), zone=0.0)
    near = [
        MoveLinear(X_world_tool=pose(X[:3, 3] + (0.0, 0.1 + 0.01 * k, 0.0), X[:3, :3]), zone=0.01) for k in (1, 2, 3)
    ]
    plan = robot.planner.chain(robot.home(), [far, near[0]], TOOL, more=True)
    assert plan.tail.more_at == plan.parts[0].last
    grown, left_out = robot.planner.extend(plan, plan.tail.more_at, near[1:], TOOL)
    whole = robot.planner.chain(robot.home(), [far, *near], TOOL)
    assert left_out == 0
    assert abs(len(grown.q) - len(whole.q)) <= 1
    assert [corner.reach > 0.0 for corner in grown.corners] == [False, True, True]


def test_nothing_follows_a_stop_without_one():
    robot = bench("puma560")
    commands = circle(robot, 60)
    fine = [*commands[:39], replace(commands[39], zone=0.0)]
    plan = robot.planner.chain(robot.home(), fine, TOOL, more=True)
    assert plan.tail.more_at is None
    assert robot.planner.chain(robot.home(), fine, TOOL).tail is None
    plan = robot.planner.chain(robot.home(), commands[:40], TOOL, more=True)
    for wrong in ([], [commands[39], commands[40]]):
        with pytest.raises(Fault, match="RBL404"):
            robot.planner.extend(plan, plan.tail.more_at, wrong, TOOL)


def test_a_chain_that_begins_in_motion_is_judged_without_a_start():
    robot = bench("puma560")
    commands = circle(robot, 260)
    plan = robot.planner.chain(robot.home(), commands[:150], TOOL, more=True)
    grown, left_out = robot.planner.extend(plan, plan.tail.more_at, commands[150:], TOOL)
    assert grown.moving
    times = Speeds(robot.planner, grown, commands[left_out:], TOOL).times
    chord_s = 2.0 * 0.05 * np.sin(np.radians(2.0)) / 0.15
    np.testing.assert_allclose(times.expected_s[:20], chord_s, rtol=1e-3)
    use = {moving: first_cycle(robot, grown, moving=moving) for moving in (True, False)}
    assert use[True] <= 1.0 < use[False]


def first_cycle(robot: Bench, plan: ChainPlan, *, moving: bool) -> float:
    """The largest share of an acceleration or a jerk that the first cycle of a plan is taken to use."""
    cycles = np.ones(len(plan.q) - 1)
    taken = Taken(
        q=plan.q,
        setpoints=plan.setpoints,
        override=cycles,
        acceleration=3.0 * cycles,
        turning_speed=cycles,
        turning_acceleration=cycles,
        cap=np.inf,
        X_flange_tool=TOOL,
        moving=moving,
    )
    use = limit_use(taken, robot.kinematics, robot.planner.limits.joints)
    return float(max(use.joints[1:, 0].max(), use.gaining[0]))


def test_a_stop_before_what_follows_lasts_as_long_as_the_jerks_need():
    limits = bench("irb2400").planner.limits
    step = limits.joints.jerk * limits.joints.period_s**3
    braking = np.array([0.0, 6.0, 9.0, 10.0])[:, None] * step
    first, rest = rows_of(braking), rows_of(braking[-1] + braking[-1] - braking[::-1])
    found = _then(first, 0.0, rest, limits)
    assert len(found.setpoints) == 4 + 2 + 3
    assert found.command.tolist() == [0, 0, 0, 0, 0, 0, 1, 1, 1]
    assert np.abs(np.diff(found.setpoints, 3, axis=0) / step).max() <= 1.0 + 1e-9


def rows_of(setpoints: Array) -> Joined:
    """One move with these set-points."""
    count = len(setpoints)
    return Joined(
        q=setpoints,
        setpoints=setpoints,
        command=np.zeros(count, dtype=np.int32),
        share=np.ones(count),
        lasts=(count - 1,),
        corners=(),
    )
