"""The log of a run as ``.npz``, which numpy reads: what was recorded, and what the run was of.

Rows of a tick have the names of their signals, those of a cycle ``cycle/NAME`` and those of a frame ``frame/NAME``;
``tools`` are the tools that ``cycle/tool`` numbers, and ``meta`` is JSON in UTF-8. What follows from these is not in
the file: ``robolang.read_log`` computes it. Files of layout 1, which had everything in every tick, are read as well.
"""

import json
import math
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any, cast

import numpy as np

from robolang.logs.archive import Archive
from robolang.logs.log import Log
from robolang.logs.meta import read_meta, ticks_of
from runtime.control.blocks import FRAME_CYCLES, SCALARS, WHOLE
from runtime.control.signals import NAMES, OF_FRAMES, Base, Rows
from runtime.core.frames import Array

_TICKS = ("t", "line", "q_cmd", "dq_cmd", "q_fb", "dq_fb", "tau_cmd", "tau_sat", "q_link")
_CYCLES = ("q_plan", "D", "T", "read_us", "payload_mass", "number", "wrist_mode", "seam_deviation", "tool")
_FRAMES = ("parts", "fingers")
_OLD = tuple(name for name in NAMES if name not in (*OF_FRAMES, "tool_cmd", "tool_error", "tool_speed"))
"""Signals of layout 1."""
_PIECE = 8192
"""Rows that are written at once."""


def write_npz(stream: IO[bytes], log: Log) -> None:
    """Write a log, piece by piece; equal logs give equal bytes."""
    rows = log.rows
    with zipfile.ZipFile(stream, "w") as file:
        text = json.dumps(log.needed_meta(), allow_nan=False, separators=(",", ":")).encode("ascii")
        meta: Any = np.frombuffer(text, np.uint8)
        _write(file, "meta", len(meta), iter([meta]), packed=True)
        for name in _TICKS:
            _write(file, name, rows.ticks, _pieces(log.span, name, rows.ticks))
        for name in _CYCLES:
            _write(file, f"cycle/{name}", rows.cycles, _pieces(rows.read, name, rows.cycles))
        for name in _FRAMES:
            _write(file, f"frame/{name}", rows.frames, _pieces(rows.read, name, rows.frames))
        _write(file, "tools", len(rows.tools), iter([np.stack(rows.tools)]))


def _pieces(read: Any, name: str, count: int) -> Iterator[Array]:
    # at least one: of a run without a tick the header of the array needs its shape
    for first in range(0, max(1, count), _PIECE):
        yield np.ascontiguousarray(read(name, first, min(first + _PIECE, count)))


def _write(file: zipfile.ZipFile, name: str, count: int, pieces: Iterator[Array], *, packed: bool = False) -> None:
    # numpy dates every entry of an archive 1980-01-01, and so does this: equal signals give equal bytes
    entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
    entry.compress_type = zipfile.ZIP_DEFLATED if packed else zipfile.ZIP_STORED
    with file.open(entry, "w", force_zip64=True) as stream:
        for number, piece in enumerate(pieces):
            # the number of rows is known before the first of them is computed
            if number == 0:
                header = {"descr": piece.dtype.str, "fortran_order": False, "shape": (count, *piece.shape[1:])}
                np.lib.format.write_array_header_1_0(stream, header)
            stream.write(piece.data if piece.size else b"")


def read_npz(path: Path | str) -> Log:
    """Return the log in a file of ``robolang run --log FILE.npz``; its signals are read when they are used.

    ``Fault`` RBL600 for a file that cannot be read, RBL619 for one that is no log or is damaged, which may show only
    when a signal is read, and RBL821 for one of a later version.
    """
    archive = Archive(Path(path))
    if "meta" not in archive:
        return OldLog(archive)
    try:
        meta = read_meta(archive.packed("meta"), archive.path)
        return Log(FileRows(archive, meta), meta, str(path))
    except (KeyError, TypeError, ValueError, IndexError, OverflowError) as error:
        raise archive.damaged(f"its meta is not as it should be: {error}") from None


