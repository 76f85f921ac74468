"""What a hand looks like: an adapter on the flange, the palm, and a cup, or fingers whose pads do not stand in shanks.

Physics has other shapes, in which shank and pad overlap; two faces in one plane would flicker in a picture.
"""

import numpy as np

from runtime.appearance.scene import SceneBody, SceneJoint, Shape
from runtime.appearance.solids import Z, box, cylinder
from runtime.cell.cell import HandSpec
from runtime.cell.gripper import finger_sign, fingers_of, palm_box
from runtime.core.frames import pose
from runtime.core.linear import matmul

FLANGE_RADIUS, FLANGE_LENGTH = 0.03, 0.012
"""Radius and thickness of the disc on which a hand is mounted, m."""


def hand_bodies(hand: HandSpec) -> list[SceneBody]:
    """Return the tool and the fingers, if there are any; a finger is at the distance of its pad from the tool, m."""
    fingers = [
        SceneBody(
            name=f"finger_{side}",
            parent="tool",
            X_parent_body=np.eye(4),
            joint=SceneJoint(
                kind="prismatic", axis=np.array([0.0, finger_sign(side), 0.0]), source="finger", index=index
            ),
        )
        for index, side in enumerate(fingers_of(hand))
    ]
    return [SceneBody(name="tool", parent="flange", X_parent_body=hand.X_flange_tool), *fingers]


def hand_shapes(hand: HandSpec) -> list[Shape]:
    """Return the shapes of a hand, on the bodies ``flange``, ``tool`` and those of the fingers."""
    size, X_tool_palm = palm_box(hand)
    palm = box("tool", X_tool_palm, size, "palm", "palm")
    fingers = [shape for side in fingers_of(hand) for shape in _finger(hand, side)]
    return [*_adapter(hand), palm, *(_cup(hand) if hand.is_cup else ()), *fingers]


def _cup(hand: HandSpec) -> list[Shape]:
    """Return a suction cup: a metal stem and, from the middle on, a lip of rubber that widens to the rim."""
    radius, length = float(hand.pad[0]), hand.finger_length
    stem, middle = radius * 0.4, -length / 2.0
    return [
        cylinder("tool", -length * Z, middle * Z, (stem, stem), "metal", "stem"),
        cylinder("tool", middle * Z, 0.0 * Z, (radius * 0.6, radius), "rubber", "cup"),
    ]


def _adapter(hand: HandSpec) -> list[Shape]:
    """Return what is between flange and palm: a disc and, where there is room, a column."""
    size, X_tool_palm = palm_box(hand)
    back = matmul(hand.X_flange_tool, X_tool_palm)[:3, 3] - size[2] / 2.0 * hand.X_flange_tool[:3, 2]
    disc = cylinder("flange", 0.0 * Z, FLANGE_LENGTH * Z, (FLANGE_RADIUS, FLANGE_RADIUS), "metal", "flange")
    if not back[2] > FLANGE_LENGTH:
        return [disc]
    # into the palm by a little: faces that only touch show a gap where the picture rounds them apart
    end = back + 0.002 * hand.X_flange_tool[:3, 2]
    radius = float(np.minimum(FLANGE_RADIUS * 0.75, size[:2].min() / 2.0))
    return [disc, cylinder("flange", FLANGE_LENGTH * Z, end, (radius, radius), "cover", "adapter")]


def _finger(hand: HandSpec, side: str) -> list[Shape]:
    """Return the shank, outside of the pad and as long as the finger, and the pad on its inner face."""
    body, sign = f"finger_{side}", finger_sign(side)
    width, thickness, length = (float(each) for each in hand.pad)
    top, tip = -hand.finger_length, length / 2.0
    pad = pose([0.0, sign * thickness * 0.2, 0.0])
    shank = pose([0.0, sign * thickness * 0.7, (top + tip) / 2.0])
    return [
        box(body, shank, (width, thickness * 0.6, tip - top), "metal", f"shank_{side}"),
        box(body, pad, (width * 0.96, thickness * 0.4, length * 0.98), "rubber", f"pad_{side}"),
    ]
