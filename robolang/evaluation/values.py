"""Values of poses while a program runs: where they come from and what was added, not yet numbers.

``P1 + (0, 0, 50)`` needs the taught point, perhaps the kinematics of the robot, and a frame of the cell, so it is kept
as it is written until the move is lowered (``lowering``) or a component of it is asked for. Pure data; mm and deg.
"""

from dataclasses import dataclass, replace
from typing import Literal

Six = tuple[float, float, float, float, float, float]
Frame = str | Six
"""A frame: its name in the cell, or its pose in the world; ``""`` is the world."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Shift:
    """A way and a turn: along the axes of ``frame``, or of the tool where it then is."""

    kind: Literal["frame", "tool"]
    by: Six
    frame: Frame = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """A place for the tool: one of ``point`` (key of a taught point), ``pose`` in ``frame``, ``joints`` deg, or
    ``last``, where the motion before it ends; then ``shifts`` from the first to the last.
    """

    point: str = ""
    pose: Six | None = None
    joints: tuple[float, ...] | None = None
    last: bool = False
    frame: Frame = ""
    shifts: tuple[Shift, ...] = ()

    def shifted(self, shift: Shift) -> "Place":
        """Return the place with one more shift; two ways in a row along the same axes are one."""
        if self.shifts and (both := _joined(self.shifts[-1], shift)) is not None:
            return replace(self, shifts=(*self.shifts[:-1], both))
        return replace(self, shifts=(*self.shifts, shift))


def _joined(one: Shift, other: Shift) -> Shift | None:
    """Return the sum of two ways without a turn along the same axes; None when they have no sum."""
    if one.kind != other.kind or one.frame != other.frame or any(one.by[3:]) or any(other.by[3:]):
        return None
    x, y, z = (a + b for a, b in zip(one.by[:3], other.by[:3], strict=True))
    return replace(one, by=(x, y, z, 0.0, 0.0, 0.0))


Value = float | str | Place
"""What a variable can hold."""


def kind_of(value: Value) -> str:
    """Return what a value is, in words."""
    return "a number" if isinstance(value, float) else "a text" if isinstance(value, str) else "a pose"
