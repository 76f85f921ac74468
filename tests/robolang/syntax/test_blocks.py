"""Blocks are matched, jumps are found, and every mistake has its place."""

import pytest

from robolang.core.diagnostics import MAX_DIAGNOSTICS, Severity
from robolang.syntax.ast import Unparsed
from robolang.syntax.blocks import MAX_BLOCKS, structure_of
from robolang.syntax.parser import parse
from tests.robolang.helpers import parsed, places, source


def found(text):
    return places(text, tuple(structure_of(parsed(text)).diagnostics))


GOOD = """10 IF 1 THEN
20 FOR i = 1 TO 2
30 NEXT i
40 ELSEIF 2
50 ELSE
60 ENDIF
70 SELECT 1
80 CASE 1, 2
90 CASE ELSE
100 ENDSELECT
*TOP WHILE 0
120 IF 1 THEN GOTO *TOP ELSE GOTO *top
130 GOTO 150
140 WEND
150 GOSUB 10
160 END
170 SUB s(a)
180 GOTO 190
190 ENDSUB
"""


def test_the_tables_of_a_program_with_every_block():
    structure = structure_of(parsed(GOOD))
    assert structure.diagnostics == []
    assert structure.after == {
        0: 3,
        3: 4,
        4: 5,
        5: 0,
        1: 2,
        2: 1,
        6: 7,
        7: 8,
        8: 9,
        9: 6,
        10: 13,
        13: 10,
        16: 18,
        18: 16,
    }
    assert {structure.end[line] for line in (0, 3, 4, 5)} == {5}
    assert structure.numbers[150] == 14
    assert structure.labels == {"TOP": 10}
    assert structure.subs == {"S": 16}
    assert structure.owner == {17: 16, 18: 16}
    assert structure.inside[1:3] == [(0,), (0,)]
    assert [structure.inside[line] for line in (0, 3, 5, 12)] == [(), (), (), (10,)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("GOTO 20", [("RBL202", 1, 6, 2)]),
        ("GOTO 10.5", [("RBL202", 1, 6, 4)]),
        ("GOTO 5000000000", [("RBL202", 1, 6, 10)]),
        ("GOSUB *L", [("RBL202", 1, 7, 2)]),
        ("ON ERROR GOTO *L", [("RBL202", 1, 15, 2)]),
        ("WAIT 1, TIMEOUT 1, GOTO 5", [("RBL202", 1, 25, 1)]),
        ("IF 1 THEN GOTO 5 ELSE GOSUB *L", [("RBL202", 1, 16, 1), ("RBL202", 1, 29, 2)]),
        ("*L\n*l DELAY 1", [("RBL203", 2, 1, 2)]),
        ("SUB a\nENDSUB\nSUB A(b)\nENDSUB", [("RBL203", 3, 5, 1)]),
        ("GOTO 20\nFOR i = 1 TO 2\n20 DELAY 1\nNEXT", [("RBL204", 1, 6, 2)]),
        ("GOTO 20\nWHILE 1\n20 DELAY 1\nWEND", [("RBL204", 1, 6, 2)]),
        ("GOTO 20\nIF 1 THEN\n20 DELAY 1\nENDIF", [("RBL204", 1, 6, 2)]),
        ("GOTO 20\nSELECT 1\nCASE 1\n20 DELAY 1\nENDSELECT", [("RBL204", 1, 6, 2)]),
        ("GOTO 20\nSUB a\n20 DELAY 1\nENDSUB", [("RBL204", 1, 6, 2)]),
        ("20 DELAY 1\nSUB a\nGOTO 20\nENDSUB", [("RBL204", 3, 6, 2)]),
        ("GOTO *L\nSUB a\n*L\nDELAY 1\nENDSUB", [("RBL204", 1, 6, 2)]),
        ("*L\nDELAY 1\nSUB a\nGOTO *L\nENDSUB", [("RBL204", 4, 6, 2)]),
        ("FOR i = 1 TO 2\nFOR j = 1 TO 2\n20 DELAY 1\nNEXT\nGOTO 20\nNEXT", [("RBL204", 5, 6, 2)]),
        ("IF 1 THEN", [("RBL211", 1, 1, 9)]),
        ("FOR i = 1 TO 2", [("RBL211", 1, 1, 14)]),
        ("WHILE 1\nSELECT 1", [("RBL211", 1, 1, 7), ("RBL211", 2, 1, 8)]),
        ("SUB a(b)", [("RBL211", 1, 1, 8)]),
        ("FOR i = 1 TO 2\nSELECT 1\nCASE 1\nNEXT", [("RBL211", 2, 1, 8)]),
        ("WHILE 1\nIF 1 THEN\nFOR i = 1 TO 2\nELSE\nENDIF\nWEND", [("RBL211", 3, 1, 14)]),
        ("FOR i = 1 TO 2\nSUB a\nNEXT\nENDSUB", [("RBL219", 2, 1, 5), ("RBL212", 3, 1, 4), ("RBL211", 1, 1, 14)]),
        ("GOTO 20\nFOR i = 1 TO 2\n20 DELAY 1", [("RBL211", 2, 1, 14)]),
        ("NEXT i", [("RBL212", 1, 1, 6)]),
        ("10 WEND", [("RBL212", 1, 4, 4)]),
        ("ELSE\nELSEIF 1\nENDIF", [("RBL212", 1, 1, 4), ("RBL212", 2, 1, 8)]),
        ("CASE 1\nCASE ELSE\nENDSELECT\nENDSUB", [("RBL212", n, 1, w) for n, w in ((1, 6), (4, 6))]),
        ("FOR i = 1 TO 2\nNEXT j", [("RBL212", 2, 1, 6)]),
        ("FOR i = 1 TO 2\nFOR j = 1 TO 2\nNEXT i\nNEXT j", [("RBL212", 3, 1, 6), ("RBL212", 4, 1, 6)]),
        ("IF 1 THEN\nELSE\nELSEIF 1\nENDIF", [("RBL212", 3, 1, 8)]),
        ("IF 1 THEN\nELSE\nELSE\nENDIF", [("RBL212", 3, 1, 4)]),
        ("SELECT 1\nCASE ELSE\nCASE 2\nENDSELECT", [("RBL212", 3, 1, 6)]),
        ("WHILE 1\nSUB a\nENDSUB\nWEND", [("RBL219", 2, 1, 5)]),
        ("SUB a\nSUB b\nENDSUB\nENDSUB", [("RBL219", 2, 1, 5)]),
    ],
)
def test_what_is_wrong_with_blocks_and_jumps(text, expected):
    assert found(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "FOR i = 1 TO 2\nGOTO 20\nNEXT\n20 END",
        "10 FOR i = 1 TO 2\nNEXT\nGOTO 10",
        "FOR i = 1 TO 2\nIF 1 THEN\nGOTO 20\nENDIF\n20 NEXT",
        "WHILE 1\nGOTO 20\n20 WEND",
        "SUB a\n*L GOTO *L\nENDSUB",
        "IF 1 THEN\nELSEIF 2 THEN\nGOTO 20\n20 DELAY 1\nENDIF",
        "FOR i = 1 TO 2\nNEXT I",
        "GOTO 10 \n10",
    ],
)
def test_what_is_allowed(text):
    assert found(text) == []


