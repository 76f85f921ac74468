"""``' noqa`` in programs."""

import pytest

from robolang.core.diagnostics import MAX_DIAGNOSTICS, Diagnostic
from robolang.core.source import Source, Span
from robolang.lint.apply import fix_all
from robolang.lint.engine import lint
from robolang.lint.suppress import add_later
from tests.messages import fields
from tests.robolang.helpers import cell_with
from tests.robolang.lint.helpers import POINTS, found, layer, marked, places, selection


def fixed(text):
    return fix_all(Source("pick.rbl", text), lambda source: lint(source, cell_with(points=POINTS))).source.text


@pytest.mark.parametrize(
    "comment",
    [
        "' noqa",
        "'noqa",
        "' NOQA",
        "'   noqa  ",
        "' not taught yet ' noqa",
        "REM noqa",
        "rem NoQA",
        "' see REM noqa",
        "' noqa: RBL301",
        "' noqa:RBL301",
        "' noqa : rbl301",
        "' noqa: point-undefined",
        "'' noqa: RBL301",
        "' to do ' noqa: RBL301",
        "REM noqa: RBL301",
        "' noqa noqa ' noqa: RBL301",
    ],
)
def test_a_finding_is_suppressed(comment):
    assert places(f"10 MOVE P9 {comment}\n") == []


@pytest.mark.parametrize(
    "comment",
    [
        "",
        "' no qa",
        "' noqa please",
        "' noqas",
        "' the noqa",
        "' noqa'",
        "REM noqas",
        "' noqaRBL301",
        "' noqa;",
        "' XREM noqa",
    ],
)
def test_other_comments_suppress_nothing(comment):
    assert [code for code, *_ in places(f"10 MOVE P9 {comment}\n")] == ["RBL301"]


def test_only_its_own_line_is_suppressed():
    assert places("MOVE P8\nMOVE P9 ' noqa\nMOVE P7\n") == [("RBL301", 1, 6), ("RBL301", 3, 6)]


def test_only_the_codes_that_are_named_are_suppressed():
    text = "10 MOVE P1\n10 MOVE P9 ' noqa: RBL113\n"
    assert places(text) == [("RBL301", 2, 9)]
    assert places(text.replace("RBL113", "RBL113, RBL301")) == []
    assert places(text.replace("RBL113", "RBL113 RBL301")) == []


def test_an_error_of_syntax_is_suppressed_by_its_whole_code_only():
    assert places("10 MOV P1 ' noqa\n") == [("RBL112", 1, 4)]
    assert places("10 MOV P1 ' noqa: RBL112\n") == []
    assert places("10 MOV P1 ' noqa: unknown-instruction\n") == []
    assert places("10 MOV P1 ' noqa: RBL1\n") == [("RBL112", 1, 4), ("RBL191", 1, 19)]


def test_what_suppresses_nothing_is_unused():
    assert places("10 MOVE P1 ' noqa\n") == [("RBL190", 1, 12)]
    assert places("10 MOVE P1 ' go ' noqa: RBL301\n") == [("RBL190", 1, 17)]
    assert marked("10 MOVE P1 ' go ' noqa: RBL301\n", "RBL190") == ["' noqa: RBL301"]


def test_of_several_codes_the_unused_ones_are_named():
    text = "10 MOVE P9 ' noqa: RBL113, RBL301, RBL212\n"
    (item,) = found(text)
    assert {"RBL113", "RBL212"} <= fields(item.message)
    assert marked(text, "RBL190") == ["RBL113"]


def test_a_code_that_is_named_twice_is_unused_the_second_time():
    assert fixed("MOVE P9 ' noqa: RBL301, point-undefined\n") == "MOVE P9 ' noqa: RBL301\n"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("10 MOVE P1 ' noqa\n", "10 MOVE P1\n"),
        ("10 MOVE P1\t' noqa: RBL301  \nMOVE P2\n", "10 MOVE P1\nMOVE P2\n"),
        ("10 MOVE P1 ' go ' noqa\n", "10 MOVE P1 ' go\n"),
        ("10 MOVE P1 REM noqa\r\nMOVE P2\r\n", "10 MOVE P1\r\nMOVE P2\r\n"),
        ("MOVE P1\n10 ' noqa\n", "MOVE P1\n10\n"),
        ("MOVE P1\n' noqa", "MOVE P1\n"),
        ("MOVE P9 ' noqa: RBL113, RBL301, RBL212\n", "MOVE P9 ' noqa: RBL301\n"),
        ("MOVE P9 ' noqa: point-undefined RBL212\n", "MOVE P9 ' noqa: point-undefined\n"),
        ("MOVE P9 ' noqa: nothing, RBL212\n", "MOVE P9 ' noqa: nothing\n"),
        ("MOVE P1 ' noqa ' noqa\n", "MOVE P1\n"),
    ],
)
def test_an_unused_one_is_removed_by_the_fix(before, after):
    assert fixed(before) == after


