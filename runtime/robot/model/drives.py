"""Drives and limits of an arm: motor, range, speed and loop bandwidths of every axis, and the limits of the tool point.

Robot files and the sidecars of model files state them with the same keys (docs/robots.md); both are read here, in mm
and deg, and kept in SI. Imports no numerics: ``robolang check`` reads the ranges of a robot with it.
"""

import math
from collections.abc import Sequence

from runtime.core.record import Record
from runtime.core.tomlfile import Table
from runtime.core.units import DEG, MM
from runtime.robot.model.axis_kind import KINDS, REVOLUTE, AxisKind

STIFFEST = 1e8
"""No gear is stiffer than this at the joint, N m/rad or N/m."""

FASTEST_SPRING = 1e4
"""A rotor that swings faster against its gear, rad/s, needs physics steps below 25 us: such a gear is rigid."""

RANGE_ROUNDING = 1e-9
"""A joint may pass the end of its range by as much, rad or m: rounding of deg and mm."""

WIDEST = REVOLUTE.widest
"""No joint turns further than ten turns to a side, rad."""

FASTEST_LOOP = 8000.0
"""No loop is stable beyond this at the shortest servo period: bandwidth times 0.25 ms is 2, 1/s (see ``project``)."""

RISE_S = 0.1
"""Time in which the acceleration of a joint builds up, s, where its robot file has no jerk limit."""


class Motor(Record):
    """The drive of one axis, motor side.

    An axis that slides has the same formulas with m for rad at the joint: N is rad/m, N^2 J a mass, torques are forces.
    ``gear_ratio`` N is signed (motor turns per joint turn), ``rotor_inertia`` kg m2, ``torque_constant`` N m/A,
    ``max_current`` A, ``viscous_friction`` N m s/rad, ``coulomb_friction`` N m (turning forward, backward, both
    positive), ``encoder_counts`` per motor turn, ``current_bandwidth`` rad/s. ``stiffness`` N m/rad and ``damping``
    N m s/rad are those of the gear between motor and link, at the joint; infinite stiffness is a rigid gear.
    """

    gear_ratio: float
    rotor_inertia: float
    torque_constant: float
    max_current: float
    viscous_friction: float
    coulomb_friction: tuple[float, float]
    encoder_counts: int
    current_bandwidth: float
    stiffness: float = math.inf
    damping: float = 0.0

    @property
    def elastic(self) -> bool:
        """Whether the gear is a spring between motor and link."""
        return math.isfinite(self.stiffness)

    @property
    def reflected_inertia(self) -> float:
        """Rotor inertia at the joint, N^2 J, kg m2 (docs/servo.md: the document omits N)."""
        return self.gear_ratio**2 * self.rotor_inertia

    @property
    def joint_torque_constant(self) -> float:
        """Ktn: joint torque per motor current, N m/A. Positive: the current is counted in joint direction."""
        return abs(self.gear_ratio) * self.torque_constant

    @property
    def joint_viscous_friction(self) -> float:
        """N^2 B, N m s/rad at the joint."""
        return self.gear_ratio**2 * self.viscous_friction

    @property
    def joint_coulomb_friction(self) -> tuple[float, float]:
        """|N| Tc at the joint, N m, (joint turning forward, joint turning backward)."""
        forward, backward = self.coulomb_friction
        if self.gear_ratio < 0.0:  # the joint turns forward while the motor turns backward
            forward, backward = backward, forward
        return abs(self.gear_ratio) * forward, abs(self.gear_ratio) * backward


class Limits(Record):
    """Joint limits: range rad, speed rad/s, acceleration rad/s2, jerk rad/s3, torque N m (at the joint), or m and N.

    ``kind`` says which. ``jerk`` is the acceleration over ``RISE_S`` where the file has none. ``rated_moment`` N m and
    ``rated_inertia`` kg m2 that a payload may have about the axis; None: not published
    (``runtime.robot.kinematics.wrist_load`` estimates them).
    """

    lower: float
    upper: float
    speed: float
    acceleration: float
    jerk: float
    torque: float
    rated_moment: float | None = None
    rated_inertia: float | None = None
    kind: AxisKind = REVOLUTE


class Bandwidths(Record):
    """The bandwidths that give the loop gains of an axis: Kp = ``position`` 1/s, Kv = K Ktn = ``velocity`` 1/s."""

    position: float
    velocity: float


