"""Moves in a row, each planned alone, as one motion: paths rounded in the zones, each timed as a whole.

A row of moves is cut where the arm stops: where a zone is 0, or leaves no room. What is between two stops is a
``ChainPath``; a move between two stops runs as it was planned. More moves may follow while the last of these paths runs
(``extension``): then it goes on, and the arm does not stop. Called by ``MotionPlanner``; m, rad, s.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.units import badness
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.chain.chain_path import ChainPath
from runtime.motion.chain.corner import Corner, Rounding, roundings, woven
from runtime.motion.chain.going_on import Going
from runtime.motion.chain.paced import AT_REST, OPEN, Beginning, ChainLimits, paced
from runtime.motion.chain.piece import JointLine, Piece
from runtime.motion.chain.timing import SLACK
from runtime.motion.fine_interpolator import through
from runtime.motion.path_ik import Arm
from runtime.motion.single import single

_AROUND = np.linspace(-1.0, 1.0, 33)
"""Places of a corner, by its half, at which its distance from the programmed one is taken."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Joined:
    """Rows ``q`` (N + 1, n) of a row of moves with their ``setpoints``, ``command`` (N + 1,) and ``share`` (N + 1,).

    ``command`` is the number of the move to which a row belongs, ``share`` how far that has come on its path.
    ``lasts`` (K,) is the last row of each move, and ``corners`` lie between the moves. ``tail`` is the path that ends
    them, None where nothing can follow it without a stop.
    """

    q: Array
    setpoints: Array
    command: NDArray[np.int32]
    share: Array
    lasts: tuple[int, ...]
    corners: tuple[Corner, ...]
    tail: "Tail | None" = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Tail:
    """The path that ends a row of moves: its row 0 is ``row`` of theirs, its first piece the move number ``move``.

    ``zone``, m, is that of the last move; ``more_at`` the last row that stays when more moves follow, ``row`` where it
    is too short to change while it runs. None: none may follow without a stop.
    """

    going: Going
    row: int
    move: int
    zone: float
    more_at: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Run:
    """The rows of moves between two stops, as in ``Joined``, with ``number`` counted from the first of them."""

    q: Array
    setpoints: Array
    number: NDArray[np.intp]
    share: Array
    corners: tuple[Corner, ...] = ()
    going: Going | None = None


def joined(
    plans: Sequence[MovePlan], zones: Sequence[float], arm: Arm, limits: ChainLimits, *, more: bool = False
) -> Joined:
    """Return moves as one motion, rounded in the zones (m) at their ends, the last of which stops.

    ``more``: other moves are to follow without a stop (``extension``).
    """
    start = plans[0].q[:1]
    q, setpoints, command, share = [start], [start], [np.zeros(1, dtype=np.int32)], [np.zeros(1)]
    corners: list[Corner] = []
    tail, rows = None, 0
    for at, last, rounded in _between_stops(plans, zones, arm):
        opens = more and last == len(plans) - 1
        for run in _runs(plans[at : last + 1], rounded, zones[at:last], arm, limits, OPEN if opens else AT_REST):
            rest = rest_cycles(setpoints[-1], run.setpoints, limits) if rows else 0
            q.append(np.repeat(q[-1][-1:], rest, axis=0))
            setpoints.append(np.repeat(setpoints[-1][-1:], rest, axis=0))
            command.append(np.repeat(command[-1][-1:], rest))
            share.append(np.repeat(share[-1][-1:], rest))
            rows += rest
            q.append(run.q[1:])
            setpoints.append(run.setpoints[1:])
            command.append((run.number[1:] + at).astype(np.int32))
            share.append(run.share[1:])
            if run.going is not None and opens:
                tail = tail_of(run.going, (rows, at), zones[-1], limits)
            rows += len(run.q) - 1
            at += len(run.corners) + 1
            corners += [*run.corners, *(Corner(radius=zone) for zone in zones[at - 1 : at])]
    return Joined(
        q=np.concatenate(q),
        setpoints=np.concatenate(setpoints),
        **numbered(np.concatenate(command), len(plans)),
        share=np.concatenate(share),
        corners=tuple(corners[: len(plans) - 1]),
        tail=tail,
    )


def rest_cycles(before: Array, after: Array, limits: ChainLimits) -> int:
    """Return how many cycles of rest, 0 to 2, part set-points that stop (N, n) from those that begin there (K, n).

    Each may take the whole acceleration and jerk of a joint where the arm stands, and both together more than that.
    """
    return next((cycles for cycles in (0, 1) if _kept_together(before, cycles, after, limits)), 2)


