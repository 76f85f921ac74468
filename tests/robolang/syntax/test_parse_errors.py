"""What the parser says of lines that are none, and the bounds of a text."""

import pytest

from robolang.core.diagnostics import MAX_DIAGNOSTICS, Severity
from robolang.core.source import Span
from robolang.syntax.ast import (
    Move,
    Unparsed,
)
from robolang.syntax.parser import MAX_DEPTH, MAX_LINE, MAX_NUMBER_DIGITS, MAX_OPERATORS, parse
from tests.robolang.helpers import only, parse_found, parsed, source

WRIST_FORM = "WRIST KEEP, WRIST AUTO or WRIST HOLD component [, component]"


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
        ("MOVE", "expected a point after MOVE", "the form is MOVE"),
        ("MOVE P1 P2", "expected ',' or the end of the line after P1, not P2", "one instruction on each line"),
        ("MOVE P1 SPEED 3", "expected ',' or the end of the line after P1, not SPEED", "a comma before SPEED"),
        (
            "MOVE P1, SPED 3",
            "expected SPEED, ACCEL, TIME, ZONE, FINE or WRIST after ',', not SPED",
            "did you mean SPEED?",
        ),
        ("MOVE P1, FREE", "expected SPEED, ACCEL, TIME, ZONE, FINE or WRIST after ',', not FREE", "[, WRIST mode]"),
        (
            "MOVE P1, WRST KEEP",
            "expected SPEED, ACCEL, TIME, ZONE, FINE or WRIST after ',', not WRST",
            "did you mean WRIST?",
        ),
        ("MOVE P1 WRIST KEEP", "expected ',' or the end of the line after P1, not WRIST", "a comma before WRIST"),
        ("HAND ON WRIST KEEP", "expected ',' or the end of the line after ON, not WRIST", "one instruction on each"),
        ("MOVE TILT", "expected a point after MOVE, not TILT", "TILT is a word of the language and cannot be a"),
        ("wrist", "expected KEEP, AUTO or HOLD after WRIST", f"the form is {WRIST_FORM}"),
        ("WRIST FREE", "expected KEEP, AUTO or HOLD after WRIST, not FREE", f"the form is {WRIST_FORM}"),
        ("WRIST KEPT", "expected KEEP, AUTO or HOLD after WRIST, not KEPT", "did you mean KEEP?"),
        ("WRIST HOLD", "expected TILT, ADVANCE or ROTATION after HOLD", f"the form is {WRIST_FORM}"),
        ("WRIST HOLD SPEED", "expected TILT, ADVANCE or ROTATION after HOLD, not SPEED", f"the form is {WRIST_FORM}"),
        ("WRIST HOLD TILTED", "expected TILT, ADVANCE or ROTATION after HOLD, not TILTED", "did you mean TILT?"),
        ("WRIST HOLD TILT, FREE", "expected TILT, ADVANCE or ROTATION after ',', not FREE", f"form is {WRIST_FORM}"),
        ("WRIST HOLD TILT ADVANCE", "expected ',' or the end of the line after TILT, not ADVANCE", "before ADVANCE"),
        ("WRIST KEEP TILT", "expected the end of the line after KEEP, not TILT", f"the form is {WRIST_FORM}"),
        ("WRIST KEEP MOVE P1", "expected the end of the line after KEEP, not MOVE", "one instruction on each line"),
        ("MOVE P1, WRIST", "expected KEEP, AUTO or HOLD after WRIST", f"the form is {WRIST_FORM}"),
        ("MOVE P1, WRIST HOLD 5", "expected TILT, ADVANCE or ROTATION after HOLD, not 5", f"the form is {WRIST_FORM}"),
        (
            "MOVE P1, WRIST HOLD TILT, ADVNCE",
            "expected SPEED, ACCEL, TIME, ZONE, FINE, WRIST, TILT, ADVANCE or ROTATION after ',', not ADVNCE",
            "did you mean ADVANCE?",
        ),
        ("MOVE P1, WRIST HOLD TILT SPEED 5", "expected ',' or the end of the line after TILT, not SPEED", "a comma"),
        ("MOVE P1, WRIST KEEP TILT", "expected ',' or the end of the line after KEEP, not TILT", "the form is MOVE"),
        ("seam", "expected ON or OFF after SEAM", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM CLOSE", "expected ON or OFF after SEAM, not CLOSE", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM ON", "expected ',' after ON", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM ON,", "expected a sensor name after ','", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM ON, 5", "expected a sensor name after ',', not 5", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM ON, HERE", "expected a sensor name after ',', not HERE", "HERE is a word of the language and cannot be"),
        ("SEAM ON, TILT", "expected a sensor name after ',', not TILT", "TILT is a word of the language and cannot be"),
        ("WRITS KEEP", "unknown instruction 'WRITS'", "did you mean WRIST?"),
        ("WRISTKEEP", "unknown instruction 'WRISTKEEP'", "did you mean WRIST KEEP?"),
        ("SEAMOFF", "unknown instruction 'SEAMOFF'", "did you mean SEAM OFF?"),
        ("MOVE P1, SPEED", "expected a value after SPEED", "the form is MOVE"),
        ("MOVE LOAD", "expected a point after MOVE, not LOAD", "cannot be a name"),
        ("hand", "expected ON or OFF after HAND", "the form is HAND"),
        ("HAND OPEN", "expected ON or OFF after HAND, not OPEN", "HAND OFF opens the hand"),
        ("HAND ONN", "expected ON or OFF after HAND, not ONN", "did you mean ON?"),
        ("LOAD 1", "expected a name or '(' after LOAD, not 1", "the form is LOAD (x, y, z), mass"),
        ("LOAD(0, 0 SPEED", "expected ')' or ',' after 0, not SPEED", "a ) is missing before SPEED"),
        ("10.5 MOVE P1", "expected an instruction, not 10.5", "whole number"),
        ("MOV P1", "unknown instruction 'MOV'", "did you mean MOVE?"),
        ("HANDON", "unknown instruction 'HANDON'", "did you mean HAND ON?"),
        ("movep1", "unknown instruction 'movep1'", "leave a space: MOVE P1"),
        ("OPEN", "unknown instruction 'OPEN'", "HAND OFF opens the hand"),
        ("QQQQ", "unknown instruction 'QQQQ'", "such as MOVE, LOAD, HAND or IF, or with name = value"),
        ("X = ", "expected a value after '='", ""),
        ("X", "unknown instruction 'X'", "or with name = value"),
        ("abs = 5", "expected an instruction, not abs", "ABS is a word of the language and cannot be a name"),
        ("move = 5", "expected a point after MOVE, not '='", "MOVE is a word of the language and cannot be a name"),
        ("END IF", "expected the end of the line after END, not IF", "did you mean ENDIF?"),
        ("ELSE IF x", "expected the end of the line after ELSE, not IF", "did you mean ELSEIF?"),
        ("DEPART", "expected a value after DEPART", "the form is DEPART mm"),
        ("MOVEC P1 P2", "expected ',' after P1, not P2", "the form is MOVEC via, point"),
        ("WAIT x, 5", "expected TIMEOUT after ',', not 5", "the form is WAIT condition [, TIMEOUT s [, GOTO target]]"),
        ("GOTO L", "expected a line number or *LABEL after GOTO, not L", "a label is written with *: GOTO *L"),
        ("FOR i = 1", "expected TO after 1", "the form is FOR v = a TO b [STEP s]"),
        ("WHILE", "expected a value after WHILE", "the form is WHILE condition"),
        ('x = "abc', "expected a value after '=', not '\"'", 'a text ends with "'),
        (
            "IF 1 THEN IF 2 THEN MOVE P1",
            "expected an instruction or the end of the line after THEN, not IF",
            "on a line",
        ),
        ("IF 1 THEN MOVE P1 ELSE", "expected an instruction after ELSE", "the form is IF condition THEN statement"),
        ("HAND ON, 1_000", "'1_000' is not a number", "write 1000"),
        ("LOAD (0, 0, 60), 800g", "'800g' is not a number", "LOAD is in kg: 0.8"),
        ("10MOVE P1", "'10MOVE' is not a number", "leave a space"),
        ("МOVE P1", "suspicious character U+041C CYRILLIC CAPITAL LETTER EM", "looks like 'M'"),
        ("' \u202e", "suspicious character U+202E RIGHT-TO-LEFT OVERRIDE", "direction"),
    ],
)
def test_messages_speak_of_the_language(text, message, hint):
    diagnostic = only(text)
    assert diagnostic.message == message
    assert hint in diagnostic.hint


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
