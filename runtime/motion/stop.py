r"""A controlled stop on the path: the rows of a running plan, played at a falling rate until they stand still.

The rows of a plan are set-points 8 ms apart, and ``q(u)``, u the row number, is the command that fine interpolation
makes of them; the running move plays u = t / P. A stop keeps the curve and changes the time on it: ``du/dt`` falls from
1 to 0 over K cycles as

    rate(x) = 1 - (10 x^3 - 15 x^4 + 6 x^5),  x = t / (K P),      so u moves on by K / 2 rows

which starts and ends without a step of acceleration. The set-points of a stop are those of a command that passes q(u)
at these places, so the tool stays on the commanded path. Along it ``dq = q' rate``, ``ddq = q'' rate^2 + q'
d(rate)/dt``. The smallest K is taken for which joint speeds and accelerations stay within the robot's limits. A move
that ends before any such stop would is left to end: it comes to rest by itself.

Where the path bends and the move is at its limits already, no falling rate of that form may fit. Then the arm brakes as
hard as the joints allow at each row (``_braked``): with b = rate^2 the least d(rate)/dt at which ``|q' d(rate)/dt + q''
b|`` keeps the accelerations. There is one of 0 or less wherever the plan itself kept them.

Called once by the interpolator when a stop is requested or an alarm is raised; rad, s.
"""

import numpy as np

from runtime.core.frames import Array
from runtime.core.units import badness
from runtime.motion.fine_interpolator import FineInterpolator, through

_SHORTEST = 3
_LONGEST = 250
"""Cycles of a stop: from 24 ms to 2 s at 8 ms."""
_STILL = 1e-12
"""Joints that move less in a row, rad, bound no braking."""
_SLACK = 1.0 + 1e-9
"""A limit is kept when it is passed by no more than rounding."""
_ROUGHER = 1.1
"""Excess allowed over that of what was already sent too fast, at the ticks that it still reaches."""
_SHARES = (0.95, 0.9, 0.8, 0.7, 0.6, 0.5)
"""Shares of the accelerations that are tried for braking: set-points 8 ms apart follow the law only nearly."""
_MEAN = 2
"""Cycles before and after that a place of braking is the mean of."""
_WORTH = 4
"""Least cycles that braking has to save."""


def stopping_rows(
    rows: Array, at: int, fine: FineInterpolator, speed: Array, acceleration: Array, ends_at_rest: bool = True
) -> Array:
    """Return the set-points (K, n) that follow row ``at`` of ``rows`` (N + 1, n) and end at rest on their curve.

    ``speed`` rad/s and ``acceleration`` rad/s2 (n,) are the joints' limits. No row left gives no set-point.
    ``ends_at_rest`` False: the rows break off in motion, so the best stop that they allow is taken.
    """
    course = _stop(rows, at, fine, (speed, acceleration), ends_at_rest)
    return rows[at + 1 :] if course is None else on_curve(rows, course, rows[at])


def pause_course(rows: Array, at: int, fine: FineInterpolator, speed: Array, acceleration: Array) -> Array:
    """Return the places (K,) on ``rows`` that follow row ``at`` and end at rest there: whole and half row numbers.

    As ``stopping_rows``; where no stop fits before their end, the rows that are left.
    """
    course = _stop(rows, at, fine, (speed, acceleration), True)
    return np.arange(at + 1.0, len(rows)) if course is None else course


