"""A run as bytes inside a page: a JSON header and the columns of its signals, in 24 bits each, gzip-compressed.

``gzip([u32 length of the header, little-endian][header][columns of the first signal][of the second]...)``. A column
is coded over its own range, or in the finest step that is of use: code ``q = rint((v - lo) / step) + 1``, and 0 where
there is no number. What is kept is the difference to the code before, modulo 2^24 and with its sign in the lowest bit:
near zero for a motion. The three bytes of the codes stand apart, all lowest ones first, so that gzip finds long runs
of equal bytes. A column that never changes has no bytes. Same run, same bytes: gzip carries no time (decision 0055).
"""

import gzip
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robolang.core.storage import strict
from runtime.core.frames import Array

FORMAT = 1
BITS = 24
LARGEST = 1e30
"""What is larger counts as no number: a page computes in single precision, in which it would be infinite."""
SMALLEST = 1e-30
"""A column whose range is smaller counts as constant: single precision has no steps for it."""
_MASK = (1 << BITS) - 1
_STEPS = _MASK - 1  # the largest code stands for the largest value, and code 0 for none
_LEVEL = 6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Signal:
    """Columns of one name at regular times: row k of ``values`` (rows, columns) holds at ``t0 + k * dt``, s.

    ``base``: ``tick``, ``cycle`` or ``frame``, or ``pairs`` for the least and the largest value of each bin. ``finest``
    is the least step that a reader has a use for, in the unit of the values; 0: as fine as 24 bits are.
    """

    name: str
    base: str
    dt: float
    values: Array
    t0: float = 0.0
    finest: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Coded:
    """Columns in codes: value ``lo + (code - 1) * step``; ``planes`` are the bytes of those with a step over 0.

    ``lo`` and ``step`` have one entry a column; a column without any number has NaN for its ``lo`` and no bytes.
    """

    lo: Array
    step: Array
    planes: bytes


def pack(header: Mapping[str, object], signals: Sequence[Signal]) -> bytes:
    """Return the bytes of a run: ``header`` with the list of the signals, then their columns."""
    coded = [code(signal.values, signal.finest) for signal in signals]
    listed = [_listed(signal, columns) for signal, columns in zip(signals, coded, strict=True)]
    # ASCII: a lone surrogate in the text of a program has no UTF-8, and its escape is read back as it was
    head = json.dumps(strict({"format": FORMAT, **header, "signals": listed}), separators=(",", ":"), allow_nan=False)
    data = b"".join([len(head).to_bytes(4, "little"), head.encode("ascii"), *(columns.planes for columns in coded)])
    return gzip.compress(data, _LEVEL, mtime=0)


def code(values: Array, finest: float = 0.0) -> Coded:
    """Return the codes of columns (rows, columns); a value that is not finite becomes no number."""
    columns = np.ascontiguousarray(values.T, dtype=float)
    there = np.abs(columns) <= LARGEST
    low = np.min(columns, axis=1, where=there, initial=np.inf)
    high = np.max(columns, axis=1, where=there, initial=-np.inf)
    known = there.any(axis=1)
    span = np.where(known, high, 0.0) - np.where(known, low, 0.0)
    span[span < SMALLEST] = 0.0
    # a constant with gaps has two codes, so it needs bytes: any step will do
    step = np.where(span > 0.0, np.maximum(span / _STEPS, finest), np.where(known & ~there.all(axis=1), 1.0, 0.0))
    kept = step > 0.0
    return Coded(
        lo=np.where(known, low, np.nan),
        step=step,
        planes=_planes(columns[kept], there[kept], low[kept, None], step[kept, None]),
    )


def _planes(columns: Array, there: Array, low: Array, step: Array) -> bytes:
    scaled = np.where(there, (np.where(there, columns, low) - low) / step, -1.0)
    codes = np.clip(np.rint(scaled), -1.0, _STEPS).astype(np.int32) + 1
    change = np.diff(codes, axis=1, prepend=0)
    half = 1 << (BITS - 1)
    signed = ((change + half) & _MASK) - half
    folded = (((signed << 1) ^ (signed >> 31)) & _MASK).astype("<u4")
    return np.ascontiguousarray(folded.view(np.uint8).reshape(-1, 4)[:, :3].T).tobytes()


def _listed(signal: Signal, columns: Coded) -> dict[str, object]:
    return {
        "name": signal.name,
        "base": signal.base,
        "t0": signal.t0,
        "dt": signal.dt,
        "rows": len(signal.values),
        "columns": len(columns.lo),
        "lo": columns.lo.tolist(),
        "step": columns.step.tolist(),
    }
