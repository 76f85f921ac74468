"""Joint set-points that are given instead of planned: whether an arm may be sent them, one every 8 ms.

They are held to what a plan is held to (``single``, ``path_ik.check_range``): at every servo tick that fine
interpolation makes of them, from those that are already sent until the command stands at the last one, each joint is
within its range and below its speed and acceleration. Called by the controller before anything moves; rad, s.
"""

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.rounding import beside
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.path_ik import RANGE_TOLERANCE
from runtime.robot.model.spec import RobotSpec

_BETWEEN = 5e-6
"""How far past a limit the command may be between set-points that keep it, rad (0.0003 deg)."""

_SLACK = 1.0 + 1e-6
"""A planner leaves its moves the same share of rounding (``timing``)."""


def as_rows(spec: RobotSpec, rows: Array) -> Array:
    """Return set-points (K, n) as an array of their own; ``ValueError`` when K is 0 or a number is not finite."""
    given = np.array(rows, dtype=np.float64)
    if given.ndim != 2 or given.shape[1] != spec.n or not len(given):
        raise ValueError(f"set-points of shape {given.shape}; {spec.name} needs (K, {spec.n}) with K at least 1")
    bad = np.argwhere(~np.isfinite(given))
    if len(bad):
        k, axis = bad[0]
        raise ValueError(f"set-point {k} of J{axis + 1} is {given[k, axis]}")
    return given


def check_motion(spec: RobotSpec, fine: FineInterpolator, rows: Array, here: Array) -> None:
    """Refuse set-points (K, n) with ``Fault``: RBL411 out of the range of a joint, RBL404 too fast for one.

    A command that already stands beyond a limit, at ``here`` (n,), may go anywhere but further out.
    """
    q, dq, ddq = fine.after(rows)
    check_range(spec, rows, here)
    # the set-points keep the range to rounding; between them the command swings a little where it starts or stops
    check_range(spec, q, here, _BETWEEN)
    _check_rate(spec, dq, spec.per_axis("limits", "speed"), "/s")
    _check_rate(spec, ddq, spec.per_axis("limits", "acceleration"), "/s2")


def check_range(spec: RobotSpec, q: Array, here: Array | None = None, tolerance: float = RANGE_TOLERANCE) -> None:
    """Refuse joint angles (K, n) out of the range of a joint, widened to ``here`` (n,); ``Fault`` RBL411."""
    lower, upper = spec.lower, spec.upper
    if here is not None:
        lower, upper = np.minimum(lower, here), np.maximum(upper, here)
    excess = np.maximum(lower - q, q - upper).max(axis=0)
    axis = int(np.argmax(excess))
    if not excess[axis] <= tolerance:
        raise Fault("RBL411", f"J{axis + 1} would leave its range by {spec.axes[axis].kind.text(excess[axis], '.4g')}")


def _check_rate(spec: RobotSpec, rates: Array, limits: Array, per: str) -> None:
    most = np.abs(rates).max(axis=0)
    axis = int(np.argmax(most / limits))
    if not most[axis] <= limits[axis] * _SLACK:
        kind = spec.axes[axis].kind
        verb = "accelerate" if per == "/s2" else kind.moves.removesuffix("s")
        unit = kind.unit + per
        rate, limit = beside(most[axis] / kind.size, limits[axis] / kind.size, form=".1f")
        raise Fault("RBL404", f"J{axis + 1} would {verb} at {rate} {unit}, more than its {limit} {unit}")
