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
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.path_ik import MOST_SLOWDOWN
from runtime.motion.velocity_profile import SpeedLimits, profile
from runtime.robot.model.axis_kind import AxisKind
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

_MARGIN = 1.0 + 1e-6
"""Share by which a profile is slowed beyond what was measured, so that rounding does not ask for another round."""

_ROUNDS = 12
"""Profiles at most. The factor is exact while the same limit rules at the same place of the curve."""

_WELL_USED = 0.99
"""A slowed move that keeps its limits is slow enough; with this share of the ruling limit it is not too slow either."""


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

    def setpoints(self, q: Array) -> Array:
        """Return the set-points (N + 1, n) rad of a command along the curve over its joints q (N + 1, n)."""

    def refuse_singular(self, s: Array, q: Array, axis: int) -> NoReturn:
        """Raise ``Fault``: no speed is slow enough for ``axis``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pace:
    """The limits of timing: ``speed`` rad/s and ``acceleration`` rad/s2 (n,), as ``fine`` measures them.

    Of an axis that slides, by ``kinds``, they are m/s and m/s2. ``speed`` is already at the share ``override`` of all
    speeds.
    """

    fine: FineInterpolator
    speed: Array
    acceleration: Array
    period_s: float
    kinds: tuple[AxisKind, ...]
    override: float = 1.0

    @classmethod
    def of(cls, spec: RobotSpec, profile: Profile) -> "Pace":
        """Return the pace of a robot under a controller profile."""
        return cls(
            fine=FineInterpolator(profile.ticks_per_cycle, profile.period_s, np.zeros(spec.n)),
            speed=spec.per_axis("limits", "speed"),
            acceleration=spec.per_axis("limits", "acceleration"),
            period_s=profile.period_s,
            kinds=tuple(axis.kind for axis in spec.axes),
        )

    def overridden(self, override: float) -> "Pace":
        """Return the pace at a share ``override`` of all speeds."""
        return (
            self if override == 1.0 else replace(self, speed=self.speed * override, override=self.override * override)
        )

    def excess(self, q: Array) -> tuple[float, int, str]:
        """Return (time factor needed, axis, quantity) of the worst violation at the servo ticks; <= 1 is none."""
        dq, ddq = self.fine.peaks(q)
        # the same curve in k times the time: speeds fall by k, accelerations by k^2
        ratios = np.stack([dq / self.speed, np.sqrt(ddq / self.acceleration)])
        kind, axis = np.unravel_index(int(np.argmax(ratios)), ratios.shape)
        return float(ratios[kind, axis]), int(axis), ("speed", "acceleration")[kind]

    def within_limits(
        self, curve: Curve, limits: SpeedLimits, duration: float | None
    ) -> tuple[Array, Array, Slowdown | None]:
        """Return s (N + 1,), q (N + 1, n) and what slowed them, of the fastest profile that holds the limits.

        ``duration`` s counts where it is longer. ``Fault`` of the curve, or RBL404 for a move of too long a time.
        """
        s = profile(limits, self.period_s, duration)
        programmed = len(s) - 1
        fastest = len(profile(limits, self.period_s)) - 1 if duration is not None else programmed
        too_fast, found, worst = 0, None, (0, "")  # most cycles that were too few; the plan that holds
        for _ in range(_ROUNDS):
            q = curve.joints(s)
            ratio, axis, quantity = self.excess(curve.setpoints(q))
            cycles = len(s) - 1
            if ratio <= 1.0:
                found = s, q
                if cycles == programmed or ratio > _WELL_USED:
                    break
            else:
                too_fast, worst = cycles, (axis, quantity)
                if not cycles * ratio <= MOST_SLOWDOWN * programmed:
                    curve.refuse_singular(s, q, axis)
            # a plan that was slowed too far is made faster again, but never with cycles known to be too few
            needed = max(cycles * ratio * _MARGIN, too_fast + 1)
            if found is not None and needed >= len(found[0]) - 1:
                break
            s = self._slower(limits, duration, fastest, needed, too_fast)
        if found is None:
            curve.refuse_singular(s, curve.joints(s), worst[0])
        return *found, _slowdown((len(found[0]) - 1) / programmed, *worst)

    def _slower(self, limits: SpeedLimits, duration: float | None, fastest: int, needed: float, too_fast: int) -> Array:
        """Return s of a profile of ``needed`` cycles or little more, in any case more than ``too_fast``.

        ``fastest``: the cycles that the limits take without slowing.
        """
        s = profile(limits.slowed(needed / fastest), self.period_s, duration)
        while len(s) - 1 <= too_fast:  # a slower profile may round to the same cycles
            needed += 1.0
            s = profile(limits.slowed(needed / fastest), self.period_s, duration)
        return s

    def slow_note(self, slowdown: Slowdown | None, cycles: int) -> tuple[str, ...]:
        """Return the note of a move that was slowed to so many cycles."""
        if slowdown is None:
            return ()
        limit = (self.speed if slowdown.quantity == "speed" else self.acceleration)[slowdown.axis]
        per = "/s" if slowdown.quantity == "speed" else "/s2"
        # an override lowers the speeds and no acceleration (``cartesian_planner``)
        under = f" under OVERRIDE {100.0 * self.override:g}" if self.override < 1.0 and per == "/s" else ""
        return (
            f"slowed {slowdown.factor:.2f} times to {cycles * self.period_s:.3f} s: J{slowdown.axis + 1} "
            f"{slowdown.quantity} is limited to {self.kinds[slowdown.axis].text(limit)}{per}{under}",
        )

    def time_note(self, duration: float | None, cycles: int) -> tuple[str, ...]:
        """Return the note of a move that takes longer than its TIME, ``duration`` s, by more than one cycle."""
        seconds = cycles * self.period_s
        if duration is None or seconds <= duration + self.period_s:
            return ()
        return (f"TIME {duration:g} s is too short, the move takes {seconds:.3f} s",)


def _slowdown(factor: float, axis: int, quantity: str) -> Slowdown | None:
    return Slowdown(factor=factor, axis=axis, quantity=quantity) if factor > 1.0 else None
