"""Expressions: undefined names, values of the wrong kind, calls with the wrong count, and what has no value at all."""

import math
from collections.abc import Callable, Iterator

from robolang.analysis import kind_hints
from robolang.analysis.cell_symbols import CellSymbols
from robolang.analysis.symbols import Defined, hint_for
from robolang.core.diagnostics import Diagnostic, Severity
from robolang.evaluation.constant_folding import fixed, no_value
from robolang.syntax import other_languages
from robolang.syntax.ast import (
    Call,
    Chain,
    Component6,
    Expression,
    Name,
    Negate,
    Not,
    Number,
    Text,
    Vector,
    walk,
)
from robolang.syntax.keywords import COMPONENTS6, near
from robolang.syntax.unparse import print_expression
from robolang.values.functions import FUNCTIONS, Function
from robolang.values.kinds import Kind
from runtime.cell.signals import unknown_input
from runtime.core.limits import INPUT
from runtime.robot.model.drives import beyond_range

_OFFSET_COUNTS = {"+": (3,), "*": (3, 6)}
"""How many values an offset after a pose may have, by the sign between them."""
_OF_TEXTS = frozenset({"+", "=", "<>", "<", ">", "<=", ">="})
"""Signs that may stand between two texts."""


class ExpressionCheck:
    """Checks the expressions of a program that has ``defined`` names in a cell of ``symbols``."""

    def __init__(self, symbols: CellSymbols, defined: Defined) -> None:
        self._symbols, self._defined = symbols, defined
        self._in_place: frozenset[str] = frozenset()

    @property
    def _known(self) -> frozenset[str]:
        """Every name that has a value here, and every word that stands for one."""
        return frozenset((self._symbols.points or frozenset()) | self._defined.values | self._in_place)

    def check(self, node: Expression, in_place: frozenset[str] = frozenset()) -> Iterator[Diagnostic]:
        """Report what is wrong in an expression and in its parts; ``in_place``: words that a name in it may mean."""
        self._in_place = in_place
        names_no_value: set[int] = set()  # of functions, arrays and components
        after_pose: set[int] = set()  # operands of a chain, where an offset may stand
        for each in walk(node):
            # by identity: in a(a) equal names differ in meaning; a node comes before its parts, so in time for them
            if isinstance(each, Call | Component6):
                names_no_value.add(id(each.name))
            elif isinstance(each, Chain):
                after_pose.update(id(operand) for _, operand in each.rest)
            if id(each) in names_no_value:
                continue
            rule = _RULES.get(type(each))
            if rule is not None:
                yield from rule(self, each)
            if isinstance(each, Vector) and id(each) not in after_pose:
                message = "an offset (x, y, z) may only follow a pose and + or *, as in P1 + (0, 0, 50)"
                hint = kind_hints.pose(each) if len(each.items) == 6 else "write it after a pose, as in P1 + (0, 0, 50)"
                yield Diagnostic(code="RBL217", message=message, span=each.span, hint=hint)
        yield from no_value(node)

    def finite(self, node: Expression) -> Iterator[Diagnostic]:
        """Report NAN and INF where only a finite number can stand."""
        value = fixed(node)
        if value is not None and not math.isfinite(value):
            yield Diagnostic(
                code="RBL209", message=f"this expression has no value: {value:g} is not finite", span=node.span
            )

    def must_be(self, node: Expression, needed: Kind, hint: str = "") -> Iterator[Diagnostic]:
        """Report an expression of another kind than is needed (RBL217); ``hint``: what to write instead."""
        kind = self.kind(node)
        if kind is not None and kind is not needed:
            hint = hint or kind_hints.instead(needed, node, kind)
            yield Diagnostic(code="RBL217", message=f"{needed} is needed here, not {kind}", span=node.span, hint=hint)

    # --- one node --------------------------------------------------------------------------------------------------

    def _operand(self, node: Negate | Not) -> Iterator[Diagnostic]:
        return self.must_be(node.operand, Kind.NUMBER)

    def _vector(self, node: Vector) -> Iterator[Diagnostic]:
        for item in node.items:
            yield from self.finite(item)

    def _name(self, node: Name) -> Iterator[Diagnostic]:
        if self._defined.has_value(node.key) or node.key in ("NAN", "INF"):
            return
        points = self._symbols.points
        if points is not None and node.key not in points and self._defined.is_missing(node):
            message = f"{node.text} has no value: no statement assigns it first, and it is not a taught point"
            elsewhere = other_languages.value(node.key) or other_languages.function(node.key)
            elsewhere = elsewhere or hint_for(node, self._known) or other_languages.signal(node.text)
            hint = elsewhere or self._to_give_value(node.text)
            if self._defined.is_of_a_sub(node.key):
                message = (
                    f"{node.text} has no value here: only a SUB assigns it, and variables of a SUB exist only inside it"
                )
                hint = f"give {node.text} a first value in the main program"
            yield Diagnostic(code="RBL215", message=message, span=node.span, hint=hint)

    def _to_give_value(self, name: str) -> str:
        """Return how a name gets a value; ``""``: the remedy of the code holds, since points are taught already."""
        # a missing points file makes every point a name without a value, and RBL301 is not given for P1 + (x, y, z)
        teach = "" if self._symbols.points else self._symbols.where_to_teach(name)
        return teach and f"if {name} is a point: {teach}; otherwise assign it a value before this line"

    def _component(self, node: Component6) -> Iterator[Diagnostic]:
        if node.name.key not in COMPONENTS6:
            message = f"a pose has no component {node.name.text}"
            yield Diagnostic(code="RBL218", message=message, span=node.name.span)

    # --- calls -------------------------------------------------------------------------------------------------------

    def _call(self, node: Call) -> Iterator[Diagnostic]:
        function = FUNCTIONS.get(node.name.key)
        if function is not None:
            yield from self._function(node, function)
        elif self._defined.has_array(node.name.key):
            yield from self._array(node)
        elif self._defined.is_missing(node.name):
            known = other_languages.function(node.name.key)
            written = other_languages.as_input(print_expression(node)) if known else ""
            known = f"write {written}" if written else known
            guess = "" if other_languages.is_known(node.name.key) else near(node.name.key, FUNCTIONS)
            hint = known or (f"did you mean {guess}?" if guess else f"DIM {node.name.text}(n) makes an array")
            message = f"{node.name.text} is neither an array nor a function"
            yield Diagnostic(code="RBL215", message=message, span=node.name.span, hint=hint)

    def _function(self, node: Call, function: Function) -> Iterator[Diagnostic]:
        low, high, count = function.least, function.most, len(node.arguments)
        if not low <= count <= high:
            allowed = f"{low}" if low == high else f"{low} to {high}"
            message = f"{function.name} takes {allowed} value{'s' * (high > 1)}, not {count}"
            yield Diagnostic(code="RBL214", message=message, span=node.span, hint=f"the form is {function.form}")
            return
        for index, argument in enumerate(node.arguments):
            yield from self.must_be(argument, function.kind(index))
        if function.name == "IN":
            yield from self._input(node.arguments[0])
        elif function.name == "JOINT":
            yield from self._joints(node)

    def _array(self, node: Call) -> Iterator[Diagnostic]:
        if len(node.arguments) == 1:
            yield from self.element(node)
            return
        message = f"an element of an array has one index, not {len(node.arguments)}"
        yield Diagnostic(code="RBL214", message=message, span=node.span)

    def element(self, node: Call) -> Iterator[Diagnostic]:
        """Report an index that is outside of every array of the name, whatever the run does (RBL507)."""
        index, largest = fixed(node.arguments[0]), self._defined.largest(node.name.key)
        if index is not None and index.is_integer() and not (0.0 <= index <= largest):
            highest = "" if math.isinf(largest) else f" to {largest:g}"
            message = f"{node.name.text} has the elements 0{highest}, not {index:.10g}"
            yield Diagnostic(code="RBL507", message=message, span=node.span)

    def _joints(self, node: Call) -> Iterator[Diagnostic]:
        """Report joint angles of another number than the arm has axes, and angles outside of their range."""
        axes, angles = self._symbols.axes, [fixed(item) for item in node.arguments]
        if axes is not None and len(angles) != axes:
            # the ranges are not compared: nobody knows which angle is of which joint
            message = f"JOINT has {len(angles)} values, but the robot has {axes} axes"
            yield Diagnostic(code="RBL307", message=message, span=node.span)
            return
        beyond = beyond_range(angles, self._symbols.limits or ())
        if beyond:
            yield Diagnostic(code="RBL309", message=beyond, span=node.span)

    def _input(self, node: Expression) -> Iterator[Diagnostic]:
        number, inputs = fixed(node), self._symbols.inputs
        if number is None:
            return
        fault = INPUT.fault(number)
        if fault is None and inputs is not None and number not in inputs:
            fault = unknown_input(int(number), inputs, self._symbols.cell_file)
        if fault is not None:
            yield Diagnostic(code=fault.code, message=fault.message, span=node.span, hint=fault.hint)

    # --- chains ------------------------------------------------------------------------------------------------------

    def _chain(self, node: Chain) -> Iterator[Diagnostic]:
        """Check the kinds of the operands, and that offsets follow poses."""
        yield from _mixed_product(node)
        if isinstance(node.first, Vector):
            return  # reported at the offset itself
        left = self.kind(node.first)
        for sign, operand in node.rest:
            if isinstance(operand, Vector):
                yield from _offset(left, sign, operand)
                left = Kind.POSE
                continue
            problem = self._operands(node, left, sign, operand)
            if problem is not None:
                # the first only: every further sign of "a" + 1 + 2 would be another finding of one mistake
                yield problem
                return

    def _operands(self, node: Chain, left: Kind | None, sign: str, operand: Expression) -> Diagnostic | None:
        """Return what is wrong with the two sides of a sign, of which none is an offset."""
        right = self.kind(operand)
        if Kind.POSE in (left, right):
            message = f"{sign} cannot take a pose; only + or * and an offset may follow one, as in P1 + (0, 0, 50)"
            moved, other, kind = (node.first, operand, right) if left is Kind.POSE else (operand, node.first, left)
            hint = kind_hints.offset(moved, sign, other, kind)
            return Diagnostic(code="RBL217", message=message, span=moved.span, hint=hint)
        if left is not None and right is not None and left is not right:
            message = f"{sign} cannot take {left} and {right}"
            hint = kind_hints.instead(left, operand, right)
            return Diagnostic(code="RBL217", message=message, span=operand.span, hint=hint)
        if left is Kind.TEXT and sign not in _OF_TEXTS:
            message = f"{sign} cannot take texts; + joins them"
            return Diagnostic(code="RBL217", message=message, span=node.span, hint="VAL(s$) is the number of a text")
        return None

    # --- kinds -------------------------------------------------------------------------------------------------------

    def kind(self, node: Expression) -> Kind | None:
        """Return the kind of an expression; None where only a run can tell."""
        if isinstance(node, Name):
            return self._kind_of_name(node)
        if isinstance(node, Call):
            return _kind_of_call(node)
        if isinstance(node, Chain):
            return self._kind_of_chain(node)
        return _KINDS.get(type(node))

    def _kind_of_name(self, node: Name) -> Kind | None:
        if node.key.endswith("$"):
            return Kind.TEXT
        taught = self._symbols.points is not None and node.key in self._symbols.points
        # None: a name without $ holds a number or a pose, and a variable hides a taught point
        return Kind.POSE if taught and not self._defined.has_value(node.key) else None

    def _kind_of_chain(self, node: Chain) -> Kind | None:
        if any(isinstance(operand, Vector) for _, operand in node.rest):
            return Kind.POSE
        first = self.kind(node.first)
        if first is Kind.POSE:
            return None  # reported as a chain
        if node.rest[0][0] != "+":
            return Kind.NUMBER
        return first or self.kind(node.rest[0][1])


