import inspect
import sys

import pytest

from robolang.syntax import ast
from robolang.syntax.parser import MAX_DEPTH, MAX_OPERATORS, parse
from robolang.syntax.unparse import describe, print_code, print_expression
from tests.robolang.helpers import only, parsed, print_line, print_program, source

PAGE = """\
10 LOAD (0, 0, 60), 0.8
20 *START HAND OFF
30 MOVE P1 + (0, 0, 50), SPEED 100, WRIST HOLD TILT, ADVANCE, ZONE 5
x = 1 + 2 * 3^2^-1 - -4 MOD 3
a(3) = NOT x > 3 AND y <> "hi" OR IN(3) = 1
P10 = P1 * (0, 0, 10) + (1, 2, 3)
IF x > 3 THEN MOVE P2 ELSE GOTO 10
IF x THEN
ELSEIF y > 2 THEN
ELSE
ENDIF
FOR i = 1 TO 10 STEP 2
NEXT i
FOR i = 1 TO 10
NEXT
WAIT IN(1) = 1, TIMEOUT 5, GOTO *START
WAIT IN(1) = 1, TIMEOUT 5
WAIT IN(1)
SELECT x
CASE 1, 2
CASE ELSE
ENDSELECT
SUB foo(a, b)
ENDSUB
SUB bar
CALL foo(1, P1.X)
CALL bar
GOSUB *START
RETURN
ON ERROR GOTO *START
ON ERROR GOTO 10
ON ERROR STOP
RESUME
RESUME NEXT
PRINT "x = "; x; HERE.Z
PRINT
OUT(3) = 1
PULSE 3, 0.5
DELAY .5
SPEED 100
SPEEDJ 50
ACCEL 80
OVERRIDE 100
ZONE 10
TOOL grip
FRAME POSE(1, 2, 3, 0, 0, 0)
WRIST HOLD ROTATION
SEAM ON, torch
SEAM OFF
HAND ON, 0.2
MOVEC P1, P2, SPEED 10, ACCEL 5, TIME 2
SPLINE (P1, P2 + (0, 0, 5), a(2)), SPEED 10, ZONE 2
SPLINE (P1, P2)
APPROACH P1, 50, FINE
DEPART 100, WRIST KEEP
LOAD part
LOAD (0, 0, 1), 2, (1, 1, 1, 0, 0, 0)
DIM q(10)
CONST pi = 3.14
*L
z$ = STR$(x) + "a"
MOVEJ JOINT(0, 1, 2, 3, 4, 5), SPEED 50
WHILE MAX(x, 1) < 2
WEND
STOP
PAUSE
END ' all
' fmt
990 REM the end
1000
"""


def test_a_page_of_every_statement_is_printed_as_it_stands():
    assert print_program(parsed(PAGE)) == PAGE


def test_words_of_the_language_are_capitals_and_names_are_as_spelt():
    text = (
        '10 *Start movej pick_One+(0,0,1e3),Speed 5,fine \'Go\n20 if In(1)=1 then x$=str$(Left)+"aB" else Resume next'
    )
    printed = "10 *Start MOVEJ pick_One + (0, 0, 1e3), SPEED 5, FINE 'Go\n"
    printed += '20 IF IN(1) = 1 THEN x$ = STR$(Left) + "aB" ELSE RESUME NEXT\n'
    assert print_program(parsed(text)) == printed


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("SELECT CASE x", "SELECT x"),
        ("IF x", "IF x THEN"),
        ("PRINT x;", "PRINT x"),
        ("DELAY +3", "DELAY 3"),
        ("MOVE here.rx", "MOVE HERE.RX"),
        ("0010 GOTO 0010", "10 GOTO 10"),
    ],
)
def test_what_can_be_written_in_two_ways_is_printed_in_one(text, printed):
    (line,) = parsed(text).lines
    assert print_line(line) == printed
    assert parsed(printed).lines == (line,)


def bare(node):
    """An expression without the parentheses that are not needed."""
    return ast.replace(node, parentheses=0)


def value(text):
    (line,) = parsed(f"DELAY {text}").lines
    return line.statement.seconds


