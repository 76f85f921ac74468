"""Values of a robot file that are possible and unlikely: as a rule they are in another unit than the file's.

Impossible values are refused where they are read (RBL605, RBL606). Values that no known arm has are doubted: the arm is
loaded, and every doubt is a warning at its place, one for all axes that share it. Here are limits and gears, which need
no numerics, in ``body_plausibility`` lengths, bodies and torques. The bounds (docs/robots-import.md):

    RBL627   a joint range of more than ``MOST_TURNS`` to a side, or within ``LEAST_ANGLE``; a speed above ``FASTEST``
             or below ``LEAST_ANGLE`` a second: degrees for radians, radians for degrees, a conversion made twice
    RBL628   of a joint that slides, a range of more than ``LONGEST_TRAVEL`` to a side, or within ``LEAST_TRAVEL``; a
             speed above ``FASTEST_SLIDE`` or below ``LEAST_TRAVEL`` a second: mm for m, m for mm
    RBL627   of a joint that turns, RBL628 of one that slides: an acceleration that takes more than ``SLOWEST_RISE`` to
             build up at the jerk limit
    RBL629   a gear ratio below 1

Units that differ by less than a factor of about ten (lb, inches) look like a light or a small arm. Read at start.
"""

import math
from collections.abc import Callable, Sequence
from typing import Literal, Protocol

from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, Table
from runtime.core.units import DEG
from runtime.robot.model import drives
from runtime.robot.model.axis_kind import PRISMATIC, REVOLUTE, AxisKind
from runtime.robot.model.drives import RISE_S, Limits, Motor, joint_label

MOST_TURNS = 2.0 * 2.0 * math.pi
"""Two turns to either side, rad: cables end earlier."""
LEAST_ANGLE = 2.0 * math.pi * DEG
"""A joint that turns no further, rad, or no faster, rad/s: 2 pi taken as degrees."""
FASTEST = 30.0
"""Fastest joint, rad/s (1719 deg/s)."""
LONGEST_TRAVEL, LEAST_TRAVEL = 15.0, 2e-3
"""Travel of an axis that slides to one side, m: rails of cells are shorter; 2 m taken as mm."""
FASTEST_SLIDE = 20.0
"""Fastest axis that slides, m/s: linear motors have up to 10."""
SLOWEST_RISE = 1.0
"""Longest time in which an acceleration builds up, s: heavy arms take some 0.3 s."""
What = Literal["range", "speed", "jerk", "torque", "body", "length", "gear"]
Place = Callable[[What, int], Callable[[str, str, str], FileFault]]
"""``place(what, axis)(code, message, hint)`` is a fault at the place of a value of an axis (0-based)."""


class Moving(Record):
    """Range and speed of a joint, rad and rad/s, of one that slides m and m/s; NaN where its file gives none.

    ``in_units``: the file has degrees and deg/s, or mm and mm/s, else radians and rad/s, or m and m/s.
    """

    label: str
    lower: float
    upper: float
    speed: float
    in_units: bool
    kind: AxisKind = REVOLUTE

    @property
    def widest(self) -> float:
        """The end of the range that is further from zero, rad or m."""
        return max(abs(self.lower), abs(self.upper))

    def text(self, what: What) -> str:
        """Return range or speed as in the file, in deg or mm too."""
        size, unit, si = self.kind.size, self.kind.unit, self.kind.coordinate
        if what == "range":
            shown = f"{self.lower / size:.6g} to {self.upper / size:.6g} {unit}"
            written = f"{self.lower:g} to {self.upper:g} {si}"
        else:
            shown, written = f"{self.speed / size:.6g} {unit}/s", f"{self.speed:g} {si}/s"
        return f"{self.label} {shown if self.in_units else f'{written} = {shown}'}"


class _Rule(Record):
    """A condition on joints of a kind, and its explanation and remedy in a file of SI units and in one of deg or mm."""

    kind: AxisKind
    what: What
    unlikely: Callable[[Moving], bool]
    si: tuple[str, str]
    units: tuple[str, str]


_CODES = {REVOLUTE: "RBL627", PRISMATIC: "RBL628"}
_TO_RADIANS = "the file has radians: multiply degrees by 0.0174533"
_TO_DEGREES = "the file has degrees: multiply radians by 57.2958"
_TO_METRES, _TO_MM = "the file has m: multiply mm by 0.001", "the file has mm: multiply m by 1000"
_TWICE, _TWICE_M = "look like degrees converted to radians twice", "look like mm converted to m twice"
_AS_DEGREES, _AS_MM = "look like radians in a file of degrees", "look like m in a file of mm"
_RULES = (
    _Rule(
        kind=REVOLUTE,
        what="range",
        unlikely=lambda joint: joint.widest > MOST_TURNS,
        si=("look like degrees in a file of radians", _TO_RADIANS),
        units=("are more than two turns to a side", "Check them; only an axis without end stops turns that far."),
    ),
    _Rule(
        kind=REVOLUTE,
        what="range",
        unlikely=lambda joint: joint.widest <= LEAST_ANGLE,
        si=(_TWICE, _TO_RADIANS),
        units=(_AS_DEGREES, _TO_DEGREES),
    ),
    _Rule(
        kind=REVOLUTE,
        what="speed",
        unlikely=lambda joint: joint.speed > FASTEST,
        si=("look like deg/s in a file of rad/s", _TO_RADIANS),
        units=("are faster than any arm", "Check them; the file has deg/s."),
    ),
    _Rule(
        kind=REVOLUTE,
        what="speed",
        unlikely=lambda joint: joint.speed <= LEAST_ANGLE,
        si=(_TWICE, _TO_RADIANS),
        units=(_AS_DEGREES, _TO_DEGREES),
    ),
    _Rule(
        kind=PRISMATIC,
        what="range",
        unlikely=lambda joint: joint.widest > LONGEST_TRAVEL,
        si=("look like mm in a file of m", _TO_METRES),
        units=("are longer than any axis", "Check them; the file has mm."),
    ),
    _Rule(
        kind=PRISMATIC,
        what="range",
        unlikely=lambda joint: joint.widest <= LEAST_TRAVEL,
        si=(_TWICE_M, _TO_METRES),
        units=(_AS_MM, _TO_MM),
    ),
    _Rule(
        kind=PRISMATIC,
        what="speed",
        unlikely=lambda joint: joint.speed > FASTEST_SLIDE,
        si=("look like mm/s in a file of m/s", _TO_METRES),
        units=("are faster than any axis", "Check them; the file has mm/s."),
    ),
    _Rule(
        kind=PRISMATIC,
        what="speed",
        unlikely=lambda joint: joint.speed <= LEAST_TRAVEL,
        si=(_TWICE_M, _TO_METRES),
        units=(_AS_MM, _TO_MM),
    ),
)


