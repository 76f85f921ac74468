"""Values that a text alone gives: expressions of numbers, worked out before anything runs."""

import math
from collections.abc import Iterator
from typing import NoReturn

from robolang.core.diagnostics import Diagnostic
from robolang.evaluation.evaluator import Evaluator, Nowhere
from robolang.syntax.ast import Call, Expression, Name, Negate, Number, Text, walk
from robolang.values.poses import Value
from runtime.core.faults import Fault


class _NoNames:
    """Names without values: what needs one is not constant."""

    def value(self, key: str) -> Value | None:
        if key in ("NAN", "INF"):
            return None
        raise _VariableError

    def element(self, key: str, index: int) -> Value | None:
        raise _VariableError


class _VariableError(Exception):
    """A value that depends on a name."""


class _Static(Nowhere):
    def _refuse(self, what: str) -> NoReturn:
        raise _VariableError


_EVALUATOR = Evaluator(_NoNames(), _Static())


_CONSTANTS = {"NAN": math.nan, "INF": math.inf}


def _number(expression: Expression) -> float | None:
    """Return the value of an expression of signs and numbers alone; None when it needs more.

    ``NAN`` and ``INF`` are names that the text may contain; the checker refuses them wherever they stand.
    """
    sign = 1.0
    while isinstance(expression, Negate):
        sign, expression = -sign, expression.operand
    if isinstance(expression, Number):
        return sign * expression.value
    value = _CONSTANTS.get(expression.key) if isinstance(expression, Name) else None
    return None if value is None else sign * value


def _depends(node: Expression) -> bool:
    """Return whether an expression reads ERR, which has a value in a handler only."""
    return any(isinstance(each, Call) and each.name.key == "ERR" for each in walk(node))


def fixed(node: Expression) -> float | None:
    """Return the value of an expression of numbers alone; None when it needs more or has none."""
    # most operands are literals, which need no evaluator
    value = _number(node)
    if value is not None or isinstance(node, Number | Name | Negate) or _depends(node):
        return value
    try:
        found = _EVALUATOR.value(node)
    except (_VariableError, Fault, RecursionError):  # too deep: the checker refuses the statement
        return None
    return found if isinstance(found, float) else None


def no_value(node: Expression) -> Iterator[Diagnostic]:
    """Report what has no value whatever the variables are: 1 / 0, SQR(-1)."""
    if isinstance(node, Number | Name | Text | Negate) or _depends(node):
        return
    try:
        _EVALUATOR.value(node)
    except _VariableError:
        return
    except Fault as fault:
        if fault.code in ("RBL501", "RBL502"):
            yield Diagnostic(code="RBL209", message=f"this expression has no value: {fault.message}", span=node.span)
