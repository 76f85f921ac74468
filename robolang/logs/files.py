"""The log of a run as a file: ``.npz`` for numpy and for ``robolang.read_log``, ``.mcap`` for log viewers.

Both repeat byte for byte: neither carries the time of day, or where the program lies.
"""

from pathlib import Path

from robolang.core.storage import write_atomic
from robolang.logs.log import Log
from robolang.logs.mcap_file import write_mcap
from robolang.logs.npz_file import write_npz

_WRITERS = {".npz": write_npz, ".mcap": write_mcap}
SUFFIXES = tuple(_WRITERS)


def write_log(path: Path, log: Log) -> None:
    """Write a log to ``path`` in the format of its suffix; ``ValueError`` for another one, ``Fault`` RBL706."""
    if path.suffix not in _WRITERS:
        raise ValueError(f"{path} must end in .npz or .mcap")
    write_atomic(path, lambda stream: _WRITERS[path.suffix](stream, log))
