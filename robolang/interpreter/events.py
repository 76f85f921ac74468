"""What one step of the interpreter yields: a closed union of frozen values."""

from dataclasses import dataclass
from typing import TypeAlias

from robolang.interpreter.effects import Effect, Origin
from robolang.syntax.ast import Statement


@dataclass(frozen=True, slots=True, kw_only=True)
class LineBegun(Origin):
    """The statement ``node`` is due: nothing of it has been carried out. Its effects follow, one a step."""

    node: Statement


@dataclass(frozen=True, slots=True, kw_only=True)
class Failed:
    """A fault that no ON ERROR caught: ``origin`` is the statement, or the part of it, that failed.

    ``calls``: the CALLs and GOSUBs that led there, outermost first. The program is over, unless ``fed``: then the
    statement that was fed has failed, and the program stands where it stood.
    """

    code: str
    message: str
    hint: str
    origin: Origin
    calls: tuple[Origin, ...] = ()
    fed: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class FedEnded:
    """The statement that was fed is over; the program stands where it stood, or where the statement has ``led`` it."""

    led: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Done:
    """The program is over: its last line, END or STOP has been reached. Every later step yields this again."""


Event: TypeAlias = LineBegun | Effect | Failed | FedEnded | Done

FED_ENDED = FedEnded()
DONE = Done()
