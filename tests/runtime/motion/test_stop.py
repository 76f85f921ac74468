"""A controlled stop by itself: the curve it keeps, the limits it keeps, and that none shorter would."""

import numpy as np
import pytest

from runtime.motion.fine_interpolator import FineInterpolator, through
from runtime.motion.stop import stopping_rows

TICKS, PERIOD = 8, 8e-3
CYCLES = (
    *range(3, 17),
    18,
    20,
    22,
    24,
    27,
    30,
    33,
    37,
    41,
    46,
    51,
    57,
    64,
    72,
    81,
    91,
    102,
    114,
    128,
    144,
    162,
    182,
    204,
    229,
)
"""How long a stop may last, in cycles: each an eighth more than the one before."""


def fine(rows):
    return FineInterpolator(TICKS, PERIOD, rows[0])


def line(speed, count=400):
    """Rows of joints that turn evenly at speeds (n,) rad/s."""
    return np.arange(count)[:, None] * np.atleast_1d(speed) * PERIOD


def swing(u):
    """Rows of two joints that swing from rest, at row numbers u."""
    return np.column_stack([0.5 * (1.0 - np.cos(0.008 * u)), 0.1 * (np.cos(0.006 * u) - 1.0)])


def passed(cycles):
    """Rows passed after each cycle of a stop: the integral of its rate, added up in small steps."""
    x = (np.arange(cycles * 1000) + 0.5) / (cycles * 1000)
    rate = 1.0 - (10.0 * x**3 - 15.0 * x**4 + 6.0 * x**5)
    return np.cumsum(rate)[999::1000] / 1000.0


def largest(rows):
    """Largest speed and acceleration of each joint when rows are played from the motion before them to their end.

    Found on ticks so short that nothing lies between them.
    """
    _, dq, ddq = np.abs(FineInterpolator(64, PERIOD, rows[0]).continue_(rows))
    return dq.max(axis=0), ddq.max(axis=0)


def on(sent, places):
    """Set-points of a command that passes places (K, n) after the set-point ``sent`` (n,), and rests at the last."""
    return through(np.concatenate([np.atleast_2d(sent), places]))[1:]


def passes(sent, found):
    """Where the command is at the knots of set-points (K, n) after ``sent`` (n,), and at last where it rests."""
    rows = np.concatenate([np.atleast_2d(sent), found, found[-1:]])
    return np.concatenate([(rows[:-3] + 4.0 * rows[1:-2] + rows[2:-1]) / 6.0, found[-1:]])


@pytest.mark.parametrize("cycles", [3, 4, 9])
def test_on_an_even_motion_the_rows_are_those_of_the_rate_and_half_the_cycles_pass(cycles):
    rows, at = line([1.0, -0.5]), 50
    stop = on(rows[at], rows[at] + np.outer(passed(cycles), rows[1]))
    needed = largest(np.concatenate([rows[at - 3 : at + 1], stop]))[1]
    found = stopping_rows(rows, at, fine(rows), np.array([10.0, 10.0]), needed * 1.0001)
    assert len(found) == cycles
    np.testing.assert_allclose(found, stop, atol=1e-8)
    np.testing.assert_allclose(found[-1], rows[at] + rows[1] * cycles / 2.0, atol=1e-12)


@pytest.mark.parametrize("at", [0, 1, 2, 3, 60])
@pytest.mark.parametrize("acceleration", [200.0, 40.0, 9.0, 2.0])
def test_a_stop_keeps_the_limits_and_the_next_shorter_one_would_not(at, acceleration):
    rows = swing(np.arange(600))
    limits = np.array([2.0, 2.0]), np.array([acceleration, 0.5 * acceleration])
    found = stopping_rows(rows, at, fine(rows), *limits)
    sent = rows[np.maximum(np.arange(at - 3, at + 1), 0)]

    def share(played):
        dq, ddq = largest(np.concatenate([sent, played]))
        return max((dq / limits[0]).max(), (ddq / limits[1]).max())

    assert len(found) in CYCLES
    assert share(found) <= 1.0 + 1e-9
    if len(found) > CYCLES[0]:
        shorter = CYCLES[CYCLES.index(len(found)) - 1]
        assert share(on(rows[at], swing(at + passed(shorter)))) > 1.0