def test_what_is_no_code_is_said():
    text = "10 MOVE P9 ' noqa: RBL30, RBL301, zzz\n"
    assert places(text) == [("RBL191", 1, 20), ("RBL191", 1, 35)]
    first, second = found(text)
    assert "RBL30" in fields(first.message)
    assert {"RBL301", "RBL302"} <= fields(first.hint)
    assert "noqa" in second.hint
    assert first.fix is None


@pytest.mark.parametrize("comment", ["' noqa:", "' noqa: ,", "' noqa RBL301"])
def test_a_noqa_that_is_none_is_said(comment):
    text = f"10 MOVE P9 {comment}\n"
    assert places(text) == [("RBL301", 1, 9), ("RBL191", 1, 12)]


def test_a_line_may_keep_either_finding_by_naming_it():
    assert places("MOVE P1 ' noqa: RBL190\n") == []
    assert places("MOVE P1 ' noqa: RBL301, RBL190\n") == []
    assert places("MOVE P9 ' noqa: RBL30, RBL301, RBL191\n") == []


def test_findings_about_suppressions_are_selected_like_all_others():
    text = "MOVE P1 ' noqa\nMOVE P9 ' noqa: RBL30\n"
    chosen = places(text, selection=selection(layer(ignore=["RBL190", "unknown-suppression"])))
    assert chosen == [("RBL301", 2, 6)]


def test_a_finding_that_is_not_selected_still_uses_its_suppression():
    assert places("MOVE P9 ' noqa: RBL301\n", selection=selection(layer(select=["RBL1"]))) == []


def test_with_an_error_of_syntax_nothing_is_called_unused():
    assert places("MOVE P1 ' noqa\nMOV P2\n") == [("RBL112", 2, 1)]
    assert places("MOVE P1 ' noqa\nMOV P2 ' noqa: RBL112\n") == []


def test_without_the_points_nothing_is_called_unused():
    source = Source("pick.rbl", "MOVE P1 ' noqa: RBL301\n")
    assert lint(source, complete=False) == ()
    assert [item.code for item in lint(source, cell_with(points=POINTS))] == ["RBL190"]


@pytest.mark.parametrize("code", ["RBL412", "RBL402", "RBL534", "wrist-singularity"])
def test_a_code_that_needs_the_cell_or_the_motion_is_not_called_unused(code):
    assert places(f"MOVE P1 ' noqa: {code}\n") == []
    assert fixed(f"MOVE P1 ' noqa: RBL301, {code}\n") == f"MOVE P1 ' noqa: {code}\n"


def test_what_is_found_later_is_suppressed_as_well():
    source = Source("pick.rbl", "MOVE P1 ' noqa\nMOVE P2 ' noqa: RBL412, RBL30\nMOVE P3\nMOVE P4 ' noqa\n")
    before = lint(source, cell_with(points=POINTS))
    assert [item.code for item in before] == ["RBL190", "RBL191", "RBL190"]
    later = [Diagnostic(code="RBL412", message="", span=Span(at, at + 1)) for at in (0, 15, 45)]
    found = sorted(add_later(source, before, later), key=lambda item: item.span)
    assert [(item.code, source.place(item.span.start).line) for item in found] == [
        ("RBL191", 2),
        ("RBL412", 3),
        ("RBL190", 4),
    ]


def test_the_findings_about_suppressions_are_bounded():
    many = found("' noqa: " + " ".join(f"x{i}" for i in range(2000)) + "\n")
    assert len(many) == MAX_DIAGNOSTICS + 1
    assert many[-1].code == "RBL107" or many[-1].code == "RBL191"


def test_long_words_are_cut_in_the_message():
    (_, item) = found(f"MOVE P9 ' noqa: {'x' * 500}\n")
    assert len(item.message) < 80
