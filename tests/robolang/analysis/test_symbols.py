"""An undefined name is one mistake, and none where a line with an error seems to define it."""

import pytest

from robolang.analysis.checker import check
from robolang.analysis.symbols import seems_to_define
from robolang.core.deduplicate import MAX_NOTES
from robolang.core.diagnostics import Severity
from robolang.syntax.parser import parse
from tests.robolang.helpers import cell_with, places, source
from tests.robolang.running import execute


def found(text, points=("P1",)):
    return places(text, check(parse(source(text)).program, cell_with(points=points)))


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("CONST height =(50", {"HEIGHT"}),
        ("CO(ST height = 50", {"HEIGHT"}),
        ("CONS height = 50", {"CONS", "HEIGHT"}),
        ("OR i = 1 TO 4", {"I"}),
        ("FRO i = 1 TO 4", {"FRO", "I"}),
        ("FOR i + 1 TO n", {"I", "N"}),
        ("x == 5", {"X"}),
        ("SUB blink(n, )", {"BLINK", "N"}),
        ("*L SUBB blink(n)", {"SUBB", "B", "BLINK", "N"}),
        ("part(i) = =", {"PART"}),
        ("SUBblink(n)", {"SUBBLINK", "BLINK", "N"}),
        ("1UB f(n)", {"F", "N"}),
        ("DIN a(3)", {"DIN", "A"}),
        ("part(a(i)) = = 2", set()),
        ("name$ = 'x = 1", {"NAME$"}),
        ('PRINT "x = 1" y', set()),
        ("IF x = 1 THN y = 2", {"X", "Y"}),
        ("MOV P77", set()),
        ("MOVE P77 P2", set()),
        ("TIMER = 5", set()),
        ("", set()),
        ("x = 1 REM y = 2", {"X"}),
        ("(" * 500, set()),
        ("a" * 9000, set()),
        ("a " * 4000, set()),
    ],
)
def test_what_a_line_with_an_error_seems_to_define(text, names):
    assert seems_to_define(text) == names


def test_an_undefined_name_is_said_at_its_first_use():
    text = "\n".join(["x = cuont", *["PRINT Cuont; cuont"] * 9, "PRINT other"])
    diagnostics = check(parse(source(text)).program, cell_with(points=()))
    assert places(text, diagnostics) == [("RBL215", 1, 5, 5), ("RBL215", 11, 7, 5)]
    assert [source(text).place(note.span.start).line for note in diagnostics[0].related] == [2, 2, 3, 3, 4][:MAX_NOTES]
    assert diagnostics[1].related == ()


def test_an_undefined_array_subroutine_and_target_are_said_once():
    text = "a(1) = 2\nPRINT a(1)\nCALL f\nCALL F\nGOTO *L\nGOSUB *l\nGOTO 1.5\nGOTO 1.5\nGOTO 7\nGOTO 8"
    assert found(text) == [
        ("RBL215", 1, 1, 1),
        ("RBL213", 3, 6, 1),
        ("RBL202", 5, 6, 2),
        ("RBL202", 7, 6, 3),
        ("RBL202", 8, 6, 3),
        ("RBL202", 9, 6, 1),
        ("RBL202", 10, 6, 1),
    ]


def test_every_move_to_a_point_that_is_not_taught_is_said():
    assert found("MOVE P9\nMOVE P9") == [("RBL301", 1, 6, 2), ("RBL301", 2, 6, 2)]


@pytest.mark.parametrize(
    "text",
    [
        "CONS k = 5\nPRINT k\nDELAY k",
        "FRO i = 1 TO 2\nPRINT i\nNEXT i",
        "SBU f(x)\nPRINT x\nENDSUB\nCALL f(1)",
        "DMI a(3)\na(1) = 2\nPRINT a(1)",
        "P5 = P1 + * (0, 0, 5)\nMOVE P5",
        "*L PRIN 1\nGOTO *L",
        "*M DELAY\nGOSUB *M",
    ],
)
def test_a_mistyped_definition_is_one_mistake(text):
    assert len(parse(source(text)).diagnostics) == 1
    assert [item for item in found(text) if item[0] != "RBL212"] == []


def test_a_use_in_a_line_with_an_error_defines_nothing():
    assert found("MOV P9\nMOVE P9\nPRINT x y\nPRINT x") == [("RBL301", 2, 6, 2), ("RBL215", 4, 7, 1)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("CALL s\nPRINT a\nSUB s\na = 1\nENDSUB", [("RBL215", 2, 7, 1)]),
        ("CALL s\nCALL t\nSUB s\na = 1\nENDSUB\nSUB t\nPRINT a\nENDSUB", [("RBL215", 7, 7, 1)]),
        ("CALL s\nPRINT a(1)\nSUB s\nDIM a(2)\nENDSUB", [("RBL215", 2, 7, 1)]),
        ("CALL s(1)\nPRINT n\nSUB s(n)\nPRINT n\nENDSUB", [("RBL215", 2, 7, 1)]),
        ("a = 1\nCALL s\nSUB s\nPRINT a\na = 2\nENDSUB", []),
        ("k = 1\nPRINT k\nCALL s\nSUB s\nCONST k = 2\nPRINT k\nENDSUB", []),
        ("CONST k = 1\nPRINT k\nCALL s\nSUB s\nk = 2\nENDSUB", [("RBL216", 5, 1, 1)]),
        ("CALL s\nCALL t\nSUB s\nCONST k = 2\nPRINT k\nENDSUB\nSUB t\nCONST k = 3\nPRINT k\nENDSUB", []),
    ],
)
def test_a_name_is_seen_where_a_run_sees_it(text, expected):
    """What a SUB gives a value ends with the SUB; a run of the accepted ones has no fault (RBL532)."""
    errors = [
        item for item in check(parse(source(text)).program, cell_with(points=())) if item.severity is Severity.ERROR
    ]
    assert places(text, errors) == expected
    if not expected:
        list(execute(parse(source(text)).program))


def test_names_are_not_scoped_by_blocks_that_are_broken():
    assert [code for code, *_ in found("SUB s\na = 1\nPRINT a\nCALL s\nPRINT a")] == ["RBL211"]
