"""Writing results: a file is there whole or not at all.

Data go to a temporary file in the same folder, are flushed to the disk and take the final name in one step. What
cannot be written is a ``Fault`` RBL706, and the folder is tried before a run starts. Only an ordinary
file is ever replaced: not a device, a pipe or a folder, and of a link the file it leads to.
"""

import json
import math
import os
import shutil
import stat
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, NoReturn

import robolang.codes  # noqa: F401 - RBL706 must be registered
from runtime.faults import Fault

_PROBE = bytes(4096)
_PREFIX = ".robolang-"  # short: with the file's own name in it, a name of 255 characters could be checked, not written


def check_writable(path: Path) -> None:
    """Raise ``Fault`` RBL706 when a file of that name could not be written now; leaves nothing behind."""
    target = _target(path)
    try:
        with tempfile.TemporaryFile(dir=target.parent, prefix=_PREFIX) as probe:
            probe.write(_PROBE)  # a full disk lets a file be made and nothing be written to it
    except OSError as error:
        _refuse(path, error)


def write_atomic(path: Path, write: Callable[[IO[bytes]], object]) -> None:
    """Write a file with ``write(stream)``, then give it its name; ``Fault`` RBL706, with the old file untouched."""
    target = _target(path)
    try:
        handle, temporary = tempfile.mkstemp(prefix=_PREFIX, dir=target.parent)
    except OSError as error:
        _refuse(path, error)
    try:
        with os.fdopen(handle, "wb") as stream:
            write(stream)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(temporary, 0o666 & ~_umask())  # noqa: PTH101 - a Path would add nothing
        Path(temporary).replace(target)
    except OSError as error:
        Path(temporary).unlink(missing_ok=True)
        _refuse(path, error)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def check_folder(path: Path, ours: Callable[[str], bool]) -> None:
    """Raise ``Fault`` RBL706 when ``write_folder`` could not make or replace that folder now; leaves nothing behind."""
    try:
        if path.is_symlink() or path.exists():
            if not path.is_dir() or path.is_symlink():
                raise Fault("RBL706", f"{path} is not a folder", "Give the name of a folder, there or not.")
            other = sorted(item.name for item in path.iterdir() if not (item.is_file() and ours(item.name)))
            if other:
                hint = "Give an empty or a new folder."
                raise Fault("RBL706", f"{path} has other files in it, such as {other[0]}", hint)
        with tempfile.TemporaryDirectory(dir=path.absolute().parent, prefix=_PREFIX) as probe:
            (Path(probe) / "probe").write_bytes(_PROBE)
    except OSError as error:
        _refuse(path, error)


def write_folder(path: Path, files: Mapping[str, bytes], ours: Callable[[str], bool]) -> None:
    """Make a folder with these files, whole or not at all; ``Fault`` RBL706, with what was there untouched.

    A folder that is there is replaced when ``ours`` says of all names in it that they were written here.
    """
    check_folder(path, ours)
    parent = path.absolute().parent
    try:
        made = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=parent))
    except OSError as error:
        _refuse(path, error)
    old: Path | None = None
    try:
        for name, data in files.items():
            with (made / name).open("wb") as stream:
                stream.write(data)
                stream.flush()
                os.fsync(stream.fileno())
        made.chmod(0o777 & ~_umask())
        if path.exists():
            old = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=parent))
            path.replace(old)
        made.replace(path)
    except OSError as error:
        if old is not None and not path.exists():
            old.replace(path)
        _refuse(path, error)
    finally:
        for left in (made, old):
            if left is not None:
                shutil.rmtree(left, ignore_errors=True)


def write_json(path: Path, value: object) -> None:
    """Write strict JSON, indented, keys in their order, numbers in full; one that is not finite becomes null.

    A file name that is not UTF-8 is kept as escapes, so that the report of a run is never lost for its name.
    """
    text = json.dumps(_strict(value), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    write_atomic(path, lambda stream: stream.write(text.encode("utf-8", "backslashreplace")))


def _target(path: Path) -> Path:
    """Return the file that ``path`` leads to, there or not; ``Fault`` RBL706 when it is not an ordinary one."""
    try:
        target = path.resolve()
        mode = target.lstat().st_mode
    except FileNotFoundError:
        return target
    except (OSError, RuntimeError) as error:  # RuntimeError: a ring of links, before Python 3.13
        _refuse(path, error)
    if stat.S_ISDIR(mode):
        raise Fault("RBL706", f"{path} is a folder", "Give the name of a file in it.")
    if not stat.S_ISREG(mode):
        raise Fault("RBL706", f"{path} is not an ordinary file", "Give the name of an ordinary file.")
    if not os.access(target, os.W_OK, effective_ids=os.access in os.supports_effective_ids):
        raise Fault("RBL706", f"{path} is read-only", "Give another name, or permit writing to the file.")
    return target


def _refuse(path: Path, error: Exception) -> NoReturn:
    missing = isinstance(error, FileNotFoundError) and not path.parent.is_dir()
    hint = f"Make the folder {path.parent} first." if missing else ""
    raise Fault("RBL706", f"cannot write {path}: {getattr(error, 'strerror', None) or error}", hint) from None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _strict(value: object) -> object:
    if isinstance(value, dict):
        return {key: _strict(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_strict(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
