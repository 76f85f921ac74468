"""The hand as bodies: how the mass a cell file states is shared out between palm and fingers.

Each finger takes an eighth of the mass, at the middle of its box, and the palm the rest, at the place that makes the
whole match the file. The fingers move symmetrically, so mass and centre of gravity are exact at every opening; only the
moments of inertia change with it, by ``2 m_f y^2``. Moments are those of uniform boxes: an estimate, since no hand of
this kind is published with its inertia. A hand with a suction cup is one body. Frames: flange and tool, as in
``HandSpec``.
"""

import numpy as np

from runtime.cell.cell import HandSpec
from runtime.cell.gripper import finger_sign, fingers_of, palm_box
from runtime.core.frames import Array
from runtime.core.linear import dot, matmul
from runtime.plant.inertia import box_inertia
from runtime.robot.model.spec import Body

FINGER_SHARE = 0.125


def finger_body(hand: HandSpec, side: str) -> Body:
    """Return a finger as a body in its own frame, which is the tool frame when the fingers touch."""
    width, thickness, length = hand.pad
    size = np.array([width, thickness, hand.finger_length + length / 2.0])
    cog = np.array([0.0, finger_sign(side) * thickness / 2.0, length / 2.0 - size[2] / 2.0])
    mass = FINGER_SHARE * hand.mass
    return Body(mass=mass, cog=cog, inertia=box_inertia(mass, size))


def palm_body(hand: HandSpec) -> Body:
    """Return the palm as a body in the flange frame: what is left of the hand's mass and first moment."""
    fingers = [_in_flange(hand, side, 0.0) for side in fingers_of(hand)]
    mass = hand.mass - sum(body.mass for body in fingers)
    cog = (hand.mass * hand.cog - sum(body.mass * body.cog for body in fingers)) / mass
    R = hand.X_flange_tool[:3, :3]
    return Body(mass=mass, cog=cog, inertia=matmul(R, box_inertia(mass, palm_box(hand)[0]), R.T))


def hand_body(hand: HandSpec, opening: float | None = None) -> Body:
    """Return the whole hand as one body in the flange frame, at ``opening`` m (None: half open)."""
    y = (hand.stroke / 2.0 if opening is None else opening) / 2.0
    bodies = [palm_body(hand), *(_in_flange(hand, side, y) for side in fingers_of(hand))]
    # about the centre of the file, which is that of all three bodies at any opening
    inertia = sum((_about(body, hand.cog) for body in bodies), np.zeros((3, 3)))
    return Body(mass=hand.mass, cog=hand.cog, inertia=inertia)


def _in_flange(hand: HandSpec, side: str, y: float) -> Body:
    own = finger_body(hand, side)
    R, p = hand.X_flange_tool[:3, :3], hand.X_flange_tool[:3, 3]
    cog = p + matmul(R, own.cog + np.array([0.0, finger_sign(side) * y, 0.0]))
    return Body(mass=own.mass, cog=cog, inertia=matmul(R, own.inertia, R.T))


def _about(body: Body, point: Array) -> Array:
    """Return the inertia (3, 3) of a body about ``point`` (parallel axes)."""
    r = body.cog - point
    return np.asarray(body.inertia + body.mass * (dot(r, r) * np.eye(3) - np.outer(r, r)))
