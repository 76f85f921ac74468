"""Straight moves under the limits of the joints alone, against the optimum of another library.

Without a limit of jerk and without one of the path, a move from rest to rest takes at most 1.10 of the time-optimal
motion, and one cycle more, since it takes whole cycles.
"""

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import Array, pose
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.chain.chain_path import derivatives
from runtime.motion.chain.rates import Bounds
from runtime.motion.chain.timing import Limits, Path, timed
from runtime.motion.commands import MoveLinear
from tests.campaign import size
from tests.runtime.motion import optimum
from tests.runtime.motion.motions import TOOL, Bench, bench

toppra = pytest.importorskip("toppra", reason="toppra has wheels for Linux on x86-64 only")

ROBOTS = ("puma560", "irb2400")
SHORTEST_S = 0.3
"""A shorter motion is judged by the cycles that it takes, not by its ratio."""
POINTS = 401


def random_line(robot: Bench, random: np.random.Generator) -> tuple[Array, MovePlan]:
    """Return places s (N + 1,) from 0 to 1 and the plan of a line of up to 0.4 m that can be run."""
    while True:
        q = robot.home() + random.uniform(-0.3, 0.3, robot.spec.n)
        X, off = robot.tool(q), random.normal(size=3)
        off *= random.uniform(0.1, 0.4) / np.linalg.norm(off)
        try:
            plan = robot.planner.plan(
                q, MoveLinear(X_world_tool=pose(X[:3, 3] + off, X[:3, :3]), speed=0.1, wrist="keep"), TOOL
            )
        except Fault:
            continue
        return np.linspace(0.0, 1.0, POINTS), plan


def joints(plan: MovePlan, s: Array) -> Array:
    """Return q (N + 1, n) at s (N + 1,) of a line."""
    assert plan.piece is not None
    return plan.piece.joints(s, np.repeat(plan.q[:1], len(s), axis=0))


def own_cycles(robot: Bench, plan: MovePlan, s: Array) -> int:
    """Return how many cycles a line takes at the limits of the joints alone."""
    along, across = derivatives(s, joints(plan, s))
    bounds = Bounds(
        along=along,
        across=across,
        beside=0.0 * along,
        most=np.broadcast_to(robot.acceleration, along.shape),
        fastest=((robot.speed / np.maximum(np.abs(along), 1e-9)) ** 2).min(axis=1),
    )
    limits = Limits(
        speed=robot.speed,
        acceleration=robot.acceleration,
        jerk=np.full(robot.spec.n, np.inf),
        period_s=robot.profile.period_s,
    )
    return len(timed(Path(x=s, bounds=bounds, joints=lambda x: joints(plan, x)), limits, 0.0).x) - 1


@pytest.mark.parametrize("name", ROBOTS)
def test_a_line_takes_hardly_longer_than_the_time_optimal_motion(name):
    robot, random = bench(name, "trapezoid"), np.random.default_rng(1)
    ratios = []
    while len(ratios) < size(100, 6):
        s, plan = random_line(robot, random)
        best = optimum.seconds(toppra, s, joints(plan, s), robot.speed, robot.acceleration)
        if best >= SHORTEST_S:
            own = own_cycles(robot, plan, s) * robot.profile.period_s
            ratios.append(own / best)
            assert own <= 1.10 * best + robot.profile.period_s, (best, own)
    # the fastest of all, up to its grid: a shorter time would break a limit
    assert min(ratios) > 0.99
