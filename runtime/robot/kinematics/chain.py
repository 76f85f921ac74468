"""The joint frames of an arm, one after another: where its flange is at given joint angles, m and rad.

    X_base_flange = prod_i (placement_i Rz(q_i)) X_last_flange,     Tz(q_i), m, for an axis that slides

It needs nothing else of the robot, so that a log of a run, which has these frames alone, gives the same poses to the
last bit.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.robot.model.axis_kind import AxisKind


class Placed(Protocol):
    """An axis with its frame in the frame of the axis before it, (4, 4) with the joint at zero."""

    @property
    def placement(self) -> Array: ...  # noqa: D102
    @property
    def kind(self) -> AxisKind: ...  # noqa: D102


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Chain:
    """``placements``: X_before_axis (4, 4) of each axis with its joint at zero; ``X_last_flange`` (4, 4).

    ``sliding`` are the indices of the axes that slide along z; the others turn about it.
    """

    placements: tuple[Array, ...]
    X_last_flange: Array
    sliding: frozenset[int] = frozenset()

    @staticmethod
    def of(axes: Sequence[Placed], X_last_flange: Array) -> "Chain":
        """Return the frames of axes one after another."""
        return Chain(
            placements=tuple(axis.placement for axis in axes),
            X_last_flange=X_last_flange,
            sliding=frozenset(index for index, axis in enumerate(axes) if axis.kind.slides),
        )

    def flange(self, q: ArrayLike) -> Array:
        """Return X_base_flange (..., 4, 4) of joint angles (..., n) rad."""
        X = np.eye(4)
        for X in self.axis_frames(np.asarray(q, dtype=np.float64)):  # noqa: B007 - only the last frame is needed
            pass
        return np.asarray(matmul(X.reshape(-1, 4), self.X_last_flange).reshape(X.shape))

    def points(self, q: Array, p_flange: Array) -> Array:
        """Return where a point (3,) of the flange is in the base (N, 3), m, at joint angles q (N, n) rad.

        Vectors only, from the flange to the base: much quicker than ``flange``, whose last bits differ.
        """
        fixed = [*self.placements, self.X_last_flange]
        x, y, z = np.broadcast_to(_moved(fixed[-1], p_flange[:, None]), (3, len(q)))
        for i in reversed(range(len(self.placements))):
            if i in self.sliding:
                x, y, z = _moved(fixed[i], np.stack([x, y, z + q[:, i]]))
                continue
            c, s = np.cos(q[:, i]), np.sin(q[:, i])
            x, y, z = _moved(fixed[i], np.stack([c * x - s * y, s * x + c * y, z]))
        return np.stack([x, y, z], axis=1)

    def axis_frames(self, q: Array) -> Iterator[Array]:
        """Yield the frame of each axis, turned or slid, in the base frame (..., 4, 4)."""
        X = np.eye(4)
        cosines, sines = np.cos(q), np.sin(q)
        for i, placement in enumerate(self.placements):
            X = matmul(X.reshape(-1, 4), placement).reshape(X.shape)  # one product for all postures
            if i in self.sliding:
                X = _slid(X, q[..., i, None])
                yield X
                continue
            c, s = cosines[..., i, None], sines[..., i, None]
            x, y = X[..., :, 0], X[..., :, 1]
            # a rotation about z mixes the first two columns only: cheaper than a product with a matrix
            turned = np.empty((*q.shape[:-1], 4, 4))
            turned[..., 0], turned[..., 1], turned[..., 2:] = c * x + s * y, c * y - s * x, X[..., :, 2:]
            X = turned
            yield X


def _slid(X: Array, by: Array) -> Array:
    """Return frames (..., 4, 4) slid along their own z by (..., 1) m."""
    moved = np.empty((*by.shape[:-1], 4, 4))
    moved[..., :3], moved[..., 3] = X[..., :3], X[..., 3] + by * X[..., 2]
    return moved


def _moved(X: Array, p: Array) -> Array:
    """Return points p (3, N) in the frame in which X (4, 4) is given."""
    return np.asarray(matmul(X[:3, :3], p) + X[:3, 3:])
