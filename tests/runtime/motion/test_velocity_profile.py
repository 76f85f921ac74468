"""Speed profiles: rest to rest, within the limits, in whole cycles, as fast as the limits allow."""

import math

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.motion.velocity_profile import SpeedLimits, bound, profile, shortest_s

PERIOD = 0.008


@pytest.mark.parametrize("length", [0.0005, 0.02, 0.4, 2.0])
def test_limits_hold_and_the_ends_are_exact(length):
    limits = bound([(length, 0.5, 3.0, 30.0)], "jerk")
    s = profile(limits, PERIOD)
    v, a, j = (np.abs(np.diff(s, order)).max() / PERIOD**order for order in (1, 2, 3))
    assert (s[0], s[-1]) == (0.0, 1.0)
    assert v <= limits.speed * (1 + 1e-9)
    assert a <= limits.acceleration * (1 + 1e-6)
    assert j <= limits.jerk * (1 + 1e-3)


@pytest.mark.parametrize(("length", "speed", "acceleration"), [(0.4, 0.5, 3.0), (0.05, 0.5, 3.0)])
def test_trapezoid_takes_the_textbook_time(length, speed, acceleration):
    """T = L/v + v/a with a plateau, 2 sqrt(L/a) without; then up to the next whole cycle."""
    reached = length > speed**2 / acceleration
    textbook = length / speed + speed / acceleration if reached else 2 * math.sqrt(length / acceleration)
    s = profile(bound([(length, speed, acceleration, 1.0)], "trapezoid"), PERIOD)
    assert len(s) - 1 == math.ceil(textbook / PERIOD)


def test_jerk_limited_takes_the_textbook_time():
    """T = L/v + v/a + a/j where speed and acceleration are both reached."""
    s = profile(bound([(0.4, 0.5, 3.0, 30.0)], "jerk"), PERIOD)
    assert len(s) - 1 == math.ceil((0.4 / 0.5 + 0.5 / 3.0 + 3.0 / 30.0) / PERIOD)


def test_the_slower_of_position_and_orientation_rules():
    limits = bound([(0.1, 0.5, 3.0, 30.0), (math.pi, 1.0, 4.0, 40.0)], "jerk")
    assert limits.speed == pytest.approx(1.0 / math.pi)
    assert bound([(0.0, 0.5, 3.0, 30.0), (math.pi, 1.0, 4.0, 40.0)], "jerk") == limits


def test_a_path_without_extent_has_no_speed():
    with pytest.raises(ValueError, match="extent"):
        bound([(0.0, 1.0, 1.0, 1.0)], "jerk")


def test_a_duration_stretches_but_never_shortens():
    limits = bound([(0.4, 0.5, 3.0, 30.0)], "jerk")
    assert len(profile(limits, PERIOD, 2.0)) - 1 == 250
    assert len(profile(limits, PERIOD, 0.1)) == len(profile(limits, PERIOD))


@pytest.mark.parametrize("speed", [1e-300, 1e-9, 5e-6, 2e-5])
def test_a_move_that_would_take_too_long_is_refused_by_name(speed):
    with pytest.raises(Fault) as caught:
        profile(bound([(0.2, speed, 3.0, 30.0)], "jerk"), PERIOD)
    assert caught.value.code == "RBL404"


def test_the_longest_move_is_planned_and_a_longer_one_refused():
    assert len(profile(bound([(0.2, 0.5, 3.0, 30.0)], "jerk"), PERIOD, 600.0)) == 75_001
    with pytest.raises(Fault, match="RBL404"):
        profile(bound([(0.2, 0.5, 3.0, 30.0)], "jerk"), PERIOD, 600.1)


@pytest.mark.parametrize("speed", [4e-4, 1e-3, 1e-2])
@pytest.mark.parametrize("shape", ["jerk", "trapezoid"])
def test_very_slow_moves_are_planned(speed, shape):
    s = profile(bound([(0.2, speed, 3.0, 30.0)], shape), PERIOD)
    assert np.diff(s).max() / PERIOD * 0.2 == pytest.approx(speed, rel=1e-3)


def test_there_is_a_profile_where_the_plateau_of_acceleration_has_just_no_length():
    """Rounding leaves the solver between two cases there; 20 of these limits had no profile."""
    rng = np.random.default_rng(1)
    for acceleration in 10.0 ** rng.uniform(-2.0, 3.0, 400):
        jerk = math.sqrt(2.0 * acceleration**3) * (1.0 + rng.integers(-3, 4) * 2.2e-16)
        limits = SpeedLimits(speed=1e3, acceleration=acceleration, jerk=jerk)
        # up and down in four equal ramps: 1 = 2 jerk tau^3
        assert shortest_s(limits) == pytest.approx(4.0 * math.cbrt(0.5 / jerk), rel=1e-6)
