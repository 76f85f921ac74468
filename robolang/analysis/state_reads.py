"""Statements that read what changes while the robot moves: before them, all motion ends."""

from robolang.syntax.ast import Call, Component6, Node
from robolang.syntax.tree import walk
from robolang.values.functions import FUNCTIONS

_READS = frozenset(name for name, function in FUNCTIONS.items() if function.changes)


def reads_state(node: Node | None) -> bool:
    """Return whether a statement or expression reads an input, the time, or where the robot or a point is."""
    if node is None:
        return False
    return any(
        (isinstance(each, Call) and each.name.key in _READS) or isinstance(each, Component6) for each in walk(node)
    )
