"""Which limit rules a planned move, and the time of its programmed speed alone: for findings and warnings.

A move is bound by its programmed speed and the accelerations of the path, and by more: the turning of the tool, the
curvature of the path, the joints. The first alone gives the time that a reader of the program expects; a path that is
too short to reach its speed takes that time, too. Of the others the one that needs the longest time rules. SI, rad.
Called after planning, for moves that take longer than programmed (docs/decisions/0030).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array
from runtime.core.units import DEG, MM
from runtime.motion.cartesian_planner import MovePlan, arc_limits
from runtime.motion.commands import Command, MoveJoint
from runtime.motion.path import LinePath, Path
from runtime.motion.time_scaling import Slowdown
from runtime.motion.velocity_profile import bound, shortest_s
from runtime.robot.model.drives import PathLimits
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

IN_PLACE = 1e-3
"""A tool whose point moves less than this, m, turns in place: its speed along the path is of no interest."""

LEAST_TURN = 0.01 * DEG
"""A tool that turns less, rad, does not turn."""
_HALVINGS = 40
"""More than enough for a speed to 0.1 %, which is where the search ends."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ruling:
    """The limit that rules a move: ``why`` in words, and ``remedy``, what would help.

    ``programmed_s``: the time that its speed alone would take; ``peak`` m/s: the largest speed of the tool point as it
    is carried out. ``keeps`` m/s: a speed that alone would take as long, 0 where a joint rules, which may rule at that
    speed as well. All are 0 for a move whose tool point has no path, or hardly one.
    """

    why: str
    remedy: str
    programmed_s: float = 0.0
    peak: float = 0.0
    keeps: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class _Bound:
    """A limit that may rule a move: the time that it alone needs, s; what it is and what would help, in words."""

    seconds: float
    why: str
    remedy: str


@dataclass(frozen=True, slots=True, kw_only=True)
class _Times:
    """The times that the limits of one planned move need, each alone, under the move's own ACCEL and override."""

    plan: MovePlan
    command: Command
    limits: PathLimits
    profile: Profile

    @property
    def speed(self) -> float:
        """The programmed speed of the tool point, m/s; with TIME the largest one, since TIME rules then."""
        if self.command.duration is not None:
            return self.limits.max_speed
        return self.command.speed or self.limits.default_speed

    def takes(self, extent: float, speed: float, acceleration: float, jerk: float) -> float:
        """Return the time, s, of an extent, m or rad, under these limits of the robot."""
        share = self.command.acceleration
        each = bound([(extent, speed, acceleration * share, jerk * share)], self.profile.speed_shape)
        return shortest_s(each.overridden(self.plan.override))

    def along(self, path: Path, speed: float) -> float:
        """Return the time, s, of a path at a speed, m/s, under the accelerations of the tool point."""
        return self.takes(path.length, speed, self.limits.acceleration, self.limits.jerk)


def ruling(plan: MovePlan, s: Array, command: Command, spec: RobotSpec, profile: Profile) -> Ruling:
    """Return what rules a plan of a move that has something to do; ``Fault`` RBL404 as its planner raises it.

    s (K,): the share of its path that is passed at each of its rows, alone or in a chain.
    """
    path = plan.path
    if path is None or isinstance(command, MoveJoint):
        return _of_joints(plan, spec)
    times = _Times(plan=plan, command=command, limits=spec.path, profile=profile)
    moves = path.length >= IN_PLACE
    # each limit is timed as if it were alone; the longest time is that of the limit that rules
    bounds = [_accelerating(times, path, moves), _turning(times, path, moves), _curving(times, path, moves)]
    rows = [(each.seconds, each.why, each.remedy) for each in bounds if each is not None]
    programmed_s = rows[0][0]
    longest_s, why, remedy = max(rows)
    slowdown = plan.slowdown
    # a joint rules where the slowing that it needed outweighs the longest of the path's own limits
    of_joint = slowdown is not None and slowdown.factor * programmed_s >= longest_s
    if slowdown is not None and of_joint:
        why = _joint_limit(slowdown, spec, plan.override)
        remedy = f"move the path away from where J{slowdown.axis + 1} has to turn fast, or go there with MOVEJ"
    if not moves:
        return Ruling(why=why, remedy=remedy)
    peak = float(np.diff(s).max(initial=0.0)) * path.length / profile.period_s
    seconds = (len(s) - 1) * profile.period_s
    keeps = 0.0 if of_joint else _slower(lambda speed: times.along(path, speed), times.speed, seconds)
    return Ruling(why=why, remedy=remedy, programmed_s=programmed_s, peak=peak, keeps=keeps)


