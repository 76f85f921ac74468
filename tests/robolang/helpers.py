"""Short ways to parse a text and to say what was found where."""

from robolang.analysis.cell_symbols import CellSymbols
from robolang.analysis.checker import check
from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Source
from robolang.syntax.ast import Line, Program
from robolang.syntax.parser import parse
from robolang.syntax.unparse import print_code


def cell_with(*, rated_payload_kg=None, inputs=None, loads=None, **names) -> CellSymbols:
    """Facts of a cell: what it may carry, kg, and the names that it has, in any case; others are not known."""
    return CellSymbols(
        rated_payload=rated_payload_kg,
        inputs=None if inputs is None else frozenset(inputs),
        loads=None if loads is None else dict.fromkeys(name.upper() for name in loads),
        **{kind: None if known is None else frozenset(map(str.upper, known)) for kind, known in names.items()},
    )


def print_line(line: Line) -> str:
    """One line as canonical text without a line end."""
    number = [] if line.number is None else [str(line.number)]
    comment = [] if line.comment is None else [line.comment.text]
    return " ".join([*number, *filter(None, [print_code(line)]), *comment])


def print_program(program: Program) -> str:
    """The lines of a program as canonical text; without indentation, and blank lines are not kept."""
    return "".join(f"{print_line(line)}\n" for line in program.lines)


Found = list[tuple[str, int, int, int]]


def source(text: str) -> Source:
    return Source("pick.rbl", text)


def places(text: str, diagnostics: tuple[Diagnostic, ...]) -> Found:
    """Code, line, column and length of each diagnostic."""
    where = source(text)
    found = []
    for item in diagnostics:
        place = where.place(item.span.start)
        found.append((item.code, place.line, place.column, item.span.end - item.span.start))
    return found


def parsed(text: str) -> Program:
    """The tree of a text that has no diagnostic."""
    result = parse(source(text))
    assert result.diagnostics == ()
    return result.program


def parse_found(text: str) -> Found:
    return places(text, parse(source(text)).diagnostics)


def only(text: str) -> Diagnostic:
    """The one diagnostic of a text."""
    (diagnostic,) = parse(source(text)).diagnostics
    return diagnostic


def checked(
    text: str, points: tuple[str, ...] | None = None, rated: float | None = None, sensors: tuple[str, ...] | None = None
) -> Found:
    return places(text, check(parsed(text), cell_with(points=points, rated_payload_kg=rated, sensors=sensors)))
