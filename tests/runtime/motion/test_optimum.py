"""Straight moves with ``ACCEL MAX`` against the optimum of another library under the limits of the joints.

Without a limit of jerk a move from rest to rest takes at most 1.10 of the time-optimal motion, and one cycle more since
it takes whole cycles. The speed of the tool is bounded in both, as that of one more joint.
"""

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import Array, pose
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import MAX, MoveLinear
from tests.campaign import size
from tests.runtime.motion import optimum
from tests.runtime.motion.motions import TOOL, Bench, bench

toppra = pytest.importorskip("toppra", reason="toppra has wheels for Linux on x86-64 only")

ROBOTS = ("puma560", "irb2400")
SHORTEST_S = 0.3
"""A shorter motion is judged by the cycles that it takes, not by its ratio."""
POINTS = 401


def random_line(robot: Bench, random: np.random.Generator) -> MovePlan:
    """Return the plan of a line of up to 0.4 m, as fast as the joints can."""
    while True:
        q = robot.home() + random.uniform(-0.3, 0.3, robot.spec.n)
        X, off = robot.tool(q), random.normal(size=3)
        off *= random.uniform(0.1, 0.4) / np.linalg.norm(off)
        end = pose(X[:3, 3] + off, X[:3, :3])
        command = MoveLinear(X_world_tool=end, speed=robot.spec.path.max_speed, acceleration=MAX, wrist="keep")
        try:
            return robot.planner.plan(q, command, TOOL)
        except Fault:
            continue


def optimum_s(robot: Bench, plan: MovePlan) -> float:
    """Return the least time of the path of a line."""
    assert plan.path is not None
    assert plan.piece is not None
    s = np.linspace(0.0, 1.0, POINTS)
    q = plan.piece.joints(s, np.repeat(plan.q[:1], POINTS, axis=0))
    tool: Array = plan.path.length * s
    return optimum.seconds(
        toppra,
        s,
        np.concatenate([q, tool[:, None]], axis=1),
        np.append(robot.speed, robot.spec.path.max_speed),
        np.append(robot.acceleration, 1e3),
    )


@pytest.mark.parametrize("shape", ["trapezoid", "jerk"])
@pytest.mark.parametrize("name", ROBOTS)
def test_a_line_takes_hardly_longer_than_the_time_optimal_motion_of_its_joints(name, shape):
    robot, random = bench(name, shape), np.random.default_rng(1)
    period_s = robot.profile.period_s
    found = []
    while len(found) < size(100, 6):
        plan = random_line(robot, random)
        best = optimum_s(robot, plan)
        if best >= SHORTEST_S:
            found.append((best, (len(plan.q) - 1) * period_s))
    for best, own in found:
        # the fastest of all, up to its grid: a shorter time would break a limit
        assert own >= 0.99 * best
        if shape == "trapezoid":
            assert own <= 1.10 * best + period_s, (best, own)
    if shape == "jerk":
        assert np.median([own / best for best, own in found]) <= 1.5
