"""Planning a joint move: all joints start and end together, each in proportion to its own turn.

    q(s) = q_start + s (q_end - q_start),   s in [0, 1]

With d_i the turn of joint i, and v_i, a_i what the move may use of its limits, s is bound by the joint that needs most:

    ds/dt <= min v_i / d_i,    d2s/dt2 <= min a_i / d_i,    d3s/dt3 <= min a_i / (RISE_S d_i)

An acceleration builds up in ``RISE_S``, as on the paths of the built-in robots (30 m/s3 to 3 m/s2). The command keeps
to what s keeps to (``fine_interpolator``).

Where only a pose is given, its solutions are those of all configurations, each joint turned into its range. Of those
that fit what the point is taught with, those in which the arm keeps the configuration that it is in come first; of
these the one is taken that the slowest joint reaches soonest (docs/decisions/0030). Refused: no
solution (RBL410), none in the ranges (RBL411), none as taught (RBL412). Called by ``runtime.motion.motion_planner``;
rad, s.
"""

from collections.abc import Sequence
from typing import NoReturn

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen, inverse
from runtime.core.limits import ACCEL, SPEED_PCT, TIME
from runtime.core.linear import matmul
from runtime.core.units import MM, PERCENT
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.chain.paced import ChainLimits
from runtime.motion.chain.piece import JointLine as JointSpan
from runtime.motion.chain.piece import Piece, extent_of
from runtime.motion.commands import MoveJoint
from runtime.motion.path import NOTHING_TO_DO
from runtime.motion.path_ik import RANGE_TOLERANCE, Arm, check_range, few_axes
from runtime.motion.single import single
from runtime.motion.taught_end import as_taught, turned
from runtime.motion.time_scaling import Pace
from runtime.motion.velocity_profile import SpeedLimits, bound, profile
from runtime.robot.kinematics.kinematics import LIMIT_ROUNDING, Kinematics, Solution
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

SAME_TIME_S = 1e-9
"""Solutions whose times differ by less, s, are equally soon: rounding must not decide between them."""


class JointLine:
    """The straight line in joint space from q_start (n,) to q_end (n,) rad."""

    def __init__(self, arm: Arm, q_start: Array, q_end: Array) -> None:
        self._arm, self._q_start, self._q_end = arm, q_start, q_end

    def joints(self, s: Array) -> Array:
        """Return q (N + 1, n) at s (N + 1,) from 0 to 1; ``Fault`` RBL411."""
        q = self._q_start + s[:, None] * (self._q_end - self._q_start)
        q[0], q[-1] = self._q_start, self._q_end  # to the last bit: the next move starts from here
        check_range(self._arm, s, q)
        return q

    def setpoints(self, q: Array) -> Array:
        """Return joints q (N + 1, n): a command between points of a straight line is on it."""
        return q

    def refuse_singular(self, s: Array, q: Array, axis: int) -> NoReturn:
        """Raise ``Fault`` RBL404: a joint move has no singularity, so no profile fits this move."""
        raise Fault("RBL404", f"no speed profile of the joint move keeps the limits of J{axis + 1}")


