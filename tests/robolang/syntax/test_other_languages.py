"""Words and signs of other languages: one error, and its remedy names what this language has."""

import pytest

from robolang.analysis.checker import check
from robolang.core.diagnostics import in_order
from robolang.syntax import other_languages
from robolang.syntax.parser import parse
from tests.messages import fields
from tests.robolang.helpers import cell_with, source


def found(text):
    """Code, line and hint of everything in a text."""
    parsed = parse(source(text))
    items = in_order((*parsed.diagnostics, *check(parsed.program, cell_with(points=["P1"]))))
    return [(item.code, source(text).place(item.span.start).line, item.hint) for item in items]


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("SPEED = 100", "SPEED"),
        ("SPEED := 5", ":="),
        ("MOVE P1, SPEED = 100", "SPEED"),
        ("DELAY = 5", ""),
        ("IF 1 == 1 THEN END", " = "),
        ("x := 5", "= "),
        ("FOR i := 1 TO 3\nNEXT", "= "),
        ("IF 1 != 2 THEN END", "<>"),
        ("IF 1 && 2 THEN END", "AND"),
        ("IF 1 || 2 THEN END", "OR"),
        ("OUT(1) = ON", "1"),
        ("WAIT IN(1) = OFF, TIMEOUT 2", "0"),
        ("OUT(1) = TRUE", "1"),
        ("P1.Z = 90", "P1 = POSE(P1.X, P1.Y, value, P1.RX, P1.RY, P1.RZ)"),
        ("PCU.rx=1", "value, PCU.RY, PCU.RZ"),
        ("OUT(1) = 1 : OUT(2) = 1", ""),
        ("LABEL:", "*LABEL"),
        ("GOTO LABEL", "GOTO *LABEL"),
        ("// text", "' text"),
        ("; text", "' text"),
        ("MOVE P1 ; text", "' or REM"),
        ("MOVE P1 // text", "' or REM"),
        ("OUT(1) = 1; OUT(2) = 0", "no ;"),
        ("MOVE P1 //text", "' or REM"),
        ("HAND ON // text", "' or REM"),
        ("HAND ON /* text */", "' or REM"),
        ("MOVE P1 /* text */", "' or REM"),
        ("MOVE P1, SPEED 5 // text", "' or REM"),
        ("MOVE P1 # text", "' or REM"),
        ("x = 5 // 2", "INT("),
        ("$ADVANCE=3", "remove"),
        ("$MOTYPE=LINEAR", "MOVEJ"),
        ("$FOO = 1", "there are no"),
        ("# text", "' text"),
        ("-- text", "' text"),
        ("MOVE P1 ! text", "' or REM"),
        ("OUT(1) = 5 % 3", "MOD"),
        ("OUT(1) = 5 DIV 3", "INT("),
        ("x += 1", "x = x + value"),
        ("x++", "x = x + 1"),
        ("LET x = 1", "x = 1"),
        ("INT x = 1", "x = 1"),
        ("DECL INT x", "x = 5"),
        ("x = [1, 2]", "POSE(x, y, z, rx, ry, rz)"),
        ("x = 5 + [1, 2, 3]", "P1 + (0, 0, 50)"),
        ("x = IN[1]", "( )"),
        ("PTP P1", "MOVEJ"),
        ("LIN P1", "MOVE "),
        ("MoveL P1, v100", "MOVE "),
        ("MOVL P1", "MOVE "),
        ("CIRC P1, P1", "MOVEC"),
        ("MoveJ P1, v100, fine, tool0;", "MOVEJ P1, FINE"),
        ("MOVE P1, z10", "ZONE 10"),
        ("J P[1] 100% FINE", "MOVEJ"),
        ("WAIT SEC 2", "DELAY"),
        ("WAIT 2(sec)", "DELAY"),
        ("WAIT 2 sec", "DELAY"),
        ("WAIT FOR $IN[1]", "WAIT IN(1) = 1"),
        ("WaitTime 1;", "DELAY"),
        ("SLEEP 1", "DELAY"),
        ("$IN[1]", "IN(n)"),
        ("$OUT[1] = TRUE", "OUT(1) = 1"),
        ("$VEL.CP = 2", "SPEED"),
        ("DO[1]=ON", "OUT(1) = 1"),
        ("OUT[1] = 1", "( )"),
        ("SET DO1", "OUT(n)"),
        ("set_digital_out(1, True)", "OUT(1) = 1"),
        ("M_Out(1) = 1", "OUT(1) = 1"),
        ("IN(1) = 1", "IN"),
        ("UFRAME(1)", "FRAME"),
        ("UFRAME_NUM = 1", "FRAME"),
        ("BASE P1", "FRAME"),
        ("UTOOL_NUM[1]=2", "TOOL"),
        ("JMP LBL[1]", "GOTO"),
        ("LBL[1]", "*L1"),
        ("EXIT FOR", "GOTO"),
        ("BREAK", "GOTO"),
        ("REPEAT", "WHILE"),
        ("R[1]=5", "R1 = 5"),
        ("HALT", "STOP"),
        ("PROC main()", "SUB"),
        ("ENDPROC", "ENDSUB"),
        ("ENDFOR", "NEXT"),
        ("END FOR", "NEXT"),
        ("END WHILE", "WEND"),
        ("WHILE 1 DO\nDELAY 1\nWEND", "WHILE 1"),
        ("IF 1 MOVE P1", "THEN"),
        ("IF 1 THEN MOVE P1 ENDIF", "ENDIF"),
        ('PRINT "a", 1', ";"),
        ("GRIPPER ON", "HAND"),
        ("PAYLOAD 2", "LOAD"),
        ("OUT(1) = SQRT(4)", "SQR"),
        ("TPWrite 1", "PRINT"),
    ],
)
def test_one_error_names_the_word_of_this_language(text, remedy):
    ((_, _, hint),) = found(text)
    assert remedy in hint


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("WHILE 1\nEXIT WHILE\nDELAY 1\nWEND", 2),
        ("FOR i = 1 TO 3\nEXIT FOR\nNEXT", 2),
        ("FOR i = 1 TO 3\nWHILE 1\nNEXXT\nDELAY 1\nWEND\nNEXT", 3),
        ("Base P1\nMOVE P1", 1),
        ("MOVE P1\nCASSE 1", 2),
        ("IF 1 MOVE P1\nMOVE P1", 1),
        ("FOR i = 1, 3\nMOVE P1", 1),
        ("IF 1 THEN\nSUBB f(x)\nMOVE P1\nENDIF", 2),
        ("*L MOVE P1\nSUBB f(x)\nGOTO *L", 2),
        ("WHILE 1\nDELAY 1\nENDWHILE", 3),
        ("SELECT 1\nCASE ELSE\nMOVE P1\nCASEE 1\nENDSELECT", 4),
        ("ELSE IF 1 THEN\nMOVE P1", 1),
    ],
)
def test_a_guess_makes_no_second_error(text, line):
    assert [item[:2] for item in found(text) if item[0] not in ("RBL111", "RBL112")] == []
    assert [item[1] for item in found(text)] == [line]


