"""Conditions that may go another way: which they are, and that the interpreter lets itself be sent there."""

import pytest

from robolang.evaluation.evaluator import Nowhere
from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import Show
from robolang.planning.branch_forcing import open_conditions
from tests.robolang.helpers import parsed, source
from tests.robolang.running import execute
from tests.steps import assert_linear


class Still(Nowhere):
    """A world whose inputs are off and whose time goes on by a second whenever it is asked."""

    def __init__(self):
        self.now = 0.0

    def input(self, number):
        return 0.0

    def seconds(self):
        self.now += 1.0
        return self.now


def asked(text):
    """The texts of the conditions that may go either way, and their lines; WAITs with a *."""
    found = open_conditions(parsed(text)).values()
    return [(source(text).slice(each.place) + "*" * each.wait, each.line) for each in found]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("IF IN(1) = 1 THEN END", [("IN(1) = 1", 1)]),
        ("x = 3\nIF x > 2 THEN END", []),
        ("x = IN(2)\ny = x + 1\nIF y > 2 THEN END", [("y > 2", 3)]),
        ("IF y > 2 THEN END\ny = x\nx = IN(2)\n", [("y > 2", 1)]),
        ("DIM a(2)\na(1) = TIMER\nIF a(0) THEN END", [("a(0)", 3)]),
        ("WAIT IN(1)", []),  # without a TIMEOUT it can only come true
        ("WAIT IN(1), TIMEOUT 2", [("IN(1)*", 1)]),
        ("WHILE IN(1)\nDELAY 1\nWEND", [("IN(1)", 1)]),
        ("SELECT CASE IN(1)\nCASE 1, 2\nDELAY 1\nENDSELECT", [("CASE 1, 2", 2)]),
        ("SELECT CASE 3\nCASE IN(4)\nDELAY 1\nENDSELECT", [("CASE IN(4)", 2)]),
        ("SELECT CASE IN(1)\nCASE 1\nENDSELECT\nSELECT CASE 2\nCASE 3\nENDSELECT", [("CASE 1", 2)]),
        ("CALL s(IN(1), 2)\nEND\nSUB s(a, b)\nIF a THEN END\nIF b THEN END\nENDSUB", [("a", 4)]),
        ("FOR i = 1 TO IN(1)\nIF i = 3 THEN END\nNEXT", [("i = 3", 2)]),
        ("IF x THEN\nELSEIF ERR = 410 THEN\nENDIF", [("ERR = 410", 2)]),
    ],
)
def test_what_may_go_either_way(text, expected):
    assert asked(text) == expected


def chained(count):
    """A program in which a value takes so many assignments to reach its condition."""
    chain = "".join(f"x{k} = x{k + 1}\n" for k in range(count))
    return f"{chain}x{count} = IN(1)\nIF x0 THEN END"


def test_a_long_chain_of_values_is_followed_once():
    """Quadratic when all values are gone through for each new name."""
    assert asked(chained(2000)) == [("x0", 2002)]
    assert_linear(open_conditions, parsed(chained(250)), parsed(chained(500)))


def printed(text, forced=(), *, patient=True):
    """What a program prints when conditions, by their text, are sent some way; and what they took."""
    places = {source(text).slice(place): place for place in open_conditions(parsed(text))}
    decisions = Decisions({places[name]: way for name, way in forced}, patient=patient)
    shown = [each.text for each in execute(parsed(text), Still(), decisions=decisions) if isinstance(each, Show)]
    return shown, {source(text).slice(place): ways for place, ways in decisions.taken.items()}


BOTH = 'IF IN(1) THEN\nPRINT "on"\nELSEIF IN(2) THEN\nPRINT "two"\nELSE\nPRINT "off"\nENDIF'


def test_the_way_of_the_inputs_is_noted():
    assert printed(BOTH) == (["off"], {"IN(1)": {False}, "IN(2)": {False}})


@pytest.mark.parametrize(
    ("forced", "expected"), [([("IN(1)", True)], ["on"]), ([("IN(2)", True)], ["two"]), ([("IN(1)", False)], ["off"])]
)
def test_a_condition_is_sent_the_other_way(forced, expected):
    assert printed(BOTH, forced)[0] == expected


def test_only_the_first_time():
    text = 'WHILE IN(1)\nPRINT "round"\nWEND\nIF IN(3) THEN PRINT "c"'
    assert printed(text, [("IN(1)", True)]) == (["round"], {"IN(1)": {True, False}, "IN(3)": {False}})


def test_a_case_and_a_wait():
    text = 'SELECT CASE IN(1)\nCASE 5\nPRINT "five"\nCASE ELSE\nPRINT "else"\nENDSELECT'
    assert printed(text, [("CASE 5", True)])[0] == ["five"]
    text = 'WAIT IN(1), TIMEOUT 3, GOTO *L\nPRINT "came"\n*L PRINT "end"'
    assert printed(text) == (["end"], {"IN(1)": {False}})
    assert printed(text, [("IN(1)", True)]) == (["came", "end"], {"IN(1)": {True}})
    text = text.replace("IN(1)", "1 - IN(1)")
    assert printed(text, [("1 - IN(1)", False)]) == (["end"], {"1 - IN(1)": {False}})


def test_an_endless_wait_comes_true_for_who_is_not_patient():
    assert printed('WAIT IN(1)\nPRINT "on"', patient=False)[0] == ["on"]
