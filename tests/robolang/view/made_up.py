"""A made-up run in the data of a page: a small arm, one part, a program with a loop. No controller, no physics."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from robolang.view.packing import Signal, pack
from robolang.view.page import Bundle, write_page

TICK_S = 0.001
CYCLE_S = 0.008
FRAME_S = 0.016
FEW = ("LOAD (0, 0, 60), 0.8", "HAND OFF", "MOVE P1", "MOVE P2", "HAND ON", "MOVE P1")
PROGRAM = "\n".join(
    ["' To and fro, three times", *(f"{10 * k} {text}" for k, text in enumerate(FEW, 1)), "", "' the end", ""]
)

Columns = dict[str, NDArray[np.float64]]


def pose(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> list[list[float]]:
    return [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]


def tilted(x: float, y: float, z: float) -> list[list[float]]:
    """A frame whose z is the world's y: the axis of a shoulder."""
    return [[1, 0, 0, x], [0, 0, 1, y], [0, -1, 0, z], [0, 0, 0, 1]]


def scene(part: str) -> dict:
    """Two turning links and a hand on a column, a table and a part."""
    turns = {"kind": "revolute", "axis": [0, 0, 1], "source": "axis"}
    slides = {"kind": "prismatic", "axis": [0, 1, 0], "source": "finger"}
    bodies = [
        ("link1", None, pose(0, 0, 0), {**turns, "index": 0}),
        ("link2", "link1", tilted(0, 0, 0.5), {**turns, "index": 1}),
        ("link3", "link2", pose(0.45), {**turns, "index": 2}),
        ("flange", "link3", pose(0.4), None),
        ("tool", "flange", pose(0.1), None),
        ("finger_left", "tool", pose(), {**slides, "index": 0}),
        ("finger_right", "tool", pose(), {**slides, "axis": [0, -1, 0], "index": 1}),
        (
            f"part:{part}",
            None,
            pose(0.6, 0, 0.3),
            {"kind": "prismatic", "axis": [0, 0, 1], "source": "part", "index": 0},
        ),
    ]
    lie = [[0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]]
    shapes = [
        ("link1", "cylinder", pose(0, 0, 0.22), [0.13, 0.1, 0.44], "cover", "column"),
        ("link1", "sphere", pose(0, 0, 0.5), [0.1], "body", "shoulder"),
        ("link2", "limb", lie, [0.08, 0.06, 0.45], "body", "upper arm"),
        ("link3", "limb", lie, [0.06, 0.045, 0.4], "body", "forearm"),
        ("link3", "cylinder", pose(), [0.05, 0.05, 0.16], "cover", "elbow"),
        ("flange", "box", pose(0.02), [0.04, 0.12, 0.05], "palm", "palm"),
        ("finger_left", "box", pose(-0.02, 0.01, 0), [0.08, 0.01, 0.02], "rubber", "left finger"),
        ("finger_right", "box", pose(-0.02, -0.01, 0), [0.08, 0.01, 0.02], "rubber", "right finger"),
        (None, "box", pose(0.6, 0, 0.23), [0.6, 0.9, 0.04], "table", "table"),
        (f"part:{part}", "box", pose(), [0.06, 0.06, 0.1], "part", part),
    ]
    colours = {
        "body": "#f2efe6",
        "cover": "#3b4148",
        "palm": "#4a5058",
        "rubber": "#22252a",
        "table": "#c9a777",
        "part": "#1f9e89",
        "edge": "#0b5d50",
    }
    return {
        "bodies": [{"name": name, "parent": parent, "X": X, "joint": joint} for name, parent, X, joint in bodies],
        "shapes": [
            {"body": body, "kind": kind, "X": X, "size": size, "colour": colour, "name": name, "mesh": None}
            for body, kind, X, size, colour, name in shapes
        ],
        "colours": colours,
        "meshes": {},
        "frames": [{"name": "world", "X": pose()}],
        "points": [{"name": "P1", "X": pose(0.7, 0, 0.5)}, {"name": "P2", "X": pose(0.6, 0.2, 0.4)}],
        "robot": "made-up arm",
        "reach": 0.95,
    }


def statements(duration_s: float) -> list[dict]:
    """The lines 2 to 7, again and again; LOAD takes no time."""
    found: list[dict] = []
    start = 0.0
    while start < duration_s - 1e-9:
        for k, text in enumerate(FEW):
            takes = 0.0 if text.startswith("LOAD") else min(0.32, duration_s - start)
            found.append({"line": k + 2, "number": 10 * (k + 1), "text": text, "start_s": start, "duration_s": takes})
            start += takes
    return [{**one, "path_deviation_mm": 0.1, "peak_torque_pct": 40.0} for one in found]


