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
from tests.robolang.syntax.fresh_lines import FRESH
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


def test_the_second_figure_has_a_hundred_lines_that_the_first_has_not():
    assert len({line.text for line in FRESH} - {line.text for line in (*LINES, *MORE)}) == 100
    assert {line.language for line in FRESH} == set(LANGUAGES) - {"V+"}


@pytest.mark.parametrize("line", FRESH, ids=lambda line: f"{line.language}: {line.text[:30]}")
def test_a_fresh_line_has_the_advice_that_is_right(line):
    hints = "\n".join(item.hint for item in found(line.text))
    assert [part for part in line.advice if part not in hints] == []
    assert [part for part in line.never if part in hints] == []


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
        ("LIN_REL {Z 100}", "MOVE HERE + (0, 0, 100)"),
        ("WaitDI diPart, 1\\MaxTime:=10;", "WAIT IN(n) = 1, TIMEOUT 10"),
        ("LBL[10:end]", "*L10 ' end"),
        ("LBL[10]", "*L10"),
        ("while (not get_standard_digital_in(2)):", "WHILE NOT IN(2)"),
        ("while (not get_standard_digital_in(0)):", "WHILE NOT IN(n)"),
        ("if get_digital_in(0) == False:", "IF IN(n) = 0 THEN"),
        ("PR[1,3]=PR[1,3]+100", "PR1 = PR1 + (0, 0, 100)"),
        ("PR[1,1]=PR[1,1]-R[2]", "PR1 = POSE(PR1.X - R2, PR1.Y, PR1.Z, PR1.RX, PR1.RY, PR1.RZ)"),
        ("PR[2,6]=90", "PR2 = POSE(PR2.X, PR2.Y, PR2.Z, PR2.RX, PR2.RY, 90)"),
        ("p10.trans.z := p10.trans.z + 50;", "p10 = p10 + (0, 0, 50)"),
        ("p10.trans.x := 400;", "p10 = POSE(400, p10.Y, p10.Z, p10.RX, p10.RY, p10.RZ)"),
        ("p20 := RelTool(p10,0,0,50\\Rz:=90);", "p20 = p10 * (0, 0, 50, 0, 0, 90)"),
        ("If M_In(1) = 1 Then *L1", "IF IN(1) = 1 THEN GOTO *L1"),
        ("for i in range(5):", "FOR i = 0 TO 4"),
        ("GO TO again", "GOTO *again"),
        ("movel(p1, a=1.2, v=0.25) # approach", "MOVE p1, SPEED 250 ' approach"),
        ("Set do1; ! grip", "OUT(n) = 1 ' grip"),
        ("DOUT[1] = ON -- grip", "OUT(1) = 1 ' grip"),
        ('TPWrite "a; b";', 'PRINT "a; b"'),
        ("$TOOL={X 0,Y 0,Z 150,A 10,B 20,C 30}", "TOOL POSE(0, 0, 150, 30, 20, 10)"),
        ("Wait IO[5] = On, 3000", "WAIT IN(5) = 1, TIMEOUT 3"),
        ("PULSE DOUT[4] FOR 300", "PULSE 4, 0.3"),
        ("LIN_REL {Y -5, X 2}", "MOVE HERE + (2, -5, 0)"),
        ("LIN XP1:{Z -50} C_DIS", "MOVE XP1 * (0, 0, -50)"),
        ("LIN_REL {Z 100} #TOOL", "MOVE HERE * (0, 0, 100)"),
        ("LIN_REL {Z 100, A 90} #TOOL", "MOVE HERE * (0, 0, 100, 0, 0, 90)"),
        (
            "movel(p[0.4,0,0.3,0,3.14,0], a=1.2, v=0.25, r=0.02)",
            "MOVE POSE(400, 0, 300, rx, ry, rz), SPEED 250, ZONE 20",
        ),
        ("movel(p[0.4,0,0.3,0,0,0], 1.2, 0.25)", "MOVE POSE(400, 0, 300, 0, 0, 0), SPEED 250"),
        ("movej([0,0,0,0,0,0], t=3)", "MOVEJ JOINT(0, 0, 0, 0, 0, 0), TIME 3"),
        ("movel(pose_trans(get_actual_tcp_pose(), p[0,0,-0.05,0,0,0]), v=0.1)", "MOVE HERE * (0, 0, -50), SPEED 100"),
        ("L P[4] 60cm/min FINE", "MOVE P4, SPEED 10, FINE"),
        ("L P[8] R[10]mm/sec FINE", "MOVE P8, SPEED R10, FINE"),
        ("MOVL C00002 V=250.0 PL=0", "MOVE C00002, SPEED 250, FINE"),
        ("MoveL RelTool(p1,0,0,-50\\Rz:=90), v100, fine, tool0;", "MOVE p1 * (0, 0, -50, 0, 0, 90), SPEED 100, FINE"),
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
        # joints by an offset, and turns in the frame: there is no statement for them
        "PTP_REL {A1 10}",
        "LIN_REL {Z 50, A 90}",
        "LIN_REL {Z NAN}",
        "movel(pose_trans(p1, p[0,0,-0.05,0,3.14,0]), v=0.1)",
        "MoveL RelTool(p1,0,0,5\\Rx:=9\\Rz:=90), v100, fine, tool0;",
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
        ("L P[3] 1000mm/sec FINE ACC50 Offset,PR[1]", "MOVE P3, SPEED 1000, FINE, ACCEL 50", "Offset,PR[1]"),
        ("J PR[1:home] 50% CNT100 ACC80", "MOVEJ PR1, SPEED 50, ACCEL 80", "CNT100"),
        ("J P[1] 50% FINE ACC150", "MOVEJ P1, SPEED 50, FINE", "ACC150"),
        ("J P[2] 2.0sec FINE Wrist,JNT", "MOVEJ P2, TIME 2, FINE", "Wrist,JNT"),
        ("L P[8] max_speed CNT10", "MOVE P8", "max_speed"),
        ("PTP P1 CONT", "MOVEJ P1", "ZONE"),
        ("LIN_REL {Z 50} C_DIS #BASE", "MOVE HERE + (0, 0, 50)", "C_DIS #BASE"),
        ("PTP {X 400, Y 0, Z 500, A 0, B 90, C 0, S 2, T 35} C_PTP", "MOVEJ POSE(400, 0, 500, 0, 90, 0)", "S 2, T 35"),
        ("MoveL\\Conc, p1, v500, z10, tool0;", "MOVE p1, SPEED 500, ZONE 10", "\\Conc, tool0"),
        ("MoveL p10\\ID:=10, v500, z10, tool0;", "MOVE p10, SPEED 500, ZONE 10", "\\ID:=10, tool0"),
        ("MoveL p1, v500\\V:=120, z10, tool0;", "MOVE p1, SPEED 500, ZONE 10", "\\V:=120, tool0"),
        ("MoveL p1, v500\\T:=3, z10, tool0;", "MOVE p1, TIME 3, ZONE 10", "v500, tool0"),
        ("MoveJ p1, v500\\T:=3, fine\\Inpos:=inpos20, tool0;", "MOVEJ p1, TIME 3, FINE", "v500, \\Inpos:=inpos20"),
        ("MoveJ p1, vmax, z10, tool0;", "MOVEJ p1, ZONE 10", "vmax, tool0"),
        ("movel(pick, a=1.2, v=0.25, t=0, r=0.02)", "MOVE pick, SPEED 250, ZONE 20", "a=1.2"),
        ("movel(pick, v=slow)", "MOVE pick", "v=slow"),
        ("movel(pick, 1.2, 0.25, 3)", "MOVE pick", "1.2, 0.25, 3"),
        ("movel(pick, t=NAN)", "MOVE pick", "t=NAN"),
        ("movej(home, a=1.4, v=1.05, t=3, r=0)", "MOVEJ home, TIME 3", "a=1.4, v=1.05"),
        ("Mov P1 Wth M_Out(8)=1", "MOVEJ P1", "Wth M_Out(8)=1"),
        ("MOVJ P001 VJ=25.00 PL=2 NWAIT", "MOVEJ P001, SPEED 25", "NWAIT"),
        ("movel(pPick, tGripper, mSlow)", "MOVE pPick", "tGripper, mSlow"),
        ("Move L, @P P2, S=50", "MOVE P2", "S=50"),
        ("LMOVE p2, 2", "MOVE p2", "2"),
        ("$OUT[25]=FALSE ;auf", "OUT(25) = 0", "auf"),
        ("Set do1; WaitTime 1;", "OUT(n) = 1", "WaitTime 1"),
        ("PTP P1 Vel=50 % PDAT1 ;home", "MOVEJ P1, SPEED 50", "PDAT1, home"),
        ("Move L, @P P2", "MOVE P2", "@P"),
        ("J P[1] 50% CNT80", "MOVEJ P1, SPEED 50", "CNT80"),
    ],
)
def test_what_is_not_carried_over_is_named(text, write, lost):
    result = proposal(text)
    assert result is not None
    assert result.statements == (write,)
    assert lost in result.note


