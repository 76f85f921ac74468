"""Bad texts and what each gets: the rows A1 to A62 of the promises, and R11, R13, R16, R20 (docs of the project)."""

import ast
import random
import re
from pathlib import Path

import pytest

from robolang.analysis.checker import check
from robolang.core.source import Source, decode_program
from robolang.evaluation import evaluator
from robolang.interpreter import effects, machine
from robolang.interpreter.program_fault import ProgramFault
from robolang.syntax.keywords import FUNCTIONS, VALUES
from robolang.syntax.parser import parse
from runtime.core.faults import Fault
from tests.campaign import size
from tests.robolang.helpers import cell_with, places
from tests.robolang.running import execute
from tests.steps import assert_linear

POINTS = ("P1", "P2")


def problems(text, points=POINTS):
    """Code, line, column and length of all that reading and checking find."""
    where = Source("pick.rbl", text)
    parsed = parse(where)
    found = check(parsed.program, cell_with(points=points, rated_payload_kg=2.5))
    return sorted(places(text, (*parsed.diagnostics, *found)), key=lambda item: item[1:])


GOLDEN = [
    ("A1", "", [("RBL201", 1, 1, 0)]),
    ("A2", "' a\nREM b\n", [("RBL201", 1, 1, 0)]),
    ("A6", "MOVE P1\rMOVE P9\r", [("RBL301", 2, 6, 2)]),
    ("A7", "MOVE P1\r\nMOVE P1\nMOVE P9", [("RBL110", 2, 8, 0), ("RBL301", 3, 6, 2)]),
    ("A8", "MOVE P1 ' \u202e", [("RBL103", 1, 11, 1)]),
    ("A9", "МОVE P1", [("RBL103", 1, 1, 1)]),
    ("A12", "' " + "x" * 10_000_000, [("RBL106", 1, 1, 0), ("RBL201", 1, 1, 0)]),
    ("A12 short", "x = " + "1" * 20_000, [("RBL105", 1, 10_001, 10_004)]),
    ("A16", "x = " + "(" * 100_000, [("RBL108", 1, 105, 1)]),
    ("A17", "x = " + "-" * 100_000 + "1", [("RBL108", 1, 105, 1)]),
    ("A17 NOT", "x = " + "NOT " * 100_000 + "1", [("RBL108", 1, 405, 1)]),
    ("A18 lines", "IF 1 THEN\n" * 10_000, [("RBL108", 101, 1, 9)]),
    ("A18", "IF 1 THEN " * 900 + "END", [("RBL111", 1, 11, 2)]),
    ("A18 long", "IF 1 THEN " * 10_000 + "END", [("RBL105", 1, 10_001, 90_003)]),
    ("A19", "x = " + "1+" * 100_000 + "1", [("RBL109", 1, 1, 200_005)]),
    ("A19 short", "PRINT " + "1+" * 1000 + "1", []),
    ("A20", "MOVE", [("RBL111", 1, 5, 0)]),
    ("A21", "MOVE P1 P2", [("RBL111", 1, 9, 2)]),
    ("A22", "MOV P1", [("RBL112", 1, 1, 3)]),
    ("A24", "x = 3E99999", [("RBL114", 1, 5, 7)]),
    ("A25", "x = " + "7" * 5000, [("RBL114", 1, 5, 5000)]),
    ("A26", "x = 1_000", [("RBL115", 1, 5, 5)]),
    ("A30", "IF 1 THEN GOTO *A\nGOTO 70", [("RBL202", 1, 16, 2), ("RBL202", 2, 6, 2)]),
    ("A31", "*A\n*A DELAY 1", [("RBL203", 2, 1, 2)]),
    ("A32", "GOTO 20\nFOR i = 1 TO 2\n20 NEXT\n30 FOR j = 1 TO 2\n40 DELAY 1\n50 NEXT\nGOTO 40", [("RBL204", 7, 6, 2)]),
    ("A33", "FOR i = 1 TO 2 STEP 0\nNEXT", [("RBL205", 1, 21, 1)]),
    ("A34", "FOR i = 1 TO 2 STEP 0.1\nNEXT", [("RBL206", 1, 21, 3)]),
    ("A37", "x = 1 / 0", [("RBL209", 1, 5, 5)]),
    ("A39", "x = SQR(-1)", [("RBL209", 1, 5, 7)]),
    ("A39 other", "x = SQRT(-1)", [("RBL215", 1, 5, 4)]),
    ("A40", "x = 1E308 * 10", [("RBL209", 1, 5, 10)]),
    ("A43", "LOAD (0, 0, 0), -1", [("RBL401", 1, 17, 2)]),
    ("A44", "LOAD (0, 0, 0), NAN\nLOAD (0, 0, 0), NAN * 2", [("RBL401", 1, 17, 3), ("RBL209", 2, 17, 7)]),
    ("A45", "LOAD (0, 0, 0), 5", [("RBL402", 1, 17, 1)]),
    ("A46", "LOAD (0, 0, 2001), 1", [("RBL403", 1, 6, 12)]),
    ("A46 inertia", "LOAD (0, 0, 10), 1, (1, 1, 1, 0, 0)", [("RBL220", 1, 21, 15)]),
    ("A47", "MOVE P1, SPEED 0\nMOVE P1, SPEED -5", [("RBL404", 1, 16, 1), ("RBL404", 2, 16, 2)]),
    ("A48", "DELAY -1\nDELAY 1E12\nHAND ON, -1", [("RBL405", 1, 7, 2), ("RBL405", 2, 7, 4), ("RBL405", 3, 10, 2)]),
    ("A46 no body", "LOAD (0, 0, 10), 1, (0.1, 0.1, 0.3, 0, 0, 0)", [("RBL403", 1, 21, 24)]),
    ("A54", "MOVE P1, ZONE 5", [("RBL413", 1, 10, 6)]),
    ("A56", "MOVE P1, ZONE -5", [("RBL415", 1, 15, 2)]),
    ("A61", 'PRINT "{0.__class__}"', []),
    ("A62", "__import__ = 5\nPRINT __import__", []),
    ("A62 alone", "__import__", [("RBL112", 1, 1, 10)]),
    ("A62 called", 'x = __import__("os")', [("RBL215", 1, 5, 10)]),
]


