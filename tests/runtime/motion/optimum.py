"""The time-optimal motion along a path by another library, toppra (H. Pham, Q.-C. Pham 2018), for paths of the planner.

Joint speeds and accelerations are bounded, nothing else: no jerk, no limit of the tool.
"""

from typing import Any

import numpy as np

from runtime.core.frames import Array


def seconds(toppra: Any, s: Array, q: Array, speed: Array, acceleration: Array) -> float:
    """Return the least time, s, from rest to rest along joints q (N + 1, n) at s (N + 1,), a cubic spline through them.

    ``speed`` and ``acceleration`` (n,) are the limits of the joints.
    """
    path = toppra.SplineInterpolator(s, q)
    most = np.stack([-speed, speed], axis=1), np.stack([-acceleration, acceleration], axis=1)
    kinds = toppra.constraint.JointVelocityConstraint, toppra.constraint.JointAccelerationConstraint
    limits = [kind(bounds) for kind, bounds in zip(kinds, most, strict=True)]
    grid = np.linspace(s[0], s[-1], 401)
    found = toppra.algorithm.TOPPRA(limits, path, gridpoints=grid, solver_wrapper="seidel")
    return float(found.compute_trajectory().duration)
