"""What to write in place of a value of the wrong kind (RBL217): the expression itself, converted where possible."""

import re
from collections.abc import Collection

from robolang.syntax.ast import Chain, Expression, Name, Negate, Text, Vector
from robolang.syntax.keywords import COMPONENTS6
from robolang.syntax.unparse import print_expression
from robolang.values.kinds import Kind

POSE_FORM = "POSE(x, y, z, rx, ry, rz)"
_MANY = 10
"""Names of the cell that are listed at most."""
_LONGEST = 60
"""Characters of an expression that is repeated in a hint; a longer one is described."""


def instead(needed: Kind, node: Expression, kind: Kind) -> str:
    """Return what to write where a value of ``kind`` stands and one of the kind ``needed`` must; ``""``: nothing known.

    An empty answer leaves the remedy of the code itself.
    """
    if needed is Kind.POSE:
        return pose(node)
    if isinstance(node, Vector):
        return f"write {needed}: values in parentheses, separated by commas, are an offset from a pose"
    shown = _shown(node)
    if kind is Kind.POSE:
        component = f"{shown or 'P1'}.X"
        return f"read one number of the pose: {component if needed is Kind.NUMBER else f'STR$({component})'}"
    if needed is Kind.NUMBER:
        return number(node)
    return f"STR$ converts a number to a text: STR$({shown or 'x'})"


def number(node: Expression) -> str:
    """Return what to write in place of a text where a number must stand."""
    if isinstance(node, Text):
        is_number = re.fullmatch(r"\s*[-+]?[0-9]+(\.[0-9]+)?\s*", node.value) is not None
        return f"write {node.value.strip()} without quotes" if is_number else "write a number, without quotes"
    return f"VAL converts a text to the number that it shows: VAL({_shown(node) or 's$'})"


def pose(node: Expression) -> str:
    """Return what to write where a pose must stand."""
    point = f"write the name of a taught point or {POSE_FORM}"
    if isinstance(node, Text) and node.value.isidentifier():
        return f"write the name of a point without quotes: {node.value}"
    if not isinstance(node, Vector):
        return point
    if len(node.items) == 6:
        shown = _shown(node)
        return f"write POSE{shown}, or JOINT(j1, ..., j6) for joint angles" if shown else point
    return f"{point}; an offset follows a pose, as in P1 + {_shown(node) or '(x, y, z)'}"


def of_cell(of: str, names: Collection[str]) -> str:
    """Return what to write after TOOL or FRAME in place of a value that is no pose; ``names``: those of the cell."""
    known = f"; {of}s of the cell: {', '.join(sorted(names))}" if 0 < len(names) <= _MANY else ""
    return f"write a name of the cell file after {of.upper()}, or a pose: {POSE_FORM}{known}"


def offset(moved: Expression, sign: str, other: Expression, kind: Kind | None) -> str:
    """Return how the pose ``moved`` is moved, where a sign and ``other``, which is no offset, follow it."""
    if sign in ("=", "<>", "<", ">", "<=", ">="):
        return "compare the distance between two poses in mm, DIST(P1, P2) < 0.1, or numbers of them, P1.X < P2.X"
    name, shown = _shown(moved) or "P1", _shown(other)
    if kind is Kind.POSE and sign == "*" and isinstance(other, Name):
        # the relative pose of MELFA: all six numbers of the second one, in the first one
        numbers = ", ".join(f"{shown}.{each}" for each in COMPONENTS6)
        return f"write the offset and the turn of {shown} in {name}: {name} * ({numbers})"
    if kind is Kind.POSE:
        values = f"{shown}.X, {shown}.Y, {shown}.Z" if isinstance(other, Name) else "x, y, z"
    else:
        # one number has no direction: the example moves along Z, which most programs mean
        height = shown if shown and not isinstance(other, Text | Chain) else "z"
        values = f"0, 0, {'-' * (sign == '-')}{height}"
    return f"write an offset (x, y, z) in mm after the pose: {name} + ({values})"


def negated(vector: Vector) -> str:
    """Return what to write in place of a minus and an offset."""
    shown = ", ".join(_negative(item) for item in vector.items)
    return f"write + and the negative values: + ({shown})" if len(shown) <= _LONGEST else ""


def _negative(item: Expression) -> str:
    if isinstance(item, Negate):
        return _shown(item.operand)
    text = _shown(Negate(operand=item))
    return "0" if text == "-0" else text


def _shown(node: Expression) -> str:
    """Return an expression as text, ``""`` where it is too long for a hint."""
    text = print_expression(node)
    return text if len(text) <= _LONGEST else ""
