"""Writing results: a file is there whole or not at all, the old one or the new one, whenever the process is killed.

Data go to a temporary file in the same folder, private until it has the mode and the owner of the file that it
replaces; it is flushed to the disk, takes the final name in one step, and the folder is flushed (decision 0026). The
temporary file is locked while it is written: one that nothing locks was left by a process that was killed, and the next
save in that folder removes it. What cannot be written is a ``Fault`` RBL706, and the folder is checked before a run
starts. Only an ordinary file is ever replaced: not a device, a pipe or a folder, and of a link the file it leads to.
"""

import errno
import fcntl
import json
import math
import os
import re
import shutil
import stat
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, NoReturn

import robolang.core.codes  # noqa: F401 - RBL706 must be registered
from runtime.core.faults import Fault

_PROBE = bytes(4096)
_PREFIX, _SUFFIX = ".robolang-", ".tmp"  # short: with the file's own name in it, one of 255 characters was not written
# tempfile puts eight of these characters into a name: no file of anybody else is removed
_TEMPORARY = re.compile(r"\.robolang-[a-z0-9_]{8}\.tmp")
_UNSYNCED = (errno.EINVAL, errno.ENOTSUP)
"""Errors of file systems on which a folder cannot be flushed."""
_HERE, _RENAME_EXCHANGE = -100, 2  # AT_FDCWD and RENAME_EXCHANGE of Linux


def check_writable(path: Path) -> None:
    """Raise ``Fault`` RBL706 when a file of that name could not be written now; nothing is left of it."""
    target, _ = _target(path)
    try:
        with tempfile.TemporaryFile(dir=target.parent, prefix=_PREFIX, suffix=_SUFFIX) as probe:
            probe.write(_PROBE)  # a full disk lets a file be made and nothing be written to it
    except OSError as error:
        _refuse(path, error)


def write_atomic(path: Path, write: Callable[[IO[bytes]], object], *, private: bool = False) -> None:
    """Write a file with ``write(stream)``, then give it its name; ``Fault`` RBL706, with the old file untouched.

    A file that is there keeps its mode, and its owner where this user may give files away; a further name of it, a hard
    link, keeps the old contents. ``private``: a new file is for its owner alone.
    """
    target, old = _target(path)
    renamed = False
    try:
        with _folder(target.parent) as flush, _temporary(target.parent) as (handle, temporary):
            with os.fdopen(handle, "wb", closefd=False) as stream:
                write(stream)
            if old is not None or not private:
                _take_over(handle, old)
            os.fsync(handle)
            os.replace(temporary, target)  # noqa: PTH105 - one call of the system, as the tests count them
            renamed = True
            flush()
    except OSError as error:
        if renamed:
            message = f"{path} has its new contents, but the disk has not confirmed them: {error.strerror}"
            raise Fault("RBL706", message, "Check the disk, and write the file again.") from None
        _refuse(path, error)


def remove(path: Path) -> None:
    """Remove a file, and flush its folder to the disk; ``Fault`` RBL706. One that is not there is no error."""
    target, old = _target(path)
    try:
        with _folder(target.parent) as flush:
            if old is not None:
                os.unlink(target)  # noqa: PTH108 - one call of the system, as the tests count them
                flush()
    except OSError as error:
        _refuse(path, error)


