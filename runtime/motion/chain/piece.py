"""One move as a piece of a path: its joints at any share of it, how long it counts, and how fast it may be run.

A move along a path that keeps its posture is solved pose by pose; one that goes through the wrist, and a joint move,
are curves in joint space. ``extent`` m is the length that a piece has on the path of its chain: that of the path, or
more where the tool turns far on a short one, ``ROOM`` m for a rad. Made by the planner of each move; m, rad.
"""

from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array, inverse
from runtime.core.linear import matmul
from runtime.core.units import badness
from runtime.motion.path import NOTHING_TO_DO, Path
from runtime.motion.path_ik import Arm, LineSolver, WristSolver
from runtime.motion.velocity_profile import SpeedLimits
from runtime.robot.kinematics.kinematics import Kinematics

ROOM = 0.1
"""Length that a turn of one rad counts for at least, m."""


class JointLine:
    """The straight line in joint space from q_start (n,) to q_end (n,) rad."""

    def __init__(self, q_start: Array, q_end: Array) -> None:
        self.q_start, self.q_end = q_start, q_end

    def at(self, s: Array) -> Array:
        """Return q (N, n) at s (N,) from 0 to 1."""
        return np.asarray(self.q_start + s[:, None] * (self.q_end - self.q_start))


@dataclass(frozen=True, slots=True, kw_only=True)
class Piece:
    """A move: the ``curve`` of its joints, its ``path``, None for a joint move, ``extent`` m and ``limits`` of s.

    ``q_start`` and ``q_end`` (n,) are where it begins and ends; ``acceleration`` the programmed share of the robot's
    (infinite: none holds along the path), ``override`` that of all speeds, ``duration_s`` the least time, s.
    """

    curve: LineSolver | WristSolver | JointLine
    path: Path | None
    extent: float
    limits: SpeedLimits
    q_start: Array
    q_end: Array
    acceleration: float = 1.0
    override: float = 1.0
    duration_s: float | None = None

    @property
    def keeps_posture(self) -> bool:
        """Whether every pose of it is one of its path."""
        return isinstance(self.curve, LineSolver)

    @property
    def programmed_s(self) -> float:
        """Time that its speed alone takes, or its TIME, s."""
        return max(1.0 / (self.limits.speed * self.override), self.duration_s or 0.0, key=badness)

    def joints(self, s: Array, near: Array) -> Array:
        """Return q (N, n) at s (N,), rising, each joint the whole turn nearest to ``near`` (N, n); NaN where lost."""
        if isinstance(self.curve, JointLine):
            return self.curve.at(s)
        if isinstance(self.curve, LineSolver):
            assert self.path is not None
            return solved(self.curve.arm, self.curve, self.path.poses(s), near)
        # it solves from the start of its path to the end, and counts the turns from there
        q = self.curve.rows(np.concatenate([[0.0], s, [1.0]]))[1:-1]
        return self.curve.arm.kinematics.nearest_turns(q, near)

    def poses(self, s: Array) -> Array:
        """Return the poses (N, 4, 4) of the tool at s (N,), of a piece that keeps its posture."""
        assert self.path is not None
        return self.path.poses(s)


def solved(arm: Arm, line: LineSolver, X_base_tool: Array, near: Array) -> Array:
    """Return q (N, n) at poses (N, 4, 4) of the tool in the configuration of a line, nearest to ``near`` (N, n)."""
    poses = matmul(X_base_tool, inverse(arm.X_flange_tool))
    if arm.kinematics.closed_form:
        return arm.kinematics.inverse_branch(poses, line.branch, near)
    # no branches to hold on to: each is solved from the one before it
    return arm.kinematics.nearest_turns(arm.kinematics.inverse_branch(poses, line.branch, near[0]), near)


def extent_of(path: Path | None, q_start: Array, q_end: Array, kinematics: Kinematics) -> float:
    """Return the extent of a move, m, from its path or, for a joint move, from where its tool flange goes."""
    turn = float(np.abs(q_end - q_start).max()) * ROOM
    if path is not None:
        # where the tool stays in place and keeps its posture, the wrist alone turns
        stays = path.length < NOTHING_TO_DO and path.angle < NOTHING_TO_DO
        return max(path.length, path.angle * ROOM, turn if stays else 0.0, key=badness)
    q = q_start + np.linspace(0.0, 1.0, 17)[:, None] * (q_end - q_start)
    flange = kinematics.forward(q)[:, :3, 3]
    return max(float(np.linalg.norm(np.diff(flange, axis=0), axis=1).sum()), turn, key=badness)