_KINDS = {
    Number: Kind.NUMBER,
    Negate: Kind.NUMBER,
    Not: Kind.NUMBER,
    Component6: Kind.NUMBER,
    Text: Kind.TEXT,
    Vector: Kind.OFFSET,
}
"""Kinds of the nodes whose kind is the same wherever they stand."""
_RULES: dict[type, Callable[..., Iterator[Diagnostic]]] = {
    Name: ExpressionCheck._name,
    Call: ExpressionCheck._call,
    Component6: ExpressionCheck._component,
    Chain: ExpressionCheck._chain,
    Negate: ExpressionCheck._operand,
    Not: ExpressionCheck._operand,
    Vector: ExpressionCheck._vector,
}


def _kind_of_call(node: Call) -> Kind | None:
    function = FUNCTIONS.get(node.name.key)
    if function is not None:
        return function.result
    return Kind.TEXT if node.name.key.endswith("$") else None


def _offset(left: Kind | None, sign: str, operand: Vector) -> Iterator[Diagnostic]:
    """Check an offset after a sign; ``left`` is the kind of what the sign follows."""
    counts = _OFFSET_COUNTS.get(sign, ())
    if left in (Kind.NUMBER, Kind.TEXT) or not counts:
        message = f"an offset may only follow a pose and + or *, not {left or 'a value'} and {sign}"
        hint = (
            kind_hints.negated(operand) if left is not Kind.NUMBER and sign == "-" else "write the pose before the sign"
        )
        yield Diagnostic(code="RBL217", message=message, span=operand.span, hint=hint)
    elif len(operand.items) not in counts:
        allowed = " or ".join(map(str, counts))
        message = f"an offset after {sign} has {allowed} values, not {len(operand.items)}"
        yield Diagnostic(code="RBL220", message=message, span=operand.span)


def _mixed_product(node: Chain) -> Iterator[Diagnostic]:
    """Report MOD beside * or / without parentheses (RBL231)."""
    signs = {sign for sign, _ in node.rest}
    if "MOD" not in signs or signs == {"MOD"}:
        return
    message = "MOD, * and / have the same precedence and are computed from left to right"
    hint = ""
    # with more signs there is more than one place for the parentheses
    if len(node.rest) == 2:
        (sign, second), last = node.rest
        hint = f"write {print_expression(Chain(first=Chain(first=node.first, rest=((sign, second),)), rest=(last,)))}"
    yield Diagnostic(code="RBL231", severity=Severity.WARNING, message=message, span=node.span, hint=hint)
