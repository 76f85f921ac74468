"""Where the parts of a hand are: two fingers that open along y of the tool, or a suction cup, and a palm.

Frames as in ``HandSpec``.
"""

import numpy as np

from runtime.cell.cell import HandSpec
from runtime.core.frames import Array, pose

FINGERS = ("left", "right")
PALM_THICKNESS = 0.02


def fingers_of(hand: HandSpec) -> tuple[str, ...]:
    """Return the names of the fingers of a hand: a suction cup has none."""
    return () if hand.is_cup else FINGERS


def is_holder(name: str) -> bool:
    """Return whether a shape of a hand is one that holds parts: a pad, or the cup."""
    return name == "cup" or name.startswith("pad_")


def finger_sign(side: str) -> float:
    """Return the direction along the tool's y axis in which a finger opens."""
    return 1.0 if side == "left" else -1.0


def palm_box(hand: HandSpec) -> tuple[Array, Array]:
    """Return the size (3,) m of the palm and its place X_tool_palm (4, 4): its face is a finger's length back."""
    width, thickness, _ = hand.pad
    size = np.array([2.0 * width, hand.stroke + 2.0 * thickness, PALM_THICKNESS])
    return size, pose([0.0, 0.0, -hand.finger_length - PALM_THICKNESS / 2.0])
