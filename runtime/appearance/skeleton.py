"""Where the links of an arm run, from its joint frames alone: along joint axes, and across from axis to axis.

A frame says which line a joint turns about. Where its origin stands on that line is a matter of notation: a row of
Denavit and Hartenberg may put it far outside of the machine. So only the lines are used. Link i leaves its own axis at
the foot of the common normal with the next axis, goes across, and arrives at the foot on that one. Between arrival and
leaving, an axis is a piece of the arm that turns in itself, like a column or a forearm; somewhere on it one link ends
and the next begins.

Axes that are parallel have no foot of their own, and the links between them lie in planes across those axes that no
frame gives. Where the arm is offset sideways in all, links lie beside one another, as in a Puma; else in one plane.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.frames import Array
from runtime.core.linear import dot
from runtime.robot.model.spec import RobotSpec

PARALLEL = 0.999
"""Cosine from which on axes are parallel."""
UPRIGHT = 0.5
"""Cosine to the vertical from which on the first axis is that of a column."""
SIDEWAYS = 0.04
"""Offset sideways from which on links lie beside one another, in parts of the reach."""
INNER = (0.2, 0.85)
"""A frame whose origin is within these parts of an axis stands where the link begins; else it does at ``USUAL``."""
USUAL = 0.6


@dataclass(frozen=True, slots=True, kw_only=True)
class Axle:
    """A joint on its own axis, as places z in its frame, m: where the link before arrives, where its own begins and
    where that leaves for the next axis (or the flange)."""

    arrives: float
    begins: float
    leaves: float

    @property
    def length(self) -> float:
        """From arriving to leaving, m."""
        return abs(self.leaves - self.arrives)

    @property
    def middle(self) -> float:
        """The place halfway, m."""
        return (self.arrives + self.leaves) / 2.0


def next_frame(spec: RobotSpec, index: int) -> Array:
    """Return the frame of the next joint, or of the flange (4, 4), in that of axis ``index`` at joint angle zero."""
    return spec.axes[index + 1].placement if index + 1 < spec.n else spec.X_last_flange


def axles(spec: RobotSpec, reach: float, gaps: Sequence[float]) -> list[Axle]:
    """Return the axle of every axis; ``gaps`` (n,) m: how far links beside one another are apart, at each axis."""
    arrives, leaves = [_floor(spec)], [0.0] * spec.n
    for index in range(spec.n):
        here, there = _feet(next_frame(spec, index), index + 1 == spec.n)
        leaves[index] = here
        arrives.append(there)
    found = [Axle(arrives=arrives[k], begins=0.0, leaves=leaves[k]) for k in range(spec.n)]
    for group in _parallels(spec):
        _lay(spec, found, group, SIDEWAYS * reach, gaps)
    return [replace(axle, begins=_begin(axle)) for axle in found]


def is_upright(spec: RobotSpec) -> bool:
    """Return whether the first axis stands on the floor, as a column does, and does not lie over it."""
    return abs(float(spec.axes[0].placement[2, 2])) > UPRIGHT


def _floor(spec: RobotSpec) -> float:
    """Return where the first axis goes through the floor; the frame's own place for an axis that lies."""
    X = spec.axes[0].placement
    return float(-X[2, 3] / X[2, 2]) if is_upright(spec) else 0.0


def _feet(X: Array, is_flange: bool) -> tuple[float, float]:
    """Return where the common normal of an axis and the next (4, 4) stands on each; the flange counts as a point.

    Parallel axes: at the origin of the next frame.
    """
    p, d = X[:3, 3], X[:3, 2]
    across = dot(d[:2], d[:2])
    if is_flange or across <= 1.0 - PARALLEL**2:
        return float(p[2]), 0.0
    along = -dot(p[:2], d[:2]) / across
    return float(p[2] + along * d[2]), along


def _parallels(spec: RobotSpec) -> list[range]:
    """Return groups of two or more axes in a row that are parallel."""
    groups, start = [], 0
    for index in range(1, spec.n + 1):
        if index < spec.n and abs(spec.axes[index].placement[2, 2]) > PARALLEL:
            continue
        if index - start > 1:
            groups.append(range(start, index))
        start = index
    return groups


def _lay(spec: RobotSpec, found: list[Axle], group: range, sideways: float, gaps: Sequence[float]) -> None:
    """Put the links between parallel axes into planes, from the last of them back to the first."""
    last = group[-1]
    # the last link leaves where the next axis is; where none follows, its frame says where it lies
    lies = found[last].leaves if last + 1 < spec.n else 0.0
    side = _side(spec, found[group[0]], group, lies, sideways)
    for index in reversed(group[:-1]):
        X = next_frame(spec, index)
        turned = float(np.sign(X[2, 2]))
        # beside the link that follows: the first one outside of it, further ones by turns
        arrives = lies + side * (1.0 if (index - group[0]) % 2 == 0 else -1.0) * gaps[index + 1] * turned
        found[index + 1] = replace(found[index + 1], arrives=arrives)
        lies = float(X[2, 3]) + arrives * turned
        found[index] = replace(found[index], leaves=lies)


def _side(spec: RobotSpec, first: Axle, group: range, lies: float, sideways: float) -> float:
    """Return on which side, along the first axis of a group, its link is of the next one; 0: in one plane with it."""
    if group[0] == 0 and is_upright(spec):
        # as a SCARA: the first link below the second, which turns above it
        return -float(np.sign(spec.axes[0].placement[2, 2]))
    offset = lies
    for index in reversed(group[:-1]):
        X = next_frame(spec, index)
        offset = float(X[2, 3]) + offset * float(np.sign(X[2, 2]))
    offset -= first.arrives
    return float(np.sign(offset)) if abs(offset) > sideways else 0.0


def _begin(axle: Axle) -> float:
    """Return where on an axle its own link begins: at the frame's origin where that is well inside, else further on."""
    if axle.length > 0.0 and INNER[0] <= -axle.arrives / (axle.leaves - axle.arrives) <= INNER[1]:
        return 0.0
    return axle.arrives + USUAL * (axle.leaves - axle.arrives)