def resume_course(rows: Array, start: float, fine: FineInterpolator, speed: Array, acceleration: Array) -> Array:
    """Return the places (K,) on ``rows`` that follow the rest at ``start``, a place where ``pause_course`` has ended.

    The rate rises from 0 to 1 as it fell. It takes an even or an odd number of cycles, so that the rows from there on
    are reached at whole numbers: the motion then goes on as if it had not been interrupted.
    """
    end = len(rows) - 1.0
    whole = start == np.floor(start)
    cycles = _SHORTEST + _SHORTEST % 2 if whole else _SHORTEST | 1
    while True:
        rise = start + np.arange(1, cycles + 1) - _progress(cycles)
        course = np.concatenate([rise, np.arange(rise[-1] + 1.0, end + 1.0)])
        course = np.append(course[course < end], end)  # where the curve ends first, it has come to rest by itself
        rest = _curve(rows, np.full(4, start))
        played = np.concatenate([rest, on_curve(rows, course, rest[0])[: cycles + 4]])
        if _excess(fine, played, (speed, acceleration)).max() <= _SLACK or cycles > _LONGEST:
            return course
        cycles += 2 * max(1, cycles // 16)


def on_curve(rows: Array, course: Array, before: Array) -> Array:
    """Return the set-points (K, n) of a command that passes places (K,) of rows after the set-point ``before`` (n,).

    From where the places go on row by row up to the last one they are the very rows.
    """
    inner = np.append((course[:-1] == np.floor(course[:-1])) & (np.diff(course) == 1.0), course[-1] == len(rows) - 1)
    first = len(course) - int(np.argmin(np.append(inner[::-1], False)))
    very = rows[course[first:].astype(int)]
    made = through(np.concatenate([before[None], _curve(rows, course[:first]), very[:1]]))
    return np.concatenate([made[1 : first + 1], very])


def _stop(
    rows: Array, at: int, fine: FineInterpolator, limits: tuple[Array, Array], ends_at_rest: bool
) -> Array | None:
    """Return the places (K,) of the shortest stop after row ``at`` that fits, None: the rows are left to end."""
    left = len(rows) - 1 - at
    sent = rows[np.maximum(np.arange(at - 3, at + 1), 0)]
    touched = len(sent)
    # what has been sent cannot be taken back. Under a seam sensor it may itself pass a limit (``seam.SPEED_SLACK``);
    # without this allowance no stop at all would be accepted there, and the arm would go on to the end of its move
    rough = _excess(fine, np.concatenate([sent, rows[at + 1 : at + 1 + len(sent)]]), limits)[:touched].max(initial=0.0)
    allowed = 1.0 if rough <= _SLACK else _ROUGHER * rough
    cycles, best = _SHORTEST, None
    while cycles / 2.0 <= left and cycles <= _LONGEST:
        course = at + _progress(cycles)
        ratio = _excess(fine, np.concatenate([sent, on_curve(rows, course, sent[-1])]), limits)
        worst = np.maximum(ratio[:touched].max() / allowed, ratio[touched:].max(initial=0.0))
        if worst <= _SLACK:
            return course
        if best is None or badness(worst) < badness(best[0]):
            best = worst, course
        cycles += max(1, cycles // 8)  # by an eighth: some 40 candidates cover 3 to 250 cycles
    if not ends_at_rest:
        return None if best is None else best[1]
    return _braked(rows, at, fine, limits)


def _braked(rows: Array, at: int, fine: FineInterpolator, limits: tuple[Array, Array]) -> Array | None:
    """Return the places (K,) of braking as hard as the joints allow after row ``at``; None where that saves nothing."""
    sent = rows[np.maximum(np.arange(at - 3, at + 1), 0)]
    for share in _SHARES:
        course = _brake_course(rows, at, share * limits[1] * fine.period_s**2)
        if course is None or len(course) + _WORTH > len(rows) - 1 - at:
            continue
        if _excess(fine, np.concatenate([sent, on_curve(rows, course, sent[-1])]), limits).max() <= _SLACK:
            return course
    return None


def _brake_course(rows: Array, at: int, most: Array) -> Array | None:
    """Return the places (K,) after row ``at`` with accelerations up to ``most`` (n,); None for a stop at the end."""
    # it brakes after the rows that the mean reaches from here, and b falls from row to row
    first = at + _MEAN
    places, squares = [float(at), float(first)], [1.0, 1.0]
    for k in range(first, len(rows) - 1):
        along, across = 0.5 * (rows[k + 1] - rows[k - 1]), rows[k + 1] - 2.0 * rows[k] + rows[k - 1]
        moving = np.abs(along) > _STILL
        least = -(most[moving] / np.abs(along[moving])) - across[moving] / along[moving] * squares[-1]
        gain = float(np.minimum(least.max(initial=-1.0), 0.0))
        if squares[-1] + 2.0 * gain <= 0.0:
            places.append(k - 0.5 * squares[-1] / gain)
            squares.append(0.0)
            return _mean_course(np.array(places), np.sqrt(squares))
        places.append(k + 1.0)
        squares.append(squares[-1] + 2.0 * gain)
    return None


def _mean_course(places: Array, rate: Array) -> Array:
    """Return the places (K,) of a law at whole cycles, each the mean of ``_MEAN`` before it and after it."""
    lasts = 2.0 * np.diff(places) / (rate[:-1] + rate[1:])
    times = np.concatenate([[0.0], np.cumsum(lasts)])
    cycles = int(np.ceil(times[-1])) + _MEAN
    asked = np.arange(1 - _MEAN, cycles + _MEAN + 1, dtype=np.float64)
    k = np.clip(np.searchsorted(times, asked, side="right") - 1, 0, len(lasts) - 1)
    passed = np.clip(asked, 0.0, times[-1]) - times[k]
    found = places[k] + rate[k] * passed + 0.5 * (rate[k + 1] - rate[k]) / lasts[k] * passed**2
    found += np.minimum(asked, 0.0)  # before it begins it moves on by a row a cycle
    width = 2 * _MEAN + 1
    course = sum(found[step : step + cycles] for step in range(width)) / width
    return np.asarray(np.minimum(course, places[-1]))


def _excess(fine: FineInterpolator, played: Array, limits: tuple[Array, Array]) -> Array:
    """Return the largest share of a joint's speed or acceleration limit about every one of played rows (K,)."""
    # up to one more: the command comes to rest at the last one
    speed, acceleration = fine.rates(np.concatenate([played, played[-1:]]))
    shares = (speed[:-1] / limits[0]).max(axis=1), (acceleration / limits[1]).max(axis=1)
    return np.asarray(np.maximum(*shares))


def _progress(cycles: int) -> Array:
    """Return the rows passed after each of K = ``cycles`` cycles (K,): the integral of the rate, K / 2 at last."""
    x = np.arange(1, cycles + 1) / cycles
    return np.asarray(cycles * (x - (2.5 * x**4 - 3.0 * x**5 + x**6)))


def _curve(rows: Array, u: Array) -> Array:
    """Return q (K, n) at row numbers u (K,): where the command of these rows is."""
    k = np.minimum(u.astype(int), len(rows) - 2)
    padded = np.concatenate([rows[:1], rows, rows[-1:]])
    windows = np.stack([padded[k + j] for j in range(4)], axis=1)
    return np.asarray(np.einsum("kp,kpn->kn", FineInterpolator.weights(u - k), windows))
