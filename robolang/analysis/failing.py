"""Which statements may fail while a program runs, so that ON ERROR leads to its handler from there.

Moves, calculations that divide or call functions, WAITs that time out without a place to go to, and what needs the
cell. Taken not to fail: names have a value, loads and settings are in their ranges, inputs are those of the cell, CALLs
and GOSUBs are not too many within one another, and memory is enough. All of it is said by ``check``, or rare; with it a
handler would seem to be reached from everywhere.
"""

from robolang.syntax.ast import (
    Assign,
    Block,
    Call,
    CallSub,
    Case,
    Chain,
    Const,
    Delay,
    Expression,
    For,
    Hand,
    Head,
    If,
    Jump,
    Load,
    LoadNamed,
    Name,
    Number,
    OnError,
    Print,
    Seam,
    Setting,
    Statement,
    Sub,
    Wait,
    Word,
    Wrist,
    walk,
)
from robolang.values.functions import FUNCTIONS

_NEVER = (Block, Hand, Jump, Load, LoadNamed, OnError, Seam, Setting, Sub, Wrist)
_WORDS = frozenset({"END", "STOP", "PAUSE", "ON ERROR STOP"})
_COMPUTES = ("+", "-", "*", "AND", "OR", "XOR", "=", "<>", "<", ">", "<=", ">=")
_HARMLESS = frozenset({*_COMPUTES, *(name for name, function in FUNCTIONS.items() if function.always)})
"""Functions and signs that have a value wherever what they are of has one."""


def may_fail(node: Statement) -> bool:
    """Return whether a statement may end in an error that ON ERROR catches."""
    if isinstance(node, If):
        parts = (node.then, *(() if node.otherwise is None else (node.otherwise,)))
        return not _harmless(node.condition) or any(may_fail(part) for part in parts)
    if isinstance(node, Wait):
        return not _harmless(node.condition) or (node.timeout is not None and node.target is None)
    if isinstance(node, Word):
        return node.word not in _WORDS
    return not isinstance(node, _NEVER) and not all(_harmless(each) for each in _asked(node))


def _asked(node: Statement) -> tuple[Expression | None, ...]:
    """Return the expressions of a statement that fails with them only; one that is None fails."""
    if isinstance(node, Assign):
        return (node.value, node.target if isinstance(node.target, Name) else None)
    if isinstance(node, Const | Head):
        return (node.value,)
    if isinstance(node, Delay):
        return (node.seconds,)
    if isinstance(node, For):
        return (node.first, node.last, *(() if node.step is None else (node.step if _number(node.step) else None,)))
    if isinstance(node, Case):
        return ()  # asked by its SELECT
    return node.items if isinstance(node, Print) else node.arguments if isinstance(node, CallSub) else (None,)


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
