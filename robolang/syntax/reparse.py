"""Parsing again after an edit: only the lines that it changes; the others keep their trees, moved to their new places.

A line is parsed by itself (``parser``), so its tree depends on its text alone. A line before the edit is the same
object as before. A line after it is copied with other places, in a third of the time that parsing it takes.
"""

from dataclasses import fields
from typing import Any, NamedTuple

from robolang.core.diagnostics import Diagnostic, Edit, Fix, Related
from robolang.core.source import Source, Span
from robolang.syntax import tree
from robolang.syntax.ast import NOWHERE, Line, Node, Unparsed
from robolang.syntax.parser import ParsedLine, ParseResult, parse
from robolang.syntax.tree import is_deeper

MAX_LEVELS = 60
"""Deepest tree that is moved, since moving recurses; a line with a deeper one is parsed again."""
_NO_LINE = frozenset({"RBL106", "RBL107", "RBL110"})
"""Codes of the whole text; every other diagnostic of the parser belongs to one line that it could not parse."""

_FIELDS: dict[type, tuple[str, ...]] = {}


def reparse(before: ParseResult, was: Source, now: Source, edit: Edit) -> ParseResult:
    """Return what ``parse(now)`` returns, where ``edit`` made ``now`` of ``was``, whose result was ``before``."""
    problems = {was.place(item.span.start).line: item for item in before.diagnostics if item.code not in _NO_LINE}
    move = _Move(
        edit=edit,
        now=now,
        by=len(edit.text) - (edit.span.end - edit.span.start),
        rows=len(now.line_spans) - len(was.line_spans),
    )
    known: dict[int, ParsedLine] = {}
    for line in before.program.lines:
        problem = problems.get(line.source_line)
        if isinstance(line.statement, Unparsed) and problem is None:
            continue  # there were more problems than are kept
        if (kept := move.of(line, problem)) is not None:
            known[kept[0].span.start] = kept
    return parse(now, known)


class _Move(NamedTuple):
    """What an edit does to the lines around it: those after it move by characters and by rows."""

    edit: Edit
    now: Source
    by: int
    rows: int

    def of(self, line: Line, problem: Diagnostic | None) -> ParsedLine | None:
        """Return a line and its problem where the edit leaves them; None where the line must be parsed again."""
        if line.span.end <= self.edit.span.start:
            # an insertion right at its end belongs to the line, which is longer then
            return (line, problem) if _is_line(self.now, line.source_line, line.span) else None
        if line.span.start < self.edit.span.end:
            return None
        there = Span(line.span.start + self.by, line.span.end + self.by)
        if not _is_line(self.now, line.source_line + self.rows, there):
            return None
        if line.statement is not None and is_deeper(line.statement, MAX_LEVELS):
            return None
        return _moved_line(line, self.by, self.rows), problem and _moved(problem, self.by)


def _is_line(source: Source, row: int, span: Span) -> bool:
    """Return whether a row of a text is a span: the edit may have joined CR and LF, or parted them."""
    return 0 < row <= len(source.line_spans) and source.line_spans[row - 1] == span


def _moved_line(line: Line, by: int, rows: int) -> Line:
    moved: Line = _moved(line, by)
    # not by assignment, which type checkers refuse for a Final
    object.__setattr__(moved, "source_line", line.source_line + rows)
    return moved


def _moved(value: Any, by: int) -> Any:
    """Return a value with every place in it moved; what has no place is the same object.

    ``replace`` would run the constructor of every node again, which takes longer.
    """
    if isinstance(value, Span):
        # NOWHERE is no place: moved, it would become one
        return value if value is NOWHERE else Span(value.start + by, value.end + by)
    if isinstance(value, tuple):
        return tuple([_moved(each, by) for each in value])
    if not isinstance(value, Node | Diagnostic | Related | Fix | Edit):
        return value
    kind = type(value)
    if kind not in _FIELDS:
        _FIELDS[kind] = tree.fields(kind) if issubclass(kind, Node) else tuple(item.name for item in fields(kind))
    twin = object.__new__(kind)
    for name in _FIELDS[kind]:
        object.__setattr__(twin, name, _moved(getattr(value, name), by))
    return twin
