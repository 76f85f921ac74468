"""Blocks of recorded rows: in memory while they are new, in a file without a name when they are old.

A block that is full is never written again, so it is the same wherever its numbers lie. In the file each signal of it
stands by itself: who reads one signal of a long run reads no other.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from runtime.control.spill import Spill
from runtime.core.frames import Array

BLOCK_CYCLES = 128
"""Cycles in a block, an even number: about 0.4 MB of a six-axis arm, which is what going back copies."""
FRAME_CYCLES = 2
"""Cycles from one frame to the next: 16 ms, which is more often than a screen shows pictures of a moving part."""
WHOLE = {"line": np.int32, "number": np.int32, "wrist_mode": np.int8, "tool": np.int32}
"""Signals that are whole numbers."""
SCALARS = ("payload_mass", "line", "number", "wrist_mode", "tool")
"""Signals of a cycle with one number."""
_NUMBER = {"ticks": np.float64, "commands": np.float64, "cycles": np.float64, "frames": np.float32}


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """A signal in a block: ``columns`` of the array ``array``; in the file ``width`` numbers a row from ``at`` on."""

    array: str
    columns: slice | int
    width: int
    at: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """The rows of an arm of ``n`` axes with so many ``parts``: how many are in a block, and where each signal is."""

    n: int
    parts: int
    ticks_per_cycle: int

    @property
    def rows(self) -> dict[str, int]:
        """How many rows each array of a block has."""
        ticks = BLOCK_CYCLES * self.ticks_per_cycle
        return {"ticks": ticks, "commands": ticks, "cycles": BLOCK_CYCLES, "frames": BLOCK_CYCLES // FRAME_CYCLES}

    @property
    def signals(self) -> dict[str, tuple[tuple[str, int], ...]]:
        """The signals in each array, in order, with how many numbers they have."""
        vectors = {
            "ticks": ("tau_cmd", "tau_sat", "q_fb", "dq_fb", "q_link"),
            "commands": ("q_cmd", "dq_cmd"),
            "cycles": ("q_plan", "D", "T", "read_us"),
        }
        found = {array: tuple((name, self.n) for name in names) for array, names in vectors.items()}
        found["cycles"] += (("seam_deviation", 6), *((name, 1) for name in SCALARS))
        return {**found, "frames": (("parts", 7 * self.parts), ("fingers", 2))}

    def width(self, array: str) -> int:
        """Return how many numbers a row of an array has."""
        return sum(width for _, width in self.signals[array])

    @property
    def columns(self) -> dict[str, Column]:
        """Where each signal is."""
        return _columns(self)


# looked up for each signal of each block that is read
@cache
def _columns(layout: Layout) -> dict[str, Column]:
    found: dict[str, Column] = {}
    at = 0
    for array, signals in layout.signals.items():
        first = 0
        for name, width in signals:
            columns = first if name in SCALARS else slice(first, first + width)
            found[name] = Column(array=array, columns=columns, width=width, at=at)
            first += width
            at += width * layout.rows[array] * np.dtype(_NUMBER[array]).itemsize
    return found


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class InMemory:
    """The rows of a block as arrays, to be written to: ``ticks``, ``commands``, ``cycles`` and ``frames``."""

    layout: Layout
    ticks: Array
    commands: Array
    cycles: Array
    frames: Array

    @classmethod
    def empty(cls, layout: Layout) -> "InMemory":
        """Return rows of zeros."""
        ticks, commands, cycles, frames = (
            np.zeros((rows, layout.width(array)), dtype=_NUMBER[array]) for array, rows in layout.rows.items()
        )
        return cls(layout=layout, ticks=ticks, commands=commands, cycles=cycles, frames=frames)

    def read(self, name: str, first: int, last: int | None) -> Array:
        """Return rows ``first`` to before ``last`` of a signal, None: to the end of the block."""
        column = self.layout.columns[name]
        rows: Array = getattr(self, column.array)
        return rows[first:last, column.columns]

    def sealed(self, spill: Spill) -> "Sealed":
        """Return the same rows in a file; ``OSError``."""
        data = b"".join(np.ascontiguousarray(self.read(name, 0, None)).tobytes() for name in self.layout.columns)
        return Sealed(layout=self.layout, spill=spill, place=spill.put(data))

    def copy(self) -> "InMemory":
        """Return rows that can be written to apart from these."""
        return _filled(self)


@dataclass(slots=True, kw_only=True, eq=False)
class Sealed:
    """The rows of a block in a file, to be read only."""

    layout: Layout
    spill: Spill
    place: int

    def read(self, name: str, first: int, last: int | None) -> Array:
        """Return rows ``first`` to before ``last`` of a signal, None: to the end of the block; ``OSError``."""
        column = self.layout.columns[name]
        number = np.dtype(_NUMBER[column.array])
        rows = self.layout.rows[column.array]
        count = max(0, (rows if last is None else min(last, rows)) - first)
        row = column.width * number.itemsize
        raw = self.spill.get(self.place + column.at + first * row, count * row)
        values: Array = np.frombuffer(raw, number)
        return values if name in SCALARS else values.reshape(count, column.width)

    def copy(self) -> InMemory:
        """Return rows that can be written to; ``OSError``."""
        return _filled(self)

    # a future that was given up, and a snapshot that is gone, hold no place
    def __del__(self) -> None:
        self.spill.free(self.place)


def _filled(rows: InMemory | Sealed) -> InMemory:
    made = InMemory.empty(rows.layout)
    for name in rows.layout.columns:
        made.read(name, 0, None)[...] = rows.read(name, 0, None)
    return made


@dataclass(slots=True, kw_only=True, eq=False)
class Block:
    """Up to ``BLOCK_CYCLES`` cycles from ``tick`` and ``cycle`` on, and the block before it, None: none is kept."""

    before: "Block | None"
    tick: int
    cycle: int
    data: InMemory | Sealed

    def first(self, array: str) -> int:
        """Return the number of the first row of an array."""
        if array in ("ticks", "commands"):
            return self.tick
        return self.cycle if array == "cycles" else self.cycle // FRAME_CYCLES
