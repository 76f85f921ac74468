"""The scene of a log as entities that viewers draw, ``foxglove.SceneUpdate``; they move with their bodies."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from robolang.logs.foxglove import message, plain
from robolang.logs.transforms import WORLD, quaternion, stamp
from runtime.appearance.scene import Scene, Shape
from runtime.core.frames import Array

_LETTERS_M = 0.03
"""Height of the names of points and frames."""


def scene_update(scene: Scene) -> bytes:
    """Return one message with an entity for each body that has a shape, and one with the names of points and frames."""
    found = message("SceneUpdate")()
    for body in scene.bodies:
        shapes = [shape for shape in scene.shapes if shape.body == body.name]
        if shapes:
            entity = _entity(found, body.name, body.name)
            for shape in shapes:
                _add(entity, shape, scene)
    marks = [*scene.points, *scene.frames]
    if marks:
        entity = _entity(found, WORLD, "points and frames")
        for mark in marks:
            text = entity.texts.add(text=plain(mark.name), billboard=True, font_size=_LETTERS_M)
            _pose(text.pose, mark.X_world_mark)
            _colour(text.color, "#202020")
    return bytes(found.SerializeToString(deterministic=True))


def _entity(found: Any, frame: str, name: str) -> Any:
    # no lifetime: it stays until the end
    entity = found.entities.add(frame_id=plain(frame), id=plain(name), frame_locked=True)
    stamp(entity.timestamp, 0)
    return entity


def _add(entity: Any, shape: Shape, scene: Scene) -> None:
    """Add the primitives that draw a shape."""
    for primitive, X in _primitives(entity, shape, scene):
        _pose(primitive.pose, X)
        _colour(primitive.color, scene.colours[shape.role])


def _primitives(entity: Any, shape: Shape, scene: Scene) -> Iterator[tuple[Any, Array]]:
    X, size = shape.X_body_shape, shape.size
    match shape.kind:
        case "box":
            yield _sized(entity.cubes.add(), *size), X
        case "sphere":
            yield _ball(entity, size[0]), X
        case "cylinder":
            yield _cylinder(entity, *size), X
        case "limb":
            start, end, length = size
            yield _ball(entity, start), X
            yield _ball(entity, end), _along(X, length)
            yield _cylinder(entity, *size), _along(X, length / 2.0)
        case "mesh":
            yield _triangles(entity, scene, shape.mesh or ""), X


def _sized(primitive: Any, x: float, y: float, z: float) -> Any:
    primitive.size.x, primitive.size.y, primitive.size.z = x, y, z
    return primitive


def _ball(entity: Any, radius: float) -> Any:
    return _sized(entity.spheres.add(), 2.0 * radius, 2.0 * radius, 2.0 * radius)


def _cylinder(entity: Any, bottom: float, top: float, length: float) -> Any:
    """Add a cylinder whose radius changes along it; the scales are parts of its width."""
    widest = max(bottom, top) or 1.0  # a point, in a log that is not trusted
    primitive = entity.cylinders.add(bottom_scale=bottom / widest, top_scale=top / widest)
    return _sized(primitive, 2.0 * widest, 2.0 * widest, length)


def _triangles(entity: Any, scene: Scene, name: str) -> Any:
    mesh = scene.meshes[name]
    primitive = entity.triangles.add(indices=mesh.faces.reshape(-1).tolist())
    for x, y, z in mesh.vertices.tolist():
        primitive.points.add(x=x, y=y, z=z)
    return primitive


def _along(X: Array, distance: float) -> Array:
    """Return a pose moved along its own z axis."""
    moved = np.array(X)
    moved[:3, 3] += distance * moved[:3, 2]
    return moved


def _pose(pose: Any, X: Array) -> None:
    pose.position.x, pose.position.y, pose.position.z = X[:3, 3].tolist()
    turn = pose.orientation
    turn.x, turn.y, turn.z, turn.w = quaternion(X[:3, :3]).tolist()


def _colour(colour: Any, code: str) -> None:
    colour.r, colour.g, colour.b = (int(code[k : k + 2], 16) / 255.0 for k in (1, 3, 5))
    colour.a = 1.0
