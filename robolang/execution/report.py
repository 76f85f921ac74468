"""The report of a run: what each statement did and how well, in the units people read. Plain JSON types only.

Joint errors compare the command that the servo received with the true link angles, at the same tick. ``tool error`` is
the distance between the commanded and the true tool point, beyond the gear springs; ``path deviation`` is the distance
of the true tool point from the straight segment of a MOVE, however far along it is. Everything but the wall times
repeats exactly.
"""

from typing import Any

import numpy as np

from robolang.core.diagnostics import Severity
from robolang.execution.alarms import as_json
from robolang.execution.result import RunRecord, StatementRun
from runtime.control.controller import Controller
from runtime.control.signals import Signals
from runtime.core.faults import Alarm
from runtime.core.frames import Array, xyzrpy_from_pose
from runtime.core.units import DEG, MM, PERCENT
from runtime.plant.touches import shape_text
from runtime.servo.motor import torque_limit


def build_report(record: RunRecord, log: Signals, wall_s: float) -> dict[str, Any]:
    """Return the report of a finished run (docs/signals.md explains every key)."""
    controller = record.controller
    sim_s = controller.time_us / 1_000_000
    measures = _Measures(log, torque_limit(controller.spec))
    return {
        "program": record.project.source.path,
        "robot": controller.spec.name,
        "ok": not record.alarms,
        "physics": record.physics,
        "servo": record.project.profile.servo.mode,
        "sim_time_s": sim_s,
        "wall_time_s": wall_s,
        "realtime_factor": sim_s / wall_s if wall_s > 0.0 else 0.0,
        "cycles": controller.recorder.cycle,
        "overruns": controller.overruns,
        "statements": [
            {**_statement(run, measures, controller.profile.tick_us), "touched": _touched(run, controller)}
            for run in record.statements
        ],
        "dynamics": _dynamics(record),
        "payload_history": record.payloads,
        "printed": [{"time_s": time_s, "text": text} for time_s, text in record.shown],
        "objects": {name: {"pose_mm_deg": pose_mm_deg(X)} for name, X in sorted(controller.plant.parts().items())},
        "alarms": _events(record, record.alarms, Severity.ERROR),
        "warnings": _events(record, controller.warnings, Severity.WARNING),
    }


def _events(record: RunRecord, found: list[Alarm], severity: Severity) -> list[dict[str, object]]:
    source, tick_us = record.project.source, record.controller.profile.tick_us
    return [as_json(alarm, severity, source, tick_us) for alarm in found]


def pose_mm_deg(X: Array) -> list[float]:
    """Return [x, y, z, rx, ry, rz] in mm and deg of a pose (4, 4)."""
    values = xyzrpy_from_pose(X) / ([MM] * 3 + [DEG] * 3)
    return [float(value) + 0.0 for value in values]  # + 0.0: no -0.0 in a report


_MEASURED = (
    "start_s",
    "duration_s",
    "planned_s",
    "joint_error_deg",
    "tool_error_mm",
    "path_deviation_mm",
    "peak_torque_pct",
    "wrist",
    "seam",
)
"""Keys that are null for a statement that has not begun."""


class _Measures:
    """Error measures of every tick, computed once for the whole run."""

    def __init__(self, log: Signals, torque: Array) -> None:
        self.p_tool = log["X_world_tool"][:, :3, 3]
        self.joint_deg = np.abs(log["q_cmd"] - log["q_link"]).max(axis=1) / DEG
        self.tool_mm = log["tool_error"] / MM
        self.wrist_mode, self.deviation = log["wrist_mode"], log["seam_deviation"]
        self.torque_pct = np.abs(log["tau_sat"] / torque).max(axis=1) / PERCENT


