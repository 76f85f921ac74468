"""What the order of statements shows, and what it must not take for a mistake."""

import pytest

from robolang.analysis import facts
from robolang.analysis.checker import check
from tests.messages import fields
from tests.robolang.helpers import checked, parsed

LISTING = """10 LOAD (0, 0, 60), 0.8
20 HAND OFF
30 MOVE P1
40 HAND ON
50 LOAD (0, 0, 95), 2.3
60 MOVE P2
70 MOVE P3
80 HAND OFF
90 LOAD (0, 0, 60), 0.8
100 MOVE P4
110 MOVE P5"""
"""The program of the 1992 document."""


def found(text, code):
    """Lines at which a code is found."""
    return [line for each, line, *_ in checked(text) if each == code]


def test_the_program_of_1992_has_no_finding():
    assert checked(LISTING, points=("P1", "P2", "P3", "P4", "P5")) == []


def test_nothing_is_said_of_the_order_while_there_are_errors():
    assert [code for code, *_ in checked("HAND ON\nMOVE P1, SPEED 0\nEND\nMOVE P2")] == ["RBL404"]


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("HAND ON\nMOVE P1", [1]),
        ("HAND ON\nLOAD l\nMOVE P1", []),
        ("LOAD l\nHAND ON\nMOVE P1\nMOVE P2", [2]),
        ("HAND OFF\nMOVE P1", [1]),  # it was open already, but nobody has said what the hand weighs
        ("LOAD l\nHAND OFF\nMOVE P1", []),
        ("HAND OFF\nLOAD l\nMOVE P1", []),
        ("MOVE P1\nHAND OFF\nMOVE P2", [2]),
        ("HAND ON\nLOAD l\nHAND OFF\nMOVE P1", [3]),
        ("HAND ON\nHAND OFF\nMOVE P1", [2]),
        ("HAND ON\nDELAY 1\nHAND ON\nMOVE P1", [1]),  # the second grasps nothing new
        ("HAND ON\nIF x THEN LOAD l\nMOVE P1", [1]),
        ("HAND ON\nIF x THEN LOAD l ELSE LOAD k\nMOVE P1", []),
        ("IF x THEN HAND ON\nMOVE P1", [1]),
        ("WHILE x\nMOVE P1\nHAND ON\nWEND", [3]),
        ("CALL grasp\nLOAD l\nMOVE P1\nEND\nSUB grasp\nHAND ON\nENDSUB", []),
        ("CALL grasp\nMOVE P1\nEND\nSUB grasp\nHAND ON\nENDSUB", [5]),
        ("HAND ON\nCALL ready\nLOAD l\nCALL ready\nMOVE P1\nEND\nSUB ready\nWAIT x, TIMEOUT 1\nENDSUB", []),
        ("IF x THEN HAND ON ELSE HAND ON\nMOVE P1", [1, 1]),
        ("ON ERROR GOTO *H\nMOVE P1\nMOVE P2\nEND\n*H HAND ON\nRESUME NEXT", [5]),
        ("IF x THEN\nHAND ON\nELSE\nHAND ON\nENDIF\nMOVE P1", [2, 4]),
        ("HAND ON\nCALL up\nEND\nSUB up\nDEPART 50\nENDSUB", [1]),
    ],
)
def test_load_missing(text, lines):
    assert found(text, "RBL228") == lines


def test_a_load_is_called_the_one_before_only_where_there_is_one():
    def message(text):
        (item,) = (item for item in check(parsed(text)) if item.code == "RBL228")
        return item.message

    assert "no LOAD before" in message("HAND OFF\nMOVE P1")
    assert "no LOAD before" in message("MOVE P1\nHAND ON\nMOVE P2\nEND\nLOAD l")
    assert "no LOAD before" not in message("LOAD l\nHAND ON\nMOVE P1")


def test_every_one_of_many_grasps_is_found():
    cases = "".join(f"CASE {k}\nHAND ON\n" for k in range(20))
    assert found(f"SELECT CASE x\n{cases}ENDSELECT\nMOVE P1", "RBL228") == list(range(3, 43, 2))


