"""Which statements may fail while a program runs, so that ON ERROR leads to its handler from there.

Moves, calculations that divide or call functions, WAITs that time out without a place to go to, and what needs the
cell. Taken not to fail: names have a value, loads and settings are in their ranges, inputs are those of the cell, CALLs
and GOSUBs are not too many within one another, and memory is enough. All of it is said by ``check``, or rare; with it a
handler would seem to be reached from everywhere.
"""

from robolang.syntax.ast import Call, Chain, Expression, For, If, Name, Number, Statement, Unparsed, Wait, walk
from robolang.syntax.declaration import Fails, Operand, Role
from robolang.syntax.statements import declaration
from robolang.values.functions import FUNCTIONS

_COMPUTES = ("+", "-", "*", "AND", "OR", "XOR", "=", "<>", "<", ">", "<=", ">=")
_HARMLESS = frozenset({*_COMPUTES, *(name for name, function in FUNCTIONS.items() if function.always)})
"""Functions and signs that have a value wherever what they are of has one."""


def may_fail(node: Statement) -> bool:
    """Return whether a statement may end in an error that ON ERROR catches."""
    match node:
        case If():
            parts = [part for part in (node.then, node.otherwise) if part is not None]
            return not _harmless(node.condition) or any(map(may_fail, parts))
        case Wait():
            # the end of TIMEOUT is an error only where no line takes it
            return not _harmless(node.condition) or (node.timeout is not None and node.target is None)
        case Unparsed():
            return True
        case _:
            return _as_declared(node)


def _as_declared(node: Statement) -> bool:
    declared = declaration(node)
    if declared.fails is Fails.OPERANDS:
        return not all(_harmless(each) for operand in declared.operands for each in _computed(node, operand))
    return declared.fails is Fails.ALWAYS


def _computed(node: Statement, operand: Operand) -> tuple[Expression | None, ...]:
    """Return the expressions of an operand; one that is None fails."""
    value = getattr(node, operand.name)
    if operand.role is Role.ASSIGNED:
        return () if isinstance(value, Name) else (None,)  # an index may be out of range
    if operand.role is not Role.VALUE or value is None:
        return ()
    if isinstance(node, For) and operand.name == "step":
        return (value if _number(value) else None,)  # STEP 0 fails
    return value if operand.separator else (value,)


def _number(node: Expression) -> bool:
    return any(isinstance(each, Number) and each.value != 0.0 for each in walk(node))


def _harmless(node: Expression | None) -> bool:
    """Return whether an expression has a value wherever its names have one."""
    if node is None:
        return False
    for each in walk(node):
        if isinstance(each, Call) and each.name.key not in _HARMLESS:
            return False
        if isinstance(each, Chain) and not all(sign in _HARMLESS for sign, _ in each.rest):
            return False
    return True
