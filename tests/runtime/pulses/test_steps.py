"""Equal-time steps against C1 and C2 of the specification and their own laws."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from runtime.pulses.steps import MOST_STEPS, EqualTimeSteps


def test_c1_has_the_published_steps():
    steps = EqualTimeSteps.of(300.0, 100.0, 0.2, 0.01)
    S = steps.distances()
    assert (steps.n0, steps.na, steps.n) == (300, 20, 320)
    assert steps.acceleration == pytest.approx(500.0)
    assert S[[1, 20, 21, 300, 319, 320]] == pytest.approx([0.025, 10.0, 11.0, 290.0, 299.975, 300.0], abs=1e-9)
    assert steps.seconds == pytest.approx(3.2)


def test_c2_has_no_glitch_after_rounding():
    """With V and T0 as given instead of V' and T0' a step of 0.502 mm follows one of 0.900."""
    steps = EqualTimeSteps.of(314.159, 90.0, 0.155, 0.01)
    S = steps.distances()
    assert (steps.n0, steps.na, steps.n) == (349, 16, 365)
    assert steps.speed == pytest.approx(90.0169, abs=5e-5)
    assert steps.acceleration == pytest.approx(562.61, abs=5e-3)
    assert np.abs(np.diff(S, 2)).max() == pytest.approx(0.05626, abs=5e-6)
    assert (S[0], S[-1]) == (0.0, 314.159)


def test_a_half_is_rounded_up():
    assert EqualTimeSteps.of(1.0, 1.0, 0.125, 0.25).na == 1
    assert EqualTimeSteps.of(0.625, 1.0, 0.0, 0.25).n0 == 3


def test_a_short_move_is_a_triangle():
    steps = EqualTimeSteps.of(2.0, 100.0, 0.2, 0.01)
    assert (steps.n0, steps.na) == (20, 20)
    assert steps.speed == pytest.approx(2.0 / (20 * 0.01))
    S = steps.distances()
    np.testing.assert_allclose(S + S[::-1], 2.0)


@pytest.mark.parametrize(
    "values",
    [
        (0.0, 1.0, 0.1, 0.01),
        (1.0, 0.0, 0.1, 0.01),
        (1.0, 1.0, -0.1, 0.01),
        (1.0, np.nan, 0.1, 0.01),
        (1e9, 1.0, 0.1, 0.01),
    ],
)
def test_what_is_no_move_is_an_error(values):
    with pytest.raises(ValueError, match=r"0|more"):
        EqualTimeSteps.of(*values)


@given(st.floats(1e-3, 1e4), st.floats(0.1, 1e3), st.floats(0.0, 2.0), st.sampled_from([0.001, 0.005, 0.01, 0.02]))
def test_ends_are_exact_the_way_rises_and_no_step_is_harder_than_the_ramp(distance, speed, ramp, step):
    assume(distance / speed + ramp < MOST_STEPS * step)
    steps = EqualTimeSteps.of(distance, speed, ramp, step)
    S = steps.distances()
    assert (S[0], S[-1]) == (0.0, distance)
    assert (np.diff(S) > 0.0).all()
    if steps.na:
        assert np.abs(np.diff(S, 2)).max() <= steps.acceleration * step**2 * (1.0 + 1e-9) + 1e-12 * distance
    assert np.diff(S).max() <= steps.speed * step * (1.0 + 1e-9) + 1e-12 * distance
