r"""Seam tracking: a straight move shifted by the deviation that a sensor reads, its end point and end angles with it.

A sensor sees where the seam really is, relative to the *calculated* point P(n) of the move. So every reading is the
whole deviation, and none adds to the one before:

    S5'    the tool goes to P(n) + d(n);  joints theta'(n) from it, sign of J5 kept
           the end is Q2(n) = Q2 + d(n);  its wrist angles theta_ke(n) from it, branch and turns of the taught end kept
    (11')  the conditions and (21') the law to the end angles use theta_ke(n);  S9 uses the position of P(n) + d(n)

``P + d`` adds the translation and turns by the rotation about fixed axes: [R_d R_P, p_P + d]. Deviations are [x, y, z]
m and [rx, ry, rz] rad in the world frame.

The reading passes a critically damped filter of time constant ``filter_s`` twice, so d has no steps of speed; a lost
sample holds the last one. A reading beyond its bound, or too many lost in a row, is a fault of the running line
(RBL524, RBL525): the arm stops on its path. So is a point that the joints cannot follow within their limits (RBL526):
the move was planned without deviation, and that of the sensor is not known before.

Source: CN103429397A (Kobe Steel), embodiment 3. Called once per 8 ms cycle by the interpolator.
"""

import copy
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array, inverse, pose, rotation_from_rpy
from runtime.core.linear import matmul, norm
from runtime.core.rounding import beside
from runtime.core.units import DEG, MM
from runtime.motion.path_ik import LineSolver
from runtime.motion.wrist.switch import Conditions, PathTiming, WristLaw, WristLimits, law_from
from runtime.robot.kinematics.frozen_wrist import MAIN_AXES, WRIST_AXES, FrozenWrist, Side
from runtime.robot.kinematics.opw import Branch
from runtime.settings.profile import WristOptions

SPEED_SLACK = 1.1
"""A tracked point may need this share of a joint's speed limit: the plan was made without the deviation."""

