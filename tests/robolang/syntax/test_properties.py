"""Properties over all programs and all texts."""

import re
from dataclasses import replace
from itertools import islice
from typing import get_args

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robolang.analysis.checker import check
from robolang.core.diagnostics import has_errors, render, to_json
from robolang.core.source import read_program
from robolang.syntax import ast, unparse
from robolang.syntax.ast import Unparsed
from robolang.syntax.blocks import targets
from robolang.syntax.formatter import format_source
from robolang.syntax.parser import parse
from robolang.syntax.renumber import remove_numbers, renumber
from runtime.core.faults import Fault, lookup
from runtime.core.tomlfile import FileFault
from tests.campaign import examples
from tests.robolang import generator
from tests.robolang.generator import jumping_programs, programs, texts, written_badly
from tests.robolang.helpers import cell_with, print_line, print_program, source
from tests.robolang.running import execute
from tests.steps import assert_linear


def test_the_generator_makes_every_kind_of_node():
    assert set(generator.EXPRESSIONS) == set(get_args(ast.Expression))
    assert set(generator.OPTIONS) == set(get_args(ast.Option))
    assert set(generator.STATEMENTS) == set(get_args(ast.Statement)) - {Unparsed}


@given(programs)
@examples(300)
def test_what_is_printed_parses_back_to_the_same_tree(program):
    result = parse(source(print_program(program)))
    assert result.diagnostics == ()
    assert result.program == program
    assert print_program(result.program) == print_program(program)


# --- the formatter ---------------------------------------------------------------------------------------------------


def canonical(program):
    """The tree with REM in capitals, the only thing in it that the formatter changes."""
    lines = [
        line
        if line.comment is None or line.comment.text.startswith("'")
        else ast.replace(line, comment=ast.Comment(text=f"REM{line.comment.text[3:]}"))
        for line in program.lines
    ]
    return ast.replace(program, lines=tuple(lines))


def assert_formatted_well(text):
    """Format a text; what comes out has its tree and its comments, and is a fixed point."""
    before = parse(source(text))
    found = format_source(source(text))
    after = parse(source(found.text))
    assert canonical(after.program) == canonical(before.program)
    assert canonical(after.program).comments == canonical(before.program).comments
    assert found.changed == (found.text != text)
    assert found.diagnostics == before.diagnostics
    again = format_source(source(found.text))
    assert again.text == found.text
    assert not again.changed
    return found.text


def parentheses(text):
    """The parentheses of a program outside of texts and comments."""
    plain = re.sub(r"""(?i)"[^"]*"|'.*|(?<!\w)REM(?!\w).*""", "", text.replace("\r", "\n"))
    return re.sub("[^()]", "", plain)


@given(programs.flatmap(lambda program: written_badly(print_program(program))))
@examples(300)
def test_formatting_is_done_once_and_keeps_the_tree_and_the_comments(text):
    before = parse(source(text))
    assert not has_errors(before.diagnostics)
    found = assert_formatted_well(text)
    assert parentheses(found) == parentheses(text)
    assert found == "" or found.endswith(("\n", "\r"))
    assert not found.endswith(("\n\n", "\r\r", "\r\n\r\n")) or "fmt: off" in text


@given(programs, st.data())
@examples(150)
def test_one_tree_has_one_layout(program, data):
    kept = [ast.replace(line, comment=None) for line in program.lines]
    program = ast.replace(program, lines=tuple(line for line in kept if line != ast.Line()))
    clean = print_program(program)
    badly = data.draw(written_badly(clean))
    spelt = format_source(source(badly)).text.upper().split()
    assert spelt == format_source(source(clean)).text.upper().split()


@given(texts)
@examples(300)
@example("\ud800")
@example("\ufeffMOVE P1")
@example("GOTO 1.5\r  goto 1.5 'x")
@example("x=1 'a\n\n\n\n \n")
@example("' fmt: off\n x=1\n\n\n\n\n")
def test_any_text_is_formatted_without_harm(text):
    assert_formatted_well(text)


# --- line numbers ----------------------------------------------------------------------------------------------------


def without_numbers(program):
    """The tree with every line number and every target that is one replaced by the line that it names."""
    index = {line.number: at for at, line in enumerate(program.lines) if line.number is not None}

    def led(statement):
        if isinstance(statement, ast.Jump | ast.OnError | ast.Wait) and statement.target is not None:
            number = statement.target.number
            return statement if number is None else ast.replace(statement, target=ast.Target(number=index[number]))
        if isinstance(statement, ast.If):
            return ast.replace(statement, then=led(statement.then), otherwise=led(statement.otherwise))
        return statement

    return [ast.replace(line, number=None, statement=led(line.statement)) for line in program.lines]


