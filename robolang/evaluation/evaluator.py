"""Expressions to values: arithmetic, texts, poses, and the functions of the language.

Numbers are floats; a comparison gives 1 or 0, and anything but 0 is true. Angles are degrees. Precedence is in the
tree (``grammar.lark``). What has no value is a ``Fault``: RBL501 division by zero, RBL502 no finite result, RBL506 a
text that is too long, RBL507 no such element, RBL531 a value of another kind, RBL532 a name without.
``World`` is what a running program can read of the robot; it is read when the motion before it has ended.
"""

import math
from collections.abc import Callable, Mapping
from typing import NoReturn, Protocol

from robolang.syntax.ast import Call, Chain, Component6, Expression, Name, Negate, Not, Number, Text, Vector
from robolang.syntax.keywords import COMPONENTS6
from robolang.values.functions import FUNCTIONS, Robot, finite, shown
from robolang.values.kinds import Kind
from robolang.values.poses import Frame, Place, Shift, Six, Value, kind_of
from runtime.core.faults import Fault

MAX_TEXT = 10_000
"""Longest text that a program may make, characters."""
MAX_SHIFTS = 1000
"""Most offsets that one pose can have."""


class World(Robot, Protocol):
    """What a program can read of the robot and its cell."""

    def components(self, place: Place, frame: Frame) -> Six:
        """Return a place in a frame, mm and deg."""


class Nowhere:
    """A world for programs that read nothing of it: everything is a ``Fault``."""

    def input(self, number: int) -> float:
        """Refuse."""
        self._refuse(f"input {number}")

    def seconds(self) -> float:
        """Refuse."""
        self._refuse("the time")

    def here(self) -> Six:
        """Refuse."""
        self._refuse("where the robot is")

    def components(self, place: Place, frame: Frame) -> Six:
        """Refuse."""
        self._refuse("the numbers of a pose")

    def _refuse(self, what: str) -> NoReturn:
        raise Fault("RBL532", f"{what} is known only while a program runs")


class Names(Protocol):
    """Where names get their values."""

    def value(self, key: str) -> Value | None:
        """Return the value of a name, None when it has none."""

    def element(self, key: str, index: int) -> Value | None:
        """Return an element of an array, None when there is no such array; ``Fault`` RBL507."""


