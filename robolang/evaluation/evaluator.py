"""Expressions to values: arithmetic, texts, poses, and the functions of the language.

Numbers are floats; a comparison gives 1 or 0, and anything but 0 is true. Angles are degrees. Precedence is in the
tree (``grammar.lark``). What has no value is a ``Fault``: RBL501 division by zero, RBL502 no finite result, RBL506 a
text that is too long, RBL507 no such element, RBL531 a value of another kind, RBL532 a name without.
``World`` is what a running program can ask of the robot; it is asked when the motion before it has ended.
"""

import math
from collections.abc import Callable, Mapping
from typing import NoReturn, Protocol

from robolang.evaluation.values import Frame, Place, Shift, Six, Value, kind_of
from robolang.syntax.ast import Call, Chain, Component6, Expression, Name, Negate, Not, Number, Text, Vector
from robolang.syntax.keywords import ARGUMENTS, COMPONENTS6, VALUES
from runtime.core.faults import Fault
from runtime.core.numerals import number_in

MAX_TEXT = 10_000
"""Longest text that a program may make, characters."""
MAX_SHIFTS = 1000
"""Most ways and turns that a pose can have behind it."""


class World(Protocol):
    """What a program can read of the robot and its cell."""

    def input(self, number: int) -> float:
        """Return the state of an input; ``Fault`` RBL534 when the cell has none of that number."""

    def seconds(self) -> float:
        """Return the time since the program began, s."""

    def here(self) -> Six:
        """Return where the tool is commanded to be, mm and deg in the world."""

    def components(self, place: Place, frame: Frame) -> Six:
        """Return a place in a frame, mm and deg."""


class Nowhere:
    """A world for programs that ask nothing of it: everything is a ``Fault``."""

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
        raise Fault("RBL532", f"{what} is known while a program runs only")


class Names(Protocol):
    """Where names get their values."""

    def value(self, key: str) -> Value | None:
        """Return the value of a name, None when it has none."""

    def element(self, key: str, index: int) -> Value | None:
        """Return an element of an array, None when there is no such array; ``Fault`` RBL507."""


class Evaluator:
    """Evaluates expressions; ``frame`` is the active frame, ``error`` the number of the error that ON ERROR caught."""

    def __init__(self, names: Names, world: World) -> None:
        self._names, self._world = names, world
        self.frame: Frame = ""
        self.error = 0.0

    def value(self, node: Expression) -> Value:
        """Return the value of an expression; ``Fault`` where it has none."""
        if isinstance(node, Number):
            return node.value
        if isinstance(node, Text):
            return node.value
        if isinstance(node, Name):
            return self._name(node)
        if isinstance(node, Negate):
            return -self.number(node.operand)
        if isinstance(node, Not):
            return float(not self.number(node.operand))
        if isinstance(node, Chain):
            return self._chain(node)
        if isinstance(node, Call):
            return self._call(node)
        if isinstance(node, Component6):
            return self._component(node)
        raise Fault("RBL531", "a way in parentheses stands behind a pose and + or * only")

    def number(self, node: Expression) -> float:
        """Return the value of an expression that must be a number."""
        value = self.value(node)
        if not isinstance(value, float):
            raise Fault("RBL531", f"{kind_of(value)} stands where a number is needed")
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
            raise Fault("RBL531", f"{kind_of(value)} stands where a pose is needed")
        return value

    def six(self, place: Place) -> Six:
        """Return the numbers of a place in the active frame."""
        return self._world.components(place, self.frame)

    def _name(self, node: Name) -> Value:
        value = self._names.value(node.key)
        if value is None:
            if node.key in ("NAN", "INF"):
                return math.nan if node.key == "NAN" else math.inf
            raise Fault("RBL532", f"{node.text} has no value")
        return value

    # --- operators ---------------------------------------------------------------------------------------------------

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
        """Return the value of AND, or of OR and XOR, from the left; what can change nothing any more is not asked."""
        value = self.true(node.first)
        for sign, operand in node.rest:
            if sign == "XOR":
                value = value is not self.true(operand)
            elif value is not (sign == "OR"):
                value = self.true(operand)
        return value

    def _place(self, place: Place, sign: str, operand: Expression) -> Place:
        if not isinstance(operand, Vector) or sign not in ("+", "*"):
            raise Fault("RBL531", "behind a pose stand + or * and a way in parentheses, as in P1 + (0, 0, 50)")
        by = [self.number(item) for item in operand.items]
        if not (len(by) == 3 or (len(by) == 6 and sign == "*")):
            raise Fault("RBL531", f"{len(by)} values stand in parentheses; + takes 3 of them, * takes 3 or 6")
        if not all(map(math.isfinite, by)):
            raise Fault("RBL502", "a way is not finite")
        if len(place.shifts) >= MAX_SHIFTS:
            raise Fault("RBL502", f"more than {MAX_SHIFTS} ways and turns stand behind one pose")
        x, y, z, rx, ry, rz = (*by, 0.0, 0.0, 0.0)[:6]
        kind = "frame" if sign == "+" else "tool"
        return place.shifted(Shift(kind=kind, by=(x, y, z, rx, ry, rz), frame=self.frame))  # type: ignore[arg-type]

    def _apply(self, left: float | str, sign: str, operand: Expression) -> float | str:
        right = self.value(operand)
        if isinstance(right, Place) or isinstance(left, str) is not isinstance(right, str):
            raise Fault("RBL531", f"{kind_of(left)} and {kind_of(right)} stand on the sides of {sign}")
        if sign in _COMPARISONS:
            return float(_COMPARISONS[sign](left, right))
        if isinstance(left, str) or isinstance(right, str):
            if sign != "+":
                raise Fault("RBL531", f"texts stand on the sides of {sign}; + joins them")
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
            result = finite(math.nan if isinstance(power, complex) else power, "^")
        return result

    # --- functions ---------------------------------------------------------------------------------------------------

    def _call(self, node: Call) -> Value:
        key = node.name.key
        if key in _NUMERIC:
            return self._numeric(node)
        self._counted(node)
        special: Callable[[Call], Value] | None = getattr(self, f"_do_{key.rstrip('$').lower()}", None)
        if special is not None and key in SPECIAL:
            return special(node)
        index = self.whole(node.arguments[0], f"the number of an element of {node.name.text}")
        value = self._names.element(key, index)
        if value is None:
            raise Fault("RBL532", f"there is no array {node.name.text}: DIM {node.name.text}(n) makes one")
        return value

    def _numeric(self, node: Call) -> float:
        self._counted(node)
        try:
            result = float(_NUMERIC[node.name.key](*(self.number(item) for item in node.arguments)))
        except (ValueError, OverflowError):  # of NAN and INF, and beyond the largest number
            result = math.nan
        return finite(result, node.name.text)

    def _counted(self, node: Call) -> None:
        """Refuse another number of arguments than a function takes; the checker has said so where it is RBL214."""
        low, high = ARGUMENTS.get(node.name.key, (1, 1))
        if node.name.key not in VALUES and not low <= len(node.arguments) <= high:
            raise Fault("RBL531", f"{node.name.text} takes another number of values than {len(node.arguments)}")

    def _do_in(self, node: Call) -> Value:
        number = self.number(node.arguments[0])
        if not (math.isfinite(number) and number == math.floor(number)):
            raise Fault("RBL534", f"there is no input {number:g}: its number is whole")
        return self._world.input(int(number))

    def _do_timer(self, node: Call) -> Value:
        return self._world.seconds()

    def _do_err(self, node: Call) -> Value:
        return self.error

    def _do_here(self, node: Call) -> Value:
        return Place(pose=self._world.here())

    def _do_pose(self, node: Call) -> Value:
        x, y, z, rx, ry, rz = (finite(self.number(item), "POSE") for item in node.arguments)
        return Place(pose=(x, y, z, rx, ry, rz), frame=self.frame)

    def _do_joint(self, node: Call) -> Value:
        return Place(joints=tuple(finite(self.number(item), "JOINT") for item in node.arguments))

    def _do_dist(self, node: Call) -> Value:
        a, b = (self.six(self.place(item)) for item in node.arguments)
        return math.dist(a[:3], b[:3])

    def _do_str(self, node: Call) -> Value:
        return shown(self.number(node.arguments[0]))

    def _do_val(self, node: Call) -> Value:
        text = self._text(node.arguments[0])
        number = number_in(text.strip())
        if number is None:
            raise Fault("RBL502", f"VAL of '{text[:20]}': that is no number")
        return finite(number, "VAL")

    def _do_len(self, node: Call) -> Value:
        return float(len(self._text(node.arguments[0])))

    def _text(self, node: Expression) -> str:
        value = self.value(node)
        if not isinstance(value, str):
            raise Fault("RBL531", f"{kind_of(value)} stands where a text is needed")
        return value

    def _component(self, node: Component6) -> float:
        if node.name.key not in COMPONENTS6:
            raise Fault("RBL531", f"a pose has no component {node.name.text}")
        return self.six(self.place(node.base))[COMPONENTS6.index(node.name.key)]


