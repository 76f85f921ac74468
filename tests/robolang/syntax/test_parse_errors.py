"""What the parser says of lines that are none, and the bounds of a text."""

import pytest

from robolang.core.diagnostics import MAX_DIAGNOSTICS, Severity
from robolang.core.source import Span
from robolang.syntax.ast import (
    MAX_NUMBER_DIGITS,
    Move,
    Unparsed,
)
from robolang.syntax.parser import MAX_DEPTH, MAX_LINE, MAX_OPERATORS, parse
from tests.messages import fields
from tests.robolang.helpers import only, parse_found, parsed, source

WRIST_FORM = "WRIST HOLD component [, component]"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("MOVE", ("RBL111", 1, 5, 0)),
        ("MOVE  ' go", ("RBL111", 1, 5, 0)),
        ("MOVE P1 P2", ("RBL111", 1, 9, 2)),
        ("MOVE )", ("RBL111", 1, 6, 1)),
        ("MOVE P1,", ("RBL111", 1, 9, 0)),
        ("MOVE P1, SPED 3", ("RBL111", 1, 10, 4)),
        ("MOVE P1, SPEED", ("RBL111", 1, 15, 0)),
        ("MOVE P1 SPEED 3", ("RBL111", 1, 9, 5)),
        ("MOVE LOAD", ("RBL111", 1, 6, 4)),
        ("HAND", ("RBL111", 1, 5, 0)),
        ("HAND ON 3", ("RBL111", 1, 9, 1)),
        ("LOAD 1", ("RBL111", 1, 6, 1)),
        ("LOAD (0), 1", ("RBL111", 1, 8, 1)),
        ("LOAD (0, 0, 60)", ("RBL111", 1, 16, 0)),
        ("LOAD (0, 0, 60), ", ("RBL111", 1, 17, 0)),
        ("WRIST", ("RBL111", 1, 6, 0)),
        ("WRIST ' x", ("RBL111", 1, 6, 0)),
        ("WRIST FREE", ("RBL111", 1, 7, 4)),
        ("WRIST TILT", ("RBL111", 1, 7, 4)),
        ("WRIST KEEP AUTO", ("RBL111", 1, 12, 4)),
        ("WRIST KEEP, TILT", ("RBL111", 1, 11, 1)),
        ("WRIST HOLD", ("RBL111", 1, 11, 0)),
        ("WRIST HOLD SPEED", ("RBL111", 1, 12, 5)),
        ("WRIST HOLD TILT,", ("RBL111", 1, 17, 0)),
        ("WRIST HOLD TILT, SPEED 5", ("RBL111", 1, 18, 5)),
        ("WRIST HOLD TILT ADVANCE", ("RBL111", 1, 17, 7)),
        ("MOVE P1, WRIST", ("RBL111", 1, 15, 0)),
        ("MOVE P1, WRIST FREE", ("RBL111", 1, 16, 4)),
        ("MOVE P1, WRIST HOLD", ("RBL111", 1, 20, 0)),
        ("MOVE P1, WRIST HOLD SPEED 5", ("RBL111", 1, 21, 5)),
        ("MOVE P1, WRIST HOLD TILT,", ("RBL111", 1, 26, 0)),
        ("MOVE P1, WRIST HOLD TILT, SPEED 5, ADVANCE", ("RBL111", 1, 36, 7)),
        ("MOVE P1, WRIST KEEP, TILT", ("RBL111", 1, 22, 4)),
        ("MOVE P1, TILT", ("RBL111", 1, 10, 4)),
        ("MOVE TILT", ("RBL111", 1, 6, 4)),
        ("MOVE Advance", ("RBL111", 1, 6, 7)),
        ("MOVE rotation", ("RBL111", 1, 6, 8)),
        ("HOLD TILT", ("RBL111", 1, 1, 4)),
        ("SEAM", ("RBL111", 1, 5, 0)),
        ("SEAM torch", ("RBL111", 1, 6, 5)),
        ("SEAM ON", ("RBL111", 1, 8, 0)),
        ("SEAM ON torch", ("RBL111", 1, 9, 5)),
        ("SEAM ON,", ("RBL111", 1, 9, 0)),
        ("SEAM ON, 5", ("RBL111", 1, 10, 1)),
        ("SEAM ON, SEAM", ("RBL111", 1, 10, 4)),
        ("SEAM ON, HERE", ("RBL111", 1, 10, 4)),
        ("SEAM OFF, torch", ("RBL111", 1, 9, 1)),
        ("WRISTKEEP", ("RBL112", 1, 1, 9)),
        ("10.5 MOVE P1", ("RBL111", 1, 1, 4)),
        ("OFF", ("RBL111", 1, 1, 3)),
        ("/", ("RBL111", 1, 1, 1)),
        ("30 MOV P1", ("RBL112", 1, 4, 3)),
        ("MOVEP1", ("RBL112", 1, 1, 6)),
        ("__import__", ("RBL112", 1, 1, 10)),
        ("MOVE P1, SPEED 1E999", ("RBL114", 1, 16, 5)),
        ("HAND ON, " + "9" * 5000, ("RBL114", 1, 10, 5000)),
        ("1234567890 MOVE P1", ("RBL114", 1, 1, 10)),
        ("9" * 5000 + " MOVE P1", ("RBL114", 1, 1, 5000)),
        ("HAND ON, 1_000", ("RBL115", 1, 10, 5)),
        ("HAND ON, 1.2.3", ("RBL115", 1, 10, 5)),
        ("HAND ON, 1E", ("RBL115", 1, 10, 2)),
        ("HAND ON, 0x1F", ("RBL115", 1, 10, 4)),
        ("LOAD (0, 0, 60), 800g", ("RBL115", 1, 18, 4)),
        ("10MOVE P1", ("RBL115", 1, 1, 6)),
        ("МOVE P1", ("RBL103", 1, 1, 1)),
        ("MOVЕ P1", ("RBL103", 1, 4, 1)),
        ("MOVE Р1", ("RBL103", 1, 6, 1)),
        ("MOVE\u00a0P1", ("RBL103", 1, 5, 1)),
        ("MOVE P1 ’ x", ("RBL103", 1, 9, 1)),
        ("HAND ON, １", ("RBL103", 1, 10, 1)),
        ("HAND ON, 1é", ("RBL103", 1, 11, 1)),
        ("MOVE P1 ' a\u202eb", ("RBL103", 1, 12, 1)),
        ("' \x1b[2J", ("RBL103", 1, 3, 1)),
        ("\x0c", ("RBL103", 1, 1, 1)),
    ],
)
def test_bad_lines(text, found):
    assert parse_found(text) == [found]
    (line,) = parse(source(text)).program.lines
    assert isinstance(line.statement, Unparsed)


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("MOVE", "MOVE", "MOVE"),
        ("MOVE P1 P2", ", P1 P2", ""),
        ("MOVE P1 SPEED 3", ", P1 SPEED", "SPEED"),
        (
            "MOVE P1, SPED 3",
            "SPEED , ACCEL TIME ZONE FINE WRIST SPED",
            "SPEED",
        ),
        ("MOVE P1, FREE", "SPEED , ACCEL TIME ZONE FINE WRIST FREE", "[, WRIST "),
        (
            "MOVE P1, WRST KEEP",
            "SPEED , ACCEL TIME ZONE FINE WRIST WRST",
            "WRIST",
        ),
        ("MOVE P1 WRIST KEEP", ", P1 WRIST", "WRIST"),
        ("HAND ON WRIST KEEP", ", ON WRIST", ""),
        ("MOVE TILT", "MOVE TILT", "TILT"),
        ("wrist", "KEEP AUTO HOLD WRIST", WRIST_FORM),
        ("WRIST FREE", "KEEP AUTO HOLD WRIST FREE", WRIST_FORM),
        ("WRIST KEPT", "KEEP AUTO HOLD WRIST KEPT", "KEEP"),
        ("WRIST HOLD", "TILT ADVANCE ROTATION HOLD", WRIST_FORM),
        ("WRIST HOLD SPEED", "TILT ADVANCE ROTATION HOLD SPEED", WRIST_FORM),
        ("WRIST HOLD TILTED", "TILT ADVANCE ROTATION HOLD TILTED", "TILT"),
        ("WRIST HOLD TILT, FREE", "TILT , ADVANCE ROTATION FREE", WRIST_FORM),
        ("WRIST HOLD TILT ADVANCE", ", TILT ADVANCE", "ADVANCE"),
        ("WRIST KEEP TILT", "KEEP TILT", WRIST_FORM),
        ("WRIST KEEP MOVE P1", "KEEP MOVE", ""),
        ("MOVE P1, WRIST", "KEEP AUTO HOLD WRIST", WRIST_FORM),
        ("MOVE P1, WRIST HOLD 5", "TILT ADVANCE ROTATION HOLD 5", WRIST_FORM),
        (
            "MOVE P1, WRIST HOLD TILT, ADVNCE",
            "SPEED , ACCEL TIME ZONE FINE WRIST TILT ADVANCE ROTATION ADVNCE",
            "ADVANCE",
        ),
        ("MOVE P1, WRIST HOLD TILT SPEED 5", ", TILT SPEED", ""),
        ("MOVE P1, WRIST KEEP TILT", ", KEEP TILT", "MOVE"),
        ("seam", "ON OFF SEAM", "SEAM ON, sensor"),
        ("SEAM CLOSE", "ON OFF SEAM CLOSE", "SEAM ON, sensor"),
        ("SEAM ON", ", ON", "SEAM ON, sensor"),
        ("SEAM ON,", ",", "SEAM ON, sensor"),
        ("SEAM ON, 5", ", 5", "SEAM ON, sensor"),
        ("SEAM ON, HERE", ", HERE", "HERE"),
        ("SEAM ON, TILT", ", TILT", "TILT"),
        ("WRITS KEEP", "WRITS", "WRIST"),
        ("WRISTKEEP", "WRISTKEEP", "WRIST KEEP"),
        ("SEAMOFF", "SEAMOFF", "SEAM OFF"),
        ("MOVE P1, SPEED", "SPEED", "MOVE"),
        ("MOVE LOAD", "MOVE LOAD", ""),
        ("hand", "ON OFF HAND", "HAND"),
        ("HAND OPEN", "ON OFF HAND OPEN", "HAND OFF"),
        ("HAND ONN", "ON OFF HAND ONN", "ON"),
        ("LOAD 1", "( LOAD 1", "LOAD (x, y, z), mass"),
        ("LOAD(0, 0 SPEED", ") , 0 SPEED", "SPEED"),
        ("10.5 MOVE P1", "10.5", ""),
        ("MOV P1", "MOV", "MOVE"),
        ("HANDON", "HANDON", "HAND ON"),
        ("movep1", "movep1", "MOVE P1"),
        ("OPEN", "OPEN", "HAND OFF"),
        ("QQQQ", "QQQQ", "MOVE, LOAD, HAND"),
        ("X = ", "=", ""),
        ("X", "X", "name = value"),
        ("abs = 5", "", "ABS"),
        ("move = 5", "MOVE =", "MOVE"),
        ("END IF", "END IF", "ENDIF"),
        ("ELSE IF x", "ELSE IF", "ELSEIF"),
        ("DEPART", "DEPART", "DEPART mm"),
        ("MOVEC P1 P2", ", P1 P2", "MOVEC point, point"),
        ("SPLINE P1, P2", "( SPLINE P1", "SPLINE (P1, P2, P3), SPEED"),
        ("SPLINE", "( SPLINE", "SPLINE (P1, P2, P3), SPEED"),
        ("SPLINE (P1, P2, SPEED 5)", ", SPEED", "SPLINE (P1, P2), SPEED"),
        ("SPLINE (P1, P2", ") , P2", "write )"),
        ("SPLINE (P1, P2) ZONE 5", ", ) ZONE", "comma before ZONE"),
        ("SPLIN (P1, P2), SPEED 5", "SPLIN", "SPLINE"),
        ("SPLINE = 5", "( SPLINE =", "SPLINE"),
        ("WAIT x, 5", "TIMEOUT , 5", "WAIT condition [, TIMEOUT s [, GOTO "),
        ("GOTO L", "*LABEL L GOTO", "GOTO *L"),
        ("WAIT 1, TIMEOUT 5 GOTO *L", ", 5 GOTO", "comma before GOTO"),
        ("WAIT IN(1) TIMEOUT 5", ", TIMEOUT", "comma before TIMEOUT"),
        ("WAIT IN(1) GOTO *L", ", GOTO", "WAIT condition [, TIMEOUT s [, GOTO line or *LABEL]]"),
        ("FOR i = 1", "TO 1", "FOR v = a TO b [STEP s]"),
        ("WHILE", "WHILE", "WHILE condition"),
        ('x = "abc', '= "', '"'),
        (
            "IF 1 THEN IF 2 THEN MOVE P1",
            "THEN IF",
            "",
        ),
        ("IF 1 THEN MOVE P1 ELSE", "ELSE", "IF condition THEN statement"),
        ("HAND ON, 1_000", "1_000", "1000"),
        ("LOAD (0, 0, 60), 800g", "800g", "0.8"),
        ("10MOVE P1", "10MOVE", ""),
        ("МOVE P1", "U+041C CYRILLIC CAPITAL LETTER EM", "'M'"),
        ("' \u202e", "U+202E RIGHT-TO-LEFT OVERRIDE", "direction"),
    ],
)
def test_messages_speak_of_the_language(text, message, hint):
    diagnostic = only(text)
    assert set(message.split()) <= fields(diagnostic.message)
    assert hint in diagnostic.hint
    assert diagnostic.hint


