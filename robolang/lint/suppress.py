"""Suppression of findings in the program itself: ``' noqa`` at the end of a line's comment.

::

    10 MOVE P9              ' noqa                       every finding of the line but errors of syntax
    20 MOVE P9              ' not taught yet ' noqa: RBL301
    30 REM noqa: RBL113, line-number-order

The word stands right after a ``'`` or ``REM``, in any case, and only a colon and codes or names follow it. An
error of syntax is suppressed by its whole code only. What suppresses nothing is RBL190, with a fix that removes it,
unless its code needs the cell or the motion; what is no code is RBL191. A line may keep either by naming it.

Only the last ``noqa`` of a line counts, so the time is linear in the text whatever it contains.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice

from robolang.core.diagnostics import MAX_DIAGNOSTICS, Diagnostic, Edit, Fix, Severity
from robolang.core.source import Source, Span
from robolang.lint.selection import guess, is_syntax_error, words
from runtime.core.faults import lookup
from runtime.core.record import Record

UNUSED, UNKNOWN = "RBL190", "RBL191"

_WORD = "noqa"
_NOQA = re.compile(_WORD, re.IGNORECASE)
_MARK = re.compile(r"(?:'|(?<!\w)REM(?=[ \t]))[ \t]*+\Z", re.IGNORECASE)
_FORGOTTEN_COLON = re.compile(r"[ \t]+RBL\d", re.IGNORECASE)
_ITEM = re.compile(r"[^\s,]+")
# the mark is searched in this many characters before the word, so that a line of spaces takes linear time
_NEAR_MARK = 64
# a word may be as long as a line, 10,000 characters
_SHOWN = 30


class _Named(Record):
    """One word after ``noqa:``; ``code`` is empty when it is not a code."""

    span: Span
    text: str
    code: str


class _Directive(Record):
    """One ``noqa``: from its ``'`` or ``REM`` to the end of the line.

    ``named`` are its codes, None when it has no colon; ``mistake``: why it has no effect.
    """

    span: Span
    named: tuple[_Named, ...] | None = None
    mistake: str = ""

    def covers(self, diagnostic: Diagnostic) -> bool:
        """Return whether it suppresses a finding of its line."""
        if self.named is None:
            return not is_syntax_error(diagnostic)
        return self.names(diagnostic.code)

    def names(self, code: str) -> bool:
        """Return whether it names a code."""
        return any(item.code == code for item in self.named or ())


def suppress(source: Source, found: Iterable[Diagnostic], *, complete: bool) -> tuple[Diagnostic, ...]:
    """Return the findings that no ``noqa`` covers, and those about the noqas themselves.

    ``complete``: everything was checked; otherwise no noqa is reported as unused, and neither is one in a program with
    an error of syntax.
    """
    findings = tuple(found)
    directives = _directives(source)
    if not directives:
        return findings
    kept, used = _split(source, findings, directives)
    complete = complete and not any(map(is_syntax_error, findings))
    for line, directive in directives.items():
        # more are never listed, and a file full of noqas would make hundreds of thousands
        if len(kept) > MAX_DIAGNOSTICS:
            break
        kept += islice(_unknown(directive), MAX_DIAGNOSTICS)
        if complete:
            kept += _unused(directive, used.get(line, set()), source)
    return tuple(kept)


def add_later(source: Source, before: Iterable[Diagnostic], later: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return findings of ``suppress`` with later ones of the same text that no ``noqa`` covers.

    A ``noqa`` without codes that was reported as unused before, and covers a later finding, is not unused.
    """
    directives = _directives(source)
    kept, used = _split(source, later, directives)
    for item in before:
        directive = directives.get(source.place(item.span.start).line)
        needed = item.code == UNUSED and directive is not None and directive.named is None
        if not (needed and source.place(item.span.start).line in used):
            kept.append(item)
    return tuple(kept)


def _split(
    source: Source, findings: Iterable[Diagnostic], directives: Mapping[int, _Directive]
) -> tuple[list[Diagnostic], dict[int, set[str]]]:
    """Return the findings that no directive covers, and the codes of the others by line."""
    kept: list[Diagnostic] = []
    used: dict[int, set[str]] = {}
    for item in findings:
        line = source.place(item.span.start).line
        directive = directives.get(line)
        if directive is not None and directive.covers(item):
            used.setdefault(line, set()).add(item.code)
        else:
            kept.append(item)
    return kept, used