@pytest.mark.parametrize(("text", "expected"), [row[1:] for row in GOLDEN], ids=[row[0] for row in GOLDEN])
def test_golden(text, expected):
    found = problems(text)
    assert found == expected


def test_a_byte_order_mark_and_bytes_that_are_no_text():
    assert problems(decode_program("p", b"\xef\xbb\xbfMOVE P9").text) == [("RBL301", 1, 6, 2)]
    for raw, code in ((b"\xff", "RBL104"), (b"MOVE\0", "RBL104"), (b" " * 1_000_001, "RBL106")):
        with pytest.raises(Fault, match=code):
            decode_program("p", raw)


@pytest.mark.parametrize(
    ("text", "code", "number"),
    [
        ("10 x = 0\n20 PRINT 1 / x", "RBL501", 20),
        ("10 x = -1\n20 PRINT SQR(x)", "RBL502", 20),
        ("10 x = 1E308\n20 PRINT x * 10", "RBL502", 20),
        ("10 WHILE 1\n20 WEND", "RBL508", 10),
        ("10 GOTO 20\n20 GOTO 10", "RBL508", 10),
    ],
    ids=["A38", "A39", "A40", "A57", "A58"],
)
def test_golden_of_a_run(text, code, number):
    assert problems(text) == []
    with pytest.raises(ProgramFault) as caught:
        list(execute(parse(Source("p", text)).program))
    assert (caught.value.code, caught.value.origin.number) == (code, number)


def printed(text):
    """What a program prints."""
    return [effect.text for effect in execute(parse(Source("p", text)).program) if isinstance(effect, effects.Show)]


def test_the_rounds_of_a_loop_are_counted_when_it_begins():
    """A34: ten tenths added up are less than 1, so a loop that adds them would go round once more or less."""
    assert printed("n = 0\nFOR i = 0 TO 1 STEP 0.1\nn = n + 1\nNEXT\nPRINT n") == ["11"]


