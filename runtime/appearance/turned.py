"""Cylinders with rounded rims and round-ended limbs as triangles: for a renderer that has neither."""

import math

import numpy as np

from runtime.appearance.scene import Shape
from runtime.core.frames import Array, frozen
from runtime.core.mesh import Mesh

AROUND = 36
"""Corners of a circle."""
BEVEL = 0.006
"""Radius of a rim, m; less where there is no room for it."""
ARC = 4
"""Steps of the quarter of a circle in a rim."""
CAP = 8
"""Steps of the quarter of a circle in the end of a limb."""


def turned(shape: Shape) -> Mesh:
    """Return a cylinder or a limb as triangles, in the frame of the shape."""
    first, last, length = shape.size
    profile = _rims(first, last, length) if shape.kind == "cylinder" else _caps(first, last, length)
    return _lathe(profile)


def _rims(low: float, high: float, length: float) -> Array:
    """Return radius and z (k, 2) m of half the outline of a cylinder, from below to above."""
    # a rim without a radius has no light on it, and the body looks like a drawing
    b = float(np.min([BEVEL, 0.3 * low, 0.3 * high, 0.3 * length]))
    z = length / 2.0
    arc = np.linspace(0.0, math.pi / 2.0, ARC)
    below = np.stack([low - b + b * np.sin(arc), -z + b - b * np.cos(arc)], axis=1)
    above = np.stack([high - b + b * np.cos(arc), z - b + b * np.sin(arc)], axis=1)
    return np.concatenate([[[0.0, -z]], below, above, [[0.0, z]]])


def _caps(start: float, end: float, length: float) -> Array:
    """Return radius and z (k, 2) m of half the outline of two spheres and the cone that touches both."""
    slope = float(np.clip((start - end) / length, -1.0, 1.0))
    # where the cone leaves the spheres: its side is a tangent of both, so it leaves them at one latitude
    leave = math.asin(slope)
    first = np.linspace(-math.pi / 2.0, leave, CAP)
    last = np.linspace(leave, math.pi / 2.0, CAP)
    below = np.stack([start * np.cos(first), start * np.sin(first)], axis=1)
    above = np.stack([end * np.cos(last), length + end * np.sin(last)], axis=1)
    return np.concatenate([below, above])


def _lathe(profile: Array) -> Mesh:
    """Return the body that an outline (k, 2) sweeps about z; its first and last point are on the axis."""
    angles = np.linspace(0.0, 2.0 * math.pi, AROUND, endpoint=False)
    rings = profile[1:-1]
    x, y = rings[:, :1] * np.cos(angles), rings[:, :1] * np.sin(angles)
    side = np.stack([x, y, np.broadcast_to(rings[:, 1:], x.shape)], axis=-1).reshape(-1, 3)
    poles = np.array([[0.0, 0.0, profile[0, 1]], [0.0, 0.0, profile[-1, 1]]])
    here = np.arange(AROUND)
    following = (here + 1) % AROUND
    faces = []
    for ring in range(len(rings) - 1):
        low, high = ring * AROUND, (ring + 1) * AROUND
        faces.append(np.stack([low + here, low + following, high + following], axis=1))
        faces.append(np.stack([low + here, high + following, high + here], axis=1))
    bottom, top, last = len(side), len(side) + 1, (len(rings) - 1) * AROUND
    faces.append(np.stack([np.full(AROUND, bottom), following, here], axis=1))
    faces.append(np.stack([np.full(AROUND, top), last + here, last + following], axis=1))
    return Mesh(vertices=frozen(np.concatenate([side, poles])), faces=np.concatenate(faces).astype(np.int32))