def _directives(source: Source) -> dict[int, _Directive]:
    """Return the directive of each line that has one."""
    last: dict[int, int] = {}
    for word in _NOQA.finditer(source.text):
        # a later word of a line takes the place of an earlier one
        last[source.place(word.start()).line] = word.start()
    known = words()
    found = ((line, _directive(source, source.line_spans[line - 1], at, known)) for line, at in last.items())
    return {line: directive for line, directive in found if directive is not None}


def _directive(source: Source, line: Span, at: int, known: Mapping[str, str]) -> _Directive | None:
    """Return the directive whose word stands at an offset; None when the word is only part of a comment."""
    end = at + len(_WORD)
    begin = max(line.start, at - _NEAR_MARK)
    mark = _MARK.search(source.text[begin:at])
    if mark is None:
        return None
    span = Span(begin + mark.start(), line.end)
    tail = source.text[end : line.end]
    if not tail.strip():
        return _Directive(span=span)
    # the author believes the finding suppressed, so this is reported and not taken for a remark
    if _FORGOTTEN_COLON.match(tail):
        return _Directive(span=span, named=(), mistake="this noqa suppresses nothing: it has no colon before its codes")
    if not tail.lstrip().startswith(":"):
        return None
    named = tuple(_named(item, end, known) for item in _ITEM.finditer(tail, tail.index(":") + 1))
    return _Directive(span=span, named=named, mistake="" if named else "this noqa names no code")


def _named(item: re.Match[str], base: int, known: Mapping[str, str]) -> _Named:
    span = Span(base + item.start(), base + item.end())
    return _Named(span=span, text=item[0], code=known.get(item[0].upper(), ""))


def _unknown(directive: _Directive) -> Iterator[Diagnostic]:
    if directive.names(UNKNOWN):
        return
    if directive.mistake:
        yield _warning(UNKNOWN, directive.mistake, directive.span)
    for item in directive.named or ():
        if not item.code:
            shown = item.text if len(item.text) <= _SHOWN else f"{item.text[:_SHOWN]}…"
            yield _warning(
                UNKNOWN,
                f"noqa names '{shown}', which is not a code",
                item.span,
                hint=guess(item.text),
            )


def _unused(directive: _Directive, used: set[str], source: Source) -> Iterator[Diagnostic]:
    """Yield the finding about the codes that a directive names without effect, if there are any."""
    if directive.mistake or directive.names(UNUSED):
        return
    if directive.named is None:
        if not used:
            yield _warning(UNUSED, "this noqa suppresses nothing", directive.span, fix=_removal(directive, source))
        return
    # a directive is judged as a whole: one finding, whose fix keeps the codes that are needed
    left = _needed(directive.named, used)
    idle = [item for item in directive.named if item not in left]
    if not idle:
        return
    message = f"noqa of {', '.join(item.code for item in idle)} suppresses nothing"
    if left:
        yield _warning(UNUSED, message, idle[0].span, fix=_reduction(directive.named, left))
    else:
        yield _warning(UNUSED, message, directive.span, fix=_removal(directive, source))


def _needed(named: Iterable[_Named], used: set[str]) -> list[_Named]:
    """Return the items of a directive that stay: those with effect, each code once, and those not to be judged here."""
    left: list[_Named] = []
    for item in named:
        # an unknown code has a finding of its own; where a finding is not certain, its absence says nothing
        needed = item.code in used or item.code in (UNKNOWN, "") or not lookup(item.code).is_certain
        repeats = item.code != "" and any(item.code == other.code for other in left)
        if needed and not repeats:
            left.append(item)
    return left


def _reduction(named: Sequence[_Named], left: Iterable[_Named]) -> Fix:
    """Return the fix that keeps some of the codes that a directive names."""
    edit = Edit(span=Span(named[0].span.start, named[-1].span.end), text=", ".join(item.text for item in left))
    return Fix(title=f"keep {edit.text} only", edits=(edit,))


def _removal(directive: _Directive, source: Source) -> Fix:
    """Return the fix that removes a directive and the space before it."""
    line = source.line_spans[source.place(directive.span.start).line - 1]
    before = source.text[line.start : directive.span.start].rstrip(" \t")
    edit = Edit(span=Span(line.start + len(before), line.end), text="")
    return Fix(title="remove the noqa", edits=(edit,))


def _warning(code: str, message: str, span: Span, *, hint: str = "", fix: Fix | None = None) -> Diagnostic:
    return Diagnostic(code=code, severity=Severity.WARNING, message=message, span=span, hint=hint, fix=fix)
