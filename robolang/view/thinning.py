"""Fewer rows for a page: of a long run the least and the largest value of each bin, in the order in which they came.

No peak is lost, only its time inside the bin. What the robot is moved by is thinned evenly instead: a joint that jumps
between its least and its largest angle is not a posture.
"""

from dataclasses import replace

import numpy as np

from robolang.view.packing import Signal
from runtime.core.frames import Array
from runtime.core.units import MM

MOST_ROWS = 60_000
"""Rows of a signal in a page: a minute of servo ticks of 1 ms."""
EVEN_ROWS = 240_000
"""Rows of what the robot is drawn by: of half an hour one every 8 ms, so that it is some hundredths of a mm off."""


def bin_rows(rows: int) -> int:
    """Return the rows of a bin whose two values keep a signal within ``MOST_ROWS``; 1: it is short enough."""
    return 1 if rows <= MOST_ROWS else -(-2 * rows // MOST_ROWS)


def even_step(rows: int) -> int:
    """Return of how many rows one is kept where a signal is thinned evenly."""
    return -(-rows // EVEN_ROWS) or 1


def paired(signal: Signal) -> Signal:
    """Return a signal as pairs, two rows for each bin; one that is short enough is returned as it is."""
    size = bin_rows(len(signal.values))
    if size == 1:
        return signal
    return replace(signal, base="pairs", dt=signal.dt * size / 2, values=pairs(signal.values, size))


def evenly(signal: Signal) -> Signal:
    """Return every so many rows of a signal, the first among them."""
    step = even_step(len(signal.values))
    return replace(signal, dt=signal.dt * step, values=signal.values[::step])


def thinned(rows: int, dt: float, off_m: float) -> dict[str, object] | None:
    """Return what a page says of signals of so many rows, ``dt`` s apart, that are thinned; None: they are not.

    ``off_m`` is how far the drawn tool point is from the true one.
    """
    size = bin_rows(rows)
    if size == 1:
        return None
    text = f"A long run: charts and their values show the least and the largest of every {size * dt * 1e3:g} ms."
    step = even_step(rows)
    if step > 1:
        text += f" The robot is drawn between postures {step * dt * 1e3:g} ms apart, up to {off_m / MM:.2g} mm off."
    return {"every_s": size * dt, "text": text}


def pairs(values: Array, size: int) -> Array:
    """Return the least and the largest of each ``size`` rows of columns (N, k), in their order; 1: the columns."""
    if size == 1:
        return values
    bins = -(-len(values) // size)
    # column by column: a run of half an hour is copied once for each, not for all at once
    return np.stack([least_and_largest(values[:, k], bins, size) for k in range(values.shape[1])], axis=1)


def least_and_largest(column: Array, bins: int, size: int) -> Array:
    """Return two values (2 bins,) of each bin of ``size`` rows of a column (N,), in their order; NaN where none."""
    filled = np.full(bins * size, np.nan)
    filled[: len(column)] = column
    binned = filled.reshape(bins, size)
    known = np.isfinite(binned)
    rows = np.arange(bins)
    least = np.argmin(np.where(known, binned, np.inf), axis=1)
    largest = np.argmax(np.where(known, binned, -np.inf), axis=1)
    first, last = np.minimum(least, largest), np.maximum(least, largest)
    return np.stack([binned[rows, first], binned[rows, last]], axis=1).reshape(-1)
