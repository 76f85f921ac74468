"""The time on a path: the law through a grid, its mean, and what gives it room for the jerk."""

import numpy as np
import pytest
import ruckig

from runtime.motion.chain.rates import Bounds, rates
from runtime.motion.chain.time_law import TimeLaw, eased, narrow

H = 0.008


def b_of(x: np.ndarray, acceleration: float, speed: float = np.inf) -> np.ndarray:
    ones = np.ones((len(x), 1))
    most = acceleration * ones
    return rates(x, Bounds(along=ones, across=0 * ones, beside=0 * ones, most=most, fastest=np.full(len(x), speed**2)))


def test_the_law_of_full_acceleration_is_a_parabola():
    x = np.linspace(0.0, 2.0, 401)
    law = TimeLaw.of(x, b_of(x, 2.0))
    assert law.seconds == pytest.approx(2.0)
    places = law.sampled(H, 0.0)
    t = np.linspace(0.0, 2.0, len(places))
    np.testing.assert_allclose(places, np.where(t < 1.0, t**2, 2.0 - (2.0 - t) ** 2), atol=1e-9)


def test_the_mean_is_that_of_many_samples():
    x = np.linspace(0.0, 1.0, 201)
    law = TimeLaw.of(x, b_of(x, 3.0, 0.7))
    mean_s, seconds = 0.1, law.seconds + 0.1
    places = law.sampled(H, mean_s)
    fine = np.linspace(-mean_s, seconds, 400001)
    t = np.clip(fine, 0.0, law.seconds)
    k = np.clip(np.searchsorted(law.t, t, side="right") - 1, 0, len(law.t) - 2)
    slope = (law.v[k + 1] - law.v[k]) / (law.t[k + 1] - law.t[k])
    at = law.x[k] + law.v[k] * (t - law.t[k]) + 0.5 * slope * (t - law.t[k]) ** 2
    whole = np.concatenate([[0.0], np.cumsum(0.5 * (at[1:] + at[:-1]) * np.diff(fine))])
    times = np.linspace(0.0, seconds, len(places))
    mean = (np.interp(times, fine, whole) - np.interp(times - mean_s, fine, whole)) / mean_s
    np.testing.assert_allclose(places, mean, atol=1e-7)
    assert (places[0], places[-1]) == (0.0, 1.0)


@pytest.mark.parametrize(("length", "acceleration", "speed"), [(1.0, 3.0, 0.7), (0.3, 3.0, 0.9), (0.05, 3.0, 2.0)])
def test_from_rest_to_rest_it_is_the_motion_of_constant_jerk_that_is_fastest(length, acceleration, speed):
    """As long as the acceleration is reached; T is acceleration over jerk."""
    mean_s = 0.1
    x = np.linspace(0.0, length, 401)
    law = TimeLaw.of(x, eased(x, b_of(x, acceleration, speed), mean_s))
    request = ruckig.InputParameter(1)
    request.target_position, request.max_velocity = [length], [speed]
    request.max_acceleration, request.max_jerk = [acceleration], [acceleration / mean_s]
    trajectory = ruckig.Trajectory(1)
    ruckig.Ruckig(1).calculate(request, trajectory)
    assert law.seconds + mean_s == pytest.approx(trajectory.duration, rel=2e-3)
    places = law.sampled(H, mean_s)
    third = np.diff(np.concatenate([[0.0] * 3, places, [length] * 3]), 3) / H**3
    assert np.abs(third).max() <= acceleration / mean_s * 1.02


def test_a_top_is_cut_until_it_lasts_long_enough_and_nothing_else_changes():
    x = np.linspace(0.0, 2.0, 2001)
    b = b_of(x, 3.0)
    cut = eased(x, b, 0.2)
    level = np.sqrt(cut.max())
    on_top = x[cut >= cut.max() * (1.0 - 1e-9)]
    assert on_top[-1] - on_top[0] == pytest.approx(level * 0.2, abs=2e-3)
    np.testing.assert_array_equal(cut[b < cut.max()], b[b < cut.max()])


def test_many_tops_close_together_become_one():
    x = np.linspace(0.0, 1.0, 1001)
    b = np.minimum(b_of(x, 3.0), (0.3 + 0.05 * np.sin(200.0 * x)) ** 2)
    cut = eased(x, b, 0.1)
    inside = (x > 0.1) & (x < 0.9)
    assert np.ptp(np.sqrt(cut[inside])) < 0.02
    assert (cut <= b).all()


def test_a_narrow_place_is_widened_by_half_the_time_on_either_side():
    x = np.linspace(0.0, 1.0, 1001)
    b = np.minimum(b_of(x, 3.0), 0.04 + 6.0 * np.abs(x - 0.5))
    low = narrow(x, b, 0.1)
    widened = x[low < b - 1e-12]
    assert widened[0] == pytest.approx(0.5 - 0.01, abs=2e-3)
    assert widened[-1] == pytest.approx(0.5 + 0.01, abs=2e-3)
    assert np.interp(0.5, x, low) == pytest.approx(0.04)


def test_a_speed_of_nan_is_not_sampled_as_a_place():
    x = np.linspace(0.0, 1.0, 11)
    b = np.full(11, 0.1)
    b[4] = np.nan
    assert not TimeLaw.of(x, b).seconds > 0.0
