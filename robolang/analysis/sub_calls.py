"""Lines that call a SUB of the program as other languages do: their error says how this one does.

A line is parsed by itself, so the parser does not know which subroutines there are.
"""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import replace

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Span
from robolang.syntax.ast import Program, Sub, Unparsed
from robolang.syntax.foreign_calls import called


def with_calls(found: Sequence[Diagnostic], program: Program) -> tuple[Diagnostic, ...]:
    """Return the errors of a program's text; those of calls of its SUBs say to write ``CALL name(values)``."""
    subs = {line.statement.name.key for line in program.lines if isinstance(line.statement, Sub)}
    calls = dict(_calls(program, subs)) if subs else {}
    spans = sorted(calls, key=lambda span: span.start)
    starts = [span.start for span in spans]
    return tuple(_with_call(item, starts, spans, calls) for item in found)


def _calls(program: Program, subs: set[str]) -> Iterator[tuple[Span, str]]:
    """Yield the places of lines that were not parsed and call a SUB, each with its statement."""
    for line in program.lines:
        if isinstance(line.statement, Unparsed):
            call = called(line.statement.text)
            if call is not None and call.name.upper() in subs:
                yield line.span, call.statement


def _with_call(item: Diagnostic, starts: list[int], spans: list[Span], calls: dict[Span, str]) -> Diagnostic:
    index = bisect_right(starts, item.span.start) - 1
    if index < 0 or item.span.start > spans[index].end:
        return item
    return replace(item, hint=f"write {calls[spans[index]]}")
