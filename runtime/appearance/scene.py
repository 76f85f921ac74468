"""What a picture of a run shows: bodies with joints, and shapes on them. The page of a run and MuJoCo draw the same.

A scene holds no motion. A body stands at ``X_parent_body`` and, beyond it, where its joint is: axis ``index`` of the
robot, a finger, or a part, whose pose in the world replaces its own. Every length is m.

The JSON form (docs/viewing.md) is part of every log; ``Scene.from_json`` trusts nothing in it.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal, cast, get_args

import numpy as np

from runtime.appearance.untrusted import Untrusted
from runtime.core.frames import Array, frozen
from runtime.core.linear import norm
from runtime.core.mesh import Mesh

JointKind = Literal["revolute", "prismatic"]
Source = Literal["axis", "finger", "part"]
ShapeKind = Literal["box", "cylinder", "limb", "sphere", "mesh"]

SIZES: dict[str, int] = {"box": 3, "cylinder": 3, "limb": 3, "sphere": 1, "mesh": 0}
"""How many numbers the size of each kind of shape has."""
ROLES = ("body", "cover", "accent", "metal", "rubber", "palm", "table", "leg", "part", "edge", "floor", "obstacle")
"""What a shape is, by which it gets its colour."""
DIGITS = 9
"""Digits of the JSON after the point: a nanometre, so that a chain of ten bodies is exact to far below 0.01 mm."""
MESH_DIGITS = 5
"""Digits of the vertices of meshes, which only have to look right: a hundredth of a millimetre."""
MOST_BODIES, MOST_SHAPES, MOST_MARKS, MOST_MESHES = 50_000, 250_000, 50_000, 300
"""Most bodies, shapes, frames or points, and meshes of a scene: more than the largest cell and points file have."""
SMALLEST = 10.0**-DIGITS
"""Least size of a shape, and least reach, m: what is smaller is nothing in the JSON."""
MOST_VERTICES, MOST_FACES = 300_000, 300_000
"""Most vertices and faces of all meshes of a scene together."""

_COLOUR = re.compile(r"#[0-9a-f]{6}")


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneJoint:
    """What moves a body: about or along ``axis`` (3,) of its own frame, by the value ``index`` of a ``source``.

    The values of axes are joint angles rad (or m), those of fingers the distance of a pad from the tool point, m. A
    part has poses, and its axis means nothing.
    """

    kind: JointKind
    axis: Array
    source: Source
    index: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneBody:
    """A body of a scene: ``parent`` (None: the world) and ``X_parent_body`` (4, 4) with its joint at zero."""

    name: str
    parent: str | None
    X_parent_body: Array
    joint: SceneJoint | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Shape:
    """A shape of a body at ``X_body_shape`` (4, 4), in the colour of a role.

    ``size`` m: box, edge lengths x y z; cylinder, radius at -z, radius at +z, length, centred on its origin; limb,
    radius at its start, radius at its end, length, round at both ends, from its origin along z; sphere, radius.
    ``mesh`` is the name of a mesh, of that kind only.
    """

    body: str
    kind: ShapeKind
    X_body_shape: Array
    size: tuple[float, ...]
    role: str
    name: str = ""
    mesh: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark:
    """A frame or a point with its name, at X_world_mark (4, 4)."""

    name: str
    X_world_mark: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """A camera at ``position`` (3,) m that looks to ``target`` (3,) m."""

    position: Array
    target: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """Bodies (parents first), their shapes, colours by role (``#rrggbb``), meshes by name, frames and points.

    ``reach`` m is how far the robot comes from its base: light and floor are as large. ``camera`` is the view that the
    cell gives; None: all of it is to be seen.
    """

    robot: str
    reach: float
    bodies: tuple[SceneBody, ...]
    shapes: tuple[Shape, ...]
    colours: Mapping[str, str]
    meshes: Mapping[str, Mesh] = field(default_factory=lambda: MappingProxyType({}))
    frames: tuple[Mark, ...] = ()
    points: tuple[Mark, ...] = ()
    camera: View | None = None

    def as_json(self) -> dict[str, Any]:
        """Return the scene as JSON values: the same scene gives the same text."""
        return {
            "robot": self.robot,
            "reach": _rounded(self.reach),
            "bodies": [
                {
                    "name": body.name,
                    "parent": body.parent,
                    "X": _rows(body.X_parent_body),
                    "joint": None if body.joint is None else _joint_json(body.joint),
                }
                for body in self.bodies
            ],
            "shapes": [
                {
                    "body": shape.body,
                    "kind": shape.kind,
                    "X": _rows(shape.X_body_shape),
                    "size": [_rounded(each) for each in shape.size],
                    "colour": shape.role,
                    "name": shape.name,
                    "mesh": shape.mesh,
                }
                for shape in self.shapes
            ],
            "colours": dict(self.colours),
            "meshes": {
                name: {"vertices": np.round(mesh.vertices, MESH_DIGITS).tolist(), "faces": mesh.faces.tolist()}
                for name, mesh in self.meshes.items()
            },
            "frames": _marks_json(self.frames),
            "points": _marks_json(self.points),
            "camera": None if self.camera is None else _view_json(self.camera),
        }

    @classmethod
    def from_json(cls, value: Any) -> "Scene":
        """Return the scene of JSON values that are not trusted; ``Fault`` RBL833 where they are none."""
        scene = Untrusted(value, "scene")
        bodies = _bodies(scene["bodies"])
        meshes = _meshes(scene["meshes"])
        return cls(
            robot=scene["robot"].text(),
            reach=_length(scene["reach"]),
            bodies=bodies,
            shapes=_shapes(scene["shapes"], {body.name for body in bodies}, meshes),
            colours=_colours(scene["colours"]),
            meshes=meshes,
            frames=_marks(scene["frames"]),
            points=_marks(scene["points"]),
            camera=_view(scene["camera"]),
        )


def _rounded(value: float) -> float:
    return round(float(value), DIGITS) + 0.0  # no -0.0: equal scenes are equal texts


def _rows(values: Array) -> Any:
    return (np.round(values, DIGITS) + 0.0).tolist()


def _joint_json(joint: SceneJoint) -> dict[str, Any]:
    return {"kind": joint.kind, "axis": _rows(joint.axis), "source": joint.source, "index": joint.index}


def _marks_json(marks: Iterable[Mark]) -> list[dict[str, Any]]:
    return [{"name": mark.name, "X": _rows(mark.X_world_mark)} for mark in marks]


def _view_json(view: View) -> dict[str, Any]:
    return {"position": _rows(view.position), "target": _rows(view.target)}


def _view(value: Untrusted) -> View | None:
    if value.value is None:
        return None
    view = View(position=value["position"].array((3,)), target=value["target"].array((3,)))
    if not norm(view.target - view.position) > 0.0:
        value.fail("looks nowhere: its two places are one")
    return view


def _bodies(value: Untrusted) -> tuple[SceneBody, ...]:
    """Return bodies, each after its parent and of a name of its own."""
    found: dict[str, SceneBody] = {}
    for each in value.items(MOST_BODIES):
        name, parent, joint = each["name"].text(), each["parent"], each["joint"]
        if name in found:
            each.fail(f"has the name of another: {name!r}")
        # parents first: a ring of bodies would be drawn for ever
        above = None if parent.value is None else parent.text(tuple(found) or ("(no body before it)",))
        found[name] = SceneBody(
            name=name,
            parent=above,
            X_parent_body=each["X"].pose(),
            joint=None if joint.value is None else _joint(joint),
        )
    return tuple(found.values())


def _joint(value: Untrusted) -> SceneJoint:
    axis = value["axis"].array((3,), most=1.0 + 1e-6)
    if not abs(norm(axis) - 1.0) <= 1e-6:
        value["axis"].fail("is not a unit vector")
    return SceneJoint(
        kind=cast(JointKind, value["kind"].text(get_args(JointKind))),
        axis=axis,
        source=cast(Source, value["source"].text(get_args(Source))),
        index=value["index"].whole(MOST_BODIES),
    )


def _shapes(value: Untrusted, bodies: set[str], meshes: Mapping[str, Mesh]) -> tuple[Shape, ...]:
    found = []
    for each in value.items(MOST_SHAPES):
        body, kind, mesh = each["body"].text(), each["kind"].text(get_args(ShapeKind)), each["mesh"].value
        if body not in bodies:
            each["body"].fail("is not the name of a body")
        if (kind == "mesh") != (isinstance(mesh, str) and mesh in meshes):
            each["mesh"].fail("is not the name of a mesh, or its shape is none")
        size = each["size"].array((SIZES[kind],))
        if not (size >= SMALLEST).all():
            each["size"].fail("is not positive")
        found.append(
            Shape(
                body=body,
                kind=cast(ShapeKind, kind),
                X_body_shape=each["X"].pose(),
                size=tuple(size.tolist()),
                role=each["colour"].text(ROLES),
                name=each["name"].text(),
                mesh=mesh,
            )
        )
    return tuple(found)


def _colours(value: Untrusted) -> Mapping[str, str]:
    found = {}
    for role, each in value.pairs(len(ROLES)):
        # as strict as this: a page puts it into styles
        if role not in ROLES or not _COLOUR.fullmatch(each.text()):
            each.fail("is not a colour #rrggbb of a role")
        found[role] = each.text()
    if missing := [role for role in ROLES if role not in found]:
        value.fail(f"has no colour for: {', '.join(missing)}")
    return MappingProxyType(found)


def _meshes(value: Untrusted) -> Mapping[str, Mesh]:
    found: dict[str, Mesh] = {}
    vertices = faces = 0
    for name, each in value.pairs(MOST_MESHES):
        points, corners = each["vertices"].array((-1, 3)), each["faces"].array((-1, 3), most=MOST_VERTICES)
        vertices, faces = vertices + len(points), faces + len(corners)
        if not (vertices <= MOST_VERTICES and faces <= MOST_FACES):
            each.fail(f"is beyond {MOST_VERTICES} vertices or {MOST_FACES} faces of all meshes")
        indices = corners.astype(np.int32)
        if not ((indices == corners) & (indices >= 0) & (indices < len(points))).all():
            each["faces"].fail("is not made of indices of its vertices")
        found[name] = Mesh(vertices=points, faces=indices)
    return MappingProxyType(found)


def _marks(value: Untrusted) -> tuple[Mark, ...]:
    return tuple(Mark(name=each["name"].text(), X_world_mark=each["X"].pose()) for each in value.items(MOST_MARKS))


def _length(value: Untrusted) -> float:
    number = value.value
    if type(number) not in (int, float) or not SMALLEST <= number <= 1e4:
        value.fail("is not a positive length, m")
    return float(frozen([number])[0])
