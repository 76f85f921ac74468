"""Doing something again whenever a file changes: programs, what stands beside them, and the configuration above.

Files are compared every ``PERIOD_S``, new ones in a folder included. A file counts as changed when its time, size or
identity is another. ``rounds`` and ``sleep`` are there for tests.
"""

import os
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from robolang.lint.files import STANDARD_INPUT, programs
from robolang.lint.settings import files_above

PERIOD_S = 0.2

Stamp = tuple[int, int, int] | None


def watch(
    paths: Iterable[str],
    check: Callable[[], int],
    *,
    rounds: int | None = None,
    sleep: Callable[[float], object] = time.sleep,
) -> int:
    """Call ``check`` now and after every change, until Ctrl-C or for ``rounds`` rounds; return its last answer."""
    named = list(paths)
    seen, code, done = stamps(named), 0, 0
    try:
        code = check()
        while rounds is None or done < rounds:
            done += 1
            sleep(PERIOD_S)
            # before the check: what changes while it runs is seen in the next round
            now = stamps(named)
            if now != seen:
                seen = now
                code = check()
    except KeyboardInterrupt:
        return code
    return code


def stamps(paths: Iterable[str]) -> dict[str, Stamp]:
    """Return what tells whether anything has changed that a check of these paths reads; None: not there."""
    # a name with a NUL character is no file, and os.stat refuses it
    found = [name for name in programs(paths) if name != STANDARD_INPUT and "\0" not in name]
    folders = {Path(name).parent for name in found} | {Path(name) for name in filter(os.path.isdir, paths)}
    # files that do not exist yet are included: a cell file that appears changes the findings
    files = {str(path) for folder in folders for path in (folder / "cell.toml", *files_above(folder))}
    for name in found:
        files.update((name, *_beside(name)))
    return {name: _stamp(name) for name in sorted(files)}


def _beside(name: str) -> Iterator[str]:
    """Yield the names of the files of one program."""
    return (str(Path(name).with_suffix(ending)) for ending in (".points.toml", ".cell.toml"))


def _stamp(name: str) -> Stamp:
    try:
        info = os.stat(name)  # noqa: PTH116
    except OSError:
        return None
    # a file that is moved into place may have the time and the size of the old one
    return info.st_mtime_ns, info.st_size, info.st_ino
