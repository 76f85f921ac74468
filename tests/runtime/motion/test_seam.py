"""Seam tracking point by point (S1 of the specification), the tracker's filter, bounds and losses."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import inverse, pose, rotation_from_rpy
from runtime.core.units import DEG, MM
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.path_ik import Arm, LineSolver
from runtime.motion.seam import CalculatedMove, SeamLimits, SeamMove, SeamTracker, superposed
from runtime.settings.profile import WristOptions
from tests.runtime.motion.wrist_moves import C1_ANY, C3, E1, E2, KINEMATICS, NOTHING, SPEC, TOOL, path_of

DT = 0.008
FULL = np.array([0.0, 5.0 * MM, -3.0 * MM, 0.0, 0.0, 2.0 * DEG])
UNFILTERED = SeamLimits(filter_s=0.0)


def ramp(length):
    return lambda way, travel: FULL * min(1.0, way / length)


Tracked = tuple[SeamMove, SeamTracker, np.ndarray]
SAME = E2[0], (25, 15, 0, -70, -20, 35)
"""A move like E2 that keeps the sign of J5, and whose path stays in range."""
C1_SLOW = replace(C1_ANY, speed=tuple(np.radians([120.0] * 3)))


def tracked(move, options: WristOptions, read=None, limits=UNFILTERED, switch=None) -> Tracked:
    """Return a move at constant speed that follows a sensor, by default the ramp of S1."""
    path = path_of(move)
    arm = Arm(spec=SPEC, kinematics=KINEMATICS, fine=FineInterpolator(8, DT, np.zeros(6)), X_flange_tool=TOOL)
    start, end = (np.radians(q) for q in move)
    s = np.linspace(0.0, 1.0, 501)
    tracker = SeamTracker("torch", limits, DT, read or ramp(path.length))
    line = LineSolver(arm, path, start)
    calculated = CalculatedMove(line=line, s=s, period_s=DT, q_end=end, switch=switch)
    return SeamMove(calculated, start, tracker, options), tracker, path.poses(s)


def run(move: SeamMove, tracker: SeamTracker, samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Return joint angles and deviations of all samples but the first; no fault is expected."""
    rows, deviations = [], []
    for n in range(1, samples):
        q, fault = move.next(n)
        assert fault is None, fault
        rows.append(q)
        deviations.append(tracker.deviation)
    return np.array(rows), np.array(deviations)


S1 = {"E1 C1": (E1, C1_ANY), "E2 C1": (E2, C1_SLOW), "E2 C3": (E2, replace(C3, look_ahead=40))}


@pytest.mark.parametrize(("move", "options"), S1.values(), ids=S1)
def test_s1_ends_at_the_updated_end_point_in_the_taught_branch_and_follows_the_seam(move, options):
    going, tracker, planned = tracked(move, options)
    q, deviations = run(going, tracker, len(planned))
    np.testing.assert_allclose(deviations[-1], FULL)
    end = np.radians(move[1])
    X_end = superposed(planned[-1], deviations[-1])
    wanted = KINEMATICS.inverse_branch(X_end @ inverse(TOOL), KINEMATICS.branch_of(end), end)
    assert np.abs(np.degrees(q[-1] - wanted)).max() < 1e-6
    assert np.abs(wanted - end).max() < math.radians(15.0)  # no turn, no other branch
    tool = (KINEMATICS.forward(q) @ TOOL)[:, :3, 3]
    assert np.abs(tool - planned[1:, :3, 3] - deviations[:, :3]).max() < 1e-9
    assert going.law is not None


def test_before_the_switch_the_posture_follows_the_seam_too():
    going, tracker, planned = tracked(SAME, NOTHING)
    q, deviations = run(going, tracker, len(planned))
    X = KINEMATICS.forward(q) @ TOOL
    wanted = np.array([superposed(*each) for each in zip(planned[1:], deviations, strict=True)])
    np.testing.assert_allclose(X, wanted, atol=1e-10)


def test_conditions_see_the_updated_end_point():
    """At the sample that leaves the path (11') holds with the end as it is seen there, and not at the one before."""
    turned = np.array([0.0, 0.0, 0.0, 8.0 * DEG, 0.0, 0.0])
    going, _, planned = tracked(E2, C1_SLOW, lambda way, travel: turned * min(1.0, way / 0.1))
    asked, n = [], 0
    path = LineSolver(going._line.arm, going._line.path, np.radians(E2[0]))
    while going.law is None:
        n += 1
        going.next(n)
        X = superposed(planned[n], going._tracker.deviation) @ inverse(TOOL)
        q = KINEMATICS.inverse_branch(X, path.branch, going.before)
        left_s = 4.0 - n * DT
        asked.append([np.abs(end[3:] - q[3:]).max() / left_s for end in (going.q_end, np.radians(E2[1]))])
    limit = math.radians(120.0)
    assert asked[-1][0] > limit >= asked[-2][0]
    assert abs(asked[-1][0] / asked[-1][1] - 1.0) > 0.02  # with the taught end it would be another speed


