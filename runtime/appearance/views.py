"""Named views, which take in the whole of a scene."""

import math
from collections.abc import Sequence

import numpy as np

from runtime.appearance.scene import Scene, Shape, View
from runtime.appearance.stance import Stance, world_poses
from runtime.core.frames import Array
from runtime.core.linear import matmul, norm
from runtime.core.units import DEG

FIELD = 32.0 * DEG
"""Vertical field of view, rad: about that of a lens for portraits, so that straight arms look straight."""
MARGIN = 1.06
"""How much more than the scene a named view shows."""
NEAREST = 0.01
"""Least distance of a camera, m: a scene may be one point."""
DIRECTIONS = {"iso": (142.0, -20.0), "front": (180.0, -8.0), "side": (90.0, -8.0), "top": (90.0, -89.9)}
"""Azimuth and elevation, deg, in which each named view looks: ``front`` faces the robot, ``side`` sees it from its
right, ``top`` has x of the world to the right."""


def named_view(name: str, scene: Scene, stances: Sequence[Stance], aspect: float) -> View:
    """Return the view ``name`` of ``DIRECTIONS`` that takes in a scene in all of some stances.

    ``aspect`` is width by height of the picture.
    """
    azimuth, elevation = (angle * DEG for angle in DIRECTIONS[name])
    forward = np.array(
        [
            math.cos(elevation) * math.cos(azimuth),
            math.cos(elevation) * math.sin(azimuth),
            math.sin(elevation),
        ]
    )
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= norm(right)
    axes = np.stack([right, np.cross(right, forward), forward])
    corners = matmul(np.concatenate([_corners(scene, stance) for stance in stances]), axes.T)
    # how far a point may be to the side for each metre before the camera
    slopes = math.tan(FIELD / 2.0) * np.array([aspect, 1.0]) / MARGIN
    return _fitted(corners, axes, slopes)


def _fitted(corners: Array, axes: Array, slopes: Array) -> View:
    """Return the nearest camera that sees all ``corners`` (k, 3): right, up and forward, in the frame of the view."""
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2.0
    # a few rounds: what is near looks larger, so the middle of the picture is not that of the scene
    for _ in range(8):
        at = corners - middle
        distance = float(np.maximum(NEAREST, (np.abs(at[:, :2]) / slopes - at[:, 2:]).max()))
        seen = at[:, :2] / (distance + at[:, 2:])
        middle[:2] += distance * (seen.min(axis=0) + seen.max(axis=0)) / 2.0
    target = matmul(middle, axes)
    return View(position=target - distance * axes[2], target=target)


def _corners(scene: Scene, stance: Stance) -> Array:
    """Return the corners (k, 3) m, in the world, of boxes around all shapes in a stance, and all points."""
    poses = world_poses(scene, stance)
    found = [mark.X_world_mark[None, :3, 3] for mark in scene.points]
    for shape in scene.shapes:
        X = matmul(poses[shape.body], shape.X_body_shape)
        found.append(matmul(_box(scene, shape), X[:3, :3].T) + X[:3, 3])
    # of nothing, where the robot could come to
    return np.concatenate(found) if found else np.array([[-scene.reach] * 3, [scene.reach] * 3])


def _box(scene: Scene, shape: Shape) -> Array:
    """Return the corners (8, 3) m of the box around a shape, in its own frame."""
    low, high = _extent(scene, shape)
    return np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])


def _extent(scene: Scene, shape: Shape) -> tuple[Array, Array]:
    """Return the lowest and the highest corner (3,) m of a shape in its own frame."""
    size = np.array(shape.size)
    if shape.mesh is not None:
        vertices = scene.meshes[shape.mesh].vertices
        return vertices.min(axis=0), vertices.max(axis=0)
    if shape.kind == "box":
        return -size / 2.0, size / 2.0
    wide = np.full(3, size[:2].max() if shape.kind != "sphere" else size[0])
    if shape.kind == "cylinder":
        wide[2] = size[2] / 2.0
    if shape.kind == "limb":
        return np.array([-wide[0], -wide[1], -size[0]]), np.array([wide[0], wide[1], size[2] + size[1]])
    return -wide, wide