def test_a_speed_that_is_too_high_is_no_stop_either():
    rows = line([1.0])
    assert len(stopping_rows(rows, 50, fine(rows), np.array([2.0]), np.array([1e6]))) == CYCLES[0]
    slow = stopping_rows(rows, 50, fine(rows), np.array([0.5]), np.array([1e6]))  # was over its limit before
    assert len(slow) == CYCLES[0]


def test_of_several_joints_the_one_that_is_nearest_to_its_limit_decides():
    rows = line([1.0, 1.0, 1.0])
    alone = stopping_rows(line([1.0]), 50, fine(line([1.0])), np.array([5.0]), np.array([20.0]))
    for joint in range(3):
        limits = np.full(3, 1e6)
        limits[joint] = 20.0
        assert len(stopping_rows(rows, 50, fine(rows), np.full(3, 5.0), limits)) == len(alone) > CYCLES[0]


def test_a_move_that_ends_sooner_than_any_stop_is_left_to_end():
    rows, limits = line([1.0], 60), (np.array([5.0]), np.array([5.0]))
    needed = len(stopping_rows(line([1.0]), 50, fine(rows), *limits))
    assert needed > 20
    left = needed // 2  # a stop of as many rows as are left, and one more: just possible, just not
    just = stopping_rows(line([1.0], 51 + left + needed % 2), 50, fine(rows), *limits)
    assert len(just) == needed
    ends = stopping_rows(line([1.0], 50 + left), 50, fine(rows), *limits)
    np.testing.assert_array_equal(ends, line([1.0], 50 + left)[51:])
    assert stopping_rows(rows, 59, fine(rows), *limits).shape == (0, 1)
    np.testing.assert_array_equal(stopping_rows(rows, 58, fine(rows), *limits), rows[59:])


def test_rows_that_break_off_in_motion_get_the_best_stop_that_they_allow():
    rows, limits = line([1.0], 60), (np.array([5.0]), np.array([5.0]))
    found = stopping_rows(rows, 40, fine(rows), *limits, False)
    longest = max(each for each in CYCLES if each / 2.0 <= 19)
    assert len(found) == longest
    inside = 40 + passed(longest) < 57  # where the four rows around are there
    there = rows[40] + np.outer(passed(longest), rows[1])
    np.testing.assert_allclose(passes(rows[40], found)[inside], there[inside], atol=1e-8)
    assert largest(np.concatenate([rows[37:41], found]))[1] > limits[1]
    # where nothing is left to choose from, what is left is played
    np.testing.assert_array_equal(stopping_rows(rows, 58, fine(rows), *limits, False), rows[59:])


def test_no_stop_lasts_longer_than_two_seconds():
    rows = line([1.0], 2000)
    for ends_at_rest, expected in ((True, 1949), (False, CYCLES[-1])):
        found = stopping_rows(rows, 50, fine(rows), np.array([5.0]), np.array([1e-3]), ends_at_rest)
        assert len(found) == expected


def test_what_was_sent_roughly_does_not_lengthen_the_stop():
    """A jerk in the rows that the pipeline holds already is over any limit; the rows after it are judged alone."""
    smooth = line([1.0])
    rough = smooth.copy()
    rough[48:] += 0.002  # two rows before the one that was sent last
    limits = np.array([5.0]), np.array([20.0])
    expected = stopping_rows(smooth, 50, fine(smooth), *limits)
    assert len(stopping_rows(rough, 50, fine(rough), *limits)) == len(expected)
    later = smooth.copy()
    later[52:] += 0.002  # a jerk that is still to come is on the way of the stop
    assert len(stopping_rows(later, 50, fine(later), *limits)) > len(expected)


