"""Numbers as messages print them: a value beside its limits, and proposals that are still on the right side.

A message that says "0.0010 mm apart, at least 0.001 mm are needed" contradicts itself. ``beside`` gives a value and its
limits as many digits as they need to differ as they do; ``down`` and ``up`` round a proposed value so that it still
fits. Called wherever a message compares a value with a limit; standard library only.
"""

import math

FEWEST_DIGITS, MOST_DIGITS = 6, 17
"""Digits of a number as a rule, and those with which any two different numbers of 64 bits differ."""


def beside(value: float, *limits: float, form: str = "g") -> tuple[str, ...]:
    """Return a value in a format such as ``.3f`` and limits in short, or all with as many digits as they need.

    They need so many that the texts compare as the numbers do: below, equal or above.
    """
    # from 1e6 on ``g`` would write 1e+06, where a message shall have 1000000
    texts = (f"{value:{form}}", *(f"{limit:g}" if abs(limit) < 1e6 else f"{limit:.10g}" for limit in limits))
    digits = FEWEST_DIGITS
    while not _compare_as(texts, value, limits) and digits < MOST_DIGITS:
        digits += 1
        texts = tuple(f"{each:.{digits}g}" for each in (value, *limits))
    return texts


def down(value: float, digits: int = 3) -> float:
    """Return the largest number of so many digits that is not above a value > 0."""
    # 1e-9 of the last digit: 0.3 is 299.99999999999994 of its thousandths
    size = _place(value, digits)
    return float(f"{math.floor(value / size + 1e-9) * size:.{digits}g}")


def up(value: float, digits: int = 4) -> float:
    """Return the smallest number of so many digits that is not below a value > 0."""
    size = _place(value, digits)
    return float(f"{math.ceil(value / size - 1e-9) * size:.{digits}g}")


def _compare_as(texts: tuple[str, ...], value: float, limits: tuple[float, ...]) -> bool:
    shown, *bounds = map(float, texts)
    return all(_order(shown, bound) == _order(value, limit) for bound, limit in zip(bounds, limits, strict=True))


def _order(a: float, b: float) -> int:
    return int(a > b) - int(a < b)


def _place(value: float, digits: int) -> float:
    """Return the unit of the last of so many digits of a value > 0."""
    return float(10.0 ** (math.floor(math.log10(value)) - digits + 1))