def test_a_short_program_that_calls_itself_in_many_ways_is_looked_at():
    subs = "".join(
        f"SUB s{k}\nIF x THEN HAND ON ELSE HAND OFF\nIF x THEN CALL s{(k + 1) % 20}\n"
        f"IF x THEN CALL s{(k + 3) % 20}\nMOVE P1\nENDSUB\n"
        for k in range(20)
    )
    assert found(f"CALL s0\nIF x THEN CALL s0\nEND\n{subs}", "RBL228")


def test_load_missing_names_the_move():
    (item,) = [one for one in check(parsed("HAND ON\nMOVE P1")) if one.code == "RBL228"]
    assert "grasps" in item.message
    assert [note.span.start for note in item.related] == [8]


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("MOVE P1\nMOVE P2", []),
        ("MOVE P1\nSPEED 100\nMOVE P2", [1]),
        ("MOVE P1\nMOVE P2, SPEED 100", [1]),
        ("MOVE P1, TIME 2\nMOVE P2, SPEED 100", []),
        ("MOVEJ P1\nSPEED 100\nMOVE P2", []),  # of joint moves nothing is said anywhere
        ("MOVEJ P1\nSPEEDJ 50\nMOVEJ P2", [1]),
        ("MOVEJ P1\nMOVEJ P2, SPEED 50", [1]),
        ("IF x THEN SPEED 100\nDEPART 5", [2]),
        ("ON ERROR GOTO *H\nSPEED 100\nTOOL t\nMOVE P1\nEND\n*H\nMOVE P2", []),  # nothing fails before SPEED
        ("ON ERROR GOTO *H\nMOVEJ P1\nSPEED 100\nMOVE P1\nEND\n*H\nMOVE P2", [7]),
        ("SPEED 100\nCALL s\nEND\nSUB s\nMOVE P1\nENDSUB", []),
    ],
)
def test_speed_unset(text, lines):
    assert found(text, "RBL226") == lines


