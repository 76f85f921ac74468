"""Whatever a program holds: every form is a sound document, every place is in the text, fixes touch nothing else."""

import json
import xml.etree.ElementTree as ET
from pathlib import Path

from hypothesis import example, given
from hypothesis import strategies as st

from robolang.core.diagnostics import MAX_DIAGNOSTICS
from robolang.core.source import Source
from robolang.lint.apply import fix_all
from robolang.lint.engine import Checked, lint
from robolang.lint.reporters import FORMS, render
from runtime.core.faults import lookup
from tests.robolang.helpers import cell_with
from tests.robolang.lint.helpers import POINTS

ROOT = Path("/work/repo")
LINES = [
    "10 MOVE P1",
    "20 MOVE P9 ' noqa",
    "10 MOVE P2, SPEED 1_000",
    "30MOVE P1",
    "MOVE P1 SPEED 20",
    "MOVE Р1 ‘ go",
    "WRIST HOLD TILT, TILT",
    "LOAD (0, 0, 60), -1",
    "HAND ON ' noqa: RBL301, RBL30",
    "REM noqa: unused-suppression",
    "",
    "' noqa: RBL111, RBL111",
    "MOV P1",
    "SEAM OFF",
    "MOVE P1, SPEED 5, speed  5 ' go ' noqa",
    "\u202eMOVE P1",
    "\x1b[2J",
    "MOVE \u200bP1 REM Р",
    "(" * 200,
    'PRINT "Р ‘ 1_0"; P1',
    "FOR I = 1 TO 3",
    "NEXT",
    "GOTO *X",
    "*X MOVE P1",
]
characters = st.sampled_from([*"MOVEP12 ,'()_-:noqa\"", "\u00a0", "é", "Р", "‘", "\ufeff", "\x0b", "\u2028"])
mutated = st.tuples(st.sampled_from(LINES), st.integers(0, 60), st.text(characters, max_size=3)).map(
    lambda parts: parts[0][: parts[1]] + parts[2] + parts[0][parts[1] + 1 :]
)
lines = st.tuples(st.sampled_from(LINES) | mutated, st.sampled_from(["\n", "\n", "\r\n", "\r"])).map("".join)
programs = st.lists(lines, max_size=12).map("".join)


def find(source):
    return lint(source, cell_with(points=POINTS))


@given(programs)
@example("")
@example("' noqa")
@example("MOVE P9 ' noqa: RBL301,,RBL301")
def test_every_finding_has_a_place_in_the_text_and_a_registered_code(text):
    source = Source("pick.rbl", text)
    found = find(source)
    assert len(found) <= MAX_DIAGNOSTICS + 1
    assert list(found) == sorted(found, key=lambda item: item.span)
    for item in found:
        assert lookup(item.code)
        spans = [item.span, *(note.span for note in item.related)]
        spans += [edit.span for edit in (item.fix.edits if item.fix else ())]
        assert all(0 <= span.start <= span.end <= len(text) for span in spans)


@given(programs)
def test_every_form_is_a_sound_document(text):
    source = Source("/work/repo/pick.rbl", text)
    result = Checked(source=source, diagnostics=find(source))
    texts = {form: render(form, [result], ROOT) for form in FORMS}
    for form in ("json", "gitlab", "sarif"):
        json.loads(texts[form])
    count = len(result.diagnostics)
    assert [len(texts[form].splitlines()) for form in ("json-lines", "github")] == [count, count]
    assert texts["concise"].count("\n") == count
    assert len(json.loads(texts["sarif"])["runs"][0]["results"]) == count
    assert len({item["fingerprint"] for item in json.loads(texts["gitlab"])}) == count
    assert len(ET.fromstring(texts["junit"]).findall("testsuite/testcase")) == max(count, 1)
    for form in ("full", "concise", "github"):
        assert "\x1b" not in texts[form]
        assert "\u202e" not in texts[form]


@given(programs)
def test_fixes_come_to_an_end_and_touch_only_lines_with_a_finding(text):
    fixable: set[int] = set()

    def watched(source):
        found = find(source)
        spans = [item.span for item in found if item.fix and item.code != "RBL110"]
        fixable.update(source.place(span.start).line for span in spans)
        return found

    before = Source("pick.rbl", text)
    after = fix_all(before, watched).source
    assert fix_all(after, find).counts == {}
    assert not any(item.fix and item.fix.safe for item in find(after))
    assert len(after.line_spans) == len(before.line_spans)
    numbers = range(1, len(before.line_spans) + 1)
    changed = {line for line in numbers if before.line_text(line) != after.line_text(line)}
    assert changed <= fixable
