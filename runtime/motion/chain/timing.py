r"""Timing a path: as fast as its bounds allow at every place, within the limits of the joints at every moment.

    1  ``rates`` gives the fastest speeds on a grid of the path, with bounded accelerations
    2  ``narrow`` and ``eased`` give room for the jerk; the mean over T of that law is where the arm is at each cycle
    3  the path is solved there, and the set-points of that command are held to the limits of the joints: speed,
       acceleration and jerk, which for set-points are limits at every moment (``fine_interpolator``)
    4  where one is passed, the bounds are lowered around that place by as much as it is passed, and 1 begins again

So a limit that binds at one place slows the motion there and nowhere else. What is left after ``_ROUNDS`` is slowed as
a whole, which is rare. Without a limit of jerk T is 0.

A slow or a short motion never reaches its accelerations: then a shorter T, with accelerations lower by the same share,
is faster, and is taken.

A path may go on from a motion that runs already (``Begun``): its law is that of the motion up to a moment, and is found
anew from there. Called by ``paced``; x m, t s, q rad.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.units import badness
from runtime.motion.chain.bends import bend_speeds
from runtime.motion.chain.rates import Bounds, rates
from runtime.motion.chain.time_law import TimeLaw, eased, narrow
from runtime.motion.fine_interpolator import through
from runtime.motion.velocity_profile import check_duration

_ROUNDS = 40
_FIRMER = 4
"""Rounds after which bounds are lowered by more than a limit is passed, so that they come to an end."""
_BOTH = 5
"""Rounds after which speed and acceleration are lowered where a jerk is passed, whichever it seems to come from."""
_LEAST_LOWERING = 1.002
SLACK = 1.0 + 1e-9
"""A limit is kept when it is passed by no more than rounding."""
_STILL = 1e-300
_ALIKE = 0.95
"""Speeds and shares that differ by less than the rest of this count as one."""
_LONG = 40.0
"""Motions of more times T are not tried with a shorter one."""
_WHOLE = 1.0 + 1e-4
"""Least factor by which a motion is slowed as a whole."""
_MOST_SLOWING = 400


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Limits of the joints (n,): rad/s, rad/s2 and rad/s3, the last infinite where none holds; and the cycle, s."""

    speed: Array
    acceleration: Array
    jerk: Array
    period_s: float

    def passed(self, setpoints: Array, before: Array | None = None) -> tuple[Array, Array, Array]:
        """Return the shares of speed (N + 6, n), acceleration (N + 5, n) and jerk (N + 4, n) of set-points (N + 1, n).

        Three set-points alike stand after the last, and ``before`` (3, n) the first, None: alike as well.
        """
        before = np.repeat(setpoints[:1], 3, axis=0) if before is None else before
        steps = np.concatenate([before, setpoints, np.repeat(setpoints[-1:], 3, axis=0)])
        shares = []
        for limit, power in ((self.speed, 1), (self.acceleration, 2), (self.jerk, 3)):
            steps = np.diff(steps, axis=0)
            shares.append(np.abs(steps) / (limit * self.period_s**power))
        return shares[0], shares[1], shares[2]


@dataclass(frozen=True, slots=True, kw_only=True)
class Path:
    """A path to be timed: grid ``x`` (M + 1,), its bounds, ``joints`` q (N, n) at places (N,) of it."""

    x: Array
    bounds: Bounds
    joints: Callable[[Array], Array]

    def since(self, first: int) -> "Path":
        """Return the path from a point of its grid on."""
        return replace(self, x=self.x[first:], bounds=self.bounds.since(first))


@dataclass(frozen=True, slots=True, kw_only=True)
class Shares:
    """Shares (M + 1,) of ``speed`` and of the ``acceleration`` that a path takes on a grid ``x`` (M + 1,)."""

    x: Array
    speed: Array
    acceleration: Array

    def at(self, x: Array) -> "Shares":
        """Return the shares at other places (N,)."""
        return Shares(x=x, speed=np.interp(x, self.x, self.speed), acceleration=np.interp(x, self.x, self.acceleration))


