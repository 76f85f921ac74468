"""The grid of a path: places near enough to each other that differences over them are its derivatives.

A corner of half d takes ``_IN_CORNER`` steps, so where corners overlap a step is that share of the smallest of them;
what is left of a move takes steps by its length and by its kind. Called by ``ChainPath``; m.
"""

import math
from collections.abc import Sequence

import numpy as np

from runtime.core.frames import Array
from runtime.motion.chain.overlap import Overlap
from runtime.motion.chain.piece import JointLine, Piece
from runtime.motion.path_ik import WristSolver

_AT_REST = 0.5 ** np.arange(12, 0, -1)
"""Shares of the first and of the last step of the grid at which there are points, too."""
_NOTHING = 1e-9
_EVEN = 0.25
"""Least share of a step beside it that a step of the grid has."""
_APART = 0.3
"""Least share of a step between two points of different grids."""
_IN_CORNER = 14
_STEP_M = 0.004
_LEAST_STEPS, _MOST_STEPS = 6, 240
_LONGEST_STEPS = 24
"""Steps of the grid: in a corner, and in what is left of a move, by its length within these numbers."""


def grid(pieces: Sequence[Piece], overlap: Overlap) -> Array:
    """Return rising places (M + 1,) from the start of a path to its end."""
    begins = np.concatenate([[0.0], overlap.finishes[:-1]]).tolist()
    ends = np.append(overlap.starts[1:], overlap.ends[-1]).tolist()
    parts, at = [np.zeros(1)], 0.0
    for k, (begin, end) in enumerate(zip(begins, ends, strict=True)):
        # where a move runs alone; next to nothing is left to the corners around it
        if steps := _steps(pieces, overlap, k, end - begin):
            parts += [_rounded(overlap, at, begin), np.linspace(begin, end, steps + 1)[1:]]
            at = end
    parts.append(_rounded(overlap, at, float(overlap.ends[-1])))
    return _with_rest(np.concatenate(parts))


def _steps(pieces: Sequence[Piece], overlap: Overlap, k: int, length: float) -> int:
    """Return the steps over the ``length`` m on which move k runs alone."""
    beside = overlap.halves[k : k + 2]
    shortest = float(np.min(2.0 * beside[beside > 0.0] / _IN_CORNER, initial=np.inf))
    least = _LEAST_STEPS
    if isinstance(pieces[k].curve, WristSolver):
        least = _MOST_STEPS
    elif k in (0, len(pieces) - 1):
        least = _LONGEST_STEPS
    wanted = _LEAST_STEPS if isinstance(pieces[k].curve, JointLine) else int(length / _STEP_M)
    # what two corners leave of a move may be next to nothing: differences over it would be rounding
    widest = _NOTHING if shortest == np.inf else _EVEN * shortest
    return max(0, min(max(least, min(_MOST_STEPS, wanted)), int(length / widest)))


def _rounded(overlap: Overlap, begin: float, end: float) -> Array:
    """Return the places (k,) after ``begin`` up to ``end`` m, between which there are only corners."""
    if not end > begin:
        return np.zeros(0)
    inside = np.flatnonzero((overlap.ends > begin) & (overlap.ends < end))
    if len(inside) == 1:
        return np.linspace(begin, end, _IN_CORNER + 1)[1:]
    nodes = np.concatenate([[begin], overlap.ends[inside], [end]])
    dense = (
        0.5
        * _IN_CORNER
        / np.concatenate([overlap.halves[inside[:1]], overlap.halves[inside], overlap.halves[inside[-1:]]])
    )
    steps = np.concatenate([[0.0], np.cumsum(np.diff(nodes) * 0.5 * (dense[:-1] + dense[1:]))])
    found = np.interp(np.linspace(0.0, steps[-1], math.ceil(steps[-1]) + 1)[1:], steps, nodes)
    found[-1] = end
    return np.asarray(found)


def _with_rest(whole: Array) -> Array:
    """Return a grid with points close to its ends."""
    # u is constant from point to point, so a slow speed is gained within a step only if steps at rest are short
    near = _AT_REST * np.array([[whole[1] - whole[0]], [whole[-1] - whole[-2]]])
    return np.concatenate([whole[:1], whole[0] + near[0], whole[1:-1], (whole[-1] - near[1])[::-1], whole[-1:]])


def after(whole: Array, kept: Array) -> Array:
    """Return the points ``kept`` (k,) of another grid, with those of a whole one (M + 1,) that come after them."""
    return np.concatenate([kept, whole[whole > kept[-1] + _APART * (kept[-1] - kept[-2])]])


def with_point(x: Array, place: float) -> Array:
    """Return a grid with a point at a place within it, and without those that are too near to it."""
    k = int(np.searchsorted(x, place))
    # differences over a tiny step would be rounding
    near = _APART * (x[k] - x[k - 1])
    return np.concatenate([x[:k][x[:k] < place - near], [place], x[k:][x[k:] > place + near]])
