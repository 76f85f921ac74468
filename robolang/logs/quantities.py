"""What the numbers of a log are: the columns of each signal, by name, with the unit that they have in the log.

A signal of one number has one column with the name of the signal; every other one has columns ``NAME:LABEL``, where the
label is the number of an axis, ``x``, or, of the poses of the parts, ``part.x``. People see mm and degrees (``shown``).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from runtime.appearance.scene import Scene
from runtime.core.frames import Array
from runtime.core.units import DEG, MM

_AXES = {
    **dict.fromkeys(("q_plan", "q_cmd", "q_fb", "q_link"), "rad"),
    **dict.fromkeys(("dq_cmd", "dq_fb"), "rad/s"),
    **dict.fromkeys(("tau_cmd", "tau_sat", "T"), "N m"),
    **dict.fromkeys(("D_age", "T_age"), "ms"),
    "D": "kg m2",
}
"""Signals with a number for each axis, and their units."""
_ONE = {
    **dict.fromkeys(("t", "frame_t"), "s"),
    **dict.fromkeys(("line", "number", "wrist_mode"), "-"),
    "payload_mass": "kg",
    "tool_error": "m",
    "tool_speed": "m/s",
}
_Labels = tuple[tuple[str, str], ...]
_XYZ: _Labels = (("x", "m"), ("y", "m"), ("z", "m"))
_MATRIX: _Labels = tuple(
    (f"r{row + 1}{column + 1}" if row == 3 or column < 3 else "xyz"[row], "m" if row < 3 and column == 3 else "-")
    for row in range(4)
    for column in range(4)
)
_PART: _Labels = (*_XYZ, ("qw", "-"), ("qx", "-"), ("qy", "-"), ("qz", "-"))
_FIXED: dict[str, _Labels] = {
    "X_world_tool": _MATRIX,
    "X_world_tool_fb": _MATRIX,
    "tool_cmd": _XYZ,
    "seam_deviation": (*_XYZ, ("rx", "rad"), ("ry", "rad"), ("rz", "rad")),
    "fingers": (("left", "m"), ("right", "m")),
}
"""Signals with the same columns for every robot: label and unit."""
_SHOWN = {"rad": ("deg", 1.0 / DEG), "rad/s": ("deg/s", 1.0 / DEG), "m": ("mm", 1.0 / MM), "m/s": ("mm/s", 1.0 / MM)}
PART = "part:"
"""What names of bodies begin with that are parts, in the scene of a log."""


class SignalSource(Protocol):
    """The part of a log that is read here and by what builds on it."""

    source: str
    meta: Mapping[str, Any] | None

    def __contains__(self, name: object) -> bool:
        """Return whether there is such a signal."""

    def count(self, name: str) -> int:
        """Return how many rows a signal has."""

    def span(self, name: str, first: int, last: int) -> Array:
        """Return rows ``first`` to before ``last`` of a signal."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """A column of a signal, number ``index`` of its row, flattened; ``unit``: that of the log, - for none."""

    signal: str
    index: int
    label: str
    unit: str

    @property
    def name(self) -> str:
        """How it is named in files and where it is selected."""
        return f"{self.signal}:{self.label}" if self.label else self.signal

    @property
    def shown(self) -> tuple[str, float]:
        """The unit that people read, and the factor from the unit of the log."""
        return _SHOWN.get(self.unit, (self.unit, 1.0))


def columns(log: SignalSource, name: str) -> tuple[Column, ...]:
    """Return the columns of a signal, in the order of its row."""
    # no row of it: of a file nothing is read but the header
    shape = log.span(name, 0, 0).shape[1:]
    size = 1
    for length in shape:
        size *= length
    labels = _labels(log, name, shape)
    # a file that is read may hold another number of columns than its name says
    if len(labels) != size:
        labels = tuple((str(k + 1), "") for k in range(size)) if shape else (("", ""),)
    return tuple(Column(signal=name, index=k, label=label, unit=unit) for k, (label, unit) in enumerate(labels))


def _labels(log: SignalSource, name: str, shape: Sequence[int]) -> _Labels:
    if name in _ONE:
        return (("", _ONE[name]),)
    if name in _AXES and len(shape) == 1:
        return tuple((str(k + 1), _AXES[name]) for k in range(shape[0]))
    if name == "parts" and len(shape) == 2:
        return tuple((f"{part}.{label}", unit) for part in part_names(log, shape[0]) for label, unit in _PART)
    return _FIXED.get(name, ())


def part_names(log: SignalSource, count: int) -> list[str]:
    """Return the names of the parts of a cell, in the order of the signal; numbers where they are not known.

    ``Fault`` RBL833 for a log whose scene is damaged.
    """
    scene = None if log.meta is None else log.meta.get("scene")
    bodies = () if scene is None else Scene.from_json(scene).bodies
    parts = {body.joint.index: body.name for body in bodies if body.joint is not None and body.joint.source == "part"}
    return [parts[k].removeprefix(PART) if k in parts else str(k + 1) for k in range(count)]
