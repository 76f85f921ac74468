"""The tip of a tool from touches of one fixed tip: by least squares, with how well the touches agree.

In touch i the flange stood at (R_i, p_i), and its tool tip t at the fixed tip c:

    R_i t + p_i = c        three equations for each touch, t and c unknown

With the means over the touches, R and p, the fixed tip drops out, and t has the normal equations

    A t = - sum (R_i - R)' (p_i - p),    A = sum (R_i - R)' (R_i - R)

An eigenvalue of A says how far the tip swings when it lies along its eigenvector: where the flange turned about one
direction only, the place along it stays open. An error sigma of each coordinate of a touch becomes one of
sigma / sqrt(lowest eigenvalue) of the tip. The orientation of a tool is not measured.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robolang.teaching.touches import Touch, check_bounds
from runtime.core.decompositions import solve, symmetric_eigen
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.rounding import beside
from runtime.core.units import DEG, MM

FEWEST = 3
"""Touches that determine a tip; four let them be compared."""
LEAST_TURN = 10.0
"""Least turn of the flange between the touches, root mean square about each direction, deg."""
LEAST_LEFT = 2.0
"""As ``LEAST_TURN``, of the touches that are left when one is left out to see whether the others agree, deg."""
MOST_APART = 2.0
"""Largest distance of a touch from the common tip, mm: touches by eye agree within 1 mm."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolTip:
    """The tip in the flange frame (3,), mm.

    ``residuals`` (N,): how far each touch is from the common tip, mm, ``worst`` the largest and ``rms`` their root mean
    square. ``amplification``: error of the tip, in the direction that is known worst, for an error of 1 of each
    coordinate of a touch. ``uncertainty`` mm: standard deviation of the tip in that direction, by the residuals.
    """

    tip: tuple[float, float, float]
    residuals: tuple[float, ...]
    amplification: float
    uncertainty: float

    @property
    def worst(self) -> float:
        """The largest residual, mm."""
        return max(self.residuals)

    @property
    def rms(self) -> float:
        """Root mean square of the residuals, mm."""
        return math.sqrt(sum(each**2 for each in self.residuals) / len(self.residuals))


def tool_tip(touches: Sequence[Touch], most_apart: float = MOST_APART) -> ToolTip:
    """Return the tip of the tool from touches with the pose of the flange; ``most_apart``: largest residual, mm.

    ``Fault`` RBL309 out of bounds; RBL314 for too few touches, or such in which the flange has turned too little;
    RBL315 where they do not meet in one tip, with the touch that fits worst.
    """
    check_bounds(touches)
    if len(touches) < FEWEST:
        raise Fault("RBL314", f"{len(touches)} touches are given; a tip needs {FEWEST}, and better 4 or more")
    R, p = _of(touches)
    lowest = _lowest_eigenvalue(R)
    if not _turn(R) >= LEAST_TURN:
        turn, least = beside(_turn(R), LEAST_TURN, form=".3g")
        raise Fault(
            "RBL314",
            f"the flange turns by {turn} deg between the touches, about the direction that is known worst; at least "
            f"{least} deg are needed",
            "touch the tip from directions that differ by 30 deg or more, tilted to more than one side",
        )
    t, residuals = _fit(R, p)
    # NaN cannot be here: ``check_bounds`` has refused it
    if not residuals.max() / MM <= most_apart:
        raise _apart(touches, R, p, residuals, most_apart)
    x, y, z = (t / MM).tolist()
    # three equations a touch, and six unknowns: tool tip and fixed tip
    free = 3 * len(R) - 6
    sigma = math.sqrt(float((residuals**2).sum()) / free) / MM
    amplification = 1.0 / math.sqrt(lowest)
    return ToolTip(
        tip=(x, y, z),
        residuals=tuple((residuals / MM).tolist()),
        amplification=amplification,
        uncertainty=sigma * amplification,
    )


def _of(touches: Sequence[Touch]) -> tuple[Array, Array]:
    X = np.array([touch.X for touch in touches])
    return X[:, :3, :3], X[:, :3, 3]


def _normal(R: Array) -> tuple[Array, Array]:
    """Return the turns beside their mean (N, 3, 3), and A (3, 3)."""
    beside_mean = R - R.mean(axis=0)
    return beside_mean, np.asarray(matmul(np.swapaxes(beside_mean, 1, 2), beside_mean).sum(axis=0))


def _lowest_eigenvalue(R: Array) -> float:
    return float(symmetric_eigen(_normal(R)[1])[0][0])


def _turn(R: Array) -> float:
    """Return by how much the flange turns, root mean square about the direction that is known worst, deg."""
    # rounding may leave an eigenvalue a little below 0
    return math.asin(min(1.0, math.sqrt(max(0.0, _lowest_eigenvalue(R)) / len(R)))) / DEG


def _fit(R: Array, p: Array) -> tuple[Array, Array]:
    """Return the tip (3,) m and the distance (N,) m of each touch from the common tip."""
    turned, A = _normal(R)
    t = solve(A, -matmul(np.swapaxes(turned, 1, 2), (p - p.mean(axis=0))[..., None]).sum(axis=0)[:, 0])
    places = matmul(R, t) + p
    return t, np.sqrt(((places - places.mean(axis=0)) ** 2).sum(axis=1))


def _apart(touches: Sequence[Touch], R: Array, p: Array, residuals: Array, most: float) -> Fault:
    """Return the fault of touches that do not meet, which names the one that fits worst."""
    worst = int(np.argmax(residuals))
    # an outlier pulls the tip towards itself: it is the one without which the others agree best
    if len(touches) > FEWEST:
        others = [np.delete(np.arange(len(touches)), each) for each in range(len(touches))]
        left = [float(_fit(R[each], p[each])[1].max()) if _turn(R[each]) >= LEAST_LEFT else math.inf for each in others]
        worst = int(np.argmin(left)) if math.isfinite(min(left)) else worst
    there, most_shown = beside(float(residuals.max()) / MM, most, form=".3g")
    return Fault(
        "RBL315",
        f"the touches are up to {there} mm from one common tip, and may be {most_shown} mm; point "
        f"{touches[worst].name} fits the others worst",
        f"touch {touches[worst].name} again; the fixed tip must not move between the touches",
    )