@given(
    jumping_programs().flatmap(lambda program: written_badly(print_program(program))),
    st.integers(0, 500),
    st.integers(1, 70),
)
@examples(200, 20)
def test_new_line_numbers_change_nothing_else(text, start, step):
    before = parse(source(text)).program
    found = renumber(source(text), start=start, step=step)
    after = parse(source(found.text)).program
    assert not has_errors(found.diagnostics)
    assert without_numbers(after) == without_numbers(before)
    counted = [line.number for line in after.lines if line.number is not None]
    assert counted == list(range(start, start + step * len(counted), step))
    assert all(
        (line.number is None) == (line.label is line.statement is None and was.number is None)
        for line, was in zip(after.lines, before.lines, strict=True)
    )
    again = renumber(source(found.text), start=start, step=step)
    assert (again.text, again.changed, again.lines, again.targets) == (found.text, False, 0, 0)


@given(jumping_programs().flatmap(lambda program: written_badly(print_program(program))))
@examples(100)
def test_numbers_are_removed_where_nothing_leads(text):
    before = parse(source(text)).program
    found = remove_numbers(source(text))
    after = parse(source(found.text)).program
    named = {target.number for line in before.lines for target in targets(line.statement)} - {None}
    assert {line.number for line in after.lines} - {None} == named
    empty = ast.Line()
    expected = [ast.replace(line, number=line.number if line.number in named else None) for line in before.lines]
    assert list(after.lines) == [line for line in expected if line != empty]


@given(texts)
@examples(200)
def test_any_text_is_renumbered_or_left_alone(text):
    for found in (renumber(source(text)), remove_numbers(source(text))):
        if has_errors(found.diagnostics):
            assert (found.text, found.changed) == (text, False)
        else:
            assert not has_errors(parse(source(found.text)).diagnostics)


# --- what a program does ---------------------------------------------------------------------------------------------

PROGRAM = """\
10 LOAD (0, 0, 60), 0.8 ' hand only
20 CONST rows = 3
DIM made(9)
WRIST HOLD TILT, ROTATION
FOR r = 0 TO rows - 1
FOR c = 4 TO 0 STEP -(3 - (2 - 1))
x = 100 - (r * 60 - (c - 10)) / (2) MOD 7
IF NOT x < 95 AND c <> 2 THEN GOSUB *Place ELSE PRINT "no ""t"" "; r XOR c; r; c; -2^2; (-2)^2; 2^3^2; 2^(3^2)
NEXT c
SELECT r - (1 - r)
CASE -1, 3
MOVE P1 + (0, 0, x), SPEED 100, ZONE 5
CASE ELSE
MOVEJ P2 * (0, 0, -r - -1), SPEED 50
ENDSELECT
NEXT
CALL Back(20, P1)
WHILE made(4) < 3
made(4) = made(4) + 1
IF made(4) = 2 THEN
HAND OFF, 0.25
ELSEIF made(4) = 3 THEN
OUT(3) = made(4) = 3
ELSE
DELAY 0.5
ENDIF
WEND
ON ERROR GOTO 900
PRINT 1 / (rows - 3)
END
*Place APPROACH P3 + (r, c, 0), 50
MOVE P3 + (r, c, 0), FINE, WRIST HOLD ADVANCE
DEPART 50
RETURN
900 PRINT "error "; ERR REM caught
RESUME NEXT
SUB Back(d, p)
MOVE p + (0, 0, d), SPEED d * 10
ENDSUB
"""


POINTS = ("P1", "P2", "P3")


def carried_out(program, most=2000):
    """The effects of a program, as many as that, and the code of the fault that ended it."""
    found = []
    try:
        found.extend(islice(execute(program, points=POINTS), most))
    except Fault as fault:
        return found, fault.code
    return found, None


def trace(text):
    """What a program does, without where it stands in the file."""
    program = parse(source(text)).program
    assert not has_errors(check(program))
    effects, fault = carried_out(program)
    return [replace(effect, line=0, span=ast.NOWHERE) for effect in effects], fault


@given(written_badly(PROGRAM))
@examples(50)
def test_formatting_changes_nothing_that_a_program_does(text):
    done, fault = trace(PROGRAM)
    assert (len(done) > 20, fault) == (True, None)
    assert trace(text) == (done, fault)
    assert trace(format_source(source(text)).text) == (done, fault)


# --- any text --------------------------------------------------------------------------------------------------------


@given(texts)
@examples(300)
@example("\ud800")
@example("\ufeffMOVE P1")
@example("MOVE P1\n\x1c\x85\u2028")
@example("1" * 5000)
def test_any_text_gives_a_tree_and_located_diagnostics(text):
    where = source(text)
    result = parse(where)
    bad = {where.place(item.span.start).line for item in result.diagnostics if item.code != "RBL110"}
    unparsed = [line for line in result.program.lines if isinstance(line.statement, Unparsed)]
    assert {line.source_line for line in unparsed} == bad
    assert len(unparsed) == sum(item.code != "RBL110" for item in result.diagnostics)
    for item in (
        *result.diagnostics,
        *check(result.program, cell_with(points=["P1"], rated_payload_kg=2.5, sensors=["P2"])),
    ):
        assert 0 <= item.span.start <= item.span.end <= len(text)
        assert render(item, where).isprintable() or "\n" in render(item, where)
        assert "\x1b" not in render(item, where)
        assert to_json(item, where)["line"] >= 1


