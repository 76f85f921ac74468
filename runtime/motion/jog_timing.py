r"""Timing a smooth curve in joint space that is slow only where a limit binds.

Along the curve q(sigma), sigma its length in joint space, a bound of the speed v = d(sigma)/dt follows at every sample
from the jog's own speed, the speeds of the joints, those of tool point and flange, and the curvature:

    v |ds/dsigma| <= rate,   v |q'_j| <= speed_j,   v |J q'| <= cap,   v^2 |q''_j| <= acceleration_j / 2

and one of dv/dt: half the accelerations, and at most the jog's own speed in ``GAINED_S``. A pass forward and one
backward give the fastest v within them. Its course over time is averaged over ``SMOOTH`` cycles, so the acceleration
has no steps, and then held against the limits at the servo ticks: where they are passed, the bounds are lowered there
and the passes repeated; what remains after ``ROUNDS`` is stretched as a whole. Called by ``runtime.motion.jog``.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.jog_course import Piece
from runtime.motion.speed_cap import GAINED_S, speeds
from runtime.robot.kinematics.kinematics import Kinematics

SMOOTH = 12
"""Cycles over which the speed is averaged: the acceleration builds up in 0.1 s, as on programmed paths."""

ROUNDS, STRETCHES = 6, 6
"""Repairs of the places where a limit is passed, then stretches of the whole."""

FEWEST = 17
"""Samples of a curve at least."""

_UNDER = 0.998
"""Share of the limits that the bounds aim at, so that fine interpolation seldom passes them."""

_NOTHING = 1e-12


@dataclass(frozen=True, slots=True, kw_only=True)
class JogLimits:
    """What a jog keeps: ``rate`` (m/s or rad/s of the jog), ``speed`` rad/s and ``acceleration`` rad/s2 (n,), ``cap``.

    ``cap`` m/s holds for tool point ``X_flange_tool`` (4, 4) and flange.
    """

    rate: float
    speed: Array
    acceleration: Array
    cap: float
    X_flange_tool: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Slow:
    """Where a jog is slowest: the ``share`` of its speed there, ``at`` m or rad from its start, because of ``axis``.

    ``axis`` (0-based) None: tool point or flange rule.
    """

    share: float
    at: float
    axis: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Timed:
    """Set-points ``q`` (K + 1, n) rad of a piece, 8 ms apart, from rest to rest, and what slows it, if anything."""

    q: Array
    slow: Slow | None


class JogTiming:
    """Times the pieces of jogs of one robot."""

    def __init__(self, kinematics: Kinematics, fine: FineInterpolator, period_s: float) -> None:
        self._kinematics, self._fine, self._period_s = kinematics, fine, period_s

    def timed(self, piece: Piece, limits: JogLimits) -> Timed:
        """Return a piece as set-points; ``Fault`` RBL412 where no timing keeps the limits."""
        curve = _Curve.of(piece)
        bounds = self._bounds(curve, limits)
        v, gain = bounds.v.copy(), bounds.gain.copy()
        for turn in range(ROUNDS + STRETCHES):
            sigma = _smoothed(_over_time(curve.sigma, _passes(curve.sigma, v, gain), self._period_s))
            q = curve.at(sigma)
            ratio = self._ratios(q, limits)
            if not ratio.max() > 1.0:
                return Timed(q=q, slow=bounds.slowest(curve, v))
            if turn < ROUNDS:
                # a row that is too fast is so because of the speeds that were averaged into it
                near = _spread(ratio, SMOOTH)
                excess = np.interp(curve.sigma, sigma, near)
                excess = np.where(excess > 1.0, excess * 1.005, 1.0)
            else:
                excess = np.full(len(v), float(ratio.max()) * 1.005)
            v, gain = v / excess, gain / excess**2
        raise Fault("RBL412", "no speed of the jog keeps the limits of the joints", "Jog a joint instead.")

    def _bounds(self, curve: "_Curve", limits: JogLimits) -> "_Bounds":
        """Return the bounds of v and of its derivative at the samples of a curve."""
        dq, ddq = np.abs(curve.dq), np.abs(curve.ddq)
        points = speeds(self._kinematics, curve.q, curve.dq, limits.X_flange_tool).max(axis=0)
        with np.errstate(divide="ignore"):
            jog = limits.rate / np.maximum(np.abs(curve.ds), _NOTHING)
            cap = limits.cap / np.maximum(points, _NOTHING)
            joints = np.minimum(
                limits.speed / np.maximum(dq, _NOTHING),
                np.sqrt(0.5 * limits.acceleration / np.maximum(ddq, _NOTHING)),
            )
            gain = (0.5 * limits.acceleration / np.maximum(dq, _NOTHING)).min(axis=1)
        own, slowest_joint = np.minimum(jog, cap), joints.min(axis=1)
        v = np.minimum(own, slowest_joint) * _UNDER
        # the jog's own speed, not v: out of a slow place the arm may gain speed as fast as it ever does
        gain = np.minimum(gain, own / GAINED_S)
        axis = np.where(slowest_joint < cap, joints.argmin(axis=1), -1)
        return _Bounds(own=jog, v=v, gain=np.maximum(gain, 1e-9), axis=axis)

    def _ratios(self, q: Array, limits: JogLimits) -> Array:
        """Return by how much each row of q (K + 1, n) passes a limit at its ticks, (K + 1,); up to 1 none is passed."""
        motion = self._fine.expand(q)
        dq, ddq = motion[1], motion[2]
        ratio = np.maximum(
            (np.abs(dq) / limits.speed).max(axis=1), np.sqrt(np.abs(ddq) / limits.acceleration).max(axis=1)
        )
        # joints at every tick; points at every fourth, which costs ten times as much and changes little between
        motion = motion[:, :: max(1, self._fine.ticks // 2)]
        point = speeds(self._kinematics, motion[0], motion[1], limits.X_flange_tool).max(axis=0) / limits.cap
        cycles = len(q) + 1
        per_cycle = np.maximum(ratio.reshape(cycles, -1).max(axis=1), point.reshape(cycles, -1).max(axis=1))
        # a segment belongs to the rows at its two ends
        return np.asarray(np.maximum(per_cycle[1:], per_cycle[:-1]))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Bounds:
    """Bounds at the samples (N,): of v, of its derivative, of v by the jog's own speed; the axis that rules or -1."""

    own: Array
    v: Array
    gain: Array
    axis: Array

    def slowest(self, curve: "_Curve", v: Array) -> Slow | None:
        """Return where the bounds v (N,) that were used leave least of the jog's own speed; None: nowhere."""
        moving = np.abs(curve.ds) > _NOTHING
        if not moving.any():
            return None
        share = np.where(moving, v / self.own, np.inf)
        at = int(np.argmin(share))
        if not share[at] < 0.9:
            return None
        axis = int(self.axis[at])
        return Slow(share=float(share[at]), at=float(curve.s[at]), axis=None if axis < 0 else axis)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Curve:
    """A piece over its length ``sigma`` (N,): joint angles and their derivatives (N, n), s and its derivative (N,)."""

    sigma: Array
    q: Array
    dq: Array
    ddq: Array
    s: Array
    ds: Array

    @classmethod
    def of(cls, piece: Piece) -> "_Curve":
        if len(piece.s) < FEWEST:  # two samples are both at rest: a speed needs some between them
            whole = np.linspace(0.0, len(piece.s) - 1.0, FEWEST)
            at = np.minimum(whole.astype(int), len(piece.s) - 2)
            piece = Piece(s=_between(piece.s[:, None], at, whole)[:, 0], q=_between(piece.q, at, whole))
        steps = np.sqrt((np.diff(piece.q, axis=0) ** 2).sum(axis=1))
        sigma = np.concatenate([[0.0], np.cumsum(steps)])
        edge: Literal[1, 2] = 2 if len(sigma) > 2 else 1
        dq = np.asarray(np.gradient(piece.q, sigma, axis=0, edge_order=edge))
        return cls(
            sigma=sigma,
            q=piece.q,
            dq=dq,
            ddq=np.asarray(np.gradient(dq, sigma, axis=0, edge_order=1)),
            s=piece.s,
            ds=np.asarray(np.gradient(piece.s, sigma, edge_order=1)),
        )

    def at(self, sigma: Array) -> Array:
        """Return q (K, n) at places sigma (K,): the cubic through the samples with their derivatives."""
        k = np.clip(np.searchsorted(self.sigma, sigma, side="right") - 1, 0, len(self.sigma) - 2)
        width = self.sigma[k + 1] - self.sigma[k]
        u = ((sigma - self.sigma[k]) / width)[:, None]
        width = width[:, None]
        found = (
            (1.0 + 2.0 * u) * (1.0 - u) ** 2 * self.q[k]
            + u * (1.0 - u) ** 2 * width * self.dq[k]
            + u**2 * (3.0 - 2.0 * u) * self.q[k + 1]
            - u**2 * (1.0 - u) * width * self.dq[k + 1]
        )
        found[0], found[-1] = self.q[0], self.q[-1]  # to the last bit: what follows begins there
        return np.asarray(found)


