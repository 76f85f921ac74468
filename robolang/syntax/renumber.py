"""New line numbers for a program, and no other change: the text is edited at its numbers, not printed anew.

Every line with a statement, a label or a number gets ``start``, ``start + step`` and so on; a comment alone and a blank
line stay without one. Line numbers after GOTO, GOSUB, ON ERROR GOTO and WAIT ... GOTO follow the line they name, also
in a one-line IF. Labels, comments, spelling and spacing are untouched, so a comment that names a line still names the
old one, and ``robolang fmt`` puts the columns right.

Refused, with nothing changed: a program that has errors in its text (a jump might hide there), one in which two lines
have the same number (RBL113) or a target names no line (RBL202), and a result that the language would not read any
more. Time is linear in the text.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from robolang.core.diagnostics import Diagnostic, Related, has_errors, in_order
from robolang.core.source import Source, Span
from robolang.syntax.ast import MAX_NUMBER_DIGITS, Line, Program, Target
from robolang.syntax.blocks import targets
from robolang.syntax.formatter import outgrown
from robolang.syntax.parser import MAX_LINE, ParseResult, parse
from robolang.syntax.unexpected import quote
from runtime.core.faults import Fault

MAX_NUMBER = 10**MAX_NUMBER_DIGITS - 1

_Edit = tuple[Span, str]
"""A place of the text, and what comes to stand there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RenumberResult:
    """The text with new numbers; with an error among the diagnostics, the old one.

    ``lines``: how many lines got another number, or none; ``targets``: how many jumps were changed to follow.
    """

    text: str
    changed: bool
    diagnostics: tuple[Diagnostic, ...]
    lines: int = 0
    targets: int = 0


def renumber(source: Source, *, start: int = 10, step: int = 10, parsed: ParseResult | None = None) -> RenumberResult:
    """Number the lines of a program; ``Fault`` RBL703 when a number would have more than nine digits.

    ``parsed``: the result of the parser for the source, where it is known.
    """
    program, problems = _read(source, parsed)
    if has_errors(problems):
        return RenumberResult(text=source.text, changed=False, diagnostics=problems)
    counted = [line for line in program.lines if (line.number, line.label, line.statement) != (None, None, None)]
    last = start + step * max(0, len(counted) - 1)
    if last > MAX_NUMBER:
        message = f"the last of {len(counted)} lines would have the number {last}, more than {MAX_NUMBER}"
        raise Fault("RBL703", message, "Take a smaller start or step.")
    numbers = [str(start + step * index) for index in range(len(counted))]
    moved = {line.number: new for line, new in zip(counted, numbers, strict=True) if line.number is not None}
    of_lines = [_numbered(line, new) for line, new in zip(counted, numbers, strict=True)]
    return _edited(source, problems, of_lines, _followed(program, moved))


def remove_numbers(source: Source, parsed: ParseResult | None = None) -> RenumberResult:
    """Remove the numbers of all lines that no jump leads to; ``parsed`` as of ``renumber``."""
    program, problems = _read(source, parsed)
    if has_errors(problems):
        return RenumberResult(text=source.text, changed=False, diagnostics=problems)
    named = {target.number for target in _targets(program)}
    free = [line for line in program.lines if line.number is not None and line.number not in named]
    return _edited(source, problems, [_unnumbered(line, source.text) for line in free], [])


def _read(source: Source, parsed: ParseResult | None) -> tuple[Program, tuple[Diagnostic, ...]]:
    """Return a program and why it cannot be renumbered, if so."""
    parsed = parse(source) if parsed is None else parsed
    if has_errors(parsed.diagnostics):
        return parsed.program, parsed.diagnostics
    first: dict[int, Line] = {}
    problems = list(parsed.diagnostics)
    for line in parsed.program.lines:
        if line.number is not None and first.setdefault(line.number, line) is not line:
            related = (Related(span=first[line.number].number_span, message="the first one"),)
            message = f"the line number {line.number} is given twice"
            problems.append(Diagnostic(code="RBL113", message=message, span=line.number_span, related=related))
    for target in _targets(parsed.program):
        if target.number not in first:
            message = f"there is no line number {quote(source.slice(target.span))} to go to"
            problems.append(Diagnostic(code="RBL202", message=message, span=target.span))
    return parsed.program, in_order(problems)


def _targets(program: Program) -> Iterator[Target]:
    """Yield the targets that are line numbers, in the order of the text."""
    for line in program.lines:
        yield from (target for target in targets(line.statement) if target.number is not None)


def _followed(program: Program, moved: Mapping[int, str]) -> list[_Edit]:
    # each of them is there: ``_read`` refuses a target that names no line
    return [(target.span, moved[target.number]) for target in _targets(program) if target.number is not None]


def _numbered(line: Line, new: str) -> _Edit:
    """Return the edit that gives a line a number: in place of the old one, or in front of all."""
    if line.number is not None:
        return line.number_span, new
    return Span(line.span.start, line.span.start), f"{new} "


def _unnumbered(line: Line, text: str) -> _Edit:
    """Return the edit that takes the number of a line away, and one blank after it."""
    # one blank belongs to the number; further ones are the indent
    end = line.number_span.end
    return Span(line.number_span.start, end + (text[end : end + 1] in (" ", "\t"))), ""


def _edited(
    source: Source, notes: tuple[Diagnostic, ...], of_lines: list[_Edit], of_targets: list[_Edit]
) -> RenumberResult:
    """Return the text with the edits made, unless the language would not read it any more."""
    of_lines, of_targets = (
        [(span, new) for span, new in edits if source.slice(span) != new] for edits in (of_lines, of_targets)
    )
    parts, at = [], 0
    # edits do not overlap, so one pass makes them all
    for span, new in sorted([*of_lines, *of_targets]):
        parts += [source.text[at : span.start], new]
        at = span.end
    text = "".join([*parts, source.text[at:]])
    # longer numbers may make the text or a line larger than the parser takes
    if (problem := outgrown(text) or _too_long(source, text)) is not None:
        return RenumberResult(text=source.text, changed=False, diagnostics=(problem, *notes))
    return RenumberResult(
        text=text, changed=text != source.text, diagnostics=notes, lines=len(of_lines), targets=len(of_targets)
    )


def _too_long(source: Source, text: str) -> Diagnostic | None:
    """Return RBL105 for the first line that its number makes too long."""
    after = Source(source.path, text).line_spans
    for old, new in zip(source.line_spans, after, strict=True):
        if (length := new.end - new.start) > MAX_LINE:
            message = f"with its new number the line would have {length} characters, more than {MAX_LINE}"
            return Diagnostic(code="RBL105", message=message, span=old)
    return None
