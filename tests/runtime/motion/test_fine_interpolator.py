"""Fine interpolation: through every set-point, continuous to the acceleration, at rest when the set-points are."""

import numpy as np

from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.velocity_profile import bound, profile

PERIOD = 0.008


def wave() -> np.ndarray:
    s = profile(bound([(0.4, 0.5, 3.0, 30.0)], "jerk"), PERIOD)
    return np.stack([s, np.sin(2 * s), 1.0 + s**2], axis=1)


def test_every_set_point_is_passed_at_the_start_of_its_segment():
    q = wave()
    fine = FineInterpolator(8, PERIOD, q[0]).expand(q)
    np.testing.assert_allclose(fine[0, 8::8], q, atol=1e-15)


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


def test_peaks_are_those_of_the_expanded_motion():
    q = np.cumsum(np.random.default_rng(2).normal(size=(40, 3)), axis=0)
    fine = FineInterpolator(8, 0.008, q[0])
    _, dq, ddq = np.abs(fine.expand(q)).max(axis=1)
    found = fine.peaks(q)
    np.testing.assert_allclose(found[0], dq, rtol=1e-12)
    np.testing.assert_allclose(found[1], ddq, rtol=1e-12)


def test_no_segment_leaves_its_set_points_by_more_than_the_largest_step():
    """What lets the planner pass over the ticks of a path that stays well inside its ranges."""
    for seed in range(20):
        q = np.cumsum(np.random.default_rng(seed).normal(size=(30, 1)), axis=0)
        positions = FineInterpolator(8, 0.008, q[0]).expand(q)[0]
        step = np.abs(np.diff(q, axis=0)).max()
        assert positions.max() <= q.max() + step
        assert positions.min() >= q.min() - step
