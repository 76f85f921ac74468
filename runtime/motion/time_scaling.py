"""Timing a curve in joint space so that every joint keeps its limits where the servo sees them.

Joint speeds and accelerations are measured at every tick of the fine interpolation. Where they pass the robot's limits
the whole profile is slowed by one factor,

    k = max(speed ratio, sqrt(acceleration ratio)),

and the curve is sampled again, until it holds them: the path stays, the time grows, and ``Slowdown`` says by how much
and because of which axis. Called by the planners of all moves; units rad, s.
"""

from dataclasses import dataclass, replace
from typing import NoReturn, Protocol

import numpy as np

from runtime.core.frames import Array
from runtime.core.units import DEG
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.path_ik import MOST_SLOWDOWN
from runtime.motion.velocity_profile import SpeedLimits, profile
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

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


class Curve(Protocol):
    """A curve in joint space over a parameter from 0 to 1."""

    def joints(self, s: Array) -> Array:
        """Return q (N, n) rad at s (N,); ``Fault`` where there is none."""

    def refuse_singular(self, s: Array, q: Array, axis: int) -> NoReturn:
        """Raise ``Fault``: no speed is slow enough for ``axis``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pace:
    """What bounds the timing: ``fine`` measures, ``speed`` rad/s and ``acceleration`` rad/s2 (n,) are the limits, at a
    share ``override`` of all speeds."""

    fine: FineInterpolator
    speed: Array
    acceleration: Array
    period_s: float
    override: float = 1.0

    @classmethod
    def of(cls, spec: RobotSpec, profile: Profile) -> "Pace":
        """Return the pace of a robot under a controller profile."""
        return cls(
            fine=FineInterpolator(profile.ticks_per_cycle, profile.period_s, np.zeros(spec.n)),
            speed=spec.per_axis("limits", "speed"),
            acceleration=spec.per_axis("limits", "acceleration"),
            period_s=profile.period_s,
        )

    def overridden(self, override: float) -> "Pace":
        """Return the pace at a share ``override`` of all speeds."""
        return (
            self if override == 1.0 else replace(self, speed=self.speed * override, override=self.override * override)
        )

    def excess(self, q: Array) -> tuple[float, int, str]:
        """Return (time factor needed, axis, quantity) of the worst violation at the servo ticks; <= 1 is none."""
        dq, ddq = self.fine.peaks(q)
        ratios = np.stack([dq / self.speed, np.sqrt(ddq / self.acceleration)])
        kind, axis = np.unravel_index(int(np.argmax(ratios)), ratios.shape)
        return float(ratios[kind, axis]), int(axis), ("speed", "acceleration")[kind]

    def within_limits(
        self, curve: Curve, limits: SpeedLimits, duration: float | None
    ) -> tuple[Array, Array, Slowdown | None]:
        """Return s (N + 1,), q (N + 1, n) and what slowed them, of the fastest profile that holds the limits.

        ``duration`` s is asked for where it is longer. ``Fault`` of the curve, or RBL404 for a move of too long a time.
        """
        period_s = self.period_s
        s = profile(limits, period_s, duration)
        asked = len(s) - 1
        fastest = len(profile(limits, period_s)) - 1 if duration is not None else asked
        too_fast, found, worst = 0, None, (0, "")  # most cycles that were too few; the plan that holds
        for _ in range(_ROUNDS):
            q = curve.joints(s)
            ratio, axis, quantity = self.excess(q)
            cycles = len(s) - 1
            if ratio <= 1.0:
                found = s, q
                if cycles == asked or ratio > _WELL_USED:
                    break
            else:
                too_fast, worst = cycles, (axis, quantity)
                if not cycles * ratio <= MOST_SLOWDOWN * asked:
                    curve.refuse_singular(s, q, axis)
            wanted = max(cycles * ratio * _MARGIN, too_fast + 1)
            if found is not None and wanted >= len(found[0]) - 1:
                break
            s = profile(limits.slowed(wanted / fastest), period_s, duration)
            while len(s) - 1 <= too_fast:  # a slower profile may round to the same cycles
                wanted += 1.0
                s = profile(limits.slowed(wanted / fastest), period_s, duration)
        if found is None:
            curve.refuse_singular(s, curve.joints(s), worst[0])
        factor = (len(found[0]) - 1) / asked
        return *found, Slowdown(factor=factor, axis=worst[0], quantity=worst[1]) if factor > 1.0 else None

    def slow_note(self, slowdown: Slowdown | None, cycles: int) -> tuple[str, ...]:
        """Return what to say of a move that was slowed to so many cycles."""
        if slowdown is None:
            return ()
        limit = (self.speed if slowdown.quantity == "speed" else self.acceleration)[slowdown.axis] / DEG
        unit = "deg/s" if slowdown.quantity == "speed" else "deg/s2"
        under = f" under OVERRIDE {100.0 * self.override:g}" if self.override < 1.0 and unit == "deg/s" else ""
        return (
            f"slowed {slowdown.factor:.2f} times to {cycles * self.period_s:.3f} s: J{slowdown.axis + 1} "
            f"{slowdown.quantity} is limited to {limit:g} {unit}{under}",
        )

    def time_note(self, duration: float | None, cycles: int) -> tuple[str, ...]:
        """Return what to say of a move that takes longer than the time asked for."""
        seconds = cycles * self.period_s
        if duration is None or seconds <= duration + self.period_s:
            return ()
        return (f"TIME {duration:g} s is too short, the move takes {seconds:.3f} s",)
