"""What a robot arm looks like, from nothing but the frames of its joints.

The rule: a foot and a column that stands on the floor, on it a turret that turns with the first joint; about every
further joint a housing along its axis, with a cover at both ends; from axis to axis a limb. Where a joint is long
(``skeleton``), its housing is a piece of the arm, in two parts that turn against one another. All radii follow from the
reach, so that a robot of any size has the proportions of a robot.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from runtime.appearance.own_meshes import OwnMeshes
from runtime.appearance.scene import SceneBody, SceneJoint, Shape
from runtime.appearance.skeleton import Axle, axles, is_upright, next_frame
from runtime.appearance.solids import Z, cylinder, limb, sphere
from runtime.core.frames import Array
from runtime.core.linear import matmul, norm
from runtime.robot.model.spec import RobotSpec

THICKNESS = (1.25, 1.1, 0.85, 0.62, 0.52, 0.4)
"""Radii of the links of six axes, in parts of ``SLENDER`` times the reach; other numbers of axes lie between."""
SLENDER = 0.078
SHORTEST = 0.05
"""The least reach that is drawn, m."""
COVER = 0.1
"""How far a cover stands out of its housing, in parts of the radius."""
LONG = 1.6
"""A joint longer than this, in radii, is a piece of the arm."""
RING = 0.16
"""Width of the ring between two links, in radii."""
INSIDE = 0.8
"""Radius of a limb that ends in a housing, in radii of the housing: it must not come out at the ends."""
MOTOR = 1.7
"""How far the motor of a joint stands out against its direction, in radii."""


def link(index: int) -> str:
    """Return the name of the body that axis ``index`` (0-based) moves; -1: the base."""
    return f"link{index + 1}" if index >= 0 else "base"


def reach_of(spec: RobotSpec) -> float:
    """Return about how far the arm reaches from its second axis, m."""
    ends = [next_frame(spec, index)[:3, 3] for index in range(1, spec.n)]
    return float(np.maximum(sum(norm(end) for end in ends), SHORTEST))


def arm_bodies(spec: RobotSpec) -> list[SceneBody]:
    """Return ``base``, the links and ``flange``."""
    links = [
        SceneBody(
            name=link(index),
            parent=link(index - 1),
            X_parent_body=axis.placement,
            joint=SceneJoint(kind=axis.kind.name, axis=Z, source="axis", index=index),
        )
        for index, axis in enumerate(spec.axes)
    ]
    flange = SceneBody(name="flange", parent=link(spec.n - 1), X_parent_body=spec.X_last_flange)
    return [SceneBody(name="base", parent=None, X_parent_body=np.eye(4)), *links, flange]


def arm_shapes(spec: RobotSpec, shown: Collection[int] = ()) -> list[Shape]:
    """Return the shapes of base and links, without the links ``shown`` by their meshes (0: the base)."""
    figure = _Figure.of(spec)
    shapes = _stand(figure)
    for index in range(spec.n):
        own = _quill(figure, index) if spec.axes[index].kind.slides else _own(figure, index)
        shapes += own + _across(figure, index) + _onwards(figure, index)
    hidden = {link(number - 1) for number in shown}
    return [shape for shape in shapes if shape.body not in hidden]


def mesh_shapes(own: OwnMeshes) -> list[Shape]:
    """Return the meshes of a robot as shapes of its links."""
    return [
        Shape(
            body=link(number - 1),
            kind="mesh",
            X_body_shape=np.eye(4),
            size=(),
            role="body" if number else "cover",
            name=name,
            mesh=name,
        )
        for number, name, _ in own.links
    ]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Figure:
    """A robot, its axles and the radius of each link, m (one more than axes: of the flange)."""

    spec: RobotSpec
    axles: list[Axle]
    radii: list[float]

    @classmethod
    def of(cls, spec: RobotSpec) -> "_Figure":
        reach = reach_of(spec)
        places = np.linspace(0.0, len(THICKNESS) - 1.0, spec.n)
        radii = SLENDER * reach * np.interp(places, np.arange(len(THICKNESS)), THICKNESS)
        found = [*radii.tolist(), float(radii[-1])]
        gaps = [found[max(k - 1, 0)] * 0.95 + found[k + 1] * 0.95 for k in range(spec.n)]
        return cls(spec=spec, axles=axles(spec, reach, gaps), radii=found)

    def is_long(self, index: int) -> bool:
        """Return whether the joint is a piece of the arm."""
        if index == 0:
            return is_upright(self.spec)
        return self.axles[index].length > LONG * self.radii[index]

    def far(self, index: int) -> Array:
        """Return where link ``index`` arrives at the next axis, or the flange (3,) m, in its own frame."""
        X = next_frame(self.spec, index)
        arrives = self.axles[index + 1].arrives if index + 1 < self.spec.n else 0.0
        return np.asarray(X[:3, 3] + arrives * X[:3, 2])


def _stand(figure: _Figure) -> list[Shape]:
    """Return foot and column, on the floor."""
    axle, r = figure.axles[0], figure.radii[0]
    X = figure.spec.axes[0].placement
    top = X[:3, 3] + axle.begins * X[:3, 2]
    low = X[:3, 3] + axle.arrives * X[:3, 2] if is_upright(figure.spec) else top * np.array([1.0, 1.0, 0.0])
    if not norm(top - low) > 0.0:
        return []
    up = (top - low) / norm(top - low)
    # the column begins inside of the foot: two faces in one plane would flicker
    thick = 0.28 * r
    return [
        cylinder("base", low, low + thick * up, (1.7 * r, 1.62 * r), "cover", "foot"),
        cylinder("base", low + 0.7 * thick * up, top, (1.3 * r, 1.08 * r), "cover", "column"),
    ]


def _own(figure: _Figure, index: int) -> list[Shape]:
    """Return what a link has along its own axis."""
    axle, r, body = figure.axles[index], figure.radii[index], link(index)
    last = index == figure.spec.n - 1
    if not figure.is_long(index):
        # a flange in the middle of the wrist: the hand comes out of the housing there
        near = axle.arrives * Z
        return _nose(figure, near, axle.leaves * Z) if last else _housing(figure, index)
    if index == 0:
        return _turret(figure)
    forward = float(np.sign(axle.leaves - axle.begins))
    ring = (axle.begins + forward * RING * r) * Z
    shapes = [cylinder(body, axle.begins * Z, ring, (0.97 * r, 0.97 * r), "cover", "ring")]
    if last:
        return [*shapes, *_nose(figure, ring, axle.leaves * Z)]
    if _leaves_sideways(figure, index):
        # a drum: the link hangs on it, so it ends beyond the link, and a cover closes it
        end = (axle.leaves + forward * 0.95 * r) * Z
        plate = end + forward * COVER * r * Z
        shapes.append(cylinder(body, ring, end, (r, r), "body", "drum"))
        shapes.append(cylinder(body, ring, plate, (0.76 * r, 0.76 * r), "cover", "lid"))
    else:
        shapes.append(limb(body, ring, axle.leaves * Z, (0.92 * r, INSIDE * figure.radii[index + 1]), "body", "arm"))
    return shapes


def _quill(figure: _Figure, index: int) -> list[Shape]:
    """Return the rod of an axis that slides, long enough to be held at both ends of its stroke, and what holds it."""
    axis, r = figure.spec.axes[index], figure.radii[index]
    rod, nut, held = 0.45 * r, 1.5 * r, figure.axles[index].arrives
    back, ahead = -(axis.limits.upper + 2.0 * nut) * Z, (nut - min(axis.limits.lower, 0.0)) * Z
    X = axis.placement
    low, high = (np.asarray(matmul(X, np.array([0.0, 0.0, at, 1.0]))[:3]) for at in (held - nut, held + nut))
    return [
        cylinder(link(index), back, ahead, (rod, rod), "metal", "quill"),
        cylinder(link(index - 1), low, high, (1.2 * r, 1.2 * r), "cover", "nut"),
    ]


def _nose(figure: _Figure, start: Array, end: Array) -> list[Shape]:
    """Return the end of the arm, which carries the flange: flat, so that a hand sits on it."""
    r, body = figure.radii[-1], link(figure.spec.n - 1)
    if not norm(end - start) > 0.3 * r:
        return []
    face = end - 0.25 * r * (end - start) / norm(end - start)
    return [
        cylinder(body, start, face, (0.92 * r, 0.9 * r), "body", "arm"),
        cylinder(body, face, end, (0.8 * r, 0.8 * r), "metal", "flange"),
    ]


def _turret(figure: _Figure) -> list[Shape]:
    """Return what turns on the column."""
    axle, r, body = figure.axles[0], figure.radii[0], link(0)
    ring = axle.begins + 0.1 * r * float(np.sign(axle.leaves - axle.begins))
    shapes = [
        cylinder(body, axle.begins * Z, ring * Z, (1.02 * r, 1.02 * r), "accent", "ring"),
        cylinder(body, ring * Z, axle.leaves * Z, (1.08 * r, r), "body", "turret"),
    ]
    # what goes on sideways at its top needs a rounded one; a housing there closes it by itself
    if figure.spec.n > 1 and figure.is_long(1):
        shapes.append(sphere(body, axle.leaves * Z, r, "body", "shoulder"))
    return shapes


def _housing(figure: _Figure, index: int) -> list[Shape]:
    """Return the housing of a short joint, with covers at both ends."""
    axle, r, body = figure.axles[index], figure.radii[index], link(index)
    # the housing on the turret is wider than it, or the turret would show through
    half = 1.08 * figure.radii[0] if index == 1 else r * (1.0 if index < 3 else 0.85)
    half += axle.length / 2.0
    low, high = (axle.middle - half) * Z, (axle.middle + half) * Z
    plate = COVER * r * Z
    return [
        cylinder(body, low, high, (r, r), "body" if index < 3 else "cover", "housing"),
        cylinder(body, low - plate, high + plate, (0.76 * r, 0.76 * r), "cover", "cover"),
    ]


def _leaves_sideways(figure: _Figure, index: int) -> bool:
    far = figure.far(index) - figure.axles[index].leaves * Z
    return norm(far) > figure.radii[index]


def _across(figure: _Figure, index: int) -> list[Shape]:
    """Return the limb from the own axis to the next one."""
    near, far = figure.axles[index].leaves * Z, figure.far(index)
    r, after = figure.radii[index], figure.radii[index + 1]
    if not norm(far - near) > 0.3 * after:
        return []
    radii = (0.95 * r, after) if index == 0 else (0.86 * r, 0.92 * after)
    return [limb(link(index), near, far, radii, "body", "limb")]


def _onwards(figure: _Figure, index: int) -> list[Shape]:
    """Return what a link has along the next axis, up to where the next link begins, and the motor of that joint."""
    if not (index + 1 < figure.spec.n and figure.is_long(index + 1)):
        return []
    X, axle, r = next_frame(figure.spec, index), figure.axles[index + 1], figure.radii[index + 1]
    near, far = (np.asarray(matmul(X, np.array([0.0, 0.0, at, 1.0]))[:3]) for at in (axle.arrives, axle.begins))
    forward = (far - near) / norm(far - near)
    body = link(index)
    # a ball where the link bends, and a flat end where the next link turns against it
    shapes = [
        sphere(body, near, 1.05 * r, "body", "arm"),
        cylinder(body, near, far, (1.05 * r, r), "body", "arm"),
    ]
    if norm(near - figure.axles[index].leaves * Z) > r:
        shapes.append(cylinder(body, near - MOTOR * r * forward, near, (0.6 * r, 0.6 * r), "cover", "motor"))
    return shapes
