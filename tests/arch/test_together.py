"""Cases that share one test lose none of what they find."""

import pytest

from tests.together import together


def test_every_case_that_fails_is_reported_and_the_others_are_judged():
    seen = []

    @together("number", [1, 2, 3, 4], ids=lambda number: f"case {number}")
    def even(number, found):
        found.append(number)
        assert number % 2 == 0

    with pytest.raises(AssertionError) as failed:
        even(found=seen)
    assert seen == [1, 2, 3, 4]
    text = str(failed.value)
    assert [f"--- case {number}" in text for number in seen] == [True, False, True, False]


def test_a_failure_that_pytest_raises_is_one():
    @together("number", [1])
    def fails(number):
        with pytest.raises(ValueError, match="never"):
            pass

    with pytest.raises(AssertionError):
        fails()


def test_no_case_is_no_test():
    with pytest.raises(AssertionError):
        together("number", [])
