"""A statement that was fed: a line of a text of its own, such as that of a prompt."""

from robolang.core.source import Source, Span
from robolang.syntax.ast import Line
from robolang.syntax.parser import parse
from runtime.core.tomlfile import FileFault, FilePlace


class FedLine(Line):
    """A line that is no part of the program; places in it are places of ``source``."""

    __slots__ = ("source",)

    def __init__(self, line: Line, source: Source) -> None:
        super().__init__(
            number=line.number, label=line.label, statement=line.statement, comment=line.comment, span=line.span
        )
        self.source = source


def fed_line(source: Source) -> FedLine:
    """Return the statement of a text; ``FileFault`` at its place for a text that is not one statement."""
    parsed = parse(source)
    if parsed.diagnostics:
        first = parsed.diagnostics[0]
        raise _fault(source, first.span, first.code, first.message, first.hint)
    statements = parsed.program.statements
    if len(statements) != 1:
        span = statements[1].span if statements else source.line_spans[0]
        hint = "Give one statement at a time."
        raise _fault(source, span, "RBL111", f"one statement is expected, the text has {len(statements)}", hint)
    return FedLine(statements[0], source)


def _fault(source: Source, span: Span, code: str, message: str, hint: str) -> FileFault:
    place = source.place(span.start)
    return FileFault(
        code, message, hint, FilePlace(source.path, place.line, place.column, source.line_text(place.line))
    )
