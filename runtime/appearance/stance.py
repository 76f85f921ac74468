"""Where the bodies of a scene are: joint values to poses."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from runtime.appearance.scene import Scene, SceneJoint
from runtime.core.frames import Array, pose, rotation_about
from runtime.core.linear import matmul


@dataclass(frozen=True, slots=True, kw_only=True)
class Stance:
    """Values of the joints of a scene: ``axes`` (n,) rad or m, ``fingers`` (2,) m, poses of ``parts`` (p, 7).

    A finger's value is the distance of its pad from the tool point; a part's pose is x y z qw qx qy qz in the world. A
    joint without a value stays at zero, a part where the scene has it.
    """

    axes: Sequence[float] | Array = ()
    fingers: Sequence[float] | Array = ()
    parts: Sequence[Sequence[float]] | Array = ()


def world_poses(scene: Scene, stance: Stance) -> Mapping[str, Array]:
    """Return X_world_body (4, 4) of every body."""
    found: dict[str, Array] = {}
    for body in scene.bodies:
        X = body.X_parent_body if body.parent is None else matmul(found[body.parent], body.X_parent_body)
        found[body.name] = X if body.joint is None else _moved(X, body.joint, stance)
    return found


def _moved(X: Array, joint: SceneJoint, stance: Stance) -> Array:
    values = {"axis": stance.axes, "finger": stance.fingers, "part": stance.parts}[joint.source]
    if not joint.index < len(values):
        return X
    value = np.asarray(values[joint.index], dtype=np.float64)
    if joint.source == "part":
        return pose(value[:3], _rotation(value[3:]))
    turn = rotation_about(joint.axis, value) if joint.kind == "revolute" else np.eye(3)
    shift = joint.axis * value if joint.kind == "prismatic" else np.zeros(3)
    return matmul(X, pose(shift, turn))


def _rotation(quaternion: Array) -> Array:
    """Return the rotation (3, 3) of (w, x, y, z), which may have a little less or more than unit length."""
    w, x, y, z = quaternion / np.sqrt(np.sum(quaternion**2))
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )
