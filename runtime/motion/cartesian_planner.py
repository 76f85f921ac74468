"""Planning a move along a path: every set-point computed and checked before the first one is sent.

The path, a line, an arc or a spline, is sampled where the interpolator will send it, every 8 ms, and solved for the
joints: in the arm configuration it starts in, with the wrist leaving the posture of the path where it has to
(``wrist_planner``).
It is refused when a sample is out of reach (RBL410), outside a joint's range (RBL411) or cannot be passed (RBL412), and
slowed where a joint would pass a limit (``single``). What was checked is what runs: the interpolator
hands out these very rows (docs/decisions/0002).

On an arc of radius r the tool point is accelerated towards the centre as well, by v^2 / r; of a spline r is the
smallest radius of curvature. Its speed is held to

    v^2 / r <= ACROSS a,    v^3 / r^2 <= j

and what v^2 / r leaves of the path's acceleration limit a is for gaining and losing speed: sqrt(a^2 - (v^2 / r)^2).

An *override* o in (0, 1] is a share of every speed: of the tool point, of its turning, of the joints, programmed or a
limit; TIME t becomes t / o. Accelerations stay. A command has one of its own, the planner may be
given another one for all moves, and the product counts. How the move goes through the wrist is chosen as for o = 1, so
a program that is tested at a low speed passes through the same points as later.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen
from runtime.core.limits import ACCEL, SPEED, TIME
from runtime.core.linear import matmul
from runtime.core.units import DEG, MM, PERCENT
from runtime.motion.chain.paced import ChainLimits
from runtime.motion.chain.piece import Piece, extent_of
from runtime.motion.commands import MAX, Component, MoveArc, MoveLinear, MoveSpline, PathMove
from runtime.motion.fine_interpolator import through
from runtime.motion.half_turn import in_order
from runtime.motion.path import NOTHING_TO_DO, ArcPath, LinePath, Path
from runtime.motion.path_ik import Arm, LineSolver, WristSolver
from runtime.motion.seam import CalculatedMove, SeamMove, SeamTracker
from runtime.motion.single import Slowdown, check_passable, single
from runtime.motion.spline_path import SplinePath
from runtime.motion.time_scaling import Pace
from runtime.motion.velocity_profile import SpeedLimits, bound, profile
from runtime.motion.wrist.switch import CONDITIONS, SAME_ANGLES, Condition, PathTiming
from runtime.motion.wrist_planner import choose, explained
from runtime.motion.wrist_request import Candidate, SampledPath, posture_deviation
from runtime.robot.kinematics.frozen_wrist import MAIN_AXES, WRIST_AXES
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.drives import PathLimits
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

FOLLOWS, EXCEPTION, HELD = 0, 1, 2
"""``wrist_mode``: the wrist follows the path; goes to its end angles; does so with posture components held."""

MOST_SAMPLES = 2000
"""A move through the wrist is chosen on at most so many samples: at 8 ms, moves of 16 s and less on all of theirs."""

ACROSS = 0.8
"""Largest share of the path's acceleration that an arc may take to turn the speed; sqrt(1 - 0.8^2) = 0.6 are then left
to gain and to lose it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WristChange:
    """Where a move leaves the posture of its path to change the wrist, and what it costs.

    ``condition`` that was met on ``axis`` (0-based; None: no single one); ``row`` and ``share`` of the path at which
    the wrist leaves it, ``row_end`` and ``share_end`` at which it is back; ``remedy`` beyond the document's rule, or
    ""; ``deviation`` rad: the largest angle between the tool and its planned posture. ``components``: by how much each
    of those to be held changes, rad.
    """

    condition: Condition
    axis: int | None
    row: int
    row_end: int
    share: float
    share_end: float
    remedy: str
    held: tuple[str, ...]
    deviation: float
    components: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class MovePlan:
    """A planned move: joint angles ``q`` (N + 1, n) rad that it passes, from the start to the end, 8 ms apart.

    ``path`` of the tool point, None for a joint move; ``s`` (N + 1,) path parameter of each row. ``slowdown`` None when
    the move runs as programmed, ``wrist`` None when the tool keeps the posture of the path, ``notes`` for the report;
    ``piece`` is the move as a piece of a path, None where it has nothing to do; ``draft``: the rows are those of the
    programmed speed, which the joints may not keep, since the move has a zone and is timed in its chain.
    """

    path: Path | None
    s: Array
    q: Array
    slowdown: Slowdown | None
    wrist: WristChange | None = None
    notes: tuple[str, ...]
    piece: Piece | None = None
    draft: bool = False

    @property
    def acceleration(self) -> float:
        """The programmed share of the robot's accelerations."""
        return 1.0 if self.piece is None else self.piece.acceleration

    @property
    def override(self) -> float:
        """The share of all speeds."""
        return 1.0 if self.piece is None else self.piece.override

    @property
    def programmed_s(self) -> float:
        """Time that its speed alone takes, or its TIME, s; 0 where it has nothing to do."""
        return 0.0 if self.piece is None else self.piece.programmed_s

    @property
    def setpoints(self) -> Array:
        """Set-points (N + 1, n) rad of a command that passes ``q``; of a joint move ``q``, on one straight line."""
        return self.q if self.path is None else through(self.q)

    @property
    def modes(self) -> NDArray[np.int8]:
        """``wrist_mode`` (N + 1,) of every set-point, the mode of a row that is reached while the wrist is away."""
        modes = np.full(len(self.q), FOLLOWS, dtype=np.int8)
        if self.wrist is not None:
            modes[self.wrist.row + 1 : self.wrist.row_end + 1] = HELD if self.wrist.held else EXCEPTION
        return modes

    def modes_at(self, s: Array) -> NDArray[np.int8]:
        """Return ``wrist_mode`` (N,) of rows at shares s (N,) of the path, in another timing of it."""
        modes = np.full(len(s), FOLLOWS, dtype=np.int8)
        if self.wrist is not None:
            away = (s > self.s[self.wrist.row]) & (s <= self.s[self.wrist.row_end])
            modes[away] = HELD if self.wrist.held else EXCEPTION
        return modes