def test_nothing_deviates_without_a_deviation():
    going, tracker, planned = tracked(E2, C1_SLOW, lambda way, travel: np.zeros(6))
    q, _ = run(going, tracker, len(planned))
    assert np.abs(np.degrees(q[-1]) - E2[1]).max() < 1e-9
    assert np.abs((KINEMATICS.forward(q) @ TOOL)[:, :3, 3] - planned[1:, :3, 3]).max() < 1e-12


def test_the_plan_may_switch_where_no_condition_does():
    going, tracker, _ = tracked(E2, NOTHING, switch=100)
    run(going, tracker, 101)
    assert going.law is None
    going.next(101)
    law: Any = going.law  # assigned by the line above
    assert law.s_switch == pytest.approx(0.2)


def test_superposed_adds_in_the_world_frame():
    X = pose((1.0, 2.0, 3.0), rotation_from_rpy((0.1, 0.2, 0.3)))
    moved = superposed(X, np.array([0.1, 0.2, 0.3, 0.0, 0.0, math.pi / 2]))
    np.testing.assert_allclose(moved[:3, 3], [1.1, 2.2, 3.3])
    np.testing.assert_allclose(moved[:3, :3], rotation_from_rpy((0, 0, math.pi / 2)) @ X[:3, :3])


def test_the_filter_is_critically_damped_and_exact():
    """A step of 1 mm: 1 - (1 + t / tau) exp(-t / tau), without overshoot, from a standing start."""
    tau = 0.04
    tracker = SeamTracker("torch", SeamLimits(filter_s=tau), DT, lambda way, travel: np.full(6, MM))
    seen = []
    for _ in range(60):
        tracker.observe(0.0, np.ones(3))
        seen.append(tracker.deviation[0])
    t = DT * np.arange(1, 61)
    np.testing.assert_allclose(seen, MM * (1.0 - (1.0 + t / tau) * np.exp(-t / tau)), rtol=1e-9)
    assert np.diff(seen, prepend=0.0)[0] < np.diff(seen).max()


def test_a_lost_sample_holds_the_last_and_too_many_are_a_fault():
    readings = iter([np.full(6, MM), None, None, np.full(6, 2 * MM)] + [None] * 20)
    tracker = SeamTracker("torch", SeamLimits(filter_s=0.0, lost_s=0.1), DT, lambda way, travel: next(readings))
    for expected in (1.0, 1.0, 1.0, 2.0):
        tracker.observe(0.0, np.ones(3))
        assert tracker.deviation[0] == pytest.approx(expected * MM)
    assert tracker.lost == 2
    for _ in range(12):  # 96 ms
        tracker.observe(0.0, np.ones(3))
    with pytest.raises(Fault, match=r"RBL525: .*torch .*104 ms"):
        tracker.observe(0.0, np.ones(3))
    assert tracker.deviation[0] == pytest.approx(2 * MM)


@pytest.mark.parametrize(
    "reading",
    [
        [0.0, 16 * MM, 15 * MM, 0, 0, 0],
        [0, 0, 0, 0, 0, -10.5 * DEG],
        [math.nan, 0, 0, 0, 0, 0],
        [0, 0, 0, math.inf, 0, 0],
    ],
)
def test_a_reading_beyond_its_bound_is_a_fault_and_is_not_followed(reading):
    tracker = SeamTracker("torch", UNFILTERED, DT, lambda way, travel: np.array(reading, dtype=float))
    with pytest.raises(Fault, match=r"RBL524: .*torch "):
        tracker.observe(0.0, np.ones(3))
    assert not tracker.deviation.any()


def test_what_the_joints_cannot_follow_is_a_fault_and_the_point_goes_on_along_the_path():
    """A jump of 60 mm in one cycle, unfiltered."""
    length = path_of(SAME).length
    jump = np.array([0, 0, 60 * MM, 0, 0, 0])
    limits = SeamLimits(filter_s=0.0, most=0.1)
    going, _, planned = tracked(SAME, NOTHING, lambda way, travel: jump * (way > length / 2), limits)
    n, fault = 0, None
    while fault is None:
        n += 1
        q, fault = going.next(n)
    assert fault.code == "RBL526"
    assert "seam" in fault.message
    assert n in (250, 251)
    np.testing.assert_allclose((KINEMATICS.forward(q) @ TOOL)[:3, 3], planned[n, :3, 3], atol=1e-9)
    rest, whole = going.rest(n + 1)
    assert whole
    assert len(rest) == len(planned) - n - 1
    np.testing.assert_allclose((KINEMATICS.forward(rest[-1]) @ TOOL)[:3, 3], planned[-1, :3, 3], atol=1e-9)


def test_the_next_move_goes_on_where_the_sensor_was():
    ways = []
    going, tracker, planned = tracked(SAME, NOTHING, lambda way, travel: ways.append(way) or np.zeros(6))
    run(going, tracker, len(planned))
    going.finish()
    assert ways[-1] == pytest.approx(path_of(SAME).length)
    assert tracker.distance == pytest.approx(path_of(SAME).length)
