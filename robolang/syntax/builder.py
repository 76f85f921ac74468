"""From the rules of ``grammar.lark`` to the nodes of the tree: one method for each, called when the rule is reduced.

The parser calls these while it reads, so no parse tree is built and nothing is visited afterwards. Every node gets the
place of its text. Called by ``parser`` alone.
"""

from collections.abc import Iterable
from dataclasses import replace
from sys import intern

from lark import Token, Transformer, v_args

from robolang.core.source import Span
from robolang.syntax import ast as nodes
from robolang.syntax.ast import Expression

Parsed = tuple[nodes.Name | None, nodes.Statement | None, nodes.Comment | None]
"""Label, statement and comment of a line."""

_Head = tuple[Token, tuple[Expression, ...]]


def span_of(token: Token) -> Span:
    """Return the place of a token."""
    assert token.start_pos is not None and token.end_pos is not None
    return Span(token.start_pos, token.end_pos)


def _over(first: Token | nodes.Node, last: Token | nodes.Node) -> Span:
    """Return the place from the start of one token or node to the end of another."""
    if first is last:
        return first.span if isinstance(first, nodes.Node) else span_of(first)
    start, end = (item.span if isinstance(item, nodes.Node) else span_of(item) for item in (first, last))
    return Span(start.start, end.end)


