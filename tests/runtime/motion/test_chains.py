"""A sample of ``make blend-campaign``, and that its checks find what is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import pose
from runtime.motion.chaining import rest_cycles
from runtime.motion.commands import MoveLinear
from tests.campaign import size
from tests.runtime.motion.chains import (
    ROBOTS,
    SLACK,
    Chain,
    broken,
    examine,
    from_arc,
    from_line,
    random_chain,
    spline,
    worst_share,
)
from tests.runtime.motion.motions import TOOL, bench

SAMPLE = {"puma560": 7, "irb2400": 7, "manutec_r3": 7, "ur5e": 1, "cobra600": 1}
"""Chains in a sample, where those of an arm without a closed form cost ten times as much."""
MOVES = size(5, 3)


@pytest.mark.parametrize("name", ROBOTS)
def test_random_chains_keep_limits_and_ranges_leave_paths_only_in_zones_and_take_no_longer(name):
    robot, random = bench(name), np.random.default_rng(4)
    saved = []
    for _ in range(size(60, SAMPLE[name])):
        found, share = examine(robot, random_chain(robot, random, MOVES if SAMPLE[name] > 1 else size(5, 2)))
        assert not found.total(), found
        saved.append(share)
    assert np.mean(saved) > 0.02 or len(saved) == 1


def corner() -> Chain:
    """Two lines of 100 mm with a corner between them."""
    robot = bench("puma560")
    X = robot.tool(robot.home())
    commands, ends, alone = [], [robot.home()], []
    for off in ((0.0, 0.1, 0.0), (0.0, 0.1, 0.1)):
        commands.append(MoveLinear(X_world_tool=pose(X[:3, 3] + off, X[:3, :3]), zone=0.01))
        plan = robot.planner.plan(ends[-1], commands[-1], TOOL)
        ends.append(plan.q[-1])
        alone.append(len(plan.q) - 1)
    return Chain(start=ends[0], commands=tuple(commands), ends=tuple(ends), alone=tuple(alone))


def test_what_is_wrong_is_found():
    robot, run = bench("puma560"), corner()
    found = robot.planner.chain(run.start, run.commands, TOOL)
    assert not broken(robot, run, found).total()
    rows, first = found.setpoints, len(found.q) // 4
    aside, far, jerky = rows.copy(), rows.copy(), rows.copy()
    aside[first - 5 : first + 6] += 1e-7 * np.hanning(11)[:, None]
    far[first - 20 : first + 21] += 9.0 * np.hanning(41)[:, None]
    jerky[first] += 0.01
    smaller = replace(run, commands=tuple(replace(each, zone=0.5 * each.zone) for each in run.commands))
    beside = np.concatenate([rows[:-1], rows[-1:] + 1e-8])
    wrong = (
        ("zone", run, aside),
        ("zone", smaller, rows),
        ("limits", run, jerky),
        ("range", run, far),
        ("stop", run, beside),
        ("stop", run, np.concatenate([rows[:1] + 1e-15, rows[1:]])),
    )
    for kind, asked, setpoints in wrong:
        assert broken(robot, asked, replace(found, setpoints=setpoints))[kind], kind


def test_a_chain_that_is_slower_than_its_stops_or_refused_is_found(monkeypatch):
    robot, run = bench("puma560"), corner()
    whole = type(robot.planner).chain

    def slow(planner, start, commands, tool):
        found = whole(planner, start, commands, tool)
        return replace(found, q=np.repeat(found.q, 2, axis=0))

    monkeypatch.setattr(type(robot.planner), "chain", slow)
    count, share = examine(robot, run)
    assert (count["time"], count.total()) == (1, 1)
    assert share < 0.0

    def refused(planner, start, commands, tool):
        raise Fault("RBL404", "no")

    monkeypatch.setattr(type(robot.planner), "chain", refused)
    assert examine(robot, run)[0] == {"fault": 1}


def test_limits_are_judged_between_the_ticks_too():
    """A parabola through set-points that are within the speed where it is sampled, and over it at its top."""
    robot = bench("puma560")
    h, n = robot.profile.period_s, robot.spec.n
    steps = np.concatenate([np.linspace(0.0, 1.0, 200), [1.0], np.linspace(1.0, 0.0, 200)])
    rows = np.cumsum(steps)[:, None] * np.eye(n)[0] * robot.speed[0] * h
    rows -= rows[0]
    assert worst_share(robot, rows) == pytest.approx(1.0, abs=1e-9)
    assert not worst_share(robot, rows * (1.0 + 1e-6)) <= SLACK
    assert not worst_share(robot, rows * np.nan) <= SLACK


def test_the_spline_and_the_distances_are_what_they_say():
    rows = np.linspace(0.0, 1.0, 9)[:, None] ** 2
    fine = spline(rows, np.array([0.0, 0.5]))
    np.testing.assert_allclose(fine[1:-1, 0], (rows[:-2] + 4.0 * rows[1:-1] + rows[2:]) / 6.0)
    start, via, end = np.array([[1.0, 0, 0], [0, 1.0, 0], [-1.0, 0, 0]])
    points = np.array([[0, 2.0, 0], [0, 0.5, 1.0], [1.0, -1.0, 0], [-1.0, -1.0, 0], [-2.0, 0.0, 0]])
    np.testing.assert_allclose(from_arc(points, start, via, end), [1.0, np.hypot(0.5, 1.0), 1.0, 1.0, 1.0])
    np.testing.assert_allclose(from_line(points, start, end), [2.0, np.hypot(0.5, 1.0), 1.0, 1.0, 1.0])


def test_a_chain_is_parted_where_it_stops():
    robot, random = bench("irb2400"), np.random.default_rng(1)
    chain = random_chain(robot, random, 4)
    zones = (0.01, 0.0, 0.01, 0.01)
    commands = tuple(replace(each, zone=zone) for each, zone in zip(chain.commands, zones, strict=True))
    first, second = replace(chain, commands=commands).runs()
    assert (first.commands, second.commands) == (commands[:2], commands[2:])
    assert second.start is chain.ends[2]
    assert len(first.ends) == len(second.ends) == 3
    assert first.alone + second.alone == chain.alone


def test_moves_that_stop_one_after_the_other_keep_the_jerk_where_the_arm_stands():
    """Each takes nearly all of it: a cycle of rest parts two that would pass it together, one pair of these three."""
    robot, rested = bench("irb2400"), []
    for seed in (251, 252, 253):
        run = random_chain(robot, np.random.default_rng(seed), 2)
        stopping = tuple(replace(each, zone=0.0) for each in run.commands)
        found = robot.planner.chain(run.start, stopping, TOOL)
        assert worst_share(robot, found.setpoints, jerk=True) <= SLACK, seed
        rested.append(len(found.q) - 1 - sum(run.alone))
    assert rested == [0, 0, 1]


@pytest.mark.parametrize(("turn", "cycles"), [(1.0, 2), (-1.0, 0), (0.1, 2)])
def test_as_many_cycles_of_rest_part_two_moves_as_their_jerks_need(turn, cycles):
    """Steps of 6, 3 and 1 jerks and back are those of a whole jerk, to a stop and from it."""
    limits = bench("irb2400").planner.limits
    step = limits.joints.jerk * limits.joints.period_s**3
    braking = np.array([0.0, 6.0, 9.0, 10.0])[:, None] * step
    begins = braking[-1] + turn * np.array([0.0, 1.0, 4.0, 10.0])[:, None] * step
    assert rest_cycles(braking, begins, limits) == cycles
    assert rest_cycles(braking, begins * np.nan, limits) == 2
    rests = np.repeat(braking[-1:], cycles, axis=0)
    worst = np.abs(np.diff(np.concatenate([braking, rests, begins[1:]]), 3, axis=0) / step).max()
    assert worst <= 1.0 + 1e-9
