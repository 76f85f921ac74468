"""A path that runs, and goes on over more moves without a stop.

What runs is a ``Going``: a path, and how it was timed up to its end, where the arm would stop. From one of its rows on
it is timed anew (``gone_on``):

    geometry   moves that still run, and all corners that begin before the moment of the change, stay as they are
    grid       the points of the path up to there stay; so do the shares of speed and acceleration that it takes there
    law        that of the motion up to the moment of the change, then the fastest one, with the same mean over T

The motion to the stop is one of those of which the new one is the fastest. Called by ``extension``; m, rad, s.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.chain.chain_path import ChainPath
from runtime.motion.chain.corner import Rounding, woven
from runtime.motion.chain.grid import with_point
from runtime.motion.chain.paced import Beginning, ChainLimits, paced
from runtime.motion.chain.piece import Piece
from runtime.motion.chain.timing import SLACK, Begun, Shares, Timed

LEAD = 16
"""Cycles between the last row that stays and the moment of a change: the set-points between them are those of before,
up to rounding."""
_AHEAD_S = 2.0
"""Time before its stop at which a motion goes on over more moves, s: it does not brake there yet."""
_MARGIN = 4
"""Points of the grid beside the moment of a change at which the path stays as it is."""
_SETTLING = 8
"""Cycles, beside T, before its last braking in which the shares of a motion belong to its stop."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Going:
    """A path as it runs: ``timed`` up to its end, after rows at places ``before`` (B,), the last with ``sent`` (3, n).

    Row 0 is that of ``timed``; ``sent`` are the set-points of rows -3 to -1.
    """

    path: ChainPath
    timed: Timed
    before: Array
    sent: Array

    @classmethod
    def from_rest(cls, path: ChainPath, found: Timed) -> "Going":
        """Return a path that begins at rest."""
        return cls(path=path, timed=found, before=np.zeros(0), sent=np.repeat(found.setpoints[:1], 3, axis=0))

    @property
    def x(self) -> Array:
        """Places (B + N + 1,) of all rows that are known."""
        return np.concatenate([self.before, self.timed.x])

    def more_at(self, zone: float, period_s: float) -> int | None:
        """Return the last row that stays when it goes on over more moves; ``zone`` m at its end. None: it ends."""
        law, path = self.timed.law, self.path
        # a corner that is being passed keeps its size, so none of them may depend on what follows
        latest = np.flatnonzero(path.x < self._settled(zone))
        if len(latest) <= _MARGIN:
            return None
        there = float(np.interp(path.x[latest[-_MARGIN - 1]], law.x, law.t))
        row = int(min(there, law.seconds - min(_AHEAD_S, 0.5 * law.seconds)) / period_s) - LEAD
        return row if row > 0 else None

    def _settled(self, zone: float) -> float:
        """Return the place up to which corners stay as they are when more moves follow."""
        pieces, ends = self.path.pieces, self.path.ends
        # m of the path in a m of the zone; of a joint move that is not known
        wide = np.array([1.0 if p.path is None else p.extent / (p.path.length or p.extent) for p in pieces])
        zones = np.array([*(each.zone for each in self.path.roundings), zone]) * np.maximum(wide, 1.0)
        return float((ends[1:] - zones)[ends[1:] + zones > ends[-1]].min())


def gone_on(
    going: Going,
    row: int,
    lead: int,
    more: tuple[Sequence[Piece], Sequence[Rounding]],
    limits: ChainLimits,
) -> tuple[Going, int]:
    """Return the motion that goes on, its row 0 being ``row``, and how many of its first pieces are left out.

    The change is ``lead`` cycles after the row. ``more`` are pieces (J,), and the corner before each of them. ``Fault``
    RBL404 where no timing is found.
    """
    found, path, h = going.timed, going.path, limits.joints.period_s
    # what can still be changed: the mean over T carries the rest on
    law = found.law.until(min((row + lead) * h, found.law.seconds))
    seam = float(law.x[-1])
    at = int(np.searchsorted(path.x, seam))
    if not (at + _MARGIN + 1 < len(path.x) and law.v[-1] > 0.0):
        raise Fault("RBL404", "the motion is at its end")
    halves = path.course.overlap.halves
    first = int(np.flatnonzero(path.ends[:-1] + halves[:-1] <= found.x[row])[-1])
    offset, last = float(path.ends[first]), float(path.x[at + _MARGIN])
    pieces, roundings = [*path.pieces[first:], *more[0]], [*path.roundings[first:], *more[1]]
    # the mean over a shorter time would pass the jerk of the new moves
    if not limits.mean_s(pieces) <= found.mean_s * SLACK:
        raise Fault("RBL404", "the moves that follow build up their accelerations in a longer time")
    begun_corners = int(np.count_nonzero(path.ends[1:-1] - halves[1:-1] < last))
    roundings = woven(pieces, roundings, path.arm, stay=max(begun_corners - first, 0), after=last - offset)
    # in other points of the grid the same path would have other bounds
    kept = with_point(path.x[: at + _MARGIN + 1], seam)
    longer = ChainPath(path.arm, pieces, roundings, kept[kept >= offset] - offset)
    shares = _shares(found, found.mean_s + _SETTLING * h)
    sent = np.concatenate([going.sent, found.setpoints[: row + 1]])[-4:]
    places = going.x[: len(going.before) + row + 1] - offset
    begun = Begun(
        law=law.since(row * h - found.mean_s - h).counted(offset, row * h),
        at=int(np.searchsorted(longer.x, seam - offset)),
        x=np.concatenate([np.repeat(places[:1], 3), places])[-4:],
        setpoints=sent,
        shares=replace(shares, x=shares.x - offset),
        mean_s=found.mean_s,
    )
    # the pieces that are left know when they began
    before = places[max(int(np.searchsorted(places, 0.0)) - 1, 0) : -1]
    # the whole T, as what runs: a shorter one would not be a mean of both
    found = paced(longer, limits, Beginning(begun=begun, before=before, open=True))
    return Going(path=longer, timed=found, before=before, sent=sent[:3]), first


def _shares(found: Timed, settling_s: float) -> Shares:
    """Return the shares with which a motion goes on: those that it was timed with, without those of its stop."""
    # the last braking begins where the speed falls for the last time
    v, law = found.law.v, found.law
    falls = len(v) - 1 - int(np.argmin(np.append((v[:-1] >= v[1:])[::-1], False)))
    stop = float(np.interp(float(law.t[falls]) - settling_s, law.t, law.x))
    stays = found.shares.x < stop
    return replace(
        found.shares,
        speed=np.where(stays, found.shares.speed, 1.0),
        acceleration=np.where(stays, found.shares.acceleration, 1.0),
    )
