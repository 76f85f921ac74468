"""Speed along a path: jerk-limited or trapezoidal, from rest to rest, in whole interpolation cycles.

The path parameter s runs from 0 to 1. Limits of the tool point (m/s, m/s2, m/s3) over the length and limits of
its turning over the angle both bound ds/dt; the smaller one rules. Ruckig finds the time-optimal profile, and its
``minimum_duration`` stretches it to a whole number of 8 ms cycles (or to TIME), so that the last set-point is exactly
the end. Called by the planners of all moves before anything moves; s without unit, time s.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import ruckig

from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen
from runtime.core.limits import TIME
from runtime.core.rounding import beside
from runtime.core.units import badness
from runtime.settings.profile import SpeedShape

MAX_DURATION = TIME.high
"""Longest move that is planned, s."""

EASINGS = (0.0, 1e-12, 1e-9)
"""Shares by which the jerk is lowered, one after another, until Ruckig finds a profile.

Where the plateau of acceleration has just no length, jerk^2 = 2 acceleration^3, rounding leaves Ruckig between two
cases: it finds none for about 5 % of such limits (a straight move of 60 mm with the Puma's limits is one).
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedLimits:
    """Bounds of ds/dt (1/s), its derivative (1/s2) and second derivative (1/s3; infinite: trapezoid)."""

    speed: float
    acceleration: float
    jerk: float

    def slowed(self, factor: float) -> "SpeedLimits":
        """Return the limits of the same motion played ``factor`` times slower."""
        return SpeedLimits(
            speed=self.speed / factor, acceleration=self.acceleration / factor**2, jerk=self.jerk / factor**3
        )

    def overridden(self, override: float) -> "SpeedLimits":
        """Return the limits at a share ``override`` of the speed; acceleration and jerk stay."""
        return self if override == 1.0 else replace(self, speed=self.speed * override)


def bound(extents: list[tuple[float, float, float, float]], shape: SpeedShape) -> SpeedLimits:
    """Return the limits of s from (extent, speed, acceleration, jerk) of position and of orientation.

    An extent of zero bounds nothing; at least one must be above zero (``ValueError``).
    """
    moving = [limits for limits in extents if not limits[0] <= 0.0]  # NaN counts as moving, and is refused later
    if not moving:
        raise ValueError("a path without extent has no speed")
    shares = [[value / extent for value in most] for extent, *most in moving]
    speed, acceleration, jerk = np.min(shares, axis=0).tolist()
    return SpeedLimits(speed=speed, acceleration=acceleration, jerk=math.inf if shape == "trapezoid" else jerk)


@lru_cache(maxsize=32)
def profile(limits: SpeedLimits, period_s: float, duration: float | None = None) -> Array:
    """Return s (N + 1,) at whole cycles, from exactly 0 to exactly 1, rest to rest; the same array when called again.

    ``duration`` s may only lengthen the move, which never gets faster than the limits. ``Fault`` RBL404 when it would
    take more than ``MAX_DURATION``.
    """
    # the bound first: a move of hours is refused without a profile
    seconds = max(_shortest(limits), duration or 0.0, key=badness)
    if seconds <= MAX_DURATION:
        seconds = max(_trajectory(limits, None).duration, seconds, key=badness)
    check_duration(seconds)
    # 1e-9 of a cycle is rounding: a move of exactly 100 cycles must not become one of 101
    cycles = max(1, math.ceil(seconds / period_s - 1e-9))
    trajectory = _trajectory(limits, cycles * period_s)
    s = np.array([trajectory.at_time(k * period_s)[0][0] for k in range(cycles + 1)])
    s[0], s[-1] = 0.0, 1.0  # Ruckig ends within rounding of 1; the end is to be the taught one to the last bit
    return frozen(np.clip(s, 0.0, 1.0))


def check_duration(seconds: float) -> None:
    """Refuse a move of more than ``MAX_DURATION``, or of no definite time; ``Fault`` RBL404."""
    if not seconds <= MAX_DURATION:
        takes, most = beside(seconds, MAX_DURATION, form=".4g")
        raise Fault("RBL404", f"the move would take {takes} s and may take at most {most} s")


def shortest_s(limits: SpeedLimits) -> float:
    """Return the time of the fastest profile within the limits, s; ``Fault`` RBL404 where there is none."""
    return float(_trajectory(limits, None).duration)


def _shortest(limits: SpeedLimits) -> float:
    """Return a time that no profile within the limits can beat, s.

    Over a distance of 1 each limit alone takes: 1 / v at constant speed, 2 sqrt(1 / a) with half the distance each to
    gain and to lose speed, and (32 / j)^(1/3) with four phases of constant jerk.
    """
    times = 1.0 / limits.speed, 2.0 * math.sqrt(1.0 / limits.acceleration), math.cbrt(32.0 / limits.jerk)
    return max(times, key=badness)


def _trajectory(limits: SpeedLimits, duration: float | None) -> "ruckig.Trajectory":
    """Return Ruckig's profile with the limits' jerk, or with the little less with which it finds one; RBL404."""
    for easing in EASINGS:
        trajectory = _calculated(limits, limits.jerk * (1.0 - easing), duration)
        if trajectory is not None:
            return trajectory
    slowest = f"{limits.speed:.3g} 1/s, {limits.acceleration:.3g} 1/s2, {limits.jerk:.3g} 1/s3"
    raise Fault("RBL404", f"no speed profile over the path keeps to {slowest}")


def _calculated(limits: SpeedLimits, jerk: float, duration: float | None) -> "ruckig.Trajectory | None":
    """Return Ruckig's profile from rest to rest over 1, None where it finds none."""
    request = ruckig.InputParameter(1)
    request.current_position, request.target_position = [0.0], [1.0]
    request.max_velocity = [limits.speed]
    request.max_acceleration = [limits.acceleration]
    request.max_jerk = [jerk]
    # a minimum duration stretches the phases of the profile, so a longer move keeps its shape and its limits
    if duration is not None:
        request.minimum_duration = duration
    trajectory = ruckig.Trajectory(1)
    try:
        result = ruckig.Ruckig(1).calculate(request, trajectory)
    except (ruckig.RuckigError, ValueError):  # an unlisted result code reaches Python as a ValueError
        return None
    return trajectory if result in (ruckig.Result.Working, ruckig.Result.Finished) else None