class JointPlanner:
    """Plans joint moves for one robot under one controller profile."""

    def __init__(self, spec: RobotSpec, kinematics: Kinematics, profile: Profile) -> None:
        self._spec, self._kinematics, self._profile = spec, kinematics, profile
        self._pace = Pace.of(spec, profile)
        self._chain_limits = ChainLimits.of(spec, profile)

    def plan(self, q_start: Array, command: MoveJoint, X_flange_tool: Array, override: float = 1.0) -> MovePlan:
        """Return the plan of a move from joint angles q_start (n,) rad; ``Fault`` RBL404, 410, 411 or 412.

        ``X_flange_tool`` (4, 4) is the tool that is put at the pose, ``override`` in (0, 1] a share of every speed
        beside the command's own.
        """
        share = _share(command)
        q_end = self.end(q_start, command, X_flange_tool)
        turns = np.abs(q_end - q_start)
        if turns.max() < NOTHING_TO_DO:
            return MovePlan(path=None, s=np.ones(1), q=frozen([q_start]), slowdown=None, notes=("already there",))
        override *= command.override
        pace = self._pace.overridden(override)
        duration = None if command.duration is None else command.duration / override
        arm = Arm(spec=self._spec, kinematics=self._kinematics, fine=pace.fine, X_flange_tool=X_flange_tool)
        limits = self._limits(turns, share, command.robot_share)
        s = profile(limits.overridden(override), self._profile.period_s, duration)
        curve = JointLine(arm, q_start, q_end)
        q = curve.joints(s)
        piece = Piece(
            curve=JointSpan(q[0], q[-1]),
            path=None,
            extent=extent_of(None, q[0], q[-1], self._kinematics),
            limits=limits,
            q_start=q[0],
            q_end=q[-1],
            acceleration=command.robot_share,
            override=override,
            duration_s=duration,
        )
        s, q, slowdown = single(curve, piece, (s, q), arm, self._chain_limits)
        notes = pace.time_note(duration, len(s) - 1)
        return MovePlan(path=None, s=frozen(s), q=frozen(q), slowdown=slowdown, notes=notes, piece=piece)

    def end(self, q_start: Array, command: MoveJoint, X_flange_tool: Array) -> Array:
        """Return the joint angles (n,) at which a move from q_start (n,) ends; ``Fault`` RBL410, 411 or 412."""
        if command.q_end is not None:
            q_end = np.array(command.q_end, dtype=np.float64)
            self._check_end(q_end)
            return q_end
        assert command.X_world_tool is not None  # a command has at least one of the two
        X_world_flange = matmul(command.X_world_tool, inverse(X_flange_tool))
        return self.choose(self._kinematics.solutions(X_world_flange, q_start), q_start, command)

    def choose(self, solutions: Sequence[Solution], q_start: Array, command: MoveJoint) -> Array:
        """Return the one of the solutions of its pose at which a move from q_start (n,) ends; ``Fault`` as ``end``.

        Called by ``end``, and where many poses are solved at once.
        """
        found = self._as_taught(solutions, q_start, command)
        # a change of configuration sweeps the whole arm through the cell: only where nothing else is in the ranges
        kept = [q for q in found if not changed(self._kinematics, q_start, q, command)]
        times = [float((np.abs(q - q_start) / self._pace.speed).max()) for q in kept or found]
        soonest = min(times) + SAME_TIME_S
        return next(q for q, time in zip(kept or found, times, strict=True) if time <= soonest)

    def _as_taught(self, solutions: Sequence[Solution], q_start: Array, command: MoveJoint) -> list[Array]:
        """Return the solutions (n,) as the point is taught, in the ranges; ``Fault`` RBL410, 411 or 412 for none."""
        kinematics = self._kinematics
        if not solutions:
            raise Fault("RBL410", f"{_point(command)} is out of reach of {self._spec.name}", few_axes(self._spec))
        found = turned(kinematics, np.array([each.q for each in solutions]), command.turns[: kinematics.n], q_start)
        fitting = [q for q in found if as_taught(kinematics, q, command)]
        if not fitting:
            raise _in_no_configuration(command, solutions)
        inside = [q for q in fitting if kinematics.limit_margin(q) >= -LIMIT_ROUNDING]
        if not inside:  # the refusal names the solution that leaves its range by least
            self._check_end(max(fitting, key=lambda q: float(kinematics.limit_margin(q))))
        return inside

    def _check_end(self, q_end: Array) -> None:
        """Refuse an end outside the range of a joint; ``Fault`` RBL411."""
        excess = np.maximum(self._spec.lower - q_end, q_end - self._spec.upper)
        axis = int(np.argmax(excess))
        if not excess[axis] <= RANGE_TOLERANCE:
            limits = self._spec.axes[axis].limits
            limit = limits.lower if q_end[axis] < limits.lower else limits.upper
            raise Fault(
                "RBL411",
                f"J{axis + 1} would pass its limit of {limits.kind.text(limit)} by "
                f"{limits.kind.text(excess[axis], '.4g')}, at the end of the move",
            )

    def _limits(self, turns: Array, speed: float, acceleration: float) -> SpeedLimits:
        """Return the bounds of s for joints that turn by ``turns`` (n,) rad, at shares of their limits."""
        most, jerk = self._pace.acceleration * acceleration, self._pace.jerk * acceleration
        each = np.stack([turns, self._pace.speed * speed, most, jerk], axis=1)
        return bound([(d, v, a, j) for d, v, a, j in each.tolist()], self._profile.speed_shape)


def _point(command: MoveJoint) -> str:
    """Return the place of a taught pose as messages name it."""
    assert command.X_world_tool is not None  # needed only where joint angles are not taught
    return f"the point ({', '.join(f'{each:.1f}' for each in command.X_world_tool[:3, 3] / MM)}) mm"


def _in_no_configuration(command: MoveJoint, solutions: Sequence[Solution]) -> Fault:
    words = " ".join(command.configuration)
    there = ", ".join(str(each.branch) for each in solutions)
    return Fault(
        "RBL412",
        f"{_point(command)} cannot be reached {words}, only {there}",
        "Teach the point in a configuration that it can be reached in.",
    )


def changed(kinematics: Kinematics, q_start: Array, q_end: Array, command: MoveJoint) -> tuple[tuple[str, str], ...]:
    """Return what an arm changes of its configuration from q_start (n,) to q_end (n,) rad without being taught to.

    Names before and after, such as RIGHTY and LEFTY. A point may name a part of the configuration only.
    """
    if command.q_end is not None:
        return ()
    found = kinematics.changes(q_start, q_end)
    return tuple((before, after) for before, after in found if after not in command.configuration)


def _share(command: MoveJoint) -> float:
    """Return the programmed share of the joints' speeds, 1 with TIME; ``Fault`` RBL404 outside (0, 1]."""
    ACCEL.checked(command.robot_share / PERCENT, ACCEL.high)
    if command.duration is not None:
        TIME.checked(command.duration)
        return 1.0
    share = 1.0 if command.speed is None else command.speed
    SPEED_PCT.checked(share / PERCENT, SPEED_PCT.high)
    return share
