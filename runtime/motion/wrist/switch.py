r"""Straight moves through a change of the wrist configuration: when to leave the planned posture, and how.

A pose is met with either sign of J5. A straight move that keeps the sign and has to end with the other one arrives
with J4 and J6 half a turn away from where they were taught, and near J5 = 0 the two turn faster than they can. The
method of CN103429397A (Kobe Steel) watches *exception conditions* while the move follows its path. From the first
that is met until the end, the wrist axes go straight to the taught end angles and the main axes are solved for the
*position* of the path alone (``runtime.robot.kinematics.frozen_wrist``): the tool point stays on its line at its
speed, the posture deviates for a while, and the move ends exactly as taught.

    C1  |theta_ke - theta_k(n)| / T(n) > theta_kd        speed that the wrist would need from here, ``any`` or ``all``
    C2  T(n) or the distance left at most a given value
    C3  theta_k(n) outside the range of a wrist axis, looked ahead by some cycles
    C4  |theta_k(n) - theta_kk(n)| > theta_kw            away from the straight line start to end (or from either)
    C6  |theta_k(n) - theta_k(n-1)| / dt > theta_kd      the wrist turns too fast on its path: a singularity is near

k are the wrist axes, n the interpolation points, T(n) the time left. T is time left *at the speed of the move*, that is
(1 - s) over the largest ds/dt to come: with constant speed it is the document's T(t), and a move that brakes at its end
is judged by what its wrist really does. S7 and S8, |theta_e - theta| / T added in every cycle, are one straight line in
s.

    linear     theta(s) = theta_0 + (theta_e - theta_0) x,   x = (s - s_0) / (1 - s_0)                     (S7, S8)
    hermite    one cubic with the slope of the path at the switch and zero slope at the end             (Figs 7, 8)
    smooth     the slope passes from that of the path to a constant one within a share w of the rest: speed and posture
               without a jump, and a peak of 1 / (1 - w/2) instead of 1.5; not in the document

As functions of s they are one curve in joint space for every speed of the move, so slowing a move down changes nothing
else, and the wrist comes to rest with the tool. Angles rad; arrays of a path have its samples first.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array, frozen
from runtime.robot.kinematics.frozen_wrist import WRIST_AXES
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import WristOptions

Mask = NDArray[np.bool_]

Condition = Literal["C1", "C2", "C3", "C4", "C6", "reach", "end"]
CONDITIONS: dict[str, str] = {
    "C1": "wrist speed to the end",
    "C2": "time or distance left",
    "C3": "range of a wrist axis",
    "C4": "deviation from the reference",
    "C6": "wrist speed on the path",
    "reach": "no posture on the path",
    "end": "other end angles than those of the path",
}
"""What each condition watches, as messages and reports name it."""

SAME_ANGLES = 1e-8
"""Wrist angles within this, rad, of the taught ones are there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Trigger:
    """The first condition that a move meets: at sample ``index`` (1 or more), ``share`` of the path, on ``axis``.

    The axis is 0-based; None: no single one.
    """

    index: int
    share: float
    condition: Condition
    axis: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class WristLimits:
    """What the wrist axes may do, each (3,): ``speed`` theta_kd rad/s, ``lower`` and ``upper`` end of range, rad."""

    speed: Array
    lower: Array
    upper: Array

    @classmethod
    def of(cls, spec: RobotSpec, options: WristOptions) -> "WristLimits":
        """Return the ranges of a robot's wrist axes and theta_kd: that of the profile, else the robot's speed."""
        limits = spec.per_axis("limits", "speed")[-WRIST_AXES:]
        speed = np.broadcast_to(options.speed, WRIST_AXES) if options.speed else limits
        return cls(speed=speed, lower=spec.lower[-WRIST_AXES:], upper=spec.upper[-WRIST_AXES:])


@dataclass(frozen=True, slots=True, kw_only=True)
class PathTiming:
    """When a move is where on its path: ``s`` (N + 1,) from 0 to 1 at samples ``period_s`` apart; ``length`` m."""

    s: Array
    period_s: float
    length: float = 0.0