def tool_point(q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Forward kinematics of the made-up arm, written down independently of the page, (N, 3) m."""
    turn, first, second = q.T
    out = 0.45 * np.cos(first) + 0.5 * np.cos(first + second)
    up = 0.5 - 0.45 * np.sin(first) - 0.5 * np.sin(first + second)
    return np.column_stack([out * np.cos(turn), out * np.sin(turn), up])


def columns(duration_s: float, phase: float = 0.0) -> Columns:
    """The signals of the run; the tool error rises once for a while, one signal has a gap."""
    t = np.arange(round(duration_s / TICK_S)) * TICK_S
    cycle, frame = t[:: round(CYCLE_S / TICK_S)], t[:: round(FRAME_S / TICK_S)]

    def angles(at: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.column_stack([0.5 * np.sin(2 * at), -0.6 + 0.3 * np.cos(1.5 * at), 1.2 + 0.25 * np.sin(1.9 * at)])

    q = angles(t) + 2e-4 * np.sin(30 * t + phase)[:, None]
    error = 1e-4 * (1 + np.sin(3 * t + phase)) + 3e-4 * np.exp(-20 * (t - 0.6 * duration_s) ** 2)
    truth = tool_point(angles(cycle) + 2e-4 * np.sin(30 * cycle + phase)[:, None])
    carried = np.column_stack([tool_point(angles(frame)), np.tile([1.0, 0, 0, 0], (len(frame), 1))])
    gap = np.where((t > 0.3 * duration_s) & (t < 0.4 * duration_s), np.nan, np.sin(5 * t))
    return {
        "q_cmd": angles(t),
        "q_link": q,
        "tool_error": error[:, None],
        "tau_sat": 30 * np.cos(2 * t[:, None] + np.arange(3)),
        "gap": gap[:, None],
        "tool": truth,
        "tool_cmd": tool_point(angles(cycle)),
        "payload_mass": np.where(cycle < 0.5 * duration_s, 0.8, 2.3)[:, None],
        "levels": np.column_stack([np.sin(cycle) > 0, np.cos(3 * cycle) > 0]).astype(float),
        "constant": np.full((len(cycle), 1), 3.25),
        "nothing": np.full((len(cycle), 1), np.nan),
        "parts": carried,
        "fingers": np.column_stack([0.02 + 0.015 * np.sin(2 * frame)] * 2),
    }


def series(
    label: str, signal: str, column: int = 0, scale: float = 1.0, role: str = "value", minus: tuple | None = None
) -> dict:
    return {"label": label, "signal": signal, "column": column, "scale": scale, "minus": minus, "role": role}


def charts() -> list[dict]:
    deg, joints = 180 / np.pi, range(3)
    error = [series(f"J{k + 1}", "q_cmd", k, deg * 1000, minus=("q_link", k)) for k in joints]
    angles = [series(f"J{k + 1}", "q_link", k, deg) for k in joints] + [
        series(f"J{k + 1} cmd", "q_cmd", k, deg, "command") for k in joints
    ]
    made = [
        ("tool_error", "Tool error", "mm", [series("error", "tool_error", 0, 1000)], None),
        ("joint_error", "Joint error", "mdeg", error, None),
        ("joints", "Joint angles", "deg", angles, None),
        ("torque_pct", "Torque", "% of limit", [series(f"J{k + 1}", "tau_sat", k, 3) for k in joints], [-100, 100]),
        ("payload", "Payload", "kg", [series("mass", "payload_mass", role="step")], None),
        (
            "gap",
            "With a gap",
            "-",
            [series("gap", "gap"), series("constant", "constant"), series("nothing", "nothing")],
            None,
        ),
        ("io", "Inputs and outputs", "", [series("READY", "levels", 0), series("CLAMP", "levels", 1)], None),
    ]
    return [
        {"id": name, "title": title, "unit": unit, "series": lines, "band": band, "lanes": name == "io"}
        for name, title, unit, lines, band in made
    ]


def notes(duration_s: float) -> list[dict]:
    return [
        {
            "time_s": 0.96,
            "line": 5,
            "code": "RBL523",
            "severity": "warning",
            "text": "not in position: 0.05 deg left after 0.4 s",
        },
        {"time_s": 0.64, "line": 4, "code": None, "severity": "note", "text": "slowed by J2"},
        {
            "time_s": round(0.6 * duration_s, 3),
            "line": 5,
            "code": "RBL501",
            "severity": "error",
            "text": "path error of J2",
        },
    ]


def run(
    duration_s: float = 4.8,
    *,
    label: str = "first",
    program: str = PROGRAM,
    name: str = "to_and_fro.rbl",
    part: str = "part",
    phase: float = 0.0,
    thinned: dict | None = None,
) -> tuple[dict, Columns]:
    """Header without the coding of its signals, and the signals."""
    executed = statements(duration_s)
    report = {
        "ok": True,
        "robot": "made-up arm",
        "servo": "scheduled",
        "statements": executed,
        "alarms": [],
        "warnings": [{}],
    }
    header = {
        "kind": "run",
        "label": label,
        "duration_s": duration_s,
        "tick_s": TICK_S,
        "cycle_s": CYCLE_S,
        "thinned": thinned,
        "meta": {"program": {"name": name, "text": program}, "scene": scene(part), "report": report},
        "charts": charts(),
        "notes": notes(duration_s),
        "joints": [
            {"name": f"J{k + 1}", "unit": "deg", "lower": -170, "upper": 170, "least_margin": 60.5, "at_s": 1.5}
            for k in range(3)
        ],
    }
    return header, columns(duration_s, phase)


def packed(header: dict, signals: Columns) -> bytes:
    spacing = {
        "q_cmd": TICK_S,
        "q_link": TICK_S,
        "tool_error": TICK_S,
        "tau_sat": TICK_S,
        "gap": TICK_S,
        "parts": FRAME_S,
        "fingers": FRAME_S,
    }
    return pack(
        header,
        [
            Signal(name=name, base="tick", dt=spacing.get(name, CYCLE_S), values=values)
            for name, values in signals.items()
        ],
    )


def page(path: Path, *runs: tuple[dict, Columns]) -> Path:
    """A page as `robolang report` writes it."""
    write_page(path, [packed(*one) for one in runs], Bundle.installed())
    return path