Read = Callable[[float, Array], Array | None]
"""The sensor: from the distance along the path since SEAM ON, m, and the direction of travel (3,), the deviation (6,)
that it reads; None where the sample is lost."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamLimits:
    """Which readings of a sensor are accepted: at most ``most`` m and ``most_turn`` rad away, lost for ``lost_s`` s.

    ``filter_s`` s is the time constant of the filter that they pass, 0 for none.
    """

    filter_s: float = 0.04
    most: float = 0.02
    most_turn: float = 10.0 * DEG
    lost_s: float = 0.1


class SeamTracker:
    """The deviation in force from SEAM ON to SEAM OFF: filtered, bounded, held while samples are lost."""

    def __init__(self, name: str, limits: SeamLimits, period_s: float, read: Read) -> None:
        self.name, self._limits, self._period_s, self._read = name, limits, period_s, read
        self.deviation = np.zeros(6)
        """Deviation in force, m and rad."""
        self.distance = 0.0
        """Distance along the calculated path since SEAM ON, up to the move that runs, m."""
        self.q_calculated: Array | None = None
        """Joint angles (n,) of the calculated point where the last move ended; None before the first."""
        self.lost = 0
        """Samples lost so far."""
        self._target = np.zeros(6)
        self._rate = np.zeros(6)
        self._lost_in_a_row = 0

    def copy(self) -> "SeamTracker":
        """Return a tracker that goes on alike and apart: its sensor repeats the readings that this one will get."""
        twin = copy.copy(self)  # the arrays are replaced, never written, so the twins may share them
        twin._read = copy.deepcopy(self._read)  # a bound method brings a copy of its sensor, a function is itself
        return twin

    def observe(self, at: float, travel: Array) -> None:
        """Read the sensor for this cycle, ``at`` m into the move that runs; ``Fault`` RBL524 or RBL525.

        Whatever happens, the deviation follows the last good reading for one cycle.
        """
        try:
            self._take(self._read(self.distance + at, travel))
        finally:
            self.follow()  # also after a fault: the arm stops on a path whose deviation has no step

    def _take(self, reading: Array | None) -> None:
        limits = self._limits
        if reading is None:
            self.lost += 1
            self._lost_in_a_row += 1
            if not self._lost_in_a_row * self._period_s <= limits.lost_s:
                raise Fault(
                    "RBL525",
                    f"seam sensor {self.name} has lost the seam for "
                    f"{self._lost_in_a_row * self._period_s * 1e3:.0f} ms",
                )
            return
        self._lost_in_a_row = 0
        # a reading beyond the bound is a wrong one (spatter, another edge): it must not move the arm by even one cycle
        far, turned = norm(reading[:3]), float(np.abs(reading[3:]).max())
        if not (far <= limits.most and turned <= limits.most_turn):
            away, most = beside(far / MM, limits.most / MM, form=".2f")
            turn, most_turn = beside(turned / DEG, limits.most_turn / DEG, form=".2f")
            raise Fault(
                "RBL524",
                f"seam sensor {self.name} reads a deviation of {away} mm and {turn} deg, more than "
                f"{most} mm or {most_turn} deg",
            )
        self._target = np.array(reading, dtype=np.float64)

    def settle(self) -> None:
        """Come to rest near the deviation in force: the arm is about to stop, readings are ignored from now on."""
        self._target = self.deviation.copy()

    def freeze(self, deviation: Array) -> None:
        """Hold a deviation (6,) from now on: the last one that the joints could follow."""
        self.deviation, self._target = np.array(deviation), np.array(deviation)
        self._rate = np.zeros(6)

    def follow(self) -> None:
        """Let the deviation follow the last reading for one cycle: a critically damped second-order lag, exact."""
        tau, h = self._limits.filter_s, self._period_s
        if tau <= 0.0:
            self.deviation = self._target.copy()
            return
        away = self.deviation - self._target
        # the solution of tau^2 d'' + 2 tau d' + d = target over one cycle; an Euler step would depend on the cycle time
        drive = self._rate + away / tau
        decay = math.exp(-h / tau)
        self.deviation = self._target + (away + drive * h) * decay
        self._rate = (self._rate - drive * h / tau) * decay


def superposed(X: Array, deviation: Array) -> Array:
    """Return the pose X (4, 4) shifted by a deviation (6,), m and rad in the world frame: [R_d R, p + d]."""
    return pose(X[:3, 3] + deviation[:3], matmul(rotation_from_rpy(deviation[3:]), X[:3, :3]))


@dataclass(frozen=True, slots=True, kw_only=True)
class CalculatedMove:
    """A straight move as planned, without deviation.

    ``line``: the path from its calculated start; ``s`` (N + 1,): path parameter of the samples, ``period_s`` apart;
    ``q_end`` (n,) rad: its end; ``switch``: sample at which the wrist leaves the path, None where it never does.
    """

    line: LineSolver
    s: Array
    period_s: float
    q_end: Array
    switch: int | None


class SeamMove:
    """One straight move under a tracker, point by point; q_start (n,) rad is where the arm really is."""

    def __init__(self, calculated: CalculatedMove, q_start: Array, tracker: SeamTracker, options: WristOptions) -> None:
        line, s, period_s, q_end = calculated.line, calculated.s, calculated.period_s, calculated.q_end
        arm = line.arm
        self._line, self._s, self._switch, self._tracker = line, s, calculated.switch, tracker
        self._kinematics, self._X_tool_flange = arm.kinematics, inverse(arm.X_flange_tool)
        six = arm.kinematics.n == MAIN_AXES + WRIST_AXES
        self._frozen = FrozenWrist(arm.kinematics, arm.X_flange_tool) if six else None
        self._poses = line.path.poses(s)
        self._travel = line.path.X_end[:3, 3] - line.path.X_start[:3, 3]
        self._end_branch = arm.kinematics.branch_of(q_end)
        self._limits = WristLimits.of(arm.spec, options)
        self._options = options
        timing = PathTiming(s=s, period_s=period_s, length=line.path.length)
        self._conditions = Conditions(timing, q_start[-WRIST_AXES:], self._limits, options)
        self._most_step = arm.spec.per_axis("limits", "speed") * period_s * SPEED_SLACK
        self._lower, self._upper = arm.spec.lower, arm.spec.upper
        self.before, self.here = q_start, q_start
        self._q_calculated = q_end
        self.q_end = np.array(q_end)
        """Joint angles (n,) of the end with the deviation in force, rad."""
        self.law: WristLaw | None = None
        """Joint curve of the wrist once it has left the path."""
        self._side: Side | None = None

    def next(self, n: int) -> tuple[Array, Fault | None]:
        """Read the sensor and return the set-point (n,) of sample n, and the fault that has to stop the arm, if any.

        Where the seam cannot be followed the deviation stays as it was, so the set-point goes on along the path.
        """
        held, fault = self._tracker.deviation, None
        try:
            self._tracker.observe(float(self._s[n]) * self._line.path.length, self._travel)
            return self.row(n), None
        except Fault as found:
            fault = found
        if fault.code == "RBL526":  # the joints cannot follow: back to the deviation of the cycle before
            self._tracker.freeze(held)
        else:
            self._tracker.settle()
        try:
            return self.row(n), fault
        except Fault:
            return self.here, fault

    @property
    def tracker(self) -> SeamTracker:
        """The tracker whose deviation the move follows."""
        return self._tracker

    def copy(self, tracker: SeamTracker) -> "SeamMove":
        """Return a move that goes on alike under another tracker."""
        twin = copy.copy(self)
        twin._tracker = tracker
        return twin

    def finish(self) -> None:
        """Add the length of the ended move to the tracker, whose next move begins at the calculated end of this one."""
        self._tracker.distance += self._line.path.length
        self._tracker.q_calculated = self._q_calculated

    def row(self, n: int) -> Array:
        """Return the joint set-point (n,) of sample n for the deviation in force; ``Fault`` RBL526."""
        deviation = self._tracker.deviation
        X = superposed(self._poses[n], deviation)
        seen = self._solve(superposed(self._line.path.X_end, deviation), self._end_branch, self.q_end)
        if np.isfinite(seen).all():  # while the shifted end is out of reach, the last one is kept
            self.q_end = seen
        end = self.q_end[-WRIST_AXES:]
        if self.law is None:
            q = self._solve(X, self._line.branch, self.here)
            switched = self._switch is not None and n > self._switch
            if self._frozen is not None and (switched or not np.isfinite(q).all() or self._met(n, q, end)):
                self._leave(n, end, self._frozen)
        if self.law is not None and self._frozen is not None:
            # the law was made for the end as it was at the switch; what the end has moved since is added in proportion
            share = (self._s[n] - self.law.s_switch) / (1.0 - self.law.s_switch)
            wrist = self.law.angles(self._s[n : n + 1]) + share * (end - self.law.end)
            q = self._frozen.solve(X[None, :3, 3], wrist, self.here, self._side)[0]
        self._check(n, q)
        self.before, self.here = self.here, q
        return q

    def _solve(self, X_base_tool: Array, branch: Branch, near: Array) -> Array:
        return self._kinematics.inverse_branch(matmul(X_base_tool, self._X_tool_flange), branch, near)

    def _met(self, n: int, q: Array, end: Array) -> bool:
        """Return whether sample n meets an exception condition with the end as it is now, S61."""
        wrist, before = q[-WRIST_AXES:], self.here[-WRIST_AXES:]
        # C3 looks ahead along the tangent: samples to come are not known under a sensor
        soon = wrist + self._options.look_ahead * (wrist - before)
        outside = ~((self._limits.lower <= soon) & (soon <= self._limits.upper))
        met = self._conditions.met(slice(n, n + 1), wrist[None], before[None], end, outside[None])
        return any(bool(where.any()) for where in met.values())

    def _leave(self, n: int, end: Array, frozen: FrozenWrist) -> None:
        """Start the law to the end angles at the sample before n, S63."""
        # two samples give the slope at the switch; before the first cycle there is one, and the move starts from rest
        rows, s = np.stack([self.before, self.here]), self._s[[max(n - 2, 0), n - 1]]
        shape = self._options.shape
        self.law = law_from(
            rows[1:] if n == 1 else rows, s[1:] if n == 1 else s, 0 if n == 1 else 1, end, shape, self._options.width
        )
        self._side = frozen.side_of(self.here)

    def _check(self, n: int, q: Array) -> None:
        """Refuse a set-point q (n,) that the joints cannot follow; ``Fault`` RBL526.

        Accelerations are not checked: noise that passes the filter is in the command (docs/wrist.md).
        """
        where = f"at {100 * self._s[n]:.1f} % of the path"
        if not np.isfinite(q).all():
            raise Fault("RBL526", f"{where} the seam is out of reach")
        step = np.abs(q - self.here)
        if not (step <= self._most_step).all():
            axis = int(np.argmax(step / self._most_step))
            raise Fault(
                "RBL526",
                f"{where} J{axis + 1} would have to turn at "
                f"{step[axis] / self._most_step[axis] * SPEED_SLACK:.2f} times its limit to follow the "
                "seam",
            )
        if not ((q >= self._lower - 1e-9) & (q <= self._upper + 1e-9)).all():
            axis = int(np.argmax(np.maximum(self._lower - q, q - self._upper)))
            raise Fault("RBL526", f"{where} J{axis + 1} would leave its range to follow the seam")

    def rest(self, n: int) -> tuple[Array, bool]:
        """Return the set-points (k, n) from sample n on, as far as there are any, and whether they reach the end.

        The deviation settles meanwhile; no more readings are taken.
        """
        rows = []
        self._tracker.settle()
        try:
            for k in range(n, len(self._s)):
                self._tracker.follow()
                rows.append(self.row(k))
        except Fault:
            pass  # the arm has to stop before the sample that it cannot reach
        return np.array(rows).reshape(-1, len(self.here)), len(rows) == len(self._s) - n
