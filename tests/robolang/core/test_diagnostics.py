import json
import unicodedata

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robolang.core.diagnostics import (
    MAX_DIAGNOSTICS,
    Diagnostic,
    Related,
    Severity,
    _excerpt,
    has_errors,
    in_order,
    render,
    render_fault,
    safe,
    to_json,
)
from robolang.core.source import Span
from runtime.core.faults import lookup
from runtime.core.tomlfile import FileFault, FilePlace
from tests.campaign import examples
from tests.robolang.helpers import only, source


def at(text, start, end, **more):
    diagnostic = Diagnostic(code="RBL111", message="no", span=Span(start, end), **more)
    return render(diagnostic, source(text)).splitlines()


def test_the_documented_form():
    text = "\n\n30 MOV P1\n"
    found = only(text)
    assert render(found, source(text)) == (
        f"pick.rbl:3:4: error RBL112 {found.message}\n   3 | 30 MOV P1\n     |    ^^^\n  help: {found.hint}"
    )


@pytest.mark.parametrize(
    ("text", "start", "end", "shown", "caret"),
    [
        ("\tMOV", 1, 4, "     1 |     MOV"[2:], "     |     ^^^"),
        ("点点 MOV", 3, 6, "   1 | 点点 MOV", "     |      ^^^"),
        ("点点", 1, 2, "   1 | 点点", "     |   ^^"),
        ("e\u0301x", 2, 3, "   1 | e\u0301x", "     |  ^"),
        ("MOVE", 4, 4, "   1 | MOVE", "     |     ^"),
        ("a\x1b[2Jb\u202ec", 5, 6, "   1 | a\ufffd[2Jb\ufffdc", "     |      ^"),
    ],
)
def test_carets_stand_under_the_place(text, start, end, shown, caret):
    _, line, under, _ = at(text, start, end)
    assert (line, under) == (shown, caret)


def test_a_long_line_is_cut_around_the_place():
    text = "x" * 5000 + "HERE" + "y" * 5000
    _, line, under, _ = at(text, 5000, 5004)
    assert len(line) < 120
    assert line[under.index("^") : under.rindex("^") + 1] == "HERE"
    assert line.endswith("…")


def screen(text):
    """Columns that a text takes on a screen."""
    wide = [2 if unicodedata.east_asian_width(letter) in "WF" else 1 for letter in text]
    return sum(
        0 if unicodedata.category(letter) in ("Mn", "Me", "Cf") else width
        for letter, width in zip(text, wide, strict=True)
    )


PIECES = ("\t", "点", "e\u0301", "\u200b", "\u202e", "\x1b", " ", "MOVE P1 ", "x" * 50)
LINES = st.text(max_size=40) | st.lists(st.sampled_from(PIECES), max_size=60).map("".join)


@given(LINES, st.integers(-3, 400), st.integers(-3, 400))
@examples(200)
@example("x" * 200, 286, 287)  # the place is one of the whole line, the text a part of it
@example("", 0, 0)
@example("\t" * 97, 96, 99)
def test_any_text_and_any_place_give_carets_within_the_excerpt(text, first, last):
    text += "."  # blanks at the end are not shown
    line, under = _excerpt(7, text, first, last)
    gutter = len("   7 | ")
    carets = under.index("^")
    assert (line[:gutter], under[:carets].strip(), set(under[carets:])) == ("   7 | ", "|", {"^"})
    assert gutter <= carets <= screen(line)
    assert len(under) <= screen(line) + 1
    if text.isascii() and text.isprintable() and 0 <= first < len(text):
        assert line[carets] == text[first]


def test_a_span_past_the_end_of_its_line_is_cut():
    _, _, under, _ = at("MOV\nMOVE", 0, 8)
    assert under.count("^") == 3


def test_no_excerpt_of_an_empty_line():
    assert at("", 0, 0) == ["pick.rbl:1:1: error RBL111 no", f"  help: {lookup('RBL111').remedy}"]


def test_related_places_are_shown():
    text = "10 MOVE A\n10 MOVE B"
    lines = at(text, 10, 12, related=(Related(span=Span(0, 2), message="first"),))
    assert lines[0].startswith("pick.rbl:2:1: error")
    assert "  pick.rbl:1:1: note: first" in lines


def test_json_is_plain_and_has_both_ends():
    text = "\n30 MOV P1"
    found = only(text)
    value = to_json(found, source(text))
    assert json.loads(json.dumps(value)) == {
        "code": "RBL112",
        "name": "unknown-instruction",
        "severity": "error",
        "message": found.message,
        "hint": found.hint,
        "file": "pick.rbl",
        "line": 2,
        "column": 4,
        "end_line": 2,
        "end_column": 7,
        "related": [],
    }


def test_a_fault_of_a_file_is_rendered_like_a_diagnostic():
    fault = FileFault("RBL309", "x\x1b", "y", FilePlace("p.toml", 3, 2, " pose = 1"))
    assert render_fault(fault).splitlines() == [
        "p.toml:3:2: error RBL309 x\ufffd",
        "   3 |  pose = 1",
        "     |  ^",
        "  help: y",
    ]


def test_a_code_must_be_registered():
    with pytest.raises(KeyError):
        Diagnostic(code="RBL999", message="", span=Span(0, 0))


def test_only_an_error_is_an_error():
    kinds = {kind: Diagnostic(code="RBL111", severity=kind, message="", span=Span(0, 0)) for kind in Severity}
    assert has_errors(kinds.values())
    assert not has_errors([kinds[Severity.WARNING], kinds[Severity.INFO]])


def test_the_list_is_ordered_and_bounded():
    many = [Diagnostic(code="RBL111", message="", span=Span(i, i)) for i in reversed(range(MAX_DIAGNOSTICS + 5))]
    found = in_order(many)
    assert [item.span.start for item in found] == list(range(MAX_DIAGNOSTICS + 1))
    assert [item.code for item in found[-2:]] == ["RBL111", "RBL107"]


def test_safe_text_keeps_ordinary_characters():
    assert safe("a\tb 点 é") == "a b 点 é"
    assert safe("\x1b\u2066\ud800\u2028\r\n") == "\ufffd" * 6
