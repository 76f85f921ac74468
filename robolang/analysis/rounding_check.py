"""Comparisons by = and <> of numbers that rounding may part (RBL232), in ``CASE`` as well.

A float holds 0.1 to 17 digits, so 0.1 + 0.2 is not the float next to 0.3. Numbers are classified by how far that goes
(``Exactness``): whole numbers and binary fractions are exact, as are counters, inputs and what only these compute;
a decimal fraction as written, or one division, is the float nearest to its value and equals another that is nearest to
the same; what is computed further may differ in the last digits, and only that is reported. The kind of a name is the
worst of all that is assigned to it anywhere. Only names that a comparison can depend on are followed, in
``MAX_PASSES`` passes at most, so the time is linear in the program.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import get_args

from robolang.core.diagnostics import Diagnostic, Related, Severity
from robolang.syntax.ast import (
    Assign,
    Block,
    Call,
    CallSub,
    Case,
    Chain,
    Component6,
    Const,
    Expression,
    For,
    Hand,
    Head,
    If,
    Jump,
    Load,
    Moving,
    Name,
    Negate,
    Next,
    Number,
    Program,
    Statement,
    Sub,
    Vector,
    Word,
    Wrist,
)
from robolang.syntax.tree import Node, walk
from robolang.syntax.unparse import print_expression
from robolang.values.functions import FUNCTIONS
from robolang.values.kinds import Exactness
from runtime.core.record import Record

MAX_PASSES = 20
SMALL = "1E-6"
"""Difference below which the remedy takes two numbers for equal."""


class _Giving(Record):
    """A statement that gives ``key`` a value: of one expression, or ``counts`` from the first by the second."""

    key: str
    values: tuple[Expression, ...]
    counts: bool = False


class _Exactnesses:
    """Exactnesss of names and arrays, by ``_key``, and the first expression that made a name ``ROUNDED``."""

    def __init__(self) -> None:
        self.names: dict[str, Exactness] = {}
        self.causes: dict[str, Expression] = {}

    def of(self, node: Expression) -> Exactness:
        """Return the kind of an expression; without recursion, its parts before itself."""
        found: dict[int, Exactness] = {}
        for part in reversed(list(walk(node))):
            found[id(part)] = self._kind(part, found)  # type: ignore[arg-type]
        return found[id(node)]

    def take(self, giving: _Giving) -> bool:
        """Let a statement raise the kind of its name; return whether it did."""
        kinds = [self.of(value) for value in giving.values]
        kind = max(kinds)
        # FOR x = 0 TO 1 STEP 0.1 adds its step in every round, and rounds each sum
        if giving.counts and kind is not Exactness.EXACT:
            kind = Exactness.ROUNDED
        if kind <= self.names.get(giving.key, Exactness.EXACT):
            return False
        self.names[giving.key] = kind
        if kind is Exactness.ROUNDED:
            self.causes[giving.key] = giving.values[kinds.index(max(kinds))]
        return True

    def _kind(self, node: Expression, found: dict[int, Exactness]) -> Exactness:
        # exact: whole numbers and binary fractions of up to 20 places
        if isinstance(node, Number):
            return Exactness.EXACT if (node.value * 2.0**20).is_integer() else Exactness.NEAREST
        if isinstance(node, Component6):
            return Exactness.ROUNDED
        if isinstance(node, Negate):
            return found[id(node.operand)]
        if isinstance(node, Call):
            return self._of_call(node, [found[id(argument)] for argument in node.arguments])
        if isinstance(node, Chain):
            return _of_chain(node, found)
        return self.names.get(node.key, Exactness.EXACT) if isinstance(node, Name) else Exactness.EXACT

    def _of_call(self, node: Call, arguments: list[Exactness]) -> Exactness:
        function = FUNCTIONS.get(node.name.key)
        if function is not None:
            return function.exactness(arguments)
        return self.names.get(_key(node), Exactness.EXACT)


def _of_chain(node: Chain, found: dict[int, Exactness]) -> Exactness:
    kind = found[id(node.first)]
    for sign, operand in node.rest:
        if isinstance(operand, Vector) or sign not in _COMPUTES:
            return Exactness.EXACT
        kind = _COMPUTES[sign](kind, node.first, found[id(operand)], operand)
    return kind


def _joined(left: Exactness, first: Expression, right: Exactness, operand: Expression) -> Exactness:
    return Exactness.EXACT if max(left, right) is Exactness.EXACT else Exactness.ROUNDED


def _multiplied(left: Exactness, first: Expression, right: Exactness, operand: Expression) -> Exactness:
    if _is_power_of_two(operand):
        return left
    return right if _is_power_of_two(first) and left is Exactness.EXACT else _joined(left, first, right, operand)


def _divided(left: Exactness, first: Expression, right: Exactness, operand: Expression) -> Exactness:
    if _is_power_of_two(operand):
        return left
    return Exactness.NEAREST if max(left, right) is Exactness.EXACT else Exactness.ROUNDED


_COMPUTES: dict[str, Callable[[Exactness, Expression, Exactness, Expression], Exactness]] = {
    "+": _joined,
    "-": _joined,
    "MOD": _joined,
    "^": _joined,
    "*": _multiplied,
    "/": _divided,
}


def _is_power_of_two(node: Expression) -> bool:
    """Return whether a product with an expression changes the exponent of a float only."""
    return isinstance(node, Number) and node.value in (0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)


def rounding_check(program: Program) -> Iterator[Diagnostic]:
    """Report comparisons by = and <>, and SELECTs, of numbers that rounding may part (RBL232), as warnings."""
    statements = [node for line in program.statements for node in _parts(line.statement)]
    compared = list(_compared(statements))
    if not compared:
        return
    kinds = _kinds(statements, [side for _, sides, _ in compared for side in sides])
    for place, sides, sign in compared:
        rounded = next((side for side in sides if kinds.of(side) is Exactness.ROUNDED), None)
        if rounded is not None:
            yield _finding(place, sides, sign, rounded, kinds)


_Compared = tuple[Expression, tuple[Expression, ...], str]
"""Where a comparison stands, its sides, and its sign; ``CASE`` for a sign where SELECT compares."""


_SKIPPED = (*get_args(Moving), Load, Hand, Wrist, Block, Word, Jump, Sub, Next)
"""Statements that compare nothing, or where nobody does; they are most of a program."""


def _compared(statements: list[Statement]) -> Iterator[_Compared]:
    for node in statements:
        if isinstance(node, _SKIPPED):
            continue
        # the statements of a one-line IF are in the list by themselves
        yield from _signs(node.condition if isinstance(node, If) else node)
        if isinstance(node, Head) and node.word == "SELECT":
            yield node.value, (node.value,), "CASE"
        elif isinstance(node, Case):
            yield from ((value, (value,), "CASE") for value in node.values)


def _signs(node: Node) -> Iterator[_Compared]:
    """Yield the comparisons by = and <> in a statement or an expression."""
    for each in walk(node):
        if isinstance(each, Chain) and each.rest[0][0] in ("=", "<>"):
            sign, other = each.rest[0]
            yield each, (each.first, other), sign


def _finding(
    place: Expression, sides: tuple[Expression, ...], sign: str, rounded: Expression, kinds: _Exactnesses
) -> Diagnostic:
    cause = kinds.causes.get(_key(rounded))
    shown = print_expression(rounded)
    related = () if cause is None else (Related(span=cause.span, message=f"{shown} is computed here"),)
    if sign == "CASE":
        hint = f"compare with IF and a small difference: IF ABS({shown} - value) < {SMALL} THEN"
    else:
        left, right = sides
        zero = isinstance(right, Number) and right.value == 0.0
        difference = print_expression(left if zero else Chain(first=left, rest=(("-", right),)))
        hint = f"write ABS({difference}) {'<' if sign == '=' else '>='} {SMALL}"
    message = f"{sign} compares {shown}, which may be rounded: equal values may differ in the last digit"
    return Diagnostic(
        code="RBL232", severity=Severity.WARNING, span=place.span, message=message, hint=hint, related=related
    )


# --- names -----------------------------------------------------------------------------------------------------------


def _key(node: Expression | Name) -> str:
    """Return under what a name or an array is kept: the two are different things of one spelling."""
    if isinstance(node, Call):
        return f"{node.name.key}()"
    return node.key if isinstance(node, Name) else ""


def _kinds(statements: list[Statement], sides: Iterable[Expression]) -> _Exactnesses:
    """Return the kinds of the names that some expressions depend on."""
    givings = _followed(statements, [_key(name) for side in sides for name in _read(side)])
    kinds = _Exactnesses()
    for _ in range(MAX_PASSES):
        # summed, not any(): each of them is taken in every pass
        if not sum(kinds.take(giving) for giving in givings):
            break
    return kinds


def _followed(statements: list[Statement], todo: list[str]) -> list[_Giving]:
    """Return what gives the names of ``todo`` their values, and what gives the names in those theirs."""
    by_key: dict[str, list[_Giving]] = {}
    for giving in _givings(statements):
        by_key.setdefault(giving.key, []).append(giving)
    givings: list[_Giving] = []
    while todo:
        # taken out, so that a key is followed once
        for giving in by_key.pop(todo.pop(), ()):
            givings.append(giving)
            todo += [_key(name) for value in giving.values for name in _read(value)]
    return givings


def _read(node: Expression) -> Iterator[Expression]:
    """Yield the names and the calls in an expression."""
    return (each for each in walk(node) if isinstance(each, Name | Call))


def _givings(statements: list[Statement]) -> Iterator[_Giving]:
    subs = {node.name.key: node for node in statements if isinstance(node, Sub)}
    for node in statements:
        if isinstance(node, Assign):
            yield _Giving(key=_key(node.target), values=(node.value,))
        elif isinstance(node, Const):
            yield _Giving(key=node.name.key, values=(node.value,))
        elif isinstance(node, For):
            step = () if node.step is None else (node.step,)
            yield _Giving(key=node.variable.key, values=(node.first, *step), counts=True)
        elif isinstance(node, CallSub) and node.name.key in subs:
            yield from _arguments(node, subs[node.name.key])


def _arguments(node: CallSub, sub: Sub) -> Iterator[_Giving]:
    """Yield what a CALL gives the parameters; a wrong number of arguments is reported elsewhere."""
    for parameter, value in zip(sub.parameters, node.arguments, strict=False):
        yield _Giving(key=parameter.key, values=(value,))


def _parts(node: Statement | None) -> Iterator[Statement]:
    """Yield a statement and those of a one-line IF."""
    if node is not None:
        yield node
    if isinstance(node, If):
        yield from _parts(node.then)
        yield from _parts(node.otherwise)
