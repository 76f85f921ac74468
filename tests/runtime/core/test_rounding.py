"""Numbers in messages compare as the numbers that they stand for."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.core.rounding import beside, down, up

numbers = st.floats(allow_nan=False, allow_infinity=False, width=64)


def order(a: float, b: float) -> int:
    return (a > b) - (a < b)


@given(numbers, numbers, st.sampled_from(["g", ".3f", ".1f", ".3g"]))
def test_texts_compare_as_the_numbers_do(value, limit, form):
    text, bound = map(float, beside(value, limit, form=form))
    assert order(text, bound) == order(value, limit)


@given(st.floats(1e-9, 1e9), st.integers(-3, 3))
def test_neighbours_compare_as_well(limit, steps):
    value = limit
    for _ in range(abs(steps)):
        value = math.nextafter(value, math.copysign(math.inf, steps))
    text, low, high = map(float, beside(value, limit, 2.0 * limit, form=".2f"))
    assert (order(text, low), order(text, high)) == (order(value, limit), -1)


@pytest.mark.parametrize(
    ("value", "limits", "form", "texts"),
    [
        (0.00099999, (0.001,), ".4f", ("0.00099999", "0.001")),
        (100.0000001, (100.0,), "g", ("100.0000001", "100")),
        (0.51234, (0.5,), ".3f", ("0.512", "0.5")),
        (5.0, (1.0, 4.0), "g", ("5", "1", "4")),
        (math.nan, (1.0,), "g", ("nan", "1")),
        (math.inf, (1.0,), ".3f", ("inf", "1")),
        (3.0, (3.0,), ".3f", ("3.000", "3")),
    ],
)
def test_examples(value, limits, form, texts):
    assert beside(value, *limits, form=form) == texts


@given(st.floats(1e-6, 1e6), st.integers(2, 6))
def test_proposals_stay_on_their_side(value, digits):
    assert value * (1.0 - 10.0 ** (1 - digits)) <= down(value, digits) <= value * (1.0 + 1e-6)
    assert value * (1.0 - 1e-6) <= up(value, digits) <= value * (1.0 + 10.0 ** (1 - digits))
