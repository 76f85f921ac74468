"""The verdicts on a finished run: one for each expectation of its test file.

Every comparison is written so that NaN fails it, and so that nothing to compare fails it: an expectation that no run
could miss is none. A difference from the golden log is named by the first line and tick at which it is too large.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from robolang.execution.report import pose_mm_deg
from robolang.execution.session import Session
from robolang.testing.expectation import Expectation
from robolang.testing.golden import read_golden, write_golden
from runtime.core.faults import Fault
from runtime.core.frames import Array, pose_from_xyzrpy, rotation_angles
from runtime.core.linear import norm
from runtime.core.program_line import named
from runtime.core.rounding import beside
from runtime.core.units import DEG, MM, badness

_LARGEST = (
    ("path_error_mm", "path_deviation_mm", "mm"),
    ("tool_error_mm", "tool_error_mm", "mm"),
    ("torque_pct", "peak_torque_pct", "%"),
)
"""Keys of ``[expect]`` that bound a measure of the statements: the measure in the report, and its unit."""
_MOST_PLACES = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """One expectation: its name, whether it is met, the values compared, and its key of ``[expect]``, ``()`` for none.

    ``fault`` is why it could not be compared at all; it is never met then. ``noted``: shown although it is met.
    """

    name: str
    ok: bool
    detail: str
    key: tuple[str, ...] = ()
    fault: Fault | None = None
    noted: bool = False


def judge(
    expected: Expectation, session: Session, report: dict[str, Any], log: Mapping[str, Array], update: bool = False
) -> list[Verdict]:
    """Return the verdicts on a finished run; ``update``: the golden log is written when all are met."""
    found = _events(expected, report["alarms"], report["warnings"], [entry["text"] for entry in report["printed"]])
    if expected.cycle_s is not None:
        low, high = expected.cycle_s
        seconds = report["sim_time_s"]
        detail = f"{seconds:.3f} s, expected {low:g} to {high:g} s"
        found.append(Verdict(name="cycle", ok=low <= seconds <= high, detail=detail, key=("cycle_s",)))
    for key, measure, unit in _LARGEST:
        most = getattr(expected, key)
        if most is not None:
            found.append(_largest(report["statements"], key, measure, most, unit))
    if expected.end_pose is not None:
        found += _end(expected, _end_pose(session, log))
    found += [_part(report["objects"], name, place, expected.part_mm) for name, place in expected.parts.items()]
    if expected.golden_key is not None:
        # a golden log of a run that fails would make the failure the standard
        clean = all(verdict.ok for verdict in found)
        found.append(_update(expected, session, log, clean) if update else _golden(expected, session, log))
    return found


def judge_refused(expected: Expectation, codes: Sequence[str], why: str) -> list[Verdict]:
    """Return the verdicts of a program that does not start: its codes are what it ends with, nothing else comes."""
    alarms, *rest = _events(expected, [{"code": code} for code in codes], [], [])
    found = [Verdict(name="alarms", ok=alarms.ok, detail=f"the program does not start: {why}", key=("alarms",)), *rest]
    names = ("cycle_s", *(key for key, _, _ in _LARGEST), "end_pose")
    keys: list[tuple[str, ...]] = [(name,) for name in names if getattr(expected, name) is not None]
    keys += [(expected.golden_key,)] if expected.golden_key is not None else []
    keys += [("parts", name) for name in expected.parts]
    detail = "nothing to compare, the program does not start"
    return found + [Verdict(name=" ".join(key), ok=False, detail=detail, key=key) for key in keys]


def _events(
    expected: Expectation, alarms: Sequence[dict[str, Any]], warnings: Sequence[dict[str, Any]], printed: list[str]
) -> list[Verdict]:
    """Return the verdicts on alarms, warnings and printed lines, that on the alarms first."""
    codes = [alarm["code"] for alarm in alarms]
    detail = f"{_listed(codes)}, expected {_listed(expected.alarms)}{_placed(alarms)}"
    found = [Verdict(name="alarms", ok=codes == list(expected.alarms), detail=detail, key=("alarms",))]
    codes = [warning["code"] for warning in warnings]
    if expected.warnings is not None:
        detail = f"{_listed(codes)}, expected {_listed(expected.warnings)}{_placed(warnings)}"
        found.append(
            # sets: a warning that is demanded may come any number of times (docs/testing.md)
            Verdict(name="warnings", ok=set(codes) == set(expected.warnings), detail=detail, key=("warnings",))
        )
    elif codes:
        detail = f"{_listed(codes)}, neither expected nor forbidden{_placed(warnings)}"
        found.append(Verdict(name="warnings", ok=True, detail=detail, key=("warnings",), noted=True))
    if expected.printed is not None:
        detail = _first_line(printed, expected.printed)
        found.append(Verdict(name="printed", ok=printed == list(expected.printed), detail=detail, key=("printed",)))
    return found


def _listed(codes: Sequence[str]) -> str:
    """Return codes in their order, each once with how often it came."""
    counts = Counter(codes)
    return ", ".join(code if count == 1 else f"{code} ({count} times)" for code, count in counts.items()) or "none"


def _placed(rows: Sequence[dict[str, Any]]) -> str:
    """Return where alarms or warnings of a run came from, each of a statement once, the first ``_MOST_PLACES``."""
    found: dict[tuple[Any, ...], str] = {}
    for row in rows:
        if "file" in row:  # what keeps a program from starting is placed by the caller
            place = row["file"], row["line"], row["column"]
            text = "{}:{}:{}: ".format(*place) + f"{row['code']} {row['message']}"
            found.setdefault((*place, row["code"]), text)
    more = len(found) - _MOST_PLACES
    texts = [*list(found.values())[:_MOST_PLACES], *([f"and at {more} more places"] if more > 0 else [])]
    return "".join(f"; {text}" for text in texts)


def _first_line(lines: list[str], expected: tuple[str, ...]) -> str:
    for number, (line, other) in enumerate(zip(lines, expected, strict=False), start=1):
        if line != other:
            return f"line {number} is '{line}', expected '{other}'"
    return f"{len(lines)} lines, expected {len(expected)}"


def _largest(statements: list[dict[str, Any]], key: str, measure: str, most: float, unit: str) -> Verdict:
    """Return the verdict of the largest value; one that is not a number is larger than all others."""
    rows = [(entry[measure], entry) for entry in statements if entry[measure] is not None]
    name = measure.rpartition("_")[0].replace("_", " ")
    if not rows:
        return Verdict(name=name, ok=False, detail="nothing to compare, no statement moves the arm", key=(key,))
    value, entry = max(rows, key=lambda row: badness(row[0]))
    where = named(entry["line"], entry["number"])
    shown, bound = beside(value, most, form=".3f")
    detail = f"{shown} {unit} in {where}, at most {bound} {unit}"
    return Verdict(name=name, ok=value <= most, detail=detail, key=(key,))


def _end_pose(session: Session, log: Mapping[str, Array]) -> Array:
    """Return X_world_tool (4, 4) at the end of the run; a run without a tick ends where it starts."""
    poses = log["X_world_tool"]
    return poses[-1] if len(poses) else session.controller.tool_poses(np.array(session.controller.areas.ina))


def _end(expected: Expectation, X: Array) -> list[Verdict]:
    values = np.array(cast("tuple[float, ...]", expected.end_pose))
    X_expected = pose_from_xyzrpy(values * ([MM] * 3 + [DEG] * 3))
    far = norm(X[:3, 3] - X_expected[:3, 3]) / MM
    turned = float(rotation_angles(X[:3, :3], X_expected[:3, :3])) / DEG
    ended = ", ".join(f"{value:.3f}" for value in pose_mm_deg(X))
    most_mm, most_deg = expected.end_mm, expected.end_deg
    away, bound_mm = beside(far, most_mm, form=".3f")
    turn, bound_deg = beside(turned, most_deg, form=".3f")
    return [
        Verdict(
            name="end",
            ok=far <= most_mm,
            detail=f"{away} mm away, at most {bound_mm} mm: ({ended})",
            key=("end_pose",),
        ),
        Verdict(
            name="end turn",
            ok=turned <= most_deg,
            detail=f"turned by {turn} deg, at most {bound_deg} deg: ({ended})",
            key=("end_pose",),
        ),
    ]


def _part(objects: dict[str, Any], name: str, place: tuple[float, ...], most: float) -> Verdict:
    title, key = f"part {name}", ("parts", name)
    if name not in objects:
        near = f"; its parts: {', '.join(sorted(objects))}" if objects else ""
        return Verdict(name=title, ok=False, detail=f"the cell has no such part{near}", key=key)
    off = norm(np.array(objects[name]["pose_mm_deg"][:3]) - place)
    away, bound = beside(off, most, form=".3f")
    return Verdict(name=title, ok=off <= most, detail=f"{away} mm away, at most {bound} mm", key=key)


def _cycles(session: Session, log: Mapping[str, Array]) -> tuple[Array, Array]:
    """Return detected joints (n, axes) rad or m, as precise as a golden log has them, and lines (n,) of every cycle."""
    every = session.project.profile.ticks_per_cycle
    return log["q_fb"][::every].astype(np.float32), log["line"][::every]


def _update(expected: Expectation, session: Session, log: Mapping[str, Array], clean: bool) -> Verdict:
    (q, line), key = _cycles(session, log), (expected.golden_key or "",)
    if not (clean and np.isfinite(q).all()):
        why = "the run does not meet the other expectations" if not clean else "its angles are not finite"
        return Verdict(name="golden", ok=False, detail=f"not written, {why}", key=key)
    write_golden(expected.golden, q, line)
    return Verdict(name="golden", ok=True, detail=f"written, {len(q)} cycles", key=key)


def _golden(expected: Expectation, session: Session, log: Mapping[str, Array]) -> Verdict:
    (q, line), key = _cycles(session, log), expected.golden_key or ""
    try:
        golden = read_golden(expected.golden, axes=q.shape[1], most_cycles=len(q))
    except Fault as fault:
        placed = expected.fault(fault.code, fault.message, fault.hint, key)
        return Verdict(name="golden", ok=False, detail=fault.message, key=(key,), fault=placed)
    kinds = [axis.kind for axis in session.project.cell.robot.axes]
    at, detail = golden.difference(q, line, [(kind, expected.golden_most(kind)) for kind in kinds])
    if at is not None and len(q):
        profile = session.project.profile
        tick = at * profile.ticks_per_cycle
        # where the golden log is longer, the difference is after the last line of the run
        row = min(at, len(line) - 1)
        number = int(log["number"][:: profile.ticks_per_cycle][row])
        detail += f", first at tick {tick} ({tick * profile.tick_s:.3f} s), {named(int(line[row]), number or None)}"
    return Verdict(name="golden", ok=at is None, detail=detail, key=(key,))
