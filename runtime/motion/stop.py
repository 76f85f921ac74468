r"""A controlled stop on the path: the rows of a running plan, played ever slower until they stand still.

The rows of a plan are joint angles 8 ms apart, ``q(u)`` with u the row number; the running move plays u = t / P. A stop
keeps the curve and changes the time on it: ``du/dt`` falls from 1 to 0 over K cycles as

    rate(x) = 1 - (10 x^3 - 15 x^4 + 6 x^5),  x = t / (K P),      so u moves on by K / 2 rows

which starts and ends without a step of acceleration. Between rows q(u) is the quintic that the fine interpolator
plays anyway, so the tool stays on the commanded path. Along it ``dq = q' rate``, ``ddq = q'' rate^2 + q'
d(rate)/dt``. The smallest K is taken for which joint speeds and accelerations at the servo ticks stay within the
robot's limits. A move that ends before any such stop would is left to end: it comes to rest by itself.
"""

import numpy as np

from runtime.core.frames import Array
from runtime.core.units import badness
from runtime.motion.fine_interpolator import FineInterpolator

_SHORTEST = 3
_LONGEST = 250
"""Cycles of a stop: from 24 ms to 2 s at 8 ms."""
_SLACK = 1.0 + 1e-9


def stopping_rows(
    rows: Array, at: int, fine: FineInterpolator, speed: Array, acceleration: Array, ends_at_rest: bool = True
) -> Array:
    """Return the set-points (K, n) that follow row ``at`` of ``rows`` (N + 1, n) and end at rest on their curve.

    ``speed`` rad/s and ``acceleration`` rad/s2 (n,) are the joints' limits. No row left gives no set-point.
    ``ends_at_rest`` False: the rows break off in motion, so the best stop that they allow is taken.
    """
    limits = speed, acceleration
    left = len(rows) - 1 - at
    sent = rows[np.maximum(np.arange(at - 3, at + 1), 0)]
    touched = len(sent) * fine.ticks
    # what has been sent cannot be taken back: where it is rough, the ticks that it reaches may be as rough as they are
    rough = _excess(fine, np.concatenate([sent, rows[at + 1 : at + 1 + len(sent)]]), limits)[:touched].max(initial=0.0)
    cycles, best = _SHORTEST, None
    while cycles / 2.0 <= left and cycles <= _LONGEST:
        candidate = _curve(rows, at + _progress(cycles))
        ratio = _excess(fine, np.concatenate([sent, candidate]), limits)
        worst = np.maximum(ratio[:touched].max() / np.maximum(1.0, 1.1 * rough), ratio[touched:].max(initial=0.0))
        if worst <= _SLACK:
            return candidate
        if best is None or badness(worst) < badness(best[0]):
            best = worst, candidate
        cycles += max(1, cycles // 8)
    if best is not None and not ends_at_rest:
        return best[1]
    return rows[at + 1 :]


def _excess(fine: FineInterpolator, played: Array, limits: tuple[Array, Array]) -> Array:
    """Return the largest share of a joint's speed or acceleration limit at every tick (ticks,) of played rows."""
    _, dq, ddq = np.abs(fine.continue_(played))
    return np.asarray(np.maximum((dq / limits[0]).max(axis=1), (ddq / limits[1]).max(axis=1)))


def _progress(cycles: int) -> Array:
    """Return the rows passed after each of ``cycles`` cycles, the integral of the rate; it ends at cycles / 2."""
    x = np.arange(1, cycles + 1) / cycles
    return np.asarray(cycles * (x - (2.5 * x**4 - 3.0 * x**5 + x**6)))


def _curve(rows: Array, u: Array) -> Array:
    """Return q (K, n) at row numbers u (K,): the quintic of the fine interpolator through the rows."""
    k = np.minimum(u.astype(int), len(rows) - 2)
    padded = np.concatenate([rows[:1], rows, rows[-1:]])
    windows = np.stack([padded[k + j] for j in range(4)], axis=1)
    return np.asarray(np.einsum("kp,kpn->kn", FineInterpolator.weights(u - k), windows))