@dataclass(frozen=True, slots=True, kw_only=True)
class PathCurve:
    """The curve of a move along a path in joint space; ``limits`` of its path parameter, None: already there.

    ``line`` keeps the posture of the path, ``choice`` is the curve that the move takes; the wrist has to ``turn`` by so
    many rad where the tool keeps its pose.
    """

    path: Path
    line: LineSolver
    limits: SpeedLimits | None
    choice: Candidate
    turn: float = 0.0

    def joints(self, s: Array) -> Array:
        """Return q (N, n) rad at path parameters s (N,); ``Fault`` RBL410, 411 or 412."""
        with self.explaining():
            return self.choice.solver.joints(s)

    @contextmanager
    def explaining(self) -> Iterator[None]:
        """Add to a refusal of a curve through the wrist the reason why the wrist has to change at all."""
        try:
            yield
        except Fault as fault:
            if self.choice.trigger is None or self.choice.switch is None:
                raise
            raise explained(fault, self.path, self.choice.trigger) from None


class CartesianPlanner:
    """Plans moves along lines and arcs for one robot under one controller profile."""

    def __init__(self, spec: RobotSpec, kinematics: Kinematics, profile: Profile) -> None:
        self._spec = spec
        self._kinematics = kinematics
        self._profile = profile
        self._pace = Pace.of(spec, profile)
        self._limits = ChainLimits.of(spec, profile)

    def plan(self, q_start: Array, command: PathMove, X_flange_tool: Array, override: float = 1.0) -> MovePlan:
        """Return the plan of a move from joint angles q_start (n,) rad; ``Fault`` RBL404, 410, 411, 412 or 416.

        ``X_flange_tool`` (4, 4) is the tool whose point moves, ``override`` in (0, 1] a share of every speed
        beside the command's own.
        """
        curve = self.curve(q_start, command, X_flange_tool)
        if curve.limits is None:
            return MovePlan(path=curve.path, s=np.ones(1), q=frozen([q_start]), slowdown=None, notes=("already there",))
        override *= command.override
        pace = self._pace.overridden(override)
        duration = None if command.duration is None else command.duration / override
        s = profile(curve.limits.overridden(override), self._profile.period_s, duration)
        solver = curve.choice.solver
        with curve.explaining():
            q = solver.joints(s)
            piece = Piece(
                curve=solver,
                path=curve.path,
                extent=extent_of(curve.path, q[0], q[-1], self._kinematics),
                limits=self._piece_limits(curve, command),
                q_start=q[0],
                q_end=q[-1],
                acceleration=command.acceleration,
                override=override,
                duration_s=duration,
            )
            # most moves with a zone never run alone: their time is that of their chain
            if draft := command.zone > 0.0:
                check_passable(solver, piece, (s, q), self._limits)
                slowdown = None
            else:
                s, q, slowdown = single(solver, piece, (s, q), curve.line.arm, self._limits)
        wrist = _wrist_change(curve.choice, curve.line, s, q, command.held)
        notes = _wrist_notes(wrist) + _kept_notes(command, q)
        notes += pace.slow_note(slowdown, len(s) - 1) + pace.time_note(duration, len(s) - 1)
        return MovePlan(
            path=curve.path,
            s=frozen(s),
            q=frozen(q),
            slowdown=slowdown,
            wrist=wrist,
            notes=notes,
            piece=piece,
            draft=draft,
        )

    def _piece_limits(self, curve: PathCurve, command: PathMove) -> SpeedLimits:
        """Return the bounds of the path parameter that a move runs with: under ``MAX`` those of its speeds alone."""
        assert curve.limits is not None  # it has something to do
        if isinstance(curve.path, SplinePath):
            # its bends and its turning bound it place by place (``runtime.motion.chain.curved``)
            return bound([along_limits(curve.path, command, self._spec.path)], self._profile.speed_shape)
        if command.acceleration < MAX:
            return curve.limits
        return speed_limits(curve.path, command, self._spec.path, self._profile, curve.turn)

    def curve(self, q_start: Array, command: PathMove, X_flange_tool: Array) -> PathCurve:
        """Return the curve of a move, at any path parameter, and its limits; arguments and faults of ``plan``."""
        X_start = matmul(self._kinematics.forward(q_start), X_flange_tool)
        # a taught end may differ in turns alone: then there is something to do although the tool is there already
        turn = 0.0 if command.q_end is None else float(np.abs(command.q_end - q_start).max())
        arm = Arm(spec=self._spec, kinematics=self._kinematics, fine=self._pace.fine, X_flange_tool=X_flange_tool)
        lines = [LineSolver(arm, path, q_start) for path in self._paths(X_start, command)]
        line, path = lines[0], lines[0].path
        if all(extent < NOTHING_TO_DO for extent in (path.length, path.angle, turn)):
            return PathCurve(path=path, line=line, limits=None, choice=Candidate(solver=line))
        # also with ``ACCEL MAX`` it is checked, and goes through its wrist, as at the robot's accelerations
        command = replace(command, acceleration=command.robot_share)
        limits = speed_limits(path, command, self._spec.path, self._profile, turn)
        if len(lines) > 1:
            lines = in_order(lines, profile(limits, self._profile.period_s, command.duration), command.q_end)
        # the other direction of a half turn is taken only where the better one is refused
        refused: list[Fault] = []
        for line in lines:
            try:
                choice = self._choose(line, limits, command)
            except Fault as fault:
                refused.append(fault)
            else:
                return PathCurve(path=line.path, line=line, limits=limits, choice=choice, turn=turn)
        raise refused[0]

    def _paths(self, X_start: Array, command: PathMove) -> tuple[Path, ...]:
        """Return the path of a move, one for each direction in which its tool may make a half turn."""
        if isinstance(command, MoveArc):
            return ArcPath.candidates(X_start, command.X_via, command.X_world_tool)
        if isinstance(command, MoveSpline):
            path = SplinePath.through(X_start, (*command.X_through, command.X_world_tool))
            if path is not None:
                return (path,)
        return LinePath.candidates(X_start, command.X_world_tool, self._profile.wrist.posture)

    def tracked(
        self,
        plan: MovePlan,
        command: MoveLinear,
        q_from: Array,
        q_here: Array,
        tracker: SeamTracker,
        X_flange_tool: Array,
    ) -> SeamMove:
        """Return a planned move (``command.tracked``) as one that follows a seam, point by point.

        q_from (n,) is where its calculated path begins, q_here (n,) where the arm really is, rad.
        """
        assert plan.path is not None  # a straight move has one
        arm = Arm(spec=self._spec, kinematics=self._kinematics, fine=self._pace.fine, X_flange_tool=X_flange_tool)
        options, wrist = self._profile.wrist, plan.wrist
        if self._keeps_posture(command):
            options = options.only()
        elif wrist is None or wrist.remedy:
            # the plan knows better than C1, C2 and C4 when the wrist has to leave; range and speed it cannot know
            options = options.only(range_condition=options.range_condition, guard=options.guard)
        calculated = CalculatedMove(
            line=LineSolver(arm, plan.path, q_from),
            s=plan.s,
            period_s=self._profile.period_s,
            q_end=plan.q[-1],
            switch=None if wrist is None else wrist.row,
        )
        return SeamMove(calculated, q_here, tracker, options)

    def _choose(self, line: LineSolver, limits: SpeedLimits, command: PathMove) -> Candidate:
        """Return how the move goes through the wrist, judged on its samples at the programmed speed."""
        options = self._profile.wrist
        if self._keeps_posture(command):
            return Candidate(solver=line)
        s = profile(limits, self._profile.period_s, command.duration)
        every = -(-(len(s) - 1) // MOST_SAMPLES)  # a long move is judged in coarser steps, as if it were faster
        period_s = every * self._profile.period_s
        if every > 1:
            s = np.unique(np.append(s[::every], 1.0))
        q = line.rows(s)
        q[0] = line.q_start

        def excess(q: Array) -> tuple[float, int, str]:
            ratio, axis, quantity = self._pace.excess(q)
            return ratio / every, axis, quantity

        timing = PathTiming(s=s, period_s=period_s, length=line.path.length)
        return choose(SampledPath(line=line, timing=timing, q=q, excess=excess), command, options)

    def _keeps_posture(self, command: PathMove) -> bool:
        """Return whether a move keeps the posture of its path whatever happens: under KEEP.

        So do arms of fewer or more than six axes: a position leaves one of four main axes free, and of two it places
        none (docs/decisions/0018).
        """
        return (command.wrist or self._profile.wrist.mode) == "keep" or self._spec.n != MAIN_AXES + WRIST_AXES


def _wrist_change(
    choice: Candidate, line: LineSolver, s: Array, q: Array, held: tuple[Component, ...]
) -> WristChange | None:
    """Return what the plan does with the wrist, measured on its samples; None where it follows the path."""
    if choice.switch is None:
        return None
    # measured on the final rows, whose samples differ from those on which the move was chosen
    row = int(np.searchsorted(s, choice.switch, side="right")) - 1
    trigger, solver = choice.trigger, choice.solver
    assert isinstance(solver, WristSolver)  # a candidate with a switch has a law from there on
    return WristChange(
        condition="end" if trigger is None else trigger.condition,
        axis=None if trigger is None else trigger.axis,
        row=row,
        row_end=min(int(np.searchsorted(s, solver.law.s_return)), len(s) - 1),
        share=choice.switch,
        share_end=solver.law.s_return,
        remedy=choice.remedy,
        held=choice.held,
        deviation=posture_deviation(line, s, q),
        components=tuple((each, posture_deviation(line, s, q, (each,))) for each in held),
    )


def _wrist_notes(wrist: WristChange | None) -> tuple[str, ...]:
    """Return the note of a move that leaves its posture: from where to where, why, and by how much the tool turns."""
    if wrist is None:
        return ()
    axis = "" if wrist.axis is None else f" of J{wrist.axis + 1}"
    why = f"{wrist.condition}, {CONDITIONS[wrist.condition]}{axis}"
    remedy = f"; {wrist.remedy}" if wrist.remedy else ""
    held = f"; {' and '.join(wrist.held)} held" if wrist.held else ""
    return (
        f"wrist goes to its end angles from {100 * wrist.share:.1f} to {100 * wrist.share_end:.1f} % of the path ({why}"
        f"{remedy}{held}): the tool turns up to {wrist.deviation / DEG:.1f} deg from its posture on the path"
        + "".join(f", {name} up to {off / DEG:.1f} deg" for name, off in wrist.components),
    )


def _kept_notes(command: PathMove, q: Array) -> tuple[str, ...]:
    """Return the note of a move that does not end at its taught angles, since it keeps its wrist."""
    if command.q_end is None:
        return ()
    axis = int(np.argmax(np.abs(q[-1] - command.q_end)))
    if abs(q[-1, axis] - command.q_end[axis]) <= SAME_ANGLES:
        return ()
    return (
        f"keeps the wrist and ends with J{axis + 1} at {q[-1, axis] / DEG:.1f} deg, not at the taught "
        f"{command.q_end[axis] / DEG:.1f} deg",
    )


def arc_limits(speed: float, acceleration: float, jerk: float, radius: float) -> tuple[float, float]:
    """Return the speed m/s on an arc of ``radius`` m and the acceleration m/s2 that it leaves along the arc.

    ``speed`` m/s, ``acceleration`` m/s2 and ``jerk`` m/s3 are the limits of the path.
    """
    speed = min(speed, math.sqrt(ACROSS * acceleration * radius), math.cbrt(jerk * radius**2))
    return speed, math.sqrt(acceleration**2 - (speed**2 / radius) ** 2)


def speed_limits(
    path: Path, command: PathMove, robot: PathLimits, profile: Profile, wrist_turn: float = 0.0
) -> SpeedLimits:
    """Return the bounds of the path parameter for a command; ``Fault`` RBL404 for a SPEED, ACCEL or TIME out of range.

    ``wrist_turn`` rad is how far the wrist has to turn, for a move whose tool stays where it is.
    """
    length, speed, acceleration, jerk = along_limits(path, command, robot)
    share = command.acceleration
    if not isinstance(path, LinePath) and share < MAX:
        speed, acceleration = arc_limits(speed, acceleration, jerk, path.radius)
    if isinstance(path, SplinePath) and share < MAX:
        speed = min(speed, path.turning_speed(ACROSS * robot.rotation_acceleration * share))
    turning = (robot.rotation_speed, robot.rotation_acceleration * share, robot.rotation_jerk * share)
    # where only the wrist turns, it gets the limits of the tool's turning; the joints' own are checked afterwards
    angle = wrist_turn if path.length < NOTHING_TO_DO and path.angle < NOTHING_TO_DO else path.angle
    return bound([(length, speed, acceleration, jerk), (angle, *turning)], profile.speed_shape)


def along_limits(path: Path, command: PathMove, robot: PathLimits) -> tuple[float, float, float, float]:
    """Return length, speed, acceleration and jerk of a command along its path, without its bends; ``Fault`` RBL404."""
    share = command.acceleration
    if share != MAX:
        ACCEL.checked(share / PERCENT, ACCEL.high)
    speed = robot.default_speed
    if command.duration is not None:
        # TIME rules alone: the speed is then only bounded by the robot, and the profile is stretched to the time
        TIME.checked(command.duration)
        speed = robot.max_speed
    elif command.speed is not None:
        speed = command.speed
        SPEED.checked(speed / MM, robot.max_speed / MM)
    return path.length, speed, robot.acceleration * share, robot.jerk * share
