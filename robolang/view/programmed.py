"""The programmed speed of the tool over time: what stands beside the speed that is reached, in plots and pages."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from robolang.view.packing import Signal
from robolang.view.thinning import paired
from runtime.core.frames import Array
from runtime.core.units import MM

NAME = "programmed_speed"
_FINEST = 1e-6


def programmed_speeds(statements: Iterable[Mapping[str, Any]], times: Array) -> Array:
    """Return the programmed speed (N,), m/s, of the statements of a report at times (N,), s; NaN where there is none.

    A move that was not begun has no start, and a joint move no speed along a path; logs of before have neither.
    """
    speeds = np.full(len(times), np.nan)
    for each in statements:
        if each.get("programmed_mm_s") is not None and each["start_s"] is not None:
            first, last = np.searchsorted(times, [each["start_s"], each["start_s"] + each["duration_s"]])
            speeds[first:last] = each["programmed_mm_s"] * MM
    return speeds


def programmed_signal(statements: Iterable[Mapping[str, Any]], cycles: int, cycle_s: float) -> Iterator[Signal]:
    """Yield the programmed speed as a signal of a page, once a cycle; nothing where no speed is programmed."""
    speeds = programmed_speeds(statements, np.arange(cycles, dtype=np.float64) * cycle_s)
    if np.isfinite(speeds).any():
        yield paired(Signal(name=NAME, base="cycle", dt=cycle_s, values=speeds[:, None], finest=_FINEST))
