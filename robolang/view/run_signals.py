"""The signals of a page from a log, read piece by piece: a run of half an hour needs little more memory than its page.

What changes once a cycle is kept once a cycle: a log repeats it in every tick.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from robolang.logs.log import Log
from robolang.view.packing import Signal
from robolang.view.thinning import bin_rows, even_step, evenly, paired, pairs
from runtime.control.signals import Signals
from runtime.core.frames import Array

PIECE = 65_536
"""Rows that are read at once."""
_TICK = ("q_cmd", "q_fb", "dq_fb", "tau_sat")
_CYCLE = ("D", "T", "payload_mass", "wrist_mode", "seam_deviation")
_ANGLE, _POINT = 2e-7, 1e-7
_FINEST = {
    **dict.fromkeys(("q_cmd", "q_fb", "q_link", "joint_error"), _ANGLE),
    **dict.fromkeys(("tool", "tool_cmd", "parts", "fingers", "seam_deviation"), _POINT),
    "tool_error": 1e-8,
    "tool_speed": 1e-6,
    "dq_fb": 1e-5,
    "tau_sat": 1e-3,
    "D": 1e-6,
    "T": 1e-4,
    "D_age": 1e-3,
    "payload_mass": 1e-6,
    "wrist_mode": 0.0,
}
"""The least step in which a signal is kept, in its unit: far below what anybody reads. Of finer ones, most bytes of a
page would be noise."""


def signals_of(log: Log, robot: dict[str, Any]) -> Iterator[Signal]:
    """Yield the signals of a page; ``robot`` is that of the ``meta`` of the log."""
    rows, tick_s = log.count("t"), log.rows.tick_us * 1e-6
    every = log.rows.ticks_per_cycle
    for name in _TICK:
        yield _every_tick(name, partial(log.span, name), rows, tick_s)
    if bin_rows(rows) > 1:
        # the difference of two thinned signals says nothing: their values are of different times
        yield _every_tick(
            "joint_error", lambda *span: log.span("q_cmd", *span) - log.span("q_link", *span), rows, tick_s
        )
    step = even_step(rows)
    yield _signal("q_link", "tick", tick_s * step, _sampled(log, "q_link", step))
    yield from _of_tool(log, rows, tick_s)
    limits = [np.nan if axis["torque"] is None else axis["torque"] for axis in robot["axes"]]
    yield Signal(name="torque_limit", base="tick", dt=rows * tick_s, values=np.array([limits, limits]))
    # one row of each cycle says all: the log repeats it in every tick
    for name in _CYCLE:
        yield paired(_signal(name, "cycle", tick_s * every, log.each_cycle(name)))
    yield paired(_signal("D_age", "cycle", tick_s * every, _sampled(log, "D_age", every)))
    yield from _frames(log)


def in_pieces(log: Log, name: str) -> Iterator[Array]:
    """Yield a signal piece by piece."""
    return (log.span(name, *span) for span in _pieces(log.count(name)))


def drawn_off(made: Signals) -> float:
    """Return how far, m, the tool point of the drawn robot is from the true one, half between two postures of a page.

    There it is farthest: a turn between two postures goes along its chord.
    """
    rows, most = made.count("t"), 0.0
    step = even_step(rows)
    for first, last in _pieces(rows, step) if step > 1 else ():
        q = made.span("q_link", first, min(last + 1, rows))
        kept, half = q[::step], step // 2
        between = kept[:-1] + half / step * np.diff(kept, axis=0)
        at = first + half + step * np.arange(len(between))
        off = made.points_at(between, at) - made.points_at(q[half::step][: len(between)], at)
        most = float(np.fmax.reduce(_lengths(off), initial=most))
    return most


def _every_tick(name: str, read: Callable[[int, int], Array], rows: int, tick_s: float) -> Signal:
    size = bin_rows(rows)
    values = np.concatenate([pairs(read(*span), size) for span in _pieces(rows, size)])
    base, dt = ("tick", tick_s) if size == 1 else ("pairs", tick_s * size / 2)
    return _signal(name, base, dt, values)


def _signal(name: str, base: str, dt: float, values: Array) -> Signal:
    return Signal(name=name, base=base, dt=dt, values=_columns(values), finest=_FINEST[name])


def _pieces(rows: int, size: int = 1) -> Iterator[tuple[int, int]]:
    """Yield spans of so many rows, each of whole bins; at least one, which gives an empty signal its columns."""
    step = size * -(-PIECE // size)
    for first in range(0, max(rows, 1), step):
        yield first, min(first + step, rows)


def _sampled(log: Log, name: str, step: int) -> Array:
    """Return every so many rows of a signal, the first among them."""
    return np.concatenate([log.span(name, *span)[::step] for span in _pieces(log.count(name), step)])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _ToolPoint:
    """The tool point in ticks: ``command`` and ``true`` (N, 3) m, its ``speed`` (N,) m/s."""

    command: Array
    true: Array
    speed: Array

    @property
    def error(self) -> Array:
        """Distance of the true point from the commanded one (N,), m."""
        return _lengths(self.true - self.command)


def _of_tool(log: Log, rows: int, tick_s: float) -> Iterator[Signal]:
    size, every = bin_rows(rows), log.rows.ticks_per_cycle
    found: dict[str, list[Array]] = {"tool_error": [], "tool_speed": [], "tool": [], "tool_cmd": []}
    for span in _pieces(rows, size * every):
        point = _tool_point(log, *span)
        for name, values in (("tool_error", point.error), ("tool_speed", point.speed)):
            found[name].append(pairs(values[:, None], size))
        for name, values in (("tool", point.true), ("tool_cmd", point.command)):
            found[name].append(values[::every])
    base, dt = ("tick", tick_s) if size == 1 else ("pairs", tick_s * size / 2)
    for name in ("tool_error", "tool_speed"):
        yield _signal(name, base, dt, np.concatenate(found[name]))
    for name in ("tool", "tool_cmd"):
        yield evenly(_signal(name, "cycle", tick_s * every, np.concatenate(found[name])))


def _tool_point(log: Log, first: int, last: int) -> _ToolPoint:
    """Return the tool point of ticks ``first`` to before ``last``.

    As the log computes it, but once for all of it: these points are what a page costs most.
    """
    from_ = max(first - 1, 0)
    true = log.tool_points("q_link", from_, last)
    before = true[:-1] if first else np.concatenate([true[:1], true[:-1]])
    true = true[first - from_ :]
    speed = _lengths(true - before) / (log.rows.tick_us * 1e-6)
    # where TOOL has changed the point, the difference is no motion
    for tick in _new_tools(log):
        if first <= tick < last:
            speed[tick - first] = log.span("tool_speed", tick, tick + 1)[0]
    return _ToolPoint(command=log.tool_points("q_cmd", first, last), true=true, speed=speed)


def _new_tools(log: Log) -> list[int]:
    tools = log.rows.read("tool", 0, log.rows.cycles)
    return [(int(at) + 1) * log.rows.ticks_per_cycle for at in np.flatnonzero(np.diff(tools))]


def _frames(log: Log) -> Iterator[Signal]:
    times = log["frame_t"]
    if len(times):
        dt = float(times[1] - times[0]) if len(times) > 1 else 1.0
        for name in ("parts", "fingers"):
            yield evenly(replace(_signal(name, "frame", dt, log[name]), t0=float(times[0])))


def _lengths(vectors: Array) -> Array:
    return np.asarray(np.sqrt((vectors * vectors).sum(axis=1)))


def _columns(values: Array) -> Array:
    return values.reshape(len(values), int(np.prod(values.shape[1:], dtype=int)))