@pytest.mark.parametrize(
    "text",
    [
        "a - (b - c)",
        "a - b - c",
        "(a - b) - c",
        "a + (b + c)",
        "a - b * c",
        "(a - b) * c",
        "a / (b / c)",
        "(a * b) / c",
        "a * b MOD c",
        "a * (b MOD c)",
        "a MOD (b MOD c)",
        "-a MOD b",
        "-(a MOD b)",
        "-(a + b)",
        "-a^2",
        "(-a)^2",
        "--a",
        "a - -b",
        "a^-b",
        "a^--b",
        "a^b^c",
        "(a^b)^c",
        "a^(b^c)",
        "a^-(b^c)",
        "a^-b^c",
        "a^(b + c)",
        "a^(NOT b)",
        "NOT a = b",
        "(NOT a) = b",
        "NOT (a AND b)",
        "NOT a AND b",
        "NOT NOT a",
        "(NOT a) + 1",
        "-(NOT a)",
        "(a = b) = c",
        "a XOR b OR c",
        "a XOR (b OR c)",
        "a = (b = c)",
        "a OR b AND c",
        "(a OR b) AND c",
        "a OR (b OR c)",
        "a AND (b AND c)",
        "a < b + c",
        "(a < b) + c",
        "f(a - (b - c), (1, 2, a OR b))",
        "POSE(1, 2, 3, 4, 5, 6).X^2",
        "P1 * (0, 0, 10) + (1, 2, 3)",
    ],
)
def test_parentheses_stand_where_they_are_needed_and_where_they_are_written(text):
    assert print_expression(value(text)) == text
    assert print_expression(value(f"(({text}))")) == f"(({text}))"
    assert print_expression(bare(value(f"(({text}))"))) == text


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("(a * b) + c", "a * b + c"),
        ("(a)^(-(b))", "a^-b"),
        ("(a = b) AND (c = d)", "a = b AND c = d"),
        ("NOT (a = b)", "NOT a = b"),
        ("-(-(a))", "--a"),
        ("-(a^b)", "-a^b"),
        ("a XOR (b AND c)", "a XOR b AND c"),
        ("f((a), ((1, 2, 3)))", "f(a, (1, 2, 3))"),
    ],
)
def test_parentheses_that_change_nothing_are_kept_and_are_no_part_of_the_meaning(text, printed):
    assert print_expression(value(text)) == text
    assert print_expression(value(printed)) == printed
    assert value(printed) == value(text)
    assert hash(value(printed)) == hash(value(text))


@pytest.mark.parametrize(
    "text", ["SUB f()", "SUB f", "CALL f()", "CALL f", "CALL f((1))", 'PRINT "say ""yes"""', 'PRINT """"']
)
def test_what_is_printed_as_it_is_written(text):
    (line,) = parsed(text).lines
    assert print_line(line) == text


@pytest.mark.parametrize("sign", ["+", "*", "^", "MOD", "AND", "OR", "XOR"])
def test_a_long_chain(sign):
    spaced = sign if sign == "^" else f" {sign} "
    text = spaced.join(["1"] * (MAX_OPERATORS + 1))
    assert print_expression(value(text)) == text


def test_the_deepest_expression_is_printed_without_recursion():
    text = "1"
    for _ in range(MAX_DEPTH - 1):
        text = f"1 OR 1 AND NOT 1 = 1 + 1 * -1^({text})"  # eight levels of the tree in one parenthesis
    deep, limit = value(text), sys.getrecursionlimit()
    try:
        sys.setrecursionlimit(len(inspect.stack()) + 50)
        printed = print_expression(deep)
    finally:
        sys.setrecursionlimit(limit)
    assert printed == text


def test_as_many_parentheses_as_the_parser_takes():
    text = "1 - (" * MAX_DEPTH + "1 = 1" + ")" * MAX_DEPTH
    assert print_expression(value(text)) == text
    assert print_expression(value("f(" * MAX_DEPTH + "1" + ")" * MAX_DEPTH)).count("f(") == MAX_DEPTH


def test_a_line_that_does_not_parse_is_printed_as_it_stands():
    assert only("30 MOV  p1  'x").code == "RBL112"
    (line,) = parse(source("30 MOV  p1  'x")).program.lines
    assert print_line(line) == "30 MOV  p1  'x"
    assert describe(line.statement) == "MOV  p1  'x"


def test_parts_of_a_line():
    (line,) = parsed("10 *L hand on 'x").lines
    assert print_code(line) == "*L HAND ON"
    assert print_code(parsed("10").lines[0]) == ""
    assert print_line(ast.Line(number=10)) == "10"