@pytest.mark.parametrize(
    "text",
    [
        "FOR i = 1 TO\nNEXT",
        "FORR i = 1 TO 2\nNEXT",
        "IF 1 THEN\nEND IF",
        "SELECT 1\nEND SELECT",
        "END 5",
        "WHILE\nWEND",
        "IF x >\nELSEIF\nELSE x\nENDFI",
        "IF 1 THN\nENDIF",
        "SELECT\nCASE\nCASE ELSE 5\nENDSLECT",
        "*L SUB a(\nENDSUB",
        "IF 1 THEN MOV P1",
        "FOR i = 1 TO 2\nNETX",
    ],
)
def test_a_line_with_an_error_still_takes_part_in_its_block(text):
    program = parse(source(text)).program
    assert any(isinstance(line.statement, Unparsed) for line in program.lines)
    assert structure_of(program).diagnostics == []


def test_both_places_are_named():
    for text, span in (
        ("*L\n*L", (0, 2)),
        ("SUB a\nENDSUB\nSUB a\nENDSUB", (4, 5)),
        ("FOR i = 1 TO 2\nNEXT j", (0, 14)),
        ("GOTO 20\nWHILE 1\n20 DELAY 1\nWEND", (8, 15)),
    ):
        (item,) = structure_of(parsed(text)).diagnostics
        assert (item.related[0].span.start, item.related[0].span.end) == span
        assert item.severity is Severity.ERROR


@pytest.mark.parametrize(("head", "end"), [("IF 1 THEN", "ENDIF"), ("WHILE 1", "WEND"), ("FOR i = 1 TO 2", "NEXT")])
def test_blocks_are_nested_to_a_bound(head, end):
    def nested(depth):
        return f"{head}\n" * depth + f"{end}\n" * depth

    assert found(nested(MAX_BLOCKS)) == []
    assert found(nested(MAX_BLOCKS + 1)) == [("RBL108", MAX_BLOCKS + 1, 1, len(head))]
    assert found(nested(5_000)) == [("RBL108", MAX_BLOCKS + 1, 1, len(head))]


def test_no_more_of_a_code_are_kept_than_are_listed():
    text = "*A\n" * 3 * MAX_DIAGNOSTICS + "GOTO *B"
    codes = [item.code for item in structure_of(parsed(text)).diagnostics]
    assert (codes.count("RBL203"), codes.count("RBL202")) == (MAX_DIAGNOSTICS + 1, 1)


def test_what_belongs_to_a_missing_head_is_not_said_again():
    assert found("FOR i = 1 TO 2\nCASE 1\nCASE 2\nCASE ELSE\nENDSELECT\nNEXT i") == [("RBL212", 2, 1, 6)]
    assert found("FOR i = 1 TO 2\nCASE 1\nNEXT i") == [("RBL212", 2, 1, 6)]
    assert [line for _, line, *_ in found("CASE 1\nWEND\nENDSELECT\nENDSELECT")] == [1, 2, 4]