def test_a_long_word_is_cut_in_the_message():
    assert len(only("M" * 9000).message) < 100


def test_comments_may_hold_any_script():
    parsed("MOVE P1 ' 点へ移動 é Привет 👩‍🏭\nREM ’ × −")


def test_several_errors_in_one_pass():
    text = "10 MOV P1\n20 MOVE P1\n30 MOVE\n40 HAND ON\n50 LOAD (1), 3\n"
    assert parse_found(text) == [("RBL112", 1, 4, 3), ("RBL111", 3, 8, 0), ("RBL111", 5, 11, 1)]
    program = parse(source(text)).program
    assert [line.number for line in program.lines] == [10, 20, 30, 40, 50]
    assert isinstance(program.lines[1].statement, Move)
    assert program.lines[0].statement == Unparsed(text="MOV P1")


def test_mixed_line_ends_are_an_information_at_the_first_other_one():
    result = parse(source("MOVE P1\nMOVE P2\r\nMOVE P3\r"))
    (item,) = result.diagnostics
    assert (item.code, item.severity, item.span) == ("RBL110", Severity.INFO, Span(15, 15))
    assert len(result.program.statements) == 3


def nested(depth):
    return "LOAD " + "(" * depth


def test_nesting_is_bounded_before_parsing():
    assert parse_found(nested(MAX_DEPTH))[0][0] == "RBL111"
    assert parse_found(nested(MAX_DEPTH + 1)) == [("RBL108", 1, 6 + MAX_DEPTH, 1)]
    assert parse_found(nested(100_000)) == [("RBL108", 1, 6 + MAX_DEPTH, 1)]