def _statement(run: StatementRun, measures: _Measures, tick_us: int) -> dict[str, Any]:
    # a statement that still goes on has no end yet: what it has done so far is measured
    end = run.end_tick if run.end_tick >= run.first_tick else len(measures.tool_mm)
    span = slice(run.first_tick, end)
    deviation = None
    if not run.begun:
        return {**_head(run), **dict.fromkeys(_MEASURED), "notes": []}
    if run.path is not None and end > run.first_tick:
        # a seam sensor takes the tool off the programmed path on purpose, which is no error of the servo
        deviation = float(run.path.deviation((measures.p_tool - measures.deviation[:, :3])[span]).max()) / MM
    return {
        **_head(run),
        "start_s": run.first_tick * tick_us / 1_000_000,
        "duration_s": (end - run.first_tick) * tick_us / 1_000_000,
        "planned_s": run.planned_s,
        "joint_error_deg": _largest(measures.joint_deg[span]),
        "tool_error_mm": _largest(measures.tool_mm[span]),
        "path_deviation_mm": deviation,
        "peak_torque_pct": _largest(measures.torque_pct[span]),
        "wrist": _wrist(run, measures.wrist_mode[span], tick_us),
        "seam": _seam(run, measures.deviation[span]),
        "notes": list(run.notes),
    }


def _touched(run: StatementRun, controller: Controller) -> list[dict[str, object]]:
    """Return what the arm, the hand or a held part touched in a statement and should not have; see ``Touches``."""
    return [
        {
            "by": [shape_text(name) for name in touch.by],
            "what": shape_text(touch.what),
            "time_s": touch.tick * controller.profile.tick_us / 1_000_000,
            "moved_mm": touch.moved / MM,
            "turned_deg": touch.turned / DEG,
            "slid_mm": touch.slid / MM,
        }
        for touch in ([] if controller.touches is None else controller.touches.records)
        if touch.noticed and run.first_tick <= touch.tick < run.end_tick
    ]


def _head(run: StatementRun) -> dict[str, Any]:
    # line 0: a statement that was fed, which is in no line of the file
    return {"line": run.origin.line or None, "number": run.origin.number, "text": run.text, "begun": run.begun}


def _wrist(run: StatementRun, mode: Array, tick_us: int) -> dict[str, object] | None:
    """Return the event of a wrist that left its posture: from when to when, why, and by how much; None for none."""
    on = np.flatnonzero(mode)
    if not len(on):
        return None
    change = run.wrist
    start, end = ((run.first_tick + int(at)) * tick_us / 1_000_000 for at in (on[0], on[-1] + 1))
    event: dict[str, object] = {"start_s": start, "end_s": end}
    if change is not None:
        event |= {
            "condition": change.condition,
            "axis": None if change.axis is None else change.axis + 1,
            "from_path_pct": change.share / PERCENT,
            "to_path_pct": change.share_end / PERCENT,
            "remedy": change.remedy,
            "held": list(change.held),
            "posture_deviation_deg": change.deviation / DEG,
        }
    return event


def _seam(run: StatementRun, deviation: Array) -> dict[str, object] | None:
    """Return what a MOVE under a seam sensor followed; None without one."""
    if run.seam is None:
        return None
    far, turned = np.linalg.norm(deviation[:, :3], axis=1), np.abs(deviation[:, 3:]).max(axis=1)
    return {
        "sensor": run.seam,
        "largest_mm": _largest(far / MM),
        "largest_deg": _largest(turned / DEG),
        "lost_readings": run.lost,
    }


def _largest(values: Array) -> float | None:
    return float(values.max()) if len(values) else None


def _dynamics(record: RunRecord) -> dict[str, Any]:
    areas, profile = record.controller.areas, record.project.profile
    return {
        "interpolation_cost_ms": profile.interpolation_cost_us * 1e-3,
        "axis_cost_ms": profile.axis_cost_us * 1e-3,
        "refresh_mean_ms": areas.mean_refresh_us * 1e-3,
        "refresh_max_ms": areas.longest_refresh_us * 1e-3,
        "refreshes": list(areas.refreshes),
    }