class Conditions:
    """The exception conditions of one move, evaluated at any sample of its ``timing``.

    ``start`` (3,) rad: wrist angles where the move begins, the reference of C4.
    """

    def __init__(self, timing: PathTiming, start: Array, limits: WristLimits, options: WristOptions) -> None:
        s, period_s = timing.s, timing.period_s
        self._s, self._start, self._period_s, self._limits, self._options = s, start, period_s, limits, options
        rate = np.diff(s) / period_s
        # T(n) is counted at the fastest rate still to come: with the average one, a move that brakes at its end would
        # let the wrist turn faster than theta_kd in its middle
        self._fastest = np.append(np.maximum.accumulate(rate[::-1])[::-1], 0.0)
        left_s = period_s * (len(s) - 1 - np.arange(len(s)))
        self._late = (left_s <= options.remaining_time) & (options.remaining_time > 0.0)
        self._late |= ((1.0 - s) * timing.length <= options.remaining_distance) & (options.remaining_distance > 0.0)

    def met(self, at: slice, wrist: Array, before: Array, end: Array, outside: Mask) -> dict[Condition, Mask]:
        """Return which conditions the samples ``at`` meet, each (k, 3) by wrist axis; left sides of (11) to (63).

        wrist, before (k, 3) rad: angles at these samples and at those before them; end (3,): taught end angles, now;
        ``outside`` (k, 3): whether the angles are, or will soon be, out of range.
        """
        options, s = self._options, self._s[at, None]
        met: dict[Condition, Mask] = {}
        if options.speed_condition != "off":
            # the linear law keeps its speed; the others exceed it by their peak, which has to keep theta_kd
            met["C1"] = self._speed_to_end(at, wrist, end) > self._limits.speed / options.peak
            if options.speed_condition == "all":
                met["C1"] = met["C1"] & met["C1"].all(axis=1, keepdims=True)
        met["C2"] = np.broadcast_to(self._late[at, None], wrist.shape)
        if options.range_condition:
            met["C3"] = outside
        if options.deviation_condition != "off":
            share = {"moving": s, "start": 0.0 * s, "end": s**0}[options.deviation_condition]
            met["C4"] = np.abs(wrist - (self._start + share * (end - self._start))) > np.array(options.deviation)
        if options.guard:  # H6: C1 to C4 did not stop 994 deg/s of E3 before the switch
            met["C6"] = np.abs(wrist - before) / self._period_s > self._limits.speed
        return met

    def _speed_to_end(self, at: slice, wrist: Array, end: Array) -> Array:
        """Return the wrist speed (k, 3) rad/s that reaches the end angles from each sample."""
        away, left = np.abs(end - wrist), 1.0 - self._s[at, None]
        over = np.where(away > SAME_ANGLES, np.inf, 0.0)  # T(n) is zero: met unless the wrist is there
        speed = away * self._fastest[at, None] / np.maximum(left, 1e-12)
        return np.where(left > 1e-12, speed, over)


def first_trigger(
    q: Array, q_end: Array, timing: PathTiming, limits: WristLimits, options: WristOptions
) -> Trigger | None:
    """Return the first exception condition of a move, S61 of Fig 3; None when there is none.

    q (N + 1, n) rad: the path at the samples of ``timing`` with the sign of J5 kept, NaN where it has no solution;
    q_end (n,) rad: the taught end.
    """
    wrist, s = q[:, -WRIST_AXES:], timing.s
    conditions = Conditions(timing, wrist[0], limits, options)
    lost: Mask = np.logical_not(np.isfinite(q).all(axis=1))
    with np.errstate(invalid="ignore"):
        outside = _ahead((wrist > limits.upper) | (wrist < limits.lower), options.look_ahead)
        met = conditions.met(slice(1, None), wrist[1:], wrist[:-1], q_end[-WRIST_AXES:], outside[1:])
    met["reach"] = np.repeat(lost[1:, None], WRIST_AXES, axis=1)
    found = [(int(np.argmax(rows)), name) for name, where in met.items() if (rows := where.any(axis=1)).any()]
    if not found:
        return None
    index, name = min(found, key=lambda each: each[0])  # of several at one sample the first in the order C1 to reach
    axis = None if name == "reach" else q.shape[1] - WRIST_AXES + int(np.argmax(met[name][index]))
    return Trigger(index=index + 1, share=float(s[index + 1]), condition=name, axis=axis)


