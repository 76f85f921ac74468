"""Values of a robot file that are possible and unlikely: as a rule they are in another unit than the file's.

What cannot be is refused where it is read (RBL605, RBL606). What no known arm has is doubted here: the arm is loaded,
and every doubt is a warning at its place, one for all axes that share it. The bounds (docs/robots-import.md):

    RBL627   a joint range of more than ``MOST_TURNS`` to a side, or within ``LEAST_ANGLE``; a speed above ``FASTEST``
             or below ``LEAST_ANGLE`` a second: degrees for radians, radians for degrees, a conversion made twice
    RBL628   a reach above ``LONGEST`` or below ``SHORTEST``; a centre of gravity further off than the whole arm
    RBL629   bodies heavier than ``HEAVIEST`` times the cube of the reach, denser than ``DENSEST``, or with a radius of
             gyration above the reach; a gear ratio below 1; a torque above ``STRONGEST`` times the arm's own weight

Reach is the sum of the distances from joint to joint and to the flange. Units other by a factor below about ten (lb,
inches) cannot be told from a light or a small arm. Read at start, no rate.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from runtime.frames import Array
from runtime.linear import norm
from runtime.robot.drives import joint_label
from runtime.robot.spec import AxisSpec, Body
from runtime.tomlfile import FileFault, Table
from runtime.units import DEG, GRAVITY, MM

MOST_TURNS = 2.0 * 2.0 * math.pi
"""Two turns to either side, rad: cables end earlier."""
LEAST_ANGLE = 2.0 * math.pi * DEG
"""A joint that turns no further, rad, or no faster, rad/s: 2 pi taken as degrees."""
FASTEST = 30.0
"""Fastest joint, rad/s (1719 deg/s)."""
LONGEST, SHORTEST = 8.0, 0.02
"""Reach of an arm, m: the longest built reach about 5 m."""
HEAVIEST = 1000.0
"""Mass of an arm over the cube of its reach, kg/m3; built arms have 5 to 250."""
SMALLEST = 0.5
"""Reach below which the mass is judged as at this one, m."""
DENSEST = 20_000.0
"""Density of tungsten and gold, kg/m3."""
STRONGEST = 50.0
"""Torque of an axis over weight times reach of the arm; built arms have up to 2."""

What = Literal["range", "speed", "torque", "body", "length", "gear"]
Place = Callable[[What, int], Callable[[str, str, str], FileFault]]
"""``place(what, axis)(code, message, hint)`` is a fault where a value of an axis (0-based) stands."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Turning:
    """How far and fast a joint turns, rad and rad/s, and its torque, N m; NaN where its file says nothing.

    ``in_degrees``: the file has degrees and deg/s, else radians and rad/s.
    """

    label: str
    lower: float
    upper: float
    speed: float
    torque: float
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


@dataclass(frozen=True, slots=True, kw_only=True)
class _TurningRule:
    """What is unlikely, and what it looks like with its remedy, in a file of radians and in one of degrees."""

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
    """Return what is unlikely about ranges and speeds (RBL627)."""
    doubts = []
    for rule in _TURNING_RULES:
        for in_degrees, (tail, hint) in ((False, rule.radians), (True, rule.degrees)):
            axes = [k for k, joint in enumerate(joints) if joint.in_degrees is in_degrees and rule.unlikely(joint)]
            if axes:
                name = "limits" if rule.what == "range" else "speeds"
                message = f"{name} {tail}: {', '.join(joints[k].text(rule.what) for k in axes)}"
                doubts.append(place(rule.what, axes[0])("RBL627", message, hint))
    return doubts


def doubt_bodies(labels: Sequence[str], bodies: Sequence[Body | None], offsets: Array, place: Place) -> list[FileFault]:
    """Return what is unlikely about lengths (RBL628) and bodies (RBL629).

    ``bodies`` in their axis frames, None for one that is corrected; ``offsets`` (n + 1, 3) m from each joint to the
    next, from the base first and to the flange last.
    """
    lengths = np.linalg.norm(offsets, axis=1)
    reach, doubts = float(lengths[1:].sum()), []
    if not SHORTEST <= reach <= LONGEST:
        looks = "it looks like mm" if reach > LONGEST else "its joints are all in one place"
        message = f"the arm is {reach / MM:.4g} mm from its first joint to the flange: {looks}"
        doubts.append(place("length", int(np.argmax(lengths[1:])))("RBL628", message, "lengths are in m"))
    size = float(np.maximum(lengths.sum(), SMALLEST))
    known = [(axis, body) for axis, body in enumerate(bodies) if body is not None and body.mass > 0.0]
    for code, unlikely, tail, hint in _BODY_RULES:
        axes = [axis for axis, body in known if unlikely(body, size)]
        if axes:
            listed = ", ".join(f"{labels[axis]} {_body(bodies[axis], code)}" for axis in axes)
            doubts.append(place("body", axes[0])(code, f"{tail}: {listed}", hint))
    mass = sum(body.mass for _, body in known)
    if not mass <= HEAVIEST * size**3:
        message = f"masses look like grams: {mass:g} kg in all, and the arm is {size / MM:.4g} mm long"
        doubts.append(place("body", int(max(known, key=lambda each: each[1].mass)[0]))("RBL629", message, _KG))
    return doubts


