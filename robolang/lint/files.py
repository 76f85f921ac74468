"""Which programs a list of paths means: files as they are named, folders with every ``*.rbl`` below them.

In a folder hidden files, hidden folders and what the configuration excludes are left out, links to folders are not
followed, and the order is that of the names. A file that is named itself is never excluded. A file is there once,
however often it is named. Nothing is opened here.
"""

import os
from collections.abc import Callable, Iterable, Iterator

SUFFIX = ".rbl"
STANDARD_INPUT = "-"

Excludes = Callable[[str], bool]
"""Whether a file or a folder below one of the paths is left out: ``robolang.lint.settings.Settings.excludes``."""


def programs(paths: Iterable[str], suffix: str = SUFFIX, excludes: Excludes = lambda path: False) -> list[str]:
    """Return the files that paths mean, in order; a path that is no folder stands for itself, there or not."""
    found: dict[str, str] = {}
    for path in paths:
        is_folder = path != STANDARD_INPUT and os.path.isdir(path)  # noqa: PTH112
        inside = _below(path, suffix, excludes) if is_folder else [path]
        for name in inside:
            found.setdefault(_key(name), name)
    return list(found.values())


def _below(folder: str, suffix: str, excludes: Excludes) -> Iterator[str]:
    """Yield the files below a folder, named as the folder was: without ``./`` for the working folder.

    A folder that cannot be listed is yielded itself, so that it is reported like a file that cannot be read.
    """
    closed: list[str] = []
    for place, folders, names in os.walk(folder, onerror=lambda error: closed.append(str(error.filename))):
        # names may be no valid Path
        where = {name: os.path.normpath(os.path.join(place, name)) for name in (*folders, *names)}  # noqa: PTH118
        # in place: os.walk descends into what is left in this very list
        folders[:] = sorted(name for name in folders if not name.startswith(".") and not excludes(where[name]))
        for name in sorted(names):
            if name.lower().endswith(suffix) and not name.startswith(".") and not excludes(where[name]):
                yield where[name]
    yield from closed


def _key(name: str) -> str:
    """Return what two names of one file have in common."""
    # realpath, so that a file and a link to it count as one; it refuses a NUL character
    return name if name == STANDARD_INPUT or "\0" in name else os.path.realpath(name)