@v_args(inline=True)
class _Builder(Transformer[Token, nodes.Node]):
    """One method for each rule of the grammar."""

    def start(self, label: nodes.Name | None, statement: nodes.Statement | None, comment: Token | None) -> Parsed:
        if comment is None:
            return label, statement, None
        text, at = comment.rstrip(), span_of(comment).start
        return label, statement, nodes.Comment(text=text, span=Span(at, at + len(text)))

    def label(self, star: Token, name: Token) -> nodes.Name:
        return nodes.Name(text=intern(str(name)), span=_over(star, name))

    # --- motion ------------------------------------------------------------------------------------------------------

    def head(self, word: Token, *values: Expression) -> _Head:
        return word, values

    def moving(self, head: _Head, *parts: nodes.Option | list[Token] | Token) -> nodes.Moving:
        word, values = head
        options = _options(parts)
        span = _over(word, options[-1] if options else values[-1])
        if word.type == "MOVE":
            return nodes.Move(target=values[0], options=options, span=span)
        if word.type == "MOVEJ":
            return nodes.MoveJ(target=values[0], options=options, span=span)
        if word.type == "MOVEC":
            return nodes.MoveC(via=values[0], target=values[1], options=options, span=span)
        if word.type == "APPROACH":
            return nodes.Approach(target=values[0], distance=values[1], options=options, span=span)
        return nodes.Depart(distance=values[0], options=options, span=span)

    def load(self, word: Token, cog: nodes.Vector, mass: Expression, inertia: nodes.Vector | None) -> nodes.Load:
        return nodes.Load(cog=cog, mass=mass, inertia=inertia, span=_over(word, inertia or mass))

    def named_load(self, word: Token, name: nodes.Name) -> nodes.LoadNamed:
        return nodes.LoadNamed(name=name, span=_over(word, name))

    def hand(self, word: Token, state: Token, dwell: Expression | None) -> nodes.Hand:
        return nodes.Hand(state=nodes.HandState[state.type], dwell=dwell, span=_over(word, dwell or state))

    def wrist(self, word: Token, mode: Token) -> nodes.Wrist:
        return nodes.Wrist(mode=nodes.WristMode[mode.type], span=_over(word, mode))

    def hold(self, *words: Token) -> list[Token]:
        return list(words)

    def holding(self, hold: list[Token], *more: Token) -> nodes.Wrist:
        return _holding([*hold, *more])

    def seam(self, word: Token, state: Token, sensor: nodes.Name | None = None) -> nodes.Seam:
        return nodes.Seam(sensor=sensor, span=_over(word, sensor or state))

    def setting(self, word: Token, value: Expression) -> nodes.Setting:
        return nodes.Setting(word=str(word.type), value=value, span=_over(word, value))

    tool = setting

    def speed(self, word: Token, value: Expression) -> nodes.Speed:
        return nodes.Speed(value=value, span=_over(word, value))

    def accel(self, word: Token, value: Expression) -> nodes.Accel:
        return nodes.Accel(value=value, span=_over(word, value))

    def time(self, word: Token, value: Expression) -> nodes.Time:
        return nodes.Time(value=value, span=_over(word, value))

    def zone(self, word: Token, value: Expression | None = None) -> nodes.Zone:
        return nodes.Zone(value=value, span=_over(word, value or word))

    # --- values, inputs and outputs ----------------------------------------------------------------------------------

    def assign(self, target: nodes.Name | nodes.Call, sign: Token, value: Expression) -> nodes.Assign:
        return nodes.Assign(target=target, value=value, span=_over(target, value))

    def element(self, name: nodes.Name, left: Token, index: Expression, right: Token) -> nodes.Call:
        return nodes.Call(name=name, arguments=(index,), span=_over(name, right))

    def dim(self, word: Token, name: nodes.Name, left: Token, size: Expression, right: Token) -> nodes.Dim:
        return nodes.Dim(name=name, size=size, span=_over(word, right))

    def const(self, word: Token, name: nodes.Name, sign: Token, value: Expression) -> nodes.Const:
        return nodes.Const(name=name, value=value, span=_over(word, value))

    def out(
        self, word: Token, left: Token, index: Expression, right: Token, sign: Token, value: Expression
    ) -> nodes.Out:
        return nodes.Out(index=index, value=value, span=_over(word, value))

    def pulse(self, word: Token, index: Expression, seconds: Expression) -> nodes.Pulse:
        return nodes.Pulse(index=index, seconds=seconds, span=_over(word, seconds))

    def delay(self, word: Token, seconds: Expression) -> nodes.Delay:
        return nodes.Delay(seconds=seconds, span=_over(word, seconds))

    def wait(
        self,
        word: Token,
        condition: Expression,
        until: Token | None,
        timeout: Expression | None,
        goto: Token | None,
        target: nodes.Target | None,
    ) -> nodes.Wait:
        return nodes.Wait(
            condition=condition, timeout=timeout, target=target, span=_over(word, target or timeout or condition)
        )

    def print(self, word: Token, *items: Expression | None) -> nodes.Print:
        found = tuple(item for item in items if item is not None)
        return nodes.Print(items=found, span=_over(word, found[-1] if found else word))

    # --- control -----------------------------------------------------------------------------------------------------

    def one_line(
        self,
        word: Token,
        condition: Expression,
        then: Token,
        statement: nodes.Statement,
        other: Token | None,
        otherwise: nodes.Statement | None,
    ) -> nodes.If:
        return nodes.If(
            condition=condition, then=statement, otherwise=otherwise, span=_over(word, otherwise or statement)
        )

    def if_head(self, word: Token, value: Expression, then: Token | None = None) -> nodes.Head:
        return nodes.Head(word=str(word.type), value=value, span=_over(word, then or value))

    else_if = while_head = if_head

    def select_head(self, word: Token, case: Token | None, value: Expression) -> nodes.Head:
        return nodes.Head(word="SELECT", value=value, span=_over(word, value))

    def case(self, word: Token, *values: Expression) -> nodes.Case:
        return nodes.Case(values=values, span=_over(word, values[-1]))

    def case_else(self, word: Token, other: Token) -> nodes.Block:
        return nodes.Block(word="CASE ELSE", span=_over(word, other))

    def closing(self, word: Token) -> nodes.Block:
        return nodes.Block(word=str(word.type), span=span_of(word))

    def for_head(
        self,
        word: Token,
        variable: nodes.Name,
        sign: Token,
        first: Expression,
        to: Token,
        last: Expression,
        by: Token | None,
        step: Expression | None,
    ) -> nodes.For:
        return nodes.For(variable=variable, first=first, last=last, step=step, span=_over(word, step or last))

    def next(self, word: Token, variable: nodes.Name | None) -> nodes.Next:
        return nodes.Next(variable=variable, span=_over(word, variable or word))

    def sub(self, word: Token, name: nodes.Name, *parts: Token | nodes.Name | None) -> nodes.Sub:
        parameters = tuple(part for part in parts if isinstance(part, nodes.Name))
        last = _last(name, parts)
        return nodes.Sub(name=name, parameters=parameters, parentheses=int(last is not name), span=_over(word, last))

    def call_sub(self, word: Token, name: nodes.Name, *parts: Token | Expression | None) -> nodes.CallSub:
        arguments = tuple(part for part in parts if isinstance(part, nodes.Node))
        last = _last(name, parts)
        return nodes.CallSub(name=name, arguments=arguments, parentheses=int(last is not name), span=_over(word, last))

    def jump(self, word: Token, target: nodes.Target) -> nodes.Jump:
        return nodes.Jump(word=str(word.type), target=target, span=_over(word, target))

    def word(self, *words: Token | None) -> nodes.Word:
        found = [word for word in words if word is not None]
        return nodes.Word(word=" ".join(word.type for word in found), span=_over(found[0], found[-1]))

    def on_error(self, on: Token, error: Token, goto: Token, target: nodes.Target) -> nodes.OnError:
        return nodes.OnError(target=target, span=_over(on, target))

    def line_target(self, token: Token) -> nodes.Target:
        # a number with a point or an exponent names no line: -1 is none, and the checker says so
        return nodes.Target(number=int(token) if token.isdecimal() and len(token) <= 9 else -1, span=span_of(token))

    def label_target(self, star: Token, name: nodes.Name) -> nodes.Target:
        return nodes.Target(label=name, span=_over(star, name))

    # --- expressions -------------------------------------------------------------------------------------------------

    def chain(self, first: Expression, *rest: Token | Expression) -> Expression:
        pairs = tuple((_sign(sign), operand) for sign, operand in zip(rest[::2], rest[1::2], strict=True))
        return nodes.Chain(first=first, rest=pairs, span=_over(first, pairs[-1][1])) if pairs else first  # type: ignore[arg-type]

    def not_(self, word: Token, operand: Expression) -> nodes.Not:
        return nodes.Not(operand=operand, span=_over(word, operand))

    def negate(self, sign: Token, operand: Expression) -> nodes.Negate:
        return nodes.Negate(operand=operand, span=_over(sign, operand))

    def plus(self, sign: Token, operand: Expression) -> Expression:
        return operand

    def group(self, left: Token, value: Expression, right: Token) -> Expression:
        return replace(value, parentheses=value.parentheses + 1)

    def vector(self, left: Token, *parts: Expression | Token) -> nodes.Vector:
        *items, right = parts
        return nodes.Vector(items=tuple(items), span=_over(left, right))  # type: ignore[arg-type]

    def call(self, name: nodes.Name | Token, *parts: Expression | Token) -> nodes.Call:
        word = name if isinstance(name, nodes.Name) else nodes.Name(text=intern(str(name)), span=span_of(name))
        arguments = tuple(part for part in parts if isinstance(part, nodes.Node))
        return nodes.Call(name=word, arguments=arguments, span=_over(name, parts[-1] if parts else name))

    def component6(self, base: Expression, name: nodes.Name) -> nodes.Component6:
        return nodes.Component6(base=base, name=name, span=_over(base, name))

    def number(self, token: Token) -> nodes.Number:
        return nodes.Number(value=float(token), text=intern(str(token)), span=span_of(token))

    def text(self, token: Token) -> nodes.Text:
        return nodes.Text(value=str(token)[1:-1].replace('""', '"'), span=span_of(token))

    def name(self, token: Token) -> nodes.Name:
        return nodes.Name(text=intern(str(token)), span=span_of(token))