@pytest.mark.parametrize(
    ("text", "lines"),
    [("MOVE P1", []), ("MOVE P1\nTOOL t\nMOVE P2", [1]), ("TOOL t\nMOVE P1", []), ("IF x THEN TOOL t\nMOVE P1", [2])],
)
def test_tool_unset(text, lines):
    assert found(text, "RBL227") == lines


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("MOVE P1, ZONE 5\nMOVE P2", []),
        ("MOVE P1, ZONE 5", [1]),
        ("MOVE P1, ZONE 0", []),
        ("MOVE P1, FINE", []),
        ("MOVE P1, ZONE 5\nEND", [1]),
        ("MOVE P1, ZONE 5\nHAND ON\nLOAD l\nMOVE P2", [1]),
        ("MOVE P1, ZONE 5\nx = 1\nMOVE P2", []),
        ("MOVE P1, ZONE 5\nIF x THEN HAND ON\nMOVE P2", []),  # it blends on some way
        ("IF x THEN\nMOVE P1, ZONE 5\nELSE\nMOVE P1, ZONE 5\nENDIF\nHAND ON\nLOAD l", [2, 4]),
        ("ZONE 5\nMOVE P1\nMOVE P2", []),  # a setting holds for moves that stop, too
        ("WHILE x\nMOVE P1, ZONE 5\nWEND", []),
        ("MOVE P1, ZONE 5\nq = HERE\nMOVE q", [1]),
        ("MOVE P1, ZONE 5\nt = TIMER\nMOVE P2\nPRINT t", [1]),
        ("MOVE P1, ZONE 5\nMOVE HERE * (0, 0, 9)", [1]),
        ("CALL s\nMOVE P2\nEND\nSUB s\nMOVE P1, ZONE 5\nENDSUB", []),
    ],
)
def test_blend_at_the_end(text, lines):
    assert found(text, "RBL413") == lines


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("MOVE P1, ZONE 5\nLOAD l\nMOVE P2", [2]),
        ("ZONE 5\nMOVE P1\nLOAD l\nMOVE P2", [3]),
        ("ZONE 5\nMOVE P1, FINE\nLOAD l\nMOVE P2", []),
        ("ZONE 5\nMOVE P1\nHAND ON\nLOAD l\nMOVE P2", []),
        ("ZONE 0\nMOVE P1\nLOAD l\nMOVE P2", []),
    ],
)
def test_load_in_blend(text, lines):
    assert found(text, "RBL229") == lines


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("WHILE 1\nMOVE P1\nWEND\nMOVE P2\nMOVE P3", [("RBL221", 4)]),
        ("WHILE 1\nMOVE P1\nWEND\nEND", []),  # an END behind an endless loop is a habit and does no harm
        ("IF x THEN END ELSE STOP\nMOVE P1", [("RBL221", 2)]),
        ("END\nSUB s\nMOVE P1\nENDSUB", [("RBL222", 2)]),
        ("CALL s\nEND\nSUB s\nEND\nMOVE P1\nENDSUB", [("RBL221", 5)]),
        ("ON ERROR GOTO *H\nCALL s\nMOVE P1\nEND\n*H RESUME NEXT\nSUB s\nWHILE 1\nDELAY 1\nWEND\nENDSUB", []),
        ("ON ERROR GOTO *H\nWHILE 1 / x\nDELAY 1\nGOTO *E\nWEND\nMOVE P1\nEND\n*H RESUME NEXT\n*E STOP", []),
        ("ON ERROR GOTO *H\nCALL s\nMOVE P1\nEND\n*H RESUME\nSUB s\nWHILE 1\nDELAY 1\nWEND\nENDSUB", [("RBL221", 3)]),
        ("GOTO *B\n*A MOVE P1\nGOTO *A\n*B END", [("RBL221", 2)]),  # they lead to one another, nothing to them
    ],
)
def test_what_cannot_run(text, expected):
    assert [(code, line) for code, line, *_ in checked(text) if code in ("RBL221", "RBL222")] == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x = 1", [("RBL225", 1)]),
        ("x = 1\nx = x + 1", [("RBL225", 1)]),
        ("x = 1\ny = x", [("RBL225", 2)]),
        ("CONST k = 1\nDIM a(2)\na(1) = 2", [("RBL225", 1), ("RBL225", 2)]),
        ("DIM a(2)\nx = 1\na(x) = 2\nPRINT a(0)", []),
        ("FOR i = 1 TO 2\nMOVE P1\nNEXT", []),
        ("WAIT IN(1)", [("RBL223", 1)]),
        ("IF ERR THEN WAIT IN(1)", [("RBL223", 1)]),
        ("WAIT IN(1), TIMEOUT 5", []),
    ],
)
def test_what_is_never_used_and_what_may_never_end(text, expected):
    assert [(code, line) for code, line, *_ in checked(text)] == expected


def test_a_value_that_nothing_reads_may_be_misspelt():
    (item,) = check(parsed("count = 0\ncuont = 1\nPRINT count"))
    assert (item.code, fields(item.hint)) == ("RBL225", {"COUNT"})


def test_a_program_of_more_lines_than_memory_is_for_gets_none_of_this(monkeypatch):
    text = "END\nDELAY 1"
    assert "RBL221" in [item.code for item in check(parsed(text))]
    monkeypatch.setattr(facts, "MAX_LINES", 2)
    assert "RBL221" in [item.code for item in check(parsed(text))]
    monkeypatch.setattr(facts, "MAX_LINES", 1)
    assert "RBL221" not in [item.code for item in check(parsed(text))]


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("ZONE 50\nFOR i = 1 TO 4\nMOVE HERE + (10, 0, 0)\nNEXT", [1]),
        ("ZONE 50\nMOVE P1\nMOVE HERE + (10, 0, 0)\nZONE 0\nMOVE HERE + (9, 0, 0)\nMOVE HERE + (9, 0, 0)", [1]),
        ("ZONE 50\nMOVE P1\nMOVE HERE + (10, 0, 0)\nMOVE P2", []),
        ("ZONE 50\nFOR i = 1 TO 4\nMOVE P1\nMOVE HERE + (10, 0, 0), FINE\nMOVE P2\nNEXT", []),
        ("ZONE 50\nMOVE P1\nHAND ON\nMOVE P2\nHAND OFF", []),
        ("ZONE NAN\nMOVE P1\nMOVE P2", []),
    ],
)
def test_a_setting_by_which_no_move_blends(text, lines):
    assert found(text, "RBL413") == lines
