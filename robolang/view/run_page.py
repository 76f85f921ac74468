"""What a page holds of a run: its signals, thinned where they are long, its charts, notes and joints, packed.

A log gives one row a servo tick for every signal; what changes once a cycle is kept once a cycle.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from robolang.view import charts, joints, notes
from robolang.view.packing import Signal, pack
from robolang.view.thinning import bin_rows, evenly, paired, thinned
from runtime.core.faults import Fault
from runtime.core.frames import Array

_TICK = ("q_cmd", "q_fb", "dq_fb", "tau_sat", "tool_error", "tool_speed")
_CYCLE = ("D", "T", "D_age", "payload_mass", "wrist_mode", "seam_deviation")
_LEFT_OUT = ("cell", "points")
"""Of the log's ``meta``: what no part of the page shows; the points are in the scene."""


def pack_run(log: Mapping[str, Array], meta: Mapping[str, Any], label: str) -> bytes:
    """Return a run as a page holds it: ``log`` by names of docs/signals.md, ``meta`` as the log has it."""
    robot, tick_s, cycle_s = meta["robot"], float(meta["tick_s"]), float(meta["cycle_s"])
    levels = _levels(meta["events"], len(log["t"]), tick_s, cycle_s)
    signals = {signal.name: signal for signal in (*_signals(log, robot, tick_s, cycle_s), *levels[1])}
    shown = charts.Shown(robot=robot, signals=signals, levels=levels[0])
    header = {
        "kind": "run",
        "label": label,
        "duration_s": len(log["t"]) * tick_s,
        "tick_s": tick_s,
        "cycle_s": cycle_s,
        "thinned": thinned(len(log["t"]), tick_s),
        "meta": {key: value for key, value in meta.items() if key not in _LEFT_OUT},
        "charts": [asdict(chart) for chart in charts.of_run(shown)],
        "notes": [asdict(note) for note in notes.of_report(meta["report"])],
        "joints": [asdict(joint) for joint in joints.ranges(robot["axes"], log["q_link"], tick_s)],
    }
    return pack(header, list(signals.values()))


def check_comparable(robots: Sequence[Mapping[str, Any]]) -> None:
    """Raise ``Fault`` RBL826 when runs are not of one robot: ``meta["robot"]`` of each."""
    shapes = [(robot["name"], [(axis["name"], axis["kind"]) for axis in robot["axes"]]) for robot in robots]
    for name, axes in shapes[1:]:
        if (name, axes) != shapes[0]:
            first, count = shapes[0][0], len(shapes[0][1])
            message = f"the first run is of {first} with {count} axes, the other of {name} with {len(axes)}"
            raise Fault("RBL826", message, "Write a page for each of them.")


def _signals(log: Mapping[str, Array], robot: Mapping[str, Any], tick_s: float, cycle_s: float) -> Iterator[Signal]:
    every = round(cycle_s / tick_s)
    for name in _TICK:
        yield paired(_tick(name, log[name], tick_s))
    link = _tick("q_link", log["q_link"], tick_s)
    if bin_rows(len(link.values)) > 1:
        # the difference of two thinned signals says nothing: their values are of different times
        yield paired(_tick("joint_error", log["q_cmd"] - log["q_link"], tick_s))
    yield evenly(link)
    limits = [np.nan if axis["torque"] is None else axis["torque"] for axis in robot["axes"]]
    yield Signal(name="torque_limit", base="tick", dt=len(log["t"]) * tick_s, values=np.array([limits, limits]))
    # one row of each cycle says all: the log repeats it in every tick
    for name in _CYCLE:
        yield paired(Signal(name=name, base="cycle", dt=cycle_s, values=_columns(log[name][::every])))
    for name, values in (("tool", log["X_world_tool"][::every, :3, 3]), ("tool_cmd", log["tool_cmd"][::every])):
        yield evenly(Signal(name=name, base="cycle", dt=cycle_s, values=values))
    yield from _frames(log)


def _frames(log: Mapping[str, Array]) -> Iterator[Signal]:
    times = log["frame_t"]
    if len(times):
        dt = float(times[1] - times[0]) if len(times) > 1 else 1.0
        for name in ("parts", "fingers"):
            yield evenly(Signal(name=name, base="frame", dt=dt, t0=float(times[0]), values=_columns(log[name])))


def _tick(name: str, values: Array, tick_s: float) -> Signal:
    return Signal(name=name, base="tick", dt=tick_s, values=_columns(values))


def _columns(values: Array) -> Array:
    return values.reshape(len(values), int(np.prod(values.shape[1:], dtype=int)))


def _levels(events: Any, ticks: int, tick_s: float, cycle_s: float) -> tuple[list[str], list[Signal]]:
    """Return names and levels of the inputs and outputs that change in a run, from the events of its log."""
    words = {"input": "IN", "output": "OUT"}
    found = [(f"{words[item['kind']]} {item['name']}", item) for item in events if item["kind"] in words]
    names = sorted({name for name, _ in found})
    if not names:
        return [], []
    rows = max(1, -(-ticks // round(cycle_s / tick_s)))
    values = np.zeros((rows, len(names)))
    for name, item in found:
        values[round(item["time_s"] / cycle_s) :, names.index(name)] = float(item["value"])
    return names, [paired(Signal(name="levels", base="cycle", dt=cycle_s, values=values))]
