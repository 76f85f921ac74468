"""Fine interpolation: between its set-points, within their limits everywhere, at rest when the set-points are."""

import numpy as np
import pytest

from runtime.motion.fine_interpolator import FineInterpolator, through
from runtime.motion.velocity_profile import bound, profile

PERIOD = 0.008


def wave() -> np.ndarray:
    s = profile(bound([(0.4, 0.5, 3.0, 30.0)], "jerk"), PERIOD)
    return np.stack([s, np.sin(2 * s), 1.0 + s**2], axis=1)


def rough(seed: int) -> np.ndarray:
    return np.cumsum(np.random.default_rng(seed).normal(size=(40, 3)), axis=0)


def test_a_command_through_places_passes_them_at_its_knots():
    q = wave()
    fine = FineInterpolator(8, PERIOD, q[0]).expand(through(q))
    np.testing.assert_allclose(fine[0, 16:-8:8], q[1:-1], atol=1e-14)
    np.testing.assert_array_equal(through(q)[[0, -1]], q[[0, -1]])


def test_through_rough_places_too():
    q = rough(3)
    fine = FineInterpolator(8, PERIOD, q[0]).expand(through(q))
    np.testing.assert_allclose(fine[0, 16:-8:8], q[1:-1], atol=1e-9)


def test_pushed_one_by_one_it_plays_what_expand_computes():
    q = wave()
    player = FineInterpolator(8, PERIOD, q[0])
    played = np.concatenate([player.push(row) for row in [*q[1:], q[-1], q[-1]]], axis=1)
    np.testing.assert_array_equal(played, player.expand(q))


def test_speed_and_acceleration_are_the_derivatives_of_the_position():
    q = wave()
    fine = FineInterpolator(64, PERIOD, q[0]).expand(q)
    h = PERIOD / 64
    np.testing.assert_allclose((fine[0, 2:] - fine[0, :-2]) / (2 * h), fine[1, 1:-1], atol=2e-4)
    np.testing.assert_allclose((fine[1, 2:] - fine[1, :-2]) / (2 * h), fine[2, 1:-1], atol=0.2)


def test_acceleration_has_no_step():
    """The largest change between neighbouring samples shrinks with the sample time: a step would stay."""
    q = wave()
    coarse, fine = (np.abs(np.diff(FineInterpolator(n, PERIOD, q[0]).expand(q)[2], axis=0)).max() for n in (8, 128))
    assert fine < 0.12 * coarse


def test_it_settles_when_the_set_points_stand_still():
    q = wave()
    player = FineInterpolator(8, PERIOD, q[0])
    assert player.settled
    player.push(q[5])
    assert not player.settled
    for _ in range(3):
        motion = player.push(q[5])
    assert player.settled
    np.testing.assert_allclose(motion[0], np.tile(q[5], (8, 1)), atol=1e-15)
    assert np.abs(motion[1:]).max() < 1e-10


def test_a_straight_line_stays_a_straight_line():
    q = np.outer(np.arange(10.0), [1.0, -2.0])
    fine = FineInterpolator(8, PERIOD, q[0]).expand(q)
    inner = fine[:, 24:-24]
    np.testing.assert_allclose(inner[1], np.tile([1 / PERIOD, -2 / PERIOD], (inner.shape[1], 1)), rtol=1e-10)
    np.testing.assert_allclose(inner[0, ::8], q[2:7], atol=1e-13)


@pytest.mark.parametrize("seed", range(20))
def test_no_tick_however_short_is_beyond_the_bounds_and_some_reach_them(seed):
    q = rough(seed)
    fine = FineInterpolator(128, PERIOD, q[0])
    played, dq, ddq = fine.expand(q)
    assert (played >= q.min(axis=0) - 1e-12).all() and (played <= q.max(axis=0) + 1e-12).all()
    speed, acceleration = fine.peaks(q)
    assert (np.abs(dq) <= speed * (1.0 + 1e-12)).all() and (np.abs(ddq) <= acceleration * (1.0 + 1e-12)).all()
    np.testing.assert_allclose(np.abs(ddq).max(axis=0), acceleration, rtol=1e-12)
    assert (np.abs(dq).max(axis=0) > 0.5 * speed).all()


def test_the_jerk_within_a_cycle_is_the_third_difference():
    q = rough(5)
    _, _, ddq = FineInterpolator(8, PERIOD, q[0]).within(q)
    inside = np.diff(ddq.reshape(-1, 8, 3), axis=1) / (PERIOD / 8)
    third = np.diff(q, 3, axis=0)[:, None] / PERIOD**3
    np.testing.assert_allclose(inside, np.broadcast_to(third, inside.shape), rtol=1e-7, atol=1e-3)


def test_bounds_of_a_continued_motion_leave_out_how_it_starts():
    q = rough(6)
    fine = FineInterpolator(128, PERIOD, q[0])
    lowest, highest, speed, acceleration = fine.extremes(q)
    played, dq, ddq = fine.within(q)
    assert (played >= lowest).all() and (played <= highest).all()
    assert (np.abs(dq) <= speed).all()
    np.testing.assert_allclose(np.abs(ddq).max(axis=0), acceleration, rtol=1e-3)


def test_nothing_that_is_not_a_number_is_within_bounds():
    q = wave()
    q[20, 1] = np.nan
    assert np.isnan(FineInterpolator(8, PERIOD, q[0]).peaks(q)[1][1])
