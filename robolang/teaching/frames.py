"""A frame from three points: its origin, one on its X axis, one on the positive Y side of its XY plane.

    x = P2 - P1,    z = x x (P3 - P1),    y = z x x        each of length 1

An error e of a touch turns the frame by about e over the distance, so points that are too near one another, or nearly
on one line, are refused.
"""

import numpy as np

from robolang.execution import lowering
from robolang.teaching.touches import Touch, check_bounds
from robolang.values.poses import Six
from runtime.core.faults import Fault
from runtime.core.frames import Array, pose
from runtime.core.linear import dot, norm
from runtime.core.rounding import beside
from runtime.core.units import MM

LEAST = 10.0
"""Least distance of the second point from the first, and of the third from the line through both, mm: touches that are
0.5 mm off then turn the frame by 3 deg."""


def frame_of(origin: Touch, on_x: Touch, on_xy: Touch) -> Six:
    """Return X_world_frame of three touches, mm and deg; ``Fault`` RBL309 out of bounds, RBL313 too near, or a line."""
    # before lengths are compared: of an infinite distance nothing below could tell
    check_bounds((origin, on_x, on_xy))
    along, across = on_x.position - origin.position, on_xy.position - origin.position
    length = norm(along)
    if not length >= LEAST * MM:
        raise _too_near(length, f"point {on_x.name} is", f"from point {origin.name}", "further away on the X axis")
    x = along / length
    # first the part at right angles, then its length: the cross product of nearly parallel vectors would lose digits
    beside_line = across - dot(across, x) * x
    height = norm(beside_line)
    if not height >= LEAST * MM:
        line = f"from the line through points {origin.name} and {on_x.name}"
        raise _too_near(height, f"point {on_xy.name} is", line, "further away from that line, on the side of +Y")
    y = beside_line / height
    return lowering.six_of(pose(origin.position, _columns(x, y)))


def _columns(x: Array, y: Array) -> Array:
    return np.stack([x, y, np.cross(x, y)], axis=-1)


def _too_near(distance: float, what: str, where: str, hint: str) -> Fault:
    there, least = beside(distance / MM, LEAST, form=".3g")
    return Fault("RBL313", f"{what} {there} mm {where}; at least {least} mm are needed", f"teach it {hint}")
