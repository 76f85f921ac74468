"""A name that one running process holds: others see that it is held, and a process that is killed holds it no more."""

import fcntl
import os
from contextlib import suppress
from pathlib import Path


class Claim:
    """A lock file that is held; ``release`` removes it. See ``claim``."""

    def __init__(self, path: Path, handle: int) -> None:
        self._path = path
        self._handle: int | None = handle

    def release(self) -> None:
        """Remove the lock file and hold it no more; a second call does nothing."""
        if self._handle is None:
            return
        with suppress(OSError):
            # while it is held: nobody else has locked a file of this name
            os.unlink(self._path)  # noqa: PTH108
        os.close(self._handle)
        self._handle = None


def claim(path: Path) -> Claim | None:
    """Make and lock a file of a name; None: another process holds it, and nothing was changed. ``OSError``."""
    return _held(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)


def is_claimed(path: Path) -> bool:
    """Return whether a running process holds a name; a lock file that is left over is removed."""
    try:
        found = _held(path, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError:  # not there, or not a file
        return False
    if found is not None:
        found.release()
    return found is None


def _held(path: Path, flags: int) -> Claim | None:
    while True:
        handle = os.open(path, flags, 0o600)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # the one who held it may have removed it between the two calls: then it is made anew
            same = _is(path, os.fstat(handle))
        except BlockingIOError:
            os.close(handle)
            return None
        except BaseException:
            os.close(handle)
            raise
        if same:
            return Claim(path, handle)
        os.close(handle)


def _is(path: Path, opened: os.stat_result) -> bool:
    try:
        named = os.lstat(path)
    except FileNotFoundError:
        return False
    return (named.st_dev, named.st_ino) == (opened.st_dev, opened.st_ino)