def _ahead(outside: Mask, cycles: int) -> Mask:
    """Return for each sample whether it or one of the ``cycles`` next ones is outside.

    A law that continues the slope of the path goes on towards the limit for a while: the cubic of E2 reaches 181.4 deg
    where the range ends at 180. So the wrist has to turn back some cycles earlier.
    """
    seen = outside.copy()
    for k in range(1, min(cycles, len(outside) - 1) + 1):
        seen[:-k] |= outside[k:]
    return seen


@dataclass(frozen=True, slots=True, kw_only=True)
class WristLaw:
    """Wrist angles from ``start`` (3,) rad at path parameter ``s_switch`` to ``end`` (3,) rad at ``s_return``.

    ``slope`` (3,) is d theta / ds of the path at the switch, where ``shape`` continues it; ``width`` in (0, 1] is the
    share of the interval in which ``smooth`` changes its slope. Only ``hermite`` has the other two: ``slope_return``
    (3,) of the path to which the wrist returns before the end, ``detour`` (3,) rad added at the middle of the cubic.
    """

    s_switch: float
    start: Array
    end: Array
    slope: Array
    shape: Literal["linear", "hermite", "smooth"] = "linear"
    width: float = 0.5
    s_return: float = 1.0
    slope_return: Array | None = None
    detour: Array | None = None

    def angles(self, s: Array) -> Array:
        """Return the wrist angles (N, 3) rad at s (N,), from the switch on."""
        left = self.s_return - self.s_switch
        x = np.clip((s - self.s_switch) / left, 0.0, 1.0)[:, None]
        turn = self.end - self.start
        if self.shape == "linear":
            return np.asarray(self.end - (1.0 - x) * turn)  # from the end: x = 1 gives the end angles exactly
        slope = self.slope * left
        if self.shape == "hermite":
            angles = self.start + (x**3 - 2 * x**2 + x) * slope + (3 * x**2 - 2 * x**3) * turn
            if self.slope_return is not None:
                angles = angles + (x**3 - x**2) * self.slope_return * left
            if self.detour is not None:
                # a bump of height 1 at x = 1/2 whose slope is zero at both ends
                angles = angles + 16.0 * (x - x**2) ** 2 * self.detour
            return np.asarray(angles)
        w = self.width
        # slope(x) = slope + (final - slope) S(x/w), S = 3u^2 - 2u^3 up to u = 1; its integral ends at the end angles
        final = (turn - slope * w / 2.0) / (1.0 - w / 2.0)
        u = np.minimum(x / w, 1.0)
        passed = w * (u**3 - u**4 / 2.0) + np.maximum(x - w, 0.0)
        angles = self.start + slope * x + (final - slope) * passed
        return np.asarray(np.where(x >= 1.0, self.end, angles))


def law_from(
    q: Array, s: Array, index: int, end: Array, shape: Literal["linear", "hermite", "smooth"], width: float = 0.5
) -> WristLaw:
    """Return the law that takes over from the path q (N + 1, n) at sample ``index``, S63; s (N + 1,).

    The slope is the path's over the cycle before the switch. A move that switches where it starts has none: it begins
    with the constant slope, since it stands.
    """
    wrist = q[:, -WRIST_AXES:]
    start = wrist[index]
    slope = (end - start) / (1.0 - s[index])
    if index > 0:
        slope = (wrist[index] - wrist[index - 1]) / (s[index] - s[index - 1])
    return WristLaw(
        s_switch=float(s[index]), start=frozen(start), end=frozen(end), slope=frozen(slope), shape=shape, width=width
    )


def law_between(q: Array, q_back: Array, s: Array, first: int, last: int) -> WristLaw:
    """Return the law that leaves the path q (N + 1, n) at sample ``first`` and returns to q_back at sample ``last``.

    q_back (N + 1, n) is the same path in the configuration of the end: before and after, the tool has its posture.
    """
    before, after = q[:, -WRIST_AXES:], q_back[:, -WRIST_AXES:]
    a, b = max(first, 1), min(last, len(s) - 2)  # one-sided slopes, taken on the side where the posture is kept
    return WristLaw(
        s_switch=float(s[first]),
        start=frozen(before[first]),
        s_return=float(s[last]),
        end=frozen(after[last]),
        slope=frozen((before[a] - before[a - 1]) / (s[a] - s[a - 1])),
        slope_return=frozen((after[b + 1] - after[b]) / (s[b + 1] - s[b])),
        shape="hermite",
    )
