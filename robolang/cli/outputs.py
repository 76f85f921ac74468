"""Files that a command writes: never over one that it reads, over each other or where nothing can be written.

Imports nothing heavy: ``check`` stays light.
"""

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from robolang.cli.usage import OptionValueError


def check_outputs(outputs: Mapping[str, Path | None], inputs: Iterable[Path | str | None]) -> None:
    """Refuse outputs, by option, before the work that takes the time; None: not given.

    ``OptionValueError`` for one that is an input or another output, ``Fault`` RBL706 for one that cannot be written.
    """
    from robolang.core.storage import check_writable

    # by where links lead: a link may have any name, and what it leads to would be replaced
    taken = {os.path.realpath(path) for path in inputs if path is not None}
    given = {option: path for option, path in outputs.items() if path is not None}
    for option, path in given.items():
        if os.path.realpath(path) in taken:
            raise OptionValueError(option, f"'{path}' is what this command reads, or another of its outputs")
        taken.add(os.path.realpath(path))
    for path in given.values():
        check_writable(path)


def output_beside(read: Path | str, suffix: str) -> Path:
    """Return the name of an output that is not given: beside what is read, with its name; ``OptionValueError``."""
    path = Path(read)
    # '.', '/' and an empty name have no last part that an ending could follow
    if not path.name:
        raise OptionValueError("--out", f"'{path}' is a folder without a name of its own; name a file, or give --out")
    return path.with_name(f"{path.stem}{suffix}")
