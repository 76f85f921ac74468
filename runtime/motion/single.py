"""The timing of one move that stops at both ends, within the limits of every joint.

The profile of its programmed speed is tried first: where its set-points keep the speed, acceleration and jerk of all
joints it is the fastest that keeps those of the path. Where they pass one, or where no acceleration of the path is
programmed (``ACCEL MAX``), the move is timed place by place as a chain of one (``paced``): it is slow where a joint
binds, and nowhere else. So is a spline, whose profile is that of its tightest bend, where this is faster. A move that a
joint would have to slow by more than ``MOST_SLOWDOWN`` at some place is refused: it runs too close to a singularity.
Called by the planners of all moves; units rad, s.
"""

import math
from dataclasses import dataclass, replace
from typing import NoReturn, Protocol, TypeAlias

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.chain.chain_path import ChainPath
from runtime.motion.chain.paced import ChainLimits, paced
from runtime.motion.chain.piece import Piece
from runtime.motion.chain.timing import SLACK
from runtime.motion.path_ik import MOST_SLOWDOWN, Arm, check_range
from runtime.motion.spline_path import SplinePath

Rows: TypeAlias = tuple[Array, Array]
"""Path parameters s (K + 1,) and joints q (K + 1, n) rad, one row a cycle."""

QUANTITIES = ("speed", "acceleration", "jerk")
"""What limits of a joint bound, in the order of their derivatives."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Slowdown:
    """Why and by how much a move takes longer: ``factor`` of time, the axis (0-based), the quantity that it passed."""

    factor: float
    axis: int
    quantity: str


class Curve(Protocol):
    """A curve in joint space over a parameter from 0 to 1."""

    def joints(self, s: Array) -> Array:
        """Return q (N, n) rad at s (N,); ``Fault`` where there is none."""

    def setpoints(self, q: Array) -> Array:
        """Return the set-points (N + 1, n) rad of a command along the curve over its joints q (N + 1, n)."""

    def refuse_singular(self, s: Array, q: Array, axis: int) -> NoReturn:
        """Raise ``Fault``: no speed is slow enough for ``axis``."""


def single(
    curve: Curve, piece: Piece, programmed: Rows, arm: Arm, limits: ChainLimits
) -> tuple[Array, Array, Slowdown | None]:
    """Return s (N + 1,), q (N + 1, n) of a move, and what slowed it; ``Fault`` of the curve, or RBL404.

    ``programmed`` are s (K + 1,) and q (K + 1, n) of the profile of its programmed speed, one row a cycle.
    """
    s, q = programmed
    needed = _needed(curve, piece, q, limits)
    kind, axis = (int(each) for each in np.unravel_index(int(np.argmax(needed)), needed.shape))
    worst = float(needed[kind, axis])
    keeps = piece.acceleration < math.inf and worst <= SLACK
    if keeps and not isinstance(piece.path, SplinePath):
        return s, q, None
    check_passable(curve, piece, programmed, limits)
    try:
        found = paced(ChainPath(arm, [piece], []), limits)
    except Fault:
        curve.refuse_singular(s, q, axis)
    if keeps and len(found.x) >= len(s):
        return s, q, None
    check_range(arm, found.x, found.q)
    slower = not worst <= SLACK and len(found.x) > len(s)
    slowdown = Slowdown(factor=(len(found.x) - 1) / (len(s) - 1), axis=axis, quantity=QUANTITIES[kind])
    return found.x / piece.extent, found.q, slowdown if slower else None


def check_passable(curve: Curve, piece: Piece, programmed: Rows, limits: ChainLimits) -> None:
    """Refuse a move that a joint would have to slow by more than ``MOST_SLOWDOWN``; ``Fault`` of the curve."""
    s, q = programmed
    # a jerk alone is no singularity
    steepest = np.maximum(*_needed(curve, piece, q, limits)[:2])
    if not (steepest <= MOST_SLOWDOWN).all():
        curve.refuse_singular(s, q, int(np.argmax(steepest)))


def _needed(curve: Curve, piece: Piece, q: Array, limits: ChainLimits) -> Array:
    """Return how many times (3, n) longer q (K + 1, n) would have to take, for each quantity and joint."""
    joints = replace(limits.joints, speed=limits.joints.speed * piece.override)
    shares = joints.passed(curve.setpoints(q))
    # the same curve in k times the time: speeds fall by k, accelerations by k^2, jerks by k^3
    return np.stack([share.max(axis=0) ** (1.0 / power) for power, share in enumerate(shares, start=1)])
