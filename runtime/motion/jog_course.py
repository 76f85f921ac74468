"""Where a jog leads: samples of its curve in joint space, up to what ends it.

A jog of one joint is a straight line in joint space. A jog of the tool is a line or a turn about the tool point; its
poses are solved in the wrist configuration of the start, more densely where the joints turn much for little motion of
the tool, down to ``FINEST``. What is left as a jump there is a singularity that the course meets exactly. The joints
then turn on the spot, if they can do so while the tool stands (``_on_the_spot``); if not, the course ends there. So a
course is one or more *pieces*, each a smooth curve from rest to rest.

The ranges of the joints are widened to the angles of the start: an arm that a sag or a push has put beyond a limit may
go anywhere but further out. Called by ``runtime.motion.jog``; m, rad.
"""

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array, inverse, pose, rotation_about, rotation_angles
from runtime.core.linear import matmul, norm
from runtime.core.units import DEG, MM
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.opw import BRANCHES, Branch

BEYOND = 1e3
"""No range of a joint is as wide, rad or m."""

FINEST = 1e-9
"""Samples are not nearer to each other than this, m or rad: what jumps between them is a jump."""

STEP = 0.03
"""Joints turn no more between two samples, rad: a cubic through them is on the path to 1e-6 m."""

JUMP = 3e-4
"""Joints that turn further between the finest samples, rad, turn on the spot."""

BEND = 0.15
"""The direction in joint space turns no more between two samples, rad."""

MOST_SAMPLES = 6000
"""With more of them a course is not made finer any more."""

STILL, STILL_TURN = 0.01 * MM, 0.005 * DEG
"""How far the tool may be off while the joints turn on the spot."""

ROUNDS = 45
"""Halvings from the coarsest samples to ``FINEST``."""

Flags: TypeAlias = NDArray[np.bool_]

EndKind = Literal["amount", "limit", "reach", "singularity", "turn", "time"]


@dataclass(frozen=True, slots=True, kw_only=True)
class End:
    """What ends a course: its ``amount``, the limit of ``axis`` (0-based), the reach, a singularity, one whole turn.

    ``limit`` rad is the range of the axis on that side. ``time``: it would go on, and has taken as long as it may.
    """

    kind: EndKind
    axis: int | None = None
    limit: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Piece:
    """A smooth part of a course: ``s`` (N,) m or rad of the jog, joint angles ``q`` (N, n) rad."""

    s: Array
    q: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Course:
    """Where a jog leads: its pieces in order, how far it ``goes`` (m or rad, 0 or more), and what ends it."""

    pieces: tuple[Piece, ...]
    goes: float
    end: End


@dataclass(frozen=True, slots=True, kw_only=True)
class Ranges:
    """The ranges of the joints (n,) rad that a course keeps, and the limits that messages name."""

    lower: Array
    upper: Array
    named: tuple[Array, Array]

    @classmethod
    def of(cls, lower: Array, upper: Array, q_start: Array, inside: Array | float) -> "Ranges":
        """Return ranges that end ``inside`` rad, (n,) or one, before the limits, widened to where the arm is."""
        return cls(
            lower=np.minimum(lower + inside, q_start),
            upper=np.maximum(upper - inside, q_start),
            named=(lower, upper),
        )

    def inside(self, q: Array) -> Flags:
        """Return whether joint angles q (N, n) are known and in the ranges, (N,); NaN is not."""
        return np.asarray(((q >= self.lower) & (q <= self.upper)).all(axis=1))

    def end(self, q: Array) -> End:
        """Return the end of a course whose next joint angles q (n,) would be outside."""
        axis = int(np.argmax(np.maximum(self.lower - q, q - self.upper)))
        limit = self.named[0][axis] if q[axis] < self.lower[axis] else self.named[1][axis]
        return End(kind="limit", axis=axis, limit=float(limit))


def joint_course(q_start: Array, axis: int, turn: float, ranges: Ranges) -> Course:
    """Return the course of one joint from q_start (n,) by ``turn`` rad, infinite: to the end of its range."""
    bound = ranges.upper[axis] if turn > 0.0 else ranges.lower[axis]
    room = abs(float(bound - q_start[axis]))
    goes = min(abs(turn), room)
    end = (
        End(kind="amount") if abs(turn) <= room else ranges.end(q_start + np.sign(turn) * BEYOND * _one(q_start, axis))
    )
    share = np.linspace(0.0, 1.0, 17)
    q = q_start + share[:, None] * (math.copysign(goes, turn) * _one(q_start, axis))
    return Course(pieces=(Piece(s=share * goes, q=q),) if goes > 0.0 else (), goes=goes, end=end)


