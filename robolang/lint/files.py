"""Which programs a list of paths means: files as they are named, folders with every ``*.rbl`` below them.

In a folder hidden files and hidden folders are passed over, links to folders are not followed, and the order is that
of the names. A file is there once, however often it is named. Nothing is opened here.
"""

import os
from collections.abc import Iterable, Iterator

SUFFIX = ".rbl"
STANDARD_INPUT = "-"


def programs(paths: Iterable[str], suffix: str = SUFFIX) -> list[str]:
    """Return the files that paths mean, in order; a path that is no folder stands for itself, there or not."""
    found: dict[str, str] = {}
    for path in paths:
        inside = _below(path, suffix) if path != STANDARD_INPUT and os.path.isdir(path) else [path]  # noqa: PTH112
        for name in inside:
            found.setdefault(_key(name), name)
    return list(found.values())


def _below(folder: str, suffix: str) -> Iterator[str]:
    """Yield the files below a folder, named as the folder was: without ``./`` for the working folder.

    A folder that cannot be listed is yielded itself, so that it is reported like a file that cannot be read.
    """
    closed: list[str] = []
    for place, folders, names in os.walk(folder, onerror=lambda error: closed.append(str(error.filename))):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(names):
            if name.lower().endswith(suffix) and not name.startswith("."):
                yield os.path.normpath(os.path.join(place, name))  # noqa: PTH118 - names may be no valid Path
    yield from closed


def _key(name: str) -> str:
    """Return what two names of one file have in common."""
    return name if name == STANDARD_INPUT or "\0" in name else os.path.realpath(name)