def test_what_is_printed_is_no_template():
    """A61."""
    assert printed('PRINT "{0.__class__}%s$(id)"') == ["{0.__class__}%s$(id)"]


# --- R11: nesting ----------------------------------------------------------------------------------------------------


LINES = ["IF 1 THEN\n", "WHILE 1\n", "SUB a\n", "SELECT 1\nCASE 1\n", "ELSE\n", "*L\n", "GOTO {n}\n", "x{n} = y{n}\n"]
IN_A_LINE = [
    ("", "("),
    ("x = ", "("),
    ("", "-"),
    ("x = ", "NOT "),
    ("", "IF 1 THEN "),
    ("x = ", "ABS("),
    ("x = ", "a("),
    ("MOVE P1", " * (0, 0, 1"),
    ("x = ", "2 ^ "),
    ("x = 1", " = 1"),
    ("", "x"),
]


def repeated(line, count):
    return "".join(line.format(n=n) for n in range(count))


@pytest.mark.parametrize("line", LINES)
def test_many_lines_without_their_partner_are_bounded(line):
    """As deep as no stack of calls is; the work grows with the lines. ``make large`` has 1 MB of each."""
    assert problems(repeated(line, 2000))
    assert_linear(problems, repeated(line, 250), repeated(line, 500))


@pytest.mark.parametrize(("start", "more"), IN_A_LINE)
def test_the_longest_lines_are_bounded(start, more):
    assert problems(start + more * 90_000)
    assert_linear(problems, start + more * 10_000, start + more * 20_000)


NINE_LEVELS = "0 OR 1 AND NOT 1 = 1 + 1 * -1^("


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("DELAY " + NINE_LEVELS * 99 + "1" + ")" * 99, ["RBL108"]),
        ("IF " + "(" * 90 + "1" + "^1 * 1 + 1 = 1 AND 1 OR 1)" * 90 + " THEN END", ["RBL108"]),
        ("WAIT 1\nWAIT " + NINE_LEVELS * 99 + "1" + ")" * 99, ["RBL233", "RBL108"]),
        ("PRINT " + NINE_LEVELS * 15 + "1" + ")" * 15, []),
        ("PRINT " + "(1 + " * 99 + "1" + ")" * 99, []),
        ("PRINT " + "ABS(" * 99 + "1" + ")" * 99, []),
    ],
    ids=["nine levels", "in front", "a WAIT", "few of nine", "sums", "calls"],
)
def test_what_is_too_deep_to_be_evaluated_is_refused_and_the_rest_runs(text, codes):
    assert [item[0] for item in problems(text)] == codes
    if not codes:
        assert len(printed(text)) == 1


@pytest.mark.parametrize("text", ["(", "-", "+", "NOT ", "ABS(", "- (", "(-"])
def test_one_line_of_any_depth_is_refused_where_it_is_too_deep(text):
    for count in (10_000, 100_000):
        assert [item[0] for item in problems("x = " + text * count)] == ["RBL108"]
    assert_linear(problems, "x = " + text * 10_000, "x = " + text * 20_000)


# --- R13: one typo ---------------------------------------------------------------------------------------------------

GOOD = """10 CONST height = 50
20 DIM part(4)
30 count = 0
40 speed1 = 200
50 LOAD (0, 0, 60), 0.8
60 HAND OFF
70 SPEED speed1
80 ACCEL 50
90 ON ERROR GOTO *FAIL
100 FOR i = 1 TO 4 STEP 1
110 APPROACH P1, height, SPEED 100
120 MOVE P1, SPEED 50, FINE
130 HAND ON, 0.5
140 IF count > 3 THEN GOTO *DONE
150 LOAD (0, 0, 95), 2.3
160 DEPART height
170 MOVE P2 + (0, 0, height), SPEED 90
180 part(i) = P2.Z + count * 2
190 SELECT i
200 CASE 1, 2
210 MOVE P2, WRIST HOLD TILT
220 CASE ELSE
230 MOVEJ P2, SPEED 30
240 ENDSELECT
250 HAND OFF
260 LOAD (0, 0, 60), 0.8
270 count = count + 1
280 NEXT i
290 WHILE count > 0
300 CALL blink(count, 0.2)
310 count = count - 1
320 WEND
330 *DONE PRINT "done"; part(0); STR$(speed1)
340 END
350 *FAIL PRINT ERR
360 RESUME NEXT
370 SUB blink(n, t)
380 PULSE n, t
390 DELAY t
400 ENDSUB"""
PLANTED = "\n410 MOVE P77"


