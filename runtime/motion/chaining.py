"""Moves in a row, each planned alone, as one motion: paths rounded in the zones, each timed as a whole.

A row of moves is cut where the arm stops: where a zone is 0, or leaves no room. What is between two stops is a
``ChainPath``; a move between two stops runs as it was planned. Called by ``MotionPlanner.join``; m, rad, s.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.chain.chain_path import ChainPath, ToolLimits
from runtime.motion.chain.corner import Corner, Rounding, roundings, woven
from runtime.motion.chain.piece import Piece
from runtime.motion.chain.timing import Limits, Path, Timed, timed
from runtime.motion.path_ik import Arm
from runtime.motion.speed_cap import PLANNED, SpeedCap
from runtime.robot.model.drives import PathLimits

_TIMES = 8
"""Timings of a path until its moves take the TIMEs that are programmed, and keep to a cap."""
_AROUND = np.linspace(-1.0, 1.0, 33)
"""Places of a corner, by its half, at which its distance from the programmed one is taken."""
_FIRMLY = 1.0 + 1e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainLimits:
    """What a chain of one robot keeps to: ``joints``, the ``path`` limits of the tool, a ``cap`` on its speed.

    ``mean_s``: the time in which accelerations build up, 0 without a limit of jerk.
    """

    joints: Limits
    path: PathLimits
    mean_s: float
    cap: SpeedCap | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Joined:
    """Rows ``q`` (N + 1, n) of a row of moves with their ``setpoints``, ``command`` (N + 1,) and ``share`` (N + 1,).

    ``command`` is the number of the move to which a row belongs, ``share`` how far that has come on its path.
    ``lasts`` (K,) is the last row of each move, and ``corners`` lie between the moves.
    """

    q: Array
    setpoints: Array
    command: NDArray[np.int32]
    share: Array
    lasts: tuple[int, ...]
    corners: tuple[Corner, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Run:
    """The rows of moves between two stops, as in ``Joined``, with ``number`` counted from the first of them."""

    q: Array
    setpoints: Array
    number: NDArray[np.intp]
    share: Array
    corners: tuple[Corner, ...] = ()


def joined(plans: Sequence[MovePlan], zones: Sequence[float], arm: Arm, limits: ChainLimits) -> Joined:
    """Return moves as one motion, rounded in the zones (m) at their ends, the last of which stops."""
    start = plans[0].q[:1]
    q, setpoints, command, share = [start], [start], [np.zeros(1, dtype=np.int32)], [np.zeros(1)]
    corners: list[Corner] = []
    for at, last, rounded in _between_stops(plans, zones, arm):
        for run in _runs(plans[at : last + 1], rounded, zones[at:last], arm, limits):
            q.append(run.q[1:])
            setpoints.append(run.setpoints[1:])
            command.append((run.number[1:] + at).astype(np.int32))
            share.append(run.share[1:])
            at += len(run.corners) + 1
            corners += [*run.corners, *(Corner(radius=zone) for zone in zones[at - 1 : at])]
    whole = np.concatenate(command)
    lasts = np.searchsorted(whole, np.arange(len(plans)), side="right") - 1
    whole[-1] = len(plans) - 1  # also where the last moves end where they start
    return Joined(
        q=np.concatenate(q),
        setpoints=np.concatenate(setpoints),
        command=whole,
        share=np.concatenate(share),
        lasts=tuple(np.maximum(lasts, 0).tolist()),
        corners=tuple(corners[: len(plans) - 1]),
    )


def _runs(
    plans: Sequence[MovePlan],
    rounded: Sequence[Rounding],
    zones: Sequence[float],
    arm: Arm,
    limits: ChainLimits,
) -> list[_Run]:
    """Return moves between two stops as one path; as moves that stop where it cannot be timed, or takes longer."""
    alone = [
        _Run(q=plan.q, setpoints=plan.setpoints, number=np.zeros(len(plan.q), dtype=np.intp), share=plan.s)
        for plan in plans
    ]
    if len(plans) == 1:
        return alone
    path = ChainPath(arm, [_piece(plan) for plan in plans], woven([_piece(plan) for plan in plans], rounded, arm))
    try:
        found = _timed(path, plans, limits)
    except Fault:
        return alone
    if len(found.x) - 1 > sum(len(plan.q) - 1 for plan in plans):
        return alone
    corners = _corners(path, zones, found.x)
    number, share = path.move_at(found.x), path.share_at(found.x)
    return [_Run(q=found.q, setpoints=found.setpoints, number=number, share=share, corners=corners)]


def _between_stops(
    plans: Sequence[MovePlan], zones: Sequence[float], arm: Arm
) -> Iterator[tuple[int, int, list[Rounding]]]:
    """Yield the first and the last move between each two stops, with the roundings between them."""
    first = 0
    for begin, end in _with_zones(plans, zones):
        found = (
            roundings([_piece(plan) for plan in plans[begin : end + 1]], zones[begin:end], arm) if end > begin else []
        )
        for k in range(begin, end + 1):
            if k == end or not found[k - begin].half > 0.0:
                yield first, k, found[first - begin : k - begin]
                first = k + 1


def _with_zones(plans: Sequence[MovePlan], zones: Sequence[float]) -> Iterator[tuple[int, int]]:
    """Yield the first and the last of moves in a row that have zones between them, and go somewhere."""
    first = 0
    for k, plan in enumerate(plans):
        runs_on = k + 1 < len(plans) and zones[k] > 0.0 and plan.piece is not None and plans[k + 1].piece is not None
        if not runs_on:
            yield first, k
            first = k + 1


def _piece(plan: MovePlan) -> Piece:
    assert plan.piece is not None
    return plan.piece


def _timed(path: ChainPath, plans: Sequence[MovePlan], limits: ChainLimits) -> Timed:
    """Return a path timed with the speeds, overrides and TIMEs of its moves; ``Fault`` RBL404 where it keeps no cap."""
    number = path.move_at(path.x)
    overrides = np.array([plan.override for plan in plans])
    tool = _tool_limits(plans, limits, number)
    bounds = path.bounds((limits.joints.speed, limits.joints.acceleration), tool, overrides)
    slower, under = np.ones(len(plans)), 1.0
    for _ in range(_TIMES):
        fastest = np.minimum(bounds.fastest, _under_cap(path, limits.cap, under)) * slower[number] ** 2
        found = timed(Path(x=path.x, bounds=bounds.replaced(fastest), joints=path.joints), limits.joints, limits.mean_s)
        factor = _too_quick(path, plans, found.x, limits.joints.period_s)
        over = 1.0 if limits.cap is None else limits.cap.ratio(limits.cap.fine.expand(found.setpoints))
        if over <= 1.0 and not (factor < 1.0).any():
            return found
        slower *= factor
        # between two points of the grid the tool may be a little faster than at both
        under /= over * _FIRMLY if over > 1.0 else 1.0
    # a TIME that is missed is found by ``plan_findings``; a cap is for the people beside the arm
    if not over <= 1.0:
        raise Fault("RBL404", "no timing of the moves keeps below the cap of MANUAL")
    return found


def _tool_limits(plans: Sequence[MovePlan], limits: ChainLimits, number: NDArray[np.intp]) -> ToolLimits:
    """Return what the tool keeps to at points that belong to moves ``number`` (M + 1,): on joint moves only a cap."""
    along = np.array([plan.path is not None for plan in plans])
    share = np.array([plan.acceleration for plan in plans])
    most = np.where(along, limits.path.acceleration * share, math.inf)
    if limits.cap is not None:
        most = np.minimum(most, limits.cap.gained)
    turning = np.where(along, limits.path.rotation_acceleration * share, math.inf)
    return ToolLimits(acceleration=most[number], turning=turning[number])


def _too_quick(path: ChainPath, plans: Sequence[MovePlan], x: Array, period_s: float) -> Array:
    """Return the share (K,) of its speed at which each move takes its TIME, 1 where it takes as long already."""
    cycles = np.interp(path.ends, x, np.arange(len(x)))
    lasts = np.diff(cycles) * period_s
    wanted = np.array([0.0 if plan.duration_s is None else plan.duration_s for plan in plans])
    # a cycle is as near as a motion in whole cycles can come
    return np.where(lasts < wanted - period_s, lasts / np.maximum(wanted, period_s), 1.0)


def _under_cap(path: ChainPath, cap: SpeedCap | None, share: float) -> Array | float:
    """Return the largest b (M + 1,) at which tool point and flange keep to a share of a cap."""
    if cap is None:
        return math.inf
    return np.asarray((share * cap.most * PLANNED / np.maximum(path.speeds(), 1e-9)) ** 2)


def _corners(path: ChainPath, zones: Sequence[float], x: Array) -> tuple[Corner, ...]:
    """Return what became of the corners of a path that is at x (N + 1,)."""
    course = path.course
    halves, middles = course.overlap.halves[1:-1], course.ends[1:-1]
    places = middles[:, None] + halves[:, None] * _AROUND
    # one after the other, since corners may overlap
    order = np.argsort(places, axis=None, kind="stable")
    points = np.empty((places.size, 3))
    points[order] = course.points(places.ravel()[order], path.joints(places.ravel()[order]))
    off = np.sqrt(((points.reshape(len(zones), -1, 3) - course.corners[:, None]) ** 2).sum(axis=2))
    cycles = np.searchsorted(x, middles + halves) - np.searchsorted(x, middles - halves, side="right")
    return tuple(
        Corner(radius=zone, cycles=int(lasts), reach=float(far), deviation=float(near))
        for zone, lasts, far, near in zip(zones, cycles, off.max(axis=1), off.min(axis=1), strict=True)
    )
