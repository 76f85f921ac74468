"""Errors of statements at the prompt, found before anything moves, as ``robolang check`` finds those of a program.

The statements are checked where they will run: after the program, with its labels, SUBs and constants, and with the
names that have a value now, also those that only the prompt has given.
"""

from collections.abc import Iterable, Iterator

from robolang.analysis.analysis import Analysis
from robolang.core.diagnostics import Diagnostic, Edit, Severity
from robolang.core.source import Source, Span
from robolang.interpreter.variables import Variables
from robolang.pendant.reading import NAME
from robolang.values.poses import Value


def errors_of(text: str, program: Analysis, variables: Iterable[Variables]) -> tuple[Diagnostic, ...]:
    """Return the errors of statements; their places are in ``text``, which is named ``prompt``."""
    # once each: a name of a SUB may hide one of the main program, and a CONST twice would be an error
    before = "".join(f"\n{line}" for line in dict.fromkeys(_definitions(variables))) + "\n"
    end = len(program.source.text)
    # ``updated`` parses only what is new, so the length of the program does not matter
    combined = program.updated(Edit(span=Span(end, end), text=before + text))
    start = end + len(before)
    source = Source(NAME, text)
    return tuple(
        _at_prompt(item, text, start).replaced(source=source, fix=None)
        for item in combined.diagnostics
        # warnings of flow are about a program that ends here, which the next line of the prompt refutes
        if item.severity is Severity.ERROR and item.span.start >= start
    )


def _at_prompt(item: Diagnostic, text: str, start: int) -> Diagnostic:
    """Return an error at its place in the text that was typed, and with what helps at a prompt."""
    span = Span(item.span.start - start, item.span.end - start)
    # the remedy for a file, to write the point into it, is not that of somebody who has the arm at hand
    hint = f"{item.hint}; at the prompt: teach {text[span.start : span.end]}" if item.code == "RBL301" else item.hint
    return item.replaced(span=span, hint=hint)


def _definitions(variables: Iterable[Variables]) -> Iterator[str]:
    """Yield lines that define the names which have a value, each by a value of its kind."""
    for names in variables:
        for key, value in names.values.items():
            # a constant is one here too, so that an assignment to it is found
            word = "CONST " if key in names.constants else ""
            yield f"{word}{key} = {_of_kind(value)}"
        for key, array in names.arrays.items():
            yield f"DIM {key}({len(array) - 1})"


def _of_kind(value: Value) -> str:
    if isinstance(value, str):
        return '""'
    # of a place only the kind matters here, and HERE needs no name
    return "0" if isinstance(value, float) else "HERE"
