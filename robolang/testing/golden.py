"""The golden log of a program: ``NAME.golden.npz``, joint angles and running line of every interpolation cycle.

Two arrays, as numpy writes them: ``q`` (cycles, axes) of float32, rad, m of an axis that slides, and ``line`` (cycles,)
of whole numbers. The file is not trusted: it must be a regular one, its directory must be that of two arrays, the
header of each is matched before anything is unpacked, and no more rows are unpacked than the run has, so that memory
is bounded by the run. numpy's own reader allocates what a header asks for. Written and read by ``robolang test``.
"""

import os
import re
import struct
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np

import robolang.core.codes  # noqa: F401 - RBL711 must be registered
from robolang.core.storage import write_atomic
from runtime.core.bounded_files import RefusedError, regular_file
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.rounding import beside
from runtime.robot.model.axis_kind import AxisKind

Bound = tuple[AxisKind, float]
"""What an axis is, and the largest difference in its unit, deg or mm."""
_REMEDY = "Write it with robolang test --update."
_ANGLES = {"<f4": np.float32, "<f8": np.float64}
_LINES = {"<i4": np.int32, "<i8": np.int64}
_HEADER = re.compile(
    rb"\{'descr': '([^']{1,8})', 'fortran_order': False, 'shape': \((\d{1,9}),(?: (\d{1,9}))?\), \} *\n"
)
_MAGIC = b"\x93NUMPY\x01\x00"
_END = struct.Struct("<4s4H2LH")  # end of the directory of a zip file without a comment
# two arrays take some 110 bytes; zipfile reads the directory as a whole, whatever length it states
_MOST_DIRECTORY = 4096
_DAMAGE = (
    OSError,
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    ValueError,
    RuntimeError,
    NotImplementedError,
)
"""What ``zipfile`` raises on bytes that are no zip file, or one of a kind that it does not read."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GoldenLog:
    """A golden log: ``cycles`` of the file, and as many as were read: ``q`` (n, axes) rad or m, ``line`` (n,)."""

    cycles: int
    q: Array
    line: Array

    def difference(self, q: Array, line: Array, bounds: Sequence[Bound]) -> tuple[int | None, str]:
        """Return the first cycle at which a run differs and how; ``None`` and the largest difference when none does.

        ``q`` (cycles, axes) rad or m and ``line`` (cycles,) are those of the run; NaN differs from everything.
        ``bounds`` (axes,) are the largest differences of each axis.
        """
        count = min(len(q), self.cycles)
        # float32 less float32 would round the difference
        off = np.abs(q[:count].astype(np.float64) - self.q[:count]) / np.array([kind.size for kind, _ in bounds])
        most = np.array([at_most for _, at_most in bounds])
        near = (off <= most).all(axis=1)
        differs = np.flatnonzero(~(near & (line[:count] == self.line[:count])))
        if len(differs):
            at = int(differs[0])
            if near[at]:
                return at, f"line {int(line[at])} runs, and line {int(self.line[at])} in the golden log"
            return at, _worst(off[at], bounds)
        if len(q) != self.cycles:
            return count, f"{len(q)} cycles, the golden log has {self.cycles}"
        return None, f"{count} cycles, at most {_largest(off, bounds)} off"


def _worst(off: Array, bounds: Sequence[Bound]) -> str:
    """Return by how much the axis differs that is furthest beyond its bound; ``off`` (axes,) in their units."""
    # NaN first, as argmax has it
    axis = int(np.argmax(off - np.array([most for _, most in bounds])))
    kind, at_most = bounds[axis]
    differs_by, most = beside(float(off[axis]), at_most, form=".3g")
    return f"{differs_by} {kind.unit} off, at most {most} {kind.unit}"


def _largest(off: Array, bounds: Sequence[Bound]) -> str:
    """Return the largest of differences (cycles, axes), of axes that turn and of those that slide."""
    units = [kind.unit for kind, _ in bounds]
    found = {unit: off[:, [each == unit for each in units]].max(initial=0.0) for unit in dict.fromkeys(units)}
    return " and ".join(f"{float(most):.2g} {unit}" for unit, most in found.items())


def write_golden(path: Path, q: Array, line: Array) -> None:
    """Write the joint angles (cycles, axes) rad or m and lines (cycles,) of a run; ``Fault`` RBL706."""
    # with their byte order, so that they are the same on any machine: the reader takes no other
    arrays = {"q": q.astype("<f4"), "line": line.astype("<i4")}
    write_atomic(path, lambda stream: np.savez_compressed(stream, allow_pickle=False, **arrays))


def read_golden(path: Path, axes: int, most_cycles: int) -> GoldenLog:
    """Read at most ``most_cycles`` of a golden log of a robot with ``axes`` axes.

    Raises ``Fault`` RBL600 for what is no readable regular file, RBL711 for one that is no golden log of this robot.
    """
    with _opened(path) as stream:
        try:
            return _read(path, stream, axes, most_cycles)
        except _DAMAGE as error:
            raise _damaged(path, f"it cannot be unpacked: {error or type(error).__name__}") from None


@contextmanager
def _opened(path: Path) -> Iterator[IO[bytes]]:
    """Yield a regular file, open for reading; never waits for the writer of a pipe."""
    try:
        with regular_file(path) as stream:
            yield stream
    except RefusedError as refused:
        if refused.mode is not None:
            raise Fault("RBL600", f"the golden log {path} is not a regular file", _REMEDY) from None
        raise Fault("RBL600", f"cannot open the golden log {path}: {refused.reason}", _REMEDY) from None


def _read(path: Path, stream: IO[bytes], axes: int, most_cycles: int) -> GoldenLog:
    _check_directory(path, stream)
    with zipfile.ZipFile(stream) as archive:
        members = {info.filename: info for info in archive.infolist()}
        if sorted(members) != ["line.npy", "q.npy"] or len(archive.infolist()) != 2:
            raise _damaged(path, "it must have the arrays 'q' and 'line' and no others")
        q = _Member(path, archive, members["q.npy"], _ANGLES)
        line = _Member(path, archive, members["line.npy"], _LINES)
        if q.width != axes or line.width is not None or q.rows != line.rows:
            raise _damaged(path, f"its arrays have the shapes {q.shape} and {line.shape}, not (n, {axes}) and (n,)")
        # rows beyond the run are a difference anyway, and a file may state any number of them
        angles, lines = q.read(most_cycles), line.read(most_cycles)
    if not np.isfinite(angles).all():
        row, axis = np.argwhere(~np.isfinite(angles))[0]
        raise _damaged(path, f"J{axis + 1} of cycle {row + 1} is {angles[row, axis]}, not a finite number")
    return GoldenLog(cycles=q.rows, q=angles, line=lines)


def _check_directory(path: Path, stream: IO[bytes]) -> None:
    """Refuse a directory that ``zipfile`` would make thousands of entries of, before it reads it."""
    size = stream.seek(0, os.SEEK_END)
    if size < _END.size:
        raise _damaged(path, "it is not a zip file")
    # 20 bytes more: the locator of a directory of 64 bit stands before the end
    stream.seek(max(0, size - _END.size - 20))
    tail = stream.read()
    mark, _, _, _, count, length, _, _ = _END.unpack(tail[-_END.size :])
    if mark != b"PK\x05\x06" or tail.startswith(b"PK\x06\x07"):  # the second: a directory of 64 bit
        raise _damaged(path, "it is not a zip file as robolang test writes it")
    if not (count <= 2 and length <= _MOST_DIRECTORY):
        raise _damaged(path, "it must have the arrays 'q' and 'line' and no others")


class _Member:
    """One array of the file; its header is read and checked when it is made, its rows with ``read``."""

    def __init__(self, path: Path, archive: zipfile.ZipFile, info: zipfile.ZipInfo, types: Mapping[str, type]) -> None:
        if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):  # others are unpacked without a bound
            raise _damaged(path, f"'{info.filename}' has a compression that is not supported")
        self._path, self._name = path, info.filename
        self._stream = archive.open(info)
        start = self._stream.read(len(_MAGIC) + 2)
        length = int.from_bytes(start[len(_MAGIC) :], "little")
        # numpy writes 118 bytes; the file may state up to 65535
        header = _HEADER.fullmatch(self._stream.read(length)) if length <= 1024 else None
        if not start.startswith(_MAGIC) or header is None:
            raise _damaged(path, f"'{info.filename}' has no header of an array")
        kind = header[1].decode("latin-1")
        if kind not in types:
            raise _damaged(path, f"'{info.filename}' holds values of type {kind!r}, not one of {', '.join(types)}")
        self._type = np.dtype(types[kind])
        self.rows, self.width = int(header[2]), None if header[3] is None else int(header[3])
        self.shape = (self.rows,) if self.width is None else (self.rows, self.width)
        self._row_bytes = self._type.itemsize * (1 if self.width is None else self.width)
        if info.file_size != len(start) + length + self.rows * self._row_bytes:
            raise _damaged(path, f"'{info.filename}' has {info.file_size} bytes, which its shape does not explain")

    def read(self, most: int) -> Array:
        """Return at most so many rows."""
        count = min(most, self.rows)
        raw = self._stream.read(count * self._row_bytes)
        if len(raw) != count * self._row_bytes:
            raise _damaged(self._path, f"'{self._name}' is cut off")
        if count == self.rows:
            self._stream.read(1)  # the end is where the checksum is compared
        return np.frombuffer(raw, self._type).reshape(count, *self.shape[1:])


def _damaged(path: Path, why: str) -> Fault:
    return Fault("RBL711", f"{path} is not a golden log of this robot: {why}", _REMEDY)
