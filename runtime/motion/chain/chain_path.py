"""A chain of moves as one path: pieces in a row, rounded at their corners, over one length x.

x m counts along the extents of the pieces, so a place on the path belongs to a share of one move, or to a corner and
the two moves that it joins. The path is sampled on a grid once, which gives its bounds of speed and acceleration and
holds the whole turns of the joints; at other places it is solved anew, so what runs is on the path itself. A corner
without rounding ends the path: the arm stops there, and the next path begins. Called by ``joined``; m, rad, s.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array, rotation_angles
from runtime.core.linear import matmul
from runtime.motion.chain.corner import Rounding, turned
from runtime.motion.chain.piece import JointLine, Piece, solved
from runtime.motion.chain.rates import Bounds
from runtime.motion.path_ik import Arm, LineSolver, WristSolver
from runtime.motion.speed_cap import speeds

_AT_REST = 0.5 ** np.arange(12, 0, -1)
"""Shares of the first and of the last step of the grid at which there are points, too."""
_NOTHING = 1e-9
_EVEN = 0.25
"""Least share of a step beside it that a step of the grid has."""
_IN_CORNER = 14
_STEP_M = 0.004
_LEAST_STEPS, _MOST_STEPS = 6, 240
_LONGEST_STEPS = 24
"""Steps of the grid: in a corner, and in what is left of a move, by its length within these numbers."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolLimits:
    """What the tool of a chain keeps to: its acceleration m/s2 and that of its turning rad/s2, at every point (M + 1,).

    Infinite where none holds.
    """

    acceleration: Array
    turning: Array


