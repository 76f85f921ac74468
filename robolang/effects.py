"""The closed vocabulary of what a program asks of the robot.

The interpreter yields these and nothing else; the session is the one place that carries them out. Values are in the
units of the text (mm, deg, kg, s, %); ``lowering`` turns them into SI. Each knows the statement it comes from, so
that every alarm, log row and progress line can name it.
"""

from dataclasses import dataclass
from typing import TypeAlias

from robolang.nodes import Hand, Load, Move, Seam, Wrist
from robolang.source import Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin:
    """Where an effect comes from: 1-based line of the file, line number of the program (None: not numbered)."""

    line: int
    number: int | None
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class SetPayload(Origin):
    """Declare all that is beyond the flange: centre of gravity in the flange frame, mm; mass, kg."""

    node: Load
    cog_mm: tuple[float, float, float]
    mass_kg: float


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveTo(Origin):
    """Move the tool point straight to a taught point, by its key; None where the move leaves a value open.

    ``wrist`` and ``held`` are the mode and the components of ``SetWrist`` that hold for this move: those of its own
    option, else of the WRIST statement before it; None and () when the program has given neither.
    """

    node: Move
    point: str
    speed_mm_s: float | None = None
    accel_pct: float | None = None
    time_s: float | None = None
    wrist: str | None = None
    held: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class SetHand(Origin):
    """Close or open the hand, then wait; ``dwell_s`` None: the default of the hand."""

    node: Hand
    closed: bool
    dwell_s: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SetWrist(Origin):
    """Choose what the wrist does on the moves that follow; each ``MoveTo`` carries it, so nothing is left to do.

    ``mode`` is ``"keep"`` or ``"auto"``; ``held`` are the components of the posture to hold, in capitals. HOLD is
    ``"auto"`` with some of them.
    """

    node: Wrist
    mode: str
    held: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class SetSeam(Origin):
    """Superpose the deviation that a seam sensor of the cell measures, by its key; None: no more."""

    node: Seam
    sensor: str | None


Effect: TypeAlias = SetPayload | MoveTo | SetHand | SetWrist | SetSeam