def test_a_wait_for_a_number_waits_for_nothing():
    ((*place, hint),) = found("WAIT 2")
    assert place == ["RBL233", 1]
    assert "DELAY 2" in hint
    text = "WAIT -1\nWAIT 1E9, TIMEOUT 1\nWAIT 0, TIMEOUT 2"
    assert [item[:2] for item in found(text)] == [("RBL233", 1), ("RBL233", 2)]


@pytest.mark.parametrize("name", ["c", "l", "j", "do", "lin", "v", "run"])
def test_an_ordinary_name_is_no_word_of_another_language(name):
    foreign = other_languages.instruction(name)
    hints = [hint for text in (f"{name} = 5", f"{name} = 5 6", f"{name} = 5 lin") for _, _, hint in found(text)]
    assert len(hints) == 3
    assert foreign
    assert foreign not in hints


@pytest.mark.parametrize("name", ["c", "l", "lin", "v", "run"])
def test_an_element_of_an_ordinary_name_lacks_its_array(name):
    ((*place, hint),) = found(f"{name}(1) = 2")
    assert place == ["RBL215", 1]
    assert f"DIM {name}(n)" in hint


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("MOVE P1, SPEED 0", "SPEED mm/s 0 10000"),
        ("MOVE P1, TIME 0", "TIME 0 600"),
        ("MOVEJ P1, SPEED 250", "SPEED MOVEJ 0 100"),
        ("MOVE P1, SPEED NAN", "mm/s"),
        ("SPEEDJ 150", "SPEEDJ 0 100"),
        ("OVERRIDE 0", "OVERRIDE 0 100"),
        ("MOVE P1, ACCEL NAN", "ACCEL 0 100"),
    ],
)
def test_the_remedy_of_a_range_names_its_quantity(text, remedy):
    hints = [hint for code, _, hint in found(text) if code == "RBL404"]
    assert [set(remedy.split()) <= fields(hint) for hint in hints] == [True]


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("MOVE P1, SPEED 200 mm/s", "mm/s: 200"),
        ("MOVE P1, SPEED 0.2 m/s, ZONE 5", "mm/s: 200"),
        ("MOVEJ P1, SPEED 50 %", "%: 50"),
        ("SPEEDJ 50%", "%: 50"),
        ("DELAY 500 ms", "0.5"),
        ("DELAY 500ms", "0.5"),
        ("HAND ON, 1 min", "s: 60"),
        ("APPROACH P1, 5 cm", "mm: 50"),
        ("WAIT IN(1) = 1, TIMEOUT 5 s", "s: 5"),
        ("LOAD (0, 0, 60 mm), 1", "mm"),
        ("x = 5 mm", ""),
        ("d = 1,5", "1.5"),
        ("DELAY 0,5", "0.5"),
        ("MOVE P1, ZONE 1,5", "1.5"),
        ("LOAD (0, 0, 6), 0,8", "0.8"),
        ("STOP 1", "STOP"),
        ("RETURN x", "RETURN"),
        ("y = SIN(90", ")"),
        ("IF (1 = 2 THEN END", ")"),
        ("y = SIN(90))", ")"),
        ('*A1: PRINT "lab"', ""),
        ("*A1:", ""),
        ("WAIT DI[1]=ON", "IN(1)"),
        ("x = R[1]", "DIM"),
        ("MOVE P[3]", "MOVE P3"),
        ("movej([0,0,0,0,0,0], a=1.2)", "MOVEJ JOINT("),
        ("move([1, 2])", "MOVE POSE("),
        ("CALL foo", "SUB foo"),
        ("s$ = 'a'", '"a"'),
        ("PRINT 'hello'", 'PRINT "hello"'),
        ("IF 1 THEN PRINT 'hello' ", 'PRINT "hello"'),
    ],
)
def test_a_usual_slip_has_its_remedy(text, remedy):
    ((_, _, hint),) = found(text)
    assert remedy in hint


@pytest.mark.parametrize(
    "text", ["x = 5 6", "x =", "x = (", "x =, 5", "NEXT 5", "OUT(1, 1) = 1", "FOR i = 1,3", "PRINT 1,5"]
)
def test_every_unexpected_token_has_a_remedy_of_its_own(text):
    hints = [hint for code, _, hint in found(text) if code == "RBL111"]
    assert [bool(hint) and "decimal" not in hint for hint in hints] == [True]


@pytest.mark.parametrize("text", ["PRINT", "PRINT 'an empty line", "PRINT 1 'one'", "DELAY 1 'a second'", "'text'"])
def test_a_comment_is_no_text(text):
    assert [code for code, _, _ in found(text) if code == "RBL234"] == []
