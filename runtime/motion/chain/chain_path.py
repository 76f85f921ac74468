"""A chain of moves as one path: pieces in a row, rounded at their corners, over one length x.

x m counts along the extents of the pieces, so a place on the path belongs to a share of one move, or to a corner and
the two moves that it joins. The path is sampled on a grid once, which gives its bounds of speed and acceleration and
holds the whole turns of the joints; at other places it is solved anew, so what runs is on the path itself. A corner
without rounding ends the path: the arm stops there, and the next path begins. Called by ``joined``; m, rad, s.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array, rotation_angles
from runtime.core.linear import matmul
from runtime.motion.chain.corner import Rounding
from runtime.motion.chain.course import Course
from runtime.motion.chain.grid import after, grid
from runtime.motion.chain.piece import Piece
from runtime.motion.chain.rates import Bounds
from runtime.motion.path_ik import Arm
from runtime.motion.speed_cap import speeds


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolLimits:
    """What the tool of a chain keeps to: its acceleration m/s2 and that of its turning rad/s2, at every point (M + 1,).

    Infinite where none holds.
    """

    acceleration: Array
    turning: Array


class ChainPath:
    """Pieces (K,) and the roundings (K - 1,) between them, all of which run on: a path from rest to rest.

    ``kept`` (k,) are the first points of its grid, where it goes on from another path.
    """

    def __init__(
        self, arm: Arm, pieces: Sequence[Piece], roundings: Sequence[Rounding], kept: Array | None = None
    ) -> None:
        self.arm, self.pieces, self.roundings = arm, tuple(pieces), tuple(roundings)
        by_pose = np.array([each.by_pose for each in roundings], dtype=bool)
        self.course = Course(arm, pieces, np.array([each.half for each in roundings]), by_pose)
        self.x = grid(self.pieces, self.course.overlap)
        if kept is not None:
            self.x = after(self.x, kept)
        self.q = self._solved()

    @property
    def ends(self) -> Array:
        """Places (K + 1,) of the ends of the pieces, from the start of the first."""
        return self.course.ends

    @property
    def length(self) -> float:
        """Length of the path, m of the extents of its pieces."""
        return float(self.ends[-1])

    def joints(self, x: Array) -> Array:
        """Return q (N, n) rad at rising places x (N,)."""
        near = np.stack([np.interp(x, self.x, column) for column in self.q.T], axis=1)
        q = self.course.joints(x, near)
        start, end = self.pieces[0].q_start, self.pieces[-1].q_end
        # to the last bit: where the arm is, and from where the next move begins
        q[x <= 0.0], q[x >= self.length] = start, end
        return q

    def move_at(self, x: Array) -> NDArray[np.intp]:
        """Return the number (N,) of the piece to which places x (N,) belong; a corner is half of either."""
        number = np.searchsorted(self.ends, x, side="right") - 1
        return np.asarray(np.clip(number, 0, len(self.pieces) - 1), dtype=np.intp)

    def share_at(self, x: Array) -> Array:
        """Return how much (N,) of its piece is passed at places x (N,)."""
        number = self.move_at(x)
        return np.asarray(np.clip((x - self.ends[number]) / np.diff(self.ends)[number], 0.0, 1.0))

    def _solved(self) -> Array:
        """Return q (M + 1, n) on the grid, each point with the whole turns of the one before it."""
        # a piece begins where the one before it ends, so it knows its turns; from there on they are unwrapped
        q = self.course.joints(self.x, self.course.near(self.x))
        turning = self.arm.kinematics.turning > 0.0
        q[:, turning] = np.unwrap(q[:, turning], axis=0)
        return q

    def speeds(self) -> Array:
        """Return the larger speed (M + 1,) of tool point and flange on the grid, per speed along x."""
        along, _ = derivatives(self.x, self.q)
        return np.asarray(speeds(self.arm.kinematics, self.q, along, self.arm.X_flange_tool).max(axis=0))

    def bounds(self, joints: tuple[Array, Array], tool: ToolLimits, share: Array) -> Bounds:
        """Return the bounds of the path on its grid: of the joints' speed and acceleration, both (n,), and of the tool.

        ``share`` (K,) is the override of each piece.
        """
        speed, acceleration = joints
        x, q = self.x, self.q
        along, across = derivatives(x, q)
        number = self.move_at(x)
        extents = np.array([piece.extent for piece in self.pieces])
        fastest = self.course.overlap.mixed(
            extents * np.array([piece.limits.speed for piece in self.pieces]) * share, x
        )
        gain = (extents * np.array([piece.limits.acceleration for piece in self.pieces]))[number]
        moving = np.abs(along)
        b = np.minimum(fastest**2, ((speed * share[number][:, None] / np.maximum(moving, 1e-12)) ** 2).min(axis=1))
        X = matmul(self.arm.kinematics.forward(q), self.arm.X_flange_tool)
        rows = [(np.ones(len(x)), np.zeros(len(x)), np.zeros(len(x)), gain)]
        for vectors, most in ((derivatives(x, X[:, :3, 3]), tool.acceleration), (_turning(x, X), tool.turning)):
            first, second = vectors
            size = np.sqrt((first**2).sum(axis=1))
            with_it = (first * second).sum(axis=1) / np.maximum(size, 1e-12)
            beside = np.sqrt(np.maximum((second**2).sum(axis=1) - with_it**2, 0.0))
            rows += [(size, with_it, 0.5 * beside, most), (size / 3.0, with_it / 3.0, beside, most)]
            b = np.minimum(b, np.where(beside > 1e-9, most / np.maximum(beside, 1e-9), np.inf))
        stacked = [np.stack(column, axis=1) for column in zip(*rows, strict=True)]
        return Bounds(
            along=np.concatenate([along, stacked[0]], axis=1),
            across=np.concatenate([across, stacked[1]], axis=1),
            beside=np.concatenate([np.zeros_like(along), stacked[2]], axis=1),
            most=np.concatenate([np.broadcast_to(acceleration, along.shape), stacked[3]], axis=1),
            fastest=b,
        )


def derivatives(x: Array, values: Array) -> tuple[Array, Array]:
    """Return first and second derivatives (M + 1, k) of values (M + 1, k) on a grid x (M + 1,)."""
    h = np.diff(x)[:, None]
    slope = np.diff(values, axis=0) / h
    first, second = np.empty_like(values), np.empty_like(values)
    before, after = h[:-1], h[1:]
    first[1:-1] = (slope[:-1] * after + slope[1:] * before) / (before + after)
    second[1:-1] = 2.0 * (slope[1:] - slope[:-1]) / (before + after)
    second[0], second[-1] = second[1], second[-2]
    first[0] = slope[0] - 0.5 * h[0] * second[0]
    first[-1] = slope[-1] + 0.5 * h[-1] * second[-1]
    return first, second


def _turning(x: Array, X: Array) -> tuple[Array, Array]:
    """Return the turning of the tool per length (M + 1, 3) of poses X (M + 1, 4, 4), and its derivative."""
    R = X[:, :3, :3]
    M = matmul(R[1:], np.swapaxes(R[:-1], -1, -2))
    w = 0.5 * np.stack([M[:, 2, 1] - M[:, 1, 2], M[:, 0, 2] - M[:, 2, 0], M[:, 1, 0] - M[:, 0, 1]], axis=1)
    # between two points of a grid the tool turns little: the vector of its sine, made as long as the angle
    sine = np.sqrt((w**2).sum(axis=1))
    angle = rotation_angles(R[:-1], R[1:])
    steps = w * (angle / np.maximum(sine, 1e-15))[:, None]
    turned = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    return derivatives(x, turned)
