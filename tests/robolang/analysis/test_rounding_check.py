"""Comparisons of numbers that rounding may part, and those that it cannot."""

import pytest

from robolang.core.diagnostics import MAX_DIAGNOSTICS
from tests.robolang.helpers import checked, parsed


def found(text):
    """Line and column of every RBL232."""
    return [(line, column) for code, line, column, _ in checked(text, points=("P1", "P2")) if code == "RBL232"]


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("x = 0.1 + 0.2\nIF x = 0.3 THEN END", [(2, 4)]),
        ("IF 0.1 + 0.2 <> 0.3 THEN END", [(1, 4)]),
        ("FOR v = 0 TO 1 STEP 0.1\nIF v = 0.5 THEN END\nNEXT", [(2, 4)]),
        ("FOR v = 0.1 TO 1\nIF v = 0.5 THEN END\nNEXT", [(2, 4)]),
        ("x = 0\nWHILE x <> 1\nx = x + 0.1\nWEND", [(2, 7)]),
        ("y = 0.1\nx = y\ny = x\nz = y * 3\nIF 0.3 = z THEN END", [(5, 4)]),
        ("CALL f(0.1 * 3)\nSUB f(a)\nIF a = 1 THEN END\nENDSUB", [(3, 4)]),
        ("DIM a(2)\na(1) = 0.1 * 3\nIF a(2) = 0.3 THEN END", [(3, 4)]),
        ("CONST k = 0.1\nSELECT 3 * k\nCASE 0.3\nEND\nENDSELECT", [(2, 8)]),
        ("SELECT 0.3\nCASE 1, 0.1 * 3\nEND\nENDSELECT", [(2, 9)]),
        ("WAIT TIMER = 5, TIMEOUT 1", [(1, 6)]),
        ("IF IN(1) = 1 AND (P1.X = 10 OR DIST(P1, P2) = 0) THEN END", [(1, 19), (1, 32)]),
        ("IF SQR(2) ^ 2 = 2 THEN PRINT SIN(30) = 0.5", [(1, 4), (1, 30)]),
        ("n = 7\nIF n / 3 * 3 = n THEN END", [(2, 4)]),
        ("IF MAX(1, -(0.1 * 3)) = 1 THEN END", [(1, 4)]),
    ],
)
def test_what_rounding_may_part(text, places):
    assert found(text) == places


@pytest.mark.parametrize(
    "text",
    [
        "x = 0.1\nIF x = 0.1 THEN END",
        "FOR i = 1 TO 9\nIF i / 10 = 0.3 OR i MOD 2 = 0 OR i * 2 + 1 = 7 THEN END\nNEXT",
        "FOR i = 0 TO 2 STEP 0.5\nIF i = 1.5 OR i / 4 = 0.125 THEN END\nNEXT",
        "n = 0\nWHILE n <> 10\nn = n + IN(1)\nWEND",
        "IF INT(0.1 * 3) = 0 OR ROUND(0.1 * 3) = 0 OR ROUND(0.1 * 3, 2) = 0.3 OR SGN(0.1 * 3) = 1 THEN END",
        'IF IN(1) = 1 OR ERR = 503 OR LEN("a" + STR$(0.1 * 3)) = 3 THEN END',
        's$ = STR$(0.1 * 3)\nIF s$ = "0.3" OR s$ + "a" = "b" THEN END',
        "x = 0.1 + 0.2\nIF x < 0.3 OR ABS(x - 0.3) < 1E-6 THEN END",
        "IF (0.1 + 0.2 < 1) = (2 > 1) THEN END",
        "y = 0.1\nIF y * 2 = 0.2 OR 4 * y = 0.4 OR y / 2 = 0.05 THEN END",
        "x = 0.1 + 0.2\nDIM x(2)\nx(1) = 3\nIF x(1) = 3 THEN END",
    ],
)
def test_what_rounding_cannot_part(text):
    assert found(text) == []


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("x = 0.1 * 3\nIF x = 0.3 THEN END", "write ABS(x - 0.3) < 1E-6"),
        ("x = 0.1 * 3\nIF x <> 1 - x THEN END", "write ABS(x - (1 - x)) >= 1E-6"),
        ("x = 0.1 * 3\nIF x = 0 THEN END", "write ABS(x) < 1E-6"),
    ],
)
def test_the_remedy_is_written_out(text, remedy):
    from robolang.analysis.rounding_check import rounding_check

    (diagnostic,) = rounding_check(parsed(text))
    assert diagnostic.hint == remedy
    assert [item.message.split()[0] for item in diagnostic.related] == ["x"]


def test_it_is_found_beside_an_error_of_another_line():
    assert [item[0] for item in checked("MOVE P9\nIF 0.1 * 3 = 0.3 THEN END\nWAIT IN(1) = 1", points=("P1",))] == [
        "RBL301",
        "RBL232",
        "RBL223",
    ]


def test_long_and_deep_programs_are_followed():
    deep = "1 = " + "(0.1 + " * 90 + "1" + ")" * 90
    assert len(found(f"IF {deep} THEN END")) == 1
    chained = "\n".join(f"x{n} = x{n + 1}" for n in range(500)) + "\nx500 = 0.1 * 3\nIF x490 = 1 THEN END"
    assert found(chained) == [(502, 4)]
    assert len(checked("IF 0.1 * 3 = 1 THEN END\n" * 2000, points=())) == MAX_DIAGNOSTICS + 1
