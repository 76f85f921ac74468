"""Applying fixes to a text.

Fixes of one round do not overlap: they are taken in the order of their places, and one that touches the text of an
earlier one waits for the next round, where the finding has its new place. Rounds go on until no fix is left, at most
``MAX_ROUNDS``.
"""

from bisect import bisect_left, insort
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence

from robolang.core.diagnostics import Diagnostic, Edit
from robolang.core.source import Source, Span
from runtime.core.record import Record, default

# two fixes that undo each other would go on for ever
MAX_ROUNDS = 20


class Fixed(Record):
    """A text after its fixes, and how often each code was fixed."""

    source: Source
    counts: Mapping[str, int] = default(factory=dict)


def fix_all(source: Source, find: Callable[[Source], Iterable[Diagnostic]]) -> Fixed:
    """Return a program with every safe fix of its findings applied; ``find`` is called again after each round."""
    counts: Counter[str] = Counter()
    for _ in range(MAX_ROUNDS):
        codes, edits = _choose(find(source))
        text = edited(source.text, edits)
        if text == source.text:
            break
        source = Source(source.path, text)
        counts.update(codes)
    return Fixed(source=source, counts=dict(sorted(counts.items())))


def edited(text: str, edits: Sequence[Edit]) -> str:
    """Return a text with edits applied; they are in order and do not overlap."""
    parts, at = [], 0
    for edit in edits:
        parts += [text[at : edit.span.start], edit.text]
        at = edit.span.end
    return "".join([*parts, text[at:]])


def _choose(found: Iterable[Diagnostic]) -> tuple[list[str], list[Edit]]:
    """Return the codes of the fixes of one round and their edits in order."""
    codes: list[str] = []
    chosen: list[Edit] = []
    taken: list[Span] = []
    for item in found:
        if item.fix is not None and item.fix.safe and all(_is_free(edit.span, taken) for edit in item.fix.edits):
            # all edits of a fix or none: half a correction is another program
            codes.append(item.code)
            chosen += item.fix.edits
            for edit in item.fix.edits:
                insort(taken, edit.span)
    return codes, sorted(chosen, key=lambda edit: edit.span)


def _is_free(span: Span, taken: Sequence[Span]) -> bool:
    """Return whether a span stays clear of others, which are in order; two insertions at one place do not."""
    # the neighbours are enough, since spans that are taken do not overlap one another
    at = bisect_left(taken, span)
    before, after = taken[at - 1 : at], taken[at : at + 1]
    return all(other.end <= span.start and other.start < span.start for other in before) and all(
        span.end <= other.start and span.start < other.start for other in after
    )