@given(texts)
@examples(150)
@example("x = 1\nWHILE x < 9\nx = x + 1\nWEND\nMOVE P1")
@example("FOR i = 1 TO 3\nSPEED i\nMOVE P1 + (i, 0, 0)\nNEXT")
def test_a_program_without_errors_runs_to_its_end_or_to_a_fault(text):
    program = parse(source(text)).program
    if any(isinstance(line.statement, Unparsed) for line in program.lines) or check(program):
        return
    lines = {line.source_line: line for line in program.statements}
    effects, fault = carried_out(program)
    for effect in effects:
        assert lines[effect.line].number == effect.number
        assert source(text).slice(effect.span)
    assert fault is None or lookup(fault)


@given(st.binary(max_size=200))
@examples(100)
def test_any_bytes_are_text_or_a_fault(tmp_path_factory, raw):
    path = tmp_path_factory.getbasetemp() / "any.rbl"
    path.write_bytes(raw)
    try:
        format_source(read_program(path))
    except FileFault as fault:
        assert fault.code == "RBL104"


# --- what a broken printer would do ----------------------------------------------------------------------------------

DEFECTS = {
    "a - (b - c) as a - b - c": {unparse._SUM: unparse._SUM},
    "a / (b / c) as a / b / c": {unparse._PRODUCT: unparse._PRODUCT},
    "(a + b) * c as a + b * c": {unparse._PRODUCT: unparse._SUM},
    "(a = b) = c as a = b = c": {unparse._COMPARE: unparse._COMPARE},
    "a OR (b OR c) as a OR b OR c": {unparse._OR: unparse._OR},
    "a AND (b OR c) as a AND b OR c": {unparse._AND: unparse._OR},
    "(-a)^b as -a^b": {unparse._POWER: unparse._SIGNED},
    "(a^b)^c as a^b^c": {unparse._POWER: unparse._POWER},
}


NUMBER = ast.Number(value=1.0, text="1")
SIGNS = (*(sign for level in generator.LEVELS for sign in level), *generator.COMPARISONS)


def holding(inner):
    """Every expression with one operator that holds another expression, on either side of it."""
    yield from (ast.Negate(operand=inner), ast.Not(operand=inner))
    for sign in SIGNS:
        yield ast.Chain(first=inner, rest=((sign, NUMBER),))
        yield ast.Chain(first=NUMBER, rest=((sign, inner),))


PAIRS = [outer for inner in holding(NUMBER) for outer in holding(inner)]


def misprinted(value):
    """Whether an expression is another one once it has been printed and parsed."""
    line = ast.Line(statement=ast.Delay(seconds=value))
    return parse(source(print_line(line))).program.lines != (line,)


def test_every_operator_in_every_other_keeps_its_parentheses():
    assert len(PAIRS) == (2 + 2 * len(SIGNS)) ** 2 > 800
    assert not [value for value in PAIRS if misprinted(value)]


@pytest.mark.parametrize("defect", DEFECTS)
def test_a_printer_without_these_parentheses_is_caught(defect, monkeypatch):
    for level, lowest in DEFECTS[defect].items():
        monkeypatch.setitem(unparse._OPERAND_OF, level, lowest)
    assert any(misprinted(value) for value in PAIRS)


# --- time ------------------------------------------------------------------------------------------------------------


SHAPES = (
    "10 MOVE P1, SPEED 200 ' x\n",
    "LOAD (1, -2, 3), 4\n",
    "'\n",
    "\n",
    "MOVE " + "-" * 90 + "\n",
    "1_0 \n",
    "MOVE P1, WRIST HOLD TILT, ADVANCE, TIME 2\n",
    "WRIST HOLD TILT\n",
    "SEAM ON, s\n",
    "IF x\n",
    "NEXT\n",
    "IF x\nFOR i = 1 TO 2\n",
    "WHILE 1\nENDIF\n",
    "CASE 1\n",
    "x = (((1 + 2) * 3)^4 MOD 5)\n",
    "PRINT x; y ' z\n",
    "IF x THEN GOSUB *L ELSE MOVE P1 + (1, 2, 3)\n",
    "' fmt: off\n",
    "x = 1 '" + "long " * 20 + "\n",
)
REPEATED = (
    ("MOVE P1", ", SPEED 1"),
    ("MOVE P1", ", WRIST HOLD TILT"),
    ("MOVE P1, WRIST HOLD TILT", ", TILT"),
    ("WRIST HOLD TILT", ", TILT"),
    ("x = 1", " + 1"),
    ("x = 2", "^2"),
    ("x = 1", " XOR 1"),
    ("x = 1", " MOD 1"),
    ('x$ = "a"', ' + "b""c"'),
    ("x = 1", " + (1)"),
    ("CASE 1", ", 1"),
    ("PRINT 1", "; 1"),
    ("x = MAX(1", ", 1"),
)


@pytest.mark.parametrize("work", [parse, format_source, renumber])
def test_work_grows_with_the_text_and_not_faster(work):
    parse(source("MOVE P1"))
    for shape in SHAPES:
        assert_linear(work, source(shape * 50), source(shape * 100))
    for start, more in REPEATED:
        assert_linear(work, source(start + more * 50), source(start + more * 100))