def typo(line, chance):
    """A line with one character left out, doubled, exchanged or changed, not in the line number."""
    at = chance.randrange(len(line.split()[0]) + 1, len(line))
    how = chance.randrange(4)
    if how == 0:
        return line[:at] + line[at + 1 :]
    if how == 1:
        return line[:at] + line[at] + line[at:]
    if how == 2:
        return line[:at] + line[at : at + 2][::-1] + line[at + 2 :]
    return line[:at] + chance.choice("abcxyz019 ,(+") + line[at + 1 :]


def test_the_good_program_is_good():
    assert problems(GOOD) == []
    assert len(GOOD.splitlines()) == 40


def test_one_typo_costs_few_diagnostics_and_hides_nothing_behind_it():
    chance = random.Random(1992)
    extra = []
    lines = GOOD.splitlines()
    for index in range(len(lines)):
        typos = [typo(lines[index], chance) for _ in range(20)]
        for wrong in typos[: size(20, 5)]:
            changed = "\n".join([*lines[:index], wrong, *lines[index + 1 :]]) + PLANTED
            found = problems(changed)
            assert ("RBL301", 41, 10, 3) in found, changed
            errors = [item for item in found if item[0] != "RBL116"]
            assert len(errors) - 1 <= 3, (lines[index], changed.splitlines()[index], errors)
            extra.append(len(errors) - 1)
    assert sorted(extra)[len(extra) // 2] <= 1
    assert sum(count > 0 for count in extra) > len(extra) / 2  # the typos are real ones


BLOCK_LINES = [
    index
    for index, line in enumerate(GOOD.splitlines())
    if re.match(r"\d+ (SUB|ENDSUB|NEXT|WHILE|WEND|ENDSELECT)", line)
]


def word_typos(line):
    """A line with each way to leave out, exchange or change one character of its first word."""
    number, word = line.split()[:2]
    start, end = len(number) + 1, len(number) + 1 + len(word)
    for at in range(start, end):
        yield line[:at] + line[at + 1 :]
        yield line[:at] + line[at : at + 2][::-1] + line[at + 2 :]
        yield from (line[:at] + sign + line[at + 1 :] for sign in " (=1")


@pytest.mark.parametrize("index", BLOCK_LINES, ids=lambda index: GOOD.splitlines()[index].split()[1])
def test_a_typo_in_the_word_of_a_block_costs_few_diagnostics(index):
    """The body of a SUB whose head is damaged is no error: neither its parameters, nor its ENDSUB, nor its CALL."""
    lines, extra = GOOD.splitlines(), []
    for wrong in set(word_typos(lines[index])) - {lines[index]}:
        found = problems("\n".join([*lines[:index], wrong, *lines[index + 1 :]]) + PLANTED)
        assert ("RBL301", 41, 10, 3) in found, wrong
        errors = [item for item in found if item[0] != "RBL116"]
        assert 1 <= len(errors) - 1 <= 3, (wrong, errors)
        extra.append(len(errors) - 1)
    assert sorted(extra)[len(extra) // 2] == 1


def test_the_head_of_a_sub_is_the_only_error_where_it_is_damaged():
    body = "CALL blink(1, 0.2)\nEND\n{}\nPULSE n, t\nDELAY t\nENDSUB\n"
    for head in ("S(B blink(n, t)", "(UB blink(n, t)", "S B blink(n, t)", "SUBblink(n, t)", "SUB blink(n t)"):
        assert [item[1] for item in problems(body.format(head))] == [3], head
    assert [item[0] for item in problems(body.format("SU= blink(n, t)"))] == ["RBL214", "RBL212"]


def test_what_lacks_a_head_or_an_end_is_found_beside_errors_of_other_kinds():
    for text in ("MOV P1\nENDSUB", "DELAY\nNEXT", "FOR i = 1 TO 2\nMOV P1", "IF 1 THEN\nS(B a(n)\nENDIF\nWEND"):
        assert {item[0] for item in problems(text)} & {"RBL211", "RBL212"}, text


def test_a_line_that_does_not_parse_hides_nothing_of_the_others():
    text = "MOV P1\nMOVE P77\nx = y + 1\nGOTO 50\nDELAY -1\nWAIT IN(1) = 1\nIF 0.1 * 3 = 0.3 THEN END\nNEXT\nCALL f"
    assert [item[:3] for item in problems(text)] == [
        ("RBL112", 1, 1),
        ("RBL301", 2, 6),
        ("RBL215", 3, 5),
        ("RBL202", 4, 6),
        ("RBL405", 5, 7),
        ("RBL223", 6, 1),
        ("RBL232", 7, 4),
        ("RBL212", 8, 1),
        ("RBL213", 9, 6),
    ]


# --- R20: what a program can do --------------------------------------------------------------------------------------


def test_the_effects_and_functions_of_a_program_are_these():
    # of the module alone: a test of the targets declares a kind of its own
    kinds = {kind.__name__ for kind in effects.OfStatement.__subclasses__() if kind.__module__ == effects.__name__}
    assert kinds == {
        "SetPayload",
        "MoveTo",
        "SetHand",
        "SetWrist",
        "SetSeam",
        "SetTool",
        "SetOutput",
        "Pass",
        "Show",
        "Drain",
        "Halt",
    }
    numbers, others = "ABS SGN INT ROUND SQR SIN COS TAN ATN2 MIN MAX DEG RAD", "STR$ VAL LEN IN DIST POSE JOINT"
    assert set(f"{numbers} {others}".split()) == FUNCTIONS
    assert set(VALUES) == {"HERE", "TIMER", "ERR"}


FORBIDDEN = {
    "open",
    "eval",
    "exec",
    "compile",
    "__import__",
    "os",
    "io",
    "sys",
    "subprocess",
    "socket",
    "pathlib",
    "importlib",
    "shutil",
    "pickle",
    "ctypes",
    "input",
    "breakpoint",
    "globals",
    "Path",
}


RUNS_A_PROGRAM = [Path(evaluator.__file__), *sorted(Path(machine.__file__).parent.glob("*.py"))]


@pytest.mark.parametrize("path", RUNS_A_PROGRAM, ids=lambda path: path.stem)
def test_what_runs_a_program_cannot_reach_files_processes_or_python(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    called = {node.func.id for node in ast.walk(tree) if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
    imported = {
        alias.name.partition(".")[0]
        for node in ast.walk(tree)
        if isinstance(node, ast.Import | ast.ImportFrom)
        for alias in node.names
    }
    imported |= {(node.module or "").partition(".")[0] for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert not (called | imported) & FORBIDDEN


def test_a_name_of_the_evaluator_is_no_function_of_the_language():
    for name in ("_do_in", "do_in", "chain", "call_", "__class__", "name"):
        assert problems(f"x = {name}(1)")[0][0] == "RBL215"
        with pytest.raises(ProgramFault, match="RBL"):
            list(execute(parse(Source("p", f"x = {name}(1)")).program))


def test_a_quote_inside_a_text_hides_nothing_from_the_limits():
    """A ' or REM between double quotes begins no comment, and what stands between them is no operator."""
    quote = 'x$ = "\'" + STR$(' + "-(" * 1600 + "1" + ")" * 1601
    word = 'x$ = "REM " + STR$(' + "(" * 500 + "1" + ")" * 501
    for text in (quote, word):
        assert [item.code for item in parse(Source("p.rbl", text)).diagnostics] == ["RBL108"]
    assert parse(Source("p.rbl", 'PRINT "' + "(" * 300 + " not " * 200 + "-" * 1500 + '"')).diagnostics == ()
