"""What a robot arm looks like, from nothing but the frames of its joints.

The rule: a foot and a column that stands on the floor, on it a turret that turns with the first joint; about every
further joint a housing along its axis, with a cover at both ends; and from housing to housing a limb, first along the
axis and then across it, as the frames lie. All radii follow from the reach.
"""

import numpy as np

from runtime.appearance.scene import SceneBody, SceneJoint, Shape
from runtime.appearance.solids import Z, cylinder, limb
from runtime.core.frames import Array
from runtime.core.linear import norm
from runtime.robot.model.spec import RobotSpec

THICKNESS = (1.25, 1.1, 0.85, 0.6, 0.52, 0.4)
"""Radii of the links, in parts of ``SLENDER`` times the reach."""
SLENDER = 0.078
SMALL = 0.03
"""An offset of less, in parts of the reach, is inside the housing."""


def link(index: int) -> str:
    """Return the name of the body that axis ``index`` (0-based) moves."""
    return f"link{index + 1}"


def reach_of(spec: RobotSpec) -> float:
    """Return about how far the arm reaches from its second axis, m."""
    ends = [_end(spec, index) for index in range(1, spec.n)]
    return max(sum(norm(end) for end in ends), 0.05)


def arm_bodies(spec: RobotSpec) -> list[SceneBody]:
    """Return ``base``, the links and ``flange``."""
    links = [
        SceneBody(
            name=link(index),
            parent=link(index - 1) if index else "base",
            X_parent_body=axis.placement,
            joint=SceneJoint(kind="revolute", axis=Z, source="axis", index=index),
        )
        for index, axis in enumerate(spec.axes)
    ]
    flange = SceneBody(name="flange", parent=link(spec.n - 1), X_parent_body=spec.X_last_flange)
    return [SceneBody(name="base", parent=None, X_parent_body=np.eye(4)), *links, flange]


def arm_shapes(spec: RobotSpec) -> list[Shape]:
    """Return the shapes of base and links."""
    scale = SLENDER * reach_of(spec)
    radii = [scale * THICKNESS[min(index, len(THICKNESS) - 1)] for index in range(spec.n + 1)]
    shapes = _column(spec, radii)
    for index in range(1, spec.n):
        shapes += _link(spec, index, radii)
    return shapes


def _end(spec: RobotSpec, index: int) -> Array:
    """Return where link ``index`` carries the next joint or the flange (3,) m, in its own frame."""
    after = spec.axes[index + 1].placement if index + 1 < spec.n else spec.X_last_flange
    return np.asarray(after[:3, 3])


def _column(spec: RobotSpec, radii: list[float]) -> list[Shape]:
    low, end = -float(spec.axes[0].placement[2, 3]), _end(spec, 0)
    top = float(np.maximum(end[2] - 0.55 * radii[1], low + 0.12))
    split = low + 0.62 * (top - low)
    r = radii[0]
    shapes = [
        cylinder("base", 0.0 * Z, 0.028 * Z, (1.7 * r, 1.62 * r), "cover", "foot"),
        cylinder("base", 0.02 * Z, (split - low) * Z, (1.3 * r, 1.08 * r), "cover", "column"),
        cylinder(link(0), split * Z, (split + 0.014) * Z, (r, r), "accent", "seam"),
        cylinder(link(0), (split + 0.014) * Z, (top + radii[1] / 2.0) * Z, (1.08 * r, r), "body", "turret"),
    ]
    if norm(end[:2]) > SMALL * reach_of(spec):
        shapes.append(limb(link(0), end[2] * Z, end, (0.95 * r, radii[1]), "body", "shoulder"))
    return shapes


def _link(spec: RobotSpec, index: int, radii: list[float]) -> list[Shape]:
    body, end, r, small = link(index), _end(spec, index), radii[index], SMALL * reach_of(spec)
    half = 1.08 * radii[0] if index == 1 else r * (1.0 if index < 3 else 0.8)
    shapes = [
        cylinder(body, -half * Z, half * Z, (r, r), "body" if index < 3 else "cover", "housing"),
        cylinder(body, -(half + 0.012) * Z, (half + 0.012) * Z, (0.76 * r, 0.76 * r), "cover", "cover"),
    ]
    knee, after = (end[2] if abs(end[2]) > small else 0.0) * Z, radii[index + 1]
    if norm(knee) > 0.0:
        shapes.append(limb(body, 0.0 * Z, knee, (0.9 * r, 1.02 * after), "body", "limb"))
    if norm(end[:2]) > small:
        shapes.append(limb(body, knee, end, (0.86 * r, 0.92 * after), "body", "limb"))
    return shapes
