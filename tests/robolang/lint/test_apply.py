"""Fixes applied to texts."""

from robolang.core.diagnostics import Diagnostic, Edit, Fix
from robolang.core.source import Source, Span
from robolang.lint.apply import MAX_ROUNDS, edited, fix_all


def finding(*edits, code="RBL115", safe=True):
    """A finding with a fix, from ``(start, end, text)``."""
    fix = Fix(title="do it", safe=safe, edits=tuple(Edit(span=Span(a, b), text=text) for a, b, text in edits))
    return Diagnostic(code=code, message="", span=Span(0, 0), fix=fix)


def once(*items):
    """Give the findings in the first round and none after it."""
    rounds = iter([items])
    return lambda source: next(rounds, ())


def test_edits_are_applied_at_their_places():
    edits = [Edit(span=Span(0, 1), text="X"), Edit(span=Span(2, 2), text="--"), Edit(span=Span(3, 5), text="")]
    assert edited("abcdefg", edits) == "Xb--cfg"
    assert edited("abc", []) == "abc"


def test_fixes_of_one_round_do_not_touch_each_other():
    done = fix_all(Source("x", "abcdef"), once(finding((0, 3, "1")), finding((2, 4, "2")), finding((3, 4, "3"))))
    assert done.source.text == "13ef"
    assert done.counts == {"RBL115": 2}


def test_a_fix_is_applied_whole_or_not_at_all():
    done = fix_all(Source("x", "abcdef"), once(finding((2, 4, "2")), finding((0, 1, "1"), (3, 5, "1"), code="RBL118")))
    assert done.source.text == "ab2ef"
    assert done.counts == {"RBL115": 1}


def test_two_insertions_at_one_place_wait_for_each_other():
    done = fix_all(Source("x", "ab"), once(finding((1, 1, "1")), finding((1, 1, "2"))))
    assert done.source.text == "a1b"


def test_an_unsafe_fix_is_not_applied():
    done = fix_all(Source("x", "ab"), once(finding((0, 1, ""), safe=False)))
    assert (done.source.text, done.counts) == ("ab", {})


def test_rounds_end_when_nothing_changes():
    asked = []

    def find(source):
        asked.append(source.text)
        return [finding((0, 1, source.text[0].upper()))]

    assert fix_all(Source("x", "ab"), find).source.text == "Ab"
    assert asked == ["ab", "Ab"]


def test_rounds_that_would_never_end_are_ended():
    done = fix_all(Source("x", ""), lambda source: [finding((0, 0, "a"))])
    assert done.source.text == "a" * MAX_ROUNDS
    assert done.counts == {"RBL115": MAX_ROUNDS}
