"""What the model file of an arm gives for estimates, and which of its values are placeholders (RBL642).

Makers fill in what a format asks for and what they do not publish: every link 2 kg, every joint 1000 N m. Values that
are the same for all axes of an arm are taken for that; ``estimate`` replaces them, and a warning names them.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array, frozen
from runtime.core.tomlfile import FileFault
from runtime.robot.files.corrections import TOKEN_MASS, flat, shifted, smallest_shift
from runtime.robot.files.estimate import Known
from runtime.robot.files.imported import ImportedArm, ImportedAxis
from runtime.robot.kinematics.chain import Chain
from runtime.robot.model.drives import joint_label
from runtime.robot.model.spec import Body

FEWEST_ALIKE = 4
"""Axes of an arm from which on values that are all alike are placeholders: a wrist is never as strong as a shoulder."""

_TOKEN_MOMENT = 1e-9
"""Moments of a link between two joints of one body, kg m2: those of a milligram some cm long."""


def known_of(arm: ImportedArm) -> Known:
    """Return what the file of an arm gives; placeholders count as missing, impossible bodies are mended or missing.

    ``FileFault`` RBL608 at an axis that slides and has no range: no rule gives one.
    """
    bodies: tuple[Body | None, ...] = tuple(_body(axis) for axis in arm.axes)
    efforts, within = _of_hinges(arm, "effort"), _within(arm)
    return Known(
        chain=Chain.of(arm.axes, arm.X_last_flange),
        bodies=(None,) * arm.n if _bodies_alike(arm) else bodies,
        mended=tuple(axis.impossible is not None for axis in arm.axes),
        lower=np.where(within, arm.lower, math.nan),
        upper=np.where(within, arm.upper, math.nan),
        endless=[axis.hinge.endless for axis in arm.axes],
        speed=_of_hinges(arm, "speed"),
        torque=np.full(arm.n, math.nan) if alike(efforts.tolist()) else efforts,
        armature=_of_hinges(arm, "armature"),
        damping=_of_hinges(arm, "damping"),
        friction=_of_hinges(arm, "friction"),
        payload=math.nan,
    )


def _of_hinges(arm: ImportedArm, what: str) -> Array:
    """Return a value of every hinge (n,); NaN, not 0, where it is missing, which must not compare as small."""
    return np.array([getattr(axis.hinge, what) for axis in arm.axes], dtype=np.float64)


def _within(arm: ImportedArm) -> NDArray[np.bool_]:
    """Return which axes (n,) have a range that a sidecar may state; another is none. ``FileFault`` RBL608."""
    widest = np.array([axis.kind.widest for axis in arm.axes])
    within = np.asarray(np.maximum(np.abs(arm.lower), np.abs(arm.upper)) <= widest)
    for index in np.flatnonzero(~within).tolist():
        _check_travel(arm.axes[index], index)
    return within


def _check_travel(axis: ImportedAxis, index: int) -> None:
    """Refuse an axis that slides without a range, or with one that no sidecar may state; ``FileFault`` RBL608."""
    # an angle has a whole turn for a bound; how far a carriage goes follows from nothing else in the file
    if axis.kind.slides:
        joint, label = axis.hinge.element, joint_label(index, axis.name)
        message = f"{label} slides and has no range, or one beyond {axis.kind.widest:g} m: it is never estimated"
        (joint.one("limit") or joint).fail("RBL608", message, "write both ends in m in the model file")


def _body(axis: ImportedAxis) -> Body | None:
    """Return the body of an axis, mended by the least inertia where it is impossible; None where none is known."""
    if axis.impossible is None:
        return axis.body
    if axis.between:  # the body counts once, at the last of its joints
        return Body(mass=TOKEN_MASS, cog=axis.body.cog, inertia=frozen(_TOKEN_MOMENT * np.eye(3)))
    # added to this body alone: taken from the link before, as a correction does it, it could make that one impossible
    shift = smallest_shift(axis.body.inertia)
    if not axis.body.mass > 0.0 or shift is None or flat(shifted(axis.body.inertia, shift)):
        return None
    return Body(mass=axis.body.mass, cog=axis.body.cog, inertia=shifted(axis.body.inertia, shift))


def alike(values: Sequence[float]) -> bool:
    """Return whether values of the axes of an arm are placeholders: all known and all the same."""
    return len(values) >= FEWEST_ALIKE and all(value == values[0] for value in values)


def _bodies_alike(arm: ImportedArm) -> bool:
    masses = [axis.body.mass for axis in arm.axes]
    # trace and sum of squares are those of the principal moments: the frames of the axes are turned against one another
    moments = [(np.trace(axis.body.inertia), np.sum(axis.body.inertia**2)) for axis in arm.axes]
    return masses[0] > 0.0 and alike(masses) and all(np.allclose(each, moments[0]) for each in moments)


def doubt_bodies_alike(arm: ImportedArm) -> list[FileFault]:
    """Return the warning (RBL642) about bodies that are the same for every axis."""
    if not _bodies_alike(arm):
        return []
    mass = arm.axes[0].body.mass
    message = f"every moving link has {mass:g} kg and the same inertia: placeholders, no bodies"
    return [arm.axes[0].link.fault("RBL642", message)]


def doubt_torques_alike(arm: ImportedArm) -> list[FileFault]:
    """Return the warning (RBL642) about torques that are the same for every axis."""
    efforts = [axis.hinge.effort for axis in arm.axes if axis.hinge.effort is not None]
    if len(efforts) < arm.n or not alike(efforts):
        return []
    joint = arm.axes[0].hinge.element
    units = " or ".join(dict.fromkeys(axis.kind.force for axis in arm.axes))
    message = f"every joint has {efforts[0]:g} {units}: placeholders, no limits"
    return [(joint.one("limit") or joint).fault("RBL642", message)]
