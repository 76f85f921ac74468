"""Plots of exported pulse tables as they are played: the frequency of every channel, and the path error.

Both lie over the time of the whole program, markers included, with a mark where each move starts. They hold what
``runtime.pulses.replay`` found, not what was requested. A curve of very many points is thinned so that no peak is lost.
"""

from itertools import chain
from pathlib import Path

import numpy as np

from robolang.core.diagnostics import safe
from robolang.core.storage import write_atomic
from robolang.execution.plot import COLOURS, LEFT, RIGHT, WIDTH, Curve, Labels, Mark, as_html, as_svg, stacked
from runtime.core.frames import Array
from runtime.core.units import badness
from runtime.pulses.exported import Export, Move
from runtime.pulses.replay import MoveReplay

_BUCKETS = 195
"""Parts of the time axis of which four points are drawn; a curve keeps four times that whole."""
_KHZ_FROM = 10_000.0
_MICRO_BELOW = 0.1
"""Frequencies are drawn in kHz from so many Hz on, errors in µm below so many mm: the axis has room for few digits."""
_LETTER = 7.0
_LONGEST_NAME = 32


def write_plot(path: Path, export: Export, replays: list[MoveReplay]) -> None:
    """Draw frequencies and path error over the time of the program; ``Fault`` RBL706."""
    program = safe(export.program)
    program = program if len(program) <= _LONGEST_NAME else f"{program[: _LONGEST_NAME - 1]}…"
    svgs = _svgs(program, export, replays)
    text = as_html(f"{program}: pulse tables", "".join(svgs)) if path.suffix == ".html" else stacked(svgs)
    write_atomic(path, lambda stream: stream.write(text.encode("utf-8")))


def _svgs(program: str, export: Export, replays: list[MoveReplay]) -> list[str]:
    """Return the plot of all frequencies and that of the path error, both over the time of the whole program."""
    starts = _starts(export)
    marks = _marks(export, starts, [item.move for item in replays])
    highest = max((item.fastest[0] for item in replays), default=0.0)
    hz, per_hz = ("kHz", 1e-3) if highest >= _KHZ_FROM else ("Hz", 1.0)
    curves = []
    for k, channel in enumerate(export.channels):
        parts = [_held(start, item.frequency[:, k], export.step_s) for start, item in zip(starts, replays, strict=True)]
        # at 0 Hz from the start of the program to its end, markers before and after the moves included
        rest = np.zeros(1)
        x, y = _thinned(*_joined([(rest, rest), *parts, (rest + export.seconds, rest)]))
        # dashed where the colours begin again, so that no two channels look alike
        curves.append(Curve(name=channel.name, x=x, y=y * per_hz, dashed=k >= len(COLOURS)))
    # NaN is worse than every number
    worst = max((item.worst_mm for item in replays), key=badness, default=0.0)
    mm, per_mm = ("µm", 1e3) if worst < _MICRO_BELOW else ("mm", 1.0)
    x, y = _thinned(*_errors(export, starts, replays))
    error = Curve(name="tool point", x=x, y=y * per_mm)
    return [
        as_svg(
            Labels(
                title=f"{program}: frequency of each channel, below 0 when counting down",
                x="time, s",
                y=f"frequency, {hz}",
            ),
            curves,
            level=0.0,
            corner="above",
            marks=marks,
        ),
        as_svg(
            Labels(
                title=f"{program}: distance of the tool point from its straight lines",
                x="time, s",
                y=f"path error, {mm}",
            ),
            [error],
            corner="above",
            marks=marks,
        ),
    ]


def _errors(export: Export, starts: list[float], replays: list[MoveReplay]) -> tuple[Array, Array]:
    """Return times and path errors of all moves, mm; the tool point stays where it is between the moves."""
    parts = [(start + item.times, item.error_mm) for start, item in zip(starts, replays, strict=True)]
    held = [
        (np.array([until]), errors[-1:])
        # not strict: of an export without a move only the end is left
        for until, (_, errors) in zip([*starts[1:], export.seconds], parts, strict=False)
    ]
    first = [(np.zeros(1), errors[:1]) for _, errors in parts[:1]]
    return _joined([*first, *chain.from_iterable(zip(parts, held, strict=True))])


def _starts(export: Export) -> list[float]:
    """Return the time at which each move starts, s."""
    now, starts = 0.0, []
    for item in export.sequence:
        if isinstance(item, Move):
            starts.append(now)
            now += item.steps * export.step_s
        else:
            now += item.dwell_s
    return starts


def _held(start: float, values: Array, step_s: float) -> tuple[Array, Array]:
    """Return the corners of a curve that holds each value (S,) for a step, from zero and back to zero."""
    edges = start + np.arange(len(values) + 1) * step_s
    return np.repeat(edges, 2), np.concatenate([[0.0], np.repeat(values, 2), [0.0]])


def _joined(parts: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    if not parts:
        return np.zeros(0), np.zeros(0)
    return np.concatenate([x for x, _ in parts]), np.concatenate([y for _, y in parts])


def _thinned(x: Array, y: Array) -> tuple[Array, Array]:
    """Return first, smallest, largest and last point of every part of the time axis, in order: no peak is lost."""
    if len(x) <= 4 * _BUCKETS:
        return x, y
    share = (x - x[0]) / max(float(x[-1] - x[0]), 1e-9)
    # the last point has share 1 and belongs to the last part
    bucket = np.minimum(share * _BUCKETS, _BUCKETS - 1).astype(np.int64)
    kept: set[int] = set()
    for part in np.split(np.arange(len(x)), np.flatnonzero(np.diff(bucket)) + 1):
        kept |= {int(part[k]) for k in (0, np.argmin(y[part]), np.argmax(y[part]), -1)}
    at = sorted(kept)
    return x[at], y[at]


def _marks(export: Export, starts: list[float], moves: list[Move]) -> list[Mark]:
    """Return a mark where each move starts, with its line in the file where there is room before the next one."""
    # an export without a move or a dwell lasts 0 s
    per_second = (WIDTH - LEFT - RIGHT) / max(export.seconds, 1e-9)
    marks, free = [], 0.0
    for start, move in zip(starts, moves, strict=True):
        name = str(move.line)
        x = start * per_second
        fits = x >= free
        free = x + _LETTER * (len(name) + 1) if fits else free
        marks.append(Mark(name=name if fits else "", x=start))
    return marks
