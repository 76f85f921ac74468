"""Conversions between the surface's units and SI. Inside the packages everything is SI and radians."""

import math

MM = 1e-3
"""Metres in a millimetre."""

DEG = math.pi / 180.0
"""Radians in a degree."""

PERCENT = 1e-2
"""Unit fraction in a per cent."""

GRAVITY = 9.81
"""Standard gravity used by every model here, m/s2 (docs/dynamics.md, acceptance figures use this value)."""


def badness(value: float) -> float:
    """Return an error or a ratio as a key for ``max`` and ``min``: NaN is worse than any number.

    ``max(1.0, nan)`` is 1.0 in Python, since every comparison with NaN is false.
    """
    return math.inf if math.isnan(value) else value
