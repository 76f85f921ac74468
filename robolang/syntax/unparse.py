"""Canonical text of the tree: keywords in capitals, names and numbers as spelt, one space between words.

What is printed parses back to an equal tree. Parentheses stand where the author wrote them and where the grammar needs
them: an operand without any is put into them when its level is lower than the lowest that its place can hold. The
levels are the rules of ``grammar.lark`` from the loosest to the tightest, ``OR AND NOT = + * -x ^``; a chain is flat,
so an operand of the chain's own level needs parentheses, in front as well: ``(a - b) - c`` is another tree than
``a - b - c``. An exponent is an operand with signs before it, so ``2^-x`` stands as it is and ``2^-(x^3)`` needs them.

Expressions are printed with a stack and not by recursion: parentheses in one another, at most 100, may hold ten levels
each. Used for progress, logs and pulse tables (``describe``), and by the formatter.
"""

from collections.abc import Callable
from enum import Enum
from typing import TypeAlias

from robolang.syntax import ast
from robolang.syntax.ast import Expression, Option, Statement
from robolang.syntax.declaration import Field, Piece, pieces
from robolang.syntax.statements import declaration
from robolang.values.functions import FUNCTIONS

_OR, _AND, _NOT, _COMPARE, _SUM, _PRODUCT, _SIGNED, _POWER, _EXPONENT, _OPERAND = range(10)
_SIGNS = {
    "OR": _OR,
    "XOR": _OR,
    "AND": _AND,
    **dict.fromkeys(("=", "<>", "<", ">", "<=", ">="), _COMPARE),
    "+": _SUM,
    "-": _SUM,
    "*": _PRODUCT,
    "/": _PRODUCT,
    "MOD": _PRODUCT,
    "^": _POWER,
}
_OPERAND_OF = {_OR: _AND, _AND: _NOT, _COMPARE: _SUM, _SUM: _PRODUCT, _PRODUCT: _SIGNED, _POWER: _OPERAND}
"""The lowest level of an operand of a chain, by the level of the chain."""
_QUOTE = '"'

_Piece: TypeAlias = str | tuple[Expression, int]
"""Text, or an expression with the lowest level that its place can hold."""


def print_code(line: ast.Line) -> str:
    """Return the label and the statement of a line; ``""`` when it has neither."""
    label = [] if line.label is None else [f"*{line.label.text}"]
    statement = [] if line.statement is None else [describe(line.statement)]
    return " ".join([*label, *statement])


def describe(statement: Statement | Option) -> str:
    """Return a statement, or an option, as canonical text, such as ``MOVE P1, SPEED 200``.

    The text is the first form of its declaration whose operands all have a value.
    """
    if isinstance(statement, ast.Unparsed):
        return statement.text
    forms = map(pieces, declaration(statement).forms)
    return _filled(next(form for form in forms if _is_whole(form, statement)), statement)


def _is_whole(form: tuple[Piece, ...], node: ast.Node) -> bool:
    """Return whether all operands of a form outside of brackets have a value."""
    return all(not isinstance(piece, Field) or _has(node, piece) for piece in form)


def _has(node: ast.Node, piece: Field) -> bool:
    value = getattr(node, piece.name)
    # a move is whole without options
    return value is not None and (value != () or piece.name == "options")


def _filled(form: tuple[Piece, ...], node: ast.Node) -> str:
    """Return a form with the operands of a statement in their places."""
    text = ""
    for piece in form:
        if isinstance(piece, str):
            text += piece
        elif isinstance(piece, Field):
            text += _operand(node, piece.name)
        # CALL name() keeps its empty parentheses (docs/decisions/0029)
        elif _is_whole(piece, node) or (piece[0] == "(" and getattr(node, "parentheses", False)):
            text += _filled(piece, node)
    return text


def _operand(node: ast.Node, name: str) -> str:
    value = getattr(node, name)
    if name == "options":
        return "".join(f", {describe(option)}" for option in value)
    if isinstance(value, tuple):
        separator = next(each.separator for each in declaration(node).operands if each.name == name)
        return separator.join(map(_part, value))
    return _part(value)


def _part(value: Expression | Statement | ast.Target | Enum) -> str:
    if isinstance(value, Enum):
        return str(value.value)
    if isinstance(value, ast.Target):
        return str(value.number) if value.label is None else f"*{value.label.text}"
    if isinstance(value, ast.Operand):
        return print_expression(value)
    return describe(value)


# --- expressions -----------------------------------------------------------------------------------------------------


def print_expression(expression: Expression) -> str:
    """Return an expression as canonical text, such as ``-(a - b)^2 MOD 3``; in time linear in its size."""
    found: list[str] = []
    stack: list[_Piece] = [(expression, _OR)]
    while stack:
        piece = stack.pop()
        if isinstance(piece, str):
            found.append(piece)
            continue
        node, lowest = piece
        around = node.parentheses or int(_needs_parentheses(node, lowest))
        if around:
            stack += [")" * around, *reversed(_pieces(node, _OR)), "(" * around]
        else:
            stack.extend(reversed(_pieces(node, lowest)))
    return "".join(found)


def _needs_parentheses(node: Expression, lowest: int) -> bool:
    return _level(node) < lowest and not (lowest == _EXPONENT and isinstance(node, ast.Negate))


def _level(node: Expression) -> int:
    match node:
        case ast.Chain():
            # any of the signs: those of one chain have the same level
            return _SIGNS[node.rest[0][0]]
        case ast.Not():
            return _NOT
        case ast.Negate():
            return _SIGNED
        case _:
            return _OPERAND


def _pieces(node: Expression, lowest: int) -> list[_Piece]:
    """Return what an expression consists of, in the order of the text."""
    if isinstance(node, ast.Negate):
        return ["-", (node.operand, _EXPONENT if lowest == _EXPONENT else _SIGNED)]
    return _PIECES[type(node)](node)


def _literal(node: ast.Number | ast.Name) -> list[_Piece]:
    return [node.text]


def _text(node: ast.Text) -> list[_Piece]:
    return [f'"{node.value.replace(_QUOTE, 2 * _QUOTE)}"']


def _not(node: ast.Not) -> list[_Piece]:
    return ["NOT ", (node.operand, _NOT)]


def _call(node: ast.Call) -> list[_Piece]:
    # a function is a word of the language, in capitals; an array keeps the spelling of its author
    word = node.name.key if node.name.key in FUNCTIONS else node.name.text
    return [word, *_list(node.arguments)] if node.arguments else [word]


def _component(node: ast.Component6) -> list[_Piece]:
    return [(node.base, _OPERAND), f".{node.name.key}"]


def _vector(node: ast.Vector) -> list[_Piece]:
    return _list(node.items)


def _chain(node: ast.Chain) -> list[_Piece]:
    level = _level(node)
    operand = _OPERAND_OF[level]
    pieces: list[_Piece] = [(node.first, operand)]
    for sign, value in node.rest:
        pieces += ["^", (value, _EXPONENT)] if level == _POWER else [f" {sign} ", (value, operand)]
    return pieces


def _list(items: tuple[Expression, ...]) -> list[_Piece]:
    pieces: list[_Piece] = ["("]
    for index, item in enumerate(items):
        pieces += [", ", (item, _OR)] if index else [(item, _OR)]
    return [*pieces, ")"]


_PIECES: dict[type, Callable[..., list[_Piece]]] = {
    ast.Number: _literal,
    ast.Name: _literal,
    ast.Text: _text,
    ast.Not: _not,
    ast.Chain: _chain,
    ast.Call: _call,
    ast.Component6: _component,
    ast.Vector: _vector,
}
