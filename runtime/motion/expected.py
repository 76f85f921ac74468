"""The time that a reader of a program expects of its moves: their speeds, with ramps where a speed changes.

Corners, joints and the turning of the tool are not in it: where a plan takes longer, one of them is the reason. The
speeds at the ends of moves are those of a look-ahead over the stretch between two stops, with the acceleration of the
path; a ramp takes half of the time more in which its acceleration builds up. Called by ``Speeds``; m, s.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from runtime.core.units import badness

_HALVINGS = 20
"""A speed to a millionth of the programmed one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Programmed:
    """A move as a reader takes it: ``length`` m, ``speed`` m/s, ``acceleration`` m/s2, ``rise_s`` s to build that up.

    ``speed`` infinite: any, as of a joint move; its time is not computed.
    """

    length: float
    speed: float
    acceleration: float
    rise_s: float


def expected_s(stretch: Sequence[Programmed], start: float = 0.0) -> list[float]:
    """Return the times, s, of moves from ``start`` m/s to the next stop; 0 for those of no programmed speed."""
    count = len(stretch)
    # squared speeds at the ends of moves
    most = [min(a.speed, b.speed, key=badness) ** 2 for a, b in itertools.pairwise(stretch)]
    ends = [min(start, stretch[0].speed, key=badness) ** 2, *most, 0.0]
    for k in range(count):
        ends[k + 1] = min(ends[k + 1], _gained(ends[k], stretch[k]))
    for k in reversed(range(count)):
        ends[k] = min(ends[k], _gained(ends[k + 1], stretch[k]))
    return [
        _seconds(move, math.sqrt(first), math.sqrt(last)) if math.isfinite(move.speed) else 0.0
        for move, first, last in zip(stretch, ends, ends[1:], strict=False)
    ]


def slower(move: Programmed, seconds: float) -> float:
    """Return a speed, m/s, at most that of a move between two stops, from which so many seconds are expected."""
    # by halving: which ramps there are depends on the speed
    low, high = 0.0, move.speed
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        takes = expected_s([replace(move, speed=middle)])[0]
        low, high = (middle, high) if takes >= seconds else (low, middle)
    return low


def _gained(squared: float, move: Programmed) -> float:
    """Return the largest squared speed at one end of a move from that at the other end."""
    return squared + 2.0 * move.acceleration * move.length if math.isfinite(move.speed) else math.inf


def _seconds(move: Programmed, first: float, last: float) -> float:
    """Return the time of a move, s, from one speed to another, as fast as its own speed and acceleration allow."""
    if not move.length > 0.0:
        return 0.0
    peak = math.sqrt(0.5 * (first**2 + last**2) + move.acceleration * move.length)
    # a speed at an end is never above that of the move: the two of a corner bound it
    top = max(min(move.speed, peak, key=badness), first, last, key=badness)
    ramps = ((top - first), (top - last))
    passed = (top**2 - 0.5 * (first**2 + last**2)) / move.acceleration
    even = max(move.length - passed, 0.0, key=badness)
    builds_up = sum(0.5 * move.rise_s for ramp in ramps if not ramp <= 0.0)
    return sum(ramps) / move.acceleration + even / top + builds_up
