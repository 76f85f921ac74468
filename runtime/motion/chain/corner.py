r"""A corner between two moves: a curve that leaves the first before its end and joins the second after its start.

Both are run at once, the first slower and slower, the second faster and faster. With u from 0 to 1 over the corner, d
m its half, and f the function with f(0) = f'(0) = f''(0) = 0, f'(1) = 1 and f''(1) = 0 whose f'' rises over a third of
the corner, stays, and falls,

    rest of the first    2 d f(1 - u)          passed of the second    2 d f(u)

    place        p(u) = p_first + p_second - p_corner            orientation    R(u) = R_first R_corner^T R_second

So place, direction and curvature are continuous where it leaves the first and joins the second; two pieces of one line
stay that line, run evenly; and on lines the tool is within d of the corner. Where a move is a joint move, or goes
through its wrist, the joints are added in place of poses: q(u) = q_first + q_second - q_corner. d is the zone, where it
is not more than half of either move, and less where the tool would leave the zone or a joint its range. Called by
``joined``; m, rad.
"""

from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array, pose
from runtime.core.linear import matmul
from runtime.motion.chain.piece import Piece, solved
from runtime.motion.path_ik import RANGE_TOLERANCE, Arm, LineSolver

_CHECKED = np.linspace(0.0, 1.0, 17)
_SMALLER, _TRIES = 0.75, 12
_LEAST = 1e-7
"""A corner of less, m, is none."""
_SAME = 1e-7
"""By how much the joints of a corner may differ from those of its moves where they meet, rad: rounding."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Corner:
    """A corner as planned: its ``radius``, m, as programmed, and ``cycles`` in which both moves run (0: it stops).

    ``reach`` m: how far from the corner the tool leaves or joins the paths, at most; ``deviation`` m: by how much it
    misses the corner.
    """

    radius: float
    cycles: int = 0
    reach: float = 0.0
    deviation: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Rounding:
    """The curve between two pieces; ``half`` d m of its extent, 0: the arm stops; ``by_pose``: poses are added."""

    first: Piece
    second: Piece
    half: float
    by_pose: bool

    @property
    def line(self) -> LineSolver | None:
        """The solver of its poses, None where joints are added."""
        curve = self.second.curve
        return curve if self.by_pose and isinstance(curve, LineSolver) else None

    def joints(self, u: Array, near: Array) -> Array:
        """Return q (N, n) at u (N,) in [0, 1], nearest to ``near`` (N, n); NaN where there is no solution."""
        line = self.line
        if line is not None:
            return solved(line.arm, line, self.poses(u), near)
        a, b = self._shares(u)
        corner = self.second.q_start
        # the first rests at its end from where the second has it, so the corner itself cancels out
        return self.first.joints(a, near) + self.second.joints(b, np.broadcast_to(corner, near.shape)) - corner

    def poses(self, u: Array) -> Array:
        """Return the poses (N, 4, 4) of the tool at u (N,) in [0, 1], where poses are added."""
        a, b = self._shares(u)
        first, second = self.first.poses(a), self.second.poses(b)
        corner = self.second.poses(np.zeros(1))[0]
        R = matmul(matmul(first[:, :3, :3], corner[:3, :3].T), second[:, :3, :3])
        return pose(first[:, :3, 3] + second[:, :3, 3] - corner[:3, 3], R)

    def _shares(self, u: Array) -> tuple[Array, Array]:
        """Return the shares (N,) of the first and of the second move that are run together."""
        length = 2.0 * self.half
        return 1.0 - length * _passed(1.0 - u) / self.first.extent, length * _passed(u) / self.second.extent


def rounding(first: Piece, second: Piece, zone: float, arm: Arm) -> Rounding:
    """Return the curve at the corner between two pieces whose programmed zone is ``zone`` m."""
    by_pose = first.keeps_posture and second.keeps_posture
    half = min(_room(first, zone, arm, at_end=True), _room(second, zone, arm, at_end=False))
    for _ in range(_TRIES):
        if not half > _LEAST:
            break
        for each in (by_pose, False) if by_pose else (False,):
            found = Rounding(first=first, second=second, half=half, by_pose=each)
            if _holds(found, zone, arm):
                return found
        half *= _SMALLER
    return Rounding(first=first, second=second, half=0.0, by_pose=by_pose)


def _passed(u: Array) -> Array:
    """Return f(u): its second derivative rises for a third, stays and falls, so its third is as small as it can be."""
    third = u - 1.0 / 3.0
    stays = 1.0 / 36.0 + 0.25 * third + 0.75 * third**2
    return np.asarray(
        np.where(u <= 1.0 / 3.0, 0.75 * u**3, np.where(u <= 2.0 / 3.0, stays, u - 0.5 + 0.75 * (1.0 - u) ** 3))
    )


def turned(u: Array) -> Array:
    """Return f'(u) (N,): the share of the second move in the direction and in the speed at u (N,) of a corner."""
    stays = 0.25 + 1.5 * (u - 1.0 / 3.0)
    return np.asarray(
        np.where(u <= 1.0 / 3.0, 2.25 * u**2, np.where(u <= 2.0 / 3.0, stays, 1.0 - 2.25 * (1.0 - u) ** 2))
    )


def _room(piece: Piece, zone: float, arm: Arm, *, at_end: bool) -> float:
    """Return how far of a piece, m of its extent, lies in the zone at one of its ends; half of it at most."""
    most = 0.5 * piece.extent
    path = piece.path
    if piece.keeps_posture and path is not None:
        # on an arc the chord is shorter than the arc, so this is less than there is
        return most if path.length <= 0.0 else float(np.minimum(most, zone * piece.extent / path.length))
    shares = np.linspace(0.0, 0.5, 65)
    s = 1.0 - shares[::-1] if at_end else shares
    q = piece.joints(s, np.broadcast_to(piece.q_end if at_end else piece.q_start, (len(s), len(piece.q_start))))
    distance = _distances(arm, q[::-1] if at_end else q)
    out = np.flatnonzero(~(distance <= zone))
    if not len(out):
        return most
    k = int(out[0])
    part = (zone - distance[k - 1]) / (distance[k] - distance[k - 1]) if distance[k] > distance[k - 1] else 0.0
    return float(shares[k - 1] + part * (shares[k] - shares[k - 1])) * piece.extent


def _distances(arm: Arm, q: Array) -> Array:
    """Return how far the tool at q (N, n) is from where it is at the first of them, m."""
    points = matmul(arm.kinematics.forward(q), arm.X_flange_tool)[:, :3, 3]
    return np.asarray(np.linalg.norm(points - points[0], axis=1))


def _holds(found: Rounding, zone: float, arm: Arm) -> bool:
    """Return whether a corner stays in its zone and the ranges, and meets its moves."""
    corner = found.second.q_start
    near = np.broadcast_to(corner, (len(_CHECKED), len(corner)))
    q = found.joints(_CHECKED, near)
    if not np.isfinite(q).all():
        return False
    if not ((q >= arm.spec.lower - RANGE_TOLERANCE) & (q <= arm.spec.upper + RANGE_TOLERANCE)).all():
        return False
    meets = found.first.joints(np.array([1.0 - found.half / found.first.extent]), near[:1])[0]
    joins = found.second.joints(np.array([found.half / found.second.extent]), near[:1])[0]
    if not np.maximum(np.abs(q[0] - meets).max(), np.abs(q[-1] - joins).max()) <= _SAME:
        return False
    return bool((_distances(arm, np.concatenate([corner[None], q])) <= zone * (1.0 + 1e-9)).all())
