"""Where the arm stood in the log of a run (``.npz``): the commanded joint angles when a line was left, or at a time.

Numbers of a program are what is written before its statements; a program without them has the lines of its file.
"""

from pathlib import Path

import numpy as np

from robolang.logs.files import read_log
from robolang.logs.log import Log
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.rounding import beside

_IN_IT = "Give a line and a time that are in the run."


def joints_at_end_of(path: Path, axes: int, line: int, time_s: float | None = None) -> Array:
    """Return the joint angles (axes,) rad at the end of the last execution of a line, or of the last before a time.

    ``Fault`` RBL600 for a file that cannot be read, RBL619 for one that is no log of an arm with so many axes, or in
    which the line has not been carried out by then.
    """
    log = read_log(path)
    log.require("t", "q_cmd", "line", "number")
    lines, what = (log["number"], "number") if log["number"].any() else (log["line"], "line")
    # 0 stands for no statement
    rows = np.flatnonzero((lines == line) & (lines > 0))
    if time_s is not None:
        rows = rows[log["t"][rows] <= time_s]
    if not len(rows):
        known = ", ".join(map(str, np.unique(lines[lines > 0]).tolist()[:20])) or "none"
        before = "" if time_s is None else f" before {time_s:g} s"
        raise Fault("RBL619", f"{path}: no statement of {what} {line} runs{before}; those that do: {known}", _IN_IT)
    last = int(rows[-1])
    if time_s is not None:
        # the execution that runs at that time is not over: its end comes later
        going = np.flatnonzero(lines[last:] != line)
        last = len(lines) - 1 if not len(going) else last + int(going[0]) - 1
    return _joints(log, axes, last)


def joints_at(path: Path, axes: int, time_s: float) -> Array:
    """Return the joint angles (axes,) rad at a time of a run, s; ``Fault`` as ``joints_at_end_of``."""
    log = read_log(path)
    log.require("t", "q_cmd")
    times = log["t"]
    if not len(times) or not 0.0 <= time_s <= times[-1]:
        end = 0.0 if not len(times) else float(times[-1])
        given, last = beside(time_s, end)
        raise Fault("RBL619", f"{path}: {given} s is not within the run, which ends at {last} s", _IN_IT)
    # the tick that has begun by then; half a microsecond for times that are no binary fractions
    return _joints(log, axes, int(np.searchsorted(times, time_s + 5e-7, side="right")) - 1)


def _joints(log: Log, axes: int, row: int) -> Array:
    """Return the commanded angles (axes,) rad of a servo tick."""
    q: Array = log.span("q_cmd", row, row + 1)[0]
    if q.shape != (axes,):
        raise Fault("RBL619", f"{log.source} is the log of an arm with {q.size} axes, not {axes}")
    if not np.isfinite(q).all():
        raise Fault("RBL619", f"{log.source}: the angles of the arm are not numbers at {log['t'][row]:g} s")
    return q