def doubt_moving(joints: Sequence[Moving], place: Place) -> list[FileFault]:
    """Return the doubts about ranges and speeds of joints that turn (RBL627) or slide (RBL628)."""
    # every comparison is false for NaN: a value that the file does not give is not doubted
    doubts = []
    # one warning a rule, at the first axis, for all that share it: a file in the wrong unit breaks one rule six times
    for rule in _RULES:
        for in_units, (tail, hint) in ((False, rule.si), (True, rule.units)):
            axes = [k for k, joint in enumerate(joints) if _breaks(joint, rule, in_units)]
            if axes:
                name = "limits" if rule.what == "range" else "speeds"
                message = f"{name} {tail}: {', '.join(joints[k].text(rule.what) for k in axes)}"
                doubts.append(place(rule.what, axes[0])(_CODES[rule.kind], message, hint))
    return doubts


def _breaks(joint: Moving, rule: _Rule, in_units: bool) -> bool:
    return joint.kind is rule.kind and joint.in_units is in_units and rule.unlikely(joint)


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
    """Return the doubts about ranges, speeds, jerks (RBL627, RBL628) and gears (RBL629) of axes in TOML tables."""
    labels = [joint_label(k, axis.name) for k, axis in enumerate(axes)]
    joints = [_moving(label, axis.limits) for label, axis in zip(labels, axes, strict=True)]
    place = in_tables([axis.table for axis in axes])
    # these files are in degrees and mm by their keys; only a URDF or MJCF may be in radians or m
    doubts = [*doubt_moving(joints, place), *_doubt_jerks(labels, [axis.limits for axis in axes], place)]
    # gears of arms reduce: a ratio below 1 is most likely joint turns per motor turn
    slow = [k for k, axis in enumerate(axes) if not (abs(axis.motor.gear_ratio) >= 1.0 or axis.limits.kind.slides)]
    if slow:
        listed = ", ".join(f"{labels[k]} {axes[k].motor.gear_ratio:g}" for k in slow)
        hint = "write motor turns per joint turn: 100 for 100:1, not 0.01"
        doubts.append(place("gear", slow[0])("RBL629", f"gears make the motor slower than the joint: {listed}", hint))
    return tuple(doubts)


def _doubt_jerks(labels: Sequence[str], limits: Sequence[Limits], place: Place) -> list[FileFault]:
    """Return the doubts about jerks so small that an acceleration is hardly reached, one for each kind of axis."""
    doubts = []
    for kind, code in _CODES.items():
        slow = [k for k, own in enumerate(limits) if own.kind is kind and own.acceleration > SLOWEST_RISE * own.jerk]
        if slow:
            listed = ", ".join(_jerk(labels[k], limits[k]) for k in slow)
            message = f"jerks build up an acceleration in more than {SLOWEST_RISE:g} s: {listed}"
            hint = f"Check them; the file has {kind.unit}/s3. Without {kind.jerk_key} it takes {RISE_S:g} s."
            doubts.append(place("jerk", slow[0])(code, message, hint))
    return doubts


def _jerk(label: str, own: Limits) -> str:
    return f"{label} {own.jerk / own.kind.size:.6g} {own.kind.unit}/s3 = {own.acceleration / own.jerk:.3g} s"


def _moving(label: str, own: Limits) -> Moving:
    return Moving(label=label, lower=own.lower, upper=own.upper, speed=own.speed, in_units=True, kind=own.kind)


def _keys(what: What, table: Table) -> tuple[str, ...]:
    """Return the keys of a value in the table of an axis."""
    kind = drives.axis_kind(table)
    keys: dict[What, tuple[str, ...]] = {
        "range": (kind.range_key,),
        "speed": (kind.speed_key,),
        "jerk": (kind.jerk_key,),
        "torque": (kind.force_key,),
        "body": ("mass_kg",),
        "length": (),
        "gear": ("motor", kind.transmission_key),
    }
    return keys[what]


def in_tables(tables: Sequence[Table]) -> Place:
    """Return the places of the values of axes that have a TOML table each."""

    def place(what: What, axis: int) -> Callable[[str, str, str], FileFault]:
        table = tables[axis]
        return lambda code, message, hint: table.source.fault(code, message, hint, (*table.keys, *_keys(what, table)))

    return place
