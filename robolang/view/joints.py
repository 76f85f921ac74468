"""How near each joint of a run came to the ends of its range, and when."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from runtime.core.frames import Array
from runtime.core.units import DEG, MM


@dataclass(frozen=True, slots=True, kw_only=True)
class JointRange:
    """The range of a joint in ``unit`` (deg or mm) and the least distance from an end of it, at ``at_s``.

    None: it has no end there, or there is no angle. A negative margin is outside the range.
    """

    name: str
    unit: str
    lower: float | None
    upper: float | None
    least_margin: float | None
    at_s: float | None


def ranges(axes: Sequence[Mapping[str, Any]], q: Array, dt: float) -> list[JointRange]:
    """Return the range of each joint; ``axes``: of ``meta["robot"]``, q (N, n) rad or m, one row each ``dt`` s."""
    return [_of(axis, q[:, k], dt) for k, axis in enumerate(axes)]


def _of(axis: Mapping[str, Any], q: Array, dt: float) -> JointRange:
    unit, size = ("deg", DEG) if axis["kind"] == "revolute" else ("mm", MM)
    # null in the log: a joint that turns without end
    lower, upper = (np.inf * sign if axis[key] is None else axis[key] for key, sign in (("lower", -1), ("upper", 1)))
    margin = np.minimum(q - lower, upper - q)
    known = np.flatnonzero(np.isfinite(margin))
    at = int(known[np.argmin(margin[known])]) if len(known) else None
    return JointRange(
        name=str(axis["name"]),
        unit=unit,
        lower=float(lower) / size if np.isfinite(lower) else None,
        upper=float(upper) / size if np.isfinite(upper) else None,
        least_margin=None if at is None else float(margin[at]) / size,
        at_s=None if at is None else at * dt,
    )
