"""Properties over all programs and all texts."""

import sys

from hypothesis import example, given, settings
from hypothesis import strategies as st

from robolang.checker import check
from robolang.diagnostics import render, to_json
from robolang.interpreter import execute
from robolang.nodes import (
    Accel,
    Comment,
    Component,
    Hand,
    HandState,
    Line,
    Load,
    Move,
    Name,
    Negate,
    Number,
    Program,
    Seam,
    Speed,
    Time,
    Unparsed,
    Vector,
    Wrist,
    WristMode,
)
from robolang.parser import parse
from robolang.printer import print_program
from robolang.source import read_program
from robolang.words import RESERVED
from runtime.tomlfile import FileFault
from tests.lang.helpers import source


def make(kind, **parts):
    return st.builds(kind, **parts)


literals = st.one_of(
    st.integers(0, 10**6).map(str),
    st.floats(0, 1e300, allow_nan=False).map(repr),
    st.sampled_from([".5", "5.", "1E3", "1e-3", "00", "3.25E+2"]),
)
numbers = literals.map(lambda text: Number(value=float(text), text=text))
names = (
    st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True)
    .filter(lambda text: text.upper() not in RESERVED)
    .map(lambda text: Name(text=text))
)
expressions = st.recursive(numbers | names, lambda inner: make(Negate, operand=inner), max_leaves=4)
vectors = make(Vector, x=expressions, y=expressions, z=expressions)
wrists = st.one_of(
    make(Wrist, mode=st.sampled_from([WristMode.KEEP, WristMode.AUTO])),
    make(
        Wrist,
        mode=st.just(WristMode.HOLD),
        held=st.lists(st.sampled_from(Component), min_size=1, max_size=4).map(tuple),
    ),
)
options = st.one_of(*(make(kind, value=expressions) for kind in (Speed, Accel, Time)), wrists)
statements = st.one_of(
    make(Move, target=names, options=st.lists(options, max_size=4).map(tuple)),
    make(Load, cog=vectors, mass=expressions),
    make(Hand, state=st.sampled_from(HandState), dwell=st.none() | expressions),
    wrists,
    make(Seam, sensor=st.none() | names),
)
comments = st.text(st.characters(categories=["L", "N", "P", "S", "Zs"]), max_size=20).map(
    lambda text: Comment(text=f"'{text}".rstrip())
)
lines = make(
    Line,
    number=st.none() | st.integers(0, 999_999_999),
    statement=st.none() | statements,
    comment=st.none() | comments,
).filter(lambda line: (line.number, line.statement, line.comment) != (None, None, None))
programs = st.lists(lines, max_size=8).map(lambda found: Program(source_path="p", lines=tuple(found)))

fragments = st.sampled_from(
    ["MOVE", "move ", "LOAD", "HAND ", "ON", "OFF", "P1", "P2 ", "SPEED", "TIME", ",", "(", ")", "-", "+", "1", ".5",
     "1E999", "1_0", "'", "REM ", "\n", "\r\n", "\r", "\t", " ", "10 ", "МOVE", "\u202e", "\x00", "=", "*", "MOVEJ",
     "WRIST ", "KEEP", "HOLD ", "TILT", "ADVANCE", "SEAM "]
)  # fmt: skip
texts = st.text(max_size=200) | st.lists(fragments, max_size=60).map("".join)


@given(programs)
@settings(max_examples=150, deadline=None)
def test_what_is_printed_parses_back_to_the_same_tree(program):
    result = parse(source(print_program(program)))
    assert result.diagnostics == ()
    assert result.program == program
    assert print_program(result.program) == print_program(program)


@given(texts)
@settings(max_examples=300, deadline=None)
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
    for item in (*result.diagnostics, *check(result.program, points=["P1"], rated_payload_kg=2.5, sensors=["P2"])):
        assert 0 <= item.span.start <= item.span.end <= len(text)
        assert render(item, where).isprintable() or "\n" in render(item, where)
        assert "\x1b" not in render(item, where)
        assert to_json(item, where)["line"] >= 1


@given(texts)
@settings(max_examples=150, deadline=None)
def test_a_program_without_errors_runs_to_its_end(text):
    program = parse(source(text)).program
    if any(isinstance(line.statement, Unparsed) for line in program.lines) or check(program):
        return
    assert len(list(execute(program))) == len(program.statements)


@given(st.binary(max_size=200))
@settings(max_examples=100, deadline=None)
def test_any_bytes_are_text_or_a_fault(tmp_path_factory, raw):
    path = tmp_path_factory.getbasetemp() / "any.rbl"
    path.write_bytes(raw)
    try:
        parse(read_program(path))
    except FileFault as fault:
        assert fault.code == "RBL104"


def calls(text):
    """The number of Python calls that parsing a text takes; a measure that does not depend on the machine."""
    where, count = source(text), 0

    def step(frame, event, argument):
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(step)
    try:
        parse(where)
    finally:
        sys.setprofile(before)
    return count


def test_work_grows_with_the_text_and_not_faster():
    parse(source("MOVE P1"))
    shapes = ["10 MOVE P1, SPEED 200 ' x\n", "LOAD (1, -2, 3), 4\n", "'\n", "\n", "MOVE " + "-" * 90 + "\n", "1_0 \n",
              "MOVE P1, WRIST HOLD TILT, ADVANCE, TIME 2\n", "WRIST HOLD TILT\n", "SEAM ON, s\n"]  # fmt: skip
    for shape in shapes:
        small, large = calls(shape * 100), calls(shape * 200)
        assert large <= 2.1 * small + 100, shape
    repeated = [("MOVE P1", ", SPEED 1"), ("MOVE P1", ", WRIST HOLD TILT"), ("MOVE P1, WRIST HOLD TILT", ", TILT"),
                ("WRIST HOLD TILT", ", TILT")]  # fmt: skip
    for start, more in repeated:
        assert calls(start + more * 200) <= 2.1 * calls(start + more * 100) + 100, more
