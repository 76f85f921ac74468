"""Which panels a plot of a log has: a panel for each unit of what is selected, and the statements that ran."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from robolang.logs.log import Log
from robolang.logs.quantities import Column
from robolang.logs.selection import selected
from robolang.view.signal_plot import Block, Line, SignalPanel, SignalPlot
from runtime.core.faults import Fault
from runtime.core.frames import Array

TOGETHER = "+"
"""What stands between signals that are drawn in one panel."""
MOVED = "Draw the log of a run that moves the arm or takes time."
_ROUNDING_S = 1e-9
"""The tick at 0.1 s may be a bit before it; a window from 0.1 s has it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Window:
    """From when to when a plot goes, s; None: from the start, to the end of the run."""

    first: float | None = None
    last: float | None = None


def plot_of(log: Log, selections: Sequence[str], window: Window) -> SignalPlot:
    """Return the plot of selected signals; ``Fault`` RBL838 for a signal that is not there and RBL832 for a run
    without two rows, ``ValueError`` for a window without them."""
    chosen = [[_columns(log, name) for name in text.split(TOGETHER)] for text in selections]
    times = log["t"]
    rows = rows_of(times, window)
    # one row has no extent in time, and the scale would divide by it
    if len(times) < 2:
        raise Fault("RBL832", f"{log.source} is of a run without motion: there is nothing to draw", MOVED)
    if len(rows) < 2:
        raise ValueError("there is nothing between these times")
    first, last = float(times[rows[0]]), float(times[rows[-1]])
    panels = [panel for group in chosen for panel in _panels(log, [each for part in group for each in part], window)]
    return SignalPlot(
        title=title_of(log),
        panels=tuple(panels),
        blocks=tuple(blocks_of(log, rows, times[rows.start : rows.stop])),
        strip="number" if numbered(log) else "line",
        first=first,
        last=last,
    )


def title_of(log: Log) -> str:
    """Return the program and the robot of a log, or its file."""
    if log.meta is None:
        return log.source
    return f"{log.meta['program'].get('name')}, {log.meta['robot'].get('name')}"


def _columns(log: Log, text: str) -> tuple[Column, ...]:
    found = selected(log, log, text)
    # of a pose what has a length: the directions beside it would have another scale
    lengths = tuple(each for each in found if each.unit != "-")
    return lengths or found


def rows_of(times: Array, window: Window) -> range:
    """Return the rows within a window, of times that rise."""
    first = 0 if window.first is None else int(np.searchsorted(times, window.first - _ROUNDING_S, "left"))
    last = len(times) if window.last is None else int(np.searchsorted(times, window.last + _ROUNDING_S, "right"))
    return range(first, last)


def _panels(log: Log, columns: Sequence[Column], window: Window) -> Iterator[SignalPanel]:
    # a panel has one scale
    by_unit: dict[str, list[Column]] = {}
    for column in columns:
        by_unit.setdefault(column.shown[0], []).append(column)
    for unit, each in by_unit.items():
        names = list(dict.fromkeys(column.signal for column in each))
        lines = tuple(_line(log, column, window, names) for column in each)
        label = " ".join(names)
        yield SignalPanel(label=f"{label}, {unit}" if unit not in ("", "-") else label, lines=lines)


def _line(log: Log, column: Column, window: Window, names: Sequence[str]) -> Line:
    """Return a column as a curve of a panel with the signals of these ``names``."""
    times = log["frame_t" if log.base(column.signal) == "frame" else "t"]
    rows = rows_of(times, window)
    values = log.span(column.signal, rows.start, rows.stop).reshape(len(rows), -1)[:, column.index]
    # a run that went wrong may hold any number
    with np.errstate(over="ignore"):
        y = values * column.shown[1]
    label = f"J{column.label}" if column.label.isdecimal() else column.label
    name = label if names == [column.signal] and label else f"{column.signal} {label}".strip()
    return Line(name=name, x=times[rows.start : rows.stop], y=y, dashed=column.signal != names[0])


def numbered(log: Log) -> bool:
    """Return whether the statements of a run have numbers, by which people then know them."""
    return "number" in log and bool(log["number"].any())


def blocks_of(log: Log, rows: range, at: Array) -> Iterator[Block]:
    """Yield the statements that run, in order, by the places (N,) of their rows; none for a log without lines."""
    if "line" not in log:
        return
    lines = log.span("line", rows.start, rows.stop)
    numbers = log.span("number", rows.start, rows.stop) if "number" in log else np.zeros_like(lines)
    texts = [] if log.meta is None else str(log.meta["program"].get("text", "")).splitlines()
    edges = [0, *(np.flatnonzero(np.diff(lines)) + 1).tolist(), len(lines)]
    for begin, end in pairwise(edges):
        line, number = int(lines[begin]), int(numbers[begin])
        if line:
            yield Block(
                begins=float(at[begin]),
                # the last one ends with the window
                ends=float(at[min(end, len(rows) - 1)]),
                number=str(number or line),
                text=texts[line - 1].strip() if 0 < line <= len(texts) else "",
            )
