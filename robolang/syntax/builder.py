"""From the rules of ``grammar.lark`` to the nodes of the tree: what is called when a rule is reduced.

The parser calls these while it reads, so no parse tree is built and nothing is visited afterwards. Every node gets the
place of its text. The automaton of ``line_reader`` calls them, and Lark for a line with an error.

A rule that is named like its node, as ``on_error`` of ``OnError``, needs no method: its node is built of the operands
of its declaration. Rules with methods hold words with a meaning, options, or parentheses that are remembered.
"""

import re
from collections.abc import Callable, Iterable
from sys import intern
from typing import Any

from robolang.core.source import Span
from robolang.syntax import ast
from robolang.syntax.ast import Expression, replace
from robolang.syntax.declaration import Declaration
from robolang.syntax.statements import BY_NODE
from robolang.syntax.tokens import Token, span_of

Parsed = tuple[ast.Name | None, ast.Statement | None, ast.Comment | None]
"""Label, statement and comment of a line."""

_Head = tuple[Token, tuple[Expression, ...], Expression | Token]


def _over(first: Token | ast.Node, last: Token | ast.Node) -> Span:
    """Return the place from the start of one token or node to the end of another."""
    if first is last:
        return first.span if isinstance(first, ast.Node) else span_of(first)
    start, end = (item.span if isinstance(item, ast.Node) else span_of(item) for item in (first, last))
    return Span(start.start, end.end)


_NODES = {
    "named_load": "LoadNamed",
    "tool": "Setting",
    "one_line": "If",
    "if_head": "Head",
    "else_if": "Head",
    "while_head": "Head",
    "select_head": "Head",
    "for_head": "For",
    "closing": "Block",
}
"""The nodes of rules that have another name, as several rules of one node must."""
_BY_RULE = {
    **{re.sub("(?<=.)([A-Z])", r"_\1", node).lower(): node for node, each in BY_NODE.items() if each[0].operands},
    **_NODES,
}


def _from_declaration(node: str) -> Callable[..., Any]:
    """Return what builds a node of the parts of its rule: operands in the order of the declaration, the optional last.

    Signs and words within the statement are no operands. A list is the last operand and takes all that are left.
    """
    declared: Declaration = BY_NODE[node][0]
    kind: Any = getattr(ast, node)
    names = [operand.name for operand in declared.operands]
    rest = names.pop() if declared.operands and declared.operands[-1].separator else ""
    has_word = "word" in kind.__slots__

    def build(*parts: Token | ast.Node | None) -> Any:
        found = [part for part in parts if part is not None]
        # Lark's tokens are texts, too, and so are those of line_reader
        operands = [part for part in found if not isinstance(part, str)]
        # not strict: optional operands that are left out are the last ones
        fields: dict[str, Any] = dict(zip(names, operands, strict=False))
        if rest:
            fields[rest] = tuple(operands[len(names) :])
        if has_word:
            # the kind, not the text: in capitals, however the word is written
            fields["word"] = str(found[0].type)  # type: ignore[union-attr]
        return kind(**fields, span=_over(found[0], found[-1]))

    return build


