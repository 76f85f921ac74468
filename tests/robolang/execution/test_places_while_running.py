"""A run-time error is placed inside the statement that failed, whatever the statement and wherever it stands.

Each text below marks what must be accused with « and »: the whole statement, or the part of it that has a place of its
own (the value of an assignment, the condition and the branch of an IF on one line, an ELSEIF, a CASE).
"""

import re
from pathlib import Path

import pytest

from robolang.core.source import Source
from robolang.interpreter.program_fault import ProgramFault
from robolang.syntax.parser import parse
from tests.robolang.running import POINTS, World, execute

STATEMENTS = (
    "Y = «1 / Z»",
    "«A(1 / Z) = 2»",
    "«A(9) = 1»",
    "A(1) = «A(9)»",
    "«DIM B(1 / Z)»",
    "CONST C = 1 / Z",
    "PRINT 1 / Z",
    "PRINT A(7)",
    "OUT(1) = 1 / Z",
    "OUT(1 / Z) = 1",
    "PULSE 1, 1 / Z",
    "WAIT 1 / Z = 1",
    "WAIT IN(9) = 1",
    "WAIT IN(1) = 1, TIMEOUT 1 / Z",
    "WAIT IN(1) = 2, TIMEOUT 0.01",
    "DELAY 1 / Z",
    "MOVE P1, SPEED 1 / Z",
    "MOVE P1, ZONE 1 / Z",
    "MOVE P1 + (0, 0, 1 / Z)",
    "MOVEJ JOINT(0, 0, 0, 0, 0, 1 / Z)",
    "MOVEC P1 + (1 / Z, 0, 0), P2",
    "MOVEC P1, P2, TIME 1 / Z",
    "SPLINE (P1, P1 + (1 / Z, 0, 0), P2)",
    "APPROACH P1, 1 / Z",
    "DEPART 1 / Z",
    "LOAD (0, 0, 1 / Z), 1",
    "LOAD (0, 0, 0), 1 / Z",
    "LOAD (0, 0, 0), 1, (1, 1, 1 / Z, 0, 0, 0)",
    "HAND ON, 1 / Z",
    "SPEED 1 / Z",
    "SPEED 0 * Z",
    "ZONE 1 / Z",
    "FRAME POSE(1 / Z, 0, 0, 0, 0, 0)",
    "TOOL POSE(1 / Z, 0, 0, 0, 0, 0)",
    "CALL S(1 / Z)",
    "CALL R(1)",
    "RESUME",
    "IF «1 / Z» THEN Y = 1",
    "IF Z = 0 THEN Y = «1 / Z»",
    "IF Z THEN Y = 1 ELSE «PRINT 1 / Z»",
    "IF Z = 0 THEN «MOVE P1, SPEED 1 / Z» ELSE Y = 2",
)
"""Statements on one line; without marks it is all of it. Z is 0, A has the elements 0 to 3."""

BLOCKS = (
    "«IF 1 / Z THEN»\nY = 1\nENDIF",
    "IF Z THEN\nY = 1\n«ELSEIF 1 / Z THEN»\nY = 2\nENDIF",
    "IF Z THEN\nY = 1\nELSEIF IN(1) = 5 THEN\nY = 2\n«ELSEIF IN(9) THEN»\nY = 3\nENDIF",
    "IF Z THEN\nY = 1\nELSE\nY = «1 / Z»\nENDIF",
    "«FOR I = 1 / Z TO 2»\nNEXT",
    "«FOR I = 1 TO 1 / Z»\nNEXT",
    "«FOR I = 1 TO 2 STEP 1 / Z»\nNEXT",
    "FOR I = 1 TO 2\n«PRINT 1 / (I - 2)»\nNEXT",
    "«WHILE 1 / Z»\nWEND",
    "W = 1\n«WHILE 1 / W»\nW = 0\nWEND",
    "«SELECT 1 / Z»\nCASE 1\nENDSELECT",
    "SELECT 3\nCASE 1\nY = 1\n«CASE 2, 1 / Z»\nENDSELECT",
    "SELECT 3\nCASE 1\nY = 1\nCASE 2, 3\nY = «1 / Z»\nENDSELECT",
)

