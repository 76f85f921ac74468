"""When the moves of a planned chain begin and end, how long they take, and how long they are expected to.

Of the rows and the programmed values alone, without kinematics: cheap enough to be computed for every chain that runs.
m, rad, s.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from runtime.core.frames import Array
from runtime.core.units import badness
from runtime.motion.commands import Command, MoveJoint
from runtime.motion.expected import Programmed, expected_s, slower
from runtime.motion.motion_planner import ChainPlan, Part
from runtime.robot.model.drives import PathLimits

SLOWED = 1.2
"""A move that takes this many times as long as expected is slow. A bead is then a fifth thicker, which shows."""
_ROUNDING = 1.0 + 1e-6
"""Cycles by which a TIME may be passed."""
_AT_SPEED = 1.02
"""A chain that begins with this much less than its speed has it: a ramp of nothing would take the time to build up."""
_IN_PLACE = 1e-3
"""A tool whose point moves less than this, m, and turns, turns in place: its speed along the path says nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Span:
    """The cycles ``first`` to before ``last`` of a move, and the continuous cycles at which it begins and ends."""

    first: int
    last: int
    begins: float
    ends: float


class MoveTimes:
    """The times of the moves of one chain, planned for ``commands`` under an override of all, a cycle ``period_s``."""

    def __init__(
        self, chain: ChainPlan, commands: Sequence[Command], limits: PathLimits, period_s: float, override: float
    ) -> None:
        self._chain, self._commands, self._limits = chain, commands, limits
        self.period_s, self._override = period_s, override

    @cached_property
    def stretches(self) -> tuple[range, ...]:
        """The moves between every two stops."""
        # by its reach: a tiny corner at a high speed has no row within it and is none the less passed
        stops = [k + 1 for k, corner in enumerate(self._chain.corners) if not corner.reach > 0.0]
        edges = [0, *stops, len(self._commands)]
        return tuple(range(first, last) for first, last in pairwise(edges))

    @cached_property
    def extents(self) -> Array:
        """The length (K,) that each move counts, m; 0 of one that has nothing to do."""
        plans = [part.plan for part in self._chain.parts]
        return np.array([0.0 if plan.piece is None else plan.piece.extent for plan in plans])

    @cached_property
    def ends(self) -> Array:
        """The places (K + 1,) at which the moves begin and the last one ends, m."""
        return np.concatenate([[0.0], np.cumsum(self.extents)])

    @cached_property
    def x(self) -> Array:
        """How far the chain has come at each row (N + 1,), m."""
        # by shares, since tool points in a corner are on neither path
        x = np.zeros(len(self._chain.q))
        for part, start, extent in zip(self._chain.parts, self.ends[:-1], self.extents, strict=True):
            x[part.first + 1 : part.last + 1] = start + part.s[1:] * extent
        return np.maximum.accumulate(x)

    @cached_property
    def spans(self) -> tuple[Span, ...]:
        """The cycles of each move."""
        rows = np.arange(len(self.x), dtype=np.float64)
        bounds = np.interp(self.ends, self.x, rows)
        # moves that end where they start have no rows of their own
        bounds[0], bounds[-1] = self._first_begins, rows[-1]
        return tuple(map(self._span, self._chain.parts, bounds[:-1].tolist(), bounds[1:].tolist()))

    def _span(self, part: Part, begins: float, ends: float) -> Span:
        # rows of its own, if there are any: a cycle that a faster neighbour shares is not its speed
        first, last = part.first + (begins > part.first + 0.5), part.last
        if last <= first:
            first = max(min(int(begins), len(self.x) - 2), 0)
            last = first + 1
        return Span(first=first, last=last, begins=begins, ends=ends)

    def seconds(self, k: int) -> float:
        """Return the time of a move, s."""
        return (self.spans[k].ends - self.spans[k].begins) * self.period_s

    def programmed(self, k: int) -> float | None:
        """Return the programmed speed of a move, m/s or a share of the joints' speeds; None: it has none."""
        command = self._commands[k]
        if command.duration is not None or self._in_place(k):
            return None
        if isinstance(command, MoveJoint):
            return (1.0 if command.speed is None else command.speed) * self.override(k)
        return (command.speed or self._limits.default_speed) * self.override(k)

    def override(self, k: int) -> float:
        """Return the share of all speeds that a move has."""
        return self._commands[k].override * self._override

    def _in_place(self, k: int) -> bool:
        path = self._chain.parts[k].path
        return path is not None and path.length < _IN_PLACE and self.extents[k] > 2.0 * path.length

    def late(self, k: int) -> bool:
        """Return whether a move does not keep its TIME, or takes far longer than its speed lets expect."""
        duration = self._commands[k].duration
        if duration is not None:
            # a move takes whole cycles
            return not self.seconds(k) <= duration / self.override(k) + self.period_s * _ROUNDING
        expected = self.expected_s[k]
        return expected > 0.0 and not self.seconds(k) <= SLOWED * max(expected, self.period_s, key=badness)

    @cached_property
    def expected_s(self) -> list[float]:
        """What the speed of each move and the accelerations of the path let expect, s; 0 where no path is."""
        moves = [self._as_programmed(k) for k in range(len(self._commands))]
        return [
            time
            for k, stretch in enumerate(self.stretches)
            for time in expected_s(moves[stretch.start : stretch.stop], self._start_speed if k == 0 else 0.0)
        ]

    @property
    def _start_speed(self) -> float:
        """The speed at which the chain begins, m/s along the path of its first move."""
        path, extent = self._chain.parts[0].path, float(self.extents[0])
        if not self._chain.moving or path is None or not extent > 0.0:
            return 0.0
        return _AT_SPEED * self._first_step / self.period_s * path.length / extent

    @property
    def _first_step(self) -> float:
        """The length, m, of the first cycles of a chain that begins in motion."""
        # row 0 is one of the move before, whose place on this one is not known
        return float(np.diff(self.x[:3]).max())

    @property
    def _first_begins(self) -> float:
        """The continuous cycle at which the first move begins."""
        if not self._chain.moving or not self._first_step > 0.0:
            return 0.0
        return float(np.clip(1.0 - self.x[1] / self._first_step, 0.0, 1.0))

    def slower(self, k: int) -> float:
        """Return the speed, m/s, without override, that lets a move between two stops expect the time it takes."""
        return slower(self._as_programmed(k), self.seconds(k)) / self.override(k)

    def _as_programmed(self, k: int) -> Programmed:
        path, limits = self._chain.parts[k].path, self._limits
        speed = None if path is None else self.programmed(k)
        return Programmed(
            length=0.0 if path is None else path.length,
            speed=np.inf if speed is None else speed,
            # no more than the usual acceleration: that a path is short is no fault
            acceleration=limits.acceleration * min(self._commands[k].acceleration, 1.0, key=badness),
            rise_s=limits.acceleration / limits.jerk,
        )