def doubt_drives(joints: Sequence[Turning], ratios: Sequence[float], weight: float, place: Place) -> list[FileFault]:
    """Return what is unlikely about gear ratios and torques (RBL629); ``weight`` N m: see ``weight_moment``."""
    slow = [axis for axis, ratio in enumerate(ratios) if abs(ratio) < 1.0]  # NaN: not known
    strong = [axis for axis, joint in enumerate(joints) if joint.torque > STRONGEST * weight > 0.0]
    doubts = []
    if slow:
        listed = ", ".join(f"{joints[axis].label} {ratios[axis]:g}" for axis in slow)
        hint = "write motor turns per joint turn: 100 for 100:1, not 0.01"
        doubts.append(place("gear", slow[0])("RBL629", f"gears make the motor slower than the joint: {listed}", hint))
    if strong:
        listed = ", ".join(f"{joints[axis].label} {joints[axis].torque:g} N m" for axis in strong)
        message = f"torques look like N mm: {listed}; to hold the whole arm takes less than {weight:.3g} N m"
        doubts.append(place("torque", strong[0])("RBL629", message, "torques are in N m"))
    return doubts


def doubt_limits_and_drives(axes: Sequence[AxisSpec], X_last_flange: Array, tables: Sequence[Table]) -> list[FileFault]:
    """Return what is unlikely about limits and drives that stand in TOML tables, one for each axis."""
    joints = [
        Turning(label=joint_label(k, axis.name), lower=axis.limits.lower, upper=axis.limits.upper,
                speed=axis.limits.speed, torque=axis.limits.torque, in_degrees=True)
        for k, axis in enumerate(axes)
    ]  # fmt: skip
    weight = weight_moment([axis.body for axis in axes], offsets([axis.placement for axis in axes], X_last_flange))
    place = in_tables(tables)
    return doubt_turning(joints, place) + doubt_drives(joints, [axis.motor.gear_ratio for axis in axes], weight, place)


_KEYS: dict[What, tuple[str, ...]] = {
    "range": ("range_deg",), "speed": ("max_speed_deg_s",), "torque": ("max_torque_nm",), "body": ("mass_kg",),
    "length": (), "gear": ("motor", "gear_ratio"),
}  # fmt: skip


def in_tables(tables: Sequence[Table]) -> Place:
    """Return where the values of axes stand that have a TOML table each."""

    def place(what: What, axis: int) -> Callable[[str, str, str], FileFault]:
        table = tables[axis]
        return lambda code, message, hint: table.source.fault(code, message, hint, (*table.keys, *_KEYS[what]))

    return place


def offsets(placements: Sequence[Array], X_last_flange: Array) -> Array:
    """Return the way from each joint to the next (n + 1, 3) m, from the base first and to the flange last."""
    return np.array([X[:3, 3] for X in (*placements, X_last_flange)])


def weight_moment(bodies: Sequence[Body], offsets: Array) -> float:
    """Return the largest moment that the weight of an arm could have about one of its joints, N m."""
    return float(sum(body.mass for body in bodies)) * GRAVITY * float(np.linalg.norm(offsets, axis=1).sum())


def _far(body: Body, size: float) -> bool:
    return not norm(body.cog) <= size


def _spread(body: Body, size: float) -> bool:
    return not math.sqrt(float(np.maximum(0.0, np.linalg.eigvalsh(body.inertia)[2])) / body.mass) <= size


def _dense(body: Body, size: float) -> bool:
    """A ball has the least inertia of all bodies of its mass and density."""
    radius = (0.75 * body.mass / (math.pi * DENSEST)) ** (1.0 / 3.0)
    return not float(np.trace(body.inertia)) >= 3.0 * 0.4 * body.mass * radius**2


_KG = "masses are in kg, inertias in kg m2"
_BODY_RULES = (
    ("RBL628", _far, "centres of gravity are further off than the arm is long", "positions are in m"),
    ("RBL629", _spread, "inertias are too large for the mass and look like kg mm2 or g mm2", _KG),
    ("RBL629", _dense, "inertias are too small for the mass, as of a body denser than gold", _KG),
)


def _body(body: Body | None, code: str) -> str:
    assert body is not None
    if code == "RBL628":
        return f"{norm(body.cog) / MM:.4g} mm"
    return f"{body.mass:g} kg with {float(np.linalg.eigvalsh(body.inertia)[2]):.3g} kg m2"


def _deg(angle: float) -> str:
    return f"{angle / DEG:.6g}"