SPECIAL = frozenset({"IN", "TIMER", "ERR", "HERE", "POSE", "JOINT", "DIST", "STR$", "VAL", "LEN"})


def shown(value: float) -> str:
    """Return a number as PRINT and STR$ show it: up to ten digits, whole numbers without a point."""
    return f"{value + 0.0:.10g}"


def finite(value: float, what: str) -> float:
    """Return a number, or ``Fault`` RBL502 when it is none."""
    if not math.isfinite(value):
        raise Fault("RBL502", f"{what} has no finite result here")
    return value


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


def _root(x: float) -> float:
    if not x >= 0.0:
        raise Fault("RBL502", f"SQR of {shown(x)} is no number")
    return math.sqrt(x)


def _round(x: float, digits: float = 0.0) -> float:
    """Round half away from zero, as people do."""
    scale = 10.0 ** max(-12.0, min(12.0, math.floor(digits)))
    return math.copysign(math.floor(abs(x) * scale + 0.5) / scale, x)


_COMPARISONS: Mapping[str, Callable[[float | str, float | str], bool]] = {
    "=": lambda a, b: a == b,
    "<>": lambda a, b: a != b,
    "<": lambda a, b: a < b,  # type: ignore[operator]
    ">": lambda a, b: a > b,  # type: ignore[operator]
    "<=": lambda a, b: a <= b,  # type: ignore[operator]
    ">=": lambda a, b: a >= b,  # type: ignore[operator]
}
_NUMERIC: Mapping[str, Callable[..., float]] = {
    "ABS": abs,
    "SGN": lambda x: float((x > 0.0) - (x < 0.0)),
    "INT": math.floor,
    "ROUND": _round,
    "SQR": _root,
    "SIN": lambda x: math.sin(math.radians(x)),
    "COS": lambda x: math.cos(math.radians(x)),
    "TAN": lambda x: math.tan(math.radians(x)),
    "ATN2": lambda y, x: math.degrees(math.atan2(y, x)),
    "MIN": lambda *x: min(x),
    "MAX": lambda *x: max(x),
    "DEG": math.degrees,
    "RAD": math.radians,
}
