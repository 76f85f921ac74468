"""The table of other languages: what it proposes is read by this language, and does what the word does there."""

import re

import pytest

from robolang.analysis import expression_check
from robolang.analysis.checker import check
from robolang.core.diagnostics import Severity, in_order
from robolang.syntax import hints, keywords, other_languages
from robolang.syntax.ast import (
    Approach,
    Assign,
    Call,
    Delay,
    Depart,
    Hand,
    Jump,
    Load,
    LoadNamed,
    Move,
    MoveC,
    MoveJ,
    Out,
    Print,
    Setting,
    Sub,
    Wait,
)
from robolang.syntax.foreign import entry as meanings
from robolang.syntax.foreign import words
from robolang.syntax.foreign.shapes import SHAPES
from robolang.syntax.foreign_lines import proposal
from robolang.syntax.keywords import FUNCTIONS, KEYWORDS, VALUES
from robolang.syntax.parser import parse
from tests.robolang.helpers import cell_with, source
from tests.robolang.syntax.foreign_lines import LINES, MORE
from tests.together import together

LANGUAGES = ("KRL", "RAPID", "MELFA", "INFORM", "TP", "KAREL", "URScript", "AS", "PacScript", "VAL3", "V+")
NODES = {
    meanings.JOINTS: (MoveJ,),
    meanings.LINE: (Move,),
    meanings.ARC: (MoveC,),
    meanings.BEFORE: (Approach,),
    meanings.BACK: (Depart,),
    meanings.OUTPUT: (Out,),
    meanings.RESET: (Out,),
    meanings.INPUT: (Assign,),
    meanings.TIME: (Delay,),
    meanings.CONDITION: (Wait,),
    meanings.CLOSES: (Hand,),
    meanings.OPENS: (Hand,),
    meanings.PAYLOAD: (Load, LoadNamed),
    meanings.TOOL: (Setting,),
    meanings.FRAME: (Setting,),
    meanings.SHOWS: (Print,),
    meanings.GOTO: (Jump,),
    meanings.BEGINS: (Sub,),
}


def found(text):
    """Everything in a text that is worth more than a remark."""
    parsed = parse(source(text))
    items = in_order((*parsed.diagnostics, *check(parsed.program, cell_with(points=["P1", "P2"]))))
    return [item for item in items if item.severity is not Severity.INFO]


def statements(text):
    """The nodes of lines that have no error of text."""
    result = parse(source(text))
    assert result.diagnostics == (), text
    return [line.statement for line in result.program.lines]


def refused(text):
    """The codes of what a check refuses in statements; blocks, names and labels are those of another program."""
    of_others = {"RBL201", "RBL202", "RBL211", "RBL212", "RBL213", "RBL215", "RBL301", "RBL305", "RBL306"}
    return [item.code for item in found(text) if item.severity is Severity.ERROR and item.code not in of_others]


# --- lines as somebody types them by mistake --------------------------------------------------------------------------


def test_the_figure_has_sixty_lines_of_ten_languages_and_more():
    assert len(LINES) == 60
    assert {line.language for line in LINES} == set(LANGUAGES)
    assert len({line.text for line in (*LINES, *MORE)}) == 110


@together("line", [*LINES, *MORE], ids=lambda line: f"{line.language}: {line.text[:30]}")
def test_a_line_of_another_language_has_one_finding_with_the_statement_to_write(line):
    (item,) = found(line.text)
    place = line.text.index(line.at) if line.at else len(line.text)
    assert item.span.start == place
    assert [part for part in line.advice if part not in item.hint] == []
    assert [part for part in line.never if part in item.hint] == []


@pytest.mark.parametrize("line", ["MOV P1", "20 MOV P1", "*A MOV P1", "  mov P1"])
def test_numbers_labels_and_blanks_before_a_line_change_nothing(line):
    (item,) = found(line)
    assert "MOVEJ P1" in item.hint


# --- words ------------------------------------------------------------------------------------------------------------


def test_the_table_has_words_of_all_languages():
    names = {word for each in words.every() for word in each.words.split()}
    assert len(names) >= 250
    assert len(SHAPES) >= 150
    for language in LANGUAGES:
        of = {word for each in words.every() if language in each.languages for word in each.words.split()}
        assert len(of) >= 12, language