OF_SIGNALS = re.compile(r"\(\?: :.{1,8}?\*\)\?")
"""A comment in the brackets of a signal, a register or a label of TP."""
DROPPED = re.compile(r"\.[*+]|\\[wd][+*]|\[\^|\\d")
SAID_BY_A_NOTE = {
    "C_PTP",
    "C_DIS",
    "MoveL",
    "MoveJ",
    "MoveAbsJ",
    "robtarget",
    "jointtarget",
    "$VEL_AXIS[1]=50",
    "$MOTYPE",
}
TYPES = {
    "VAR num x;",
    "VAR num x := 5;",
    "DECL INT x = 5",
    "count : INTEGER",
    "&ACCESS RVP",
    "set_tool_digital_out(0,True)",
}


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.example)
def test_no_pattern_drops_what_no_hint_names(shape):
    """What a pattern takes is written, or is one of the readings that are named as left out."""
    pattern = OF_SIGNALS.sub("", re.sub(r"<[a-z]+\d?>", "", shape.pattern))
    if DROPPED.search(pattern):
        assert shape.example in TYPES or SAID_BY_A_NOTE & set(shape.example.split())
        assert shape.example in TYPES or shape.note


NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?")
OTHER_NUMBERS = ("rx, ry, rz", "n is the", "that of all joints", "PRINT")
"""What the advice has where a turn, a signal, one axis or the digits of a text are of another kind here."""


