"""The syntax tree: frozen values, one class for each rule of ``grammar.lark``.

Two trees are equal when they mean the same text; places (``span``, ``source_line``) take no part. Names keep
the user's spelling in ``text`` and compare by ``key``, since the language ignores case. A line that could not
be parsed is kept as ``Unparsed``, so that line numbers and the formatter see every line; blank lines are not
kept, they are the gaps between the ``source_line`` of neighbours.
"""

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import TypeAlias

from robolang.source import Span

NOWHERE = Span(0, 0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Node:
    """Anything with a place in the text."""

    span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Number(Node):
    """A literal; ``text`` is its spelling."""

    value: float
    text: str = field(compare=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Name(Node):
    """The name of a point, a sensor or a value; ``key`` is the spelling that is compared and looked up."""

    text: str = field(compare=False)
    key: str = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "key", self.text.upper())


@dataclass(frozen=True, slots=True, kw_only=True)
class Negate(Node):
    """``-operand``."""

    operand: "Expression"


Expression: TypeAlias = Number | Name | Negate


@dataclass(frozen=True, slots=True, kw_only=True)
class Vector(Node):
    """``(x, y, z)``."""

    x: Expression
    y: Expression
    z: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Speed(Node):
    """Option ``SPEED v``: speed of the tool point, mm/s."""

    value: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Accel(Node):
    """Option ``ACCEL a``: acceleration, % of the robot's."""

    value: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Time(Node):
    """Option ``TIME t``: duration of the move, s."""

    value: Expression


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


@dataclass(frozen=True, slots=True, kw_only=True)
class Wrist(Node):
    """``WRIST KEEP|AUTO`` or ``WRIST HOLD c {, c}``: an option of one move, or a statement for the moves that follow.

    ``held`` are the components of HOLD as written, ``held_spans`` their places; the checker bounds their number.
    """

    mode: WristMode
    held: tuple[Component, ...] = ()
    held_spans: tuple[Span, ...] = field(default=(), compare=False, repr=False)

    def __post_init__(self) -> None:
        if not self.held_spans:
            object.__setattr__(self, "held_spans", (NOWHERE,) * len(self.held))


Option: TypeAlias = Speed | Accel | Time | Wrist


@dataclass(frozen=True, slots=True, kw_only=True)
class Move(Node):
    """``MOVE target {, option}``: straight line of the tool point."""

    target: Name
    options: tuple[Option, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Load(Node):
    """``LOAD (x, y, z), m``: centre of gravity (mm, flange frame) and mass (kg) beyond the flange."""

    cog: Vector
    mass: Expression


class HandState(Enum):
    """What the hand is told: ``ON`` closes, ``OFF`` opens."""

    ON = "ON"
    OFF = "OFF"


@dataclass(frozen=True, slots=True, kw_only=True)
class Hand(Node):
    """``HAND ON|OFF [, t]``: drive the hand, then wait ``dwell`` seconds (None: the default of the hand)."""

    state: HandState
    dwell: Expression | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Seam(Node):
    """``SEAM ON, sensor`` or ``SEAM OFF`` (``sensor`` None): follow a seam sensor of the cell, or stop following."""

    sensor: Name | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Unparsed(Node):
    """A statement that has an error; a program that contains one does not run."""

    text: str


Statement: TypeAlias = Move | Load | Hand | Wrist | Seam | Unparsed


@dataclass(frozen=True, slots=True, kw_only=True)
class Comment(Node):
    """A comment as written, from ``'`` or ``REM`` to the end of its line."""

    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Line(Node):
    """``[number] [statement] [comment]``; ``source_line`` is 1-based."""

    number: int | None = None
    statement: Statement | None = None
    comment: Comment | None = None
    source_line: int = field(default=1, compare=False)
    number_span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Program:
    """All lines that are not blank, in order."""

    source_path: str = field(compare=False)
    lines: tuple[Line, ...]

    @property
    def comments(self) -> tuple[Comment, ...]:
        """The comments in order."""
        return tuple(line.comment for line in self.lines if line.comment is not None)

    @property
    def statements(self) -> tuple[Line, ...]:
        """The lines that have a statement, in order."""
        return tuple(line for line in self.lines if line.statement is not None)


_CONSTANTS = {"NAN": math.nan, "INF": math.inf}


def constant(expression: Expression) -> float | None:
    """Return the value of an expression that needs no variable; None when it needs one.

    ``NAN`` and ``INF`` are names that the text may contain; the checker refuses them wherever they stand.
    """
    sign = 1.0
    while isinstance(expression, Negate):
        sign, expression = -sign, expression.operand
    if isinstance(expression, Number):
        return sign * expression.value
    value = _CONSTANTS.get(expression.key)
    return None if value is None else sign * value