@together("each", words.every(), ids=lambda each: f"{each.words[:20]} {each.languages[0]}")
def test_what_a_word_stands_for_is_read_and_does_the_same(each):
    assert each.write or each.note or each.missing
    nodes = statements(each.write)
    assert refused(each.write) == []
    if kinds := NODES.get(each.means):
        assert isinstance(nodes[0], kinds)
    if each.means in (meanings.CLOSES, meanings.OPENS):
        assert nodes[0].state.name == ("ON" if each.means == meanings.CLOSES else "OFF")
    if each.means in (meanings.OUTPUT, meanings.RESET):
        assert nodes[0].value.value == (each.means == meanings.OUTPUT)
    if each.means == meanings.INPUT:
        assert isinstance(nodes[0].value, Call)
        assert nodes[0].value.name.key == "IN"
    if each.means in (meanings.TOOL, meanings.FRAME):
        assert nodes[0].word == ("TOOL" if each.means == meanings.TOOL else "FRAME")


@together("word", sorted(words.instructions()))
def test_no_word_of_the_table_gets_a_guess_by_its_letters(word, monkeypatch):
    for module in (keywords, hints, expression_check):
        monkeypatch.setattr(module, "near", lambda *_, **__: "GUESSED")
    assert word not in KEYWORDS | FUNCTIONS | VALUES
    for text in (f"{word} P1", f"MOVE P1, {word}", f"PRINT {word}(1)"):
        assert [item.hint for item in found(text) if "GUESSED" in item.hint] == []


@pytest.mark.parametrize("word", sorted(words.own()))
def test_words_that_mean_something_else_elsewhere_are_words_of_this_language(word):
    assert word in KEYWORDS | FUNCTIONS | VALUES


@pytest.mark.parametrize(
    ("word", "parts"),
    [
        ("SET", ("RAPID", "OUT(1) = 1", "INFORM", "x = 5")),
        ("OPEN", ("AS", "HAND OFF", "RAPID", "there is none")),
        ("BREAK", ("URScript", "GOTO", "V+", "remove", "RAPID", "STOP")),
        ("DEF", ("KRL", "SUB", "MELFA", "x = 5")),
        ("SIGNAL", ("AS", "OUT(1) = 1", "KRL", "KAREL", "there is none")),
        ("CONNECT", ("RAPID", "there is none", "IF IN(1) = 1")),
        ("TRK", ("MELFA", "there is none")),
    ],
)
def test_a_word_that_stands_for_several_things_names_them_all(word, parts):
    hint = other_languages.instruction(word.lower())
    assert [part for part in parts if part not in hint] == []


# --- whole lines ------------------------------------------------------------------------------------------------------


@together("shape", SHAPES, ids=lambda shape: shape.example)
def test_the_example_of_a_shape_has_that_shape(shape):
    result = proposal(shape.example)
    assert result is not None
    assert result.shape == shape
    assert statements("\n".join(result.statements)) or result.note
    assert refused("\n".join(result.statements)) == []
    assert bool(result.statements) == bool(shape.write)


@pytest.mark.parametrize(
    ("text", "write"),
    [
        ("movej([3.14159265, 0, -1.57079633, 0, 1, 0], a=1, v=1)", "MOVEJ JOINT(180, 0, -90, 0, 57.296, 0)"),
        ("PTP {X 400, Y 0, Z 500, A 10, B 20, C 30}", "MOVEJ POSE(400, 0, 500, 30, 20, 10)"),
        ("MoveL p1, v5, z0, tool0;", "MOVE p1, SPEED 5, ZONE 0.3"),
        ("MoveL RelTool(p1, 1, 2, -3), v50, fine, tool0;", "MOVE p1 * (1, 2, -3), SPEED 50, FINE"),
        ("LIN P2 Vel=0.05 m/s CPDAT1", "MOVE P2, SPEED 50"),
        ("set_payload(1.5, [0.01, -0.02, 0.05])", "LOAD (10, -20, 50), 1.5"),
        ("IF ($IN[1]==TRUE) AND NOT $IN[2] THEN", "IF (IN(1) = 1) AND NOT IN(2) THEN"),
        ("WHILE ($IN[1] != FALSE) && (x<=3)", "WHILE (IN(1) <> 0) AND (x <= 3)"),
        ("DO[007]=off", "OUT(7) = 0"),
        ("SIGNAL -12", "OUT(12) = 0"),
        ("SWAIT -1002", "WAIT IN(2) = 0"),
        ("WAIT SEC .50", "DELAY 0.5"),
    ],
)
def test_numbers_are_carried_over_in_the_units_of_this_language(text, write):
    result = proposal(text)
    assert result is not None
    assert result.statements == (write,)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "  ",
        "'",
        "*",
        "MOV",
        "MOV P1 P2",
        "PTP " + "x" * 300,
        "DO[1]=",
        "DO[1]=NAN",
        "SWAIT NAN",
        "movej([NAN,0,0,0,0,0])",
        "IF THEN",
        "IF (1 == 2 THEN",
        "WAIT FOR \x00",
        "MoveL p1, vNaN, z, tool0;",
        "DO[99999999999]=ON",
    ],
)
def test_what_is_no_whole_line_has_no_statement(text):
    assert proposal(text) is None


