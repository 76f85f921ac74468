"""Planning a straight move: every set-point computed and checked before the first one is sent.

The path is sampled where the interpolator will send it, every 8 ms, solved for the joints in the arm configuration
it starts in, and refused when a sample is out of reach (RBL410), outside a joint's range (RBL411) or needs another
wrist configuration (RBL412). Joint speeds and accelerations are then measured where the servo sees them, at every
tick of the fine interpolation. Where they pass the robot's limits the whole profile is slowed by one factor,
``k = max(speed ratio, sqrt(acceleration ratio))``, and sampled again, until it holds them: the path stays, the time
grows, and the plan says by how much and because of which axis. What was checked is what runs: the interpolator
hands out these very rows (docs/decisions/0002).
"""

import math
from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from runtime.faults import Fault
from runtime.frames import Array, frozen, inverse
from runtime.motion.commands import MoveLinear
from runtime.motion.fine import FineInterpolator
from runtime.motion.path import LinePath
from runtime.motion.speed import MAX_DURATION, SpeedLimits, bound, profile
from runtime.profile import Profile
from runtime.robot.kinematics import Kinematics
from runtime.robot.opw import Branch
from runtime.robot.spec import PathLimits, RobotSpec
from runtime.units import DEG, MM

MOST_SLOWDOWN = 20.0
"""A move that would have to be slowed more than this runs too close to a singularity to be meant."""

RANGE_TOLERANCE = 1e-9
"""How far past its range a joint may be commanded, rad: rounding, nothing more."""

