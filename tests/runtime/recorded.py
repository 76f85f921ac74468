"""What is recorded of a run, as bytes.

All signals follow from these rows (``runtime/control/signals.py``): runs with the same rows have the same log, and to
compare rows computes no pose of the tool.
"""

from runtime.control.recorder import Recorder


def rows_of(recorder: Recorder) -> dict[str, bytes]:
    """Return the bytes of all recorded rows by name, and of the tools that they were recorded with."""
    recorded = recorder.recorded()
    counts = {
        "ticks": recorded.ticks,
        "commands": recorded.ticks,
        "cycles": recorded.cycles,
        "frames": recorded.frames,
    }
    columns = recorded.layout.columns.items()
    rows = {name: recorded.read(name, 0, counts[column.array]).tobytes() for name, column in columns}
    return rows | {"tools": b"".join(X.tobytes() for X in recorded.tools)}
