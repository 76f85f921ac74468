"""Steps that a channel can emit: S06 of the document with the figures of C4, and what no rule may break."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.pulses.emission import MOST_CARRIED, compensate, emit, hold, least_step, settle
from runtime.pulses.steps import EqualTimeSteps

PULSE_DEG, PULSE_MM = 0.0036, 0.005


def c3(step_s):
    """Steps wanted of theta and radius for the line of C3, by plain trigonometry."""
    y = -150.0 + EqualTimeSteps.of(300.0, 100.0, 0.2, step_s).distances()
    theta, r = np.degrees(np.arctan2(y, 300.0)), np.hypot(300.0, y)
    pulses = [np.floor(value / pulse + 0.5).astype(np.int64) for value, pulse in ((theta, PULSE_DEG), (r, PULSE_MM))]
    return [np.diff(each) for each in pulses]


def debt(steps, wanted):
    return int(np.abs(np.cumsum(steps) - np.cumsum(wanted)).max())


def test_the_least_step_is_rounded_up():
    assert [least_step(*each) for each in ((191, 0.02), (500, 0.02), (200, 0.01), (1.5, 0.01))] == [4, 10, 2, 1]


@pytest.mark.parametrize(
    ("min_hz", "raised", "debts", "left"), [(191.0, (0, 2), (0, 3), (0, 0)), (500.0, (2, 10), (6, 19), (6, 1))]
)
def test_c4_has_the_published_compensations(min_hz, raised, debts, left):
    least = least_step(min_hz, 0.02)
    for wanted, count, most, final in zip(c3(0.02), raised, debts, left, strict=True):
        steps, found, carried = compensate(wanted, least)
        assert (found, debt(steps, wanted), abs(carried)) == (count, most, final)
        assert int(steps.sum() - wanted.sum()) == carried
        assert (np.abs(steps[steps != 0]) >= least).all()


def test_c4_ends_exactly_after_the_terminal_correction():
    """Line error of what is carried: at most 19 pulses of 5 um."""
    for wanted in c3(0.02):
        found = emit(wanted, 10, 2000)
        assert found.rule == "compensate"
        assert len(found.steps) == len(wanted)
        assert found.steps.sum() == wanted.sum()
        assert found.debt <= 19


def test_enough_frequency_changes_nothing():
    wanted = np.array([0, 5, 6, 0, -7], dtype=np.int64)
    found = emit(wanted, 5, 100)
    assert found.rule == "none"
    assert found.steps is wanted


def test_a_joint_that_creeps_stands_between_its_pulses():
    """The document's rule would emit 400 pulses for 200, and have nothing that could give them back."""
    wanted = np.tile(np.array([1, 0], dtype=np.int64), 200)
    steps, _, carried = compensate(wanted, 2)
    assert (debt(steps, wanted), carried) == (200, 200)
    found = emit(wanted, 2, 1000)
    assert (found.rule, found.debt) == ("hold", 1)
    assert found.steps.sum() == 200
    assert set(found.steps.tolist()) == {0, 2}


def test_what_is_carried_against_a_reversal_is_added_to_it():
    steps, raised, carried = compensate(np.array([1, -10], dtype=np.int64), 4)
    assert steps.tolist() == [4, -13]
    assert (raised, carried) == (1, 0)


def test_a_large_step_gives_back_no_more_than_keeps_it_a_step():
    steps, _, carried = compensate(np.array([1, 1, 1, 8, 9, 40], dtype=np.int64), 4)
    assert steps.tolist() == [4, 4, 4, 4, 4, 40]
    assert carried == 0


@pytest.mark.parametrize(
    ("steps", "missing", "settled"),
    [
        ([9, 5, 4], -1, [9, 4, 4]),  # the last step that can bear it
        ([9, 5, 4], 3, [9, 5, 7]),
        ([6, 5, 5], -3, [5, 4, 4]),  # none can alone
        ([4, 4, 4], -1, [4, 7, 0]),  # one is left out, another raised
        ([4], -1, [4, -5, 4]),  # two are appended
        ([4], -9, [4, -9]),
        ([0, 0], 0, [0, 0]),
    ],
)
def test_what_is_left_goes_to_the_last_that_can_bear_it(steps, missing, settled):
    assert settle(np.array(steps, dtype=np.int64), missing, 4, 50).tolist() == settled


def test_more_than_a_channel_can_give_is_an_error():
    with pytest.raises(ValueError, match="100"):
        emit(np.array([101], dtype=np.int64), 2, 100)


WANTED = st.lists(st.integers(-60, 60), min_size=1, max_size=60).map(lambda each: np.array(each, dtype=np.int64))


@given(WANTED, st.integers(1, 12))
def test_every_emission_is_exact_possible_and_near(wanted, least):
    most = 200
    found = emit(wanted, least, most)
    sizes = np.abs(found.steps[found.steps != 0])
    assert found.steps.sum() == wanted.sum()
    assert len(found.steps) <= len(wanted) + 2
    assert ((sizes >= least) & (sizes <= most)).all()
    # steady enough: what the document's rule carries, or half a step; and what the end needed beside it
    assert found.debt <= 2 * (MOST_CARRIED * least + abs(found.settled)) + 2 * least


@given(WANTED, st.integers(1, 12))
def test_holding_is_never_more_than_half_a_least_step_off(wanted, least):
    steps, _, carried = hold(wanted, least, 200)
    assert debt(steps, wanted) <= least // 2
    assert abs(carried) <= least // 2
    nonzero = steps[steps != 0]
    assert (np.abs(nonzero) >= least).all()
