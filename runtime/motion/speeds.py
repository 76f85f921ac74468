"""How fast the moves of a planned chain are and what keeps them from their speeds, judged from the rows of the plan.

Nothing of how the rows were timed is used. A move that reaches less than ``REACHED`` of its speed gets the first reason
that holds; a share of ``NEAR`` and more of a limit (``limit_use``) is at the limit:

    1  where it is fastest: the cap of MANUAL, the speed of a joint, the turning of the tool
    2  there, too: the acceleration or jerk of a joint or, on a bend, that of the tool; within a corner it is the corner
    3  the ramps that lead there begin or end where a curve doubles back
    4  on these ramps: the acceleration or jerk of a joint, or the turning, oftener than the tool's own
    5  where these ramps begin or end: a corner, or another slow place; else a stop: the path is too short

Computed when it is read first, for all moves of a chain in one call: only those who show it pay for it. m, rad, s.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.commands import Command
from runtime.motion.limit_use import QUANTITIES, LimitUse, Taken, limit_use
from runtime.motion.motion_planner import ChainPlan, MotionPlanner
from runtime.motion.move_times import SLOWED, MoveTimes
from runtime.motion.path import LinePath
from runtime.motion.reached import Kind, Reached, Why
from runtime.motion.reasons import Limit, Reasons
from runtime.motion.speed_cap import PLANNED
from runtime.motion.spline_path import SplinePath
from runtime.motion.wider_zones import Row, WiderZone

REACHED = 0.98
"""A speed is reached at this share of it: the rest is rounding to whole cycles, and nobody sees it."""
NEAR = 0.95
"""A limit is taken at this share of it: plans keep a little below, by whole cycles and by the grid of their path."""
_DIP = 0.05
"""Share by which a speed falls and rises again at a slow place."""
_SLOWER = 0.9
"""A corner that is passed at less of the speed of a move keeps it slow."""
_RAMP = 0.3
"""Share of the acceleration of the path from which on a move gains or loses speed, and does not go on evenly."""
_HALF = 0.5
"""Share of the acceleration of the path that a ramp takes at least, where nothing else keeps it low."""
_EVEN, _LONG = 0.03, 0.4
"""Speeds within this share are alike, and those of this share of the time last: a peak between two ramps is shorter."""
_STRAIGHT = 1e-3
"""Share of its reach by which a corner of two pieces of one line misses the corner, at most."""
_CUSP = 1e-3
"""A curve that doubles back within so many m of a slow place is slow for it."""
_BESIDE = 2.0
"""Cycles beside a corner or a stop that belong to it."""


class Speeds:
    """Judges the moves of one chain that ``planner`` has planned for ``commands``, with a tool and an override.

    ``cap`` m/s is that of the plan, None without one.
    """

    def __init__(
        self,
        planner: MotionPlanner,
        chain: ChainPlan,
        commands: Sequence[Command],
        X_flange_tool: Array,
        override: float = 1.0,
        cap: float | None = None,
    ) -> None:
        self._planner, self._commands = planner, commands
        self.chain = chain
        """The plan that is judged."""
        self._X_flange_tool, self._cap = X_flange_tool, cap
        limits = planner.limits
        self.times = MoveTimes(chain, commands, planner.spec.path, limits.joints.period_s, override)
        """The times of the moves."""

    def __eq__(self, other: object) -> bool:
        # plans are kept and never changed: a run that is taken back comes to the same one again
        return isinstance(other, Speeds) and self.chain is other.chain and self._cap == other._cap

    def __hash__(self) -> int:
        return hash((id(self.chain), self._cap))

    @cached_property
    def moves(self) -> tuple[Reached, ...]:
        """What became of the speed of each move."""
        extents = self.times.extents.tolist()
        found = tuple(self._judged(k) if extent > 0.0 else _nothing() for k, extent in enumerate(extents))
        # a long run keeps the speeds of every chain, and needs no more than what was found
        for measured in ("_use", "_valleys"):
            self.__dict__.pop(measured, None)
        return found

    @cached_property
    def slowed(self) -> Mapping[int, tuple[int, ...]]:
        """The moves with a SPEED that are slow between every two stops, by the one of them that loses most time.

        A corner or a ramp is what it is: moves that are slow for one count where the whole row of moves is slow.
        """
        rows = (self._slow_moves(stretch) for stretch in self.times.stretches)
        return {max(row, key=self._lost): row for row in rows if row}

    def _slow_moves(self, stretch: range) -> tuple[int, ...]:
        late = [k for k in stretch if self._commands[k].speed is not None and self._late(k)]
        # kinematics only where a move is late at all
        if late and not self._slow_as_a_whole(stretch):
            late = [k for k in late if self._within(k)]
        return tuple(late)

    def _lost(self, k: int) -> float:
        return self.times.seconds(k) - self.times.expected_s[k]

    def wider_zone(self, k: int) -> WiderZone | None:
        """Return a zone that makes move ``k`` and those beside it faster, found by planning; None: none does."""
        return Row.about(self._planner, self.chain, self._commands, self._X_flange_tool, k).wider()

    def seconds_at(self, k: int, speed: float) -> float | None:
        """Return the time, s, that a move between two stops takes with another SPEED, m/s; None: that is not kept."""
        command = replace(self._commands[k], speed=speed)
        override = self.times.override(k) / command.override
        start, planner, X_flange_tool = self.chain.parts[k].plan.q[0], self._planner, self._X_flange_tool
        try:
            chain = planner.chain(start, [command], X_flange_tool, override)
        except Fault:
            return None
        times = Speeds(planner, chain, [command], X_flange_tool, override).times
        return None if times.late(0) else times.seconds(0)

    def late_for_time(self, k: int) -> bool:
        """Return whether a move with a TIME does not keep it; under a cap a TIME is not what is programmed."""
        return self._cap is None and self._commands[k].duration is not None and self.times.late(k)

    def _late(self, k: int) -> bool:
        return self._cap is None and self._commands[k].duration is None and self.times.late(k)

    def _within(self, k: int) -> bool:
        """Return whether a slow move is so within itself, and not for a corner or a ramp."""
        why = self.moves[k].why
        return why is not None and why.kind in ("joint", "turning", "radius", "tool")

    def _slow_as_a_whole(self, stretch: range) -> bool:
        known = [k for k in stretch if self.times.expected_s[k] > 0.0]
        return sum(map(self.times.seconds, known)) > SLOWED * sum(self.times.expected_s[k] for k in known)

    # --- what the plan holds -----------------------------------------------------------------------------------------

    @cached_property
    def _use(self) -> LimitUse:
        spec, parts = self._planner.spec, self.chain.parts
        number = self.chain.command[1:]
        along = np.array([part.path is not None for part in parts])
        share = np.array([command.acceleration for command in self._commands])
        most = np.where(along, share, np.inf)
        taken = Taken(
            q=self.chain.q,
            setpoints=self.chain.setpoints,
            override=np.array([part.plan.override for part in parts])[number],
            acceleration=(spec.path.acceleration * most)[number],
            turning_speed=np.where(along, spec.path.rotation_speed, np.inf)[number],
            turning_acceleration=(spec.path.rotation_acceleration * most)[number],
            cap=np.inf if self._cap is None else self._cap * PLANNED,
            X_flange_tool=self._X_flange_tool,
            moving=self.chain.moving,
        )
        return limit_use(taken, self._planner.kinematics, self._planner.limits.joints)

    @cached_property
    def _valleys(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """The slow places, as cycles, of the tool point and of the joints."""
        return _slow_places(self._use.tool), _slow_places(self._use.joint_speed)

    # --- one move ----------------------------------------------------------------------------------------------------

    def _judged(self, k: int) -> Reached:
        times, span = self.times, self.times.spans[k]
        programmed = times.programmed(k)
        highest = float(self._pace(k)[span.first : span.last].max())
        reached = highest if programmed is None else min(highest, programmed)
        short = programmed is not None and not reached >= (NEAR if self._joint_move(k) else REACHED) * programmed
        timed = self._commands[k].duration is not None
        why = self._why(k, fastest=short or timed) if short or times.late(k) else None
        return Reached(
            programmed=programmed,
            reached=reached,
            seconds=times.seconds(k),
            expected_s=times.expected_s[k],
            why=why,
            of_joints=self._joint_move(k),
        )

    def _joint_move(self, k: int) -> bool:
        return self.chain.parts[k].path is None

    def _slow_places(self, k: int) -> NDArray[np.intp]:
        return self._valleys[self._joint_move(k)]

    def _pace(self, k: int) -> Array:
        """Return what the speed of a move is measured by, in all cycles (N,)."""
        return self._use.joint_speed if self._joint_move(k) else self._use.tool

    def _why(self, k: int, *, fastest: bool) -> Why:
        """Return why a move is slow: at its ``fastest`` cycle, or where it is slowest between two stops."""
        span, pace = self.times.spans[k], self._pace(k)
        at = span.first + int(np.argmax(pace[span.first : span.last]))
        if not fastest:
            ramps = (slice(span.first, at + 1), slice(at, span.last))
            found = self._at_cusp(k, self._slowest(k)) or self._on_ramps(k, *ramps) or self._why_slowest(k)
            if found is not None:
                return found
        return self._at_limit(k, at) or self._from_beside(k, at)

    def _why_slowest(self, k: int) -> Why | None:
        """Return why a move is slow at its slowest place beside stops; None: there is none."""
        at = self._slowest(k)
        return None if at is None else self._at_limit(k, at) or self._at_slow_place(k, at)

    def _slowest(self, k: int) -> int | None:
        """Return the cycle of the slowest place of a move beside stops; None: there is none."""
        span, pace, valleys = self.times.spans[k], self._pace(k), self._slow_places(k)
        near = valleys[(valleys >= span.first - 1) & (valleys <= span.last)]
        near = near[~self._stands(near)]
        return int(near[np.argmin(pace[near])]) if len(near) else None

    def _at_cusp(self, k: int, *cycles: int | None) -> Why | None:
        """Return that the curve of a move doubles back at one of some cycles; None: it does not."""
        path = self.chain.parts[k].path
        if not isinstance(path, SplinePath):
            return None
        cusps = path.cusps()
        reasons = (self._reason(k, at) for at in cycles if at is not None)
        near = (each for each in reasons if each.at is not None and _is_near(cusps - each.at, _CUSP / path.length))
        return next((each.of_cusp() for each in near), None)

    def _at_limit(self, k: int, at: int) -> Why | None:
        """Return the limit that is taken where move ``k`` is at a cycle; None: none is."""
        span, use = self.times.spans[k], self._use
        # the cycles beside it, too: speeds and accelerations of a row are not largest in the same one
        near = slice(max(at - 1, span.first), min(at + 2, span.last))
        axis, speed = _largest(use.joints[0, near])
        cap, turning = float(use.cap[near].max()), float(use.turning[0, near].max())
        shares: list[tuple[float, Kind]] = [(cap, "cap"), (speed, "joint"), (turning, "turning")]
        share, kind = max(shares)
        if share >= NEAR:
            return self._reason(k, at).of(Limit(kind=kind, share=share, axis=axis, quantity="speed"))
        bent = self._bending(k, near)
        return None if bent is None else self._in_corner(k, at, bent) or self._reason(k, at).of(bent)

    def _bending(self, k: int, near: slice) -> Limit | None:
        """Return the limit of an acceleration or a jerk that is taken in some cycles of a move; None: none is."""
        # a joint move has no other limits than those of its joints, which its ramps take anyway
        found = [] if self._joint_move(k) else [_of_joints(self._use, near)]
        kind: Kind = "radius" if self._curved(k) else "tool"
        found.append(Limit(kind=kind, share=float(self._use.across[near].max())))
        worst = max(found, key=lambda each: each.share)
        return worst if worst.share >= NEAR else None

    def _from_beside(self, k: int, at: int) -> Why:
        """Return why a move is no faster at its fastest cycle: the ramps from there to slower places beside it."""
        pace = self._pace(k)
        before, after = self._beside(k, at)
        if self._even(k, at, slice(before, after + 1)):
            return self._at_slow_place(k, at)
        ramps = self._ramps(k, at, before, after)
        valleys = [valley for valley, _ in ramps]
        found = self._at_cusp(k, *valleys) or self._on_ramps(k, *(ramp for _, ramp in ramps))
        if found is not None:
            return found
        slow = (self._slow_place(k, valley) for valley in valleys if not pace[valley] > _SLOWER * pace[at])
        return next(filter(None, slow), None) or self._short(k, valleys)

    def _ramps(self, k: int, at: int, before: int, after: int) -> list[tuple[int, slice]]:
        """Return the slow places beside a cycle at which the speed does not rise, each with the ramp to it."""
        span = self.times.spans[k]
        ramps = [
            (before, slice(max(before, span.first), at + 1)),
            (after, slice(at, min(after + 1, span.last))),
        ]
        # towards a side on which the speed still rises, as on the long ramp of short moves, nothing keeps it low
        return [ramp for ramp, beside in zip(ramps, (at - 1, at + 1), strict=True) if not self._rises(k, at, beside)]

    def _slow_place(self, k: int, at: int) -> Why | None:
        """Return why a ramp begins or ends at a slow place: a corner, or a limit within the move; None: a stop."""
        span = self.times.spans[k]
        corner = self._in_corner(k, at)
        if corner is not None or self._stands(np.array([at]))[0] or not span.first <= at < span.last:
            return corner
        return self._at_limit(k, at) or self._at_slow_place(k, at)

    def _rises(self, k: int, at: int, beside: int) -> bool:
        """Return whether a move is faster in the cycle beside another one."""
        pace = self._pace(k)
        return bool(pace[min(max(beside, 0), len(pace) - 1)] > pace[at])

    def _beside(self, k: int, at: int) -> tuple[int, int]:
        """Return the slow places before and after a cycle."""
        valleys = self._slow_places(k)
        last = len(self.times.x) - 2
        return int(valleys[valleys <= at].max(initial=0)), int(valleys[valleys >= at].min(initial=last))

    def _on_ramps(self, k: int, *ramps: slice) -> Why | None:
        """Return the first limit that ``_on_ramp`` finds."""
        return next(filter(None, (self._on_ramp(k, ramp) for ramp in ramps)), None)

    def _even(self, k: int, at: int, between: slice) -> bool:
        """Return whether a move goes on evenly at a cycle: for long ``between`` slow places, or in all of its own."""
        # the speed of its joints is what is programmed of a joint move: there are ramps alone
        if self._joint_move(k):
            return False
        span, tool = self.times.spans[k], self._use.tool
        alike = np.abs(tool[between] - tool[at]) <= _EVEN * tool[at]
        if np.count_nonzero(alike) >= _LONG * len(alike):
            return True
        own = tool[max(span.first - 1, 0) : span.last + 1]
        gained = np.abs(np.diff(own)).max(initial=0.0) / self.times.period_s
        gains = gained >= _RAMP * self._planner.spec.path.acceleration * self._commands[k].acceleration
        return bool(not gains and own.min() >= _SLOWER * tool[at])

    def _on_ramp(self, k: int, ramp: slice) -> Why | None:
        """Return the limit of a joint or of the turning that is taken on a ramp, oftener than that of the tool."""
        use = self._use
        if self._joint_move(k) or ramp.stop <= ramp.start:
            return None
        gaining, turning = use.gaining[ramp] >= NEAR, use.turning[1, ramp] >= NEAR
        joints = (use.joints[1:, ramp] >= NEAR).any(axis=(0, 2))
        often = max(joints.sum(), turning.sum())
        if not often > gaining.sum():
            return None
        # the first cycle is where the limit begins to hold, which is nearest to what causes it
        if joints.sum() >= turning.sum():
            limit, cycles = _of_joints(use, ramp), joints
        else:
            limit, cycles = (
                Limit(kind="turning", share=float(use.turning[1, ramp].max()), quantity="acceleration"),
                turning,
            )
        pace = self._pace(k)
        slower = ramp.start if pace[ramp.start] < pace[ramp.stop - 1] else ramp.stop - 1
        beside = self._corner_at(slower)
        return self._reason(k, ramp.start + int(np.flatnonzero(cycles)[0])).of(
            limit, None if beside is None else beside - k
        )

    def _in_corner(self, k: int, at: int, limit: Limit | None = None) -> Why | None:
        """Return a corner that keeps a move slow, with the limit that is taken there; None: the cycle is in none."""
        number = self._corner_at(at)
        if number is None:
            return None
        corner, centre = self.chain.corners[number], self._corners[0][number]
        # a cycle more on either side: the slowest one may be half in the corner
        half = 0.5 * corner.cycles + 1.0
        inside = slice(max(int(centre - half), 0), min(int(centre + half) + 1, len(self._use.tool)))
        passed = float(self._use.tool[inside].min()) if corner.reach > 0.0 else 0.0
        return self._reason(k, at).of_corner(number - k, corner, passed, limit or self._largest_in(inside))

    def _largest_in(self, cycles: slice) -> Limit:
        """Return what takes most of its limit in some cycles: a joint or the tool."""
        use = self._use
        axis, speed = _largest(use.joints[0, cycles])
        found = (
            Limit(kind="joint", share=speed, axis=axis, quantity="speed"),
            _of_joints(use, cycles),
            Limit(kind="turning", share=float(use.turning[0, cycles].max()), quantity="speed"),
            Limit(kind="turning", share=float(use.turning[1, cycles].max()), quantity="acceleration"),
            Limit(kind="tool", share=float(use.gaining[cycles].max())),
        )
        return max(found, key=lambda each: each.share)

    def _at_slow_place(self, k: int, at: int) -> Why:
        """Return what takes most of its limit where a move goes on evenly or is slowest, else anywhere on it."""
        use, corner = self._use, self._in_corner(k, at)
        if corner is not None:
            return corner
        # slowed for its curvature as a whole, it takes little of its acceleration anywhere
        if self._curved(k):
            span = self.times.spans[k]
            tightest = span.first + int(np.argmax(use.across[span.first : span.last]))
            bent = Limit(kind="radius", share=float(use.across[tightest]))
            return self._at_cusp(k, at) or self._reason(k, tightest).of(bent)
        found = self._anywhere(k)
        # the end of a ramp, where nothing takes much any more
        return found if found.share >= _HALF else self._short(k, ())

    def _curved(self, k: int) -> bool:
        path = self.chain.parts[k].path
        return path is not None and not isinstance(path, LinePath)

    def _anywhere(self, k: int) -> Why:
        """Return what takes most of its limit on a move."""
        span = self.times.spans[k]
        found = [(cycle, self._largest_in(slice(cycle, cycle + 1))) for cycle in range(span.first, span.last)]
        cycle, limit = max(found, key=lambda each: each[1].share)
        return self._reason(k, cycle).of(limit)

    def _short(self, k: int, valleys: Sequence[int]) -> Why:
        """Return that a move is too short for its speed, between slow places at cycles ``valleys``."""
        span = self.times.spans[k]
        # where the tool gains its speed slowly, something else has slowed the move as a whole
        if not self._joint_move(k) and self._use.gaining[span.first : span.last].max() < _HALF:
            found = self._anywhere(k)
            if found.kind != "tool" and found.share >= NEAR:
                return found
        own = all(span.first - 1 <= valley <= span.last for valley in valleys) and len(valleys) > 1
        return self._reason(k, span.first).of_length(own)

    @cached_property
    def _stops(self) -> Array:
        """The continuous cycles at which the arm stands as programmed."""
        spans, corners = self.times.spans, self.chain.corners
        bounds = [stretch.start for stretch in self.times.stretches[1:]]
        meant = [spans[k].begins for k in bounds if not corners[k - 1].radius > 0.0]
        # far before the first cycle, where it begins in motion
        begins = -np.inf if self.chain.moving else 0.0
        return np.array([begins, *meant, len(self.times.x) - 1.0])

    def _stands(self, cycles: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Return whether cycles (N,) are beside a stop."""
        return np.asarray(np.abs(self._stops - (cycles[:, None] + 0.5)).min(axis=1) <= _BESIDE)

    @cached_property
    def _corners(self) -> tuple[Array, Array]:
        """The continuous cycles (K - 1,) at which each move but the last ends, and how far the corner there reaches.

        Less than 0 where no corner bends the path.
        """
        corners = self.chain.corners
        bends = [
            each.radius > 0.0 and (each.deviation > _STRAIGHT * each.reach or not each.reach > 0.0) for each in corners
        ]
        halves = [0.5 * each.cycles + _BESIDE if bent else -1.0 for each, bent in zip(corners, bends, strict=True)]
        return np.array([span.ends for span in self.times.spans[:-1]]), np.array(halves)

    def _corner_at(self, at: int) -> int | None:
        """Return the corner with a zone that a cycle is in, or the nearest of several; None: it is in none."""
        centres, halves = self._corners
        off = np.abs(centres - (at + 0.5))
        inside = np.flatnonzero(off <= halves)
        if not len(inside) or self._stands(np.array([at]))[0]:
            return None
        return int(inside[np.argmin(off[inside])])

    def _reason(self, k: int, at: int) -> Reasons:
        """Return what names the reasons of a move, at a cycle."""
        # the place of a cycle is that of its middle
        middle = 0.5 * (self.times.x[at] + self.times.x[at + 1]) - self.times.ends[k]
        share = float(middle / self.times.extents[k])
        spec, limits = self._planner.spec, self._planner.limits.joints
        part, speed = self.chain.parts[k], float(self._use.tool[at])
        place = share if 0.0 <= share <= 1.0 else None
        return Reasons(part=part, command=self._commands[k], spec=spec, jerk=limits.jerk, speed=speed, at=place)


