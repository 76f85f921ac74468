"""Whether a suction cup seals on a part: its whole rim lies on one flat face.

The face is the one that looks towards the cup, of a box, or an end of a cylinder; the side of a cylinder is not flat,
so that no cup seals on it. A real cup is soft: its lip bridges ``GAP`` and yields by ``PRESSED`` where it is pushed
on.
"""

import numpy as np

from runtime.cell.cell import HandSpec, PartSpec
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.units import DEG

GAP = 1e-3
"""Largest distance of the rim from the face, m."""
PRESSED = 2e-3
"""How far the rim may be in the face, m."""
ASKEW = 5.0 * DEG
"""Largest angle between the axis of the cup and the normal of the face, rad."""

# a flat face is convex: where these are on it, the polygon between them is, and the circle but for 8 % of its radius
_ANGLES = np.arange(8) * (np.pi / 4.0)
_RIM = np.stack([np.cos(_ANGLES), np.sin(_ANGLES), np.zeros(8)])


def seals(hand: HandSpec, X_world_tool: Array, part: PartSpec, X_world_part: Array) -> bool:
    """Return whether the whole rim of the cup lies on a flat face of a part; poses (4, 4)."""
    R_part_world = X_world_part[:3, :3].T
    R = matmul(R_part_world, X_world_tool[:3, :3])
    towards = R[:, 2]
    # of a box in any pose exactly one face looks to the cup, but for the edges, on which no cup seals anyway
    axis = int(np.argmax(np.abs(towards)))
    if not abs(towards[axis]) >= np.cos(ASKEW) or (part.shape == "cylinder" and axis != 2):
        return False
    centre = matmul(R_part_world, X_world_tool[:3, 3] - X_world_part[:3, 3])
    rim = centre[:, None] + matmul(R, _RIM * hand.pad[0])
    half = part.size / 2.0
    gaps = -np.sign(towards[axis]) * rim[axis] - half[axis]
    # so written, a pose with NaN seals on nothing
    if not (gaps.max() <= GAP and gaps.min() >= -PRESSED):
        return False
    across = [k for k in range(3) if k != axis]
    if part.shape == "cylinder":
        return bool((np.hypot(*rim[across]) <= half[0]).all())
    return bool((np.abs(rim[across]) <= half[across][:, None]).all())
