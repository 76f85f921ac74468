"""The speed of the tool along its path as a plot of a log: what is programmed as steps, what is commanded as a curve.

The place is the length of path that the commanded tool point (``tool_cmd``) has passed, so a corner is where it is in
the work piece, and a wait has no length. A tool that is exchanged moves its point, not the arm: that is no path. Of the
many rows in a column of the picture the least and the largest are drawn.
"""

import numpy as np

from robolang.logs.log import Log
from robolang.view.log_plot import MOVED, Window, blocks_of, numbered, rows_of, title_of
from robolang.view.programmed import programmed_speeds
from robolang.view.signal_plot import COLUMNS, Line, SignalPanel, SignalPlot
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.units import MM

_LEAST = 1e-6
"""A path that is shorter, m, is none."""
_FARTHEST = 10.0
"""No arm moves its tool point by more m for a rad of a joint; where the tool is exchanged it does."""


def path_plot(log: Log, window: Window) -> SignalPlot:
    """Return the plot of the tool's speed along its path; ``Fault`` RBL832 for a run that moves no tool.

    ``ValueError`` for a window without two rows.
    """
    times = log["t"]
    rows = rows_of(times, window)
    if len(times) > 1 and len(rows) < 2:
        raise ValueError("there is nothing between these times")
    passed, speed = _motion(log, rows)
    if not len(passed) or not passed[-1] > _LEAST:
        raise Fault("RBL832", f"{log.source} is of a run without motion: there is nothing to draw", MOVED)
    x = passed / MM
    lines = [_curve("commanded", x, speed / MM), *_programmed(log, times[rows.start : rows.stop], x)]
    return SignalPlot(
        title=title_of(log),
        panels=(SignalPanel(label="speed of the tool, mm/s", lines=tuple(lines)),),
        blocks=tuple(blocks_of(log, rows, x)),
        strip="number" if numbered(log) else "line",
        first=0.0,
        last=float(x[-1]),
        axis="path of the tool, mm",
    )


def _motion(log: Log, rows: range) -> tuple[Array, Array]:
    """Return the length passed (N,), m, and the speed (N,), m/s, of the commanded tool point at each row."""
    if len(rows) < 2:
        return np.zeros(0), np.zeros(0)
    times = log["t"][rows.start : rows.stop]
    steps = np.linalg.norm(np.diff(log.span("tool_cmd", rows.start, rows.stop), axis=0), axis=1)
    turned = np.abs(np.diff(log.span("q_cmd", rows.start, rows.stop), axis=0)).sum(axis=1)
    steps[steps > _FARTHEST * turned] = 0.0
    speed = steps / np.diff(times)
    return np.concatenate([[0.0], np.cumsum(steps)]), np.append(speed, speed[-1])


def _curve(name: str, x: Array, y: Array) -> Line:
    """Return a curve over rising x (N,) with the least and the largest y (N,) of each column of the picture."""
    edges = np.linspace(x[0], x[-1], COLUMNS + 1)
    column = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, COLUMNS - 1)
    # columns without a row of their own, at a high speed on a short path, have the value between their neighbours
    between = np.interp(0.5 * (edges[:-1] + edges[1:]), x, y)
    firsts = np.flatnonzero(np.diff(column, prepend=-1))
    least, largest = between.copy(), between.copy()
    least[column[firsts]], largest[column[firsts]] = np.minimum.reduceat(y, firsts), np.maximum.reduceat(y, firsts)
    # where the speed falls the largest comes first
    lasts = np.append(firsts[1:], len(y)) - 1
    falls = np.zeros(COLUMNS, dtype=bool)
    falls[column[firsts]] = y[firsts] > y[lasts]
    pair = np.where(falls[:, None], np.stack([largest, least], axis=1), np.stack([least, largest], axis=1))
    return Line(name=name, x=np.linspace(x[0], x[-1], 2 * COLUMNS), y=pair.ravel())


def _programmed(log: Log, times: Array, x: Array) -> list[Line]:
    """Return the programmed speed as steps, without a value where none is programmed; none for a log without it."""
    speeds = programmed_speeds(() if log.meta is None else log.meta["report"].get("statements", ()), times) / MM
    if not np.isfinite(speeds).any():
        return []
    places = np.linspace(x[0], x[-1], 2 * COLUMNS)
    # the statement that runs at a place: steps stay steps
    rows = np.clip(np.searchsorted(x, places, side="right") - 1, 0, len(x) - 1)
    return [Line(name="programmed", x=places, y=speeds[rows], dashed=True)]
