"""A log and its ``meta`` made up here: a robot of two axes that turn and one that slides, with every signal."""

from types import SimpleNamespace

import numpy as np

from robolang.logs.log import Log

PLACEMENT = np.eye(4).tolist()
AXES = [
    {
        "name": "J1",
        "kind": "revolute",
        "placement": PLACEMENT,
        "lower": -3.0,
        "upper": 3.0,
        "speed": 2.0,
        "torque": 100.0,
    },
    {
        "name": "J2",
        "kind": "revolute",
        "placement": PLACEMENT,
        "lower": None,
        "upper": None,
        "speed": 2.0,
        "torque": None,
    },
    {
        "name": "J3",
        "kind": "prismatic",
        "placement": PLACEMENT,
        "lower": 0.0,
        "upper": 0.5,
        "speed": 1.0,
        "torque": 300.0,
    },
]


def statement(line, start_s, **fields):
    return {"line": line, "number": None, "text": "MOVE A", "begun": True, "start_s": start_s, "notes": [], **fields}


def event(kind, name, value, time_s):
    return {"kind": kind, "name": name, "value": value, "time_s": time_s}


def happened(code, line, time_s):
    return {"code": code, "line": line, "time_s": time_s, "message": code, "hint": "hint"}


def meta(**changes):
    report = {"ok": True, "statements": [statement(1, 0.0)], "printed": [], "alarms": [], "warnings": []}
    found = {
        "format": 2,
        "program": {"name": "made.rbl", "text": "MOVE A\n"},
        "cell": {"text": "secret = 1\n"},
        "points": {"A": {"p_mm": [0, 0, 0]}},
        "robot": {"name": "made", "axes": AXES, "flange": PLACEMENT, "tool": PLACEMENT},
        "scene": {"bodies": [], "shapes": []},
        "events": [],
        "report": report | changes.pop("report", {}),
        "tick_s": 0.001,
        "cycle_s": 0.008,
    }
    return found | changes


class MadeLog(Log):
    """A log whose signals are arrays that a test gives."""

    def __init__(self, arrays, meta):
        self.arrays = arrays
        ticks = len(arrays["t"])
        rows = SimpleNamespace(
            ticks=ticks,
            cycles=-(-ticks // 8),
            ticks_per_cycle=8,
            tick_us=1000,
            read=lambda name, first, last: self.arrays[f"cycle/{name}"][first:last],
        )
        super().__init__(rows, meta)

    def count(self, name):
        return len(self.arrays[name])

    def span(self, name, first, last):
        return self.arrays[name][first:last]

    def tool_points(self, name, first, last):
        points = {"q_cmd": self.arrays["tool_cmd"], "q_link": self.arrays["X_world_tool"][:, :3, 3]}
        return points[name][first:last]

    def points_at(self, q, ticks):
        return self.arrays["X_world_tool"][ticks, :3, 3] + q - self.arrays["q_link"][ticks]

    def each_cycle(self, name):
        return self.arrays[name][::8]


def log(rows, about=None, **changes):
    """A log of so many ticks; a value is a wave of its own for each column."""
    cycles, frames, t = -(-rows // 8), -(-rows // 16), np.arange(rows) * 0.001

    def wave(columns, size=1.0):
        return size * np.sin(3.0 * t[:, None] + np.arange(columns))

    def held(columns, size=1.0):
        return np.repeat(wave(columns, size)[::8], 8, axis=0)[:rows]

    X = np.tile(np.eye(4), (rows, 1, 1))
    X[:, :3, 3] = wave(3)
    moved = np.diff(X[:, :3, 3], axis=0, prepend=X[:1, :3, 3])
    found = {
        "t": t,
        "q_cmd": wave(3, 0.2) + 0.25,
        "q_fb": wave(3, 0.2) + 0.2501,
        "dq_fb": wave(3),
        "tau_sat": wave(3, 40.0),
        "q_link": wave(3, 0.2) + 0.2502,
        "X_world_tool": X,
        "D": held(3),
        "T": held(3),
        "D_age": held(3, 8.0) + 8.0,
        "payload_mass": np.where(t < 0.05, 0.0, 2.5),
        "wrist_mode": np.zeros(rows, dtype=np.int8),
        "seam_deviation": np.zeros((rows, 6)),
        "tool_cmd": X[:, :3, 3] + [0.0, 1.7e-4 * t[-1] if rows else 0.0, 3e-4],
        "tool_speed": np.linalg.norm(moved, axis=1) / 0.001,
        "cycle/tool": np.zeros(cycles, dtype=np.int32),
        "frame_t": np.arange(frames) * 0.016,
        "parts": np.tile([0.1, 0.2, 0.3, 1.0, 0.0, 0.0, 0.0], (frames, 2)).reshape(frames, 2, 7),
        "fingers": np.linspace(0.01, 0.03, 2 * frames).reshape(frames, 2),
    }
    return MadeLog(found | changes, about or meta())