def _one(q: Array, axis: int) -> Array:
    return np.asarray(np.eye(len(q))[axis])


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolPath:
    """A jog of the tool: along (or, with ``turns``, about) a unit vector (3,) by up to ``extent`` m or rad."""

    X_start: Array
    X_flange_tool: Array
    vector: Array
    turns: bool
    extent: float

    def flange(self, s: Array) -> Array:
        """Return the poses (N, 4, 4) of the flange at s (N,)."""
        X = matmul(self.X_start, inverse(self.X_flange_tool))
        if not self.turns:
            return pose(X[:3, 3] + s[:, None] * self.vector, np.broadcast_to(X[:3, :3], (len(s), 3, 3)))
        # the tool point is the centre, and only the lever to the flange turns: no large coordinates
        R, centre = rotation_about(self.vector, s), self.X_start[:3, 3]
        return pose(centre + matmul(R, X[:3, 3] - centre), matmul(R, X[:3, :3]))

    def samples(self, step: float) -> Array:
        """Return s (N,) from 0 to the extent, at most ``step`` apart, 17 at least."""
        return np.linspace(0.0, self.extent, max(16, math.ceil(self.extent / step)) + 1)


class ToolCourse:
    """Finds the course of a jog of the tool in one configuration, that of q_start (n,)."""

    def __init__(self, kinematics: Kinematics, path: ToolPath, q_start: Array, ranges: Ranges) -> None:
        self._kinematics, self._path, self._q_start, self._ranges = kinematics, path, q_start, ranges

    def find(self, standoff: float) -> Course:
        """Return the course; where the reach ends it, ``standoff`` m or rad before.

        Where the start is at the border of several configurations, the one that leads furthest, then with the fewest
        turns of the joints: at a singularity none of them is more the arm's own than the others.
        """
        found = [self._in(branch, standoff) for branch in self._branches()]
        return max(found, key=lambda each: (round(each.goes, 6), -_length(each)))

    def _branches(self) -> list[Branch]:
        kinematics = self._kinematics
        own = kinematics.branch_of(self._q_start)
        if not kinematics.closed_form:
            return [own]
        here = self._path.flange(np.zeros(1))
        merged = []
        for branch in BRANCHES:
            q = kinematics.inverse_branch(here, branch, self._q_start)[0]
            if np.abs(kinematics.nearest_turns(q, self._q_start) - self._q_start).max() < 1e-5:
                merged.append(branch)
        return merged or [own]

    def _in(self, branch: Branch, standoff: float) -> Course:
        """Return the course in a branch."""
        closed = self._kinematics.closed_form
        step = (2.0 * DEG if self._path.turns else 5.0 * MM) * (1.0 if closed else 2.0)
        s = self._path.samples(step)
        q = self._solved(s, branch)
        s, q, end = self._cut(s, q, branch)
        s, q = self._refined(s, q, branch)
        # a limit that is passed only between the first samples shows in the finer ones
        s, q, later = self._cut(s, q, branch)
        return self._course(s, q, later if later.kind != "amount" else end, standoff)

    def _solved(self, s: Array, branch: Branch) -> Array:
        q = self._kinematics.inverse_branch(self._path.flange(s), branch, self._q_start)
        known = np.isfinite(q).all(axis=1)
        count = len(q) if known.all() else int(np.argmin(known))
        q[:count] = np.unwrap(q[:count], axis=0)
        if count:
            q[:count] += 2.0 * math.pi * np.round((self._q_start - q[0]) / (2.0 * math.pi))
            q[0] = self._q_start  # where the arm is, to the last bit
        return q

    def _near(self, s: Array, near: Array, branch: Branch) -> Array:
        """Return q (N, n) at s (N,), each next to its own ``near`` (N, n); NaN out of reach."""
        q = self._kinematics.inverse_branch(self._path.flange(s), branch, near)
        return self._kinematics.nearest_turns(q, near)

    def _cut(self, s: Array, q: Array, branch: Branch) -> tuple[Array, Array, End]:
        """Return the samples up to the last one that is in reach and in the ranges, brought next to what ends them."""
        good = self._ranges.inside(q)
        if good.all():
            return s, q, End(kind="amount")
        last = int(np.argmin(good)) - 1
        if last < 0:  # not even the start: rounding at the border of the reach
            return s[:1], self._q_start[None], End(kind="reach")
        low, high, here, beyond = float(s[last]), float(s[last + 1]), q[last], q[last + 1]
        for _ in range(12):
            if not high - low > FINEST:
                break
            # sixteen at once: one call costs little more than for one
            between = np.linspace(low, high, 18)[1:-1]
            tried = self._near(between, np.broadcast_to(here, (16, len(here))), branch)
            fine = self._ranges.inside(tried)
            count = 16 if fine.all() else int(np.argmin(fine))
            if count < 16:
                high, beyond = float(between[count]), tried[count]
            if count:
                low, here = float(between[count - 1]), tried[count - 1]
        end = self._ranges.end(beyond) if np.isfinite(beyond).all() else End(kind="reach")
        if low > s[last]:
            return np.append(s[: last + 1], low), np.concatenate([q[: last + 1], here[None]]), end
        return s[: last + 1], q[: last + 1], end

    def _refined(self, s: Array, q: Array, branch: Branch) -> tuple[Array, Array]:
        """Return samples with more between those where the joints turn far or their direction turns."""
        for _ in range(ROUNDS):
            steps = np.diff(q, axis=0)
            wide = (np.abs(steps).max(axis=1, initial=0.0) > STEP) | _bent(steps)
            wide &= np.diff(s) > FINEST
            if not wide.any() or len(s) > MOST_SAMPLES:
                break
            at = np.flatnonzero(wide)
            middle = 0.5 * (s[at] + s[at + 1])
            added = self._near(middle, 0.5 * (q[at] + q[at + 1]), branch)
            known = np.isfinite(added).all(axis=1)
            if not known.any():
                break
            s, q = np.insert(s, at[known] + 1, middle[known]), np.insert(q, at[known] + 1, added[known], axis=0)
        return s, q

    def _course(self, s: Array, q: Array, end: End, standoff: float) -> Course:
        """Return samples as pieces, up to the first jump over which the joints cannot turn while the tool stands."""
        if end.kind == "reach":
            keep = s <= max(s[-1] - standoff, 0.0)
            s, q = s[keep], q[keep]
        turned = np.abs(np.diff(q, axis=0)).max(axis=1, initial=0.0)
        jumps = np.flatnonzero((turned > STEP * (1.0 + 1e-6)) | ((turned > JUMP) & (np.diff(s) <= 2.0 * FINEST)))
        pieces: list[Piece] = []
        first = 0
        for jump in jumps.tolist():
            spot = self._on_the_spot(float(s[jump]), q[jump], q[jump + 1])
            _add(pieces, s[first : jump + 1], q[first : jump + 1])
            if spot is None:
                return Course(pieces=tuple(pieces), goes=float(s[jump]), end=End(kind="singularity"))
            pieces.append(spot)
            first = jump + 1
        _add(pieces, s[first:], q[first:])
        return Course(pieces=tuple(pieces), goes=float(s[-1]) if pieces else 0.0, end=end)

    def _on_the_spot(self, s: float, q_from: Array, q_to: Array) -> Piece | None:
        """Return the turn of the joints from q_from to q_to (n,) at which the tool stands at s; None for none."""
        turn = np.abs(q_to - q_from).max()
        share = np.linspace(0.0, 1.0, max(17, math.ceil(turn / STEP) + 1))
        q = q_from + share[:, None] * (q_to - q_from)
        if not self._ranges.inside(q).all():
            return None
        X, there = self._kinematics.forward(q), self._path.flange(np.array([s]))[0]
        off = float(np.sqrt(((X[:, :3, 3] - there[:3, 3]) ** 2).sum(axis=1)).max())
        turned = float(rotation_angles(X[:, :3, :3], np.broadcast_to(there[:3, :3], (len(X), 3, 3))).max())
        if not (off <= STILL and turned <= STILL_TURN):
            return None
        return Piece(s=np.full(len(q), s), q=q)


