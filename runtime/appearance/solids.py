"""Shapes by the points between which they reach, in the frame of their body, m."""

from collections.abc import Sequence

import numpy as np

from runtime.appearance.scene import Shape
from runtime.core.frames import Array, pose
from runtime.core.linear import norm
from runtime.robot.files.imported import rotation_z_to

X, Y, Z = np.eye(3)


def cylinder(body: str, start: Array, end: Array, radii: Sequence[float], role: str, name: str = "") -> Shape:
    """Return a cylinder from one point to another, with a radius at each."""
    reach = end - start
    return Shape(
        body=body,
        kind="cylinder",
        X_body_shape=pose((start + end) / 2.0, rotation_z_to(reach / norm(reach))),
        size=(radii[0], radii[1], norm(reach)),
        role=role,
        name=name,
    )


def limb(body: str, start: Array, end: Array, radii: Sequence[float], role: str, name: str = "") -> Shape:
    """Return a round-ended limb from one point to another, with a radius at each."""
    reach = end - start
    return Shape(
        body=body,
        kind="limb",
        X_body_shape=pose(start, rotation_z_to(reach / norm(reach))),
        size=(radii[0], radii[1], norm(reach)),
        role=role,
        name=name,
    )


def box(body: str, X: Array, size: Sequence[float] | Array, role: str, name: str = "") -> Shape:
    """Return a box of edge lengths ``size``, centred on a pose (4, 4)."""
    x, y, z = (float(each) for each in size)
    return Shape(body=body, kind="box", X_body_shape=X, size=(x, y, z), role=role, name=name)


def sphere(body: str, centre: Array, radius: float, role: str, name: str = "") -> Shape:
    """Return a sphere."""
    return Shape(body=body, kind="sphere", X_body_shape=pose(centre), size=(radius,), role=role, name=name)
