"""Which payloads a LOAD may declare: one rule for checking a program, for planning it and for the running controller.

A mass is zero or more and at most what the robot is rated for; its centre of gravity is within ``MAX_COG_DISTANCE`` of
the flange, whatever the mass; an own inertia is one that a body can have: principal moments J1 <= J2 <= J3 with

    J1 >= 0,   J3 <= J1 + J2,   each to within ``ROUNDING`` of J3 (people type rounded figures).

Every comparison is written so that NaN fails it. Imports no numerics.
"""

import math
from collections.abc import Sequence
from typing import Literal

from runtime.core.faults import Fault
from runtime.core.rounding import beside
from runtime.core.units import MM

LoadMode = Literal["add", "replace"]
"""Whether a payload is added to the last link, or takes its place (the literal reading of the document)."""

MAX_COG_DISTANCE = 2.0
"""Farthest centre of gravity from the flange that is accepted, m; beyond it a value was meant in mm or cm."""

ROUNDING = 1e-6
"""Share of the largest moment: typed figures of six digits may break the triangle inequality by that much."""
_SMALLEST_MOMENT = 1e-9
"""Rounding below this is none, kg m2."""
_SWEEPS = 20
"""Jacobi's method converges quadratically: a 3x3 matrix needs four or five sweeps."""
_GRAMS, _TIMES = 50.0, 10.0
"""A mass of this or more, kg, and of so many times what a robot carries, may have been meant in g."""


def load_fault(mass: float, cog: Sequence[float], inertia: Sequence[float] | None, rated: float) -> Fault | None:
    """Return why a payload cannot be declared, None when it can: RBL401, RBL402 or RBL403.

    mass kg, cog (3,) m in the flange frame, inertia (xx, yy, zz, xy, xz, yz) kg m2 about it, rated kg of the robot.
    """
    return mass_fault(mass, rated) or centre_fault(cog) or (None if inertia is None else inertia_fault(inertia))


def mass_fault(mass: float, rated: float | None) -> Fault | None:
    """Return why a mass, kg, cannot be declared (RBL401, RBL402); rated None: not known."""
    if not (math.isfinite(mass) and mass >= 0.0):
        return Fault("RBL401", f"a payload of {mass:g} kg is not a mass")
    if rated is None or mass <= rated:
        return None
    # the hint only where grams would make sense: 2300 for a robot of 4 kg, but not 5, nor 60 for one of 49 kg
    grams = mass / 1000.0 <= rated and mass >= _GRAMS and mass >= _TIMES * rated
    shown, most = beside(mass, rated)
    return Fault(
        "RBL402",
        f"a payload of {shown} kg is more than the {most} kg the robot is rated for",
        f"LOAD takes kg: {mass:g} g is {mass / 1000.0:g} kg" if grams else "",
    )


def centre_fault(cog: Sequence[float]) -> Fault | None:
    """Return why a centre of gravity (3,) m cannot be declared (RBL403)."""
    distance = math.hypot(*cog)
    if distance <= MAX_COG_DISTANCE:
        return None
    if not all(map(math.isfinite, cog)):
        shown = ", ".join(f"{value / MM:g}" for value in cog)
        return Fault("RBL403", f"the centre of gravity ({shown}) mm is not a place")
    away, most = beside(distance / MM, MAX_COG_DISTANCE / MM)
    return Fault("RBL403", f"the centre of gravity is {away} mm from the flange, more than {most} mm")


def inertia_fault(inertia: Sequence[float]) -> Fault | None:
    """Return why an inertia (xx, yy, zz, xy, xz, yz), kg m2, cannot be declared (RBL403)."""
    moments = principal_moments(inertia)
    if moments_defect(moments) <= max(_SMALLEST_MOMENT, ROUNDING * abs(moments[2])):
        return None
    if not all(map(math.isfinite, inertia)):
        return Fault("RBL403", "the payload inertia is not finite")
    if moments[0] < 0.0:
        return Fault("RBL403", "the payload inertia is not physically possible: a principal moment is negative")
    return Fault(
        "RBL403",
        "the payload inertia is not physically possible: the largest principal moment exceeds the sum of the other two",
    )


def moments_defect(moments: Sequence[float]) -> float:
    """Return by how much principal moments, in order, fail to be a body's: 0 when they are, else kg m2 missing."""
    if not all(map(math.isfinite, moments)):
        return math.inf
    # the smallest moment is not negative either then: the largest is at least the middle one
    return max(0.0, moments[2] - moments[1] - moments[0])


def principal_moments(inertia: Sequence[float]) -> tuple[float, float, float]:
    """Return the eigenvalues of (xx, yy, zz, xy, xz, yz) in order; NaN where an entry is not finite.

    Jacobi's method: turns in one plane after the other until nothing is left beside the diagonal.
    """
    xx, yy, zz, xy, xz, yz = inertia
    if not all(map(math.isfinite, inertia)):
        return math.nan, math.nan, math.nan
    M = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    for _ in range(_SWEEPS):
        if M[0][1] == M[0][2] == M[1][2] == 0.0:
            break
        for i, j in ((0, 1), (0, 2), (1, 2)):
            _turn(M, i, j)
    low, middle, high = sorted((M[0][0], M[1][1], M[2][2]))
    return low, middle, high


def _turn(M: list[list[float]], i: int, j: int) -> None:
    """Turn a symmetric matrix in one plane so that its element i, j becomes 0."""
    beside = M[i][j]
    if beside == 0.0:
        return
    # the smaller of the two angles that make the element zero: then the method converges
    ratio = (M[j][j] - M[i][i]) / (2.0 * beside)
    t = math.copysign(1.0, ratio) / (abs(ratio) + math.hypot(ratio, 1.0))
    c = 1.0 / math.hypot(t, 1.0)
    s = t * c
    k = 3 - i - j
    M[i][i], M[j][j] = M[i][i] - t * beside, M[j][j] + t * beside
    M[i][j] = M[j][i] = 0.0
    one, two = c * M[i][k] - s * M[j][k], s * M[i][k] + c * M[j][k]
    M[i][k] = M[k][i] = one
    M[j][k] = M[k][j] = two
