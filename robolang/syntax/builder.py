"""From the rules of ``grammar.lark`` to the nodes of the tree: one method for each, called when the rule is reduced.

The parser calls these while it reads, so no parse tree is built and nothing is visited afterwards. Every node gets the
place of its text. The automaton of ``line_reader`` calls
them, and Lark for a line with an error.
"""

from collections.abc import Iterable
from sys import intern
from typing import Any

from robolang.core.source import Span
from robolang.syntax import ast
from robolang.syntax.ast import Expression, replace
from robolang.syntax.tokens import Token, span_of

Parsed = tuple[ast.Name | None, ast.Statement | None, ast.Comment | None]
"""Label, statement and comment of a line."""

_Head = tuple[Token, tuple[Expression, ...]]


def _over(first: Token | ast.Node, last: Token | ast.Node) -> Span:
    """Return the place from the start of one token or node to the end of another."""
    if first is last:
        return first.span if isinstance(first, ast.Node) else span_of(first)
    start, end = (item.span if isinstance(item, ast.Node) else span_of(item) for item in (first, last))
    return Span(start.start, end.end)


class _Builder:
    """One method for each rule of the grammar, called with what the parts of the rule gave."""

    def start(self, label: ast.Name | None, statement: ast.Statement | None, comment: Token | None) -> Parsed:
        if comment is None:
            return label, statement, None
        text, at = comment.rstrip(), span_of(comment).start
        return label, statement, ast.Comment(text=text, span=Span(at, at + len(text)))

    def label(self, star: Token, name: Token) -> ast.Name:
        return ast.Name(text=intern(str(name)), span=_over(star, name))

    # --- motion ------------------------------------------------------------------------------------------------------

    def head(self, word: Token, *values: Expression) -> _Head:
        return word, values

    def moving(self, head: _Head, *parts: ast.Option | list[Token] | Token) -> ast.Moving:
        word, values = head
        options = _options(parts)
        span = _over(word, options[-1] if options else values[-1])
        if word.type == "MOVE":
            return ast.Move(target=values[0], options=options, span=span)
        if word.type == "MOVEJ":
            return ast.MoveJ(target=values[0], options=options, span=span)
        if word.type == "MOVEC":
            return ast.MoveC(via=values[0], target=values[1], options=options, span=span)
        if word.type == "APPROACH":
            return ast.Approach(target=values[0], distance=values[1], options=options, span=span)
        return ast.Depart(distance=values[0], options=options, span=span)

    def load(self, word: Token, cog: ast.Vector, mass: Expression, inertia: ast.Vector | None) -> ast.Load:
        return ast.Load(cog=cog, mass=mass, inertia=inertia, span=_over(word, inertia or mass))

    def named_load(self, word: Token, name: ast.Name) -> ast.LoadNamed:
        return ast.LoadNamed(name=name, span=_over(word, name))

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

    def setting(self, word: Token, value: Expression) -> ast.Setting:
        return ast.Setting(word=str(word.type), value=value, span=_over(word, value))

    tool = setting

    def speed(self, word: Token, value: Expression) -> ast.Speed:
        return ast.Speed(value=value, span=_over(word, value))

    def accel(self, word: Token, value: Expression) -> ast.Accel:
        return ast.Accel(value=value, span=_over(word, value))

    def time(self, word: Token, value: Expression) -> ast.Time:
        return ast.Time(value=value, span=_over(word, value))

    def zone(self, word: Token, value: Expression | None = None) -> ast.Zone:
        return ast.Zone(value=value, span=_over(word, value or word))

    # --- values, inputs and outputs ----------------------------------------------------------------------------------

    def assign(self, target: ast.Name | ast.Call, sign: Token, value: Expression) -> ast.Assign:
        return ast.Assign(target=target, value=value, span=_over(target, value))

    def element(self, name: ast.Name, left: Token, index: Expression, right: Token) -> ast.Call:
        return ast.Call(name=name, arguments=(index,), span=_over(name, right))

    def dim(self, word: Token, name: ast.Name, left: Token, size: Expression, right: Token) -> ast.Dim:
        return ast.Dim(name=name, size=size, span=_over(word, right))

    def const(self, word: Token, name: ast.Name, sign: Token, value: Expression) -> ast.Const:
        return ast.Const(name=name, value=value, span=_over(word, value))

    def out(self, word: Token, left: Token, index: Expression, right: Token, sign: Token, value: Expression) -> ast.Out:
        return ast.Out(index=index, value=value, span=_over(word, value))

    def pulse(self, word: Token, index: Expression, seconds: Expression) -> ast.Pulse:
        return ast.Pulse(index=index, seconds=seconds, span=_over(word, seconds))

    def delay(self, word: Token, seconds: Expression) -> ast.Delay:
        return ast.Delay(seconds=seconds, span=_over(word, seconds))

    def wait(
        self,
        word: Token,
        condition: Expression,
        until: Token | None,
        timeout: Expression | None,
        goto: Token | None,
        target: ast.Target | None,
    ) -> ast.Wait:
        return ast.Wait(
            condition=condition, timeout=timeout, target=target, span=_over(word, target or timeout or condition)
        )

    def print(self, word: Token, *items: Expression | None) -> ast.Print:
        found = tuple(item for item in items if item is not None)
        return ast.Print(items=found, span=_over(word, found[-1] if found else word))

    # --- control -----------------------------------------------------------------------------------------------------

    def one_line(
        self,
        word: Token,
        condition: Expression,
        then: Token,
        statement: ast.Statement,
        other: Token | None,
        otherwise: ast.Statement | None,
    ) -> ast.If:
        return ast.If(
            condition=condition, then=statement, otherwise=otherwise, span=_over(word, otherwise or statement)
        )

    def if_head(self, word: Token, value: Expression, then: Token | None = None) -> ast.Head:
        return ast.Head(word=str(word.type), value=value, span=_over(word, then or value))

    else_if = while_head = if_head

    def select_head(self, word: Token, case: Token | None, value: Expression) -> ast.Head:
        return ast.Head(word="SELECT", value=value, span=_over(word, value))

    def case(self, word: Token, *values: Expression) -> ast.Case:
        return ast.Case(values=values, span=_over(word, values[-1]))

    def case_else(self, word: Token, other: Token) -> ast.Block:
        return ast.Block(word="CASE ELSE", span=_over(word, other))

    def closing(self, word: Token) -> ast.Block:
        return ast.Block(word=str(word.type), span=span_of(word))

    def for_head(
        self,
        word: Token,
        variable: ast.Name,
        sign: Token,
        first: Expression,
        to: Token,
        last: Expression,
        by: Token | None,
        step: Expression | None,
    ) -> ast.For:
        return ast.For(variable=variable, first=first, last=last, step=step, span=_over(word, step or last))

    def next(self, word: Token, variable: ast.Name | None) -> ast.Next:
        return ast.Next(variable=variable, span=_over(word, variable or word))

    def sub(self, word: Token, name: ast.Name, *parts: Token | ast.Name | None) -> ast.Sub:
        parameters = tuple(part for part in parts if isinstance(part, ast.Name))
        last = _last(name, parts)
        return ast.Sub(name=name, parameters=parameters, parentheses=int(last is not name), span=_over(word, last))

    def call_sub(self, word: Token, name: ast.Name, *parts: Token | Expression | None) -> ast.CallSub:
        arguments = tuple(part for part in parts if isinstance(part, ast.Node))
        last = _last(name, parts)
        return ast.CallSub(name=name, arguments=arguments, parentheses=int(last is not name), span=_over(word, last))

    def jump(self, word: Token, target: ast.Target) -> ast.Jump:
        return ast.Jump(word=str(word.type), target=target, span=_over(word, target))

    def word(self, *words: Token | None) -> ast.Word:
        found = [word for word in words if word is not None]
        return ast.Word(word=" ".join(word.type for word in found), span=_over(found[0], found[-1]))

    def on_error(self, on: Token, error: Token, goto: Token, target: ast.Target) -> ast.OnError:
        return ast.OnError(target=target, span=_over(on, target))

    def line_target(self, token: Token) -> ast.Target:
        # a number with a point or an exponent names no line: -1 is none, and the checker says so
        return ast.Target(number=int(token) if token.isdecimal() and len(token) <= 9 else -1, span=span_of(token))

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
    """Return an object with a method for each rule of the grammar."""
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
