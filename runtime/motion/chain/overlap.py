r"""Which moves run at a place of a chain, and how far each has come: neighbours overlap in their corners.

Move k lies between the places e_k and e_k+1, and the corner at e_k has a half d_k. With f as in ``corner``,

    F_d(y) = 2 d f((y + d) / (2 d)) for |y| <= d,    0 before,    y after it
    passed of move k at x    L_k(x) = F(x - e_k) - F(x - e_k+1)

so a move starts d before its place and comes to its end d after it, the lengths passed add up to x, and outside of the
corners one move alone runs. Halves that change from corner to corner by no more than the move between them
(``ordered``) keep starts and ends in the order of the moves; corners may then overlap, and any number of moves runs at
once. Called by ``ChainPath``; m.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array

Numbers: TypeAlias = NDArray[np.intp]
Flags: TypeAlias = NDArray[np.bool_]


_TOUCHING = 1e-12
"""Corners overlap by less, m, by rounding alone."""


class Overlap:
    """Moves between ``ends`` (K + 1,), with the ``halves`` (K - 1,) of the corners between them."""

    def __init__(self, ends: Array, halves: Array) -> None:
        self.ends = ends
        self.halves = np.concatenate([[0.0], halves, [0.0]])
        """Halves (K + 1,) at all ends: 0 where the chain begins and ends."""
        self.starts, self.finishes = ends[:-1] - self.halves[:-1], ends[1:] + self.halves[1:]
        """Places (K,) at which the moves begin and come to their ends."""
        self.extents = np.diff(ends)

    def running(self, x: Array) -> tuple[Numbers, Numbers]:
        """Return the first and the last move, (N,) each, that run at places x (N,)."""
        most = len(self.extents) - 1
        # corners that share a move between them touch up to rounding, and do not overlap
        first = np.minimum(np.searchsorted(self.finishes - _TOUCHING, x, side="right"), most)
        last = np.maximum(np.searchsorted(self.starts, x, side="left") - 1, first)
        return first, last

    def shares(self, number: Numbers, x: Array) -> Array:
        """Return the share (N,) of moves ``number`` (N,) that is passed at places x (N,)."""
        before = _length(x - self.ends[number], self.halves[number])
        after = _length(x - self.ends[number + 1], self.halves[number + 1])
        return np.asarray(np.clip((before - after) / self.extents[number], 0.0, 1.0))

    def mixed(self, values: Array, x: Array) -> Array:
        """Return the mean (N,) of a value of each move (K,) at places x (N,): each counts as much as it moves on."""
        # at the very end the last move still counts
        x = np.minimum(x, np.nextafter(self.ends[-1], 0.0))
        first, last = self.running(x)
        found = np.zeros(len(x))
        for step in range(int((last - first).max(initial=0)) + 1):
            rows = np.flatnonzero(first + step <= last)
            number = first[rows] + step
            before = _rate(x[rows] - self.ends[number], self.halves[number])
            after = _rate(x[rows] - self.ends[number + 1], self.halves[number + 1])
            found[rows] += (before - after) * values[number]
        return found


def ordered(ends: Array, halves: Array, first: float = 0.0) -> Array:
    """Return halves (K - 1,) lowered until each differs from the next by no more than the move between them.

    ``first`` is the half of the corner at the first end, which is not lowered.
    """
    found = np.concatenate([[first], halves, [0.0]])
    # there and back: what limits a corner may lie before it or after it
    for k in range(1, len(found) - 1):
        found[k] = min(found[k], found[k - 1] + ends[k] - ends[k - 1])
    for k in range(len(found) - 2, 0, -1):
        found[k] = min(found[k], found[k + 1] + ends[k + 1] - ends[k])
    return found[1:-1]


def passed(u: Array) -> Array:
    """Return f(u): its second derivative rises for a third, stays and falls, so its third is as small as it can be."""
    third = u - 1.0 / 3.0
    stays = 1.0 / 36.0 + 0.25 * third + 0.75 * third**2
    return np.asarray(
        np.where(u <= 1.0 / 3.0, 0.75 * u**3, np.where(u <= 2.0 / 3.0, stays, u - 0.5 + 0.75 * (1.0 - u) ** 3))
    )


def turned(u: Array) -> Array:
    """Return f'(u) (N,): the share of the second move in the direction and in the speed at u (N,) of a corner."""
    stays = 0.25 + 1.5 * (u - 1.0 / 3.0)
    return np.asarray(
        np.where(u <= 1.0 / 3.0, 2.25 * u**2, np.where(u <= 2.0 / 3.0, stays, 1.0 - 2.25 * (1.0 - u) ** 2))
    )


def _length(y: Array, half: Array) -> Array:
    """Return F (N,) at y (N,) from corners of ``half`` (N,)."""
    width = 2.0 * half
    u = np.clip((y + half) / np.where(half > 0.0, width, 1.0), 0.0, 1.0)
    return np.asarray(width * passed(u) + np.maximum(y - half, 0.0))


def _rate(y: Array, half: Array) -> Array:
    """Return the derivative (N,) of F."""
    u = np.clip((y + half) / np.where(half > 0.0, 2.0 * half, 1.0), 0.0, 1.0)
    return np.asarray(np.where(half > 0.0, turned(u), y >= 0.0))
