"""The speeds at which the splines of a path may be run, place by place.

Curvature and turning of a spline change along it. At every point of the grid its largest ones between the points before
and after bound the speed v along the curve, for a and w the accelerations of the tool and of its turning:

    v^2 |p''| <= ACROSS a        v^2 |r'| <= ACROSS w        v |r| <= the largest rate of turning

So a spline is slow where it bends, and nowhere else. Called by ``paced``; m, rad, s.
"""

import numpy as np

from runtime.core.frames import Array
from runtime.motion.chain.chain_path import ChainPath, ToolLimits
from runtime.motion.spline_path import SplinePath

ACROSS = 0.8
"""Largest share of an acceleration that may go into the change of direction, as on an arc."""
_NONE = 1e-12


def curved(path: ChainPath, tool: ToolLimits, rotation_speed: float) -> Array:
    """Return the largest b (M + 1,), (m/s)^2 along x, that the splines of a path allow; infinite elsewhere."""
    found = np.full(len(path.x), np.inf)
    number, share = path.move_at(path.x), path.share_at(path.x)
    for k, piece in enumerate(path.pieces):
        rows = np.flatnonzero(number == k)
        if not isinstance(piece.path, SplinePath) or not len(rows):
            continue
        bend, rate, gain = piece.path.largest_about(share[rows])
        b = np.minimum(
            ACROSS * tool.acceleration[rows] / np.maximum(bend, _NONE),
            ACROSS * tool.turning[rows] / np.maximum(gain, _NONE),
        )
        b = np.minimum(b, (piece.override * rotation_speed / np.maximum(rate, _NONE)) ** 2)
        found[rows] = b * (piece.extent / piece.path.length) ** 2
    return found
