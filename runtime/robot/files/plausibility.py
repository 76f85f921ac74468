"""Values of a robot file that are possible and unlikely: as a rule they are in another unit than the file's.

Impossible values are refused where they are read (RBL605, RBL606). Values that no known arm has are doubted: the arm is
loaded, and every doubt is a warning at its place, one for all axes that share it. Here are limits and gears, which need
no numerics, in ``body_plausibility`` lengths, bodies and torques. The bounds (docs/robots-import.md):

    RBL627   a joint range of more than ``MOST_TURNS`` to a side, or within ``LEAST_ANGLE``; a speed above ``FASTEST``
             or below ``LEAST_ANGLE`` a second: degrees for radians, radians for degrees, a conversion made twice
    RBL629   a gear ratio below 1

Units that differ by less than a factor of about ten (lb, inches) look like a light or a small arm. Read at start.
"""

import math
from collections.abc import Callable, Sequence
from typing import Literal, Protocol

from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, Table
from runtime.core.units import DEG
from runtime.robot.model.drives import Limits, Motor, joint_label

MOST_TURNS = 2.0 * 2.0 * math.pi
"""Two turns to either side, rad: cables end earlier."""
LEAST_ANGLE = 2.0 * math.pi * DEG
"""A joint that turns no further, rad, or no faster, rad/s: 2 pi taken as degrees."""
FASTEST = 30.0
"""Fastest joint, rad/s (1719 deg/s)."""
What = Literal["range", "speed", "torque", "body", "length", "gear"]
Place = Callable[[What, int], Callable[[str, str, str], FileFault]]
"""``place(what, axis)(code, message, hint)`` is a fault at the place of a value of an axis (0-based)."""


class Turning(Record):
    """Range and speed of a joint, rad and rad/s; NaN where its file gives none.

    ``in_degrees``: the file has degrees and deg/s, else radians and rad/s.
    """

    label: str
    lower: float
    upper: float
    speed: float
    in_degrees: bool

    @property
    def widest(self) -> float:
        """The end of the range that is further from zero, rad."""
        return max(abs(self.lower), abs(self.upper))

    def text(self, what: What) -> str:
        """Return range or speed as in the file, in degrees too."""
        if what == "range":
            degrees, radians = f"{_deg(self.lower)} to {_deg(self.upper)} deg", f"{self.lower:g} to {self.upper:g} rad"
        else:
            degrees, radians = f"{_deg(self.speed)} deg/s", f"{self.speed:g} rad/s"
        return f"{self.label} {degrees if self.in_degrees else f'{radians} = {degrees}'}"


class _TurningRule(Record):
    """A condition, and its explanation and remedy in a file of radians and in one of degrees."""

    what: What
    unlikely: Callable[[Turning], bool]
    radians: tuple[str, str]
    degrees: tuple[str, str]


_TO_RADIANS = "the file has radians: multiply degrees by 0.0174533"
_TO_DEGREES = "the file has degrees: multiply radians by 57.2958"
_TWICE = "look like degrees converted to radians twice"
_AS_DEGREES = "look like radians in a file of degrees"
_TURNING_RULES = (
    _TurningRule(
        what="range",
        unlikely=lambda joint: joint.widest > MOST_TURNS,
        radians=("look like degrees in a file of radians", _TO_RADIANS),
        degrees=("are more than two turns to a side", "Check them; only an axis without end stops turns that far."),
    ),
    _TurningRule(
        what="range",
        unlikely=lambda joint: joint.widest <= LEAST_ANGLE,
        radians=(_TWICE, _TO_RADIANS),
        degrees=(_AS_DEGREES, _TO_DEGREES),
    ),
    _TurningRule(
        what="speed",
        unlikely=lambda joint: joint.speed > FASTEST,
        radians=("look like deg/s in a file of rad/s", _TO_RADIANS),
        degrees=("are faster than any arm", "Check them; the file has deg/s."),
    ),
    _TurningRule(
        what="speed",
        unlikely=lambda joint: joint.speed <= LEAST_ANGLE,
        radians=(_TWICE, _TO_RADIANS),
        degrees=(_AS_DEGREES, _TO_DEGREES),
    ),
)


def doubt_turning(joints: Sequence[Turning], place: Place) -> list[FileFault]:
    """Return the doubts about ranges and speeds (RBL627)."""
    # every comparison is false for NaN: a value that the file does not give is not doubted
    doubts = []
    # one warning a rule, at the first axis, for all that share it: a file in the wrong unit breaks one rule six times
    for rule in _TURNING_RULES:
        for in_degrees, (tail, hint) in ((False, rule.radians), (True, rule.degrees)):
            axes = [k for k, joint in enumerate(joints) if joint.in_degrees is in_degrees and rule.unlikely(joint)]
            if axes:
                name = "limits" if rule.what == "range" else "speeds"
                message = f"{name} {tail}: {', '.join(joints[k].text(rule.what) for k in axes)}"
                doubts.append(place(rule.what, axes[0])("RBL627", message, hint))
    return doubts


class Driven(Protocol):
    """An axis of a TOML file."""

    @property
    def name(self) -> str:
        """Its name in the file."""

    @property
    def limits(self) -> Limits:
        """Range and speed."""

    @property
    def motor(self) -> Motor:
        """The drive."""

    @property
    def table(self) -> Table:
        """Its place."""


def doubt_axes(axes: Sequence[Driven]) -> tuple[FileFault, ...]:
    """Return the doubts about ranges, speeds (RBL627) and gears (RBL629) of axes in TOML tables."""
    labels = [joint_label(k, axis.name) for k, axis in enumerate(axes)]
    joints = [_turning(label, axis.limits) for label, axis in zip(labels, axes, strict=True)]
    place = in_tables([axis.table for axis in axes])
    # these files are in degrees by their keys; only a URDF or MJCF may be in radians
    doubts = doubt_turning(joints, place)
    # gears of arms reduce: a ratio below 1 is most likely joint turns per motor turn
    slow = [k for k, axis in enumerate(axes) if not (abs(axis.motor.gear_ratio) >= 1.0 or axis.limits.kind.slides)]
    if slow:
        listed = ", ".join(f"{labels[k]} {axes[k].motor.gear_ratio:g}" for k in slow)
        hint = "write motor turns per joint turn: 100 for 100:1, not 0.01"
        doubts.append(place("gear", slow[0])("RBL629", f"gears make the motor slower than the joint: {listed}", hint))
    return tuple(doubts)


def _turning(label: str, limits: Limits) -> Turning:
    """Return the range and speed of an axis; of one that slides NaN, since its file has no angle to doubt."""
    found = Turning(label=label, lower=limits.lower, upper=limits.upper, speed=limits.speed, in_degrees=True)
    return found.replaced(lower=math.nan, upper=math.nan, speed=math.nan) if limits.kind.slides else found


_KEYS: dict[What, tuple[str, ...]] = {
    "range": ("range_deg",),
    "speed": ("max_speed_deg_s",),
    "torque": ("max_torque_nm",),
    "body": ("mass_kg",),
    "length": (),
    "gear": ("motor", "gear_ratio"),
}


def in_tables(tables: Sequence[Table]) -> Place:
    """Return the places of the values of axes that have a TOML table each."""

    def place(what: What, axis: int) -> Callable[[str, str, str], FileFault]:
        table = tables[axis]
        return lambda code, message, hint: table.source.fault(code, message, hint, (*table.keys, *_KEYS[what]))

    return place


def _deg(angle: float) -> str:
    return f"{angle / DEG:.6g}"
