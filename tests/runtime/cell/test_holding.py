"""Parts that are heavy for the hand of their cell."""

import math

import pytest

from robolang.project.builtin import cell_text
from runtime.cell.cell_file import parse_cell_file
from runtime.cell.holding import weakness
from runtime.core.tomlfile import Source
from tests.runtime.cell.test_cell import with_cup

MASS = "mass_kg = 1.5"


def doubts(text, mass):
    assert text.count(MASS) == 1
    text = text.replace(MASS, f"mass_kg = {mass}")
    found = parse_cell_file(Source("cell.toml", text)).doubts
    return [(fault.code, text.splitlines()[fault.line - 1]) for fault in found]


@pytest.mark.parametrize(
    ("text", "mass", "code"),
    [
        (with_cup(force="40"), 2.03, None),
        (with_cup(force="40"), 2.05, "RBL646"),
        (with_cup(force="40"), 4.07, "RBL646"),
        (with_cup(force="40"), 4.09, "RBL647"),
        # two pads of 120 N at a friction of 0.6 carry 144 N
        (cell_text(), 7.3, None),
        (cell_text(), 7.4, "RBL646"),
        (cell_text(), 14.6, "RBL646"),
        (cell_text(), 14.7, "RBL647"),
    ],
)
def test_a_part_needs_a_hand_of_twice_its_weight(text, mass, code):
    assert doubts(text, mass) == ([] if code is None else [(code, f"mass_kg = {mass}")])


@pytest.mark.parametrize("numbers", [(math.nan, 1.0, 0.5), (40.0, math.nan, 0.5)])
def test_a_number_that_is_none_is_no_reserve(numbers):
    assert weakness("suction", *numbers)[0] == "RBL647"
