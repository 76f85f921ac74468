"""What a program is expected to do: the file ``NAME.test.toml`` beside it, and what a run says to it.

::

    schema = 1
    physics = true                       # false: on the ideal arm
    [expect]                             # every key is optional
    alarms = []                          # codes that the run must end with, in order; none: it ends well
    cycle_s = [13.5, 14.5]               # least and most time of the whole run
    printed = ["2 parts"]                # the lines of PRINT
    path_error_mm = 0.5                  # most distance of the tool point from its paths, blends not counted
    tool_error_mm = 0.5                  # most distance of the tool from its command
    torque_pct = 80                      # most torque of any joint, of its limit
    end_pose = [480, 0, 840, 180, 0, 180]
    end_mm = 0.5                         # how far from it the tool may end, default 1
    golden_deg = 0.01                    # most difference of a joint from NAME.golden.npz, cycle by cycle
    [expect.parts]
    part_1 = [400, 150, 640]             # where a part lies in the end
    part_mm = 1.0                        # how far from there, default 1

The golden log is the joint angles of every interpolation cycle and the line that ran; ``robolang test --update`` writes
it. A difference is named by the first line and tick at which it is too large.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

import numpy as np

from robolang.report import pose_mm_deg
from robolang.session import Session
from robolang.storage import write_atomic
from runtime.faults import Fault
from runtime.frames import Array
from runtime.tomlfile import Table, load_table, read_source
from runtime.units import DEG

SCHEMA = 1
ENDING = ".test.toml"


@dataclass(frozen=True, slots=True, kw_only=True)
class Expectation:
    """The contents of a test file; None: nothing is expected of it. Units as in the file."""

    path: Path
    physics: bool = True
    alarms: tuple[str, ...] = ()
    cycle_s: tuple[float, float] | None = None
    printed: tuple[str, ...] | None = None
    path_error_mm: float | None = None
    tool_error_mm: float | None = None
    torque_pct: float | None = None
    end_pose: tuple[float, ...] | None = None
    end_mm: float = 1.0
    golden_deg: float | None = None
    parts: dict[str, tuple[float, ...]] = field(default_factory=dict)
    part_mm: float = 1.0

    @property
    def golden(self) -> Path:
        """The golden log beside the test file."""
        return self.path.with_name(self.path.name.removesuffix(ENDING) + ".golden.npz")


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """One thing that was looked at: its name, whether it is as expected, and in words what was found."""

    name: str
    ok: bool
    said: str


def load_expectation(path: Path) -> Expectation:
    """Read a test file; ``FileFault`` RBL6xx at its line."""
    table = load_table(read_source(path))
    if table.integer("schema", low=0, high=10**6) != SCHEMA:
        table.fail("RBL605", f"'schema' must be {SCHEMA}", key="schema")
    expect = table.table("expect", required=False)
    parts = expect.table("parts", required=False)
    found = Expectation(
        path=path,
        physics=table.flag("physics", True),
        alarms=_texts(expect, "alarms") or (),
        cycle_s=_pair(expect, "cycle_s"),
        printed=_texts(expect, "printed"),
        path_error_mm=_most(expect, "path_error_mm"),
        tool_error_mm=_most(expect, "tool_error_mm"),
        torque_pct=_most(expect, "torque_pct"),
        end_pose=expect.numbers("end_pose", 6) if "end_pose" in expect else None,
        end_mm=expect.number("end_mm", 1.0, positive=True),
        golden_deg=_most(expect, "golden_deg"),
        part_mm=parts.number("part_mm", 1.0, positive=True),
        parts={name: parts.numbers(name, 3) for name in parts.names() if name != "part_mm"},
    )
    for each in (parts, expect, table):
        each.done()
    return found


def _texts(table: Table, key: str) -> tuple[str, ...] | None:
    if key not in table:
        return None
    found = table.raw_list(key)
    if not all(isinstance(item, str) for item in found):
        table.fail("RBL613", f"'{table.name(key)}' must be a list of texts", key=key)
    return tuple(found)


def _pair(table: Table, key: str) -> tuple[float, float] | None:
    if key not in table:
        return None
    low, high = table.numbers(key, 2, low=0.0)
    if not low <= high:
        table.fail("RBL607", f"'{table.name(key)}' must be [least, most]", key=key)
    return low, high


def _most(table: Table, key: str) -> float | None:
    return table.number(key, low=0.0) if key in table else None


def judge(expected: Expectation, session: Session, report: dict[str, Any], log: dict[str, Array],
          update: bool = False) -> list[Verdict]:  # fmt: skip
    """Return what a finished run says to the expectations; with ``update`` the golden log is written anew."""
    alarms = [alarm["code"] for alarm in report["alarms"]]
    found = [Verdict(name="alarms", ok=alarms == list(expected.alarms), said=f"{', '.join(alarms) or 'none'}")]
    if expected.cycle_s is not None:
        low, high = expected.cycle_s
        seconds = report["sim_time_s"]
        found.append(Verdict(name="cycle", ok=low <= seconds <= high,
                             said=f"{seconds:.3f} s, expected {low:g} to {high:g} s"))  # fmt: skip
    if expected.printed is not None:
        lines = [entry["text"] for entry in report["printed"]]
        said = _first_line(lines, expected.printed)
        found.append(Verdict(name="printed", ok=lines == list(expected.printed), said=said))
    for key, most, unit in (("path_deviation_mm", expected.path_error_mm, "mm"),
                            ("tool_error_mm", expected.tool_error_mm, "mm"),
                            ("peak_torque_pct", expected.torque_pct, "%")):  # fmt: skip
        if most is not None:
            found.append(_largest(report, key, most, unit))
    if expected.end_pose is not None:
        found.append(_end(expected, log))
    for name, place in expected.parts.items():
        found.append(_part(report, name, place, expected.part_mm))
    if expected.golden_deg is not None:
        found.append(_golden(expected, session, log, expected.golden_deg, update))
    return found


def _first_line(lines: list[str], wanted: tuple[str, ...]) -> str:
    for number, (line, want) in enumerate(zip(lines, wanted, strict=False), start=1):
        if line != want:
            return f"line {number} is '{line}', expected '{want}'"
    return f"{len(lines)} lines, expected {len(wanted)}"


def _largest(report: dict[str, Any], key: str, most: float, unit: str) -> Verdict:
    rows = [(entry[key], entry) for entry in report["statements"] if entry[key] is not None]
    name = key.rpartition("_")[0].replace("_", " ")
    if not rows:
        return Verdict(name=name, ok=True, said="nothing has moved")
    value, entry = max(rows, key=lambda row: row[0])
    where = entry["number"] if entry["number"] is not None else entry["line"]
    return Verdict(name=name, ok=value <= most, said=f"{value:.3f} {unit} in line {where}, at most {most:g} {unit}")


def _end(expected: Expectation, log: dict[str, Array]) -> Verdict:
    pose = np.array(pose_mm_deg(log["X_world_tool"][-1]))
    off = float(np.linalg.norm(pose[:3] - np.array(cast("tuple[float, ...]", expected.end_pose))[:3]))
    return Verdict(name="end", ok=off <= expected.end_mm, said=f"{off:.3f} mm away, at most {expected.end_mm:g} mm")


def _part(report: dict[str, Any], name: str, place: tuple[float, ...], most: float) -> Verdict:
    if name not in report["objects"]:
        return Verdict(name=f"part {name}", ok=False, said="the cell has no such part, or the run had no physics")
    off = float(np.linalg.norm(np.array(report["objects"][name]["pose_mm_deg"][:3]) - place))
    return Verdict(name=f"part {name}", ok=off <= most, said=f"{off:.3f} mm away, at most {most:g} mm")


def _golden(expected: Expectation, session: Session, log: dict[str, Array], most_deg: float, update: bool) -> Verdict:
    """Compare with the golden log, or write it."""
    every = session.project.profile.ticks_per_cycle
    q, line = log["q_fb"][::every], log["line"][::every]
    if update:
        write_atomic(expected.golden, lambda stream: np.savez_compressed(stream, q=q.astype(np.float32), line=line))
        return Verdict(name="golden", ok=True, said=f"written, {len(q)} cycles")
    try:
        with np.load(expected.golden, allow_pickle=False) as stored:
            q_golden, line_golden = stored["q"].astype(np.float64), stored["line"]
    except (OSError, KeyError, ValueError) as error:
        raise Fault("RBL600", f"cannot read the golden log {expected.golden}: {error}",
                    "write it with robolang test --update") from None  # fmt: skip
    count = min(len(q), len(q_golden))
    off = np.abs(q[:count] - q_golden[:count]).max(axis=1) / DEG
    differs = np.flatnonzero((off > most_deg) | (line[:count] != line_golden[:count]))
    if not len(differs) and len(q) == len(q_golden):
        most = float(off.max(initial=0.0))
        return Verdict(name="golden", ok=True, said=f"{count} cycles, at most {most:.2g} deg off")
    at = int(differs[0]) if len(differs) else count
    tick, here = at * every, int(line[min(at, len(line) - 1)])
    where = f"first at tick {tick} ({tick * session.project.profile.tick_s:.3f} s), line {here}"
    why = f"{float(off[at]):.3g} deg off" if len(differs) else f"{len(q)} cycles, the golden log {len(q_golden)}"
    return Verdict(name="golden", ok=False, said=f"{why}, {where}")
