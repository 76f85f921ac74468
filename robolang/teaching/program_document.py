"""Lines of a program, put, changed, inserted and deleted in its text; each edit says where the other lines went.

Lines are physical lines, counted from 1 as an editor shows them, or named by their line number as in BASIC. What is
typed stays as it is until the program is saved through the formatter.
"""

import re
from dataclasses import dataclass, replace
from typing import NoReturn

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.analysis.analysis import Analysis
from robolang.core.source import Source
from robolang.syntax.ast import MAX_NUMBER_DIGITS, Line
from robolang.syntax.formatter import line_end
from robolang.teaching.documents import Documents
from robolang.teaching.line_map import LineMap
from runtime.core.faults import Fault

_NUMBERED = re.compile(r"[ \t]*([0-9]+)(.*)", re.DOTALL)
_LINE_ENDS = re.compile(r"[\r\n]")

Edited = tuple[Documents, LineMap]


def put_line(documents: Documents, text: str, analysis: Analysis | None = None) -> Edited:
    """Put a line with a line number where its number belongs; a number alone deletes the line of that number.

    It replaces the line of its number, or comes before the next higher one and the comments and labels above that.
    ``analysis``: of the program, where it is known. ``Fault`` RBL717: no line of that number, no number, or a program
    without numbers, in which nothing says where the line belongs; RBL114: a number of more than nine digits.
    """
    found = _NUMBERED.fullmatch(text)
    if found is None:
        _no_line(f"{text!r} has no line number", "Begin with a line number.")
    if len(found[1]) > MAX_NUMBER_DIGITS:
        raise Fault("RBL114", f"the line number {found[1][:20]} has more than {MAX_NUMBER_DIGITS} digits")
    lines = (analysis or Analysis(source=documents.source)).program.lines
    number = int(found[1])
    same = next((line for line in lines if line.number == number), None)
    if found[2].strip(" \t"):
        return insert_line(documents, _place(lines, number), text) if same is None else _change(documents, same, text)
    if same is None:
        _no_line(f"there is no line {number}", "List the program for its line numbers.")
    return delete_line(documents, same.source_line)


def insert_line(documents: Documents, before: int, text: str) -> Edited:
    """Insert a line before a physical line; one more than the last line: at the end. ``Fault`` RBL717."""
    rows = _Rows.of(documents)
    if not 1 <= before <= len(rows.lines) + 1:
        _no_line(f"there is no line {before} in a text of {len(rows.lines)} lines")
    return _replaced(documents, rows, (before - 1, before - 1), text)


def change_line(documents: Documents, row: int, text: str) -> Edited:
    """Put a text in place of a physical line; ``Fault`` RBL717."""
    rows = _Rows.of(documents)
    rows.check(row)
    return _replaced(documents, rows, (row - 1, row), text)


def delete_line(documents: Documents, row: int) -> Edited:
    """Delete a physical line; ``Fault`` RBL717."""
    rows = _Rows.of(documents)
    rows.check(row)
    return _replaced(documents, rows, (row - 1, row), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Rows:
    """The physical lines of a text, with their line ends."""

    lines: tuple[str, ...]

    @staticmethod
    def of(documents: Documents) -> "_Rows":
        source: Source = documents.source
        starts = [span.start for span in source.line_spans]
        parts = [source.text[start:end] for start, end in zip(starts, [*starts[1:], len(source.text)], strict=True)]
        # after the last line end there is no line
        return _Rows(lines=tuple(parts if parts[-1] else parts[:-1]))

    def check(self, row: int) -> None:
        if not 1 <= row <= len(self.lines):
            _no_line(f"there is no line {row} in a text of {len(self.lines)} lines")


def _change(documents: Documents, line: Line, text: str) -> Edited:
    return change_line(documents, line.source_line, text)


def _replaced(documents: Documents, rows: _Rows, place: tuple[int, int], text: str | None) -> Edited:
    """Return documents with the lines ``[start, end)`` replaced by one line, or by none."""
    if text is not None and _LINE_ENDS.search(text):
        _no_line("the text has several lines", "Give one line at a time.")
    start, end = place
    ending = line_end(documents.program)
    before, old, after = rows.lines[:start], rows.lines[start:end], rows.lines[end:]
    # the last line of a text may lack its line end
    if before and text is not None and not before[-1].endswith(("\r", "\n")):
        before = (*before[:-1], before[-1] + ending)
    new = () if text is None else (f"{text}{_end(old, ending)}",)
    lines = LineMap(start=_count(before), removed=_count(old), added=_count(new))
    return replace(documents, program="".join((*before, *new, *after))), lines


def _end(old: tuple[str, ...], ending: str) -> str:
    return old[0][len(old[0].rstrip("\r\n")) :] if old else ending


def _count(lines: tuple[str, ...]) -> int:
    return sum(bool(line.strip(" \t\r\n")) for line in lines)


def _place(lines: tuple[Line, ...], number: int) -> int:
    """Return the physical line before which a line of a new number belongs."""
    if not lines:
        return 1
    numbered = [(line.number, at) for at, line in enumerate(lines) if line.number is not None]
    if not numbered and any(line.statement is not None or line.label is not None for line in lines):
        _no_line("the program has no line numbers", "Insert the line before or after another one.")
    # of a program whose numbers do not rise the nearest lower one decides
    lower = max(((each, at) for each, at in numbered if each < number), default=(0, -1))[1]
    higher = next((at for each, at in numbered if each > number and at > lower), None)
    if higher is None:
        return lines[-1].source_line + 1
    above = higher
    while above and _belongs_below(lines[above - 1], lines[above]):
        above -= 1
    # a comment at the top is about the program
    return lines[above or higher].source_line


def _belongs_below(line: Line, below: Line) -> bool:
    """Return whether a line is a comment or a label right above another line."""
    return line.number is None and line.statement is None and line.source_line == below.source_line - 1


def _no_line(message: str, hint: str = "") -> NoReturn:
    raise Fault("RBL717", message, hint)