def test_the_curve_between_rows_is_that_of_the_fine_interpolator():
    rows = np.sin(0.05 * np.arange(200))[:, None]
    found = stopping_rows(rows, 100, fine(rows), np.array([100.0]), np.array([1e5]))
    assert len(found) == 3
    u = 100 + passed(3)
    for value, place in zip(passes(rows[100], found)[:, 0], u, strict=True):
        k = int(place)
        weights = FineInterpolator.weights(np.array(place - k))
        assert value == pytest.approx(float(weights @ rows[k - 1 : k + 3, 0]), abs=1e-9)


@pytest.mark.parametrize("jerk", [0.0, 0.02])
def test_a_limit_that_three_cycles_miss_by_a_twentieth_takes_four(jerk):
    """Also after a jerk that has been played: only what the pipeline still holds may be as rough as it is.

    The motion is slowing down already, so a stop asks most of its first ticks, those that the pipeline reaches.
    """

    def slowing(u):
        return np.asarray((u - 50) * PERIOD - 4.0 * ((u - 50) * PERIOD) ** 2)[:, None]

    rows = slowing(np.arange(60))
    needed = largest(np.concatenate([rows[47:51], on(rows[50], slowing(50 + passed(3)))]))[1]
    rows[:47] -= jerk
    for share, cycles in ((1.01, 3), (0.95, 4)):
        assert len(stopping_rows(rows, 50, fine(rows), np.array([1.6]), needed * share)) == cycles


@pytest.mark.parametrize("left", [36, 57])
def test_a_stop_may_take_all_of_which_the_neighbours_are_there(left):
    rows = line([1.0], 41 + left)
    found = stopping_rows(rows, 40, fine(rows), np.array([5.0]), np.array([0.1]), False)
    cycles = max(each for each in CYCLES if each / 2.0 < left)
    assert len(found) == cycles
    u = 40 + passed(cycles)
    padded = np.concatenate([rows, rows[-1:]])  # the last row is where the arm stays
    for value, place in zip(passes(rows[40], found)[:, 0], u, strict=True):
        k = min(int(place), len(rows) - 2)
        weights = FineInterpolator.weights(np.array(place - k))
        assert value == pytest.approx(float(weights @ padded[k - 1 : k + 3, 0]), abs=1e-8)
    assert found[-1, 0] == pytest.approx(float(rows[40, 0]) + 0.5 * cycles * PERIOD, abs=1e-12)


def test_where_a_falling_rate_would_be_too_fast_on_its_way_the_arm_brakes_harder():
    """The joint gets faster along the path: a stop must not take it over its speed limit."""
    t = PERIOD * (np.arange(200) - 50)
    rows, acceleration = (0.9 * t + 7.5 * t**2)[:, None], np.array([25.0])
    stops = stopping_rows(rows, 50, fine(rows), np.array([10.0]), acceleration)
    assert len(stops) in CYCLES
    speed = largest(np.concatenate([rows[47:51], stops]))[0]
    braked = stopping_rows(rows, 50, fine(rows), 0.9 * speed, acceleration)
    fastest, gained = largest(np.concatenate([rows[47:51], braked]))
    assert fastest <= 0.9 * speed * (1 + 1e-9)
    assert gained <= acceleration * (1 + 1e-9)
    assert len(braked) < len(stops)
    # on the curve at every cycle, and at rest
    places = passes(rows[50], braked)[:, 0]
    assert (np.diff(places) >= -1e-12).all()
    assert rows[50, 0] < places[-1] < rows[62, 0]
    # where the joint may not even be as fast as it is, nothing can be done but to go on
    np.testing.assert_array_equal(stopping_rows(rows, 50, fine(rows), 0.5 * speed, acceleration), rows[51:])