class Evaluator:
    """Evaluates expressions; ``frame`` is the active frame, ``error`` the number of the error that ON ERROR caught.

    ``robot`` is what the functions of the language ask.
    """

    def __init__(self, names: Names, world: World) -> None:
        self._names, self._world = names, world
        self.frame: Frame = ""
        self.error = 0.0

    @property
    def robot(self) -> Robot:
        """The robot that the program runs on."""
        return self._world

    def value(self, node: Expression) -> Value:
        """Return the value of an expression; ``Fault`` where it has none."""
        return _VALUE[type(node)](self, node)

    def number(self, node: Expression) -> float:
        """Return the value of an expression that must be a number."""
        value = self.value(node)
        if not isinstance(value, float):
            raise _other_kind(value, Kind.NUMBER)
        return value

    def true(self, node: Expression) -> bool:
        """Return whether an expression is true."""
        return self.number(node) != 0.0

    def whole(self, node: Expression, what: str) -> int:
        """Return the value of an expression that must be a whole number."""
        value = self.number(node)
        if not (math.isfinite(value) and value == math.floor(value)):
            raise Fault("RBL531", f"{what} is {value:g}, not a whole number")
        return int(value)

    def place(self, node: Expression) -> Place:
        """Return the value of an expression that must be a pose."""
        value = self.value(node)
        if not isinstance(value, Place):
            raise _other_kind(value, Kind.POSE)
        return value

    def six(self, place: Place) -> Six:
        """Return the numbers of a place in the active frame."""
        return self._world.components(place, self.frame)

    def _literal(self, node: Number | Text) -> Value:
        return node.value

    def _name(self, node: Name) -> Value:
        value = self._names.value(node.key)
        if value is None:
            if node.key in ("NAN", "INF"):
                return math.nan if node.key == "NAN" else math.inf
            raise Fault("RBL532", f"{node.text} has no value")
        return value

    def _offset(self, node: Vector) -> NoReturn:
        raise Fault("RBL531", "an offset (x, y, z) may only follow a pose and + or *")

    # --- operators ---------------------------------------------------------------------------------------------------

    def _negate(self, node: Negate) -> float:
        return -self.number(node.operand)

    def _not(self, node: Not) -> float:
        return float(not self.number(node.operand))

    def _chain(self, node: Chain) -> Value:
        sign = node.rest[0][0]
        if sign == "^":
            return self._power(node)
        if sign in ("AND", "OR", "XOR"):
            return float(self._condition(node))
        value = self.value(node.first)
        for sign, operand in node.rest:
            value = self._place(value, sign, operand) if isinstance(value, Place) else self._apply(value, sign, operand)
        return value

    def _condition(self, node: Chain) -> bool:
        """Return the value of AND, or of OR and XOR, from the left; what cannot change it is not evaluated."""
        value = self.true(node.first)
        for sign, operand in node.rest:
            if sign == "XOR":
                value = value is not self.true(operand)
            elif value is not (sign == "OR"):
                value = self.true(operand)
        return value

    def _place(self, place: Place, sign: str, operand: Expression) -> Place:
        if not isinstance(operand, Vector) or sign not in ("+", "*"):
            raise Fault("RBL531", "only + or * and an offset may follow a pose, as in P1 + (0, 0, 50)")
        by = [self.number(item) for item in operand.items]
        if not (len(by) == 3 or (len(by) == 6 and sign == "*")):
            raise Fault("RBL531", f"the offset has {len(by)} values; + takes 3, * takes 3 or 6")
        if not all(map(math.isfinite, by)):
            raise Fault("RBL502", "an offset is not finite")
        if len(place.shifts) >= MAX_SHIFTS:
            raise Fault("RBL502", f"one pose has more than {MAX_SHIFTS} offsets")
        x, y, z, rx, ry, rz = (*by, 0.0, 0.0, 0.0)[:6]
        kind = "frame" if sign == "+" else "tool"
        return place.shifted(Shift(kind=kind, by=(x, y, z, rx, ry, rz), frame=self.frame))  # type: ignore[arg-type]

    def _apply(self, left: float | str, sign: str, operand: Expression) -> float | str:
        right = self.value(operand)
        if isinstance(right, Place) or isinstance(left, str) is not isinstance(right, str):
            raise Fault("RBL531", f"{sign} cannot take {kind_of(left)} and {kind_of(right)}")
        if sign in _COMPARISONS:
            return float(_COMPARISONS[sign](left, right))
        if isinstance(left, str) or isinstance(right, str):
            if sign != "+":
                raise Fault("RBL531", f"{sign} cannot take texts; + joins them")
            return checked_text(f"{left}{right}")
        return finite(_arithmetic(left, sign, right), sign)

    def _power(self, node: Chain) -> float:
        values = [self.number(part) for part in (node.first, *(part for _, part in node.rest))]
        result = values.pop()
        while values:
            try:
                power = values.pop() ** result
            except (OverflowError, ZeroDivisionError):
                power = math.inf
            # Python gives a complex number for a negative base with a fraction as exponent
            result = finite(math.nan if isinstance(power, complex) else power, "^")
        return result

    # --- functions ---------------------------------------------------------------------------------------------------

    def _call(self, node: Call) -> Value:
        function = FUNCTIONS.get(node.name.key)
        if function is None:
            return self._element(node)
        count = len(node.arguments)
        if not function.least <= count <= function.most:  # the checker has reported it as RBL214
            raise Fault("RBL531", f"{function.form} does not take {count} values")
        arguments = [self._of_kind(item, function.kind(index)) for index, item in enumerate(node.arguments)]
        return function.apply(self, *arguments)

    def _of_kind(self, node: Expression, kind: Kind) -> Value:
        value = self.value(node)
        if kind_of(value) is not kind:
            raise _other_kind(value, kind)
        return value

    def _element(self, node: Call) -> Value:
        name = node.name
        if len(node.arguments) != 1:
            raise Fault("RBL531", f"an element of {name.text} has one index, not {len(node.arguments)}")
        index = self.whole(node.arguments[0], f"the number of an element of {name.text}")
        value = self._names.element(name.key, index)
        if value is None:
            raise Fault("RBL532", f"there is no array {name.text}: DIM {name.text}(n) makes one")
        return value

    def _component(self, node: Component6) -> float:
        if node.name.key not in COMPONENTS6:
            raise Fault("RBL531", f"a pose has no component {node.name.text}")
        return self.six(self.place(node.base))[COMPONENTS6.index(node.name.key)]


_VALUE: Mapping[type, Callable[..., Value]] = {
    Number: Evaluator._literal,
    Text: Evaluator._literal,
    Name: Evaluator._name,
    Negate: Evaluator._negate,
    Not: Evaluator._not,
    Chain: Evaluator._chain,
    Call: Evaluator._call,
    Component6: Evaluator._component,
    Vector: Evaluator._offset,
}


def _other_kind(value: Value, needed: Kind) -> Fault:
    return Fault("RBL531", f"{needed} is needed here, not {kind_of(value)}")


def checked_text(text: str) -> str:
    """Return a text, or ``Fault`` RBL506 when it is too long."""
    if len(text) > MAX_TEXT:
        raise Fault("RBL506", f"a text of {len(text)} characters is longer than {MAX_TEXT}")
    return text


def _arithmetic(left: float, sign: str, right: float) -> float:
    if sign == "+":
        return left + right
    if sign == "-":
        return left - right
    if sign == "*":
        return left * right
    if right == 0.0:
        raise Fault("RBL501", f"{shown(left)} {sign} 0")
    return left / right if sign == "/" else left % right


_COMPARISONS: Mapping[str, Callable[[float | str, float | str], bool]] = {
    "=": lambda a, b: a == b,
    "<>": lambda a, b: a != b,
    "<": lambda a, b: a < b,  # type: ignore[operator]
    ">": lambda a, b: a > b,  # type: ignore[operator]
    "<=": lambda a, b: a <= b,  # type: ignore[operator]
    ">=": lambda a, b: a >= b,  # type: ignore[operator]
}
