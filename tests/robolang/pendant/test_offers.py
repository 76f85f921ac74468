"""What completion offers at each place, with its meaning; and help at a word."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from prompt_toolkit.completion import CompleteEvent
from prompt_toolkit.document import Document

from robolang.analysis.analysis import Analysis
from robolang.analysis.cell_symbols import CellSymbols
from robolang.core.source import Source
from robolang.pendant.assembly import COMMANDS
from robolang.pendant.completer import PromptCompleter
from robolang.pendant.known import Known, natural
from robolang.pendant.offers import offered
from robolang.pendant.word_help import explained, word_at
from robolang.project.points import Point
from robolang.syntax.completion import completions
from robolang.values.functions import FUNCTIONS
from runtime.cell.cell_file import LoadFile

TEXT = """\
10 CONST FAST = 500
20 *AGAIN MOVE P1
30 DIM a(3)
40 CALL fill(3)
50 GOTO *AGAIN
SUB fill(n)
ENDSUB
"""
CELL = CellSymbols(
    tools=frozenset({"GRIP", "FLANGE"}),
    frames=frozenset({"TABLE", "WORLD"}),
    loads={"FULL": LoadFile(mass_kg=2.3, cog_mm=(0.0, 0.0, 95.0))},
    sensors=frozenset({"EYE"}),
    inputs=frozenset({1, 3}),
    points=frozenset({"P1", "P2", "P10"}),
)
POINTS = {
    "P1": Point(name="P1", pose=(480.0, -220.0, 640.0, 180.0, 0.0, 90.0), comment="above the table"),
    "P2": Point(name="P2", joints=(0.0, 45.0, 90.0, 0.0, 45.0, 0.0)),
    "P10": Point(name="p10", pose=(1.0, 2.0, 3.0, 0.0, 0.0, 0.0), frame="TABLE"),
}
KNOWN = Known(
    analysis=Analysis(source=Source("job.rbl", TEXT), cell=CELL),
    points=POINTS,
    values={"FAST": "500", "HELLO": '"x"'},
    inputs={1: 0.0, 3: 1.0},
    outputs={2: 1.0},
)


OPTIONS = ["SPEED", "ACCEL", "ACCEL MAX", "TIME", "ZONE", "FINE", "WRIST HOLD", "WRIST KEEP", "WRIST AUTO"]


def texts(typed):
    return [each.text for each in offered(typed, KNOWN, COMMANDS)]


def meaning(typed, text):
    return next(each.meaning for each in offered(typed, KNOWN, COMMANDS) if each.text == text)


@pytest.mark.parametrize(
    ("typed", "first"),
    [
        ("MOVE ", ["P1", "P2", "p10"]),
        ("move p", ["P1", "P2", "p10"]),
        ("20 MOVEJ ", ["P1", "P2", "p10"]),
        ("MOVEC P1, ", ["P1", "P2", "p10"]),
        ("SPLINE (P1, ", ["P1", "P2", "p10"]),
        ("SPLINE (P1, P2), ", OPTIONS),
        ("spl", ["SPLINE"]),
        ("MOVE P1, ", OPTIONS),
        ("MOVE P1, w", ["WRIST HOLD", "WRIST KEEP", "WRIST AUTO"]),
        ("MOVE P1, SPEED ", ["HELLO", "FAST", "a", "P1"]),
        ("GOTO ", ["*AGAIN", "10", "20", "30", "40", "50"]),
        ("GOTO *", ["*AGAIN"]),
        ("ON ERROR GOTO ", ["*AGAIN"]),
        ("CALL ", ["fill"]),
        ("LOAD ", ["FULL"]),
        ("TOOL ", ["FLANGE", "GRIP"]),
        ("FRAME ", ["TABLE", "WORLD"]),
        ("SEAM ON, ", ["EYE"]),
        ("PRINT IN(", ["1", "3"]),
        ("OUT(", ["2"]),
        ("P1.", ["X", "Y", "Z", "RX", "RY", "RZ"]),
        ("P1.r", ["RX", "RY", "RZ"]),
        ("IF x ", ["THEN", "AND", "MOD", "OR", "XOR"]),
        ("WAIT IN(1), ", ["TIMEOUT"]),
        ("HAND ", ["OFF", "ON"]),
        ("IF 1 THEN MO", ["MOVE", "MOVEJ", "MOVEC"]),
        ("IF 1\nMO", ["MOVE", "MOVEJ", "MOVEC"]),
        ("*top MO", ["MOVE", "MOVEJ", "MOVEC"]),
        ("x = 2 *P", ["P1", "P2", "p10"]),
        ("teach ", ["P1", "P2", "p10"]),
        ("in ", ["1", "3", "on", "off", "auto"]),
        ("list *", ["*AGAIN"]),
        ("help mo", ["MOVE", "MOVEJ", "MOVEC"]),
        ("te", ["teach"]),
        ('PRINT "MO', []),
        ("DELAY 1 ' MO", []),
        ("REM MO", []),
        ("list = P", ["P1", "P2", "p10"]),
    ],
)
def test_what_is_offered(typed, first):
    found = texts(typed)
    assert found[: len(first)] == first
    assert bool(found) == bool(first)


def test_every_word_that_begins_a_statement_and_every_command_is_offered_at_the_start():
    found = set(texts(""))
    assert {each.words for each in completions() if not each.after} <= found
    assert {command.word for command in COMMANDS} <= found


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_is_offered_with_its_form(name):
    form = FUNCTIONS[name].form
    offer = next(each for each in offered(f"PRINT {name}", KNOWN, COMMANDS) if each.text.rstrip("(") == name)
    assert not FUNCTIONS[name].parameters or form in offer.meaning


@pytest.mark.parametrize(
    ("typed", "text", "expected"),
    [
        ("MOVE ", "P1", "480 -220 640 mm  180 0 90 deg  above the table"),
        ("MOVE ", "P2", "joints 0 45 90 0 45 0"),
        ("MOVE ", "p10", "1 2 3 mm  0 0 0 deg  in TABLE"),
        ("GOTO ", "*AGAIN", "20 *AGAIN MOVE P1"),
        ("GOTO ", "50", "50 GOTO *AGAIN"),
        ("LOAD ", "FULL", "load  2.3 kg at 0 0 95 mm"),
        ("PRINT ", "FAST", "constant = 500"),
        ("PRINT ", "HELLO", '= "x"'),
        ("PRINT IN(", "3", "is 1"),
    ],
)
def test_meanings(typed, text, expected):
    assert meaning(typed, text) == expected


def test_names_are_in_the_order_of_people():
    assert sorted(["P10", "P2", "a3", "A20", "P1"], key=natural) == ["a3", "A20", "P1", "P2", "P10"]
    assert natural("P" + "9" * 5000)


@given(st.text(max_size=60))
def test_any_text_can_be_completed_and_explained(text):
    for each in offered(text, KNOWN, COMMANDS):
        assert 0 <= each.replaces <= len(text)
    explained(word_at(text, len(text) // 2), text, KNOWN, COMMANDS)


@given(st.text(alphabet=st.sampled_from("MOVEPIF GT*(1,).'\"= \n"), max_size=30))
def test_any_words_can_be_completed(text):
    for each in offered(text, KNOWN, COMMANDS):
        assert text[len(text) - each.replaces :].upper() == each.text[: each.replaces].upper()


def test_a_meaning_is_one_short_line():
    point = Point(name="P1", pose=(0.0,) * 6, comment="\x1b[31m" + "long " * 50)
    known = KNOWN.replaced(points={**POINTS, "P1": point})
    completer = PromptCompleter(lambda: known, COMMANDS)
    found = list(completer.get_completions(Document("MOVE P"), CompleteEvent(text_inserted=True)))
    assert len(found[0].display_meta_text) <= 70
    assert "\x1b" not in found[0].display_meta_text


def test_nothing_comes_up_before_something_is_typed():
    completer = PromptCompleter(lambda: KNOWN, COMMANDS)
    assert not list(completer.get_completions(Document("IF 1\n  "), CompleteEvent(text_inserted=True)))
    assert list(completer.get_completions(Document(""), CompleteEvent(completion_requested=True)))


@pytest.mark.parametrize(
    ("text", "cursor", "word"),
    [("MOVE P1", 2, "MOVE"), ("MOVE P1", 7, "P1"), ("MOVE P1, ", 9, "P1"), ("", 0, ""), ("  +", 3, "")],
)
def test_the_word_at_the_cursor(text, cursor, word):
    assert word_at(text, cursor) == word


@pytest.mark.parametrize(
    ("word", "text", "expected"),
    [
        ("move", "move P1", "moves the tool point on a straight line"),
        ("SPEED", "MOVE P1, SPEED 10", "speed of the tool point, mm/s"),
        ("SPEED", "SPEED 10", "sets the speed of straight moves"),
        ("THEN", "IF x THEN", "carries out one of two statements"),
        ("ROUND", "x = ROUND(1)", "ROUND(x [, digits])"),
        ("P1", "MOVE P1", "taught point: 480 -220 640 mm"),
        ("teach", "teach P1", "Teach a point"),
        ("ptp", "ptp P1", "MOVEJ P1, SPEED 50"),
        ("nothing", "nothing", ""),
    ],
)
def test_help_at_a_word(word, text, expected):
    assert expected in explained(word, text, KNOWN, COMMANDS)
    assert bool(expected) == bool(explained(word, text, KNOWN, COMMANDS))