def test_signs_are_nesting():
    parsed("HAND ON, " + "-" * MAX_DEPTH + "1")
    assert parse_found("HAND ON, " + "- " * 100_000 + "1") == [("RBL108", 1, 10 + 2 * MAX_DEPTH, 1)]


def test_nesting_in_a_comment_does_not_count():
    parsed("MOVE P1 ' " + "(-" * 1000 + "\nREM " + "-" * 5000)


def test_long_expression():
    text = "HAND ON, " + "1+" * 100_000 + "1"
    assert [item[:3] for item in parse_found(text)] == [("RBL109", 1, 1)]


def test_line_length_limit_is_exact():
    parsed("'" * MAX_LINE)
    assert parse_found("'" * (MAX_LINE + 1)) == [("RBL105", 1, MAX_LINE + 1, 1)]
    assert parse_found("'" * (MAX_LINE + 3)) == [("RBL105", 1, MAX_LINE + 1, 3)]


def test_operators_limit_is_exact():
    parsed("HAND ON, " + "1+" * MAX_OPERATORS + "1")
    assert parse_found("HAND ON, " + "1+" * (MAX_OPERATORS + 1) + "1")[0][0] == "RBL109"


def test_line_number_limit_is_exact():
    parsed(f"{10**MAX_NUMBER_DIGITS - 1} END")
    assert parse_found(f"{10**MAX_NUMBER_DIGITS} END")[0][0] == "RBL114"


