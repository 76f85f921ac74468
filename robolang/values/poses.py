"""Poses while a program runs: what a pose is made of and which offsets were added, not yet its numbers.

``P1 + (0, 0, 50)`` needs the taught point, perhaps the kinematics of the robot, and a frame of the cell, so it stays
symbolic until the move is lowered (``robolang.execution.lowering``) or the program reads a component. Pure data; mm and
deg.
"""

from typing import Literal

from robolang.values.kinds import Kind
from runtime.core.record import Record

Six = tuple[float, float, float, float, float, float]
Frame = str | Six
"""A frame: its name in the cell, or its pose in the world; ``""`` is the world."""


class Shift(Record):
    """An offset and a rotation: along the axes of ``frame``, or of the tool where it then is."""

    kind: Literal["frame", "tool"]
    by: Six
    frame: Frame = ""


class Place(Record):
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
        """Return the place with one more shift; two offsets in a row along the same axes become one."""
        if self.shifts and (both := _joined(self.shifts[-1], shift)) is not None:
            return self.replaced(shifts=(*self.shifts[:-1], both))
        return self.replaced(shifts=(*self.shifts, shift))


def _joined(one: Shift, other: Shift) -> Shift | None:
    """Return the sum of two offsets along the same axes; None where one of them rotates or the axes differ."""
    # after a rotation an offset follows other axes
    if one.kind != other.kind or one.frame != other.frame or any(one.by[3:]) or any(other.by[3:]):
        return None
    x, y, z = (a + b for a, b in zip(one.by[:3], other.by[:3], strict=True))
    return one.replaced(by=(x, y, z, 0.0, 0.0, 0.0))


Value = float | str | Place
"""What a variable can hold."""


def kind_of(value: Value) -> Kind:
    """Return the kind of a value."""
    return Kind.NUMBER if isinstance(value, float) else Kind.TEXT if isinstance(value, str) else Kind.POSE
