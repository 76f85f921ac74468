"""How much of each limit a planned chain takes, cycle by cycle: what is near 1 is what keeps it from being faster.

Taken from the rows of a plan alone, however they were timed. Of the joints speed, acceleration and jerk are bounds of
the command, from the differences of its set-points (``fine_interpolator``); tool point and tool are measured where the
rows put them. OVERRIDE lowers the limits of speeds, ACCEL those of accelerations. Called by ``Speeds``; m, rad, s.
"""

from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array, rotation_angles
from runtime.core.linear import matmul
from runtime.motion.chain.timing import Limits
from runtime.robot.kinematics.kinematics import Kinematics

QUANTITIES = ("speed", "acceleration", "jerk")
"""What a joint has limits of, in the order of ``LimitUse.joints``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Taken:
    """Rows q (N + 1, n) rad of a chain with their set-points, and for each of the N cycles between them its move's:

    ``override``, share of all speeds, and the limits of the tool, m/s2, rad/s and rad/s2, infinite on joint moves.
    ``cap``, m/s, is what the point of the tool ``X_flange_tool`` (4, 4) and the flange keep to, infinite without one.
    ``moving``: the chain begins in motion, which is taken to be even until then.
    """

    q: Array
    setpoints: Array
    override: Array
    acceleration: Array
    turning_speed: Array
    turning_acceleration: Array
    cap: float
    X_flange_tool: Array
    moving: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitUse:
    """What is taken in each of the N cycles, limits as shares; an acceleration is the larger one of its ends.

    ``tool`` (N,) m/s is the speed of the tool point, ``joints`` (3, N, n) are shares of speed, acceleration and jerk,
    ``turning`` (2, N) those of the tool's turning: speed and acceleration. ``gaining`` (N,) is the share of its
    acceleration that the tool point takes, ``across`` (N,) the part of that which bends the path; ``cap`` (N,) the
    share of the cap.
    """

    tool: Array
    joints: Array
    turning: Array
    gaining: Array
    across: Array
    cap: Array

    @property
    def joint_speed(self) -> Array:
        """The share (N,) of its speed limit that the fastest joint takes, without an override."""
        return np.asarray(self.joints[0].max(axis=1, initial=0.0))


def limit_use(taken: Taken, kinematics: Kinematics, limits: Limits) -> LimitUse:
    """Return what a chain of at least two rows takes; ``limits`` of the joints."""
    h = limits.period_s
    flange = kinematics.forward(taken.q)
    X = matmul(flange, taken.X_flange_tool)
    steps = np.diff(X[:, :3, 3], axis=0) / h
    tool = _lengths(steps)
    gained = np.diff(_between(steps, taken.moving), axis=0) / h
    turning = rotation_angles(X[:-1, :3, :3], X[1:, :3, :3]) / h
    # the cap holds for the flange as well, which may be the faster one
    fastest = np.maximum(tool, _lengths(np.diff(flange[:, :3, 3], axis=0)) / h)
    joints = _joints(taken.setpoints, limits, taken.moving)
    # an override is a share of the limits of speeds
    joints[0] /= taken.override[:, None]
    return LimitUse(
        tool=tool,
        joints=joints,
        turning=np.stack(
            [
                turning / (taken.turning_speed * taken.override),
                _either_end(np.abs(np.diff(_between(turning, taken.moving))) / h) / taken.turning_acceleration,
            ]
        ),
        gaining=_either_end(_lengths(gained)) / taken.acceleration,
        across=_either_end(_across(gained, steps, taken.moving)) / taken.acceleration,
        cap=fastest / taken.cap,
    )


def _joints(setpoints: Array, limits: Limits, moving: bool) -> Array:
    """Return the shares (3, N, n) of speed, acceleration and jerk that the joints take."""
    h = limits.period_s
    # two set-points alike stand before the first and after the last
    before = 2.0 * setpoints[:1] - setpoints[1:2] if moving else setpoints[:1]
    steps = np.diff(np.concatenate([before, setpoints, setpoints[-1:]]), axis=0)
    second = np.diff(steps, axis=0)
    third = np.diff(second, axis=0)
    shares = (
        np.abs(steps[1:-1]) / (limits.speed * h),
        _either_end(np.abs(second)) / (limits.acceleration * h**2),
        np.abs(third) / (limits.jerk * h**3),
    )
    return np.stack(shares)


def _between(values: Array, moving: bool) -> Array:
    """Return values (N, ...) between those before and after them (N + 2, ...): zeros, and the first where it moves."""
    still = np.zeros_like(values[:1])
    return np.concatenate([values[:1] if moving else still, values, still])


def _either_end(values: Array) -> Array:
    """Return the larger (N, ...) of the values (N + 1, ...) at the ends of each cycle."""
    return np.maximum(values[:-1], values[1:])


def _lengths(vectors: Array) -> Array:
    return np.asarray(np.sqrt((vectors**2).sum(axis=-1)))


def _across(gained: Array, steps: Array, moving: bool) -> Array:
    """Return the part (N + 1,) of accelerations (N + 1, 3) that lies across the motion at speeds (N, 3)."""
    between = _between(steps, moving)
    along = between[:-1] + between[1:]
    size = np.maximum(_lengths(along), 1e-12)
    with_it = (gained * along).sum(axis=1) / size
    return np.asarray(np.sqrt(np.maximum((gained**2).sum(axis=1) - with_it**2, 0.0)))
