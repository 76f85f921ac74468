"""Whether a hand can hold the parts of its cell: its force against their weight, at rest.

A cup that looks down holds by its force, two fingers by friction, on both pads. What accelerates needs more, and a part
that is held far from its centre of gravity too: a hand is chosen with a reserve. No numerics: ``robolang check``
compares every cell.
"""

from runtime.core.units import GRAVITY

RESERVE = 2.0
"""Holding force over weight that hands are chosen with, where the part lies level and moves gently."""


def holding_force_n(kind: str, grip_force_n: float, friction: float) -> float:
    """Return what a hand of a ``kind`` can carry of a part, N."""
    return grip_force_n if kind == "suction" else 2.0 * friction * grip_force_n


def weakness(kind: str, grip_force_n: float, mass_kg: float, friction: float) -> tuple[str, str] | None:
    """Return code and message where a hand holds a part with no reserve (RBL646) or not at all (RBL647)."""
    weight = mass_kg * GRAVITY
    force = holding_force_n(kind, grip_force_n, friction)
    if force >= RESERVE * weight:
        return None
    holds = "the cup holds" if kind == "suction" else "two fingers hold, by friction,"
    code, most = ("RBL646", f"less than {RESERVE:g} times as much") if force >= weight else ("RBL647", "less than that")
    return code, f"weighs {weight:.3g} N and {holds} {force:.3g} N, {most}"
