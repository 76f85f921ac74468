"""What the model file of an arm gives for estimates, and which of its values are placeholders (RBL642).

Makers fill in what a format asks for and what they do not publish: every link 2 kg, every joint 1000 N m. Values that
are the same for all axes of an arm are taken for that; ``estimate`` replaces them, and a warning names them.
"""

import math
from collections.abc import Sequence

import numpy as np

from runtime.core.tomlfile import FileFault
from runtime.robot.files.corrections import flat, shifted, smallest_shift
from runtime.robot.files.estimate import Known
from runtime.robot.files.imported import ImportedArm, ImportedAxis
from runtime.robot.kinematics.chain import Chain
from runtime.robot.model.drives import WIDEST
from runtime.robot.model.spec import Body

FEWEST_ALIKE = 4
"""Axes of an arm from which on values that are all alike are placeholders: a wrist is never as strong as a shoulder."""


def known_of(arm: ImportedArm) -> Known:
    """Return what the file of an arm gives; placeholders count as missing, impossible bodies are mended or missing."""
    # NaN, not 0: a value that is missing must not compare as small
    efforts = [math.nan if axis.hinge.effort is None else axis.hinge.effort for axis in arm.axes]
    bodies: tuple[Body | None, ...] = tuple(_body(axis) for axis in arm.axes)
    # a range that no sidecar may state is none
    within = np.maximum(np.abs(arm.lower), np.abs(arm.upper)) <= WIDEST
    hinges = [axis.hinge for axis in arm.axes]
    return Known(
        chain=Chain(placements=tuple(axis.placement for axis in arm.axes), X_last_flange=arm.X_last_flange),
        bodies=(None,) * arm.n if _bodies_alike(arm) else bodies,
        mended=tuple(axis.impossible is not None for axis in arm.axes),
        lower=np.where(within, arm.lower, math.nan),
        upper=np.where(within, arm.upper, math.nan),
        endless=[axis.hinge.endless for axis in arm.axes],
        speed=np.array([math.nan if hinge.speed is None else hinge.speed for hinge in hinges]),
        torque=np.full(arm.n, math.nan) if alike(efforts) else np.array(efforts),
        armature=np.array([hinge.armature for hinge in hinges]),
        damping=np.array([hinge.damping for hinge in hinges]),
        friction=np.array([hinge.friction for hinge in hinges]),
        payload=math.nan,
    )


def _body(axis: ImportedAxis) -> Body | None:
    """Return the body of an axis, mended by the least inertia where it is impossible; None where none is known."""
    if axis.impossible is None:
        return axis.body
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
    message = f"every joint has {efforts[0]:g} N m: placeholders, no torque limits"
    return [(joint.one("limit") or joint).fault("RBL642", message)]
