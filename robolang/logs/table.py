"""Signals of a log as one table with a row for each tick: what is exported, piece by piece.

Signals of frames, poses of parts and fingers, have fewer rows. Beside signals of ticks each tick has the values of the
frame before it; alone they have a row for each frame.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from robolang.logs.log import Log
from robolang.logs.quantities import Column, columns
from robolang.logs.selection import selected
from runtime.core.frames import Array

PIECE = 8192
"""Rows that are made at once."""
_TIMES = ("t", "frame_t")


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Columns of a log, the time first, over rows of ticks or, ``of_frames``, of frames."""

    log: Log
    columns: tuple[Column, ...]
    of_frames: bool

    @property
    def rows(self) -> int:
        """How many rows there are."""
        return self.log.count(self.columns[0].signal)

    def pieces(self) -> Iterator[list[Array]]:
        """Yield the columns (K,) of up to ``PIECE`` rows, in the order of the rows."""
        for first in range(0, self.rows, PIECE):
            last = min(first + PIECE, self.rows)
            found: list[Array] = []
            for signal, each in groupby(self.columns, key=lambda column: column.signal):
                values = self._span(signal, first, last)
                flat = values.reshape(len(values), -1)
                found += [flat[:, column.index] for column in each]
            yield found

    def empty(self) -> list[Array]:
        """Return the columns without a row, for their types."""
        return [self.log.span(column.signal, 0, 0).reshape(0) for column in self.columns]

    def _span(self, signal: str, first: int, last: int) -> Array:
        if self.of_frames or self.log.base(signal) == "tick":
            return self.log.span(signal, first, last)
        # by their times: which tick a frame belongs to is known to the recorder alone
        times, frames = self.log.span("t", first, last), self.log["frame_t"]
        at = np.searchsorted(frames, times, "right") - 1
        low = int(at[0])
        return self.log.span(signal, low, int(at[-1]) + 1)[at - low]


def table_of(log: Log, selections: Sequence[str]) -> Table:
    """Return the table of selected signals, without any of all of them; ``Fault`` RBL838."""
    chosen = [column for text in selections for column in selected(log, log, text)]
    if not selections:
        chosen = [column for name in log for column in columns(log, name)]
    # the time is the first column in any case
    kept = list(dict.fromkeys(column for column in chosen if column.signal not in _TIMES))
    # the time alone is that of the ticks
    of_frames = bool(kept) and all(log.base(column.signal) == "frame" for column in kept)
    (time,) = columns(log, "frame_t" if of_frames else "t")
    return Table(log=log, columns=(time, *kept), of_frames=of_frames)
