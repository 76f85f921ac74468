"""Which findings have a fix, and what it makes of the text."""

from itertools import pairwise

import pytest

from robolang.core.diagnostics import Diagnostic, Edit, Fix
from robolang.core.source import Source, Span
from robolang.lint.apply import edited, fix_all
from robolang.lint.engine import lint
from robolang.lint.fixes import with_fix
from tests.robolang.helpers import cell_with
from tests.robolang.lint.helpers import POINTS, found


def fixed(text):
    return fix_all(Source("pick.rbl", text), lambda source: lint(source, cell_with(points=POINTS))).source.text


def codes(text):
    return [item.code for item in found(text)]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        # RBL103
        ("10 MOVE P1 ‘ go ‘ slowly’\n", "10 MOVE P1 ' go ‘ slowly’\n"),
        ("10 МОVЕ Р1\n", "10 MOVE P1\n"),
        ("１０ MOVE P１\n", "10 MOVE P1\n"),
        ("10\u00a0MOVE\u00a0P1,\u2003SPEED 20\n", "10 MOVE P1, SPEED 20\n"),
        ("10 LOAD (0, 0, −60), 0.8\n", "10 LOAD (0, 0, -60), 0.8\n"),
        ("10 MOVE \u200bP1\n", "10 MOVE P1\n"),
        ("\ufeffMOVE P1\n\ufeffMOVE P2\n", "MOVE P1\nMOVE P2\n"),
        ("10 MOVE Р1 REM Р1\n", "10 MOVE P1 REM Р1\n"),
        ("10 MOVE Р1 ' Р1\n", "10 MOVE P1 ' Р1\n"),
        # RBL110
        ("MOVE P1\r\nMOVE P2\nMOVE P3\rMOVE P4", "MOVE P1\r\nMOVE P2\r\nMOVE P3\r\nMOVE P4"),
        ("MOVE P1\nMOVE P2\r\n", "MOVE P1\nMOVE P2\n"),
        # RBL111
        ("MOVE P1 SPEED 20\n", "MOVE P1, SPEED 20\n"),
        ("move p1  accel 20 time 3 ' go\n", "move p1,  accel 20, time 3 ' go\n"),
        ("MOVE P1 WRIST HOLD TILT ADVANCE\n", "MOVE P1, WRIST HOLD TILT, ADVANCE\n"),
        ("*L WAIT IN(1) TIMEOUT 5 GOTO *L\n", "*L WAIT IN(1), TIMEOUT 5, GOTO *L\n"),
        # RBL115
        ("MOVE P1, SPEED 1_000\n", "MOVE P1, SPEED 1000\n"),
        ("MOVE P1, SPEED 1_000.5\n", "MOVE P1, SPEED 1000.5\n"),
        ("10MOVE P1\n", "10 MOVE P1\n"),
        ("  10hand on\n", "  10 hand on\n"),
        ("MOVE P1 SPEED 1_000\n", "MOVE P1, SPEED 1000\n"),
        # RBL118
        ("MOVE P1, SPEED 20, speed  20, TIME 2\n", "MOVE P1, SPEED 20, TIME 2\n"),
        ("WRIST HOLD TILT, tilt\n", "WRIST HOLD TILT\n"),
    ],
)
def test_what_is_certain_is_corrected(before, after):
    if "SPEED 20" in after and "TIME" in after:
        assert "RBL119" in codes(after)
    else:
        assert codes(after) == []
    assert fixed(before) == after


@pytest.mark.parametrize(
    "text",
    [
        "10 MOV P1\n",  # RBL112: the nearest word may be another motion
        "10 MOVEP1\n",
        "MOVE P1, SPEED 20mm\n",  # RBL115: a unit may be the wrong one
        "MOVE P1, SPEED 1.0.0\n",
        "MOVE P1, SPEED 1__0\n",
        "MOVE P1, SPEED _1\n",
        "10X P1\n",
        "MOVE 10MOVE\n",
        "MOVE P1 P2\n",  # RBL111
        "MOVE P1; SPEED 20\n",
        "MOVE é1\n",  # RBL103: no plain twin
        "MOVE P1 ' \u202e\n",
        "MOVE P1, SPEED 20, SPEED 30\n",  # RBL118: which one?
        "10 MOVE P1\n10 MOVE P2\n",  # RBL113
        "MOVE P9\n",  # RBL301
        "LOAD (0, 0, 60), -1\n",  # RBL401
    ],
)
def test_what_is_not_certain_is_left_alone(text):
    assert found(text)
    assert all(item.fix is None for item in found(text))
    assert fixed(text) == text


def test_a_fix_has_a_title_and_shows_in_the_finding():
    (item,) = found("MOVE P1, SPEED 1_000\n")
    assert item.fix == Fix(title=item.fix.title, edits=(Edit(span=Span(15, 20), text="1000"),))
    assert found("MOVE\u200b P1\n")[0].fix.title


def test_a_finding_that_brings_its_fix_keeps_it():
    own = Fix(title="own", edits=())
    item = Diagnostic(code="RBL115", message="", span=Span(0, 5), fix=own)
    assert with_fix(item, Source("x", "1_000")).fix is own


@pytest.mark.parametrize("emptied", ["' noqa: RBL111", "\u200b\u200b"])
def test_a_line_between_cr_and_lf_is_not_emptied(emptied):
    text = f"10 MOVE P1\n20 MOVE P2 ' noqa\r{emptied}\n"
    assert fixed(text) == text
    assert fixed(text.replace("\r", "\n")) == "10 MOVE P1\n20 MOVE P2\n\n"


def test_edits_of_one_fix_are_in_order_and_apart():
    for text in ("МОVЕ Р1\n", "MOVE P1\r\nMOVE P2\nMOVE P3\n"):
        edits = found(text)[0].fix.edits
        assert len(edits) > 0
        assert all(one.span.end <= other.span.start for one, other in pairwise(edits))
        assert edited(text, edits) == fixed(text)