NESTINGS = {
    "main": "{}",
    "sub": "CALL OUTER(1)\nEND\nSUB OUTER(K)\n{}\nENDSUB",
    "sub in sub": "CALL OUTER\nEND\nSUB OUTER\nCALL INNER\nENDSUB\nSUB INNER\n{}\nENDSUB",
    "gosub": "GOSUB *G\nEND\n*G\n{}\nRETURN",
    "for": "FOR N = 1 TO 3\nV = N\n{}\nNEXT N",
    "while": "V = 1\nWHILE V\n{}\nWEND",
    "select": "SELECT 1\nCASE 2\nV = 0\nCASE 1\n{}\nENDSELECT",
    "if": "IF Z = 0 THEN\n{}\nENDIF",
    "handler": "ON ERROR GOTO *H\nV = SQR(Z - 1)\nEND\n*H\n{}\nRESUME NEXT",
    "after a handler": "ON ERROR GOTO *H\nV = SQR(Z - 1)\nON ERROR STOP\n{}\nEND\n*H RESUME NEXT",
}

HEAD = "Z = 0\nDIM A(3)\n"
TAIL = "\nEND\nSUB S(K)\nENDSUB\nSUB R(K)\nCALL R(K + 1)\nENDSUB"


def numbered(text, first):
    """Number every line in order: with 2 as the first, the number of each line is the file line of the next."""
    return "\n".join(f"{first + k} {line}" for k, line in enumerate(text.split("\n")))


def accused(marked):
    """The text without the marks, and the range of offsets between them."""
    start, end = marked.index("«"), marked.index("»") - 1
    return marked.replace("«", "").replace("»", ""), start, end


def assert_placed(body, nesting, first):
    body = body if "«" in body else f"«{body}»"
    text = HEAD + NESTINGS[nesting].format(body) + TAIL
    text, start, end = accused(text if first is None else numbered(text, first))
    source = Source("p.rbl", text)
    if body == "«CALL R(1)»":  # it comes back no more: what is one too many is the CALL in R
        start = text.index("CALL R(K + 1)")
        end = start + len("CALL R(K + 1)")
    with pytest.raises(ProgramFault) as caught:
        world = World()
        for _ in execute(parse(source).program, world, POINTS):
            world.time += 0.008
    origin = caught.value.origin
    assert start <= origin.span.start < origin.span.end <= end, (text, source.slice(origin.span), caught.value)
    line = source.place(start).line
    assert (origin.line, origin.number) == (line, None if first is None else first + line - 1)


@pytest.mark.parametrize("first", [None, 2], ids=["plain", "numbered"])
@pytest.mark.parametrize("nesting", NESTINGS)
def test_the_place_is_inside_the_statement_that_failed(nesting, first):
    inapplicable = {"handler": {"RESUME"}}.get(nesting, set())
    for body in STATEMENTS + BLOCKS:
        if body not in inapplicable:
            assert_placed(body, nesting, first)


def test_every_call_on_the_chain_is_named_outermost_first():
    text = "Z = 0\nIF 1 THEN CALL A(2)\nEND\nSUB A(K)\nGOSUB *G\nRETURN\n*G CALL B\nRETURN\nENDSUB\n"
    text += "SUB B\nY = 1 / Z\nENDSUB"
    source = Source("p.rbl", text)
    with pytest.raises(ProgramFault) as caught:
        list(execute(parse(source).program))
    assert [source.slice(call.span) for call in caught.value.calls] == ["CALL A(2)", "GOSUB *G", "CALL B"]
    assert [call.line for call in caught.value.calls] == [2, 5, 7]


def test_nothing_takes_a_line_number_for_a_line_or_the_other_way_round():
    """A choice between the two is what once put them into one field; words are made by ``named`` alone."""
    root = Path(__file__).parents[3]
    mixed = re.compile(r"\bline\b.* if .*\bnumber\b.* is None else|\bnumber\b.* if .*is not None else .*line\b")
    found = {
        path.name
        for package in ("robolang", "runtime")
        for path in (root / package).rglob("*.py")
        if mixed.search(path.read_text("utf-8"))
    }
    assert found == {"program_line.py"}