def _nothing() -> Reached:
    return Reached(programmed=None, reached=0.0, seconds=0.0, expected_s=0.0, why=None, of_joints=False)


def _is_near(off: Array, within: float) -> bool:
    return bool((np.abs(off) <= within).any())


def _largest(shares: Array) -> tuple[int, float]:
    """Return the axis that takes most in shares (N, n), and what it takes."""
    each = shares.max(axis=0)
    axis = int(np.argmax(each))
    return axis, float(each[axis])


def _of_joints(use: LimitUse, cycles: slice) -> Limit:
    """Return the largest share of an acceleration or jerk limit that a joint takes in some cycles."""
    found = []
    for order in (1, 2):
        axis, share = _largest(use.joints[order, cycles])
        found.append(Limit(kind="joint", share=share, axis=axis, quantity=QUANTITIES[order]))
    return max(found, key=lambda each: each.share)


def _slow_places(pace: Array) -> NDArray[np.intp]:
    """Return the cycles at which a pace (N,) is lowest between two rises, and the first and the last."""
    # a rise or a fall counts from ``_DIP`` on: less is rounding to whole cycles
    found, falling, extreme, at = [0], False, float(pace[0]), 0
    for k, value in enumerate(pace.tolist()):
        if falling and value < extreme:
            extreme, at = value, k
        elif falling and value > extreme * (1.0 + _DIP):
            found.append(at)
            falling, extreme = False, value
        elif not falling and value > extreme:
            extreme = value
        elif not falling and value < extreme * (1.0 - _DIP):
            falling, extreme, at = True, value, k
    return np.array([*found, len(pace) - 1], dtype=np.intp)
