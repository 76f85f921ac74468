"""The poses of moves that keep their posture, run one by one or several at once: any number of places in few steps.

Where the moves first to last run, shares s of each,

    p = p_first(s) + sum (p_k(s) - p_k(0)),      R = R_first(s) prod R_k(0)^T R_k(s),      k = first + 1, ..., last

Lines that turn about one axis are evaluated together, whatever move they belong to. Called by ``ChainPath``; m, rad.
"""

from collections.abc import Sequence

import numpy as np

from runtime.core.frames import Array, pose, rotation_about
from runtime.core.linear import matmul
from runtime.motion.chain.overlap import Numbers, Overlap
from runtime.motion.chain.piece import Piece
from runtime.motion.path import NOTHING_TO_DO, LinePath


class Posed:
    """The poses of pieces (K,); those without a path, or through the wrist, are not evaluated."""

    def __init__(self, pieces: Sequence[Piece]) -> None:
        self._pieces = tuple(pieces)
        count = len(self._pieces)
        self._start, self._axis = np.tile(np.eye(4), (count, 1, 1)), np.tile([0.0, 0.0, 1.0], (count, 1))
        self._by, self._angle = np.zeros((count, 3)), np.zeros(count)
        self._straight = np.zeros(count, dtype=bool)
        for k, piece in enumerate(self._pieces):
            if piece.path is None:
                continue
            self._start[k] = piece.path.X_start
            if isinstance(piece.path, LinePath) and piece.path.rpy is None:
                self._straight[k] = True
                self._by[k] = piece.path.X_end[:3, 3] - piece.path.X_start[:3, 3]
                self._axis[k], self._angle[k] = piece.path.axis, piece.path.angle

        self._slides = bool((self._straight & (self._angle <= NOTHING_TO_DO)).all())
        """Whether all are lines on which the tool keeps its orientation: then their places alone are added."""

    def at(self, x: Array, overlap: Overlap) -> Array:
        """Return the poses (N, 4, 4) of the tool at places x (N,) where all moves that run keep their posture."""
        first, last = overlap.running(x)
        X = self._poses(first, overlap.shares(first, x))
        if self._slides:
            for step in range(1, int((last - first).max(initial=0)) + 1):
                rows = np.flatnonzero(first + step <= last)
                number = first[rows] + step
                X[rows, :3, 3] += overlap.shares(number, x[rows])[:, None] * self._by[number]
            return X
        for step in range(1, int((last - first).max(initial=0)) + 1):
            rows = np.flatnonzero(first + step <= last)
            number = first[rows] + step
            run, start = self._poses(number, overlap.shares(number, x[rows])), self._start[number]
            turn = matmul(np.swapaxes(start[:, :3, :3], -1, -2), run[:, :3, :3])
            X[rows] = pose(X[rows, :3, 3] + run[:, :3, 3] - start[:, :3, 3], matmul(X[rows, :3, :3], turn))
        return X

    def _poses(self, number: Numbers, share: Array) -> Array:
        """Return the poses (N, 4, 4) of pieces ``number`` (N,) at shares (N,) of them."""
        R = matmul(rotation_about(self._axis[number], share * self._angle[number]), self._start[number, :3, :3])
        X = pose(self._start[number, :3, 3] + share[:, None] * self._by[number], R)
        # arcs, splines and lines by three angles: few on long paths, so one by one
        for k in np.unique(number[~self._straight[number]]).tolist():
            rows = number == k
            X[rows] = self._pieces[k].poses(share[rows])
        return X