class PathLimits(Record):
    """Limits and defaults of the tool point on a straight move, m/s, m/s2, m/s3 and rad/s, rad/s2, rad/s3."""

    default_speed: float
    max_speed: float
    acceleration: float
    jerk: float
    rotation_speed: float
    rotation_acceleration: float
    rotation_jerk: float


def path_limits(table: Table) -> PathLimits:
    """Read ``[path]`` in mm and deg into SI; ``FileFault`` RBL60x."""
    limits = PathLimits(
        default_speed=table.number("default_speed_mm_s", positive=True) * MM,
        max_speed=table.number("max_speed_mm_s", positive=True) * MM,
        acceleration=table.number("acceleration_mm_s2", positive=True) * MM,
        jerk=table.number("jerk_mm_s3", positive=True) * MM,
        rotation_speed=table.number("rotation_speed_deg_s", positive=True) * DEG,
        rotation_acceleration=table.number("rotation_acceleration_deg_s2", positive=True) * DEG,
        rotation_jerk=table.number("rotation_jerk_deg_s3", positive=True) * DEG,
    )
    if not limits.default_speed <= limits.max_speed:
        table.fail("RBL605", "'path.default_speed_mm_s' is above 'path.max_speed_mm_s'", key="default_speed_mm_s")
    table.done()
    return limits


def axis_kind(table: Table) -> AxisKind:
    """Read the kind of an axis, revolute without the key; ``FileFault`` RBL60x."""
    return KINDS[table.text("kind", REVOLUTE.name, choices=tuple(KINDS))]


def motor(table: Table, kind: AxisKind = REVOLUTE) -> Motor:
    """Read ``[axes.motor]``, motor side; ``FileFault`` RBL60x."""
    ratio = _ratio(table, kind)
    # two numbers, since gears differ by direction; both positive, so that a sign cannot be read in two senses
    forward, backward = table.numbers("coulomb_friction_nm", 2, low=0.0)
    # one of the two makes the gear elastic and the other is then required: an undamped spring is not guessed
    elastic = kind.stiffness_key in table or kind.damping_key in table
    motor = Motor(
        gear_ratio=ratio,
        rotor_inertia=table.number("rotor_inertia_kg_m2", low=0.0),
        torque_constant=table.number("torque_constant_nm_a", positive=True),
        max_current=table.number("max_current_a", positive=True),
        viscous_friction=table.number("viscous_friction_nm_s", low=0.0),
        coulomb_friction=(forward, backward),
        encoder_counts=table.integer("encoder_counts", low=4, high=2**30),
        # Hz in the file, as data sheets have it
        current_bandwidth=table.number("current_bandwidth_hz", positive=True) * 2.0 * math.pi,
        stiffness=table.number(kind.stiffness_key, positive=True, high=STIFFEST) if elastic else math.inf,
        damping=table.number(kind.damping_key, low=0.0) if elastic else 0.0,
    )
    _check_spring(table, motor, kind)
    table.done()
    return motor


def _ratio(table: Table, kind: AxisKind) -> float:
    """Return N, rad of the motor per rad or m of the axis, signed."""
    key = kind.transmission_key
    most = 1000.0 if kind.slides else 10000.0
    ratio = table.number(key, low=-most, high=most)
    # a screw of 10 um a turn is the finest that positions; anything below is a slip of the unit
    if not abs(ratio) >= (1e-2 if kind.slides else 1e-3):
        table.fail("RBL605", f"'{table.name(key)}' is {ratio:g} and must not be zero", key=key)
    return kind.motor_ratio(ratio)


def _check_spring(table: Table, motor: Motor, kind: AxisKind) -> None:
    """Refuse a spring without a mass on the motor's side, or one that swings too fast to be simulated."""
    if not motor.elastic:
        return
    if not motor.rotor_inertia > 0.0:
        table.fail(
            "RBL605",
            f"'{table.name('rotor_inertia_kg_m2')}' is 0, and the spring of the gear needs a rotor",
            key="rotor_inertia_kg_m2",
        )
    # the eigenfrequency of the rotor against its gear, sqrt(Kc / (N^2 J)), squared
    if not motor.stiffness <= motor.reflected_inertia * FASTEST_SPRING**2:
        table.fail(
            "RBL605",
            f"the spring of {motor.stiffness:g} {kind.force}/{'m' if kind.slides else 'rad'} swings the rotor too fast "
            "to be simulated",
            f"a gear as stiff as that is rigid: leave out {kind.stiffness_key} and {kind.damping_key}",
            key=kind.stiffness_key,
        )


