"""Where a chain of moves goes: its joints at every place, on the moves and in the corners between them.

Where moves that run at once all keep their posture, their poses are added (``posed``) and solved; where one of two is a
joint move, or goes through its wrist, their joints are: q = q_first + q_second - q_corner. Called by ``ChainPath``, and
where the room of a corner is found; m, rad.
"""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.motion.chain.overlap import Flags, Numbers, Overlap
from runtime.motion.chain.piece import Piece, solved
from runtime.motion.chain.posed import Posed
from runtime.motion.path_ik import Arm, LineSolver


class Course:
    """Pieces (K,) that overlap by ``halves`` (K - 1,) m; ``by_pose`` (K - 1,): whether poses are added there."""

    def __init__(self, arm: Arm, pieces: Sequence[Piece], halves: Array, by_pose: Flags) -> None:
        self.arm, self.pieces, self.by_pose = arm, tuple(pieces), by_pose
        self.overlap = Overlap(np.concatenate([[0.0], np.cumsum([piece.extent for piece in pieces])]), halves)
        self._posed = Posed(pieces)
        self.starts = np.array([piece.q_start for piece in pieces])
        """Joints (K, n) at which the pieces begin."""
        self._keeps = np.array([piece.keeps_posture for piece in pieces], dtype=bool)
        self._branches = [str(p.curve.branch) if isinstance(p.curve, LineSolver) else "" for p in pieces]

    @property
    def ends(self) -> Array:
        """Places (K + 1,) of the ends of the pieces, from the start of the first."""
        return self.overlap.ends

    @cached_property
    def corners(self) -> Array:
        """Places (K - 1, 3) of the tool at the corners between the pieces."""
        return matmul(self.arm.kinematics.forward(self.starts[1:]), self.arm.X_flange_tool)[:, :3, 3]

    def joints(self, x: Array, near: Array) -> Array:
        """Return q (N, n) at rising places x (N,), each joint the whole turn nearest to ``near`` (N, n).

        NaN where there is no solution. All that keeps its posture in one configuration is solved in one call.
        """
        first, last = self.overlap.running(x)
        posed = self._posed_at(first, last)
        q = np.empty((len(x), self.arm.spec.n))
        self._solve_posed(np.flatnonzero(posed), x, last, near, q)
        for rows in _runs(np.flatnonzero(~posed), first, last):
            q[rows] = self._added(int(first[rows[0]]), int(last[rows[0]]), x[rows], near[rows])
        return q

    def points(self, x: Array, near: Array) -> Array:
        """Return the places (N, 3) of the tool point at rising x (N,); ``near`` as for ``joints``."""
        found = np.empty((len(x), 3))
        first, last = self.overlap.running(x)
        posed = self._posed_at(first, last)
        found[posed] = self._posed.at(x[posed], self.overlap)[:, :3, 3]
        if not posed.all():
            q = self.joints(x[~posed], near[~posed])
            found[~posed] = matmul(self.arm.kinematics.forward(q), self.arm.X_flange_tool)[:, :3, 3]
        return found

    def near(self, x: Array) -> Array:
        """Return joints (N, n) near those at places x (N,): where the last move that runs there begins."""
        return np.asarray(self.starts[self.overlap.running(x)[1]])

    def _posed_at(self, first: Numbers, last: Numbers) -> Flags:
        """Return whether (N,) poses are added where the moves first to last run."""
        alone: Flags = self._keeps[first]
        if not len(self.by_pose):
            return alone
        # only at a corner that is one of joints do two moves run of which one has no poses
        added: Flags = self.by_pose[np.minimum(first, len(self.by_pose) - 1)]
        found: Flags = ((first == last) & alone) | ((first != last) & added)
        return found

    def _solve_posed(self, rows: Numbers, x: Array, last: Numbers, near: Array, q: Array) -> None:
        """Write the joints at ``rows`` of x (N,) to q (N, n)."""
        if not len(rows):
            return
        X = self._posed.at(x[rows], self.overlap)
        if self.arm.kinematics.closed_form:
            names = np.array(self._branches)[last[rows]]
            parts = [np.flatnonzero(names == name) for name in np.unique(names)]
        else:
            # one is solved from the other, so a part has no gaps
            parts = [np.searchsorted(rows, part) for part in _runs(rows, last, last)]
        for part in parts:
            line = self.pieces[int(last[rows[part[0]]])].curve
            assert isinstance(line, LineSolver)
            q[rows[part]] = solved(self.arm, line, X[part], near[rows[part]])

    def _added(self, first: int, last: int, x: Array, near: Array) -> Array:
        """Return q (N, n) at places x (N,) where one move runs, or two whose joints are added."""
        shares = self.overlap.shares
        q = self.pieces[first].joints(shares(np.full(len(x), first), x), near)
        if first == last:
            return q
        # the first rests at its end from where the second has it, so the corner itself cancels out
        corner = self.starts[last]
        second = self.pieces[last].joints(shares(np.full(len(x), last), x), np.broadcast_to(corner, q.shape))
        return np.asarray(q + second - corner)


def _runs(rows: Numbers, first: Numbers, last: Numbers) -> list[Numbers]:
    """Return ``rows`` (N,) in parts without gaps in which the same moves run."""
    if not len(rows):
        return []
    new = (np.diff(rows) > 1) | (np.diff(first[rows]) != 0) | (np.diff(last[rows]) != 0)
    return np.split(rows, np.flatnonzero(new) + 1)