def _kept_together(before: Array, cycles: int, after: Array, limits: ChainLimits) -> bool:
    around = np.concatenate([before[-4:], np.repeat(before[-1:], cycles, axis=0), after[1:4]])
    worst = 0.0
    for limit, power in ((limits.joints.acceleration, 2), (limits.joints.jerk, 3)):
        steps = np.abs(np.diff(around, power, axis=0)) / (limit * limits.joints.period_s**power)
        worst = max(worst, float(steps.max(initial=0.0)), key=badness)
    return worst <= SLACK


class Numbered(TypedDict):
    """The moves to which rows belong, and the last row of each, as in ``Joined``."""

    command: NDArray[np.int32]
    lasts: tuple[int, ...]


def numbered(command: NDArray[np.int32], moves: int) -> Numbered:
    """Return the moves to which rows belong, with the last row of each."""
    lasts = np.searchsorted(command, np.arange(moves), side="right") - 1
    command[-1] = moves - 1  # also where the last moves end where they start
    return {"command": command, "lasts": tuple(np.maximum(lasts, 0).tolist())}


def tail_of(going: Going, begins: tuple[int, int], zone: float, limits: ChainLimits) -> Tail:
    """Return a path, which begins at a row and a move of a row of moves, as their tail; the last has a ``zone``, m."""
    row, move = begins
    at = going.more_at(zone, limits.joints.period_s) if zone > 0.0 else None
    # what is in motion already cannot begin anew
    if at is None and zone > 0.0 and not going.timed.law.t[0] < 0.0:
        at = 0
    return Tail(going=going, row=row, move=move, zone=zone, more_at=None if at is None else row + at)


def _runs(
    plans: Sequence[MovePlan],
    rounded: Sequence[Rounding],
    zones: Sequence[float],
    arm: Arm,
    limits: ChainLimits,
    beginning: Beginning,
) -> list[_Run]:
    """Return moves between two stops as one path; as moves that stop where it cannot be timed, or takes longer."""
    if plans[0].piece is None or (len(plans) == 1 and not beginning.open):
        return [_alone(plans[0], arm, limits)]
    pieces = [piece_of(plan) for plan in plans]
    path = ChainPath(arm, pieces, woven(pieces, rounded, arm))
    try:
        found = paced(path, limits, beginning)
    except Fault:
        return [_alone(plan, arm, limits) for plan in plans]
    # but for splines, drafts are never longer than what they stand for; and what goes on does not stop at its end
    if len(found.x) - 1 > _cycles(plans) and not beginning.open:
        alone = [_alone(plan, arm, limits) for plan in plans]
        if len(found.x) - 1 > _cycles(alone):
            return alone
    going = Going.from_rest(path, found)
    number, share = path.move_at(found.x), path.share_at(found.x)
    corners = corners_of(going, zones)
    return [_Run(q=found.q, setpoints=found.setpoints, number=number, share=share, corners=corners, going=going)]


def _cycles(moves: Sequence[MovePlan | _Run]) -> int:
    return sum(len(move.q) - 1 for move in moves)


def _alone(plan: MovePlan, arm: Arm, limits: ChainLimits) -> _Run:
    """Return a move that stops at both ends; ``Fault`` as of ``single``."""
    s, q = plan.s, plan.q
    if plan.draft:
        assert plan.piece is not None  # it goes somewhere
        curve = plan.piece.curve
        assert not isinstance(curve, JointLine)  # a joint move is never a draft
        s, q, _ = single(curve, plan.piece, (s, q), arm, limits)
    setpoints = q if plan.path is None else through(q)
    return _Run(q=q, setpoints=setpoints, number=np.zeros(len(q), dtype=np.intp), share=s)


def _between_stops(
    plans: Sequence[MovePlan], zones: Sequence[float], arm: Arm
) -> Iterator[tuple[int, int, list[Rounding]]]:
    """Yield the first and the last move between each two stops, with the roundings between them."""
    first = 0
    for begin, end in _with_zones(plans, zones):
        found = (
            roundings([piece_of(plan) for plan in plans[begin : end + 1]], zones[begin:end], arm) if end > begin else []
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


def piece_of(plan: MovePlan) -> Piece:
    """Return the piece of a plan that goes somewhere."""
    assert plan.piece is not None
    return plan.piece


def corners_of(going: Going, zones: Sequence[float]) -> tuple[Corner, ...]:
    """Return what became of the corners of a path as it runs; ``zones`` m are those programmed."""
    path, x, course = going.path, going.x, going.path.course
    if not len(zones):
        return ()
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
