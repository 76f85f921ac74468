"""The arrays in a ``.npz`` file, read row by row. The file is not trusted.

What its headers state is compared with its size before anything is unpacked or any memory is taken, and an array is
compared with its checksum when it is first read. Arrays are stored as they are, so that rows of a long run are read
without the rest; the only one that is packed, ``meta``, is read with ``packed``.
"""

import os
import re
import struct
import weakref
import zipfile
import zlib
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.logs.meta import unreadable
from runtime.core.bounded_files import RefusedError, regular_file
from runtime.core.faults import Fault
from runtime.core.frames import Array

MOST_BYTES = 64_000_000_000
"""Largest log that is read: some days of a six-axis arm."""
MOST_PACKED = 256_000_000
"""Most bytes of an array that is packed, before they are unpacked and after: half a million statements in a report."""
_MOST_LISTED = 100_000
"""Most bytes of the list of arrays at the end of a file: some hundred arrays, where a log has thirty."""
_END = struct.Struct("<4s4H2LH")  # end of central directory: PKZIP APPNOTE 4.3.16, without a comment
_LOCATOR = struct.Struct("<4sLQL")  # end of central directory locator of a large file: APPNOTE 4.3.15
_END64 = struct.Struct("<4sQ2H2L4Q")  # end of central directory of a large file: APPNOTE 4.3.14
_LOCAL = struct.Struct("<4s5H3L2H")  # local file header: APPNOTE 4.3.7
_MAGIC = b"\x93NUMPY\x01\x00"
_HEADER = re.compile(
    rb"\{'descr': '(<[fi][48]|\|[iu]1)', 'fortran_order': False, "
    rb"'shape': \((\d{1,18},|\d{1,18}(?:, \d{1,18}){1,3})\), \} *\n"
)
_HASHED = 1 << 20
_DAMAGE = (zipfile.BadZipFile, zlib.error, EOFError, ValueError, RuntimeError, NotImplementedError, KeyError)
"""What is raised for bytes that are no zip file, or no array."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stored:
    """An array in a file: its ``shape`` and ``dtype``, and the place of its numbers."""

    shape: tuple[int, ...]
    dtype: np.dtype[np.float64]
    at: int

    @property
    def row(self) -> int:
        """Bytes of a row."""
        return int(np.prod(self.shape[1:], dtype=object)) * self.dtype.itemsize


class Archive:
    """The arrays of a file by name; ``Fault`` RBL600 where it cannot be read, RBL619 where it is no such file."""

    def __init__(self, path: Path) -> None:
        self.path = path
        with ExitStack() as opened:
            try:
                # held open: a file that is replaced meanwhile is not mixed with the new one
                self._file = os.fdopen(os.dup(opened.enter_context(regular_file(path)).fileno()), "rb")
                self._size = os.fstat(self._file.fileno()).st_size
            except (RefusedError, OSError) as error:
                raise unreadable(path, _reason(error)) from None
        # a log is closed when nobody has it any more: it is used like an array
        self.close = weakref.finalize(self, self._file.close)
        self._stored: dict[str, Stored] = {}
        try:
            self._list()
        except (*_DAMAGE, OSError, struct.error) as error:
            self.close()
            raise self.damaged(error) from None

    def _list(self) -> None:
        if not _END.size <= self._size <= MOST_BYTES:
            raise ValueError(f"a file of {self._size} bytes")
        self._file.seek(-_END.size, os.SEEK_END)
        mark, _, _, _, _, listed, _, comment = _END.unpack(self._file.read(_END.size))
        # before zipfile reads it: a list may be as long as the file
        if mark != b"PK\5\6" or comment or not max(listed, self._listed64()) <= _MOST_LISTED:
            raise ValueError("it is cut off, or no log at all")
        self._zip = zipfile.ZipFile(self._file)

    def _listed64(self) -> int:
        """Return the bytes of the list that a file beyond 4 GB states, which counts more than the other; 0: none."""
        at = self._size - _END.size - _LOCATOR.size
        place = at - _END64.size
        self._file.seek(max(0, at))
        mark, _, stated, _ = _LOCATOR.unpack(self._file.read(_LOCATOR.size))
        if mark != b"PK\6\7":
            return 0
        self._file.seek(max(0, place))
        end = _END64.unpack(self._file.read(_END64.size))
        # zipfile reads what lies before the locator, or what the locator names: they have to be one
        if end[0] != b"PK\6\6" or stated != place:
            raise ValueError("its end is not that of a log")
        return int(end[-2])

    def __contains__(self, name: str) -> bool:
        """Return whether there is an array of this name."""
        return f"{name}.npy" in self._zip.NameToInfo

    def stored(self, name: str) -> Stored:
        """Return an array whose headers agree with the size of the file; ``Fault`` RBL619."""
        if name not in self._stored:
            try:
                self._stored[name] = self._checked(name)
            except (*_DAMAGE, OSError, struct.error) as error:
                raise self.damaged(error) from None
        return self._stored[name]

    def rows(self, name: str, first: int, last: int) -> Array:
        """Return rows ``first`` to before ``last``; ``Fault`` RBL619."""
        stored = self.stored(name)
        count = max(0, min(last, stored.shape[0]) - first)
        try:
            # not through the buffer of the file: what is cut meanwhile would still be in it
            raw = os.pread(self._file.fileno(), count * stored.row, stored.at + first * stored.row)
            return np.frombuffer(raw, stored.dtype).reshape(count, *stored.shape[1:])
        except (ValueError, OSError) as error:
            raise self.damaged(error) from None

    def packed(self, name: str) -> bytes:
        """Return the bytes of a packed array (K,) of uint8; ``Fault`` RBL619."""
        try:
            entry = self._entry(name)
            if not max(entry.file_size, entry.compress_size) <= MOST_PACKED:
                raise ValueError(f"{name} has {entry.file_size} bytes")
            with self._zip.open(entry) as stream:
                shape, dtype = _header(stream)
                data = stream.read(MOST_PACKED)  # to its end, where zipfile compares the checksum
            if dtype != np.uint8 or shape != (len(data),):
                raise ValueError(f"{name} is not a text")
            return data
        except (*_DAMAGE, OSError) as error:
            raise self.damaged(error) from None

    def _entry(self, name: str) -> zipfile.ZipInfo:
        entry = self._zip.NameToInfo.get(f"{name}.npy")
        if entry is None:
            raise ValueError(f"it has no array '{name}'")
        return entry

    def _checked(self, name: str) -> Stored:
        entry = self._entry(name)
        if entry.compress_type != zipfile.ZIP_STORED or entry.flag_bits & 1 or entry.file_size != entry.compress_size:
            raise ValueError(f"{name} is packed")
        self._file.seek(entry.header_offset)
        local = _LOCAL.unpack(self._file.read(_LOCAL.size))
        begin = entry.header_offset + _LOCAL.size + local[-2] + local[-1]
        if local[0] != b"PK\3\4" or not begin + entry.file_size <= self._size:
            raise ValueError(f"{name} is not where the list says")
        self._file.seek(begin)
        shape, dtype = _header(self._file)
        at = self._file.tell()
        if not int(np.prod(shape, dtype=object)) * dtype.itemsize == entry.file_size - (at - begin):
            raise ValueError(f"{name} has another size than its header says")
        self._compare(name, begin, entry)
        return Stored(shape=shape, dtype=dtype, at=at)

    def _compare(self, name: str, begin: int, entry: zipfile.ZipInfo) -> None:
        self._file.seek(begin)
        crc, left = 0, entry.file_size
        while left > 0 and (piece := self._file.read(min(left, _HASHED))):
            crc, left = zlib.crc32(piece, crc), left - len(piece)
        if left or crc != entry.CRC:
            raise ValueError(f"the checksum of {name} is wrong")

    def damaged(self, why: object) -> Fault:
        """Return the fault of a file that is no log, with the reason."""
        return Fault("RBL619", f"{self.path} is not the log of a run: {why}")


def _header(stream: IO[bytes]) -> tuple[tuple[int, ...], np.dtype[np.float64]]:
    """Read the header of an array of plain numbers, row after row, as numpy writes it; ``ValueError``."""
    mark = stream.read(len(_MAGIC) + 2)
    if len(mark) != len(_MAGIC) + 2 or not mark.startswith(_MAGIC):
        raise ValueError("an array of another format")
    # matched, and not read by numpy, which hands what it finds there to a parser of Python
    found = _HEADER.fullmatch(stream.read(int.from_bytes(mark[len(_MAGIC) :], "little")))
    if found is None:
        raise ValueError("an array of another kind")
    shape = tuple(map(int, re.findall(rb"\d+", found[2])))
    return shape, np.dtype(found[1].decode("ascii"))


def _reason(error: Exception) -> str:
    return error.reason if isinstance(error, RefusedError) else str(getattr(error, "strerror", None) or error)
