"""Reading files that anybody may have put there: regular ones of a bounded size, without waiting.

A pipe would never open and a device never end, so a file is opened without blocking and its kind is looked up before it
is read. What a refusal is called depends on the reader: it turns ``RefusedError`` into its own code and message.
"""

import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import IO


def stays_inside(name: str) -> bool:
    """Return whether a file name is a relative path that stays in its folder, on any system.

    A Windows path is refused on Linux too: the same file means the same on both. Links are not followed here.
    """
    # C:x and \x have an anchor on Windows and are not absolute there, yet leave the folder
    absolute = any(kind(name).is_absolute() or kind(name).anchor for kind in (PurePosixPath, PureWindowsPath))
    return not (absolute or ".." in re.split(r"[/\\]", name) or "\0" in name)


def resolved_inside(path: Path, folder: Path, *, strict: bool = False) -> Path | None:
    """Return a path with its links followed; None where they lead out of a folder.

    ``OSError``, ``RuntimeError`` (a ring of links, before Python 3.13) or ``ValueError`` where it cannot be followed;
    ``strict``: also where it does not exist.
    """
    target = path.resolve(strict=strict)
    return target if target.is_relative_to(folder.resolve(strict=strict)) else None


def kind_text(mode: int) -> str:
    """Return what a file is that is not regular."""
    kinds = {
        stat.S_IFDIR: "a folder",
        stat.S_IFIFO: "a pipe",
        stat.S_IFCHR: "a device",
        stat.S_IFBLK: "a device",
    }
    return kinds.get(stat.S_IFMT(mode), "a special file")


class RefusedError(Exception):
    """A file that is not read. One of three is given: ``error`` where it cannot be opened or read, ``mode`` where it is
    not regular, ``size`` where it is too large."""

    def __init__(self, *, error: OSError | ValueError | None = None, mode: int | None = None, size: int = 0) -> None:
        super().__init__(str(error or mode or size))
        self.error, self.mode, self.size = error, mode, size
        self.opened = False

    @property
    def reason(self) -> str:
        """The reason in words; that of the system without the path that an ``OSError`` names too."""
        if self.mode is not None:
            return f"it is {kind_text(self.mode)}, not a file"
        if self.error is None:
            return f"it has {self.size} bytes, more than are read"
        return str(getattr(self.error, "strerror", None) or self.error)


@contextmanager
def regular_file(path: str | os.PathLike[str], *, links: bool = True) -> Iterator[IO[bytes]]:
    """Yield a regular file, open for reading; ``RefusedError``. ``links`` False: a link is refused, too (ELOOP)."""
    # without O_NONBLOCK the open of a pipe waits for a writer; O_NOCTTY: a terminal must not become ours
    flags = os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC | (0 if links else os.O_NOFOLLOW)
    try:
        handle = os.open(path, flags)
    except (OSError, ValueError) as error:  # ValueError: a NUL character in the name
        raise RefusedError(error=error) from None
    try:
        # of the open file, not of its name, which may be another file by now
        mode = os.fstat(handle).st_mode
        if not stat.S_ISREG(mode):
            raise RefusedError(mode=mode)
        with os.fdopen(handle, "rb", closefd=False) as stream:
            yield stream
    finally:
        os.close(handle)


def read_bounded(path: str | os.PathLike[str], most: int, *, links: bool = True) -> bytes:
    """Return the bytes of a regular file of at most ``most``; ``RefusedError``, ``opened`` where reading it failed."""
    with regular_file(path, links=links) as stream:
        try:
            size = os.fstat(stream.fileno()).st_size
            raw = b"" if size > most else stream.read(most + 1)
        except OSError as error:
            refused = RefusedError(error=error)
            refused.opened = True
            raise refused from None
    if not max(size, len(raw)) <= most:  # it may have grown in the meantime
        raise RefusedError(size=max(size, len(raw)))
    return raw
