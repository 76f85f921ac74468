"""The overlap of two moves as a function of rows, and the search for how long it may be."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.motion.blend import BlendLimits, _largest, blend, overlapped
from runtime.motion.commands import MoveJoint
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.path_ik import Arm
from runtime.motion.time_scaling import Pace
from tests.runtime.motion.motions import TOOL, bench, limits_broken

ROBOT = bench("irb2400")
PACE = Pace.of(ROBOT.spec, ROBOT.profile)
ARM = Arm(spec=ROBOT.spec, kinematics=ROBOT.kinematics, fine=PACE.fine, X_flange_tool=TOOL)


def rows(*ways: float) -> list[np.ndarray]:
    """Joint moves one after the other, J1 and J2 by turns."""
    q, found = ROBOT.home(), []
    for axis, way in enumerate(ways):
        plan = ROBOT.planner.plan(q, MoveJoint(q_end=q + way * np.eye(6)[axis % 2], speed=0.5), TOOL)
        found.append(plan.q)
        q = plan.q[-1]
    return found


@pytest.mark.parametrize("m", [0, 1, 2, 7])
def test_both_moves_run_at_once_for_so_many_cycles_and_are_themselves_before_and_after(m):
    random = np.random.default_rng(0)
    a = random.normal(size=(21, 6))
    b = random.normal(size=(16, 6))
    b[0] = a[-1]
    found = overlapped(a, b, m)
    assert len(found) - 1 == 20 + 15 - m
    np.testing.assert_array_equal(found[: 20 - m + 1], a[: 20 - m + 1])
    np.testing.assert_array_equal(found[20 + (m == 0) :], b[max(m, 1) :])
    for i in range(1, m):
        np.testing.assert_allclose(found[20 - m + i], a[20 - m + i] + b[i] - b[0], atol=1e-15)


@pytest.mark.parametrize("most", [0, 1, 2, 3, 50, 127, 128])
def test_the_largest_overlap_is_found_and_what_is_taken_has_been_tried(most):
    for limit in range(most + 1):
        tried = []

        def holds(m: int, limit: int = limit, tried: list = tried) -> bool:
            tried.append(m)
            return m <= limit

        assert _largest(most, holds) == limit
        assert len(tried) <= 9
    random = np.random.default_rng(most)
    for _ in range(50):
        good = {m for m in range(1, most + 1) if random.random() < 0.5}
        assert _largest(most, good.__contains__) in good | {0}


def test_without_a_zone_or_without_room_nothing_overlaps():
    a, b = rows(0.3, 0.3)
    for most, zone in ((10, 0.0), (0, 0.1), (10, 1e-12)):
        joined, corner = blend(a, b, (most, 10), zone, ARM, BlendLimits(pace=PACE, acceleration=5.0, turning=3.0))
        np.testing.assert_array_equal(joined, np.concatenate([a, b[1:]]))
        assert (corner.cycles, corner.reach, corner.deviation, corner.radius) == (0, 0.0, 0.0, zone)


def test_each_rule_makes_a_blend_shorter():
    a, b = rows(0.5, 0.5)
    half = len(b) // 2

    def cycles(half: int = half, zone: float = 1.0, pace: Pace = PACE, acceleration: float = 100.0) -> int:
        limits = BlendLimits(pace=pace, acceleration=acceleration, turning=100.0)
        return blend(a, b, (len(a) // 2, half), zone, ARM, limits)[1].cycles

    free = cycles()
    assert free > 15
    assert cycles(half=10) == 10
    assert 0 < cycles(zone=0.03) < free
    assert 0 < cycles(pace=replace(PACE, acceleration=PACE.acceleration * [0.3, 1, 1, 1, 1, 1])) <= free
    assert cycles(acceleration=0.0) < free


def test_straight_back_both_moves_accelerate_the_same_way_and_the_joint_limits_what_overlaps():
    q, end = ROBOT.home(), ROBOT.home() + 0.5 * np.eye(6)[0]
    there, back = (ROBOT.planner.plan(a, MoveJoint(q_end=b), TOOL).q for a, b in ((q, end), (end, q)))
    halves = len(there) // 2, len(back) // 2
    tight, loose = (
        blend(there, back, halves, 1.0, ARM, BlendLimits(pace=pace, acceleration=100.0, turning=100.0))
        for pace in (PACE, replace(PACE, acceleration=2.0 * PACE.acceleration))
    )
    assert 0 < tight[1].cycles < loose[1].cycles
    assert limits_broken(ROBOT, tight[0]) == []
    assert limits_broken(ROBOT, loose[0]) != []


def test_nothing_that_is_played_is_beyond_the_extremes():
    (a,) = rows(0.5)
    middle = a[10:40]
    played = FineInterpolator(64, 8e-3, a[0]).continue_(middle)[:, : (len(middle) - 3) * 64]
    lowest, highest, speed, acceleration = PACE.fine.extremes(middle)
    assert (played[0] >= lowest - 1e-14).all() and (played[0] <= highest + 1e-14).all()
    assert (np.abs(played[1]) <= speed + 1e-12).all() and (np.abs(played[2]) <= acceleration + 1e-10).all()
    np.testing.assert_allclose(speed, np.abs(played[1]).max(axis=0), rtol=0.01, atol=1e-12)
    np.testing.assert_allclose(acceleration, np.abs(played[2]).max(axis=0), rtol=0.01, atol=1e-9)
