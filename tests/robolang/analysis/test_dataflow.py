"""What holds before a line: facts follow the ways that the interpreter takes, and no others."""

import pytest

from robolang.analysis.dataflow import edges_of, facts_before
from robolang.analysis.tabulation import MAX_FACTS
from robolang.syntax.ast import Print
from robolang.syntax.blocks import structure_of
from tests.robolang.helpers import parsed


def lines_before(text):
    """Line by line, and behind the last: the sets of numbers of PRINTs that can have come last."""
    program = parsed(text)
    ways = edges_of(program, structure_of(program))
    return facts_before(ways, 0, lambda at, node, fact: (at + 1 if isinstance(node, Print) else fact,))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("PRINT 1\nPRINT 2", [{0}, {1}, {2}]),
        ("IF x THEN PRINT 1 ELSE PRINT 2\nEND", [{0}, {1}, set()]),
        ("IF x THEN PRINT 1\nEND", [{0}, {0, 1}, set()]),
        ("IF x THEN\nPRINT 1\nELSE\nPRINT 2\nENDIF", [{0}, {0}, {2}, {0}, {4}, {2, 4}]),
        ("IF x THEN\nPRINT 1\nELSEIF y THEN\nPRINT 2\nENDIF", [{0}, {0}, {2}, {0}, {0, 4}, {0, 2, 4}]),
        ("SELECT CASE x\nCASE 1\nPRINT 1\nCASE 2\nPRINT 2\nENDSELECT", [{0}, set(), {0}, {3}, {0}, {0, 5}, {0, 3, 5}]),
        ("SELECT CASE x\nCASE 1\nPRINT 1\nCASE ELSE\nPRINT 2\nENDSELECT", [{0}, set(), {0}, {3}, {0}, {5}, {3, 5}]),
        ("WHILE x\nPRINT 1\nWEND", [{0, 2}, {0, 2}, {2}, {0, 2}]),
        ("WHILE 1\nPRINT 1\nWEND", [{0, 2}, {0, 2}, {2}, set()]),
        ("FOR i = 1 TO 3\nPRINT 1\nNEXT", [{0}, {0, 2}, {2}, {2}]),
        ("FOR i = 1 TO n\nPRINT 1\nNEXT", [{0}, {0, 2}, {2}, {0, 2}]),
        ("FOR i = 3 TO 1\nPRINT 1\nNEXT", [{0}, {0, 2}, {2}, {0, 2}]),
        ("GOTO *L\nPRINT 1\n*L PRINT 2", [{0}, set(), {0}, {3}]),
        ("WAIT x, TIMEOUT 1, GOTO *L\nPRINT 1\n*L\nEND", [{0}, {0}, {0, 2}, {0, 2}, set()]),
        ("ON ERROR GOTO *L\nPRINT 1\nEND\n*L\nRESUME NEXT", [{0}, {0}, {2}, set(), set(), set()]),
        ("STOP\nPRINT 1", [{0}, set(), set()]),
    ],
)
def test_facts_follow_the_ways_through_a_program(text, expected):
    assert lines_before(text) == expected


def test_what_returns_from_a_subroutine_goes_back_to_its_own_caller():
    text = "CALL s\nPRINT 1\nCALL s\nEND\nSUB s\nIF x THEN RETURN\nENDSUB"
    assert lines_before(text) == [{0}, {0}, {2}, {2}, set(), {0, 2}, {0, 2}, set()]


def test_gosub_comes_back_too_and_may_call_itself():
    text = "GOSUB *A\nPRINT 1\nGOSUB *A\nEND\n*A\nIF x THEN GOSUB *A\nRETURN"
    assert lines_before(text) == [{0}, {0}, {2}, {2}, {0, 2}, {0, 2}, {0, 2}, set()]


def test_a_subroutine_that_prints_tells_its_callers():
    assert lines_before("CALL s\nCALL s\nEND\nSUB s\nPRINT 1\nENDSUB") == [{0}, {5}, {5}, set(), {0, 5}, {5}, set()]


def test_endsub_leaves_the_sub_however_many_gosubs_are_open_in_it():
    text = "CALL s\nEND\nSUB s\nGOSUB *A\nPRINT 1\nRETURN\n*A GOSUB *B\nPRINT 2\nRETURN\n*B PRINT 3\nENDSUB"
    assert lines_before(text) == [{0}, {10}, set(), {0}, set(), set(), {0}, set(), set(), {0}, {10}, set()]


def test_endsub_leaves_for_every_caller_also_where_its_gosub_was_entered_before():
    text = "CALL s\nPRINT 1\nCALL s\nEND\nSUB s\nIF x THEN GOSUB *A\nGOSUB *A\nRETURN\n*A ENDSUB"
    assert lines_before(text)[:4] == [{0}, {0}, {2}, {2}]
    assert lines_before(text)[7] == set()


@pytest.mark.parametrize(
    ("text", "line", "expected"),
    [
        ("ON ERROR GOTO *L\nPRINT 1\nx = 1 / y\nPRINT 2\nEND\n*L END", 6, {2}),
        ("PRINT 1\nx = 1 / y\nPRINT 2\nON ERROR GOTO *L\nEND\n*L END", 6, set()),  # what failed before ends the run
        ("ON ERROR GOTO *L\nx = 1 / y\nON ERROR STOP\nPRINT 1\nx = 1 / y\nEND\n*L END", 7, {0}),
        ("ON ERROR GOTO *L\nx = 1 / y\nPRINT 1\nEND\n*L PRINT 2\nRESUME NEXT", 3, {0, 5}),
        ("ON ERROR GOTO *L\nx = 1 / y\nPRINT 1\nEND\n*L PRINT 2\nRESUME", 2, {0, 5}),
        ("ON ERROR GOTO *L\nMOVE P1\nEND\n*L PRINT 1\nMOVE P1\nEND", 4, {0}),  # of an error in a handler none runs
        ("ON ERROR GOTO *L\nCALL s\nEND\n*L END\nSUB s\nPRINT 1\nMOVE P1\nENDSUB", 4, {6}),
        ("ON ERROR GOTO *L\nCALL s\nPRINT 9\nEND\n*L RESUME NEXT\nSUB s\nPRINT 1\nMOVE P1\nRETURN\nENDSUB", 3, {7}),
        ("ON ERROR GOTO *L\nCALL s\nEND\n*L END\nSUB s\nON ERROR STOP\nMOVE P1\nENDSUB", 4, set()),
        ("CALL s\nMOVE P1\nEND\nSUB s\nON ERROR GOTO *L\n*L RETURN\nENDSUB", 6, {0}),  # ends with its SUB
        ("ON ERROR GOTO *L\nGOSUB *A\nEND\n*L PRINT 1\nRETURN\n*A MOVE P1\nRETURN", 3, {0, 4}),
        ("GOSUB *A\nEND\n*L PRINT 1\nRETURN\n*A ON ERROR GOTO *L\nMOVE P1\nRETURN", 2, {0, 3}),
    ],
)
def test_errors_lead_to_the_handler_of_the_way_that_they_come_on(text, line, expected):
    assert lines_before(text)[line - 1] == expected


def test_too_many_facts_are_given_up():
    text = "*L\n" + "IF x THEN PRINT 1\n" * (MAX_FACTS + 2) + "GOTO *L"
    assert lines_before(text) is None
