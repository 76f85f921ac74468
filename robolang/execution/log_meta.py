"""``meta`` of a log: all that somebody needs who has nothing but the log, in plain JSON types.

Nothing in it depends on the machine, the folder or the wall time: the same run gives the same bytes.
"""

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from robolang.core.storage import strict
from robolang.execution import lowering
from robolang.execution.findings import file_name, of_project
from robolang.execution.result import RunRecord
from robolang.interpreter.effects import SetHand
from robolang.logs.log import VERSION
from robolang.project.project import Project
from runtime.appearance.cell_scene import scene_of
from runtime.appearance.scene import Scene
from runtime.cell.signals import Signals
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.spec import RobotSpec

_OF_THE_HOST = ("wall_time_s", "realtime_factor", "overruns")
"""Keys of the report that the host has a part in."""


def meta_of(record: RunRecord, signals: Signals, report: dict[str, Any]) -> dict[str, Any]:
    """Return the ``meta`` of a run; ``signals`` are those of its cell, ``report`` is that of ``build_report``."""
    project, profile = record.project, record.controller.profile
    points = point_poses(project, record.controller.kinematics)
    name = file_name(project.source.path)
    found = {
        "format": VERSION,
        "program": {"name": name, "text": project.source.text},
        "cell": {"text": project.cell_text},
        "points": points_of(points),
        "robot": robot_of(project.cell.robot, project.cell.hand.X_flange_tool),
        "scene": _scene(project, points),
        "events": events(record, signals),
        "findings": of_project(project),
        "home": list(map(float, project.cell.home)),
        "report": _without_host(report, project.source.path, name),
        "tick_s": profile.tick_s,
        "cycle_s": profile.period_s,
    }
    plain = strict(found)
    assert isinstance(plain, dict)
    return plain


def _scene(project: Project, points: Mapping[str, Array]) -> dict[str, Any] | None:
    """Return the scene of a run; None where it is none that a reader takes: a log is not lost by how it looks."""
    scene = scene_of(project.cell, points).as_json()
    with suppress(Fault):
        Scene.from_json(scene)
        return scene
    return None


def events(record: RunRecord, signals: Signals) -> list[dict[str, Any]]:
    """Return the changes of inputs, outputs and the hand up to now: time s, kind, name and value, in order of time."""
    controller = record.controller
    now_us = controller.time_us
    rows = [
        (us, kind, str(number), value)
        for kind, changes in (("input", signals.input_changes(now_us)), ("output", signals.output_changes(now_us)))
        for number, states in sorted(changes.items())
        for us, value in states
    ]
    rows += [
        (run.first_tick * controller.profile.tick_us, "hand", "hand", float(run.effect.closed))
        for run in record.statements
        if isinstance(run.effect, SetHand)
    ]
    keys = ("time_s", "kind", "name", "value")
    return [dict(zip(keys, (us / 1e6, *row), strict=True)) for us, *row in sorted(rows, key=lambda row: row[0])]


def point_poses(project: Project, kinematics: Kinematics) -> dict[str, Array]:
    """Return X_world_tool (4, 4) of the taught points with the tool of the hand, of those that can be computed."""
    found: dict[str, Array] = {}
    for name, point in project.points.points.items():
        # of another robot, or of a frame that the cell has no more: a program that uses it is refused
        with suppress(Fault):
            found[name] = lowering.target(point, project.cell, kinematics)
    return found


def points_of(poses: Mapping[str, Array]) -> dict[str, Any]:
    """Return where points are in the world: ``p_mm`` and ``r_deg`` of each."""
    sixes = {name: lowering.six_of(X) for name, X in poses.items()}
    return {name: {"p_mm": list(six[:3]), "r_deg": list(six[3:])} for name, six in sixes.items()}


def robot_of(spec: RobotSpec, X_flange_tool: Array) -> dict[str, Any]:
    """Return the joint frames and limits of a robot and the tool at the start of a run, in SI."""
    return {
        "name": spec.name,
        "axes": [
            {
                "name": f"J{number}",  # as messages and the language name it
                "title": axis.name,
                "kind": axis.kind.name,
                "placement": axis.placement.tolist(),
                "lower": float(axis.limits.lower),
                "upper": float(axis.limits.upper),
                "speed": float(axis.limits.speed),
                "torque": float(axis.limits.torque),
            }
            for number, axis in enumerate(spec.axes, 1)
        ],
        "flange": spec.X_last_flange.tolist(),
        "tool": X_flange_tool.tolist(),
    }


def _without_host(value: Any, path: str, name: str) -> Any:
    """Return a report without what the host has a part in, and without the folder of the program."""
    if isinstance(value, dict):
        kept = {key: item for key, item in value.items() if key not in _OF_THE_HOST}
        return {
            key: name if key in ("file", "program") and item == path else _without_host(item, path, name)
            for key, item in kept.items()
        }
    return [_without_host(item, path, name) for item in value] if isinstance(value, list | tuple) else value
