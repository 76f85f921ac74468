"""The closed vocabulary of what a program requests of the robot.

The interpreter yields these and nothing else; the session is the one place that carries them out. Values are in the
units of the text (mm, deg, kg, s, %); ``lowering`` turns them into SI. Each knows the statement it comes from, so
that every alarm, log row and progress line can name it.
"""

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from robolang.core.source import Source, Span
from robolang.interpreter.fed_line import FedLine
from robolang.syntax.ast import Line, Statement
from robolang.syntax.tree import Node
from robolang.values.poses import Frame, Place
from runtime.core.program_line import ProgramLine

PathKind = Literal["line", "joint", "arc", "spline"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin(ProgramLine):
    """Where an effect or a fault comes from: ``span`` is the place of the statement, or of the part of it that failed.

    This is what the controller keeps with an alarm, so its place is never looked up. ``source`` is the text of a
    statement that was fed: its ``span`` is in that text, and its ``line`` is 0. None: the statement is of the program.
    """

    span: Span
    source: Source | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class OfStatement(Origin):
    """What every effect has: the statement, or the branch of an IF on one line, that requests it."""

    node: Statement

    @property
    def origin(self) -> Origin:
        """Where it comes from, without what is requested."""
        return Origin(line=self.line, number=self.number, span=self.span, source=self.source)


@dataclass(frozen=True, slots=True, kw_only=True)
class SetPayload(OfStatement):
    """Declare all that is beyond the flange: centre of gravity in the flange frame, mm; mass, kg; inertia about the
    centre (ixx, iyy, izz, ixy, ixz, iyz), kg m2. ``name``: in their place a load of the cell, by its key."""

    cog_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    mass_kg: float = 0.0
    inertia_kg_m2: tuple[float, ...] = ()
    name: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveTo(OfStatement):
    """Move the tool to a place; None where the move leaves a value open.

    ``path``: straight, with all joints together, on an arc over the place ``via``, or on a spline through the places
    ``via``. ``speed_mm_s`` of the tool point and ``speed_pct`` of the joints (``path`` joint), ``accel_pct``, infinite
    for MAX, ``time_s`` for all of the move, ``override_pct`` of every speed. ``zone_mm``: radius within which it blends
    into the next one, 0: it stops. ``wrist`` and ``held`` are the mode and the components of ``SetWrist`` that hold for
    this move; None and () when the program has given neither.
    """

    path: PathKind = "line"
    target: Place
    via: tuple[Place, ...] = ()
    speed_mm_s: float | None = None
    speed_pct: float | None = None
    accel_pct: float | None = None
    time_s: float | None = None
    override_pct: float = 100.0
    zone_mm: float = 0.0
    wrist: str | None = None
    held: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class SetHand(OfStatement):
    """Close or open the hand, then wait; ``dwell_s`` None: the default of the hand."""

    closed: bool
    dwell_s: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SetWrist(OfStatement):
    """Choose what the wrist does on the moves that follow; each ``MoveTo`` carries it, so nothing is left to do.

    ``mode`` is ``"keep"`` or ``"auto"``; ``held`` are the components of the posture to hold, in capitals. HOLD is
    ``"auto"`` with some of them.
    """

    mode: str
    held: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class SetSeam(OfStatement):
    """Superpose the deviation that a seam sensor of the cell measures, by its key; None: no more."""

    sensor: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class SetTool(OfStatement):
    """Take another tool: a tool of the cell by its key, or a pose in the flange frame, mm and deg."""

    tool: Frame


@dataclass(frozen=True, slots=True, kw_only=True)
class SetOutput(OfStatement):
    """Set an output; with ``seconds`` only for so long, while the program goes on."""

    output: int
    value: float
    seconds: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Pass(OfStatement):
    """Let time pass, s; 0: at least one interpolation cycle, in which inputs may change."""

    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Show(OfStatement):
    """Show a line of text."""

    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Drain(OfStatement):
    """Let all motion end: what comes next reads where the robot is, an input or the time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Halt(OfStatement):
    """``STOP``: the program ends here, ``PAUSE``: it would wait for an operator; a run notes it and goes on."""

    word: str


Effect: TypeAlias = (
    SetPayload | MoveTo | SetHand | SetWrist | SetSeam | SetTool | SetOutput | Pass | Show | Drain | Halt
)


def origin(line: Line, node: Statement) -> dict[str, Any]:
    """Return the fields of ``OfStatement`` for a statement, or a part of one, of a line."""
    return {**_place(line, node), "node": node}


def origin_of(line: Line, part: Node) -> Origin:
    """Return where a part of a line is."""
    return Origin(**_place(line, part))


def _place(line: Line, part: Node) -> dict[str, Any]:
    source = line.source if isinstance(line, FedLine) else None
    return {
        "line": line.source_line if source is None else 0,
        "number": line.number,
        "span": part.span,
        "source": source,
    }
