"""A temporary file for what a run has recorded, so that its length does not cost memory.

It has no name: nobody else opens it, and nothing is left of it whenever the process ends. It is made when it is first
written to. Pieces have one size, and the place of one that is no longer needed is used again.
"""

import os
import tempfile
import weakref
from pathlib import Path


class Spill:
    """Pieces of bytes in a file without a name."""

    def __init__(self, folder: Path | None = None) -> None:
        """``folder``: where the file is made; None: where the system has temporary files."""
        self._folder = folder
        self._handle: int | None = None
        self._end = 0
        self._free: list[int] = []

    def put(self, data: bytes) -> int:
        """Write a piece and return its place; ``OSError``, and nothing that was written before is lost."""
        if self._handle is None:
            file = tempfile.TemporaryFile(dir=self._folder)  # noqa: SIM115 - open as long as this object is there
            weakref.finalize(self, file.close)
            self._handle = file.fileno()
        at = self._free[-1] if self._free else self._end
        written = 0
        # a file system may take less than it is given
        while written < len(data):
            written += os.pwrite(self._handle, data[written:], at + written)
        # only now: a piece that failed has not used its place
        if self._free:
            self._free.pop()
        else:
            self._end += len(data)
        return at

    def get(self, at: int, size: int) -> bytes:
        """Return ``size`` bytes from a place on; ``OSError``."""
        assert self._handle is not None  # a place is that of a piece
        data = os.pread(self._handle, size, at)
        while 0 < len(data) < size and (more := os.pread(self._handle, size - len(data), at + len(data))):
            data += more
        if len(data) != size:
            raise OSError("the temporary file of the log is shorter than what was written")
        return data

    def free(self, at: int) -> None:
        """Let the place of a piece be used again."""
        self._free.append(at)