def test_source_size_limit_is_exact():
    largest = f"'{'x' * 9998}\n" * 100
    assert len(largest) == 1_000_000
    parsed(largest)
    assert parse_found(largest + "\n") == [("RBL106", 1, 1, 0)]


def test_the_list_of_problems_is_bounded():
    result = parse(source("MOV\n" * 5000))
    assert len(result.diagnostics) == MAX_DIAGNOSTICS + 1
    assert result.diagnostics[-1].code == "RBL107"


@pytest.mark.parametrize(
    "text",
    [
        "*",
        "*5",
        "*MOVE",
        "*A *B",
        "IF x THEN IF y THEN END",
        "IF x THEN FOR i = 1 TO 2",
        "IF x THEN END ELSE",
        "x = 1 = 2 = 3",
        "x == 1",
        "x = 1 +",
        "x = (1",
        "x = ()",
        "x = ABS",
        "x = ABS()",
        "x = P1.",
        "x = P1.5",
        "x =",
        'x = "a',
        "1 = x",
        "HERE = 5",
        "FOR abs = 1 TO 2",
        "GOTO x",
        "GOTO",
        "CALL s(",
        "CALL s(1,)",
        "SUB s(1)",
        "SUB s(a,)",
        "WAIT x, GOTO 5",
        "WAIT x, TIMEOUT",
        "CASE",
        "CASE 1,",
        "PRINT 1, 2",
        "PRINT ;",
        "PRINT 1 2",
        "OUT 1 = 2",
        "OUT(1)",
        "DIM a",
        "DIM a(1, 2)",
        "CONST k",
        "RESUME 5",
        "ON ERROR",
        "ON x GOTO 5",
        "FINE",
        "END IF",
        "MOVE P1, ZONE",
        "MOVEC P1",
        "APPROACH P1",
        "DEPART",
        "TIME 5",
        "HOLD TILT",
        "NEXT 5",
        "x = NOT",
        "x = 1 MOD",
        "x = 2 ^",
        "x = (1, )",
        "x = a.b.c",
    ],
)
def test_what_is_no_statement(text):
    ((code, line, column, length),) = parse_found(text)
    assert (code, line) == ("RBL111", 1)
    assert 1 <= column <= len(text) + 1
    assert column + length <= len(text) + 1
    assert only(text).hint
