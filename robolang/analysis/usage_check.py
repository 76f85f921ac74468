"""What is never used, may never end, or is never shown: unread values, WAITs without TIMEOUT, texts in single quotes.

Taught points that nothing names are found with ``named``; their finding stands in the points file (``lint.engine``).
"""

import re
from collections.abc import Iterator

from robolang.analysis.symbols import names_in
from robolang.core import limits
from robolang.core.diagnostics import Diagnostic, Related, Severity
from robolang.evaluation.constant_folding import fixed
from robolang.syntax import other_languages
from robolang.syntax.ast import Assign, Call, Const, Dim, For, If, Name, Node, Print, Program, Statement, Wait
from robolang.syntax.blocks import Structure
from robolang.syntax.keywords import near

MAX_SHOWN = 60
"""Longest text that a remedy repeats, in characters."""
_QUOTED = re.compile(r"'([^'\"]+)'[ \t]*")


def wait_check(program: Program) -> Iterator[Diagnostic]:
    """Report WAITs without a TIMEOUT (RBL223) and WAITs for a number (RBL233), as warnings."""
    for line in program.statements:
        for node in _statements(line.statement):
            if isinstance(node, Wait) and (value := fixed(node.condition)):
                delay = f"DELAY {value:g} waits for {value:g} s" if 0.0 < value <= limits.DELAY.high else ""
                message = f"WAIT {value:g} waits for nothing: its condition is a number that is not 0"
                yield Diagnostic(code="RBL233", severity=Severity.WARNING, span=node.span, message=message, hint=delay)
            elif isinstance(node, Wait) and node.timeout is None:
                yield Diagnostic(
                    code="RBL223",
                    severity=Severity.WARNING,
                    span=node.span,
                    message="this WAIT has no TIMEOUT: where its signal never comes, the program stands here for ever",
                )


def quote_check(program: Program) -> Iterator[Diagnostic]:
    """Report PRINTs without a value that a text in single quotes follows, a comment (RBL234), as warnings."""
    for line in program.statements:
        comment = line.comment
        quoted = None if comment is None else _QUOTED.fullmatch(comment.text)
        if comment is None or quoted is None:
            continue
        *_, last = _statements(line.statement)
        if isinstance(last, Print) and not last.items:
            yield Diagnostic(
                code="RBL234",
                severity=Severity.WARNING,
                span=comment.span,
                message="this is a comment, not a text: PRINT shows an empty line",
                hint=f'write PRINT "{quoted[1]}"' if len(quoted[1]) <= MAX_SHOWN else "",
            )


def loop_check(program: Program, structure: Structure) -> Iterator[Diagnostic]:
    """Report FORs that count with the variable of a FOR around them (RBL235), as warnings.

    Called for programs without errors.
    """
    for line, heads in zip(program.lines, structure.inside, strict=True):
        node = line.statement
        if not isinstance(node, For):
            continue
        around = (program.lines[head].statement for head in reversed(heads))
        loops = (each for each in around if isinstance(each, For))
        outer = next((each for each in loops if each.variable.key == node.variable.key), None)
        if outer is not None:
            message = f"{node.variable.text} counts a FOR around this one: its value there is lost"
            related = (Related(span=outer.variable.span, message=f"{outer.variable.text} counts here"),)
            yield Diagnostic(
                code="RBL235", severity=Severity.WARNING, span=node.variable.span, message=message, related=related
            )


def usage_check(program: Program) -> Iterator[Diagnostic]:
    """Report values and arrays that nothing reads (RBL225), as warnings; called for programs without errors."""
    given: dict[str, Name] = {}
    read: set[str] = set()
    for line in program.statements:
        for node in _statements(line.statement):
            name = _gives(node)
            if name is not None:
                given.setdefault(name.key, name)
            read.update(_reads(node))
    for key, name in given.items():
        if key not in read:
            guess, elsewhere = near(key, read), other_languages.assigned(key)
            yield Diagnostic(
                code="RBL225",
                severity=Severity.WARNING,
                span=name.span,
                message=f"nothing reads {name.text}",
                hint=f"did you mean {guess}?" if guess else elsewhere,
            )


def named(program: Program) -> frozenset[str]:
    """Return the names that a program reads, in capitals."""
    return frozenset(key for line in program.statements for node in _statements(line.statement) for key in _reads(node))


def _statements(node: Statement | None) -> Iterator[Statement]:
    if isinstance(node, If):
        yield node
        yield from _statements(node.then)
        yield from _statements(node.otherwise)
    elif node is not None:
        yield node


def _gives(node: Statement) -> Name | None:
    """Return the name that a statement gives a value, an array's among them; not that of a FOR, which counts."""
    if isinstance(node, Assign):
        return node.target if isinstance(node.target, Name) else None
    return node.name if isinstance(node, Const | Dim) else None


def _reads(node: Statement) -> Iterator[str]:
    """Yield the names that a statement reads; a value that only goes into itself, as in N = N + 1, is not read."""
    if isinstance(node, If):
        yield from _keys(node.condition)
    elif isinstance(node, Assign):
        own = "" if isinstance(node.target, Call) else node.target.key
        yield from (key for key in _keys(node.value) if key != own)
        if isinstance(node.target, Call):
            yield from (key for argument in node.target.arguments for key in _keys(argument))
    elif isinstance(node, Const):
        yield from _keys(node.value)
    elif isinstance(node, Dim):
        yield from _keys(node.size)
    else:
        yield from _keys(node)


def _keys(node: Node) -> Iterator[str]:
    return (name.key for name in names_in(node))
