"""Where parts and fingers are in a planned motion: a part lies, goes with the hand that holds it, and lies again."""

import numpy as np

from robolang.execution.dry_run import Rehearsal
from robolang.planning.part_findings import CellTouches, Scene
from robolang.project.project import Project
from robolang.view.packing import Signal
from robolang.view.thinning import even_step
from runtime.core.frames import Array, quaternion

_CYCLES = 2
"""Cycles from one row to the next, as in a log."""
_FINEST = 1e-7


def parts_of(project: Project, rehearsal: Rehearsal, q: Array) -> list[Signal]:
    """Return ``parts`` and ``fingers`` as a log has them; q (N, n) rad are the set-points, one a cycle."""
    cell, period_us = project.cell, project.profile.period_us
    step = _CYCLES * even_step(-(-len(q) // _CYCLES))
    X_world_tool = rehearsal.kinematics.forward(q[::step]) @ cell.hand.X_flange_tool
    changes = CellTouches(project, rehearsal.kinematics).scenes(rehearsal)
    begins = [-(-time_us // (step * period_us)) for time_us, _ in changes]
    parts, fingers = np.zeros((len(X_world_tool), len(cell.parts), 7)), np.zeros((len(X_world_tool), 2))
    for (_, scene), begin, end in zip(changes, begins, [*begins[1:], len(parts)], strict=True):
        fingers[begin:end] = scene.opening / 2.0
        for k, part in enumerate(cell.parts):
            # a part of which nothing is known any more stays where it was seen last
            before = parts[begin - 1, k] if begin else _seven(np.array(part.X_world_part))
            parts[begin:end, k] = _poses(scene, part.name, X_world_tool[begin:end], before)
    dt = step * period_us * 1e-6
    columns = parts.reshape(len(parts), 7 * len(cell.parts))
    return [
        Signal(name=name, base="frame", dt=dt, values=values, finest=_FINEST)
        for name, values in (("parts", columns), ("fingers", fingers))
    ]


def _poses(scene: Scene, name: str, X_world_tool: Array, before: Array) -> Array:
    """Return the pose of a part as seven numbers in each row, or in all rows alike."""
    if name in scene.held:
        found = np.array([_seven(X @ scene.held[name]) for X in X_world_tool]).reshape(len(X_world_tool), 7)
        # a quaternion and its negative are one rotation: those of neighbours are on one side, so that none is between
        turned = np.sum(found[1:, 3:] * found[:-1, 3:], axis=1) < 0.0
        found[1:, 3:] *= np.where(np.cumsum(turned) % 2, -1.0, 1.0)[:, None]
        return found
    return _seven(scene.lying[name]) if name in scene.lying else before


def _seven(X: Array) -> Array:
    """Return position m and quaternion w x y z (7,) of a pose (4, 4)."""
    return np.concatenate([X[:3, 3], quaternion(X[:3, :3])])
