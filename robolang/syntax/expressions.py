"""The nodes of expressions, and the parts of statements that are no expressions: one class for each rule.

Names keep the user's spelling in ``text`` and compare by ``key``, since the language ignores case.
"""

from enum import Enum
from sys import intern
from typing import ClassVar, Final, TypeAlias

from robolang.core.source import Span
from robolang.syntax.tree import NOWHERE, Node


class Operand(Node):
    """A part of an expression; ``parentheses``: how many pairs are written around it, which do not change its value."""

    __slots__ = ("parentheses",)
    parentheses: int


class Number(Operand):
    """A literal; ``text`` is its spelling."""

    __slots__ = ("text", "value")
    compared = ("value",)

    def __init__(self, *, value: float, text: str, parentheses: int = 0, span: Span = NOWHERE) -> None:
        self.value: Final = value
        self.text: Final = text
        self.parentheses = parentheses
        self.span = span


class Text(Operand):
    """A literal between double quotes, ``value`` without them; ``""`` in it is one of its double quotes."""

    __slots__ = ("value",)

    def __init__(self, *, value: str, parentheses: int = 0, span: Span = NOWHERE) -> None:
        self.value: Final = value
        self.parentheses = parentheses
        self.span = span


class Name(Operand):
    """The name of a point, a sensor or a value; ``key`` is the spelling that is compared and looked up."""

    __slots__ = ("key", "text")
    compared = ("key",)
    computed = ("key",)

    def __init__(self, *, text: str, parentheses: int = 0, span: Span = NOWHERE) -> None:
        self.text: Final = text
        upper = text.upper()
        # names recur throughout a program: one text for all of them saves memory
        self.key: Final = text if upper == text else intern(upper)
        self.parentheses = parentheses
        self.span = span


class Negate(Operand):
    """``-operand``."""

    __slots__ = ("operand",)

    def __init__(self, *, operand: "Expression", parentheses: int = 0, span: Span = NOWHERE) -> None:
        self.operand: Final = operand
        self.parentheses = parentheses
        self.span = span


class Not(Operand):
    """``NOT operand``."""

    __slots__ = ("operand",)

    def __init__(self, *, operand: "Expression", parentheses: int = 0, span: Span = NOWHERE) -> None:
        self.operand: Final = operand
        self.parentheses = parentheses
        self.span = span


class Chain(Operand):
    """Operands of one precedence with the signs between them: ``first rest[0] rest[1] ...``; flat, however long.

    Signs are ``OR XOR AND = <> < > <= >= + - * / MOD ^``. They apply from the left, except ``^``, whose base is all
    that is left of it.
    """

    __slots__ = ("first", "rest")

    def __init__(
        self,
        *,
        first: "Expression",
        rest: tuple[tuple[str, "Expression"], ...],
        parentheses: int = 0,
        span: Span = NOWHERE,
    ) -> None:
        self.first: Final = first
        self.rest: Final = rest
        self.parentheses = parentheses
        self.span = span


class Call(Operand):
    """A function of the language, or an element of an array: ``ABS(x)``, ``POSE(...)``, ``HERE``, ``a(3)``.

    ``name.key`` says which; a word such as HERE or TIMER has no arguments.
    """

    __slots__ = ("name", "arguments")

    def __init__(
        self, *, name: Name, arguments: tuple["Expression", ...] = (), parentheses: int = 0, span: Span = NOWHERE
    ) -> None:
        self.name: Final = name
        self.arguments: Final = arguments
        self.parentheses = parentheses
        self.span = span


class Component6(Operand):
    """``base.X`` to ``base.RZ``: a component of a pose, mm or deg."""

    __slots__ = ("base", "name")

    def __init__(self, *, base: "Expression", name: Name, parentheses: int = 0, span: Span = NOWHERE) -> None:
        self.base: Final = base
        self.name: Final = name
        self.parentheses = parentheses
        self.span = span


class Vector(Operand):
    """``(x, y, z)``, or six values: an offset, with a rotation where it has six."""

    __slots__ = ("items",)

    def __init__(self, *, items: tuple["Expression", ...], parentheses: int = 0, span: Span = NOWHERE) -> None:
        self.items: Final = items
        self.parentheses = parentheses
        self.span = span


Expression: TypeAlias = Number | Text | Name | Negate | Not | Chain | Call | Component6 | Vector


class WristMode(Enum):
    """What the wrist may do on a move: ``KEEP`` the sign of J5, change it (``AUTO``), or that with components held."""

    KEEP = "KEEP"
    AUTO = "AUTO"
    HOLD = "HOLD"


class Component(Enum):
    """A component of the posture that ``WRIST HOLD`` holds."""

    TILT = "TILT"
    ADVANCE = "ADVANCE"
    ROTATION = "ROTATION"


class HandState(Enum):
    """The command to the hand: ``ON`` closes, ``OFF`` opens."""

    ON = "ON"
    OFF = "OFF"


class Wrist(Node):
    """``WRIST KEEP|AUTO`` or ``WRIST HOLD c {, c}``: an option of one move, or a statement for the moves that follow.

    ``held`` are the components of HOLD as written, ``held_spans`` their places; the checker bounds their number.
    """

    __slots__ = ("held", "held_spans", "mode")
    compared: ClassVar = ("mode", "held")

    def __init__(
        self,
        *,
        mode: WristMode,
        held: tuple[Component, ...] = (),
        held_spans: tuple[Span, ...] = (),
        span: Span = NOWHERE,
    ) -> None:
        self.mode: Final = mode
        self.held: Final = held
        # a node that no parser made has no places, and readers go through both together
        self.held_spans: Final = held_spans or (NOWHERE,) * len(held)
        self.span = span


class Target(Node):
    """The line that a jump goes to: a line number, or the name of a label; the other is None."""

    __slots__ = ("label", "number")

    def __init__(self, *, number: int | None = None, label: Name | None = None, span: Span = NOWHERE) -> None:
        self.number: Final = number
        self.label: Final = label
        self.span = span


class Unparsed(Node):
    """A statement that has an error; a program that contains one does not run."""

    __slots__ = ("text",)

    def __init__(self, *, text: str, span: Span = NOWHERE) -> None:
        self.text: Final = text
        self.span = span
