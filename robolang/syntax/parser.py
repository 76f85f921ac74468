"""Parser: program text to syntax tree and diagnostics, in time linear in the text.

Grammar: ``grammar.lark`` (LALR(1)) for what follows the line number of a line,
``line = [digits] [*label] [statement] [comment]``. Lines are parsed one by one, so an error costs exactly its own line,
and every line is checked first for what would make parsing it unsafe: hidden characters, nesting, length. The
tree is built while the parser reduces, without a visitor, so its depth is bounded by ``MAX_DEPTH`` and
nothing recurses.

A line is read by ``line_reader`` and, where it has an error, parsed by Lark (``line_errors``); both have the table that
Lark makes of the grammar, which is part of the package (``grammar``).
"""

import re
from collections.abc import Mapping
from types import MappingProxyType

from robolang.core.diagnostics import HIDDEN, MAX_DIAGNOSTICS, Diagnostic, Severity, in_order
from robolang.core.source import MAX_BYTES, Source, Span
from robolang.syntax import ast
from robolang.syntax.builder import Parsed
from robolang.syntax.line_reader import Stopped, line_reader
from runtime.core.record import Record

# bounds, so that every text is read in time and memory that are known beforehand
MAX_LINE = 10_000
MAX_DEPTH = 100
MAX_OPERATORS = 1000

_HEAD = re.compile(r"[ \t]*+(?:([0-9]++)(?![\w.]))?[ \t]*+")
_STRING = re.compile(r'"[^"\r\n]*+"')
_COMMENT = re.compile(r"'|(?<!\w)REM(?!\w)", re.IGNORECASE)
_NOT = re.compile(r"(?<!\w)NOT(?!\w)", re.IGNORECASE)
_LINE_END = re.compile(r"\r\n?|\n")

ParsedLine = tuple[ast.Line, Diagnostic | None]
"""A line of the tree and why it could not be parsed, if so."""
_NO_LINES: Mapping[int, ParsedLine] = MappingProxyType({})


class ParseResult(Record):
    """The tree of what could be parsed, and the diagnostics by place.

    Lines with an error are in the tree as ``Unparsed``. After ``MAX_DIAGNOSTICS`` errors the rest of the text
    is not read and not in the tree.
    """

    program: ast.Program
    diagnostics: tuple[Diagnostic, ...]


def parse(source: Source, known: Mapping[int, ParsedLine] = _NO_LINES) -> ParseResult:
    """Parse a program; any text gives a result, nothing is raised.

    ``known`` are lines of this text that have been parsed, by the offset at which they begin; they are taken as they
    are. See ``reparse``.
    """
    # characters: the text of an editor was never bytes; those of a file are bounded where it is read
    if len(source.text) > MAX_BYTES:
        message = f"the program has {len(source.text)} characters, more than {MAX_BYTES}"
        problem = Diagnostic(code="RBL106", message=message, span=Span(0, 0))
        return ParseResult(program=ast.Program(source_path=source.path, lines=()), diagnostics=(problem,))
    lines: list[ast.Line] = []
    problems = _mixed_line_ends(source)
    for row, span in enumerate(source.line_spans, start=1):
        text = source.slice(span)
        if not text.strip(" \t"):
            continue
        line, found = known.get(span.start) or _parse_line(text, span, row)
        lines.append(line)
        if found is not None:
            problems.append(found)
            if len(problems) > MAX_DIAGNOSTICS:
                break
    program = ast.Program(source_path=source.path, lines=tuple(lines))
    return ParseResult(program=program, diagnostics=in_order(problems))


def _mixed_line_ends(source: Source) -> list[Diagnostic]:
    first = _LINE_END.search(source.text)
    # without CR all ends are LF: no line needs to be searched
    if first is None or "\r" not in source.text:
        return []
    other = next((end for end in _LINE_END.finditer(source.text) if end[0] != first[0]), None)
    if other is None:
        return []
    message = "this line ends with other characters (LF, CR LF or CR) than the first line"
    return [Diagnostic(code="RBL110", severity=Severity.INFO, message=message, span=Span(other.start(), other.start()))]


