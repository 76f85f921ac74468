"""The syntax tree: frozen values, one class for each rule of ``grammar.lark``.

Two trees are equal when they mean the same; places (``span``, ``source_line``) and parentheses that change
nothing take no part. Names keep
the user's spelling in ``text`` and compare by ``key``, since the language ignores case. A line that could not
be parsed is kept as ``Unparsed``, so that line numbers and the formatter see every line; blank lines are not
kept, they are the gaps between the ``source_line`` of neighbours.
"""

from dataclasses import dataclass, field
from enum import Enum
from sys import intern
from typing import TypeAlias

from robolang.core.source import Span
from robolang.syntax.tree import NOWHERE as NOWHERE
from robolang.syntax.tree import Node as Node
from robolang.syntax.tree import walk as walk


@dataclass(frozen=True, slots=True, kw_only=True)
class Operand(Node):
    """A part of an expression; ``parentheses``: how many pairs are written around it, which change nothing of it."""

    parentheses: int = field(default=0, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Number(Operand):
    """A literal; ``text`` is its spelling."""

    value: float
    text: str = field(compare=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Text(Operand):
    """A literal between double quotes, ``value`` without them; ``""`` in it is one of its double quotes."""

    value: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Name(Operand):
    """The name of a point, a sensor or a value; ``key`` is the spelling that is compared and looked up."""

    text: str = field(compare=False)
    key: str = field(init=False)

    def __post_init__(self) -> None:
        upper = self.text.upper()
        object.__setattr__(self, "key", self.text if upper == self.text else intern(upper))


@dataclass(frozen=True, slots=True, kw_only=True)
class Negate(Operand):
    """``-operand``."""

    operand: "Expression"


@dataclass(frozen=True, slots=True, kw_only=True)
class Not(Operand):
    """``NOT operand``."""

    operand: "Expression"


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain(Operand):
    """Operands of one precedence with the signs between them: ``first rest[0] rest[1] ...``; flat, however long.

    Signs are ``OR XOR AND = <> < > <= >= + - * / MOD ^``. From the left, but ``^``, whose base is what
    stands left of it.
    """

    first: "Expression"
    rest: tuple[tuple[str, "Expression"], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Call(Operand):
    """A function of the language, or an element of an array: ``ABS(x)``, ``POSE(...)``, ``HERE``, ``a(3)``.

    ``name.key`` says which; a word such as HERE or TIMER has no arguments.
    """

    name: Name
    arguments: tuple["Expression", ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Component6(Operand):
    """``base.X`` to ``base.RZ``: a component of a pose, mm or deg."""

    base: "Expression"
    name: Name


@dataclass(frozen=True, slots=True, kw_only=True)
class Vector(Operand):
    """``(x, y, z)``, or six values: a way and a turn."""

    items: tuple["Expression", ...]


Expression: TypeAlias = Number | Text | Name | Negate | Not | Chain | Call | Component6 | Vector


@dataclass(frozen=True, slots=True, kw_only=True)
class Speed(Node):
    """Option ``SPEED v``: speed of the tool point, mm/s; of a MOVEJ, % of the joints' limits."""

    value: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Accel(Node):
    """Option ``ACCEL a``: acceleration, % of the robot's."""

    value: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Time(Node):
    """Option ``TIME t``: duration of the move, s."""

    value: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Zone(Node):
    """Option ``ZONE r``: radius within which the move blends into the next one, mm; ``FINE`` is None: it stops."""

    value: Expression | None


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


Option: TypeAlias = Speed | Accel | Time | Zone | Wrist


@dataclass(frozen=True, slots=True, kw_only=True)
class Move(Node):
    """``MOVE target {, option}``: straight line of the tool point."""

    target: Expression
    options: tuple[Option, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveJ(Node):
    """``MOVEJ target {, option}``: all joints start and end together."""

    target: Expression
    options: tuple[Option, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveC(Node):
    """``MOVEC via, target {, option}``: arc of the tool point."""

    via: Expression
    target: Expression
    options: tuple[Option, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Approach(Node):
    """``APPROACH target, d {, option}``: straight to d mm before the target, against the tool's approach axis."""

    target: Expression
    distance: Expression
    options: tuple[Option, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Depart(Node):
    """``DEPART d {, option}``: straight back by d mm along the tool's approach axis."""

    distance: Expression
    options: tuple[Option, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Load(Node):
    """``LOAD (x, y, z), m [, (ixx, iyy, izz, ixy, ixz, iyz)]``: centre of gravity (mm, flange frame), mass (kg) and
    inertia about the centre (kg m2) beyond the flange."""

    cog: Vector
    mass: Expression
    inertia: Vector | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadNamed(Node):
    """``LOAD name``: a load of the cell file."""

    name: Name


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
class Setting(Node):
    """``SPEED v``, ``SPEEDJ p``, ``ACCEL p``, ``OVERRIDE p``, ``ZONE r``, ``TOOL t`` or ``FRAME f``: until changed.

    ``word`` is the first word in capitals. ``FINE`` is an option of a move only; ``ZONE 0`` sets the same.
    """

    word: str
    value: Expression


# --- values, inputs and outputs --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class Assign(Node):
    """``x = e``, ``s$ = e``, ``P10 = pose``, ``a(n) = e``."""

    target: Name | Call
    value: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Dim(Node):
    """``DIM a(n)``: elements 0 to n."""

    name: Name
    size: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Const(Node):
    """``CONST k = e``."""

    name: Name
    value: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Out(Node):
    """``OUT(n) = e``."""

    index: Expression
    value: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Pulse(Node):
    """``PULSE n, t``: output n on for t seconds, while the program goes on."""

    index: Expression
    seconds: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Delay(Node):
    """``DELAY t``."""

    seconds: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Target(Node):
    """Where to go: a line number, or the key of ``*LABEL``; the other is None."""

    number: int | None = None
    label: Name | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Wait(Node):
    """``WAIT cond [, TIMEOUT t [, GOTO target]]``."""

    condition: Expression
    timeout: Expression | None = None
    target: Target | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Print(Node):
    """``PRINT e; e``."""

    items: tuple[Expression, ...]


# --- control ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class If(Node):
    """``IF c THEN s [ELSE s]`` on one line."""

    condition: Expression
    then: "Statement"
    otherwise: "Statement | None" = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Block(Node):
    """A line that begins, divides or ends a block and has no values of its own.

    ``word`` is ``ELSE``, ``ENDIF``, ``WEND``, ``CASE ELSE``, ``ENDSELECT``, ``ENDSUB``.
    """

    word: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Head(Node):
    """A line that begins or divides a block with a value: ``word`` is ``IF``, ``ELSEIF``, ``WHILE`` or ``SELECT``."""

    word: str
    value: Expression


@dataclass(frozen=True, slots=True, kw_only=True)
class Case(Node):
    """``CASE e {, e}``."""

    values: tuple[Expression, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class For(Node):
    """``FOR v = a TO b [STEP s]``."""

    variable: Name
    first: Expression
    last: Expression
    step: Expression | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Next(Node):
    """``NEXT [v]``."""

    variable: Name | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Jump(Node):
    """``GOTO target`` or ``GOSUB target``: ``word``."""

    word: str
    target: Target


@dataclass(frozen=True, slots=True, kw_only=True)
class Sub(Node):
    """``SUB name [(a, b)]``: the subroutine's lines follow, to ENDSUB; parameters and locals are its own.

    ``parentheses``: 1 where they are written, without a parameter as well.
    """

    name: Name
    parameters: tuple[Name, ...] = ()
    parentheses: int = field(default=0, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class CallSub(Node):
    """``CALL name [(e, e)]``; ``parentheses`` as of ``Sub``."""

    name: Name
    arguments: tuple[Expression, ...] = ()
    parentheses: int = field(default=0, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Word(Node):
    """Words alone: ``RETURN``, ``END``, ``STOP``, ``PAUSE``, ``RESUME``, ``RESUME NEXT``, ``ON ERROR STOP``."""

    word: str


@dataclass(frozen=True, slots=True, kw_only=True)
class OnError(Node):
    """``ON ERROR GOTO *L``."""

    target: Target


@dataclass(frozen=True, slots=True, kw_only=True)
class Unparsed(Node):
    """A statement that has an error; a program that contains one does not run."""

    text: str


Moving: TypeAlias = Move | MoveJ | MoveC | Approach | Depart
Statement: TypeAlias = (
    Moving
    | Load
    | LoadNamed
    | Hand
    | Wrist
    | Seam
    | Setting
    | Assign
    | Dim
    | Const
    | Out
    | Pulse
    | Delay
    | Wait
    | Print
    | If
    | Block
    | Head
    | Case
    | For
    | Next
    | Jump
    | Sub
    | CallSub
    | Word
    | OnError
    | Unparsed
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Comment(Node):
    """A comment as written, from ``'`` or ``REM`` to the end of its line."""

    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Line(Node):
    """``[number] [*label] [statement] [comment]``; ``source_line`` is 1-based."""

    number: int | None = None
    label: Name | None = None
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
