"""A call as other languages write it: what it is here, where the SUB is in the file and where it is not."""

import re

import pytest

from robolang.analysis.analysis import Analysis
from robolang.core.diagnostics import Edit
from robolang.core.source import Span
from robolang.syntax.foreign_calls import called
from robolang.syntax.parser import parse
from tests.robolang.helpers import source

SUBS = "CALL pick(1, 2)\nEND\nSUB pick(a, b)\nENDSUB\nSUB grip\nENDSUB\n"


def found(text):
    """Code, column and hint of every error of a text."""
    text = source(text)
    return [(item.code, text.place(item.span.start).column, item.hint) for item in Analysis(source=text).diagnostics]


@pytest.mark.parametrize(
    ("line", "column", "write"),
    [
        ("pick()", 1, "CALL pick"),
        ("pick ( );", 1, "CALL pick"),
        ("pick;", 1, "CALL pick"),
        ("pick", 1, "CALL pick"),
        ("pick 1, 2;", 1, "CALL pick(1, 2)"),
        ("pick 1", 1, "CALL pick(1)"),
        ("pick(1,2)", 1, "CALL pick(1, 2)"),
        ('pick("a, b", P1 + (0, 0, 5));', 1, 'CALL pick("a, b", P1 + (0, 0, 5))'),
        ("pick(1, 2) ' now", 1, "CALL pick(1, 2)"),
        ("Call pick;", 10, "CALL pick"),
        ("CALL pick 1, 2", 11, "CALL pick(1, 2)"),
        ("*AGAIN pick()", 8, "CALL pick"),
        ("20 PICK(1, 2)", 4, "CALL PICK(1, 2)"),
        ("IF x = 1 THEN pick(1, 2)", 15, "CALL pick(1, 2)"),
        ("IF x = 1 THEN STOP ELSE pick()", 25, "CALL pick"),
        # a word of other languages, and a SUB of this program
        ("grip()", 1, "CALL grip"),
        ("grip;", 1, "CALL grip"),
    ],
)
def test_a_call_of_a_sub_of_the_file_is_written_out(line, column, write):
    items = [item for item in found(f"x = 1\n{line}\n{SUBS}") if item[0] in ("RBL111", "RBL112")]
    assert [(item[1], item[2].partition(" ")[2]) for item in items] == [(column, write)]


@pytest.mark.parametrize(
    ("line", "write"),
    [
        ('MsgNotify("hallo")', 'CALL MsgNotify("hallo")'),
        ("rg_grip(20)", "CALL rg_grip(20)"),
        ("zero;", "CALL zero"),
        ("zero 1, 2;", "CALL zero(1, 2)"),
    ],
)
def test_a_call_of_no_sub_says_what_a_call_is_and_what_it_runs(line, write):
    ((code, column, hint),) = found(line)
    assert (code, column) == ("RBL112", 1)
    assert hint == called(line).advice
    assert f"{write}, " in hint
    assert "SUB" in hint


@pytest.mark.parametrize("line", ["MOVV P1", "MOVV", "sleep(0.5)", "x.y()", "foo bar", "pick \\Fast;", "f(x"])
def test_what_is_no_call_or_a_known_word_is_called_none(line):
    assert [hint for _, _, hint in found(f"{line}\n{SUBS}") if re.search(r"CALL (?!name)", hint)] == []


@pytest.mark.parametrize("line", ["", "x = 5", "pick(NAN", "MOVE", "SIN(5)", "5", "x" * 200, "IF x THEN", "a(1) = 2"])
def test_what_cannot_be_a_call_is_none(line):
    assert called(line) is None


def test_the_help_follows_an_edit_that_takes_the_sub_away():
    text = "grip()\nEND\nSUB grip\nENDSUB\n"
    before = Analysis(source=source(text))
    assert before.diagnostics[0].hint.endswith(" CALL grip")
    after = before.updated(Edit(span=Span(text.index("SUB"), len(text)), text=""))
    assert after.diagnostics == Analysis(source=after.source).diagnostics
    assert after.diagnostics[0].hint == parse(after.source).diagnostics[0].hint != before.diagnostics[0].hint