_NOTHING_TO_DO = 1e-9
_MARGIN = 1.0 + 1e-6
_ROUNDS = 12
_WELL_USED = 0.99
"""A slowed move is slow enough; when it also uses this much of the ruling limit it is not too slow either."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Slowdown:
    """Why and by how much a move was stretched: ``factor`` of time, the ruling axis (0-based), what it passed."""

    factor: float
    axis: int
    quantity: str


@dataclass(frozen=True, slots=True, kw_only=True)
class LinePlan:
    """A planned straight move: joint set-points ``q`` (N + 1, n) rad, from the start to the end, 8 ms apart.

    ``s`` (N + 1,) path parameter of each, ``slowdown`` None when the move runs as asked, ``notes`` for people.
    """

    path: LinePath
    s: Array
    q: Array
    slowdown: Slowdown | None
    notes: tuple[str, ...]


class LinePlanner:
    """Plans straight moves of the flange frame for one robot under one controller profile."""

    def __init__(self, spec: RobotSpec, kinematics: Kinematics, profile: Profile) -> None:
        self._spec = spec
        self._kinematics = kinematics
        self._profile = profile
        self._fine = FineInterpolator(profile.ticks_per_cycle, profile.period_s, np.zeros(spec.n))
        self._speed = spec.per_axis("limits", "speed")
        self._acceleration = spec.per_axis("limits", "acceleration")

    def plan(self, q_start: Array, command: MoveLinear, X_flange_tool: Array) -> LinePlan:
        """Return the plan of a move from joint angles q_start (n,) rad; ``Fault`` RBL404, 410, 411 or 412.

        ``X_flange_tool`` (4, 4) is the tool whose point moves.
        """
        X_start = self._kinematics.forward(q_start) @ X_flange_tool
        path = LinePath.between(X_start, command.X_world_tool)
        if path.length < _NOTHING_TO_DO and path.angle < _NOTHING_TO_DO:
            return LinePlan(path=path, s=np.ones(1), q=frozen([q_start]), slowdown=None, notes=("already there",))
        solver = _LineSolver(self._spec, self._kinematics, self._fine, path, X_flange_tool, q_start)
        limits = speed_limits(path, command, self._spec.path, self._profile)
        s, q, slowdown = self._within_limits(solver, limits, command.duration)
        notes = self._notes(s, slowdown, command)
        return LinePlan(path=path, s=frozen(s), q=frozen(q), slowdown=slowdown, notes=notes)

    def _within_limits(
        self, solver: "_LineSolver", limits: SpeedLimits, duration: float | None
    ) -> tuple[Array, Array, Slowdown | None]:
        period_s = self._profile.period_s
        s = profile(limits, period_s, duration)
        asked = len(s) - 1
        fastest = len(profile(limits, period_s)) - 1 if duration is not None else asked
        too_fast, found, worst = 0, None, (0, "")  # most cycles that were too few; the plan that holds
        for _ in range(_ROUNDS):
            q = solver.joints(s)
            ratio, axis, quantity = self._excess(q)
            cycles = len(s) - 1
            if ratio <= 1.0:
                found = s, q
                if cycles == asked or ratio > _WELL_USED:
                    break
            else:
                too_fast, worst = cycles, (axis, quantity)
                if cycles * ratio > MOST_SLOWDOWN * asked:
                    solver.refuse_singular(s, q, axis)
            wanted = max(cycles * ratio * _MARGIN, too_fast + 1)
            if found is not None and wanted >= len(found[0]) - 1:
                break
            s = profile(limits.slowed(wanted / fastest), period_s, duration)
        if found is None:
            solver.refuse_singular(s, solver.joints(s), worst[0])
        factor = (len(found[0]) - 1) / asked
        return *found, Slowdown(factor=factor, axis=worst[0], quantity=worst[1]) if factor > 1.0 else None

    def _excess(self, q: Array) -> tuple[float, int, str]:
        """Return (time factor needed, axis, quantity) of the worst violation at the servo ticks; <= 1 is none."""
        _, dq, ddq = np.abs(self._fine.expand(q)).max(axis=1)
        ratios = np.stack([dq / self._speed, np.sqrt(ddq / self._acceleration)])
        kind, axis = np.unravel_index(int(np.argmax(ratios)), ratios.shape)
        return float(ratios[kind, axis]), int(axis), ("speed", "acceleration")[kind]

    def _notes(self, s: Array, slowdown: Slowdown | None, command: MoveLinear) -> tuple[str, ...]:
        notes = []
        seconds = (len(s) - 1) * self._profile.period_s
        if slowdown is not None:
            limit = (self._speed if slowdown.quantity == "speed" else self._acceleration)[slowdown.axis] / DEG
            unit = "deg/s" if slowdown.quantity == "speed" else "deg/s2"
            notes.append(
                f"slowed {slowdown.factor:.2f} times to {seconds:.3f} s: J{slowdown.axis + 1} {slowdown.quantity} "
                f"is limited to {limit:g} {unit}"
            )
        if command.duration is not None and seconds > command.duration + self._profile.period_s:
            notes.append(f"TIME {command.duration:g} s is too short, the move takes {seconds:.3f} s")
        return tuple(notes)


def speed_limits(path: LinePath, command: MoveLinear, robot: PathLimits, profile: Profile) -> SpeedLimits:
    """Return the bounds of the path parameter for a command; ``Fault`` RBL404 when it asks for the impossible."""
    speed = command.speed if command.speed is not None else robot.default_speed
    if command.duration is not None:
        speed = robot.max_speed
    for name, value, most in (
        ("SPEED in mm/s", speed / MM, robot.max_speed / MM),
        ("ACCEL in %", command.acceleration * 100.0, 100.0),
        ("TIME in s", command.duration if command.duration is not None else 1.0, MAX_DURATION),
    ):
        if not (0.0 < value <= most * (1.0 + 1e-12)):
            raise Fault("RBL404", f"{name} is {value:g} and must be above 0 and at most {most:g}")
    share = command.acceleration
    position = (path.length, speed, robot.acceleration * share, robot.jerk * share)
    turning = (robot.rotation_speed, robot.rotation_acceleration * share, robot.rotation_jerk * share)
    return bound([position, (path.angle, *turning)], profile.speed_shape)


class _LineSolver:
    """Joint angles along one path, in one arm configuration, refused where there are none."""

    def __init__(
        self,
        spec: RobotSpec,
        kinematics: Kinematics,
        fine: FineInterpolator,
        path: LinePath,
        X_flange_tool: Array,
        q_start: Array,
    ) -> None:
        self._spec = spec
        self._kinematics = kinematics
        self._fine = fine
        self._path = path
        self._X_tool_flange = inverse(X_flange_tool)
        self._q_start = q_start
        self._branch: Branch = kinematics.branch_of(q_start)

    def joints(self, s: Array) -> Array:
        """Return q (N + 1, n) at path parameters s, continuous from the start; ``Fault`` RBL410, 411, 412."""
        q = self._kinematics.inverse_branch(self._path.poses(s) @ self._X_tool_flange, self._branch, self._q_start)
        self._check_reach(s, q)
        q = np.unwrap(q, axis=0) + 0.0
        q += 2.0 * math.pi * np.round((self._q_start - q[0]) / (2.0 * math.pi))
        self._check_continuity(s, q)
        q[0] = self._q_start
        self._check_range(s, q)
        return q

    def _check_reach(self, s: Array, q: Array) -> None:
        bad = ~np.isfinite(q).all(axis=1)
        if not bad.any():
            return
        first = int(np.argmax(bad))
        place = self._path.poses(s[first : first + 1])[0, :3, 3] / MM
        raise Fault(
            "RBL410",
            f"the point ({place[0]:.1f}, {place[1]:.1f}, {place[2]:.1f}) mm at {100 * s[first]:.1f} % of the path is "
            f"out of reach of {self._spec.name} ({self._branch})",
        )

    def _check_continuity(self, s: Array, q: Array) -> None:
        jumps = np.abs(np.diff(q, axis=0))
        if np.abs(q[0] - self._q_start).max() > 1e-3:  # the start is itself at a singularity
            self.refuse_singular(s[:1], q, int(np.argmax(np.abs(q[0] - self._q_start))))
        if len(jumps) > 4 and jumps.max() > math.pi / 4:
            step, axis = np.unravel_index(int(np.argmax(jumps)), jumps.shape)
            self.refuse_singular(s[step : step + 1], q, int(axis))

    def _check_range(self, s: Array, q: Array) -> None:
        """Refuse a path that leaves a joint's range at any servo tick: between set-points the command may pass them."""
        positions = self._fine.expand(q)[0]
        excess = np.maximum(self._spec.lower - positions, positions - self._spec.upper)
        axis = int(np.argmax(excess.max(axis=0)))
        worst = int(np.argmax(excess[:, axis]))
        if excess[worst, axis] <= RANGE_TOLERANCE:
            return
        first = int(np.argmax(excess[:, axis] > RANGE_TOLERANCE)) // self._fine.ticks
        limits = self._spec.axes[axis].limits
        limit = limits.lower if positions[worst, axis] < limits.lower else limits.upper
        raise Fault(
            "RBL411",
            f"J{axis + 1} would pass its limit of {limit / DEG:g} deg by {excess[worst, axis] / DEG:.4g} deg, "
            f"first at {100 * s[min(first, len(s) - 1)]:.1f} % of the path",
        )

    def refuse_singular(self, s: Array, q: Array, axis: int) -> NoReturn:
        """Raise ``Fault`` RBL412 where axis moves most between two samples."""
        where = s[0]
        if len(s) == len(q) and len(s) > 1:
            where = s[int(np.argmax(np.abs(np.diff(q[:, axis]))))]
        raise Fault(
            "RBL412",
            f"at {100 * where:.1f} % of the straight path J{axis + 1} would have to turn too fast: it passes a "
            f"singularity, or its end needs another configuration than {self._branch}",
        )
