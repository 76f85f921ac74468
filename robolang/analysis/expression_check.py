"""Expressions: undefined names, values of the wrong kind, calls with the wrong count, and what has no value at all."""

import math
from collections.abc import Iterator

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
from robolang.syntax.keywords import ARGUMENTS, COMPONENTS6, near
from robolang.syntax.unparse import print_expression
from runtime.robot.model.drives import beyond_range


class ExpressionCheck:
    """Checks the expressions of a program that has ``defined`` names in a cell of ``symbols``."""

    def __init__(self, symbols: CellSymbols, defined: Defined) -> None:
        self._symbols, self._defined = symbols, defined

    @property
    def _known(self) -> frozenset[str]:
        """Every name that has a value here."""
        return frozenset((self._symbols.points or frozenset()) | self._defined.values)

    def check(self, node: Expression) -> Iterator[Diagnostic]:
        """Report what is wrong in an expression and in everything inside of it."""
        skip: set[int] = set()
        behind: set[int] = set()
        for each in walk(node):
            if id(each) in skip:
                continue
            if isinstance(each, Name):
                yield from self._name(each)
            elif isinstance(each, Call):
                skip.add(id(each.name))
                yield from self._call(each)
            elif isinstance(each, Component6):
                skip.add(id(each.name))
                yield from _component(each)
            elif isinstance(each, Chain):
                behind.update(id(operand) for _, operand in each.rest)
                yield from self._chain(each)
            elif isinstance(each, Negate | Not):
                yield from self.must_be(each.operand, "a number")
            elif isinstance(each, Vector) and id(each) not in behind:
                message = "a way in parentheses stands behind a pose and + or *, as in P1 + (0, 0, 50)"
                yield Diagnostic(code="RBL217", message=message, span=each.span)
            if isinstance(each, Vector):
                for item in each.items:
                    yield from self.finite(item)
        yield from no_value(node)

    def finite(self, node: Expression) -> Iterator[Diagnostic]:
        """Report a number that is none, NAN or INF, where only a finite one can stand."""
        value = fixed(node)
        if value is not None and not math.isfinite(value):
            yield Diagnostic(code="RBL209", message=f"this has no value: {value:g} is not finite", span=node.span)

    def _name(self, node: Name) -> Iterator[Diagnostic]:
        if self._defined.has_value(node.key) or node.key in ("NAN", "INF"):
            return
        points = self._symbols.points
        if points is not None and node.key not in points and self._defined.is_missing(node):
            message = f"{node.text} has no value: nothing gives it a first one, and it is no taught point"
            hint = other_languages.VALUES.get(node.key) or hint_for(node, self._known)
            if self._defined.is_of_a_sub(node.key):
                message = f"{node.text} has no value here: only a SUB gives it one, which ends with the SUB"
                hint = f"give {node.text} a first value in the main program"
            yield Diagnostic(code="RBL215", message=message, span=node.span, hint=hint)

    def _call(self, node: Call) -> Iterator[Diagnostic]:
        key, count = node.name.key, len(node.arguments)
        if key in ("HERE", "TIMER", "ERR"):
            return
        if key in ARGUMENTS:
            low, high = ARGUMENTS[key]
            if not low <= count <= high:
                wanted = f"{low}" if low == high else f"{low} to {high}"
                message = f"{key} takes {wanted} value{'s' * (high > 1)}, not {count}"
                yield Diagnostic(code="RBL214", message=message, span=node.span)
                return
            wanted_kind = "a text" if key in ("VAL", "LEN") else "a pose" if key == "DIST" else "a number"
            for argument in node.arguments:
                yield from self.must_be(argument, wanted_kind)
            if key == "IN":
                yield from self._input(node.arguments[0])
            elif key == "JOINT":
                yield from self._joints(node)
        elif not self._defined.has_array(key):
            if not self._defined.is_missing(node.name):
                return
            guess = other_languages.function(key) or near(key, ARGUMENTS)
            hint = f"did you mean {guess}?" if guess else f"DIM {node.name.text}(n) makes an array"
            message = f"{node.name.text} is no array and no function"
            yield Diagnostic(code="RBL215", message=message, span=node.name.span, hint=hint)
        elif count != 1:
            yield Diagnostic(code="RBL214", message=f"an element has one number, not {count}", span=node.span)
        else:
            yield from self.element(node)

    def element(self, node: Call) -> Iterator[Diagnostic]:
        """Report an element that no array of its name has, whatever the run does (RBL507)."""
        index, largest = fixed(node.arguments[0]), self._defined.largest(node.name.key)
        if index is not None and index.is_integer() and not (0.0 <= index <= largest):
            highest = "" if math.isinf(largest) else f" to {largest:g}"
            message = f"{node.name.text} has the elements 0{highest}, no {index:.10g}"
            yield Diagnostic(code="RBL507", message=message, span=node.span)

    def _joints(self, node: Call) -> Iterator[Diagnostic]:
        """Report joint angles of another number than the arm has axes, and angles outside of their range."""
        axes, angles = self._symbols.axes, [fixed(item) for item in node.arguments]
        if axes is not None and len(angles) != axes:
            message = f"JOINT has {len(angles)} values, the robot {axes} axes"
            yield Diagnostic(code="RBL307", message=message, span=node.span)
            return
        beyond = beyond_range(angles, self._symbols.limits or ())
        if beyond:
            yield Diagnostic(code="RBL309", message=beyond, span=node.span)

    def _input(self, node: Expression) -> Iterator[Diagnostic]:
        number, inputs = fixed(node), self._symbols.inputs
        if number is not None and inputs is not None and number not in inputs:
            known = ", ".join(map(str, sorted(inputs))) or "none"
            message = f"the cell has no input {number:g} (known: {known})"
            yield Diagnostic(code="RBL534", message=message, span=node.span)

    def _chain(self, node: Chain) -> Iterator[Diagnostic]:
        """Check the kinds of the operands, and that ways in parentheses stand behind poses."""
        yield from _mixed_product(node)
        left = self.kind(node.first)
        if isinstance(node.first, Vector):
            return  # said of the vector itself
        for sign, operand in node.rest:
            if isinstance(operand, Vector):
                wanted = (3,) if sign == "+" else (3, 6) if sign == "*" else ()
                if left in ("a number", "a text") or not wanted:
                    message = f"a way in parentheses stands behind {left or 'a value'} and {sign}, not behind a pose"
                    yield Diagnostic(code="RBL217", message=message, span=operand.span)
                elif len(operand.items) not in wanted:
                    counts = " or ".join(map(str, wanted))
                    yield Diagnostic(
                        code="RBL220",
                        message=f"{sign} takes {counts} values in parentheses, not {len(operand.items)}",
                        span=operand.span,
                    )
                left = "a pose"
                continue
            right = self.kind(operand)
            if "a pose" in (left, right):
                where = node.first if left == "a pose" else operand
                message = f"a pose stands beside {sign}; behind it stand + or * and a way, as in P1 + (0, 0, 50)"
                yield Diagnostic(code="RBL217", message=message, span=where.span)
                return
            if left is not None and right is not None and left != right:
                message = f"{left} and {right} stand on the sides of {sign}"
                yield Diagnostic(code="RBL217", message=message, span=operand.span)
                return
            if left == "a text" and sign not in ("+", "=", "<>", "<", ">", "<=", ">="):
                yield Diagnostic(code="RBL217", message=f"texts stand on the sides of {sign}", span=node.span)
                return

    def kind(self, node: Expression) -> str | None:
        """Return what an expression is, in words; None where only a run can tell."""
        if isinstance(node, Number | Negate | Not | Component6):
            return "a number"
        if isinstance(node, Text):
            return "a text"
        if isinstance(node, Name):
            if node.key.endswith("$"):
                return "a text"
            taught = self._symbols.points is not None and node.key in self._symbols.points
            return "a pose" if taught and not self._defined.has_value(node.key) else None
        if isinstance(node, Call):
            if node.name.key in ("POSE", "JOINT", "HERE"):
                return "a pose"
            if node.name.key in ("TIMER", "ERR"):
                return "a number"
            return "a text" if node.name.key.endswith("$") else "a number" if node.name.key in ARGUMENTS else None
        if isinstance(node, Chain):
            if any(isinstance(operand, Vector) for _, operand in node.rest):
                return "a pose"
            if self.kind(node.first) == "a pose":
                return None  # reported as a chain
            if node.rest[0][0] not in "+":
                return "a number"
            return self.kind(node.first) or self.kind(node.rest[0][1])
        return "a way in parentheses" if isinstance(node, Vector) else None

    def must_be(self, node: Expression, wanted: str) -> Iterator[Diagnostic]:
        """Report an expression of another kind than is wanted, ``"a number"`` for one (RBL217)."""
        kind = self.kind(node)
        if kind is not None and kind != wanted:
            yield Diagnostic(code="RBL217", message=f"{kind} stands where {wanted} is needed", span=node.span)


def _mixed_product(node: Chain) -> Iterator[Diagnostic]:
    """Report MOD beside * or / without parentheses (RBL231)."""
    signs = {sign for sign, _ in node.rest}
    if "MOD" not in signs or signs == {"MOD"}:
        return
    message = "MOD stands beside * or /; they are worked out from the left"
    hint = ""
    if len(node.rest) == 2:
        (sign, second), last = node.rest
        hint = f"write {print_expression(Chain(first=Chain(first=node.first, rest=((sign, second),)), rest=(last,)))}"
    yield Diagnostic(code="RBL231", severity=Severity.WARNING, message=message, span=node.span, hint=hint)


def _component(node: Component6) -> Iterator[Diagnostic]:
    if node.name.key not in COMPONENTS6:
        message = f"a pose has no component {node.name.text}"
        yield Diagnostic(code="RBL218", message=message, span=node.name.span)
