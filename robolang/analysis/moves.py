"""Statements that move the arm, and their options."""

from robolang.syntax.ast import Approach, Depart, Move, MoveC, MoveJ, Moving, Spline

MOVES = (Move, MoveJ, MoveC, Spline, Approach, Depart)


def has_option(node: Moving, *kinds: type) -> bool:
    """Return whether a move has an option of one of some kinds."""
    return any(isinstance(option, kinds) for option in node.options)
