"""A zone that makes slow moves faster, found by planning them with it.

Tried on the moves about one of them, in the order of their lengths: where moves turn little, a zone that reaches over
half of each lets their corners overlap (``chain.corner``); at a sharp corner no zone reaches beyond half of the shorter
move. What is returned has been planned, so it holds. Called for the hint of a finding; m, s.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.limits import ZONE
from runtime.core.rounding import down, up
from runtime.core.units import MM, badness
from runtime.motion.chain.corner import GENTLE
from runtime.motion.commands import Command
from runtime.motion.motion_planner import ChainPlan, MotionPlanner, Part
from runtime.motion.path import turn_between

_BESIDE = 12
"""Moves before and after one that are planned again: what helps these helps the row."""
_TIMES_LENGTH = (0.6, 1.2, 2.4, 5.0)
"""Zones that are tried, as shares of the length of the middle one of the moves."""
_WIDER = 1.1
"""A zone that is tried is at least so many times as wide as what is programmed."""
_GAIN = 0.1
"""Least share of the time that a zone has to save."""
_MOST_OF_IT = 0.8
"""Share of the largest saving at which the smaller zone is better."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WiderZone:
    """A ``zone`` m with which so many ``moves`` take ``seconds`` in place of ``now_s``; the paths are ``shortest`` to
    ``longest`` m."""

    zone: float
    moves: int
    shortest: float
    longest: float
    seconds: float
    now_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """The moves of a chain between which a zone is sought: ``commands`` of ``parts``, planned with a tool (4, 4)."""

    planner: MotionPlanner
    parts: Sequence[Part]
    commands: Sequence[Command]
    X_flange_tool: Array

    @classmethod
    def about(
        cls, planner: MotionPlanner, chain: ChainPlan, commands: Sequence[Command], X_flange_tool: Array, k: int
    ) -> "Row":
        """Return the moves about move ``k`` of a chain that have zones between them."""
        first, last = k, k
        while first > max(0, k - _BESIDE) and _runs_on(chain, commands, first - 1):
            first -= 1
        while last < min(len(commands) - 1, k + _BESIDE) and _runs_on(chain, commands, last):
            last += 1
        moves = slice(first, last + 1)
        return cls(planner=planner, parts=chain.parts[moves], commands=commands[moves], X_flange_tool=X_flange_tool)

    def wider(self) -> WiderZone | None:
        """Return the smallest zone that saves most of what a wider zone can save; None: none saves a tenth."""
        zones = [command.zone for command in self.commands[:-1]]
        tried = self._tried(zones)
        if not tried:
            return None
        now_s = self._seconds(zones)
        found = [(self._seconds([max(zone, each) for each in zones]), zone) for zone in tried]
        saved = now_s - min(found)[0]
        if not saved >= _GAIN * now_s:
            return None
        seconds, zone = next(each for each in found if now_s - each[0] >= _MOST_OF_IT * saved)
        lengths = self._lengths
        return WiderZone(
            zone=zone,
            moves=len(self.parts),
            shortest=min(lengths),
            longest=max(lengths),
            seconds=seconds,
            now_s=now_s,
        )

    @property
    def _lengths(self) -> list[float]:
        return [part.path.length for part in self.parts if part.path is not None]

    def _tried(self, zones: Sequence[float]) -> list[float]:
        """Return the zones that are wider than those of the moves, and have room, rising."""
        lengths = self._lengths
        if not zones or not lengths:
            return []
        middle, room = sorted(lengths)[len(lengths) // 2], self._room()
        sizes = {up(share * middle / MM, 2) * MM for share in _TIMES_LENGTH}
        sizes = {size for size in sizes if size <= room} | ({down(room / MM, 2) * MM} if room < max(sizes) else set())
        return sorted(size for size in sizes if max(zones) * _WIDER <= size <= ZONE.high * MM)

    def _room(self) -> float:
        """Return the largest zone that every sharp corner has room for."""
        halves = []
        for before, after in itertools.pairwise(part.path for part in self.parts):
            # of joint moves there is no length to compare with
            if before is None or after is None or not turn_between(before, after) < GENTLE:
                halves += [0.5 * path.length for path in (before, after) if path is not None]
        return min(halves, key=badness, default=math.inf)

    def _seconds(self, zones: Sequence[float]) -> float:
        plans = [part.plan for part in self.parts]
        try:
            plan = self.planner.join(plans, [*zones, 0.0], self.X_flange_tool)
        except Fault:
            return math.inf
        return (len(plan.q) - 1) * self.planner.limits.joints.period_s


def _runs_on(chain: ChainPlan, commands: Sequence[Command], k: int) -> bool:
    """Return whether a move has a zone at its end, and goes somewhere as the next one does."""
    pieces = chain.parts[k].plan.piece, chain.parts[k + 1].plan.piece
    return commands[k].zone > 0.0 and None not in pieces