class _Builder:
    """What builds the nodes, by the names of the rules, called with what the parts of a rule gave."""

    def __getattr__(self, rule: str) -> Callable[..., Any]:
        if rule not in _BY_RULE:
            # rules that only group have no method: the tables are made by ``hasattr``
            raise AttributeError(rule)
        return _from_declaration(_BY_RULE[rule])

    def start(self, label: ast.Name | None, statement: ast.Statement | None, comment: Token | None) -> Parsed:
        if comment is None:
            return label, statement, None
        # the token goes on to the end of the line, blanks included
        text, at = comment.rstrip(), span_of(comment).start
        return label, statement, ast.Comment(text=text, span=Span(at, at + len(text)))

    def label(self, star: Token, name: Token) -> ast.Name:
        return ast.Name(text=intern(str(name)), span=_over(star, name))

    # --- motion ------------------------------------------------------------------------------------------------------

    def head(self, word: Token, *values: Expression | Token) -> _Head:
        # the parentheses of SPLINE are no operands; the last one ends the statement
        return word, tuple(value for value in values if isinstance(value, ast.Node)), values[-1]

    def moving(self, head: _Head, *parts: ast.Option | list[Token] | Token) -> ast.Moving:
        word, values, last = head
        options = _options(parts)
        span = _over(word, options[-1] if options else last)
        if word.type == "MOVE":
            return ast.Move(target=values[0], options=options, span=span)
        if word.type == "MOVEJ":
            return ast.MoveJ(target=values[0], options=options, span=span)
        if word.type == "MOVEC":
            return ast.MoveC(via=values[0], target=values[1], options=options, span=span)
        if word.type == "SPLINE":
            return ast.Spline(points=values, options=options, span=span)
        if word.type == "APPROACH":
            return ast.Approach(target=values[0], distance=values[1], options=options, span=span)
        return ast.Depart(distance=values[0], options=options, span=span)

    def hand(self, word: Token, state: Token, dwell: Expression | None) -> ast.Hand:
        return ast.Hand(state=ast.HandState[state.type], dwell=dwell, span=_over(word, dwell or state))

    def wrist(self, word: Token, mode: Token) -> ast.Wrist:
        return ast.Wrist(mode=ast.WristMode[mode.type], span=_over(word, mode))

    def hold(self, *words: Token) -> list[Token]:
        return list(words)

    def holding(self, hold: list[Token], *more: Token) -> ast.Wrist:
        return _holding([*hold, *more])

    def seam(self, word: Token, state: Token, sensor: ast.Name | None = None) -> ast.Seam:
        return ast.Seam(sensor=sensor, span=_over(word, sensor or state))

    # --- values, inputs and outputs ----------------------------------------------------------------------------------

    def element(self, name: ast.Name, left: Token, index: Expression, right: Token) -> ast.Call:
        return ast.Call(name=name, arguments=(index,), span=_over(name, right))

    # --- control -----------------------------------------------------------------------------------------------------

    def case_else(self, word: Token, other: Token) -> ast.Block:
        return ast.Block(word="CASE ELSE", span=_over(word, other))

    def sub(self, word: Token, name: ast.Name, *parts: Token | ast.Name | None) -> ast.Sub:
        parameters = tuple(part for part in parts if isinstance(part, ast.Name))
        last = _last(name, parts)
        return ast.Sub(name=name, parameters=parameters, parentheses=int(last is not name), span=_over(word, last))

    def call_sub(self, word: Token, name: ast.Name, *parts: Token | Expression | None) -> ast.CallSub:
        arguments = tuple(part for part in parts if isinstance(part, ast.Node))
        last = _last(name, parts)
        return ast.CallSub(name=name, arguments=arguments, parentheses=int(last is not name), span=_over(word, last))

    def word(self, *words: Token | None) -> ast.Word:
        found = [word for word in words if word is not None]
        return ast.Word(word=" ".join(word.type for word in found), span=_over(found[0], found[-1]))

    def line_target(self, token: Token) -> ast.Target:
        # a number that no line can have (a point, an exponent, too long) is -1, which the checker reports
        possible = token.isdecimal() and len(token) <= ast.MAX_NUMBER_DIGITS
        return ast.Target(number=int(token) if possible else -1, span=span_of(token))

    def label_target(self, star: Token, name: ast.Name) -> ast.Target:
        return ast.Target(label=name, span=_over(star, name))

    # --- expressions -------------------------------------------------------------------------------------------------

    def chain(self, first: Expression, *rest: Token | Expression) -> Expression:
        pairs = tuple((_sign(sign), operand) for sign, operand in zip(rest[::2], rest[1::2], strict=True))
        return ast.Chain(first=first, rest=pairs, span=_over(first, pairs[-1][1])) if pairs else first  # type: ignore[arg-type]

    def not_(self, word: Token, operand: Expression) -> ast.Not:
        return ast.Not(operand=operand, span=_over(word, operand))

    def negate(self, sign: Token, operand: Expression) -> ast.Negate:
        return ast.Negate(operand=operand, span=_over(sign, operand))

    # no node: +x has the value of x, and the formatter leaves the sign out
    def plus(self, sign: Token, operand: Expression) -> Expression:
        return operand

    def group(self, left: Token, value: Expression, right: Token) -> Expression:
        return replace(value, parentheses=value.parentheses + 1)

    def vector(self, left: Token, *parts: Expression | Token) -> ast.Vector:
        *items, right = parts
        return ast.Vector(items=tuple(items), span=_over(left, right))  # type: ignore[arg-type]

    def call(self, name: ast.Name | Token, *parts: Expression | Token) -> ast.Call:
        word = name if isinstance(name, ast.Name) else ast.Name(text=intern(str(name)), span=span_of(name))
        arguments = tuple(part for part in parts if isinstance(part, ast.Node))
        return ast.Call(name=word, arguments=arguments, span=_over(name, parts[-1] if parts else name))

    def component6(self, base: Expression, name: ast.Name) -> ast.Component6:
        return ast.Component6(base=base, name=name, span=_over(base, name))

    def number(self, token: Token) -> ast.Number:
        return ast.Number(value=float(token), text=intern(str(token)), span=span_of(token))

    def text(self, token: Token) -> ast.Text:
        return ast.Text(value=str(token)[1:-1].replace('""', '"'), span=span_of(token))

    def name(self, token: Token) -> ast.Name:
        return ast.Name(text=intern(str(token)), span=span_of(token))


def builder() -> Any:
    """Return an object with an attribute to call for each rule that builds something."""
    return _Builder()


def _sign(token: Token | Expression) -> str:
    return str(token).upper()


def _last(name: ast.Name, parts: Iterable[Token | ast.Node | None]) -> Token | ast.Node:
    found: Token | ast.Node = name
    for part in parts:
        found = found if part is None else part
    return found


def _options(parts: Iterable[ast.Option | list[Token] | Token]) -> tuple[ast.Option, ...]:
    """Return the options of a move, each WRIST HOLD with the components that follow it."""
    found: list[ast.Option | list[Token]] = []
    hold: list[Token] = []
    for part in parts:
        if isinstance(part, str):  # Lark's tokens are texts, too
            hold.append(part)
            continue
        if isinstance(part, list):
            hold = part
        found.append(part)
    return tuple(_holding(part) if isinstance(part, list) else part for part in found)


def _holding(words: list[Token]) -> ast.Wrist:
    """Return the node of ``WRIST HOLD c {, c}``, given as its words."""
    held = words[2:]
    return ast.Wrist(
        mode=ast.WristMode.HOLD,
        held=tuple(ast.Component[word.type] for word in held),
        held_spans=tuple(map(span_of, held)),
        span=_over(words[0], words[-1]),
    )
