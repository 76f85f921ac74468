"""The fastest speeds along a path, against the double integrator and against limits checked point by point."""

import numpy as np
import pytest

from runtime.motion.chain.rates import Bounds, rates


def line(x: np.ndarray, acceleration: float, speed: float = np.inf) -> Bounds:
    ones = np.ones((len(x), 1))
    return Bounds(
        along=ones, across=0.0 * ones, beside=0.0 * ones, most=acceleration * ones, fastest=np.full(len(x), speed**2)
    )


def test_a_line_from_rest_to_rest_is_run_with_full_acceleration_and_full_braking():
    x = np.linspace(0.0, 2.0, 401)
    b = rates(x, line(x, 3.0))
    np.testing.assert_allclose(b, np.minimum(6.0 * x, 6.0 * (2.0 - x)), atol=1e-9)


def test_no_speed_is_above_its_bound():
    x = np.linspace(0.0, 2.0, 401)
    b = rates(x, line(x, 3.0, 0.5))
    np.testing.assert_allclose(b, np.minimum.reduce([6.0 * x, 6.0 * (2.0 - x), np.full(401, 0.25)]), atol=1e-9)


def test_a_narrow_place_slows_only_what_is_near_to_it():
    x = np.linspace(0.0, 2.0, 401)
    bounds = line(x, 3.0, 1.0)
    bounds.fastest[200] = 0.01
    b = rates(x, bounds)
    assert b[200] == pytest.approx(0.01)
    away = np.abs(x - 1.0)
    np.testing.assert_allclose(b, np.minimum.reduce([6.0 * x, 6.0 * (2.0 - x), np.ones(401), 0.01 + 6.0 * away]))


def test_it_begins_and_ends_at_speeds_that_are_given_as_far_as_it_can():
    x = np.linspace(0.0, 1.0, 101)
    b = rates(x, line(x, 2.0), 1.0, 4.0)
    assert (b[0], b[-1]) == (1.0, 4.0)
    np.testing.assert_allclose(b, np.minimum(1.0 + 4.0 * x, 4.0 + 4.0 * (1.0 - x)), atol=1e-9)
    assert rates(x, line(x, 0.5), 9.0)[0] == pytest.approx(1.0)  # more could not be braked in 1 m


def curved(x: np.ndarray, seed: int) -> Bounds:
    """Bounds of three joints on a smooth curve."""
    random = np.random.default_rng(seed)
    phase, size, waves = random.uniform(0.0, 6.0, 3), random.uniform(0.2, 1.0, 3), random.uniform(1.0, 6.0, 3)
    angle = phase + waves * x[:, None]
    along, across = size * waves * np.cos(angle), -size * waves**2 * np.sin(angle)
    most = np.broadcast_to(random.uniform(2.0, 9.0, 3), along.shape)
    return Bounds(along=along, across=across, beside=0.0 * along, most=most, fastest=np.full(len(x), 4.0))


@pytest.mark.parametrize("seed", range(20))
def test_on_a_curve_every_joint_keeps_its_acceleration_and_one_of_them_is_at_it(seed):
    x = np.linspace(0.0, 2.0, 1001)
    bounds = curved(x, seed)
    b = rates(x, bounds)
    u = 0.5 * np.diff(b) / np.diff(x)
    share = np.abs(bounds.along[:-1] * u[:, None] + bounds.across[:-1] * b[:-1, None]) / bounds.most[:-1]
    assert share.max() <= 1.0 + 1e-9
    assert (b > 0.0)[1:-1].all()
    # time-optimal: nearly everywhere something is at its limit
    busy = np.maximum(share.max(axis=1), b[:-1] / bounds.fastest[:-1])
    assert np.median(busy) > 1.0 - 1e-9
    faster = bounds.replaced(bounds.fastest * 1.0)
    np.testing.assert_array_equal(rates(x, faster), b)


def test_bounds_of_a_curve_in_space_leave_less_for_the_speed_the_faster_it_is():
    """A circle of 1 m under 3 m/s2: the acceleration across is v^2, and |u| + b / 2 keeps within the circle of both."""
    x = np.linspace(0.0, 3.0, 601)
    ones = np.ones((601, 1))
    both = Bounds(
        along=np.concatenate([ones, ones / 3.0], axis=1),
        across=np.zeros((601, 2)),
        beside=np.concatenate([0.5 * ones, ones], axis=1),
        most=np.full((601, 2), 3.0),
        fastest=np.full(601, 3.0),
    )
    b = rates(x, both)
    u = 0.5 * np.diff(b) / np.diff(x)
    assert np.hypot(u, b[:-1]).max() <= 3.0 + 1e-9
    assert np.hypot(u, b[:-1]).min() > 0.8 * 3.0
    assert b.max() == pytest.approx(3.0, rel=1e-3)


def test_a_bound_that_is_no_number_leaves_no_speed():
    x = np.linspace(0.0, 1.0, 11)
    bounds = line(x, 2.0)
    bounds.most[5] = np.nan
    assert not (rates(x, bounds)[4:6] > 0.0).all()