@contextmanager
def only_one(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder, so that of those who take it one at a time compares and saves.

    A process that is killed holds it no more. In a folder that is not there, cannot be read or has no locks nothing is
    held, and what is then written there says why it cannot be.
    """
    handle = None
    try:
        with suppress(OSError):
            handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        if handle is not None:
            # each in its own block: the lock ends with either of them, and what was saved is saved
            with suppress(OSError):
                fcntl.flock(handle, fcntl.LOCK_UN)
            with suppress(OSError):
                os.close(handle)


@contextmanager
def _folder(folder: Path) -> Iterator[Callable[[], None]]:
    """Remove what killed processes left in a folder; yield what flushes the folder to the disk."""
    _clear(folder)
    try:
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    except PermissionError:  # a folder may be written to and not be read
        yield lambda: None
        return

    def flush() -> None:
        try:
            os.fsync(handle)
        except OSError as error:
            if error.errno not in _UNSYNCED:
                raise

    try:
        yield flush
    finally:
        os.close(handle)


def _clear(folder: Path) -> None:
    """Remove temporary files and folders that no process writes any more; what cannot be removed is left."""
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if _TEMPORARY.fullmatch(entry.name):
                with suppress(OSError):
                    _remove_unlocked(entry)


def _remove_unlocked(entry: os.DirEntry[str]) -> None:
    # a link is not followed and a pipe not waited for: somebody may give either such a name
    handle = os.open(entry.path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if entry.is_dir(follow_symlinks=False):
            shutil.rmtree(entry.path)
        else:
            os.unlink(entry.path)  # noqa: PTH108
    finally:
        os.close(handle)


@contextmanager
def _temporary(folder: Path) -> Iterator[tuple[int, str]]:
    """Yield a new, locked, private file and its name; it is removed where the caller fails, and else has another name.

    It is made anew where a process that clears the folder took it for a rest before it was locked.
    """
    while True:
        handle, name = tempfile.mkstemp(prefix=_PREFIX, suffix=_SUFFIX, dir=folder)
        try:
            if _lock(handle) and os.fstat(handle).st_nlink:
                yield handle, name
                return
        # Ctrl-C as well: no temporary file is left
        except BaseException:
            with suppress(OSError):
                os.unlink(name)  # noqa: PTH108
            raise
        finally:
            os.close(handle)


def _lock(handle: int) -> bool:
    """Lock an open file or folder; False when another process has locked it."""
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks: ``_clear`` removes nothing there
        pass
    return True


def _take_over(handle: int, old: os.stat_result | None) -> None:
    """Give a file the owner and the mode of the one that it replaces; without one, the mode of any new file."""
    if old is None:
        os.fchmod(handle, 0o666 & ~_umask())
        return
    new, mode = os.fstat(handle), stat.S_IMODE(old.st_mode)
    group = new.st_gid
    if (new.st_uid, new.st_gid) != (old.st_uid, old.st_gid):
        with suppress(PermissionError):
            # one by one, the group first: a user may give a file to a group of their own and to no other user
            os.fchown(handle, -1, old.st_gid)
            group = old.st_gid
            os.fchown(handle, old.st_uid, -1)
    if group != old.st_gid:  # another group may do no more than everybody may
        mode &= ~0o070 | (mode & 0o007) << 3
    os.fchmod(handle, mode)


def check_folder(path: Path, ours: Callable[[str], bool]) -> None:
    """Raise ``Fault`` RBL706 when ``write_folder`` could not make or replace that folder now; nothing is left of it."""
    try:
        if path.is_symlink() or path.exists():
            if not path.is_dir() or path.is_symlink():
                raise Fault("RBL706", f"{path} is not a folder", "Give the name of a new or of an existing folder.")
            other = sorted(item.name for item in path.iterdir() if not (item.is_file() and ours(item.name)))
            if other:
                hint = "Give an empty or a new folder."
                raise Fault("RBL706", f"{path} has other files in it, such as {other[0]}", hint)
        with tempfile.TemporaryDirectory(dir=path.absolute().parent, prefix=_PREFIX, suffix=_SUFFIX) as probe:
            (Path(probe) / "probe").write_bytes(_PROBE)
    except OSError as error:
        _refuse(path, error)


def write_folder(path: Path, files: Mapping[str, bytes], ours: Callable[[str], bool]) -> None:
    """Make a folder with these files, whole or not at all; ``Fault`` RBL706, with what was there untouched.

    A name may have folders before it, with ``/`` between them.

    A folder that is there is replaced when ``ours`` says of all names in it that they were written here, in one step
    where the system has one (Linux); elsewhere the old one has another name for a moment, ``.robolang-….old``.
    """
    check_folder(path, ours)
    try:
        with _folder(path.absolute().parent) as flush, _temporary_folder(path.absolute().parent) as (handle, made):
            for name, data in files.items():
                (made / name).parent.mkdir(parents=True, exist_ok=True)
                with (made / name).open("wb") as stream:
                    stream.write(data)
                    stream.flush()
                    os.fsync(stream.fileno())
            there = path.exists()
            # mkdtemp makes a folder that only its owner may read
            made.chmod(stat.S_IMODE(path.stat().st_mode) if there else 0o777 & ~_umask())
            os.fsync(handle)
            if not there:
                made.replace(path)
            elif not _exchange(made, path):
                _exchange_in_steps(made, path)
            flush()
    except OSError as error:
        _refuse(path, error)


@contextmanager
def made_folders(folder: Path) -> Iterator[None]:
    """Make a folder and those above it that are missing; they are removed where what follows raises. ``Fault`` RBL706.

    Also where the caller is interrupted: nothing half-written is left.
    """
    made: list[Path] = []
    try:
        try:
            for missing in reversed([each for each in (folder, *folder.parents) if not each.exists()]):
                missing.mkdir()
                made.append(missing)
        except OSError as error:
            _refuse(folder, error)
        yield
    except BaseException:
        for each in reversed(made):
            with suppress(OSError):  # somebody else may have put something into it
                each.rmdir()
        raise


def add_files(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write files into a folder, all or none, with the folders that their names have; ``Fault`` RBL706.

    The caller has seen that none of them is there; what has been written is removed where another one cannot be.
    """
    undo: list[Callable[[], object]] = []
    try:
        for name, data in files.items():
            path = folder / name
            for missing in reversed([each for each in path.parents if not each.exists()]):
                missing.mkdir()
                undo.append(missing.rmdir)
            # before it is written: a disk that did not confirm the file may have it all the same
            undo.append(path.unlink)
            write_atomic(path, lambda stream, data=data: stream.write(data))  # type: ignore[misc]
    # Ctrl-C as well
    except BaseException as error:
        for each in reversed(undo):
            with suppress(OSError):
                each()
        if isinstance(error, OSError):
            _refuse(folder, error)
        raise


@contextmanager
def _temporary_folder(parent: Path) -> Iterator[tuple[int, Path]]:
    """Yield a new, locked folder and its name; whatever has that name in the end is removed."""
    made = Path(tempfile.mkdtemp(prefix=_PREFIX, suffix=_SUFFIX, dir=parent))
    handle = os.open(made, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        _lock(handle)
        yield handle, made
    finally:
        shutil.rmtree(made, ignore_errors=True)
        os.close(handle)


def _exchange(one: Path, other: Path) -> bool:
    """Exchange the names of two folders in one step; False where the system cannot."""
    import ctypes

    try:
        # Python has no function for it; rename alone cannot replace a folder that is not empty
        call = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError):
        return False
    if call(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _RENAME_EXCHANGE) == 0:
        return True
    number = ctypes.get_errno()
    # an old kernel, or a file system that cannot exchange names
    if number in (errno.ENOSYS, errno.EINVAL):
        return False
    raise OSError(number, os.strerror(number), str(other))


def _exchange_in_steps(one: Path, other: Path) -> None:
    # not .tmp: a process that is killed in between leaves the only old copy here, which no save may remove
    aside = one.with_suffix(".old")
    other.replace(aside)
    try:
        one.replace(other)
    except OSError:
        aside.replace(other)
        raise
    # under the name of the temporary folder, which the caller removes
    aside.replace(one)


def write_json(path: Path, value: object) -> None:
    """Write strict JSON, indented, keys in their order, numbers in full; one that is not finite becomes null.

    A file name that is not UTF-8 is kept as escapes, so that the report of a run is never lost for its name.
    """
    text = json.dumps(strict(value), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    write_atomic(path, lambda stream: stream.write(text.encode("utf-8", "backslashreplace")))


def _target(path: Path) -> tuple[Path, os.stat_result | None]:
    """Return the file that ``path`` leads to and its state, None: not there; ``Fault`` RBL706: not an ordinary one."""
    try:
        target = path.resolve()
        old = target.lstat()
    except FileNotFoundError:
        return target, None
    except (OSError, RuntimeError) as error:  # RuntimeError: a ring of links, before Python 3.13
        _refuse(path, error)
    if stat.S_ISDIR(old.st_mode):
        raise Fault("RBL706", f"{path} is a folder", "Give the name of a file in it.")
    if not stat.S_ISREG(old.st_mode):
        raise Fault("RBL706", f"{path} is not an ordinary file", "Give the name of an ordinary file.")
    if not os.access(target, os.W_OK, effective_ids=os.access in os.supports_effective_ids):
        raise Fault("RBL706", f"{path} is read-only", "Give another name, or make the file writable.")
    return target, old


def _refuse(path: Path, error: Exception) -> NoReturn:
    missing = isinstance(error, FileNotFoundError) and not path.parent.is_dir()
    hint = f"Create the folder {path.parent} first." if missing else ""
    raise Fault("RBL706", f"cannot write {path}: {getattr(error, 'strerror', None) or error}", hint) from None


def _umask() -> int:
    # there is no call that reads the mask without setting it
    mask = os.umask(0)
    os.umask(mask)
    return mask


def strict(value: object) -> object:
    """Return a value as strict JSON has it: a number that is not finite becomes None."""
    if isinstance(value, dict):
        return {key: strict(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [strict(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