@pytest.mark.parametrize(
    ("text", "write", "lost"),
    [
        ("CIRC XP2, XP3, CA 360", "MOVEC XP2, XP3", "CA 360"),
        ("MOVL P002 V=23.0 UNTIL IN#(1)=ON", "MOVE P002, SPEED 23", "UNTIL IN#(1)=ON"),
        ("MoveL p1, v300, z1, tGrip\\WObj:=wTray;", "MOVE p1, SPEED 300, ZONE 1", "tGrip\\WObj:=wTray"),
        ("L P[3] 1000mm/sec FINE ACC50", "MOVE P3, SPEED 1000, FINE", "ACC50"),
        ("Move L, @P P2", "MOVE P2", "@P"),
        ("J P[1] 50% CNT80", "MOVEJ P1, SPEED 50", "CNT80"),
    ],
)
def test_what_is_not_carried_over_is_named(text, write, lost):
    result = proposal(text)
    assert result is not None
    assert result.statements == (write,)
    assert lost in result.note


@pytest.mark.parametrize("text", ["Move L, @E P2", "PTP P1", "DO[1]=ON", "MOVS", "LMOVE p2"])
def test_where_nothing_is_lost_nothing_is_noted(text):
    result = proposal(text)
    assert result is None or result.note == ""


@pytest.mark.parametrize(
    ("text", "at", "parts"),
    [
        ("x = M_In(2)", 4, ("IN(2)",)),
        ("WAIT SIG(1005)", 5, ("IN(5)",)),
        ("x = get_actual_tcp_pose()", 24, ("URScript", "HERE")),
        ("x = P_Curr", 4, ("MELFA", "HERE")),
        ("HERE p1", 0, ("AS", "P10 = HERE")),
        ("INT i", 0, ("KRL", "x = 5")),
        ("movej(get_inverse_kin(p1), a=1, v=1)", 5, ("MOVEJ p1",)),
        ("set_digital_out(0, True)", 0, ("URScript", "OUT(1)")),
        ("EXTSPEED 50", 0, ("PacScript", "OVERRIDE 50")),
    ],
)
def test_words_inside_a_line_have_their_advice_too(text, at, parts):
    (item,) = found(text)
    assert item.span.start == at
    assert [part for part in parts if part not in item.hint] == []


def test_nothing_that_is_proposed_needs_a_line_longer_than_one_by_hand():
    assert proposal(f"! {'x' * 100}") is not None
    assert proposal(f"! {'x' * 1000}") is None


def test_languages_of_the_table_have_a_maker():
    general = {meanings.OTHERS, meanings.C, meanings.PYTHON, meanings.G_CODE}
    named = {language for each in words.every() for language in each.languages} - general
    assert named | {language for shape in SHAPES for language in shape.languages} - general == set(meanings.MAKERS)
    assert set(LANGUAGES) <= set(meanings.MAKERS)
    assert all(re.fullmatch(r"[A-Z0-9_$ ]+", each.words) for each in words.every())


@pytest.mark.parametrize(
    "piece", ["", " ", "9" * 80, "1e99", "NAN", "-", "'", '"', "[", ")", "\\", "%", "P[0]", "\x00", "é"]
)
def test_a_damaged_line_has_a_statement_that_is_read_or_none(piece):
    for shape in SHAPES:
        middle = len(shape.example) // 2
        result = proposal(shape.example[:middle] + piece + shape.example[middle:])
        assert result is None or statements("\n".join(result.statements)) is not None
