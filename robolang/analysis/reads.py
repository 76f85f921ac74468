"""Which names a program reads."""

from collections.abc import Iterator

from robolang.analysis.facts import parts_of
from robolang.analysis.symbols import names_in
from robolang.syntax.ast import Assign, Call, Const, Dim, If, Node, Program, Statement


def named(program: Program) -> frozenset[str]:
    """Return the names that a program reads, in capitals."""
    return frozenset(key for line in program.statements for node in parts_of(line.statement) for key in reads(node))


def reads(node: Statement) -> Iterator[str]:
    """Yield the names that a statement reads, in capitals; of a one-line IF those of its condition.

    A value that only goes into itself, as in N = N + 1, is not read.
    """
    if isinstance(node, Assign):
        own = "" if isinstance(node.target, Call) else node.target.key
        yield from (key for key in _keys(node.value) if key != own)
    for part in _read_parts(node):
        yield from _keys(part)


def _read_parts(node: Statement) -> tuple[Node, ...]:
    """Return the parts of a statement in which every name is read."""
    if isinstance(node, Assign):
        return node.target.arguments if isinstance(node.target, Call) else ()
    if isinstance(node, If):
        return (node.condition,)
    if isinstance(node, Const):
        return (node.value,)
    return (node.size,) if isinstance(node, Dim) else (node,)


def _keys(node: Node) -> Iterator[str]:
    return (name.key for name in names_in(node))
