"""Meaning: what is wrong with a program that parses.

Every limit is written so that NaN fails it. What needs the geometry of the arm (reach, the joints along a path)
belongs to the planner and is found before the move that breaks it; here are the limits that hold for every robot, and
the facts of the cell that need no kinematics (``cell_symbols``): its names (taught points, sensors, tools, frames,
loads, inputs), what the arm may carry, how fast its tool may be and the ranges of its joints. Values of numbers alone
are worked out (``evaluator``), so ``SPEED 2 * 50`` is checked like ``SPEED 100``; what depends on a variable is
checked when it runs. Blocks and jumps are checked by ``blocks``; the lint rules are in ``rules``. Most of these follow
the program through its branches and need one without errors, in which one mistake does not look like many; those that
need a single statement are reported beside errors of other lines as well. Time is linear in the program.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from itertools import chain, islice

from robolang.analysis.cell_symbols import NOTHING_KNOWN, CellSymbols
from robolang.analysis.facts import Facts
from robolang.analysis.rounding_check import rounding_check
from robolang.analysis.rules import checks
from robolang.analysis.statement_check import StatementCheck
from robolang.analysis.symbols import Defined
from robolang.core.diagnostics import MAX_DIAGNOSTICS, Diagnostic, Related, Severity, has_errors, in_order
from robolang.core.source import Span
from robolang.syntax.ast import Line, Program, Statement, Unparsed
from robolang.syntax.blocks import Structure
from robolang.syntax.tree import is_deeper
from robolang.syntax.unparse import describe

MAX_LEVELS = 150
"""Deepest tree of a statement: expressions are evaluated by recursion, in at most five calls for a level."""


def check(program: Program, symbols: CellSymbols = NOTHING_KNOWN, facts: Facts | None = None) -> tuple[Diagnostic, ...]:
    """Return what is wrong with a program in its cell, by place.

    ``Unparsed`` statements are left out, the parser has reported them. What is not known of the cell is not checked.
    ``facts`` are those of the program, where they are kept.
    """
    facts = Facts(program) if facts is None else facts
    structure = facts.blocks
    # one more than is kept, so that ``in_order`` can say that there are more
    found = list(
        islice(
            chain(
                _line_numbers(program),
                _emptiness(program),
                structure.diagnostics,
                _statements(program, structure, symbols),
            ),
            MAX_DIAGNOSTICS + 1,
        )
    )
    lints = checks()
    found += _beside(found, chain(rounding_check(program), *(each.find(facts) for each in lints if each.beside_errors)))
    if not has_errors(found) and not any(isinstance(line.statement, Unparsed) for line in program.statements):
        found += chain(*(each.find(facts) for each in lints if not each.beside_errors))
    return in_order(islice(found, MAX_DIAGNOSTICS + 1))


def _beside(found: list[Diagnostic], more: Iterator[Diagnostic]) -> list[Diagnostic]:
    """Return those of ``more`` in whose text nothing else was found: a statement is corrected one thing at a time."""
    starts = sorted(item.span.start for item in found)
    free = (item for item in more if bisect_left(starts, item.span.start) == bisect_right(starts, item.span.end))
    return list(islice(free, MAX_DIAGNOSTICS + 1))


def _statements(program: Program, structure: Structure, symbols: CellSymbols) -> Iterator[Diagnostic]:
    # where blocks are wrong, nobody knows which SUB a line is in: each line sees all names then
    defined = Defined.of(program, {} if structure.diagnostics else structure.owner, structure.lost_subs)
    checks = StatementCheck(symbols, defined)
    # a list: the other uses of a name, which become notes, are known at the end only
    found = list(islice(_each_statement(program, structure, defined, checks), MAX_DIAGNOSTICS + 1))
    for code in ("RBL213", "RBL215"):
        found = defined.missing.noted(found, code)
    yield from found


def _each_statement(
    program: Program, structure: Structure, defined: Defined, checks: StatementCheck
) -> Iterator[Diagnostic]:
    for index, line in enumerate(program.lines):
        if line.statement is None:
            continue
        defined.look_from(structure.owner.get(index))
        if is_deeper(line.statement, MAX_LEVELS):
            message = f"operators and parentheses stand more than {MAX_LEVELS} levels inside one another"
            yield Diagnostic(code="RBL108", message=message, span=line.statement.span)
            continue
        said: set[tuple[str, Span]] = set()  # two rules may check one expression
        for found in checks.check(line.statement):
            if (found.code, found.span) not in said:
                yield _advised(found, line.statement)
            said.add((found.code, found.span))


def _advised(found: Diagnostic, statement: Statement) -> Diagnostic:
    """Return an unknown name of a statement that is a line of another language with the statement to write as help."""
    if found.code != "RBL215" or isinstance(statement, Unparsed):
        return found
    from robolang.syntax import foreign_lines

    text = describe(statement)
    line = foreign_lines.proposal(text)
    # IF ready THEN is a line of several languages, and of this one
    return found if line is None or line.statements == (text,) else found.replaced(hint=line.advice)


def _emptiness(program: Program) -> Iterator[Diagnostic]:
    if not program.statements:
        yield Diagnostic(
            code="RBL201",
            severity=Severity.WARNING,
            message="the program has no instruction: nothing will move",
            span=Span(0, 0),
        )


def _line_numbers(program: Program) -> Iterator[Diagnostic]:
    first: dict[int, Line] = {}
    previous = -1
    for line in program.lines:
        if line.number is None:
            continue
        if other := first.get(line.number):
            related = (Related(span=other.number_span, message="first used here"),)
            message = f"line number {line.number} is used twice"
            yield Diagnostic(code="RBL113", message=message, span=line.number_span, related=related)
        elif line.number < previous:
            message = f"line number {line.number} comes after {previous}"
            yield Diagnostic(code="RBL116", severity=Severity.WARNING, message=message, span=line.number_span)
        first.setdefault(line.number, line)
        # the one above, not the largest so far: one number that is too large is one finding
        previous = line.number