@dataclass(frozen=True, slots=True, kw_only=True)
class Begun:
    """A motion that runs already: its ``law`` up to where the path is timed anew, which is point ``at`` of its grid.

    Times count from row 0, the last that stays: ``x`` (4,) and ``setpoints`` (4, n) are of the rows -3 to 0. ``shares``
    are those with which the rest of the path begins; ``mean_s`` is T.
    """

    law: TimeLaw
    at: int
    x: Array
    setpoints: Array
    shares: Shares
    mean_s: float

    @property
    def moves(self) -> bool:
        """Whether it is in motion where the path is timed anew; else it begins at rest."""
        return bool(self.law.v[-1] > 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Timed:
    """A timed path: places ``x`` (N + 1,) and joints ``q`` (N + 1, n), one a cycle, and the ``setpoints`` for them.

    ``law`` is what they are the mean of, over ``mean_s``; ``shares`` those of the grid where it was timed.
    """

    x: Array
    q: Array
    setpoints: Array
    law: TimeLaw
    mean_s: float
    shares: Shares


def timed(path: Path, limits: Limits, mean_s: float, *, begun: Begun | None = None, whole: bool = False) -> Timed:
    """Return the fastest motion found along a path; ``mean_s`` is T. ``Fault`` RBL404 for one of too long a time.

    ``begun``: it goes on from that motion; ``whole``: T is not shortened for a short motion.
    """
    # before it is cut: third differences reach beyond the place where it begins
    path = _within_bends(path, limits)
    if begun is not None:
        return _timed(path.since(begun.at), limits, begun)
    best = _timed(path, limits, _at_rest(path, mean_s, 1.0))
    if not whole and 0.0 < (len(best.x) - 1) * limits.period_s < _LONG * mean_s:
        share = _better_share(path, mean_s)
        other = _timed(path, limits, _at_rest(path, mean_s * share, share)) if share < _ALIKE else best
        best = other if len(other.x) < len(best.x) else best
    return best


def _at_rest(path: Path, mean_s: float, share: float) -> Begun:
    """Return what a path that begins at rest goes on from, at a share of its accelerations."""
    still = TimeLaw(x=path.x[:1], v=np.zeros(1), t=np.zeros(1))
    shares = Shares(x=path.x, speed=np.ones(len(path.x)), acceleration=np.full(len(path.x), float(share)))
    q = path.joints(path.x[:1])
    return Begun(
        law=still, at=0, x=np.repeat(path.x[:1], 4), setpoints=np.repeat(q, 4, axis=0), shares=shares, mean_s=mean_s
    )


def _better_share(path: Path, mean_s: float) -> float:
    """Return the share of its accelerations, and of T, at which a motion is faster, up to 1.

    A change of speed that takes t at full acceleration takes t / k + k T at a share k; where a top speed is not kept,
    the two on either side of it take 2 t / sqrt(k) + k T. t is the mean of all changes.
    """
    law = TimeLaw.of(path.x, rates(path.x, path.bounds))
    rising = np.sign(np.round(np.diff(law.v) / law.v.max(initial=_STILL), 3))
    edges = np.flatnonzero(np.diff(rising)) + 1
    lasts = np.diff(law.t[np.concatenate([[0], edges, [len(law.t) - 1]])])
    changes = rising[np.concatenate([[0], edges])] != 0.0
    t = float(lasts[changes].mean()) if changes.any() else mean_s
    keeps = bool((lasts[~changes] > mean_s).any())
    return float(np.clip(t / mean_s, 0.01, 1.0) ** (1.0 / 2.0 if keeps else 2.0 / 3.0))


def _within_bends(path: Path, limits: Limits) -> Path:
    """Return a path whose bends are passed within the jerk of the joints."""
    if not np.isfinite(limits.jerk).all():
        return path
    bounds = path.bounds
    across = bounds.across[:, : len(limits.jerk)]
    speeds = bend_speeds(path.x, across, np.sqrt(bounds.fastest), limits.jerk, limits.period_s)
    return replace(path, bounds=bounds.replaced(speeds**2))


def _timed(path: Path, limits: Limits, begun: Begun) -> Timed:
    shares, mean_s = begun.shares.at(path.x), begun.mean_s
    speed, acceleration = shares.speed, shares.acceleration
    around = max(1, math.ceil(0.5 * mean_s / limits.period_s)) + 1
    for round_ in range(_ROUNDS):
        law = _law(path, path.bounds.scaled(acceleration, speed), begun)
        check_duration(law.seconds + mean_s)
        found = _along(path, law, limits.period_s, begun, Shares(x=path.x, speed=speed, acceleration=acceleration))
        fast, gaining, jerk = limits.passed(found.setpoints, begun.setpoints[:3])
        pace = _pace(path, found.x, limits.period_s, begun)
        if max((float(each.max()) for each in (fast, gaining, jerk, pace)), key=badness) <= SLACK:
            return found
        firm = 1.0 if round_ < _FIRMER else 1.0 + 0.25 * (round_ - _FIRMER + 1)
        gently = 0.5 if round_ < _FIRMER else firm
        _lower(path.x, speed, found.x, np.maximum(fast.max(axis=1), pace), (1, around), firm)
        _lower(path.x, acceleration, found.x, gaining.max(axis=1), (2, around), firm)
        # the jerk of a change of speed, or that of the path itself, which a lower speed makes less by its cube
        along = _changing(path, _rows(found.x, begun), limits)
        changes = (along >= 0.5 * jerk) | (round_ >= _BOTH)
        _lower(path.x, acceleration, found.x, np.where(changes, jerk, 0.0).max(axis=1), (3, around), gently)
        bends = ~changes | (round_ >= _BOTH)
        _lower(path.x, speed, found.x, np.where(bends, jerk, 0.0).max(axis=1), (3, 1), gently / 3.0)
    return _slowed(path, limits, law, Shares(x=path.x, speed=speed, acceleration=acceleration), begun)


def _rows(x: Array, begun: Begun) -> Array:
    """Return places (N + 7,) with the three before the first and after the last of x (N + 1,)."""
    return np.concatenate([begun.x[:3], x, np.repeat(x[-1:], 3)])


def _pace(path: Path, x: Array, period_s: float, begun: Begun) -> Array:
    """Return the share (N + 6,) of the bounds of speed along the path that a motion takes.

    The mean over T carries the speed before a narrow place into it.
    """
    places = _rows(x, begun)
    most = np.interp(places, path.x, np.sqrt(path.bounds.fastest))
    shares = np.asarray(np.diff(places) / period_s / np.maximum(most[:-1], most[1:]))
    if begun.moves:
        # what ran before is in the mean
        shares[: 3 + math.ceil((begun.law.seconds + begun.mean_s) / period_s)] = 0.0
    return shares


def _changing(path: Path, places: Array, limits: Limits) -> Array:
    """Return the share of the jerk (N + 4, n) that changes of the acceleration along the path make, of ``_rows``."""
    third = np.abs(np.diff(places, 3)) / limits.period_s**3
    middle = places[1:-2]
    slope = np.stack(
        [np.interp(middle, path.x, column) for column in np.abs(path.bounds.along[:, : len(limits.jerk)]).T]
    )
    return np.asarray(third[:, None] * slope.T / limits.jerk)


def _law(path: Path, bounds: Bounds, begun: Begun) -> TimeLaw:
    start, mean_s = float(begun.law.v[-1]) ** 2, begun.mean_s
    b = rates(path.x, bounds, start)
    if mean_s > 0.0:
        low = narrow(path.x, b, mean_s)
        if (low < b).any():
            b = rates(path.x, bounds.replaced(np.minimum(bounds.fastest, low)), start)
        b = eased(path.x, b, mean_s)
    # it is as fast as it is, whatever can be reached from there
    b[0] = start
    return begun.law.then(TimeLaw.of(path.x, b))


def _along(path: Path, law: TimeLaw, period_s: float, begun: Begun, shares: Shares) -> Timed:
    """Return the motion of a law.

    Its samples are taken as set-points of the place on the path: so the place has no steps within a cycle, and the
    set-points of the joints follow it without swinging.
    """
    mean_s = begun.mean_s
    # what runs cannot be stretched: only a motion from rest takes whole cycles
    if begun.moves:
        sampled = law.going_on(period_s, mean_s)
    else:
        sampled = law.sampled(period_s, mean_s)
        stretch = law.stretch(period_s, mean_s)
        law, mean_s = law.slower(stretch), mean_s * stretch
    x = sampled.copy()
    x[0] = begun.x[-1]
    x[1:-1] = (sampled[:-2] + 4.0 * sampled[1:-1] + sampled[2:]) / 6.0
    q = path.joints(x)
    setpoints = through(np.concatenate([begun.setpoints[-1:], q[1:]]))
    return Timed(x=x, q=q, setpoints=setpoints, law=law, mean_s=mean_s, shares=shares)


def _lower(grid: Array, field: Array, x: Array, passed: Array, about: tuple[int, int], firmness: float) -> None:
    """Lower a field (M + 1,) on a grid where a limit is passed, ``about`` (differences, cycles around) that place."""
    order, margin = about
    bad = np.flatnonzero(~(passed <= 1.0))
    if not len(bad):
        return
    last = len(x) - 1
    # three set-points stand before the first
    starts = x[np.clip(bad - 3 - margin, 0, last)]
    ends = x[np.clip(bad - 3 + order + margin, 0, last)]
    lowered = np.ones(len(grid))
    firsts = np.maximum(np.searchsorted(grid, starts, side="left") - 1, 0)
    lasts = np.searchsorted(grid, ends, side="right") + 1
    for first, end, share in zip(firsts.tolist(), lasts.tolist(), passed[bad].tolist(), strict=True):
        lowered[first:end] = np.minimum(lowered[first:end], 1.0 / max(share**firmness, _LEAST_LOWERING))
    field *= lowered


def _slowed(path: Path, limits: Limits, law: TimeLaw, shares: Shares, begun: Begun) -> Timed:
    """Return a motion slowed as a whole until it keeps every limit; ``Fault`` RBL404 where no time is enough."""
    factor = _WHOLE
    # what runs already cannot be slowed as a whole
    for _ in range(0 if begun.moves else _MOST_SLOWING):
        slower = law.slower(factor)
        check_duration(slower.seconds + begun.mean_s)
        found = _along(path, slower, limits.period_s, begun, shares)
        over = (
            float(each.max()) ** (1.0 / power) for power, each in enumerate(limits.passed(found.setpoints), start=1)
        )
        worst = max(over, key=badness)
        if worst <= SLACK:
            return found
        factor *= max(worst, _WHOLE)
    raise Fault("RBL404", "no timing of the moves keeps the limits of the joints")