def _between(rows: Array, at: NDArray[np.int_], whole: Array) -> Array:
    """Return rows (N, n) at the numbers ``whole`` (K,), straight from row ``at`` (K,) to the next, (K, n)."""
    return np.asarray(rows[at] + (whole - at)[:, None] * (rows[at + 1] - rows[at]))


def _passes(sigma: Array, v: Array, gain: Array) -> Array:
    """Return the fastest v (N,) from rest to rest within its bounds v and ``gain`` of its derivative, (N,) each."""
    # plain numbers: the passes are sequential, and indexing an array costs more than the sums
    squares, steps = (v**2).tolist(), np.diff(sigma).tolist()
    gains = np.minimum(gain[1:], gain[:-1]).tolist()
    squares[0] = squares[-1] = 0.0
    for k, (step, most) in enumerate(zip(steps, gains, strict=True)):
        squares[k + 1] = min(squares[k + 1], squares[k] + 2.0 * most * step)
    for k in range(len(steps) - 1, -1, -1):
        squares[k] = min(squares[k], squares[k + 1] + 2.0 * gains[k] * steps[k])
    return np.asarray(np.sqrt(np.array(squares)))


def _over_time(sigma: Array, v: Array, period_s: float) -> Array:
    """Return the places (K + 1,) at whole cycles of a motion with speed v (N,) at places sigma (N,)."""
    width = np.diff(sigma)
    # at a constant acceleration between two samples, as the passes have it
    durations = 2.0 * width / (v[1:] + v[:-1])
    t = np.concatenate([[0.0], np.cumsum(durations)])
    at = np.arange(math.ceil(t[-1] / period_s) + 1) * period_s
    k = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(width) - 1)
    since = np.minimum(at - t[k], durations[k])
    rate = (v[k + 1] - v[k]) / durations[k]
    return np.asarray(np.minimum(sigma[k] + v[k] * since + 0.5 * rate * since**2, sigma[-1]))


def _smoothed(places: Array) -> Array:
    """Return places (K,) over time averaged over ``SMOOTH`` cycles and over two: from rest to rest as well."""
    # over two besides: beside a first or last step fine interpolation swings by 8 % of it, which counts at a limit
    for cycles in (SMOOTH, 2):
        places = _averaged(places, cycles)
    return places


def _averaged(places: Array, cycles: int) -> Array:
    """Return places (K,) over time averaged over some cycles, (K + cycles - 1,)."""
    before, after = np.full(cycles, places[0]), np.full(cycles, places[-1])
    total = np.cumsum(np.concatenate([before, places, after]))
    found = (total[cycles:] - total[:-cycles]) / cycles
    found[0], found[-1] = places[0], places[-1]
    return np.asarray(np.maximum.accumulate(np.clip(found, places[0], places[-1])))


def _spread(values: Array, cycles: int) -> Array:
    """Return the largest of the values (K,) up to so many places before and after each."""
    padded = np.concatenate([np.full(cycles, values[0]), values, np.full(cycles, values[-1])])
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * cycles + 1).max(axis=1))