def limits(table: Table, kind: AxisKind = REVOLUTE) -> Limits:
    """Read the range, speed, acceleration, jerk and torque of an axis in deg and N m, or mm and N; ``FileFault``."""
    lower, upper = joint_range(table, kind)
    acceleration = table.number(kind.acceleration_key, positive=True) * kind.size
    jerk = _optional(table, kind.jerk_key)
    return Limits(
        lower=lower,
        upper=upper,
        speed=table.number(kind.speed_key, positive=True) * kind.size,
        acceleration=acceleration,
        jerk=acceleration / RISE_S if jerk is None else jerk * kind.size,
        torque=table.number(kind.force_key, positive=True),
        # what a payload weighs about an axis is a moment: a sliding axis is rated by its force alone
        rated_moment=None if kind.slides else _optional(table, "rated_moment_nm"),
        rated_inertia=None if kind.slides else _optional(table, "rated_inertia_kg_m2"),
        kind=kind,
    )


def joint_range(table: Table, kind: AxisKind = REVOLUTE) -> tuple[float, float]:
    """Read ``range_deg`` or ``range_mm`` of an axis, rad or m; ``FileFault`` RBL60x."""
    key = kind.range_key
    lower, upper = table.numbers(key, 2, low=-kind.widest / kind.size, high=kind.widest / kind.size)
    if not lower < upper:
        table.fail("RBL607", f"'{table.name(key)}' is [{lower:g}, {upper:g}]: the first must be smaller", key=key)
    return lower * kind.size, upper * kind.size


def link_radii(tables: Sequence[Table]) -> tuple[float, ...]:
    """Return the radii of the links, m, of axes with a table each; empty when none has one; ``FileFault``.

    RBL608 at an axis without one where others have it.
    """
    radii = [_optional(table, "link_radius_mm") for table in tables]
    given = [radius * MM for radius in radii if radius is not None]
    # some links only would leave gaps that a check of the arm against itself does not see
    if given and len(given) < len(radii):
        table = tables[radii.index(None)]
        table.fail(
            "RBL608",
            f"'{table.name('link_radius_mm')}' is missing",
            "other axes have it: give it for all of them or for none",
        )
    return tuple(given)


def _optional(table: Table, key: str) -> float | None:
    """Return a number above 0, None where the file has none."""
    table.ask(key)  # known also where it is missing, so that a misspelt key is compared with it
    return table.number(key, positive=True) if key in table else None


def bandwidths(table: Table) -> Bandwidths:
    """Read ``[axes.servo]``, 1/s; ``FileFault`` RBL60x."""
    bandwidths = Bandwidths(
        position=table.number("position_bandwidth_rad_s", positive=True, high=FASTEST_LOOP),
        velocity=table.number("velocity_bandwidth_rad_s", positive=True, high=FASTEST_LOOP),
    )
    table.done()
    return bandwidths


def texts(table: Table, key: str) -> tuple[str, ...]:
    """Return an optional list of texts; ``FileFault`` RBL613."""
    value = table.raw_list(key)
    if not all(isinstance(item, str) for item in value):
        table.fail("RBL613", f"'{key}' must be a list of texts", key=key)
    return tuple(value)


def beyond_range(joints: Sequence[float | None], limits: Sequence[Limits]) -> str:
    """Return which joint is furthest outside of its range at joints (n,) deg or mm, and by how much; empty for none.

    A joint of None is not known. With fewer ``limits`` than joints, or fewer joints, only the pairs are compared.
    """
    # the worst joint only: the others are often outside for the same reason
    worst, found = RANGE_ROUNDING, ""
    for index, (value, axis) in enumerate(zip(joints, limits, strict=False)):
        if value is None:
            continue
        size, unit = axis.kind.size, axis.kind.unit
        excess = max(axis.lower - value * size, value * size - axis.upper)
        if not excess <= worst:
            worst = excess
            found = (
                f"J{index + 1} is at {value:g} {unit}, {excess / size:.4g} {unit} outside of its range of "
                f"{axis.lower / size:g} to {axis.upper / size:g} {unit}"
            )
    return found


def joint_label(index: int, name: str) -> str:
    """Return ``J2 shoulder_lift``: the number of an axis (0-based ``index``) from 1, and its name in the file."""
    return f"J{index + 1} {name}"
