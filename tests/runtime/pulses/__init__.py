"""Exports of pulse tables written by hand, with plain arithmetic and nothing of the exporter."""

import json
from dataclasses import dataclass, field
from pathlib import Path

X_TABLE, Y_TABLE = "00_line30_X.csv", "01_line30_Y.csv"
"""Tables of ``staircase``."""
HEADER = "control,frequency_hz,target_pulses,steps"


def rows(at, targets, rate):
    """The rows from ``at`` through one target in each step, ``rate`` steps in a second; steps at rest are waits."""
    found = []
    for target in targets:
        if target != at:
            found.append(["up" if target > at else "down", abs(target - at) * rate, target, 1])
        elif found and found[-1][0] == "wait":
            found[-1][3] += 1
        else:
            found.append(["wait", 0, at, 1])
        at = target
    return [*found, ["end", 0, at, 0]]


def csv(table):
    """The text of a table, its first row on line 4."""
    lines = ["# pulses of one move", "# written by hand", HEADER, *(",".join(map(str, row)) for row in table)]
    return "\n".join(lines) + "\n"


def pose(x=0.0, y=0.0, z=0.0, turn=((1, 0, 0), (0, 1, 0), (0, 0, 1))):
    return [[*row, at] for row, at in zip(turn, (x, y, z), strict=True)] + [[0, 0, 0, 1]]


TURN_X = ((1, 0, 0), (0, 0, -1), (0, 1, 0))
ARM = {
    "kind": "arm",
    "name": "two",
    "placements": [pose(), pose(0.4, turn=TURN_X)],
    "X_last_flange": pose(0.3, turn=TURN_X),
    "X_flange_tool": pose(0.0, 0.1, 0.0),
}
"""A mechanism of two axes in the plane, the second one lying down."""


@dataclass
class Handmade:
    """A folder to be: ``channels`` are (name, unit, unit per pulse, first position); moves are added one by one."""

    mechanism: dict
    channels: list
    rate: int = 100
    min_hz: float = 1.5
    max_hz: float = 100_000.0
    sequence: list = field(default_factory=list)
    files: dict = field(default_factory=dict)

    def __post_init__(self):
        self.at = {name: start for name, _, _, start in self.channels}

    def load(self, line, mass=0.8, cog=(0, 0, 60)):
        self.sequence.append(
            {
                "kind": "marker",
                "line": line,
                "number": 10 * line,
                "text": f"LOAD {cog}, {mass}",
                "load": {"mass_kg": mass, "cog_mm": list(cog)},
            }
        )

    def hand(self, line, state, dwell=0.3):
        self.sequence.append(
            {
                "kind": "marker",
                "line": line,
                "number": 10 * line,
                "text": f"HAND {state.upper()}",
                "hand": state,
                "dwell_s": dwell,
            }
        )

    def move(self, line, start, end, text="MOVE P1", **targets):
        """A move; ``targets`` of the channels that do not stand still, one a step; ``start`` and ``end`` mm."""
        tables = dict.fromkeys(self.at)
        for name, positions in targets.items():
            tables[name] = f"{len(self.files):02}_line{10 * line}_{name}.csv"
            self.files[tables[name]] = csv(rows(self.at[name], positions, self.rate))
            self.at[name] = positions[-1]
        self.sequence.append(
            {
                "kind": "move",
                "line": line,
                "number": 10 * line,
                "text": text,
                "steps": max(map(len, targets.values()), default=0),
                "start_mm": list(start),
                "end_mm": list(end),
                "tables": tables,
                "f174": {},
                "summary": {},
            }
        )

    @property
    def manifest(self):
        channels = [
            {
                "name": name,
                "unit": unit,
                "per_pulse": per_pulse,
                "min_hz": self.min_hz,
                "max_hz": self.max_hz,
                "start_pulses": start,
            }
            for name, unit, per_pulse, start in self.channels
        ]
        return {
            "schema": 1,
            "program": "by_hand.rbl",
            "mechanism": self.mechanism,
            "step_s": 1 / self.rate,
            "channels": channels,
            "sequence": self.sequence,
        }

    def write(self, folder: Path) -> Path:
        folder.mkdir(exist_ok=True)
        (folder / "manifest.json").write_text(json.dumps(self.manifest, indent=1), "utf-8")
        for name, text in self.files.items():
            (folder / name).write_text(text, "utf-8")
        return folder


def staircase():
    """An xy table that goes 3 mm along x, then 4 mm along y, three times: 2.4 mm beside the line in each corner."""
    found = Handmade(
        {"kind": "cartesian", "name": "xy", "axes": ["x", "y"], "z_mm": 120.0},
        [("X", "mm", 0.01, 100), ("Y", "mm", -0.02, 50)],
    )
    found.load(1)
    found.hand(2, "off")
    found.move(3, (1, -1, 120), (10, 11, 120), X=[400, 400, 700, 700, 1000, 1000], Y=[50, -150, -150, -350, -350, -550])
    found.move(4, (10, 11, 120), (9, 11, 120), "MOVE P2", X=[960, 940, 920, 900])
    return found


def turntable():
    """A cylindrical arm that turns from -10 to 10 deg at 300 mm in two steps: an arc over the chord of its line."""
    x, y = 300.0 * 0.984807753012208, 300.0 * 0.17364817766693033
    found = Handmade(
        {"kind": "cylindrical", "name": "cylindrical", "axes": ["theta", "r"], "z_mm": 50.0},
        [("T", "deg", 0.05, -200), ("R", "mm", 0.01, 30000)],
    )
    found.move(1, (x, -y, 50), (x, y, 50), T=[0, 200])
    return found
