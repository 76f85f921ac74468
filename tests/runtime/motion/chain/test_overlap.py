"""Moves that overlap in their corners: what runs where, and how far each has come."""

import itertools

import numpy as np
import pytest

from runtime.motion.chain.overlap import Overlap, ordered


def overlap(seed: int) -> Overlap:
    """Return moves of 1 to 30 mm with corners that overlap each other."""
    random = np.random.default_rng(seed)
    ends = np.concatenate([[0.0], np.cumsum(random.uniform(0.001, 0.03, 12))])
    return Overlap(ends, ordered(ends, random.uniform(0.0005, 0.05, 11)))


@pytest.mark.parametrize("seed", range(4))
def test_shares_grow_in_the_order_of_the_moves_and_add_up_to_the_place(seed):
    found = overlap(seed)
    x = np.linspace(0.0, found.ends[-1], 2000)
    passed = np.stack([found.shares(np.full(len(x), k), x) for k in range(len(found.extents))])
    assert (np.diff(passed, axis=1) >= -1e-12).all()
    assert (passed[:-1] >= passed[1:] - 1e-12).all()
    np.testing.assert_allclose(found.extents @ passed, x, atol=1e-15)
    first, last = found.running(x)
    assert (last - first).max() > 2
    runs = (passed > 1e-9) & (passed < 1.0 - 1e-9)
    for k, here in enumerate(runs):
        assert (first[here] <= k).all()
        assert (last[here] >= k).all()


def test_where_no_corner_is_one_move_runs_alone_as_programmed():
    found = Overlap(np.array([0.0, 0.1, 0.3]), np.array([0.02]))
    first, last = found.running(np.array([0.05, 0.079, 0.081, 0.119, 0.121]))
    assert (first.tolist(), last.tolist()) == ([0, 0, 0, 0, 1], [0, 0, 1, 1, 1])
    np.testing.assert_allclose(found.shares(np.array([0, 1]), np.array([0.05, 0.2])), [0.5, 0.5], atol=1e-15)


@pytest.mark.parametrize("seed", range(4))
def test_ordered_halves_are_the_largest_that_differ_by_no_more_than_the_moves_between(seed):
    random = np.random.default_rng(seed)
    ends = np.concatenate([[0.0], np.cumsum(random.uniform(0.001, 0.03, 9))])
    wanted = random.uniform(0.0005, 0.08, 8)
    # an independent formula: each half is the least of what any other corner, or an end of the chain, leaves to it
    whole, places = np.concatenate([[0.0], wanted, [0.0]]), ends
    expected = [min(whole[j] + abs(places[k] - places[j]) for j in range(10)) for k in range(1, 9)]
    np.testing.assert_allclose(ordered(ends, wanted), expected, atol=1e-15)


def test_a_mixed_value_goes_over_from_move_to_move_and_is_each_ones_own_where_it_runs_alone():
    found = overlap(1)
    x = np.linspace(0.0, found.ends[-1], 500)
    np.testing.assert_allclose(found.mixed(np.ones(12), x), 1.0, atol=1e-12)
    values = np.random.default_rng(2).uniform(0.1, 1.0, 12)
    mixed = found.mixed(values, x)
    for k, (begin, end) in enumerate(itertools.pairwise(found.ends)):
        first, last = found.running(np.array([begin, end]))
        inside = (x > begin) & (x < end)
        around = values[max(0, first[0] - 1) : last[1] + 2]
        assert (mixed[inside] <= around.max() + 1e-12).all(), k
        assert (mixed[inside] >= around.min() - 1e-12).all(), k
    assert (mixed[0], mixed[-1]) == pytest.approx((values[0], values[-1]))


def test_corners_that_share_a_move_between_them_do_not_overlap_by_rounding():
    touching = Overlap(np.array([0.0, 0.1, 0.4, 0.5]), np.array([0.15 + 1e-16, 0.15]))
    assert touching.starts[2] < touching.finishes[0]
    places = np.linspace(touching.starts[2], touching.finishes[0], 5)
    first, last = touching.running(places)
    assert (last - first <= 1).all()