def _bent(steps: Array) -> Flags:
    """Return whether the direction of steps (N, n) turns by more than ``BEND`` at either end of each, (N,)."""
    lengths = np.sqrt((steps**2).sum(axis=1))
    # of steps shorter than this the direction is rounding
    long = lengths > 1e-10
    unit = steps / np.maximum(lengths, 1e-300)[:, None]
    turned = np.sqrt(((unit[1:] - unit[:-1]) ** 2).sum(axis=1)) > BEND
    turned &= long[1:] & long[:-1] & (np.maximum(lengths[1:], lengths[:-1]) > 1e-4)
    bent = np.zeros(len(steps), dtype=bool)
    bent[1:] |= turned
    bent[:-1] |= turned
    return bent


def _add(pieces: list[Piece], s: Array, q: Array) -> None:
    """Add samples as a piece, unless the arm stands at all of them."""
    moved = np.abs(np.diff(q, axis=0)).max(axis=1, initial=0.0) > 0.0
    if moved.any():
        keep = np.concatenate([[True], moved])  # samples at the same joint angles have no direction
        pieces.append(Piece(s=s[keep], q=q[keep]))


def _length(course: Course) -> float:
    """Return how far the joints turn on a course, rad."""
    return float(sum(np.sqrt((np.diff(piece.q, axis=0) ** 2).sum(axis=1)).sum() for piece in course.pieces))


def reach(kinematics: Kinematics, X_flange_tool: Array) -> float:
    """Return a length, m, within which of the base the tool point always is."""
    links = [norm(axis.placement[:3, 3]) for axis in kinematics.spec.axes]
    return sum(links) + norm(kinematics.spec.X_last_flange[:3, 3]) + norm(X_flange_tool[:3, 3])
