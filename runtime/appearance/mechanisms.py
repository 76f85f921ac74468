"""What the machines of pulse tables look like: a gantry, a turning column with a sliding arm, a SCARA.

The bodies of the joints are named as the joints; their order in the scene is that of the machine, their index that of
``Mechanism.joints``. ``tool`` is the tool point. A coordinate without a joint is where the mechanism has it, or zero.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from runtime.appearance.cell_scene import NO_POINTS, marks
from runtime.appearance.colours import colours_of
from runtime.appearance.scene import Scene, SceneBody, SceneJoint, Shape
from runtime.appearance.solids import X, Y, Z, box, cylinder, limb
from runtime.appearance.untrusted import LONGEST_TEXT
from runtime.core.frames import Array, pose
from runtime.pulses.machine import Joint
from runtime.pulses.mechanism import Kind

SLENDER = 0.05
"""Thickness of a beam in parts of the size of the machine."""
LIFTED = 0.6
"""A SCARA whose z is longer than this, in parts of its arms, lifts them along its column; else it has a quill."""


class Machine(Protocol):
    """What is known of a machine whose scene is made: a ``Mechanism``, or what its tables say of it."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def kind(self) -> Kind:
        """Which machine it is."""

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Its joints, with their ranges."""

    @property
    def lengths(self) -> tuple[float, float]:
        """l1 and l2 of a SCARA, m."""

    @property
    def fixed(self) -> tuple[tuple[str, float], ...]:
        """The coordinates that have no joint, m."""


def machine_scene(machine: Machine, points: Mapping[str, Array] = NO_POINTS) -> Scene:
    """Return what a machine looks like; ``points`` are taught points by name, X_world_point (4, 4)."""
    frame = {"cartesian": _gantry, "cylindrical": _column, "scara": _scara}[machine.kind](_Plan(machine=machine))
    return Scene(
        robot=machine.name[:LONGEST_TEXT],
        reach=_Plan(machine=machine).size,
        bodies=tuple(frame.bodies),
        shapes=tuple(frame.shapes),
        colours=colours_of(machine.name),
        points=marks(points),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Frame:
    """The bodies and shapes of a machine."""

    bodies: list[SceneBody]
    shapes: list[Shape]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Plan:
    """A machine with its lengths, m, and its joints by name."""

    machine: Machine

    @property
    def size(self) -> float:
        """The largest length of the machine."""
        joints = {joint.name: joint for joint in self.machine.joints if not joint.rotary}
        spans = [max(abs(joint.lower), abs(joint.upper), joint.upper - joint.lower) for joint in joints.values()]
        return float(np.max([*spans, sum(self.machine.lengths), 0.1]))

    @property
    def thick(self) -> float:
        """Half the thickness of a beam."""
        return SLENDER * self.size / 2.0

    def range(self, name: str) -> tuple[float, float]:
        """Return the lowest and highest value of a coordinate, which need not have a joint."""
        joint = self.joint(name)
        at = dict(self.machine.fixed).get(name, 0.0)
        return (at, at) if joint is None else (joint.lower, joint.upper)

    def joint(self, name: str) -> Joint | None:
        """Return a joint; None for a coordinate without one."""
        return next((joint for joint in self.machine.joints if joint.name == name), None)

    def body(self, name: str, parent: str | None, place: Array, axis: Array) -> SceneBody:
        """Return the body of a joint. Without one it stands at its fixed place along ``axis``, or at angle zero."""
        joint = self.joint(name)
        if joint is None:
            return SceneBody(name=name, parent=parent, X_parent_body=pose(place + self.range(name)[0] * axis))
        return SceneBody(
            name=name,
            parent=parent,
            X_parent_body=pose(place),
            joint=SceneJoint(
                kind="revolute" if joint.rotary else "prismatic",
                axis=axis,
                source="axis",
                index=self.machine.joints.index(joint),
            ),
        )


def _base() -> SceneBody:
    return SceneBody(name="base", parent=None, X_parent_body=np.eye(4))


def _tool(parent: str) -> SceneBody:
    return SceneBody(name="tool", parent=parent, X_parent_body=np.eye(4))


def _tip(body: str, plan: _Plan, height: float) -> list[Shape]:
    """Return a pointed tool that ends at the origin of its body, and a shank up to ``height``."""
    r, tip = 0.5 * plan.thick, min(2.0 * plan.thick, 0.5 * height)
    return [
        cylinder(body, 0.0 * Z, tip * Z, (0.1 * r, r), "metal", "tip"),
        cylinder(body, tip * Z, height * Z, (r, r), "cover", "shank"),
    ]


def _gantry(plan: _Plan) -> _Frame:
    """Two rails along x on legs, a bridge across them, on it a carriage with a quill: the tool hangs from it."""
    (x0, x1), (y0, y1), (z0, z1) = (plan.range(name) for name in "xyz")
    t = plan.thick
    # the carriage is wider than the tool: rails stand off the range by as much
    edge = 4.0 * t
    # high enough that the quill is above the work in its lowest place, and its carriage above the rails
    high = np.maximum(z1, 0.0) + 0.35 * plan.size
    quill = high - z0
    rails = [y0 - edge, y1 + edge]
    middle, length = (x0 + x1) / 2.0, x1 - x0 + 2.0 * edge
    shapes: list[Shape] = []
    for y in rails:
        shapes.append(box("base", pose([middle, y, high - 2.0 * t]), (length, 2.0 * t, 2.0 * t), "cover", "rail"))
        legs = [pose([x, y, (high - 3.0 * t) / 2.0]) for x in (x0 - edge + t, x1 + edge - t)]
        shapes += [box("base", X_leg, (2.0 * t, 2.0 * t, high - 3.0 * t), "leg", "leg") for X_leg in legs]
    for x in (x0 - edge + t, x1 + edge - t):
        beam = pose([x, (y0 + y1) / 2.0, high - 2.0 * t])
        shapes.append(box("base", beam, (2.0 * t, y1 - y0 + 2.0 * edge, 2.0 * t), "cover", "beam"))
    span = rails[1] - rails[0]
    shapes.append(box("x", pose([0.0, sum(rails) / 2.0, high + t]), (3.0 * t, span, 3.0 * t), "body", "bridge"))
    shapes += [box("x", pose([0.0, y, high - t / 2.0]), (5.0 * t, 3.0 * t, 2.0 * t), "accent", "slide") for y in rails]
    # carriage and quill before the bridge, so that the quill passes it; its foot brings the tool back under it
    shapes.append(box("y", pose([2.4 * t, 0.0, high + t]), (2.4 * t, 4.4 * t, 5.0 * t), "cover", "carriage"))
    shapes.append(box("z", pose([4.4 * t, 0.0, quill / 2.0 + 2.0 * t]), (2.0 * t, 2.6 * t, quill), "body", "quill"))
    shapes.append(box("z", pose([2.2 * t, 0.0, 2.5 * t]), (6.4 * t, 2.6 * t, 1.4 * t), "body", "foot"))
    shapes += _tip("z", plan, 2.0 * t)
    zero = np.zeros(3)
    bodies = [_base(), plan.body("x", "base", zero, X), plan.body("y", "x", zero, Y), plan.body("z", "y", zero, Z)]
    return _Frame(bodies=[*bodies, _tool("z")], shapes=shapes)


def _column(plan: _Plan) -> _Frame:
    """Two pillars on a table that turns, on them a sleeve that is lifted, and between them an arm that slides."""
    inner, reach = plan.range("r")
    t, hang = plan.thick, 4.0 * plan.thick
    top, stroke = plan.range("z")[1] + hang + 4.0 * t, reach - inner
    shapes = [
        cylinder("base", 0.0 * Z, 2.0 * t * Z, (5.6 * t, 5.0 * t), "cover", "foot"),
        cylinder("theta", 2.0 * t * Z, 2.4 * t * Z, (4.6 * t, 4.6 * t), "accent", "ring"),
        cylinder("theta", 2.4 * t * Z, 3.4 * t * Z, (4.8 * t, 4.6 * t), "body", "turntable"),
        *(_pillar(side * 2.6 * t, 3.2 * t, top, 1.1 * t) for side in (-1.0, 1.0)),
        box("theta", pose([0.0, 0.0, top + 0.6 * t]), (3.0 * t, 8.4 * t, 1.4 * t), "cover", "cap"),
        box("z", pose([0.0, 0.0, hang]), (5.0 * t, 8.6 * t, 4.2 * t), "cover", "sleeve"),
        # as long as its stroke: pulled in, it stands out at the other side
        box("r", pose([-(stroke + 3.0 * t) / 2.0, 0.0, hang]), (stroke + 5.0 * t, 1.8 * t, 1.8 * t), "body", "arm"),
        *_tip("r", plan, hang),
    ]
    zero = np.zeros(3)
    bodies = [
        _base(),
        plan.body("theta", "base", zero, Z),
        plan.body("z", "theta", zero, Z),
        plan.body("r", "z", zero, X),
        _tool("r"),
    ]
    return _Frame(bodies=bodies, shapes=shapes)


def _pillar(y: float, low: float, high: float, r: float) -> Shape:
    return cylinder("theta", np.array([0.0, y, low]), np.array([0.0, y, high]), (r, r), "body", "pillar")


def _scara(plan: _Plan) -> _Frame:
    """Two arms that turn about vertical axes; z lifts both along a column, or a quill at their end."""
    first, second = plan.machine.lengths
    z0, z1 = plan.range("z")
    lifts = z1 - z0 > LIFTED * (first + second)
    r = 0.11 * (first + second)
    # the tool hangs this far below the second arm, and the quill sinks by its stroke
    hang = 1.2 * r
    arms = hang if lifts else hang + z1
    shapes = [
        limb("theta1", np.array([0.0, 0.0, arms]), np.array([first, 0.0, arms]), (1.1 * r, 0.9 * r), "body", "arm"),
        _post("theta1", (0.0, arms - 1.3 * r), (0.0, arms + 1.2 * r), (1.2 * r, 1.1 * r), "cover"),
        _post("theta1", (first, arms - 0.9 * r), (first, arms + 0.95 * r), (0.8 * r, 0.8 * r), "cover"),
    ]
    # the second arm above the first one, so that it turns over it
    above = arms + 1.75 * r
    shapes += [
        limb("theta2", above * Z, np.array([second, 0.0, above]), (0.9 * r, 0.75 * r), "body", "arm"),
        _post("theta2", (0.0, above - 0.8 * r), (0.0, above + 1.0 * r), (0.8 * r, 0.7 * r), "cover"),
        _post("theta2", (second, above - 0.9 * r), (second, above + 1.3 * r), (0.55 * r, 0.5 * r), "cover"),
    ]
    last = "theta4" if plan.joint("theta4") else ("theta2" if lifts else "z")
    if lifts:
        shapes += _lift(plan, r, hang)
        shapes.append(_quill(last, plan, above))
    else:
        shapes += _pedestal(arms - 1.3 * r, r)
        shapes.append(_quill(last, plan, above + 1.6 * r - z0))
    return _Frame(bodies=_scara_bodies(plan, lifts), shapes=[*shapes, *_tip(last, plan, 1.2 * plan.thick)])


def _scara_bodies(plan: _Plan, lifts: bool) -> list[SceneBody]:
    first, second = plan.machine.lengths
    zero, elbow, wrist = np.zeros(3), first * X, second * X
    # the two orders place the tool alike: all axes are vertical
    if lifts:
        bodies = [plan.body("z", "base", zero, Z), plan.body("theta1", "z", zero, Z)]
        bodies += [plan.body("theta2", "theta1", elbow, Z), plan.body("theta4", "theta2", wrist, Z)]
    else:
        bodies = [plan.body("theta1", "base", zero, Z), plan.body("theta2", "theta1", elbow, Z)]
        bodies += [plan.body("z", "theta2", wrist, Z), plan.body("theta4", "z", zero, Z)]
    return [_base(), *bodies, _tool("theta4")]


def _lift(plan: _Plan, r: float, hang: float) -> list[Shape]:
    """Return a column beside the first axis, and the carriage on it that bears the arms."""
    z1 = plan.range("z")[1]
    back = -2.6 * r
    top = z1 + hang + 3.0 * r
    return [
        box("base", pose([back, 0.0, 0.2 * r]), (4.4 * r, 4.4 * r, 0.4 * r), "cover", "foot"),
        box("base", pose([back, 0.0, top / 2.0]), (1.8 * r, 2.2 * r, top), "leg", "column"),
        box("base", pose([back, 0.0, top + 0.15 * r]), (2.2 * r, 2.6 * r, 0.3 * r), "cover", "cap"),
        box("z", pose([back, 0.0, hang]), (2.6 * r, 3.0 * r, 2.8 * r), "accent", "carriage"),
        box("z", pose([back / 2.0, 0.0, hang - 1.55 * r]), (-back + 2.2 * r, 2.2 * r, 0.6 * r), "cover", "bracket"),
    ]


def _pedestal(top: float, r: float) -> list[Shape]:
    """Return the column of a SCARA whose arms stay at their height."""
    return [
        cylinder("base", 0.0 * Z, 0.3 * r * Z, (2.2 * r, 2.1 * r), "cover", "foot"),
        cylinder("base", 0.2 * r * Z, top * Z, (1.5 * r, 1.25 * r), "cover", "column"),
    ]


def _quill(body: str, plan: _Plan, height: float) -> Shape:
    r = 0.45 * plan.thick
    return cylinder(body, plan.thick * Z, height * Z, (r, r), "metal", "quill")


def _post(
    body: str, low: tuple[float, float], high: tuple[float, float], radii: tuple[float, float], role: str
) -> Shape:
    """Return an upright cylinder between two points (x, z) of the plane of the arm."""
    return cylinder(body, np.array([low[0], 0.0, low[1]]), np.array([high[0], 0.0, high[1]]), radii, role, "post")
