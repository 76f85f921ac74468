"""Where the bodies of a scene are while a program runs, as transforms of viewers: ``foxglove.FrameTransforms``.

Each body is a frame under its parent, ``world`` at the root. ``tool_point`` is a frame more: the tool point in use,
under the flange, which TOOL may change; the frame ``tool`` belongs to the hand and stays.
"""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from robolang.logs.foxglove import message, plain
from robolang.logs.log import Log
from runtime.appearance.scene import Scene, SceneBody, SceneJoint
from runtime.control.blocks import FRAME_CYCLES
from runtime.core.frames import Array
from runtime.core.linear import matmul

WORLD, FLANGE, TOOL_POINT = "world", "flange", "tool_point"

Placed = tuple[str, str, Array, Array]
"""Parent, child, translations (F, 3) m and quaternions (F, 4), x y z w, of F frames of the log."""


def fixed(scene: Scene) -> Iterator[Placed]:
    """Yield the bodies that never move against their parents, with one frame each."""
    for body in scene.bodies:
        if body.joint is None:
            yield _placed(body, body.X_parent_body[None, :3, 3], quaternion(body.X_parent_body[:3, :3])[None])


def moving(scene: Scene, log: Log, first: int, last: int) -> Iterator[Placed]:
    """Yield the bodies that move, for the frames ``first`` to before ``last`` of the log, and the tool point in use."""
    sources = {
        "axis": _at_frames(log, "q_link", first, last),
        "finger": log.span("fingers", first, last),
        "part": log.span("parts", first, last),
    }
    for body in scene.bodies:
        if body.joint is not None:
            values = sources[body.joint.source][:, body.joint.index]
            yield _part(body, values) if body.joint.source == "part" else _jointed(body, body.joint, values)
    if any(body.name == FLANGE for body in scene.bodies):
        yield _tool_point(log, first, last)


def messages(times_ns: Iterable[int], placed: Iterable[Placed]) -> Iterator[bytes]:
    """Yield a message for each frame, with all transforms of that frame."""
    rows = [(plain(parent), plain(child), moves.tolist(), turns.tolist()) for parent, child, moves, turns in placed]
    for k, time_ns in enumerate(times_ns):
        found = message("FrameTransforms")()
        for parent, child, moves, turns in rows:
            each = found.transforms.add(parent_frame_id=parent, child_frame_id=child)
            stamp(each.timestamp, time_ns)
            each.translation.x, each.translation.y, each.translation.z = moves[k]
            turn = each.rotation
            turn.x, turn.y, turn.z, turn.w = turns[k]
        yield found.SerializeToString(deterministic=True)


def stamp(timestamp: Any, time_ns: int) -> None:
    """Set a ``google.protobuf.Timestamp``."""
    timestamp.seconds, timestamp.nanos = divmod(time_ns, 1_000_000_000)


def quaternion(R: Array) -> Array:
    """Return the quaternion x y z w (4,) of a rotation (3, 3)."""
    # the largest of four sums, which is no small number to divide by (Shepperd 1978)
    x, y, z = R[0, 0], R[1, 1], R[2, 2]
    sums = [x - y - z, y - x - z, z - x - y, x + y + z]
    largest = int(np.argmax(sums))
    root = float(np.sqrt(1.0 + sums[largest]))
    found = np.zeros(4)
    found[largest] = root / 2.0
    if largest == 3:
        found[:3] = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (2.0 * root)
        return found
    i, j, k = largest, (largest + 1) % 3, (largest + 2) % 3
    found[j], found[k] = (R[j, i] + R[i, j]) / (2.0 * root), (R[k, i] + R[i, k]) / (2.0 * root)
    found[3] = (R[k, j] - R[j, k]) / (2.0 * root)
    return found


def _placed(body: SceneBody, moves: Array, turns: Array) -> Placed:
    return body.parent or WORLD, body.name, moves, turns


def _jointed(body: SceneBody, joint: SceneJoint, values: Array) -> Placed:
    R, p, axis = body.X_parent_body[:3, :3], body.X_parent_body[:3, 3], joint.axis
    still = quaternion(R)
    if joint.kind == "prismatic":
        along = matmul(R, axis[:, None])[:, 0]
        return _placed(body, p + values[:, None] * along, np.repeat(still[None], len(values), axis=0))
    half = values[:, None] / 2.0
    turned = np.concatenate([np.sin(half) * axis, np.cos(half)], axis=1)
    return _placed(body, np.repeat(p[None], len(values), axis=0), _product(still, turned))


def _product(first: Array, then: Array) -> Array:
    """Return the quaternions (F, 4) of a rotation (4,) followed by others (F, 4) in its frame."""
    u, w, v, s = first[:3], first[3], then[:, :3], then[:, 3:]
    vector = w * v + s * u + np.cross(u, v)
    return np.concatenate([vector, w * s - (v * u).sum(axis=1, keepdims=True)], axis=1)


def _part(body: SceneBody, poses: Array) -> Placed:
    # the log has w first, viewers have it last
    return WORLD, body.name, poses[:, :3], poses[:, [4, 5, 6, 3]]


def _tool_point(log: Log, first: int, last: int) -> Placed:
    tools = np.stack(log.rows.tools)
    turns = np.stack([quaternion(X[:3, :3]) for X in tools])
    used = log.rows.read("tool", first * FRAME_CYCLES, min(last * FRAME_CYCLES, log.rows.cycles))[::FRAME_CYCLES]
    return FLANGE, TOOL_POINT, tools[used][:, :3, 3], turns[used]


def _at_frames(log: Log, name: str, first: int, last: int) -> Array:
    """Return a signal of ticks at the times of frames."""
    step = FRAME_CYCLES * log.rows.ticks_per_cycle
    return log.span(name, first * step, min(last * step, log.rows.ticks))[::step]
