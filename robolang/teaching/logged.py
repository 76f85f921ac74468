"""Where the arm stood in the log of a run (``.npz``): the commanded joint angles when a line was left, or at a time.

The file is not trusted: what its headers state is compared with its size before anything is unpacked. Numbers of a
program are what is written before its statements; a program without them has the lines of its file.
"""

import io
import zipfile
import zlib
from pathlib import Path

import numpy as np

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from runtime.core.bounded_files import RefusedError, read_bounded
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.rounding import beside

MOST_BYTES = 2_000_000_000
"""Largest log that is read, and largest signal in it: some hours of a six-axis arm."""
_DAMAGE = (zipfile.BadZipFile, zlib.error, EOFError, ValueError, RuntimeError, NotImplementedError, KeyError)
"""What is raised for bytes that are no zip file, or no array."""


def joints_at_end_of(path: Path, axes: int, line: int, time_s: float | None = None) -> Array:
    """Return the joint angles (axes,) rad at the end of the last execution of a line, or of the last before a time.

    ``Fault`` RBL600 for a file that cannot be read, RBL619 for one that is no log of an arm with so many axes, or in
    which the line has not been carried out by then.
    """
    log = _Log(path, axes)
    numbers = log.signal("number")
    lines, what = (numbers, "number") if numbers.any() else (log.signal("line"), "line")
    # 0 stands for no statement
    rows = np.flatnonzero((lines == line) & (lines > 0))
    if time_s is not None:
        rows = rows[log.signal("t")[rows] <= time_s]
    if not len(rows):
        known = ", ".join(map(str, np.unique(lines[lines > 0]).tolist()[:20])) or "none"
        before = "" if time_s is None else f" before {time_s:g} s"
        raise Fault("RBL619", f"{path}: no statement of {what} {line} runs{before}; those that do: {known}")
    last = int(rows[-1])
    if time_s is not None:
        # the execution that runs at that time is not over: its end comes later
        going = np.flatnonzero(lines[last:] != line)
        last = len(lines) - 1 if not len(going) else last + int(going[0]) - 1
    return log.joints(last)


def joints_at(path: Path, axes: int, time_s: float) -> Array:
    """Return the joint angles (axes,) rad at a time of a run, s; ``Fault`` as ``joints_at_end_of``."""
    log = _Log(path, axes)
    times = log.signal("t")
    if not len(times) or not 0.0 <= time_s <= times[-1]:
        end = 0.0 if not len(times) else float(times[-1])
        given, last = beside(time_s, end)
        raise Fault("RBL619", f"{path}: {given} s is not within the run, which ends at {last} s")
    # the tick that has begun by then; half a microsecond for times that are no binary fractions
    return log.joints(int(np.searchsorted(times, time_s + 5e-7, side="right")) - 1)


class _Log:
    """The signals of a log, read one by one."""

    def __init__(self, path: Path, axes: int) -> None:
        self._path, self._axes = path, axes
        try:
            self._file = zipfile.ZipFile(io.BytesIO(read_bounded(path, MOST_BYTES)))
        except RefusedError as error:
            raise Fault("RBL600", f"cannot read {path}: {error.reason}") from None
        except _DAMAGE as error:
            raise self._damaged(error) from None

    def joints(self, row: int) -> Array:
        """Return the commanded angles (axes,) rad of a servo tick."""
        q = self.signal("q_cmd", 2)
        if q.shape[1] != self._axes:
            raise Fault("RBL619", f"{self._path} is the log of an arm with {q.shape[1]} axes, not {self._axes}")
        return np.array(q[row], dtype=np.float64)

    def signal(self, name: str, dimensions: int = 1) -> Array:
        """Return a signal, first dimension the servo ticks."""
        try:
            entry = self._file.getinfo(f"{name}.npy")
            with self._file.open(entry) as stream:
                if np.lib.format.read_magic(stream) != (1, 0):
                    raise ValueError("an array of another format")
                shape, fortran, dtype = np.lib.format.read_array_header_1_0(stream)
                size = int(np.prod(shape, dtype=object)) * dtype.itemsize
                plain = dtype.kind in "if" and not fortran and len(shape) == dimensions
                # before it is unpacked: a header may state more than the memory has
                if not (plain and size + stream.tell() == entry.file_size <= MOST_BYTES):
                    raise ValueError(f"{name} is not an array of a log")
                return np.frombuffer(stream.read(size), dtype).reshape(shape)
        except _DAMAGE as error:
            raise self._damaged(error) from None

    def _damaged(self, error: Exception) -> Fault:
        return Fault("RBL619", f"{self._path} is not the log of a run: {error}")