class ChainPath:
    """Pieces (K,) and the roundings (K - 1,) between them, all of which run on: a path from rest to rest."""

    def __init__(self, arm: Arm, pieces: Sequence[Piece], roundings: Sequence[Rounding]) -> None:
        self.arm, self.pieces, self.roundings = arm, tuple(pieces), tuple(roundings)
        ends = np.cumsum([piece.extent for piece in pieces])
        self.ends = np.concatenate([[0.0], ends])
        """Places (K + 1,) of the ends of the pieces, from the start of the first."""
        halves = np.array([each.half for each in roundings])
        inner = self.ends[1:-1]
        # the path in sections: piece, corner, piece, ..., by the places at which they begin
        self._sections = np.concatenate([[0.0], np.stack([inner - halves, inner + halves], axis=1).ravel()])
        self.length = float(self.ends[-1])
        self.x = self._grid()
        self.q = self._solved()

    def joints(self, x: Array) -> Array:
        """Return q (N, n) rad at rising places x (N,)."""
        near = np.stack([np.interp(x, self.x, column) for column in self.q.T], axis=1)
        q = self._at(x, near)
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

    def _grid(self) -> Array:
        """Return the places (M + 1,) of the grid."""
        edges = np.append(self._sections, self.length)
        grid = [np.zeros(1)]
        for k, (begin, end) in enumerate(itertools.pairwise(edges.tolist())):
            if steps := self._steps(k, end - begin):
                grid.append(np.linspace(begin, end, steps + 1)[1:])
        whole = np.concatenate(grid)
        # u is constant from point to point, so a slow speed is gained within a step only if steps at rest are short
        near = _AT_REST * np.array([[whole[1] - whole[0]], [whole[-1] - whole[-2]]])
        return np.concatenate([whole[:1], whole[0] + near[0], whole[1:-1], (whole[-1] - near[1])[::-1], whole[-1:]])

    def _steps(self, section: int, length: float) -> int:
        if section % 2:
            return _IN_CORNER
        piece = self.pieces[section // 2]
        least = _LEAST_STEPS
        if isinstance(piece.curve, WristSolver):
            least = _MOST_STEPS
        elif len(self.pieces) == 1 or section in (0, len(self._sections) - 1):
            least = _LONGEST_STEPS
        wanted = _LEAST_STEPS if isinstance(piece.curve, JointLine) else int(length / _STEP_M)
        # what two corners leave of a move may be next to nothing: differences over it would be rounding
        return min(max(least, min(_MOST_STEPS, wanted)), int(length / (_EVEN * self._step_beside(section))))

    def _step_beside(self, section: int) -> float:
        """Return the shorter step of the grid, m, in the corners beside a section; next to nothing without one."""
        beside = self.roundings[max(section // 2 - 1, 0) : section // 2 + 1]
        return min((2.0 * each.half / _IN_CORNER for each in beside), default=_NOTHING)

    def _solved(self) -> Array:
        """Return q (M + 1, n) on the grid, each point with the whole turns of the one before it."""
        section = self._section(self.x)
        # a section begins where the move before it ends, so it knows its turns; from there on they are unwrapped
        starts = np.array([piece.q_start for piece in self.pieces])
        q = self._at(self.x, starts[(section + 1) // 2])
        turning = self.arm.kinematics.turning > 0.0
        q[:, turning] = np.unwrap(q[:, turning], axis=0)
        return q

    def _section(self, x: Array) -> Array:
        return np.clip(np.searchsorted(self._sections, x, side="right") - 1, 0, len(self._sections) - 1)

    def _at(self, x: Array, near: Array) -> Array:
        """Return q (N, n) at rising places x (N,); all that keeps its posture is solved in one call."""
        section = self._section(x)
        q, X = np.empty((len(x), self.arm.spec.n)), np.empty((len(x), 4, 4))
        lines: dict[str, tuple[LineSolver, list[slice]]] = {}
        edges = np.flatnonzero(np.diff(section)) + 1
        for first, last in itertools.pairwise([0, *edges.tolist(), len(x)]):
            inside, k = slice(first, last), int(section[first])
            line = self._line(k)
            if line is None or not self.arm.kinematics.closed_form:
                q[inside] = self._in_section(k, x[inside], near[inside])
            else:
                X[inside] = self._poses(k, x[inside])
                lines.setdefault(str(line.branch), (line, []))[1].append(inside)
        for line, parts in lines.values():
            rows = np.concatenate([np.arange(part.start, part.stop) for part in parts])
            q[rows] = solved(self.arm, line, X[rows], near[rows])
        return q

    def _line(self, section: int) -> LineSolver | None:
        """Return the solver of a section that keeps its posture, None for another one."""
        number = section // 2
        curve = self.pieces[number].curve if section % 2 == 0 else self.roundings[number].line
        return curve if isinstance(curve, LineSolver) else None

    def _poses(self, section: int, x: Array) -> Array:
        number = section // 2
        if section % 2 == 0:
            return self.pieces[number].poses(self._share(number, x))
        return self.roundings[number].poses(self._passed(section, x))

    def _in_section(self, section: int, x: Array, near: Array) -> Array:
        number = section // 2
        if section % 2 == 0:
            return self.pieces[number].joints(self._share(number, x), near)
        return self.roundings[number].joints(self._passed(section, x), near)

    def _share(self, number: int, x: Array) -> Array:
        return np.asarray(np.clip((x - self.ends[number]) / self.pieces[number].extent, 0.0, 1.0))

    def _passed(self, section: int, x: Array) -> Array:
        passed = (x - self._sections[section]) / (2.0 * self.roundings[section // 2].half)
        return np.asarray(np.clip(passed, 0.0, 1.0))

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
        fastest = self._mixed(extents * np.array([piece.limits.speed for piece in self.pieces]) * share)
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

    def _mixed(self, speeds: Array) -> Array:
        """Return the programmed speed (M + 1,) on the grid from that of each piece (K,): in a corner it goes over."""
        found: Array = speeds[self.move_at(self.x)]
        section = self._section(self.x)
        for k in range(1, len(self._sections), 2):
            inside = section == k
            if inside.any():
                share = turned(self._passed(k, self.x[inside]))
                found[inside] = speeds[k // 2] + share * (speeds[k // 2 + 1] - speeds[k // 2])
        return found


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