@pytest.mark.parametrize("text", [*(shape.example for shape in SHAPES), *(line.text for line in FRESH)])
def test_another_number_in_a_line_is_another_advice(text):
    """A value that is lost without a note would leave the advice as it is."""
    result = proposal(text)
    # 9E9: axes that the robot has not
    if result is None or "9E9" in text or any(part in result.advice for part in OTHER_NUMBERS):
        return
    for number in NUMBER.finditer(text):
        other = "7" if number[0] != "7" else "3"
        changed = proposal(f"{text[: number.start()]}{other}{text[number.end() :]}")
        assert changed is None or changed.advice != result.advice, number


@pytest.mark.parametrize("text", ["Move L, @E P2", "PTP P1", "DO[1]=ON", "MOVS", "LMOVE p2"])
def test_where_nothing_is_lost_nothing_is_noted(text):
    result = proposal(text)
    assert result is None or result.note == ""


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("SELECT R[1]=1,CALL A", ("SELECT R1", "CASE 1", "CALL A")),
        ("=2,JMP LBL[3]", ("CASE 2", "GOTO *L3")),
        ("ELSE,CALL C", ("CASE ELSE", "CALL C")),
        ("PERS tooldata tGrip := [TRUE,[[0,0,120],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];", ()),
        ("DECL E6POS XP5", ()),
        ("def prog():", ()),
        ("/PROG  PICK", ()),
        ("/MN", ()),
        ("/END", ()),
    ],
)
def test_a_line_may_be_several_statements_or_none(text, lines):
    result = proposal(text)
    assert result is not None
    assert result.statements == lines
    assert lines or result.note


@pytest.mark.parametrize(
    ("text", "parts", "never"),
    [
        ("$ADVANCE=3", ("remove",), ("s$",)),
        ("StopMove;", ("RAPID", "STOP"), ("did you mean",)),
        ("P3 = P1 * P2", ("P1 * (P2.X, P2.Y, P2.Z, P2.RX, P2.RY, P2.RZ)",), ("P1 + (",)),
        ("PTP_REL {A1 10}", ("there is none", "JOINT("), ("HERE",)),
        ("x = diPart", ("IN(n)",), ("did you mean",)),
        ("IF DI_READY = 1 THEN END", ("IN(n)",), ()),
        ("x = doGrip", ("OUT(n)",), ()),
        ("x = diameter", (), ("IN(n)",)),
        ("SPEED VJ=40.00", ("SPEEDJ 40",), ()),
        ('PRINT "a"; 5, 6', (";",), ("left out",)),
        ("set_payload_mass(2)", ("LOAD",), ("CALL",)),
        ("OUT 5 'grip' State=FALSE", ("OUT(5) = 0", "'grip'"), ()),
    ],
)
def test_a_line_without_a_statement_of_its_own_is_explained(text, parts, never):
    hints = [item.hint for item in found(text)]
    assert [part for part in parts if part not in hints[0]] == []
    assert [part for part in never if part in hints[0]] == []


def test_a_name_of_a_line_with_an_error_is_no_guess():
    hints = [item.hint for item in found("DIM dinput 5\nx = DINPUT[1]\ny = diPart") if item.code == "RBL215"]
    assert [hint for hint in hints if "DINPUT" in hint.upper()] == []


@pytest.mark.parametrize(
    ("text", "at", "parts"),
    [
        ("x = M_In(2)", 4, ("IN(2)",)),
        ("WAIT SIG(1005)", 5, ("IN(5)",)),
        ("x = get_actual_tcp_pose()", 24, ("URScript", "HERE")),
        ("x = P_Curr", 4, ("x = HERE",)),
        ("HERE p1", 0, ("p1 = HERE",)),
        ("INT i", 0, ("KRL", "x = 5")),
        ("movej(get_inverse_kin(p1), a=1, v=1)", 5, ("MOVEJ p1",)),
        ("set_digital_out(0, False)", 0, ("OUT(n) = 0",)),
        ("EXTSPEED 80", 0, ("OVERRIDE 80",)),
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