def builder() -> Transformer[Token, nodes.Node]:
    """Return what the parser calls for each rule that it reduces."""
    return _Builder()


def _sign(token: Token | Expression) -> str:
    return str(token).upper()


def _last(name: nodes.Name, parts: Iterable[Token | nodes.Node | None]) -> Token | nodes.Node:
    found: Token | nodes.Node = name
    for part in parts:
        found = found if part is None else part
    return found


def _options(parts: Iterable[nodes.Option | list[Token] | Token]) -> tuple[nodes.Option, ...]:
    """Return the options of a move, each WRIST HOLD with the components that follow it."""
    found: list[nodes.Option | list[Token]] = []
    hold: list[Token] = []
    for part in parts:
        if isinstance(part, Token):
            hold.append(part)
            continue
        if isinstance(part, list):
            hold = part
        found.append(part)
    return tuple(_holding(part) if isinstance(part, list) else part for part in found)


def _holding(words: list[Token]) -> nodes.Wrist:
    """Return the node of ``WRIST HOLD c {, c}``, given as its words."""
    held = words[2:]
    return nodes.Wrist(
        mode=nodes.WristMode.HOLD,
        held=tuple(nodes.Component[word.type] for word in held),
        held_spans=tuple(map(span_of, held)),
        span=_over(words[0], words[-1]),
    )
