"""Equal-time linear interpolation: the distance along the line after each step (document 004, 4.2 and 4.3).

    T = S / V,  N0 = round(T / dT),  Na = round(T0 / dT),  N = N0 + Na                                    S02
    S_i = a/2 (i dT)^2                              0 <= i <= Na            a = V / T0                    S03
          a/2 T0^2 + V (i dT - T0)                  Na < i <= N0
          S - a/2 ((N - i) dT)^2                    N0 < i <= N

T and T0 are seldom whole numbers of steps. With the rounded V' = S / (N0 dT), T0' = Na dT, a' = V' / T0' the branches
meet: S_0 = 0, S_N = S, and no second difference is above a' dT^2. A move too short for its ramps (N0 < Na) becomes a
triangle: V' = S / (Na dT). Distances may be in any unit; rounding is half up. Called by ``move`` for each profile.
"""

import math
from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array

MOST_STEPS = 200_000
"""Longest move in steps: 2000 s of 10 ms."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EqualTimeSteps:
    """The steps of one move over ``distance``: ``n0`` N0, ``na`` Na, each ``step_s`` dT long."""

    distance: float
    n0: int
    na: int
    step_s: float

    @classmethod
    def of(cls, distance: float, speed: float, ramp_s: float, step_s: float) -> "EqualTimeSteps":
        """Return the steps of a move over ``distance`` at ``speed`` V (distance/s) with ramps of ``ramp_s`` T0.

        ``ValueError`` when a value is not positive (``ramp_s`` may be 0) or the move has over ``MOST_STEPS`` steps.
        """
        if not (distance > 0.0 and speed > 0.0 and ramp_s >= 0.0 and step_s > 0.0):
            raise ValueError("distance, speed and step time must be above 0")
        if not distance / speed + ramp_s <= MOST_STEPS * step_s:
            raise ValueError(f"the move would take more than {MOST_STEPS} steps")
        # N0 is rounded once and the speed follows from it; rounding the speed instead would leave a part of a step over
        na = _half_up(ramp_s / step_s)
        return cls(distance=distance, n0=max(_half_up(distance / speed / step_s), na, 1), na=na, step_s=step_s)

    @property
    def n(self) -> int:
        """Number of steps N."""
        return self.n0 + self.na

    @property
    def speed(self) -> float:
        """Speed V' of the constant part, distance/s."""
        return self.distance / (self.n0 * self.step_s)

    @property
    def acceleration(self) -> float:
        """Acceleration a' of the ramps, distance/s2; 0 without ramps."""
        return self.speed / (self.na * self.step_s) if self.na else 0.0

    @property
    def seconds(self) -> float:
        """Duration N dT, s."""
        return self.n * self.step_s

    def distances(self) -> Array:
        """Return S_0 .. S_N (N + 1,), from exactly 0 to exactly ``distance``."""
        i = np.arange(self.n + 1)
        ramp, half = self.na * self.step_s, 0.5 * self.acceleration
        there = half * (i * self.step_s) ** 2
        along = half * ramp**2 + self.speed * (i * self.step_s - ramp)
        back = self.distance - half * ((self.n - i) * self.step_s) ** 2
        found = np.where(i <= self.na, there, np.where(i <= self.n0, along, back))
        found[-1] = self.distance  # the end to the last bit, not the last partial sum
        return found


def _half_up(x: float) -> int:
    return math.floor(x + 0.5)
