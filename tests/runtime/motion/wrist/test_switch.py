"""Every row of the tables in section 7.2 of the specification (docs/wrist.md), one unit in the last digit given."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.motion.wrist.switch import PathTiming, WristLaw, WristLimits, first_trigger
from runtime.settings.profile import WristOptions
from tests.runtime.motion.wrist_moves import (
    C1_ALL,
    C1_ANY,
    C3,
    C4,
    C6,
    E1,
    E2,
    E3,
    NOTHING,
    SPEC,
    Done,
    carry_out,
    path_of,
)

ROBOT = (360.0, 360.0, 450.0)
WRIST, MAIN = slice(3, 6), slice(0, 3)


def last_digit(printed: str) -> float:
    """Return one unit in the last digit of a printed number."""
    return 10.0 ** -len(printed.partition(".")[2])


def same(value: float, printed: str) -> bool:
    return abs(value - float(printed)) <= last_digit(printed)


def test_the_moves_are_those_of_the_specification():
    for move, p_start, p_end, length, speed in (
        (E1, (782.43, -237.05, 655.12), (857.11, 211.59, 1039.10), "595.23", "148.81"),
        (E2, (1257.19, 385.01, 891.22), (1200.90, 521.38, 1124.52), "276.04", "69.01"),
        (E3, (821.19, 40.54, 1919.45), (927.29, -274.08, 1664.29), "418.75", "104.69"),
    ):
        path = path_of(move)
        assert 1e3 * path.X_start[:3, 3] == pytest.approx(p_start, abs=0.01)
        assert 1e3 * path.X_end[:3, 3] == pytest.approx(p_end, abs=0.01)
        assert same(1e3 * path.length, length)
        assert same(1e3 * path.length / 4.0, speed)


@pytest.mark.parametrize(
    ("move", "posture", "end", "least_j5", "fastest"),
    [
        (E1, "rpy", (125, 65, -95), "54.3", "34.6"),
        (E2, "rpy", (-225, -10, 215), "5.95", "102"),
        (E3, "rpy", (210, 10, -130), "7.4", "66"),
        (E3, "axis", (210, 10, -130), "0.40", "1008"),
    ],
)
def test_the_conventional_move_ends_at_the_flipped_solution(move, posture, end, least_j5, fastest):
    done = carry_out(move, NOTHING, ROBOT, posture=posture)
    assert done.q_deg[-1, 3:] == pytest.approx(end, abs=1e-9)
    np.testing.assert_allclose(done.taken[-1], done.planned[-1], atol=1e-12)
    assert same(np.abs(done.q_deg[:, 4]).min(), least_j5)
    assert same(done.speed(WRIST).max(), fastest)


ROWS = [
    # move, posture, options, theta_kd, dt; switch s, axes, wrist speed after, main axes, posture deviation
    (E1, "rpy", C1_ANY, 120, 0.01, "2.71", "J4", ("119.57", "92.9", "114.5"), "41", "43.6"),
    (E1, "rpy", C1_ALL, 120, 0.01, "2.99", "", ("160.8", "120.0", "154.0"), "50", "44.1"),
    (E1, "rpy", C1_ANY, ROBOT, 0.01, "3.51", "J4", ("355", "256", "345"), "98", "45.6"),
    (E1, "rpy", C4, ROBOT, 0.01, "1.84", "J4", ("57.9", "55.7", "57.9"), "28", "43.5"),
    (E2, "rpy", C3, ROBOT, 0.01, "2.23", "J4", ("76.2", "11.3", "64.2"), "8.6", "7.6"),
    (E2, "rpy", C1_ANY, 120, 0.01, "2.79", "J4", ("119.6", "16.8", "108.2"), "12", "7.5"),
    (E2, "rpy", C1_ALL, 120, 0.01, "3.83", "", ("1020", "117", "1010"), "74", "7.6"),
    (E3, "axis", C4, ROBOT, 0.01, "2.78", "J4", ("79.0", "8.5", "64.1"), "6.4", "2.8"),
    (E3, "axis", C6, ROBOT, 0.01, "2.71", "", ("36.7", "8.2", "21.8"), "5", "1.35"),
    (E3, "axis", C6, 120, 0.01, "2.62", "", None, "5", "0.83"),
    (E1, "rpy", C1_ANY, 120, 0.008, "2.712", "J4", ("119.8", None, None), "41", "43.6"),
    (E1, "rpy", C1_ANY, 120, 0.1, "2.700", "J4", ("118.4", None, None), "40", "43"),
]


COLUMNS = ("move", "posture", "options", "limit", "dt", "switch", "axis", "after", "main", "turned")


@pytest.mark.parametrize(COLUMNS, ROWS)
def test_exceptional_operation(move, posture, options, limit, dt, switch, axis, after, main, turned):
    done = carry_out(move, options, limit, dt=dt, posture=posture)
    assert same(done.switch * dt, switch)
    if axis:
        assert done.trigger.axis == int(axis[1]) - 1
    speed = done.speed(WRIST, done.switch)
    assert all(same(value, printed) for value, printed in zip(speed, after or (), strict=False) if printed), speed
    assert same(done.speed(MAIN, done.switch).max(), main)
    assert same(done.posture_deg, turned)
    must_hold(done, move)
    if options.speed_condition == "any":
        assert (speed <= np.broadcast_to(limit, 3)).all()


def must_hold(done: Done, move) -> None:
    """What the specification asks of every run: end angles, line and speed of the tool."""
    assert np.abs(done.q_deg[-1] - move[1]).max() < 1e-6
    assert done.off_line_mm < 1e-6
    assert np.ptp(done.tool_speed_mm_s) < 1e-6


def test_the_range_of_e1_is_never_left_so_c3_alone_does_not_fire():
    done = carry_out(E1, C3, ROBOT)
    assert done.trigger is None
    assert done.q_deg[-1, 3:] == pytest.approx((125, 65, -95), abs=1e-9)


def test_ranges_of_the_wrist():
    lowest, highest = (f(carry_out(E1, C1_ANY, 120).q_deg[:, 3:], axis=0) for f in (np.min, np.max))
    assert [same(*pair) for pair in zip(lowest, ("-55", "-65", "-63"), strict=True)] == [True] * 3
    assert [same(*pair) for pair in zip(highest, ("99", "65", "85"), strict=True)] == [True] * 3
    assert same(carry_out(E2, C3, ROBOT).q_deg[:, 3].min(), "-179.9")
    assert same(carry_out(E2, C1_ANY, 120).q_deg[:, 3].min(), "-189.7")  # C1 alone does not protect the range


def test_nothing_bounds_the_wrist_before_the_switch_but_the_guard():
    without = carry_out(E3, C4, ROBOT, posture="axis").speed(WRIST)
    assert same(without[0], "979") and same(without[2], "994")
    for limit, printed in ((ROBOT, ("349.5", "8.2", "364.6")), (120, ("99.7", "8.1", "114.8"))):
        whole = carry_out(E3, C6, limit, posture="axis").speed(WRIST)
        assert all(same(*pair) for pair in zip(whole, printed, strict=True))
        assert (whole <= np.broadcast_to(limit, 3)).all()
        assert np.diff(np.sign(carry_out(E3, C6, limit, posture="axis").q_deg[:, 4])).any()  # J5 passes through 0


def test_hermite_takes_the_jump_out_of_the_switch():
    """E1, C1 at 80 deg/s; the profile divides by the peak of the shape, so 128 deg/s are given."""
    hermite = carry_out(E1, replace(C1_ANY, shape="hermite"), 80.0 * 1.6)
    linear = carry_out(E1, C1_ANY, 80.0)
    assert hermite.switch == linear.switch and same(hermite.switch * 0.01, "2.25")
    assert [same(*pair) for pair in zip(hermite.speed(WRIST, 225), ("128", "102", "123"), strict=True)] == [True] * 3
    assert same(hermite.speed(MAIN, 225).max(), "40") or same(hermite.speed(MAIN, 225).max(), "39")
    assert same(hermite.posture_deg, "43.1")
    must_hold(hermite, E1)

    def acceleration(done: Done) -> float:
        return float(np.abs(np.diff(done.q_deg[done.switch - 1 :, 3:], 2, axis=0)).max() / 0.01**2)

    assert same(acceleration(hermite), "347")
    assert same(acceleration(carry_out(E1, C1_ANY, 120.0)), "15054")


@pytest.mark.parametrize("width", [0.25, 0.5, 1.0])
def test_the_soft_start_has_no_jump_of_speed_and_the_peak_that_c1_counts_with(width):
    s, step = np.linspace(0.0, 1.0, 401), 1.0 / 400
    start, end, slope = np.zeros(3), np.array([1.0, -2.0, 0.5]), np.array([0.3, 0.1, -0.2])
    law = WristLaw(s_switch=0.0, start=start, end=end, slope=slope, shape="smooth", width=width)
    q = law.angles(s)
    rate = np.diff(q, axis=0) / step
    np.testing.assert_allclose(q[[0, -1]], [start, end], atol=1e-15)
    np.testing.assert_allclose(rate[0], slope, atol=0.02)
    # of the slope: that of 3 u^2 - 2 u^3 at its middle
    steepest = 1.5 * np.abs(end - slope) / (1.0 - width / 2.0) / width
    assert (np.abs(np.diff(rate, axis=0)).max(axis=0) <= 1.001 * steepest * step).all()
    from_rest = replace(law, slope=np.zeros(3))
    peak = np.abs(np.diff(from_rest.angles(s), axis=0)).max(axis=0) / step
    assert peak == pytest.approx(np.abs(end) * WristOptions(width=width).peak, rel=1e-3)


def test_remaining_time_and_distance_fire_where_they_say():
    by_time = carry_out(E2, replace(NOTHING, remaining_time=1.0), ROBOT)
    assert by_time.trigger.condition == "C2"
    assert by_time.trigger.index * 0.01 == pytest.approx(3.0)
    by_distance = carry_out(E2, replace(NOTHING, remaining_distance=0.06901), ROBOT)
    assert abs(by_distance.trigger.index - 300) <= 1
    must_hold(by_time, E2)


def test_a_constant_reference_counts_from_the_start_or_the_end():
    start = carry_out(E1, replace(C4, deviation_condition="start"), ROBOT)
    moved = np.abs(start.q_deg[start.switch] - start.q_deg[0])[3:]
    assert (moved <= (90, 180, 90)).all()
    assert start.switch > carry_out(E1, C4, ROBOT).switch
    assert carry_out(E1, replace(C4, deviation_condition="end"), ROBOT).trigger.index == 1  # J5 is 130 deg away, J6 100


def test_a_move_that_keeps_the_sign_of_j5_behaves_the_same_way():
    """(v) of the specification: conditions do not ask for signs, and T = 0 is met only where angles differ."""
    same_sign = E2[0], (25, 15, 0, -70, -20, 35)
    assert carry_out(same_sign, replace(C1_ANY, deviation_condition="moving"), ROBOT).trigger is None
    done = carry_out(same_sign, replace(NOTHING, remaining_time=2.0), ROBOT)
    assert done.trigger.condition == "C2"
    must_hold(done, same_sign)


def test_the_first_condition_is_latched_and_the_earliest_counts():
    both = carry_out(E1, replace(C1_ANY, deviation_condition="moving"), 120.0)
    assert both.trigger.condition == "C4"
    assert both.trigger.index == min(carry_out(E1, one, 120.0).trigger.index for one in (C1_ANY, C4))


def test_a_path_that_is_lost_is_a_condition_of_its_own():
    q = np.zeros((11, 6))
    q[6:] = np.nan
    reach = np.ones(3)
    timing = PathTiming(s=np.linspace(0.0, 1.0, 11), period_s=0.008)
    found = first_trigger(q, np.zeros(6), timing, WristLimits(speed=reach, lower=-reach, upper=reach), NOTHING)
    assert (found.index, found.condition, found.axis) == (6, "reach", None)


def test_the_two_hazards_of_the_specification_are_where_it_says():
    """(vi): one move has no solution at 1.28 s, the other ends with J1 239 deg off, on another side of the arm."""
    lost = carry_out(((-20, -25, -30, 50, -30, 50), (-55, -50, -35, -30, 30, 45)), C4, ROBOT, dt=0.04)
    assert np.argmin(np.isfinite(lost.q_deg).all(axis=1)) * 0.04 == pytest.approx(1.28)
    end = (-15, -45, -20, 10, 65, 75)
    astray = carry_out(((-30, -20, -20, 5, -65, 60), end), C1_ANY, (119, 119, 148), dt=0.04)
    assert abs(astray.q_deg[-1, 0] - end[0]) == pytest.approx(239, abs=1)
    assert astray.off_line_mm < 1e-6  # the tool point is where it should be all the same


def test_the_limits_of_the_robot_are_those_of_the_specification():
    assert np.degrees(SPEC.per_axis("limits", "speed")[3:]) == pytest.approx(ROBOT)
