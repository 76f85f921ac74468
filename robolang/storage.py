"""Writing results: a file is there whole or not at all.

Data go to a temporary file in the same folder, are flushed to the disk and take the final name in one step. What
cannot be written is a ``Fault`` RBL706, and the folder is tried before a run starts (promise R24).
"""

import json
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import IO

import robolang.codes  # noqa: F401 - RBL706 must be registered
from runtime.faults import Fault


def check_writable(path: Path) -> None:
    """Raise ``Fault`` RBL706 when a file of that name could not be written now."""
    if path.is_dir():
        raise Fault("RBL706", f"{path} is a folder")
    try:
        with tempfile.TemporaryFile(dir=path.parent or Path()):
            pass
    except OSError as error:
        raise Fault("RBL706", f"cannot write {path}: {error.strerror}") from None


def write_atomic(path: Path, write: Callable[[IO[bytes]], object]) -> None:
    """Write a file with ``write(stream)``, then give it its name; ``Fault`` RBL706, with the old file untouched."""
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent or Path())
    except OSError as error:
        raise Fault("RBL706", f"cannot write {path}: {error.strerror}") from None
    try:
        with os.fdopen(handle, "wb") as stream:
            write(stream)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(temporary, 0o666 & ~_umask())  # noqa: PTH101 - a Path would add nothing
        Path(temporary).replace(path)
    except OSError as error:
        Path(temporary).unlink(missing_ok=True)
        raise Fault("RBL706", f"cannot write {path}: {error.strerror}") from None
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def write_json(path: Path, value: object) -> None:
    """Write plain JSON, indented, keys in their order, numbers in full."""
    text = json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    write_atomic(path, lambda stream: stream.write(text.encode("utf-8")))
