r"""How fast a path may be run at each of its places, with bounded accelerations: the fastest of all squared speeds.

A path q(x), x from its start to its end, is run as x(t). With b = (dx/dt)^2 and u = d2x/dt2 a joint has

    dq/dt = q' sqrt(b),      d2q/dt2 = q' u + q'' b,      db/dx = 2 u

so bounds of accelerations are linear in (u, b), and bounds of speeds are bounds of b alone. A tool point on a curve
keeps ``|p' u + p'' b| <= a``: with t its direction and N b the part of p'' b across it, it is enough that

    | |p'| u + (p'' . t) b | + N b / 2 <= a,      | |p'| u + (p'' . t) b | / 3 + N b <= a

two chords of the circle, which lie within it and meet where N b = 0.8 a.

All rows therefore have one form, ``|along u + across b| + beside b <= most``. On a grid of x, u is constant from each
point to the next. Backwards, the largest b from which the end can still be reached within the bounds; forwards, the
largest that can be gained. Between two points that leaves the fastest motion of all, up to the grid (time-optimal path
parameterization by reachability: H. Pham and Q.-C. Pham, IEEE Trans. Robotics 34 (2018) 645). Jerk is bounded
afterwards (``time_law``). Called by ``timing`` for every chain, several times; x m, t s.
"""

from dataclasses import dataclass, replace

import numpy as np

from runtime.core.frames import Array

_STILL = 1e-9
"""A row that moves less along x than this share of the largest bounds no u: it would divide by nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Bounds:
    """Rows ``|along u + across b| + beside b <= most`` (M + 1, k) on a grid, and ``fastest`` b (M + 1,)."""

    along: Array
    across: Array
    beside: Array
    most: Array
    fastest: Array

    def replaced(self, fastest: Array) -> "Bounds":
        """Return the bounds with another largest b (M + 1,)."""
        return replace(self, fastest=fastest)

    def since(self, first: int) -> "Bounds":
        """Return the bounds from a point of the grid on."""
        return Bounds(
            along=self.along[first:],
            across=self.across[first:],
            beside=self.beside[first:],
            most=self.most[first:],
            fastest=self.fastest[first:],
        )

    def scaled(self, acceleration: Array, speed: Array) -> "Bounds":
        """Return the bounds at shares (M + 1,) of all accelerations and of the speed."""
        return replace(self, most=self.most * acceleration[:, None], fastest=self.fastest * speed**2)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Range:
    """u between ``-least + below b`` and ``least - above b``, row by row (M + 1, k); b at most ``top`` (M + 1,)."""

    least: Array
    above: Array
    below: Array
    top: Array


def rates(x: Array, bounds: Bounds, start: float = 0.0, end: float = 0.0) -> Array:
    """Return the largest b (M + 1,) along a grid x (M + 1,), from ``start`` to ``end``, both as far as bounds allow."""
    span = _range(bounds)
    steps = 0.5 / np.diff(x)
    reachable = _backwards(steps, span, end)
    found = _forwards(steps, span, reachable, start)
    # comparisons of single numbers pass over NaN
    return found if np.isfinite(reachable).all() and np.isfinite(found).all() else np.full(len(x), np.nan)


def _range(bounds: Bounds) -> _Range:
    """Return the range of u at every point, and the largest b that leaves one."""
    along, across = np.abs(bounds.along), np.copysign(1.0, bounds.along) * bounds.across
    still = along <= _STILL * along.max(axis=1, keepdims=True, initial=1e-300)
    scale = np.where(still, 1.0, along)
    least = np.where(still, np.inf, bounds.most / scale)
    above = np.where(still, 0.0, (across + bounds.beside) / scale)
    below = np.where(still, 0.0, (bounds.beside - across) / scale)
    # rows that bound b alone, and pairs of rows whose ranges must meet: -least_l + below_l b <= least_k - above_k b
    bend = np.abs(across) + bounds.beside
    alone = np.where(still & (bend > 0.0), bounds.most / np.where(bend > 0.0, bend, 1.0), np.inf)
    top = np.minimum(bounds.fastest, alone.min(axis=1, initial=np.inf))
    for row in range(along.shape[1]):
        closing = below + above[:, row : row + 1]
        room = least + least[:, row : row + 1]
        meets = np.where(closing > 0.0, room / np.where(closing > 0.0, closing, 1.0), np.inf)
        top = np.minimum(top, meets.min(axis=1))
    return _Range(least=least, above=above, below=below, top=top)


def _backwards(steps: Array, span: _Range, end: float) -> Array:
    """Return the largest b (M + 1,) from which b at the next point is reachable: b + u / step <= that of the next."""
    # the least u of a row is -least + below b; so b (step + below) <= step next + least, for rows that bound it at all
    slope = span.below[:-1] + steps[:, None]
    bounding = slope > 0.0
    scale = np.where(bounding, slope, 1.0)
    share = np.where(bounding, steps[:, None] / scale, 0.0)
    offset = np.where(bounding, span.least[:-1] / scale, np.inf)
    reachable = np.empty(len(span.top))
    value = reachable[-1] = min(end, span.top[-1])
    top = span.top.tolist()
    for k in range(len(steps) - 1, -1, -1):
        found = float((share[k] * value + offset[k]).min())
        value = reachable[k] = found if not found >= top[k] else top[k]
    return reachable


def _forwards(steps: Array, span: _Range, reachable: Array, start: float) -> Array:
    """Return the largest b (M + 1,) that is gained from ``start`` within what is ``reachable``."""
    found = np.empty(len(reachable))
    value = found[0] = float(np.minimum(start, reachable[0]))
    limit, widths = reachable.tolist(), (1.0 / steps).tolist()
    for k, width in enumerate(widths):
        u = float((span.least[k] - span.above[k] * value).min())
        gained = value + width * u
        gained = gained if not gained <= 0.0 else 0.0
        value = found[k + 1] = gained if not gained >= limit[k + 1] else limit[k + 1]
    return found
