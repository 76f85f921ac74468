"""Whether a suction cup seals on a part: its whole rim lies on one flat face.

The face is the one that looks towards the cup, of a box, an end of a cylinder or a flat face of a mesh; the side of a
cylinder is not flat, so that no cup seals on it. A real cup is soft: its lip bridges ``GAP`` and yields by ``PRESSED``
where it is pushed on.
"""

import numpy as np

from runtime.cell.cell import HandSpec, PartSpec
from runtime.cell.flat_faces import flat_faces
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
    centre = matmul(R_part_world, X_world_tool[:3, 3] - X_world_part[:3, 3])
    rim = centre[:, None] + matmul(R, _RIM * hand.pad[0])
    if part.mesh is None:
        return _on_solid(part, R[:, 2], rim)
    faces = flat_faces(part.mesh).towards(R[:, 2], ASKEW)
    return any(_on(matmul(face.normal, rim) - face.offset) and face.holds(centre, hand.pad[0]) for face in faces)


def _on(gaps: Array) -> bool:
    """Return whether points of the rim at such distances (8,) m from a plane seal on it; NaN seals on nothing."""
    return bool(gaps.max() <= GAP and gaps.min() >= -PRESSED)


def _on_solid(part: PartSpec, towards: Array, rim: Array) -> bool:
    """Return whether the rim (3, 8) m is on a face of a box or a cylinder; the cup looks ``towards`` (3,) it."""
    # of a box in any pose exactly one face looks to the cup, but for the edges, on which no cup seals anyway
    axis, is_round = int(np.argmax(np.abs(towards))), part.shape == "cylinder"
    if not abs(towards[axis]) >= np.cos(ASKEW) or (is_round and axis != 2):
        return False
    half = part.size / 2.0
    if not _on(-np.sign(towards[axis]) * rim[axis] - half[axis]):
        return False
    across = [k for k in range(3) if k != axis]
    inside = np.hypot(*rim[across]) <= half[0] if is_round else np.abs(rim[across]) <= half[across][:, None]
    return bool(inside.all())
