"""Which limit rules a planned move, and what its programmed speed alone would take: for what people are shown.

A move is bound by its programmed speed and the accelerations of the path, and by more: the turning of the tool, the
curvature of an arc, the joints. The first alone gives the time that a reader of the program expects; a path that is too
short to reach its speed takes that time, too. Of the others the one that needs the longest time rules. SI, rad.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from runtime.core.units import DEG, MM
from runtime.motion.cartesian_planner import MovePlan, arc_limits
from runtime.motion.commands import Command, MoveJoint
from runtime.motion.path import ArcPath
from runtime.motion.time_scaling import Slowdown
from runtime.motion.velocity_profile import bound, shortest_s
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

IN_PLACE = 1e-3
"""A tool whose point moves less than this, m, turns in place: its speed along the path is of no interest."""

LEAST_TURN = 0.01 * DEG
"""A tool that turns less, rad, does not turn."""
_HALVINGS = 40


@dataclass(frozen=True, slots=True, kw_only=True)
class Ruling:
    """What rules a move, ``why`` in words, and what would help, ``remedy``.

    ``asked_s``: the time that its programmed speed alone would take; ``peak`` m/s: the largest speed of the tool point
    in the plan. ``keeps`` m/s: a speed that alone would take as long as the plan does, 0 where a joint rules, which may
    rule at that speed as well. All are 0 for a move whose tool point has no path, or hardly one.
    """

    why: str
    remedy: str
    asked_s: float = 0.0
    peak: float = 0.0
    keeps: float = 0.0


def ruling(plan: MovePlan, command: Command, spec: RobotSpec, profile: Profile) -> Ruling:
    """Return what rules a plan of a move that has something to do."""
    path = plan.path
    if path is None or isinstance(command, MoveJoint):
        return _of_joints(plan, spec)
    limits, share = spec.path, command.acceleration
    speed = limits.max_speed if command.duration is not None else command.speed or limits.default_speed

    def takes(extent: float, speed: float, acceleration: float, jerk: float) -> float:
        each = bound([(extent, speed, acceleration * share, jerk * share)], profile.speed_shape)
        return shortest_s(each.overridden(plan.override))

    def along(speed: float) -> float:
        return takes(path.length, speed, limits.acceleration, limits.jerk)

    moves = path.length >= IN_PLACE
    there = f" on {path.length / MM:.1f} mm" if moves else ""
    asked_s = along(speed) if moves else 0.0
    most = f"at most {limits.acceleration * share / MM:g} mm/s2"
    rows = [(asked_s, f"the tool point is accelerated by {most}{there}", "make the path shorter")]
    turn = path.angle if path.angle >= LEAST_TURN else float(np.abs(plan.q[-1] - plan.q[0]).max())
    if turn >= LEAST_TURN:
        turns_s = takes(turn, limits.rotation_speed, limits.rotation_acceleration, limits.rotation_jerk)
        rows.append(
            (
                turns_s,
                f"the tool turns by {turn / DEG:.1f} deg{there}, at {limits.rotation_speed / DEG:g} deg/s at most",
                f"turn the tool {'on a longer path or in its own move' if moves else 'less'}",
            )
        )
    if isinstance(path, ArcPath) and moves:
        on_arc, _ = arc_limits(speed, limits.acceleration * share, limits.jerk * share, path.radius)
        rows.append(
            (
                along(on_arc),
                f"on a radius of {path.radius / MM:.1f} mm, {on_arc / MM:.1f} mm/s take all the "
                "acceleration of the path",
                "make the radius larger",
            )
        )
    longest_s, why, remedy = max(rows)
    slowdown = plan.slowdown
    of_joint = slowdown is not None and slowdown.factor * asked_s >= longest_s
    if slowdown is not None and of_joint:
        why = _joint_limit(slowdown, spec, plan.override)
        remedy = f"move the path away from where J{slowdown.axis + 1} has to turn fast, or go there with MOVEJ"
    if not moves:
        return Ruling(why=why, remedy=remedy)
    peak = float(np.diff(plan.s).max(initial=0.0)) * path.length / profile.period_s
    keeps = 0.0 if of_joint else _slower(along, speed, (len(plan.q) - 1) * profile.period_s)
    return Ruling(why=why, remedy=remedy, asked_s=asked_s, peak=peak, keeps=keeps)


def _of_joints(plan: MovePlan, spec: RobotSpec) -> Ruling:
    """Return what rules a joint move: the joint that needs the longest time for its turn, or was slowed for."""
    turns = np.abs(plan.q[-1] - plan.q[0])
    axis = int(np.argmax(turns / spec.per_axis("limits", "speed")))
    limits = spec.axes[axis].limits
    return Ruling(
        why=f"J{axis + 1} turns by {turns[axis] / DEG:.1f} deg, at most at {limits.speed / DEG:g} deg/s and "
        f"{limits.acceleration / DEG:g} deg/s2",
        remedy=f"turn J{axis + 1} less",
    )


def _joint_limit(slowdown: Slowdown, spec: RobotSpec, override: float) -> str:
    limits = spec.axes[slowdown.axis].limits
    value, unit = (limits.speed, "deg/s") if slowdown.quantity == "speed" else (limits.acceleration, "deg/s2")
    under = f" under OVERRIDE {100.0 * override:g}" if override < 1.0 and slowdown.quantity == "speed" else ""
    return f"J{slowdown.axis + 1} is at its {slowdown.quantity} limit of {value / DEG:g} {unit}{under}"


def _slower(takes: Callable[[float], float], speed: float, seconds: float) -> float:
    """Return a speed m/s, at most ``speed``, that alone needs ``seconds`` or little more."""
    low, high = 0.0, speed
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if takes(middle) >= seconds else (low, middle)
        if high - low <= 1e-3 * high:
            break
    return low
