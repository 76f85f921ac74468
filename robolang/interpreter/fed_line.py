"""Statements that were fed: lines of a text of its own, such as that of a prompt.

One statement, or several lines that are whole statements and blocks. Their indices lie below 0 and end before
``AFTER_FED``, so that the next line is one more in either text, and loops, branches and returns work as in a program.
"""

from collections.abc import Sequence
from functools import cached_property

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Source, Span
from robolang.syntax.ast import Line, Program, Sub
from robolang.syntax.blocks import Structure, structure_of
from robolang.syntax.parser import parse
from runtime.core.tomlfile import FileFault, FilePlace

AFTER_FED = -1
"""Where what was fed goes on after its last line: the place that it has suspended."""


class FedLine(Line):
    """A line that is no part of the program; places in it are places of ``source``."""

    __slots__ = ("source",)

    def __init__(self, line: Line, source: Source) -> None:
        super().__init__(
            number=line.number, label=line.label, statement=line.statement, comment=line.comment, span=line.span
        )
        self.source = source


class Fed:
    """The lines of a text that was fed, by their indices from ``first`` to -2; a value."""

    def __init__(self, lines: Sequence[Line]) -> None:
        self.lines = tuple(lines)
        self.first = AFTER_FED - len(self.lines)
        self._program = Program(source_path="", lines=self.lines)

    @cached_property
    def structure(self) -> Structure:
        """The blocks of the text, by places from 0."""
        return structure_of(self._program)

    def line(self, at: int) -> Line:
        """Return the line of an index."""
        return self.lines[at - self.first]

    def end(self, at: int) -> int:
        """Return the index of the line that closes the block of a line."""
        return self.structure.end[at - self.first] + self.first

    def after(self, at: int) -> int:
        """Return the index of the next line of the block of a line."""
        return self.structure.after[at - self.first] + self.first

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fed) and self.lines == other.lines

    def __hash__(self) -> int:
        return hash(self.lines)


def fed(source: Source) -> Fed:
    """Return the statements of a text; ``FileFault`` at its place for a text that is not whole statements.

    Of several lines none may have a line number, a label or a SUB: nothing outside of the text could lead there.
    """
    parsed = parse(source)
    if parsed.diagnostics:
        raise _refused(source, parsed.diagnostics[0])
    statements = parsed.program.statements
    if not statements:
        hint = "Give a statement, such as MOVE P1."
        raise _fault(source, source.line_spans[0], "RBL111", "a statement is expected, the text has none", hint)
    found = Fed([FedLine(line, source) for line in statements])
    if len(statements) > 1:
        for line in statements:
            _check(source, line)
        # of one statement the machine refuses a block: it is typed often, and needs no tables
        wrong = [each for each in found.structure.diagnostics if each.code in _OF_BLOCKS]
        if wrong:
            raise _refused(source, wrong[0])
    return found


_OF_BLOCKS = ("RBL108", "RBL211", "RBL212", "RBL219")
"""What can be wrong with blocks; where jumps lead is known in the program alone."""


def fed_line(source: Source) -> FedLine:
    """Return the one statement of a text; ``FileFault`` at its place for a text that is not one statement."""
    first, *others = fed(source).lines
    if others:
        hint = "Give one statement at a time."
        count = len(others) + 1
        raise _fault(source, others[0].span, "RBL111", f"one statement is expected, the text has {count}", hint)
    assert isinstance(first, FedLine)
    return first


def _check(source: Source, line: Line) -> None:
    what = "a SUB" if isinstance(line.statement, Sub) else "a label" if line.label is not None else "a line number"
    if isinstance(line.statement, Sub) or line.label is not None or line.number is not None:
        hint = "Write it into the program, or give the lines without it."
        raise _fault(source, line.span, "RBL111", f"{what} cannot be given at a prompt: nothing leads there", hint)


def _refused(source: Source, found: Diagnostic) -> FileFault:
    return _fault(source, found.span, found.code, found.message, found.hint)


def _fault(source: Source, span: Span, code: str, message: str, hint: str) -> FileFault:
    place = source.place(span.start)
    return FileFault(
        code, message, hint, FilePlace(source.path, place.line, place.column, source.line_text(place.line))
    )
