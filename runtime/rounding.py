"""Numbers as messages print them: a value beside its limit, and values that are still on the right side when rounded.

A message that says "0.0010 mm apart, at least 0.001 mm are needed" contradicts itself. ``beside`` gives both numbers as
many digits as they need to differ; ``down`` and ``up`` round a proposed value so that it still fits.
"""

import math

MOST_DIGITS = 17
"""As many digits tell any two numbers of 64 bits apart."""


def beside(value: float, limit: float, digits: int = 4) -> tuple[str, str]:
    """Return a value and its limit as text with ``digits`` significant digits, or as many more as make them differ."""
    while digits < MOST_DIGITS and value != limit and float(f"{value:.{digits}g}") == float(f"{limit:.{digits}g}"):
        digits += 1
    return f"{value:.{digits}g}", f"{limit:.{digits}g}"


def down(value: float, digits: int = 3) -> float:
    """Return the largest number of so many digits that is not above a value > 0."""
    size = _place(value, digits)
    return float(f"{math.floor(value / size + 1e-9) * size:.{digits}g}")


def up(value: float, digits: int = 4) -> float:
    """Return the smallest number of so many digits that is not below a value > 0."""
    size = _place(value, digits)
    return float(f"{math.ceil(value / size - 1e-9) * size:.{digits}g}")


def _place(value: float, digits: int) -> float:
    """Return the worth of the last of the digits of a value > 0."""
    return float(10.0 ** (math.floor(math.log10(value)) - digits + 1))
