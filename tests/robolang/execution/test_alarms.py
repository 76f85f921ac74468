"""Alarms as diagnostics: the calls that led there, however many there are."""

import pytest

from robolang.core.diagnostics import Severity
from robolang.core.source import Span
from robolang.execution.alarms import SHOWN_CALLS, as_diagnostic, calls
from robolang.interpreter.effects import Origin
from runtime.core.faults import Alarm
from tests.messages import numbers


def call(at):
    return Origin(line=at, number=10 * at, span=Span(at, at + 1))


@pytest.mark.parametrize("count", [0, 1, 2 * SHOWN_CALLS, 2 * SHOWN_CALLS + 1])
def test_a_few_calls_are_all_shown(count):
    found = calls(tuple(map(call, range(count))))
    assert [each.span.start for each in found] == list(range(count))
    assert not [each for each in found if numbers(each.message)]


@pytest.mark.parametrize("count", [2 * SHOWN_CALLS + 2, 100])
def test_of_many_calls_the_first_and_the_last_are_shown(count):
    found = calls(tuple(map(call, range(count))))
    assert [each.span.start for each in found] == [0, 1, 2, count - 3, count - 2, count - 1]
    assert [numbers(each.message) for each in found if numbers(each.message)] == [[count - 2 * SHOWN_CALLS]]


def test_a_call_within_itself_is_shown_once():
    found = calls((call(1), *[call(2)] * 98, call(3)))
    assert [each.span.start for each in found] == [1, 2, 3]
    assert [numbers(each.message) for each in found] == [[], [98], []]


def test_calls_that_alternate_are_bounded():
    assert len(calls((call(1), call(2)) * 50)) == 2 * SHOWN_CALLS


def test_an_alarm_without_a_statement_of_the_program_is_a_defect_and_never_stands_at_1_1():
    with pytest.raises(AssertionError):
        as_diagnostic(Alarm(code="RBL530", message="stopped", tick=0), Severity.ERROR)
