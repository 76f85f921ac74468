"""Conditions that may take another branch than they did: those that depend on inputs, time or errors.

``open_conditions`` returns those that read an input, the time or the error, or a name that is given such a value
somewhere. A condition on numbers of the program alone takes the same branch in every run.
``robolang.interpreter.branch_oracle.Decisions`` forces them.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from robolang.analysis.symbols import names_in
from robolang.core.source import Span
from robolang.syntax.ast import (
    Assign,
    Call,
    CallSub,
    Case,
    Const,
    Expression,
    For,
    Head,
    If,
    Name,
    Program,
    Statement,
    Sub,
    Wait,
)
from robolang.syntax.tree import Node
from robolang.values.functions import FUNCTIONS

_OUTSIDE = frozenset(name for name, function in FUNCTIONS.items() if function.outside)


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """A condition: its ``place`` and source line, and whether it is that of a WAIT."""

    place: Span
    line: int
    wait: bool = False


def open_conditions(program: Program) -> dict[Span, Condition]:
    """Return the conditions of a program that can take either branch in the cell, by place."""
    outside = _from_outside(program)
    return {
        place: Condition(place=place, line=line, wait=wait)
        for place, line, wait, values in _conditions(program)
        if any(_is_outside(node, outside) for node in values)
    }


def _conditions(program: Program) -> Iterator[tuple[Span, int, bool, tuple[Expression, ...]]]:
    """Yield place, line, whether it is a WAIT that may time out, and the values it depends on, of every condition."""
    selected: list[Expression] = []
    for line in program.statements:
        for node in _parts(line.statement):
            if isinstance(node, Head) and node.word == "SELECT":
                selected.append(node.value)
            elif getattr(node, "word", "") == "ENDSELECT" and selected:
                selected.pop()
            elif (condition := _condition(node, selected)) is not None:
                place, values = condition
                yield place, line.source_line, isinstance(node, Wait), values


def _condition(node: Statement, selected: list[Expression]) -> tuple[Span, tuple[Expression, ...]] | None:
    """Return the place of the condition that a statement decides, and the values it depends on; None: it has none."""
    match node:
        case If():
            return node.condition.span, (node.condition,)
        case Wait() if node.timeout is not None:  # without TIMEOUT the program only goes on when it is true
            return node.condition.span, (node.condition,)
        case Head():
            return node.value.span, (node.value,)
        case Case():  # it compares with the value of the innermost SELECT
            return node.span, (*node.values, *selected[-1:])
    return None


def _parts(node: Statement | None) -> Iterator[Statement]:
    if node is None:
        return
    yield node
    if isinstance(node, If):
        yield from _parts(node.then)
        yield from _parts(node.otherwise)


def _from_outside(program: Program) -> frozenset[str]:
    """Return the names that are given a value from outside somewhere, in capitals."""
    into: dict[str, set[str]] = {}
    todo: list[str] = []
    for name, value in _given(program):
        for read in _names(value):
            into.setdefault(read, set()).add(name)
        if _is_outside(value, frozenset()):
            todo.append(name)
    found: set[str] = set()
    while todo:
        name = todo.pop()
        # A = B and B = A lead to one another
        if name not in found:
            found.add(name)
            todo += into.get(name, ())
    return frozenset(found)


def _given(program: Program) -> Iterator[tuple[str, Expression]]:
    """Yield every name that is given a value, and the value; of an array its name."""
    subs = {line.statement.name.key: line.statement for line in program.statements if isinstance(line.statement, Sub)}
    for line in program.statements:
        for node in _parts(line.statement):
            yield from _assignments(node, subs)


def _assignments(node: Statement, subs: Mapping[str, Sub]) -> Iterator[tuple[str, Expression]]:
    match node:
        case Assign(target=Call(name=name) | (Name() as name)):
            yield name.key, node.value
        case Const():
            yield node.name.key, node.value
        case For():
            yield from ((node.variable.key, limit) for limit in (node.first, node.last, node.step) if limit)
        case CallSub() if node.name.key in subs:
            # a wrong number of arguments is an error of the check, which comes before
            parameters = subs[node.name.key].parameters
            yield from zip((name.key for name in parameters), node.arguments, strict=False)


def _is_outside(node: Node, names: frozenset[str]) -> bool:
    return any(key in _OUTSIDE or key in names for key in _names(node))


def _names(node: Node) -> Iterator[str]:
    return (name.key for name in names_in(node))
