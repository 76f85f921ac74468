"""The log of a run as a file: ``.npz`` for numpy and for ``robolang.read_log``, ``.mcap`` for log viewers.

Both repeat byte for byte: neither carries the time of day, or where the program lies.
"""

from pathlib import Path

from robolang.core.calls import checked
from robolang.core.storage import write_atomic
from robolang.logs.log import Log
from robolang.logs.mcap_file import write_mcap
from robolang.logs.mcap_reading import read_mcap
from robolang.logs.npz_file import read_npz, write_npz
from runtime.core.faults import Fault

_WRITERS = {".npz": write_npz, ".mcap": write_mcap}
SUFFIXES = tuple(_WRITERS)


def write_log(path: Path, log: Log) -> None:
    """Write a log to ``path`` in the format of its suffix; ``ValueError`` for another one, ``Fault`` RBL706."""
    if path.suffix not in _WRITERS:
        raise ValueError(f"{path} must end in .npz or .mcap")
    write_atomic(path, lambda stream: _WRITERS[path.suffix](stream, log))


@checked
def read_log(path: Path | str) -> Log:
    """Return the log in a file of ``robolang run --log``; its signals are read when they are used.

    ``Fault`` RBL600 for a file that cannot be read, RBL619 for one that is no log or is damaged, which may show only
    when a signal is read, and RBL821 for one of a later version.
    """
    path = Path(path)
    if path.suffix == ".rbl":
        hint = f"Run it first: robolang run {path} --log FILE.npz, and give FILE.npz."
        raise Fault("RBL619", f"{path} is a program, not the log of a run", hint)
    return read_mcap(path) if path.suffix == ".mcap" else read_npz(path)
