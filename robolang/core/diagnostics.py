"""Diagnostics: what is wrong with a program, as values.

Finding one never stops the search for the next. A diagnostic has three views with the same place: the text
below, the object of ``to_json`` and, later, the editor's. Colour is left to the command line.
::

    pick.rbl:3:4: error RBL112 unknown instruction 'MOV'
       3 | 30 MOV P1
         |    ^^^
      help: did you mean MOVE?

Excerpts are safe to print: tabs become spaces, control and direction-changing characters become U+FFFD, wide
characters count two columns, and a long line is cut around the place.
"""

import os
import re
import unicodedata
from collections.abc import Iterable
from enum import Enum
from typing import Any

import robolang.core.codes  # noqa: F401 - every code a diagnostic may carry
from robolang.core.source import Source, Span
from runtime.core.faults import lookup
from runtime.core.record import Record
from runtime.core.tomlfile import FileFault

MAX_DIAGNOSTICS = 1000
_TAB = 4
_WINDOW = 96

HIDDEN = re.compile(
    r"[\x00-\x08\x0a-\x1f\x7f-\x9f\ud800-\udfff\u2028\u2029"  # controls but tab, surrogates, line separators
    r"\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]"  # marks, overrides and isolates of Unicode annex 9
)
"""Characters that steer a terminal or reorder the text around them (CVE-2021-42574)."""


class Severity(Enum):
    """How bad a diagnostic is; only an error keeps a program from running."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


class Related(Record):
    """Another place that explains a diagnostic."""

    span: Span
    message: str


class Edit(Record):
    """One change of the text: what ``span`` covers becomes ``text``; an empty span is an insertion."""

    span: Span
    text: str


class Fix(Record):
    """A correction of a diagnostic: edits that do not overlap, and a title that states what they do.

    ``safe``: there is only one thing the text can have meant, so a program may apply it without asking.
    """

    title: str
    edits: tuple[Edit, ...]
    safe: bool = True


class Diagnostic(Record):
    """One problem of a program: registered code, severity, one-line message, place, what would help.

    Without a hint the remedy of the code is given. ``fix`` is a correction that a tool can apply. ``source`` is the
    text that ``span`` is in, where that is not the program's: the one of a statement that was fed.
    """

    code: str
    severity: Severity = Severity.ERROR
    message: str
    span: Span
    hint: str = ""
    related: tuple[Related, ...] = ()
    fix: Fix | None = None
    source: Source | None = None

    def __post_init__(self) -> None:
        remedy = lookup(self.code).remedy  # KeyError: the code is not registered
        object.__setattr__(self, "hint", self.hint or remedy)


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Return whether any diagnostic is an error."""
    return any(item.severity is Severity.ERROR for item in diagnostics)


def in_order(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the diagnostics by place, at most ``MAX_DIAGNOSTICS`` of them and then RBL107."""
    # by code too, so that the order does not depend on which check comes first
    found = sorted(diagnostics, key=lambda item: (item.span, item.code))
    if len(found) <= MAX_DIAGNOSTICS:
        return tuple(found)
    message = f"more than {MAX_DIAGNOSTICS} problems; the rest is not listed"
    return (
        *found[:MAX_DIAGNOSTICS],
        Diagnostic(code="RBL107", message=message, span=found[MAX_DIAGNOSTICS].span),
    )


def render(diagnostic: Diagnostic, source: Source) -> str:
    """Return the diagnostic as text with an excerpt of the program, without a final line end."""
    head = f"{diagnostic.severity.value} {diagnostic.code} {diagnostic.message}"
    lines = _block(head, diagnostic.source or source, diagnostic.span)
    for other in diagnostic.related:
        lines += [f"  {line}" for line in _block(f"note: {other.message}", source, other.span)]
    lines.append(f"  help: {safe(diagnostic.hint)}")
    if diagnostic.fix is not None:
        lines.append(f"  fix: {safe(diagnostic.fix.title)}")
    return "\n".join(lines)


def render_fault(fault: FileFault, severity: Severity = Severity.ERROR) -> str:
    """Return a fault of a file in the same form as ``render``."""
    # a folder has no lines
    place = fault.path if os.path.isdir(fault.path) else f"{fault.path}:{fault.line}:{fault.column}"  # noqa: PTH112
    lines = [safe(f"{place}: {severity.value} {fault.code} {fault.message}")]
    if fault.excerpt:
        lines += _excerpt(fault.line, fault.excerpt, fault.column - 1, fault.column)
    lines.append(f"  help: {safe(fault.hint)}")
    return "\n".join(lines)


def to_json(diagnostic: Diagnostic, source: Source) -> dict[str, Any]:
    """Return the diagnostic as an object of plain JSON types; the end place is exclusive."""
    return {
        "code": diagnostic.code,
        "name": lookup(diagnostic.code).name,
        "severity": diagnostic.severity.value,
        "message": diagnostic.message,
        "hint": diagnostic.hint,
        **_json_span(diagnostic.span, diagnostic.source or source),
        "related": [{"message": item.message, **_json_span(item.span, source)} for item in diagnostic.related],
    }


def safe(text: str) -> str:
    """Return text that is safe in a terminal: hidden characters replaced, tabs as one space."""
    return HIDDEN.sub("\ufffd", text).replace("\t", " ")


def _json_span(span: Span, source: Source) -> dict[str, object]:
    start, end = source.place(span.start), source.place(span.end)
    return {
        "file": source.path,
        "line": start.line,
        "column": start.column,
        "end_line": end.line,
        "end_column": end.column,
    }


def _block(head: str, source: Source, span: Span) -> list[str]:
    place = source.place(span.start)
    text = source.line_text(place.line)
    first = place.column - 1
    lines = [safe(f"{source.path}:{place.line}:{place.column}: {head}")]
    # a place of several lines is marked on its first one only: the excerpt ends with that line
    return lines + (_excerpt(place.line, text, first, first + span.end - span.start) if text.strip() else [])


def _excerpt(line: int, text: str, first: int, last: int) -> list[str]:
    """Return the line and the line of carets under characters ``[first, last)``, at least one caret.

    A place outside the text is taken for the end that it is nearest to: a text may be shorter than its place says.
    """
    first = min(max(first, 0), len(text))
    begin = max(0, first - _WINDOW // 2) if len(text) > _WINDOW else 0
    end = min(len(text), begin + _WINDOW)
    shown, columns = _columns(text[begin:end])
    left, right = columns[first - begin], columns[min(max(last, first), end) - begin]
    dots = "…" if begin else ""
    gutter = max(4, len(str(line)))
    return [
        f"{line:>{gutter}} | {dots}{shown}{'…' if end < len(text) else ''}".rstrip(),
        f"{'':>{gutter}} | {' ' * (left + len(dots))}{'^' * max(1, right - left)}",
    ]


def _columns(text: str) -> tuple[str, list[int]]:
    """Return the text as shown and the screen column of each character and of the end."""
    shown, columns, column = [], [], 0
    for character in text:
        columns.append(column)
        if character == "\t":
            width = _TAB - column % _TAB
            shown.append(" " * width)
        else:
            shown.append(HIDDEN.sub("\ufffd", character))
            width = _width(shown[-1])
        column += width
    return "".join(shown), [*columns, column]


def _width(character: str) -> int:
    # these are drawn over the character before them, or not at all
    if unicodedata.combining(character) or unicodedata.category(character) in ("Mn", "Me", "Cf"):
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1