def _accelerating(times: _Times, path: Path, moves: bool) -> _Bound:
    """Return the programmed speed with the accelerations of the path: what a reader of the program expects."""
    most = f"at most {times.limits.acceleration * times.command.acceleration / MM:g} mm/s2"
    return _Bound(
        seconds=times.along(path, times.speed) if moves else 0.0,
        why=f"the tool point is accelerated by {most}{_on(path, moves)}",
        remedy="make the path shorter",
    )


def _turning(times: _Times, path: Path, moves: bool) -> _Bound | None:
    """Return the turning of the tool, or of the wrist where the tool keeps its pose; None where nothing turns."""
    limits, q = times.limits, times.plan.q
    turn = path.angle if path.angle >= LEAST_TURN else float(np.abs(q[-1] - q[0]).max())
    if turn < LEAST_TURN:
        return None
    return _Bound(
        seconds=times.takes(turn, limits.rotation_speed, limits.rotation_acceleration, limits.rotation_jerk),
        why=f"the tool turns by {turn / DEG:.1f} deg{_on(path, moves)}, at {limits.rotation_speed / DEG:g} deg/s at "
        "most",
        remedy=f"turn the tool {'on a longer path or in its own move' if moves else 'less'}",
    )


def _curving(times: _Times, path: Path, moves: bool) -> _Bound | None:
    """Return the curvature of a path, whose acceleration towards the centre bounds the speed; None on a line."""
    if isinstance(path, LinePath) or not moves:
        return None
    share, limits = times.command.acceleration, times.limits
    on_arc, _ = arc_limits(times.speed, limits.acceleration * share, limits.jerk * share, path.radius)
    return _Bound(
        seconds=times.along(path, on_arc),
        why=f"on a radius of {path.radius / MM:.1f} mm, {on_arc / MM:.1f} mm/s take all the acceleration of the path",
        remedy="make the radius larger",
    )


def _on(path: Path, moves: bool) -> str:
    return f" on {path.length / MM:.1f} mm" if moves else ""


def _of_joints(plan: MovePlan, spec: RobotSpec) -> Ruling:
    """Return what rules a joint move: the joint that needs the longest time for its turn, or was slowed for."""
    turns = np.abs(plan.q[-1] - plan.q[0])
    axis = int(np.argmax(turns / spec.per_axis("limits", "speed")))
    limits, kind = spec.axes[axis].limits, spec.axes[axis].kind
    return Ruling(
        why=f"J{axis + 1} {kind.moves} by {kind.text(turns[axis], '.1f')}, at most at {kind.text(limits.speed)}/s and "
        f"{kind.text(limits.acceleration)}/s2",
        remedy=f"{kind.moves.removesuffix('s')} J{axis + 1} less",
    )


def _joint_limit(slowdown: Slowdown, spec: RobotSpec, override: float) -> str:
    """Return the joint limit for which a plan was slowed, in words."""
    limits = spec.axes[slowdown.axis].limits
    value, per = (limits.speed, "/s") if slowdown.quantity == "speed" else (limits.acceleration, "/s2")
    under = f" under OVERRIDE {100.0 * override:g}" if override < 1.0 and slowdown.quantity == "speed" else ""
    return f"J{slowdown.axis + 1} is at its {slowdown.quantity} limit of {limits.kind.text(value)}{per}{under}"


def _slower(takes: Callable[[float], float], speed: float, seconds: float) -> float:
    """Return a speed m/s, at most ``speed``, that alone needs ``seconds`` or little more."""
    # by halving: the time falls with the speed, but through Ruckig's cases there is no formula to invert
    low, high = 0.0, speed
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if takes(middle) >= seconds else (low, middle)
        if high - low <= 1e-3 * high:
            break
    return low