class FileRows:
    """The rows of a run in a file: ``runtime.control.signals.Rows``. A row of another shape is a ``Fault`` RBL619."""

    def __init__(self, archive: Archive, meta: dict[str, Any]) -> None:
        self._archive = archive
        self._axes = len(meta["robot"]["axes"])
        self.tick_us, self.ticks_per_cycle = ticks_of(meta)
        times = archive.stored("t")
        # all memory that a signal takes is counted from here: a shorter number would let a small file ask for much
        if times.dtype != np.float64 or len(times.shape) != 1:
            raise ValueError(f"t has the shape {times.shape} of {times.dtype}")
        self.ticks = times.shape[0]
        self.cycles = math.ceil(self.ticks / self.ticks_per_cycle)
        self.frames = math.ceil(self.cycles / FRAME_CYCLES)
        self._tools = archive.stored("tools")
        if self._tools.shape[1:] != (4, 4) or not self._tools.shape[0]:
            raise ValueError("a tool is not 4 x 4")

    @property
    def tools(self) -> tuple[Array, ...]:
        """The tools that have been used, X_flange_tool (4, 4)."""
        return tuple(self._archive.rows("tools", 0, self._tools.shape[0]))

    def read(self, name: str, first: int, last: int) -> Array:
        """Return rows ``first`` to before ``last`` of a recorded signal."""
        if name == "line":
            # of a cycle all ticks have one line
            step = self.ticks_per_cycle
            return self._rows("line", self.ticks, first * step, last * step)[::step]
        if name in _TICKS:
            return self._rows(name, self.ticks, first, last)
        if name in _CYCLES:
            return self._rows(f"cycle/{name}", self.cycles, first, last)
        return self._rows(f"frame/{name}", self.frames, first, last)

    def _rows(self, place: str, count: int, first: int, last: int) -> Array:
        name, stored = place.rpartition("/")[2], self._archive.stored(place)
        widths = {"t": (), "parts": (*stored.shape[1:2], 7), "fingers": (2,), "seam_deviation": (6,)}
        width = widths.get(name, () if name in SCALARS else (self._axes,))
        number = np.float32 if name in _FRAMES else WHOLE.get(name, np.float64)
        if stored.shape != (count, *width) or stored.dtype != number:
            raise self._archive.damaged(
                f"{place} has the shape {stored.shape} of {stored.dtype}, not {(count, *width)}"
            )
        rows = self._archive.rows(place, first, last)
        if name == "tool" and len(rows) and not 0 <= rows.min() <= rows.max() < self._tools.shape[0]:
            raise self._archive.damaged("a tool is used that it does not have")
        return rows


class OldLog(Log):
    """A log of layout 1: the signals that are in the file, one row a tick; nothing is known of the program."""

    version = 1

    def __init__(self, archive: Archive) -> None:
        self._archive = archive
        shape = archive.stored("t").shape
        if len(shape) != 1:
            raise archive.damaged(f"t has the shape {shape}")
        self._ticks = shape[0]
        self._names = tuple(name for name in _OLD if name in archive)
        # all rows are of ticks, and are read in ``span``
        super().__init__(cast("Rows", None), None, str(archive.path))

    def __iter__(self) -> Iterator[str]:
        """Yield the names."""
        return iter(self._names)

    def __len__(self) -> int:
        """Return how many signals there are."""
        return len(self._names)

    def __contains__(self, name: object) -> bool:
        """Return whether there is such a signal."""
        return name in self._names

    def base(self, name: str) -> Base:
        """Return what a row of a signal is."""
        return "tick"

    def count(self, name: str) -> int:
        """Return how many rows a signal has."""
        return self._ticks

    def span(self, name: str, first: int, last: int) -> Array:
        """Return rows of a signal; ``KeyError``, ``Fault`` RBL619."""
        if name not in self._names:
            raise KeyError(name)
        if self._archive.stored(name).shape[0] != self._ticks:
            raise self._archive.damaged(f"{name} has another number of ticks")
        return self._archive.rows(name, first, last)

    def each_cycle(self, name: str) -> Array:
        """Refuse: ``Fault`` RBL820, since the length of a cycle is not in the file."""
        raise self.lacks("the length of a cycle")
