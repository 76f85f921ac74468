"""The robot as data: geometry, bodies, drives, limits and loop bandwidths of every axis, in SI.

One frozen ``RobotSpec`` feeds every consumer: the Pinocchio model of the controller, the MuJoCo model of the
plant, the closed-form inverse kinematics, the servo gains and the planner's limits.

Each axis is a joint that turns about the z axis of its own frame, or slides along it (``axis_kind``). ``placement`` is
the pose of that frame, with the joint at zero, in the frame of the joint before it; body data are in the axis' own
frame, which moves with the joint. Joint coordinates are rad, of a sliding axis m.
Robot files give standard Denavit-Hartenberg rows (``form = "dh"``) or joint lines in space (``form = "lines"``);
``geometry`` turns either into these frames.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array, frozen
from runtime.core.tomlfile import FileFault
from runtime.core.units import DEG
from runtime.robot.model.axis_kind import AxisKind
from runtime.robot.model.drives import Bandwidths, Limits, Motor, PathLimits
from runtime.robot.model.load_rules import moments_defect


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A rigid body: mass kg, centre of gravity (3,) m, inertia (3, 3) about the centre of gravity, kg m2."""

    mass: float
    cog: Array
    inertia: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisSpec:
    """One axis: its name, joint placement (4, 4), body, motor, limits and bandwidths."""

    name: str
    placement: Array
    body: Body
    motor: Motor
    limits: Limits
    bandwidths: Bandwidths

    @property
    def kind(self) -> AxisKind:
        """Whether it turns or slides."""
        return self.limits.kind


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

    @property
    def lengths(self) -> tuple[float, ...]:
        """The lengths a1, a2, b, c1, c2, c3, c4, m."""
        return self.a1, self.a2, self.b, self.c1, self.c2, self.c3, self.c4

    @staticmethod
    def of(lengths: Sequence[float], offsets: Array, signs: Array) -> "OpwParameters":
        """Return the parameters with ``lengths`` (7,) m in the order of the property, offsets and signs (6,)."""
        a1, a2, b, c1, c2, c3, c4 = lengths
        return OpwParameters(
            a1=a1, a2=a2, b=b, c1=c1, c2=c2, c3=c3, c4=c4, offsets=frozen(offsets), signs=frozen(signs)
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Correction:
    """A change to the published body of ``axis`` (0-based) that makes it a possible one, and why (``corrections``).

    ``inertia_shift`` and ``added_inertia`` kg m2, ``added_mass`` kg.
    """

    axis: int
    inertia_shift: float
    added_mass: float
    reason: str
    added_inertia: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkMesh:
    """A mesh file that shows a link: pictures use it, nothing else does.

    ``link`` counts from the base, 0; link i is moved by axis i - 1. ``X_link_mesh`` (4, 4) is in the frame of the axis
    (of the base: the world). ``file`` is its name as the model has it, ``folder`` that of the model, which holds it;
    ``scale`` (3,) makes its numbers m.
    """

    link: int
    file: str
    folder: str
    X_link_mesh: Array
    scale: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotSpec:
    """A robot of ``n`` axes. ``X_last_flange`` (4, 4) is the flange in the frame of the last axis.

    ``published`` holds the bodies as the source prints them, before ``corrections``. ``warnings`` are the doubts
    about its files, each at its place (``plausibility``). ``link_radii`` m, one for each axis: of the capsules from
    joint to joint that stand for the links; empty: the shapes of the arm are not known. ``meshes`` show the links.
    ``estimated`` has the values that are estimates, by their names in the file (``axes.1.motor.gear_ratio``), with the
    rule of each. ``undriven``: the fault of physics with an arm whose drives no file states; None for others.
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
    link_radii: tuple[float, ...] = ()
    meshes: tuple[LinkMesh, ...] = ()
    estimated: Mapping[str, str] = field(default_factory=dict)
    undriven: FileFault | None = None

    @property
    def n(self) -> int:
        """Number of axes."""
        return len(self.axes)

    def per_axis(self, group: str, field: str) -> Array:
        """Return one number of every axis as an array (n,), e.g. ``per_axis("limits", "speed")``."""
        return np.array([getattr(getattr(axis, group), field) for axis in self.axes])

    @property
    def lower(self) -> Array:
        """Lower joint limits (n,) rad or m."""
        return self.per_axis("limits", "lower")

    @property
    def upper(self) -> Array:
        """Upper joint limits (n,) rad or m."""
        return self.per_axis("limits", "upper")

    @property
    def units(self) -> Array:
        """What people type and read of each axis, as SI (n,): a degree, rad, or of a sliding axis a millimetre, m."""
        return self.per_axis("kind", "size")

    @property
    def slides(self) -> NDArray[np.bool_]:
        """Whether each axis slides (n,)."""
        return np.array([axis.kind.slides for axis in self.axes])

    @property
    def joints_key(self) -> str:
        """The key of joints in what is written for programs: with deg in its name where all axes turn."""
        return "joints" if self.slides.any() else "joints_deg"

    def largest(self, off: Array) -> str:
        """Return the largest of distances (n,) of joints, rad where a mm counts as a deg, in the unit of its axis."""
        axis = int(np.argmax(off))
        return f"{off[axis] / DEG:.3f} {self.axes[axis].kind.unit}"

    def bound(self, angle: float) -> Array:
        """Return a bound of ``angle`` rad for every axis (n,); for one that slides as many mm as the angle has deg, m.

        A bound such as a following error is set once, in deg, for all axes of an arm.
        """
        return angle * (self.units / DEG)


def dh_transform(d: float, a: float, alpha: float) -> Array:
    """Return ``Tz(d) Tx(a) Rx(alpha)``, the fixed part of a standard DH row (m, rad)."""
    # cos(pi/2) is 6e-17 in floating point: rounded away, so that right angles are exact in every model built from it
    c, s = (round(f(alpha), 15) + 0.0 for f in (math.cos, math.sin))
    return np.array([[1.0, 0.0, 0.0, a], [0.0, c, -s, 0.0], [0.0, s, c, d], [0.0, 0.0, 0.0, 1.0]])


def inertia_defect(inertia: Array) -> float:
    """Return by how much a 3x3 inertia fails to be a body's: 0 when it is one, else kg m2 missing.

    Principal moments must be positive and each at most the sum of the other two.
    """
    return moments_defect(np.linalg.eigvalsh(inertia).tolist())


def shift_between_links(axis_spec: AxisSpec, before: Body, shift: float) -> tuple[Body, Body]:
    """Move ``shift`` (kg m2) of inertia about the two axes across a joint from the link before it to its link.

    The tensor ``shift * (E - z z')`` is symmetric about the joint axis z, so it may belong to either side of the
    joint: the two angular velocities differ only along z, where it is zero. The equations of motion are therefore
    unchanged in exact arithmetic. Returns (body of the axis, body before it).
    """
    # added to one side and taken from the other, each in its own frame, in which the joint axis has other components
    z = np.array([0.0, 0.0, 1.0])
    own = axis_spec.body.inertia + shift * (np.eye(3) - np.outer(z, z))
    z_before = axis_spec.placement[:3, 2]
    other = before.inertia - shift * (np.eye(3) - np.outer(z_before, z_before))
    return (
        Body(mass=axis_spec.body.mass, cog=axis_spec.body.cog, inertia=own),
        Body(mass=before.mass, cog=before.cog, inertia=other),
    )
