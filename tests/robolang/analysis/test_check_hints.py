"""What an error of the check says besides its place: what to write in its stead, and where."""

import re

import pytest

from robolang.analysis.checker import check
from robolang.core.source import Span
from tests.messages import fields
from tests.robolang.helpers import cell_with, parsed


def first(text, **facts):
    (diagnostic,) = check(parsed(text), cell_with(**facts))
    return diagnostic


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("TOOL 1", "POSE(x, y, z, rx, ry, rz); tools of the cell: GRIP"),
        ("FRAME P1.X", "FRAME, or a pose: POSE(x, y, z, rx, ry, rz)"),
        ("MOVE (480, 0, 800, 180, 0, 180)", "POSE(480, 0, 800, 180, 0, 180)"),
        ("P9 = (1, 2, 3, 4, 5, 6)", "POSE(1, 2, 3, 4, 5, 6)"),
        ("MOVE (1, 2, 3)", "P1 + (1, 2, 3)"),
        ('MOVE "P1"', "without quotes: P1"),
        ("MOVE P1 + 50", "P1 + (0, 0, 50)"),
        ("MOVE P1 - 50", "P1 + (0, 0, -50)"),
        ("MOVE P1 + P2", "P1 + (P2.X, P2.Y, P2.Z)"),
        ("MOVE P1 - (0, -5, x)", "+ (0, 5, -x)"),
        ("IF P1 = P2 THEN END", "DIST(P1, P2)"),
        ("DELAY P1", "P1.X"),
        ('DELAY "2.5"', "2.5 without quotes"),
        ("DELAY s$", "VAL(s$)"),
        ("s$ = 5", "STR$(5)"),
        ("s$ = P1", "STR$(P1.X)"),
        ('x = "1"', "x$ for a text"),
    ],
)
def test_a_value_of_another_kind_is_named_as_it_must_be_written(text, written):
    found = check(parsed(f'x = 1\ns$ = "a"\n{text}\nPRINT x; s$'), cell_with(points=("P1", "P2"), tools=("GRIP",)))
    (hint,) = (item.hint for item in found if item.code == "RBL217")
    assert written in hint


def test_a_cell_without_inputs_is_given_one_in_its_form():
    (item,) = check(parsed("PRINT IN(1)"), cell_with(inputs=()).replaced(cell_file="a.cell.toml"))
    assert (item.code, item.span) == ("RBL534", Span(9, 10))
    assert "into a.cell.toml: [inputs.1] changes = [[0, 0], [1, 1]]" in item.hint
    assert "(2, 3)" in first("PRINT IN(1)", inputs=(3, 2)).hint


def test_fine_beside_zone_is_named_by_both_words():
    assert {"ZONE", "FINE"} <= fields(first("MOVE P1, FINE, ZONE 5").message)
    assert "FINE" not in first("MOVE P1, ZONE 5, ZONE 5").message


def test_a_misspelt_max_is_one_only_as_the_whole_value_of_accel():
    assert "MAX" in fields(first("ACCEL MXA", points=()).hint)
    assert "MAX" in fields(first("MOVE P1, ACCEL MAXX", points=("P1",)).hint)
    assert "MAX" not in fields(first("ACCEL MXA + 1", points=()).hint)
    assert "MAX" not in fields(first("SPEED MXA", points=()).hint)


def test_one_value_is_not_several():
    item = first("CALL up\nEND\nSUB up(x)\nPRINT x\nENDSUB")
    assert (item.code, item.span) == ("RBL214", Span(0, 7))
    assert re.search(r"\b1 value\b", item.message)


def test_a_name_without_a_value_may_be_a_point_of_a_file_that_is_missing():
    text = "MOVE P1 + (0, 0, 5)"
    (missing,) = check(parsed(text), cell_with(points=()).replaced(points_file="a.points.toml"))
    assert (missing.code, missing.span) == ("RBL215", Span(5, 7))
    assert "a.points.toml" in missing.hint
    assert "[points.P1]" in missing.hint
    (taught,) = check(parsed(text), cell_with(points=("A", "B")).replaced(points_file="a.points.toml"))
    assert "a.points.toml" not in taught.hint
