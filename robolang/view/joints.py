"""How near each joint of a run came to the ends of its range, and when."""

from collections.abc import Iterable, Mapping, Sequence
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


def ranges(axes: Sequence[Mapping[str, Any]], pieces: Iterable[Array], dt: float) -> list[JointRange]:
    """Return the range of each joint; ``axes``: of ``meta["robot"]``, pieces of q (N, n) rad or m, a row every dt s."""
    limits = [(_number(axis["lower"], -np.inf), _number(axis["upper"], np.inf)) for axis in axes]
    least: list[tuple[float, int]] = [(np.inf, -1)] * len(axes)
    row = 0
    for q in pieces:
        for k, (lower, upper) in enumerate(limits):
            margin = np.minimum(q[:, k] - lower, upper - q[:, k])
            known = np.flatnonzero(np.isfinite(margin))
            if len(known):
                at = known[np.argmin(margin[known])]
                least[k] = min(least[k], (float(margin[at]), row + int(at)))
        row += len(q)
    return [_of(axis, *limit, *found, dt) for axis, limit, found in zip(axes, limits, least, strict=True)]


def _number(value: float | None, endless: float) -> float:
    # null in a log: a joint that turns without end
    return endless if value is None else float(value)


def _of(axis: Mapping[str, Any], lower: float, upper: float, margin: float, row: int, dt: float) -> JointRange:
    unit, size = ("deg", DEG) if axis["kind"] == "revolute" else ("mm", MM)
    return JointRange(
        name=str(axis["name"]),
        unit=unit,
        lower=lower / size if np.isfinite(lower) else None,
        upper=upper / size if np.isfinite(upper) else None,
        least_margin=None if row < 0 else margin / size,
        at_s=None if row < 0 else row * dt,
    )
