"""The report of a run: what each statement did and how well, in the units people read. Plain JSON types only.

Joint errors compare the command that the servo received with the true link angles, at the same tick. ``tool error`` is
the distance between the commanded and the true tool point, beyond the gear springs; ``path deviation`` is the distance
of the true tool point from the path of its move, or of a move beside it in its chain, however far along it is.
Everything but the wall times repeats exactly.
"""

from collections.abc import Sequence
from typing import Any

from robolang.core.diagnostics import Severity
from robolang.execution.alarms import as_json
from robolang.execution.measures import Measured
from robolang.execution.result import RunRecord, StatementRun
from robolang.execution.run_report import Report, report_of
from robolang.execution.speed_keys import KEYS, speed_keys
from runtime.control.controller import Controller
from runtime.core.faults import Alarm
from runtime.core.frames import Array, xyzrpy_from_pose
from runtime.core.units import DEG, MM, PERCENT
from runtime.plant.touches import shape_text


def build_report(record: RunRecord, measured: Sequence[Measured], wall_s: float) -> Report:
    """Return the report of a finished run (docs/signals.md explains every key).

    ``measured`` is of each statement, as ``Measures.complete`` gives it.
    """
    controller = record.controller
    sim_s = controller.time_us / 1_000_000
    found = {
        "program": record.project.source.path,
        "robot": controller.spec.name,
        "robot_estimated": list(controller.spec.estimated),
        "ok": not record.alarms,
        "physics": record.physics,
        "servo": record.project.profile.servo.mode,
        "sim_time_s": sim_s,
        "wall_time_s": wall_s,
        "realtime_factor": sim_s / wall_s if wall_s > 0.0 else 0.0,
        "cycles": controller.recorder.cycle,
        "overruns": controller.overruns,
        "statements": [
            {**_statement(run, found, controller), "touched": _touched(run, controller)}
            for run, found in zip(record.statements, measured, strict=True)
        ],
        "dynamics": _dynamics(record),
        "payload_history": record.payloads,
        "printed": [{"time_s": time_s, "text": text} for time_s, text in record.shown],
        "objects": {name: {"pose_mm_deg": pose_mm_deg(X)} for name, X in sorted(controller.plant.parts().items())},
        "alarms": _events(record, record.alarms, Severity.ERROR),
        "warnings": _events(record, controller.warnings, Severity.WARNING),
    }
    return report_of(found)


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
    *KEYS,
    "joint_error_deg",
    "joint_error_mm",
    "tool_error_mm",
    "path_deviation_mm",
    "peak_torque_pct",
    "wrist",
    "seam",
)
"""Keys that are null for a statement that has not begun."""


def _statement(run: StatementRun, measured: Measured, controller: Controller) -> dict[str, Any]:
    if not run.begun:
        found = {**_head(run), **dict.fromkeys(_MEASURED), "notes": []}
        return found if controller.spec.slides.any() else _without_mm(found)
    tick_us = controller.profile.tick_us
    # a statement that still goes on has no end yet: what it has done so far is measured
    end = run.end_tick if run.ended else controller.recorder.tick
    found = {
        **_head(run),
        "start_s": run.first_tick * tick_us / 1_000_000,
        "duration_s": (end - run.first_tick) * tick_us / 1_000_000,
        "planned_s": run.planned_s,
        **speed_keys(run.reached),
        "joint_error_deg": measured.joint_deg,
        "joint_error_mm": measured.joint_mm,
        "tool_error_mm": measured.tool_mm,
        "path_deviation_mm": measured.path_mm,
        "peak_torque_pct": measured.torque_pct,
        "wrist": _wrist(run, measured, tick_us),
        "seam": _seam(run, measured),
        "notes": list(run.notes),
    }
    return found if controller.spec.slides.any() else _without_mm(found)


def _without_mm(statement: dict[str, Any]) -> dict[str, Any]:
    """Return a statement of an arm whose axes all turn: it has no error of a joint in mm."""
    return {key: value for key, value in statement.items() if key != "joint_error_mm"}


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


def _wrist(run: StatementRun, measured: Measured, tick_us: int) -> dict[str, object] | None:
    """Return the event of a wrist that left its posture: from when to when, why, and by how much; None for none."""
    if measured.wrist is None:
        return None
    change, (first, last) = run.wrist, measured.wrist
    start, end = (at * tick_us / 1_000_000 for at in (first, last + 1))
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


def _seam(run: StatementRun, measured: Measured) -> dict[str, object] | None:
    """Return what a MOVE under a seam sensor followed; None without one."""
    if run.seam is None:
        return None
    return {
        "sensor": run.seam,
        "largest_mm": measured.seam_mm,
        "largest_deg": measured.seam_deg,
        "lost_readings": run.lost,
    }


def _dynamics(record: RunRecord) -> dict[str, Any]:
    areas, profile = record.controller.areas, record.project.profile
    return {
        "interpolation_cost_ms": profile.interpolation_cost_us * 1e-3,
        "axis_cost_ms": profile.axis_cost_us * 1e-3,
        "refresh_mean_ms": areas.mean_refresh_us * 1e-3,
        "refresh_max_ms": areas.longest_refresh_us * 1e-3,
        "refreshes": list(areas.refreshes),
    }
