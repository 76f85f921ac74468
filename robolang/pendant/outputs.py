"""Files that the prompt writes beside what it edits: never over the program that is open, its points or its cell."""

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from runtime.core.faults import Fault

if TYPE_CHECKING:
    from robolang.teaching.documents import Documents


def refuse_open(files: Iterable[Path], documents: "Documents") -> None:
    """Raise ``Fault`` RBL706 for a file that is one of the documents that are open."""
    # the same file may have two names, by a link or by ./
    files = tuple(files)
    if any("\0" in str(path) or not str(path).isprintable() for path in files):
        raise Fault("RBL706", "the name of the file has characters that no name has", "Give another name.")
    taken = {os.path.realpath(path) for path in documents.texts}
    for path in files:
        if os.path.realpath(path) in taken:
            raise Fault("RBL706", f"{path} is open at the prompt", "Give another name.")
