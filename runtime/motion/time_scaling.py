"""Limits of the joints, how far samples of a move pass them, and notes on moves that they make longer; rad, s."""

from dataclasses import dataclass, replace

import numpy as np

from runtime.core.frames import Array
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.single import QUANTITIES, Slowdown
from runtime.robot.model.axis_kind import AxisKind
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile


@dataclass(frozen=True, slots=True, kw_only=True)
class Pace:
    """Limits of the joints: ``speed`` rad/s, ``acceleration`` rad/s2 and ``jerk`` rad/s3 (n,), as ``fine`` measures.

    Of an axis that slides, by ``kinds``, they are in m. ``speed`` is already at the share ``override`` of all
    speeds.
    """

    fine: FineInterpolator
    speed: Array
    acceleration: Array
    jerk: Array
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
            jerk=spec.per_axis("limits", "jerk"),
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

    def slow_note(self, slowdown: Slowdown | None, cycles: int) -> tuple[str, ...]:
        """Return the note of a move that was slowed to so many cycles."""
        if slowdown is None:
            return ()
        kind = QUANTITIES.index(slowdown.quantity)
        limit, per = (self.speed, self.acceleration, self.jerk)[kind][slowdown.axis], ("/s", "/s2", "/s3")[kind]
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
