"""The robot as data: geometry, bodies, drives, limits and loop bandwidths of every axis, in SI.

One frozen ``RobotSpec`` feeds every consumer: the Pinocchio model of the controller, the MuJoCo model of the
plant, the closed-form inverse kinematics, the servo gains and the planner's limits.

Each axis is a revolute joint about the z axis of its own frame. ``placement`` is the pose of that frame, at joint
angle zero, in the frame of the joint before it; body data are in the axis' own frame, which turns with the joint.
Robot files give standard Denavit-Hartenberg rows (``form = "dh"``) or joint lines in space (``form = "lines"``);
``geometry`` turns either into these frames.
"""

import math
from dataclasses import dataclass

import numpy as np

from runtime.frames import Array
from runtime.tomlfile import FileFault


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A rigid body: mass kg, centre of gravity (3,) m, inertia (3, 3) about the centre of gravity, kg m2."""

    mass: float
    cog: Array
    inertia: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Motor:
    """The drive of one axis, motor side.

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
        if self.gear_ratio < 0.0:
            forward, backward = backward, forward
        return abs(self.gear_ratio) * forward, abs(self.gear_ratio) * backward


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Joint limits: range rad, speed rad/s, acceleration rad/s2, torque N m (at the joint).

    ``rated_moment`` N m and ``rated_inertia`` kg m2 that a payload may have about the axis; None: not published
    (``runtime.robot.load`` estimates them).
    """

    lower: float
    upper: float
    speed: float
    acceleration: float
    torque: float
    rated_moment: float | None = None
    rated_inertia: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Bandwidths:
    """What the loop gains of an axis derive from: Kp = ``position`` 1/s, Kv = K Ktn = ``velocity`` 1/s."""

    position: float
    velocity: float


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisSpec:
    """One axis: its name, joint placement (4, 4), body, motor, limits and bandwidths."""

    name: str
    placement: Array
    body: Body
    motor: Motor
    limits: Limits
    bandwidths: Bandwidths


@dataclass(frozen=True, slots=True, kw_only=True)
class PathLimits:
    """Limits and defaults of the tool point on a straight move, m/s, m/s2, m/s3 and rad/s, rad/s2, rad/s3."""

    default_speed: float
    max_speed: float
    acceleration: float
    jerk: float
    rotation_speed: float
    rotation_acceleration: float
    rotation_jerk: float


@dataclass(frozen=True, slots=True, kw_only=True)
class OpwParameters:
    """Geometry of an ortho-parallel arm with a spherical wrist (Brandstoetter, Angerer, Hofbaur 2014).

    Lengths m. The joint angle of the OPW model is ``sign * q + offset``.
    """

    a1: float
    a2: float
    b: float
    c1: float
    c2: float
    c3: float
    c4: float
    offsets: Array
    signs: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Correction:
    """A change made to published body data so that it is a possible body, and why (see ``corrections``)."""

    axis: int
    inertia_shift: float
    added_mass: float
    reason: str
    added_inertia: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotSpec:
    """A robot of ``n`` axes. ``X_last_flange`` (4, 4) is the flange in the frame of the last axis.

    ``published`` holds the bodies as the source prints them, before ``corrections``. ``warnings`` are what is unlikely
    about its files, each at its place (``plausibility``).
    """

    name: str
    title: str
    sources: tuple[str, ...]
    rated_payload: float
    axes: tuple[AxisSpec, ...]
    X_last_flange: Array
    path: PathLimits
    opw: OpwParameters | None
    corrections: tuple[Correction, ...]
    published: tuple[Body, ...]
    notes: tuple[str, ...]
    warnings: tuple[FileFault, ...] = ()

    @property
    def n(self) -> int:
        """Number of axes."""
        return len(self.axes)

    def per_axis(self, group: str, field: str) -> Array:
        """Return one number of every axis as an array (n,), e.g. ``per_axis("limits", "speed")``."""
        return np.array([getattr(getattr(axis, group), field) for axis in self.axes])

    @property
    def lower(self) -> Array:
        """Lower joint limits (n,) rad."""
        return self.per_axis("limits", "lower")

    @property
    def upper(self) -> Array:
        """Upper joint limits (n,) rad."""
        return self.per_axis("limits", "upper")


def dh_transform(d: float, a: float, alpha: float) -> Array:
    """Return ``Tz(d) Tx(a) Rx(alpha)``, the fixed part of a standard DH row (m, rad)."""
    # cos(pi/2) is 6e-17: rounded away, so that right angles are exact in every model built from it
    c, s = (round(f(alpha), 15) + 0.0 for f in (math.cos, math.sin))
    return np.array([[1.0, 0.0, 0.0, a], [0.0, c, -s, 0.0], [0.0, s, c, d], [0.0, 0.0, 0.0, 1.0]])


def inertia_defect(inertia: Array) -> float:
    """Return by how much a 3x3 inertia fails to be a body's: 0 when it is one, else kg m2 missing.

    Principal moments must be positive and each at most the sum of the other two.
    """
    moments = np.linalg.eigvalsh(inertia)
    return max(0.0, float(moments[2] - moments[1] - moments[0]), float(-moments[0]))


def shift_between_links(axis_spec: AxisSpec, before: Body, shift: float) -> tuple[Body, Body]:
    """Move ``shift`` (kg m2) of inertia about the two axes across a joint from the link before it to its link.

    The tensor ``shift * (E - z z')`` is symmetric about the joint axis z, so it may belong to either side of the
    joint: the two angular velocities differ only along z, where it is zero. The equations of motion are therefore
    unchanged to the last bit of exact arithmetic. Returns (body of the axis, body before it).
    """
    z = np.array([0.0, 0.0, 1.0])
    own = axis_spec.body.inertia + shift * (np.eye(3) - np.outer(z, z))
    z_before = axis_spec.placement[:3, 2]
    other = before.inertia - shift * (np.eye(3) - np.outer(z_before, z_before))
    return (
        Body(mass=axis_spec.body.mass, cog=axis_spec.body.cog, inertia=own),
        Body(mass=before.mass, cog=before.cog, inertia=other),
    )


def joint_label(index: int, name: str) -> str:
    """Return ``J2 shoulder_lift``: the number people use, from 1, and the name in the file."""
    return f"J{index + 1} {name}"
