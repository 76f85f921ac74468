"""A row of moves that goes on over more of them while it runs, so that it may be longer than what is planned ahead.

The rows up to one that the arm has reached stay; from there on the last path is timed anew over the moves that follow
(``chain.going_on``). Called by ``MotionPlanner.extend``; m, rad, s.
"""

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.chain.corner import Corner, Rounding, roundings
from runtime.motion.chain.going_on import LEAD, Going, gone_on
from runtime.motion.chain.paced import ChainLimits
from runtime.motion.chain.piece import Piece
from runtime.motion.chaining import Joined, Tail, corners_of, joined, numbered, piece_of, rest_cycles, tail_of
from runtime.motion.path_ik import Arm

_LATER = 25
"""Cycles by which the change is later where it cannot be at the moment before."""
_MOMENTS = 4


def extended(
    chain: Joined,
    at: int,
    plans: Sequence[MovePlan],
    zones: Sequence[float],
    arm: Arm,
    limits: ChainLimits,
) -> tuple[Joined, int]:
    """Return a row of moves that goes on over more of them, and how many of its moves are left out.

    ``plans`` (K + J,) are those of its moves and of the J that follow, whose ``zones`` (J,) m are at their ends. Row
    ``at`` is the last that stays; what is left out has ended before it. ``Fault`` RBL404 where the motion cannot go on:
    the row of moves stops where it does.
    """
    tail = chain.tail
    if tail is None or not zones:
        raise Fault("RBL404", "nothing follows the motion without a stop")
    if at == tail.row:
        return _from_rest(chain, tail, plans, zones, arm, limits)
    more = _following(tail, plans[-len(zones) :], zones, arm)
    going, first = _gone_on(tail, at, more, limits)
    move, count = tail.move + first, len(more[0])
    # the moves of the path that are over stay in it, so that its first corners keep their numbers
    left_out = min(move, int(chain.command[at]))
    move -= left_out
    begins = chain.lasts[left_out - 1] if left_out else 0
    grown = Joined(
        **_rows(_part(chain, slice(begins, at + 1), left_out), _after_row_0(going, move)),
        lasts=(),
        corners=(
            *chain.corners[left_out : left_out + move],
            *corners_of(going, [r.zone for r in going.path.roundings]),
        ),
        tail=tail_of(going, (at - begins, move), zones[count - 1], limits),
    )
    # what follows a stop begins from rest there, planned as any other row of moves
    rest = plans[len(plans) - len(zones) + count :]
    if rest:
        grown = _then(grown, zones[count - 1], joined(rest, zones[count:], arm, limits, more=True), limits)
    return replace(grown, **numbered(grown.command, len(plans) - left_out)), left_out


def _from_rest(
    chain: Joined, tail: Tail, plans: Sequence[MovePlan], zones: Sequence[float], arm: Arm, limits: ChainLimits
) -> tuple[Joined, int]:
    """Return a row of moves whose last path begins at rest, and does so anew with more moves."""
    left_out = min(tail.move, int(chain.command[tail.row]))
    begins = chain.lasts[left_out - 1] if left_out else 0
    # nothing of the path has been run: all of its corners may become as large as what follows lets them
    whole = [*(each.zone for each in tail.going.path.roundings), tail.zone, *zones]
    rest = joined(plans[tail.move :], whole, arm, limits, more=True)
    if not tail.move > left_out:
        return rest, left_out
    kept = Joined(
        **_rows(_part(chain, slice(begins, tail.row + 1), left_out)),
        lasts=(),
        corners=chain.corners[left_out : tail.move - 1],
    )
    grown = _then(kept, chain.corners[tail.move - 1].radius, rest, limits)
    return replace(grown, **numbered(grown.command, len(plans) - left_out)), left_out


def _following(
    tail: Tail, plans: Sequence[MovePlan], zones: Sequence[float], arm: Arm
) -> tuple[list[Piece], list[Rounding]]:
    """Return the pieces that follow without a stop, and the corner before each; ``Fault`` RBL404 for none."""
    pieces = [piece_of(plan) for plan in itertools.takewhile(lambda plan: plan.piece is not None, plans)]
    last = tail.going.path.pieces[-1]
    found = roundings([last, *pieces], [tail.zone, *zones][: len(pieces)], arm)
    count = next((k for k, each in enumerate(found) if not each.half > 0.0), len(found))
    if not count:
        raise Fault("RBL404", "the zone leaves no room for a corner")
    return pieces[:count], found[:count]


def _gone_on(tail: Tail, at: int, more: tuple[list[Piece], list[Rounding]], limits: ChainLimits) -> tuple[Going, int]:
    """Return the path as it goes on, changed as early as one is found, and how many of its first pieces are over."""
    for moment in range(_MOMENTS):
        try:
            return gone_on(tail.going, at - tail.row, LEAD + moment * _LATER, more, limits)
        except Fault as fault:
            refused = fault
    raise refused


class _Rows(TypedDict):
    """Joints, set-points, numbers of moves and shares of them, as in ``Joined``."""

    q: Array
    setpoints: Array
    command: NDArray[np.int32]
    share: Array


def _rows(*parts: _Rows) -> _Rows:
    """Return the rows of all parts."""
    return {
        "q": np.concatenate([part["q"] for part in parts]),
        "setpoints": np.concatenate([part["setpoints"] for part in parts]),
        "command": np.concatenate([part["command"] for part in parts]),
        "share": np.concatenate([part["share"] for part in parts]),
    }


def _part(chain: Joined, kept: slice, less: int) -> _Rows:
    """Return rows of a row of moves, the numbers of which are so many less; the first may be one of a move before."""
    command = np.maximum(chain.command[kept] - less, 0).astype(np.int32)
    return {"q": chain.q[kept], "setpoints": chain.setpoints[kept], "command": command, "share": chain.share[kept]}


def _after_row_0(going: Going, move: int) -> _Rows:
    """Return the rows after row 0 of a path whose first piece is a move of that number."""
    found, path, x = going.timed, going.path, going.timed.x[1:]
    command = (path.move_at(x) + move).astype(np.int32)
    return {"q": found.q[1:], "setpoints": found.setpoints[1:], "command": command, "share": path.share_at(x)}


def _then(first: Joined, zone: float, rest: Joined, limits: ChainLimits) -> Joined:
    """Return a row of moves that stops, and another one from there."""
    for _ in range(rest_cycles(first.setpoints, rest.setpoints, limits)):
        first = replace(first, **_rows(_part(first, slice(None), 0), _part(first, slice(-1, None), 0)))
    rows, moves = len(first.q) - 1, len(first.corners) + 1
    tail = rest.tail
    if tail is not None:
        at = None if tail.more_at is None else tail.more_at + rows
        tail = replace(tail, row=tail.row + rows, move=tail.move + moves, more_at=at)
    return Joined(
        **_rows(_part(first, slice(None), 0), _part(rest, slice(1, None), -moves)),
        lasts=(),
        corners=(*first.corners, Corner(radius=zone), *rest.corners),
        tail=tail,
    )
