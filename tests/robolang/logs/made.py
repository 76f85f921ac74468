"""Logs that no run has made: every signal, with the numbers that are hard to keep; and logs of layout 1."""

from pathlib import Path

import numpy as np

from robolang.logs.log import Log
from runtime.control.recorder import Recorder
from runtime.core.frames import Array
from runtime.robot.files.loader import load_builtin

NAN = float("nan")
ODD = np.array([0.0, -0.0, 1e-320, 1e308, np.inf, -np.inf, NAN, 1 / 3])
PLAIN = np.array([0.0, 0.5, -0.25, 1.0, -1.5])
OLD = ("t", "q_cmd", "line", "number")


def meta(n: int = 6) -> dict:
    """What a reader of a log needs of its ``meta``."""
    spec = load_builtin("puma560")
    axes = [{"name": axis.name, "placement": axis.placement.tolist()} for axis in spec.axes[:n]]
    robot = {"name": spec.name, "axes": axes, "flange": np.eye(4).tolist(), "tool": np.eye(4).tolist()}
    events = [{"time_s": 0.004, "kind": "output", "name": "3", "value": 1.0}]
    return {
        "format": 2,
        "program": {"name": "p.rbl", "text": "10 MOVE P1 ' \x00\u2028\udc80\n"},
        "cell": {"text": None},
        "points": {},
        "robot": robot,
        "scene": None,
        "events": events,
        "report": {"statements": []},
        "tick_s": 0.001,
        "cycle_s": 0.008,
    }


def recorder(ticks: int, numbers: Array = ODD, parts: int = 2) -> Recorder:
    """A recorder after so many ticks of an arm that moves from number to number."""
    made = Recorder(6, 8, 1000, parts)
    tool = np.eye(4)
    made.begin(np.resize(numbers, 6), tool)

    def row(size: int) -> Array:
        return np.resize(np.roll(numbers, made.tick + made.cycle), size)

    for tick in range(ticks):
        if tick % 8 == 0:
            tool = np.array(tool)
            tool[2, 3] = 0.1 * (made.cycle % 3)
            made.use_tool(tool)
            scalars = (float(row(1)[0]), made.cycle % 4, 10 * (made.cycle % 4), made.cycle % 3)
            vectors = tuple(row(size) for size in (6, 6, 6, 6, 6))
            made.begin_cycle(vectors, row(144).reshape(3, 8, 6), scalars, lambda: row(7 * parts + 2).clip(-1e30, 1e30))
        made.record(tuple(row(6) for _ in range(5)))
    return made


def log(ticks: int, numbers: Array = ODD) -> Log:
    """A log of so many ticks."""
    return Log(recorder(ticks, numbers).recorded(), meta())


def old(path: Path, **signals: Array) -> Path:
    """Write a log of layout 1 that has these signals."""
    np.savez(path, **signals)
    return path