def _parse_line(text: str, span: Span, row: int) -> ParsedLine:
    """Parse one line that is not blank; ``text`` is the text of ``span``."""
    head = _HEAD.match(text)
    assert head is not None
    digits, code, base = head[1], text[head.end() :], span.start + head.end()
    number_span = _part(span, span.start + head.start(1), span.start + head.end(1)) if digits else ast.NOWHERE
    parsed = _refusal(text, span.start) or _long_number(digits, number_span) or _parse_statement(code, base, span)
    problem = None
    if isinstance(parsed, Diagnostic):
        problem, parsed = parsed, (None, ast.Unparsed(text=code, span=_part(span, base, span.end)), None)
    line = ast.Line(
        number=int(digits) if digits and len(digits) <= ast.MAX_NUMBER_DIGITS else None,
        label=parsed[0],
        statement=parsed[1],
        comment=parsed[2],
        source_line=row,
        span=span,
        number_span=number_span,
    )
    return line, problem


def _long_number(digits: str | None, span: Span) -> Diagnostic | None:
    """Return RBL114 for a line number with too many digits."""
    if digits is None or len(digits) <= ast.MAX_NUMBER_DIGITS:
        return None
    from robolang.syntax.unexpected import quote

    message = f"the line number {quote(digits)} has more than {ast.MAX_NUMBER_DIGITS} digits"
    return Diagnostic(code="RBL114", message=message, span=span)


def _part(line: Span, start: int, end: int) -> Span:
    """Return a place in a line; the line's own where it is the whole line, which saves memory in long programs."""
    return line if (start, end) == (line.start, line.end) else Span(start, end)


def _refusal(text: str, base: int) -> Diagnostic | None:
    """Return why a line is not parsed at all; None when it may be."""
    if not (text.isascii() and text.isprintable()) and (hidden := HIDDEN.search(text)):
        from robolang.syntax.syntax_errors import suspicious

        return suspicious(hidden[0], base + hidden.start())
    # blanks in place of texts keep the offsets
    plain = _STRING.sub(lambda found: " " * len(found[0]), text) if '"' in text else text
    # a shorter line cannot go beyond a bound, with or without its comment
    comment = _COMMENT.search(plain) if len(text) > MAX_DEPTH else None
    code = plain[: comment.start()] if comment else plain
    if (at := _too_deep(code)) is not None:
        message = f"more than {MAX_DEPTH} nested parentheses or signs"
        return Diagnostic(code="RBL108", message=message, span=Span(base + at, base + at + 1))
    if (operators := sum(map(code.count, "+-*/^"))) > MAX_OPERATORS:
        message = f"{operators} operators in one line, more than {MAX_OPERATORS}"
        return Diagnostic(code="RBL109", message=message, span=Span(base, base + len(code)))
    if len(text) > MAX_LINE:
        message = f"the line has {len(text)} characters, more than {MAX_LINE}"
        return Diagnostic(code="RBL105", message=message, span=Span(base + MAX_LINE, base + len(text)))
    return None


def _too_deep(code: str) -> int | None:
    """Return the offset of the parenthesis, sign or NOT that is nested too deeply."""
    if len(nots := list(_NOT.finditer(code))) > MAX_DEPTH:
        return nots[MAX_DEPTH].start()
    # most lines have too few signs to be too deep: their characters need not be read one by one
    if code.count("(") + code.count("-") + code.count("+") <= MAX_DEPTH:
        return None
    depth = signs = 0
    for offset, character in enumerate(code):
        if character in "+-":
            signs += 1
        elif character not in " \t":
            signs = 0
            depth = max(0, depth + (character == "(") - (character == ")"))
        if depth + signs > MAX_DEPTH:
            return offset
    return None


def _parse_statement(code: str, base: int, line: Span) -> Parsed | Diagnostic:
    """Parse what follows the line number; ``base`` is its offset in the source, ``line`` the place of the line."""
    if not code:
        return None, None, None
    if code[0] == "'":
        text = code.rstrip()
        return None, None, ast.Comment(text=text, span=_part(line, base, base + len(text)))
    reader = line_reader()
    if reader is None:
        from robolang.syntax.line_errors import parsed_by_lark

        return parsed_by_lark(code, base)
    read = reader.read(code, base)
    if not isinstance(read, Stopped):
        return read
    from robolang.syntax.syntax_errors import explain
    from robolang.syntax.unexpected import unexpected

    return explain(unexpected(read.token, read.accepts, code, base))
