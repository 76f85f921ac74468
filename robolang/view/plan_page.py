"""What a page holds of a planned motion: the joint angles of every cycle, its times, and the findings at their places.

The same page as that of a run, with what a plan has: no physics, no torques, no errors of the servo.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from robolang.core.diagnostics import Diagnostic, has_errors
from robolang.execution.dry_run import Rehearsal
from robolang.execution.findings import file_name, of_diagnostic, of_doubt
from robolang.execution.log_meta import point_poses, robot_of
from robolang.execution.speed_keys import speed_keys
from robolang.planning.placed import Placed
from robolang.project.project import Project
from robolang.syntax.unparse import describe
from robolang.view import charts, joints, notes
from robolang.view.packing import Signal, pack
from robolang.view.plan_parts import parts_of
from robolang.view.plan_rows import PlanRows
from robolang.view.programmed import programmed_signal
from robolang.view.run_signals import drawn_off
from robolang.view.thinning import evenly, paired, thinned
from runtime.appearance.cell_scene import scene_of
from runtime.control.signals import Signals
from runtime.core.frames import Array
from runtime.core.tomlfile import FileFault


def pack_plan(
    project: Project, rehearsal: Rehearsal, found: Sequence[Diagnostic], doubts: Sequence[FileFault] = ()
) -> bytes:
    """Return a planned motion as a page holds it, with what was ``found`` in program, points and motion.

    ``doubts`` are what is unlikely about the files of cell and robot.
    """
    cycle_s, robot, label = project.profile.period_s, _robot(project), file_name(project.source.path)
    rows = PlanRows(project, rehearsal)
    q, made = rows.q, Signals(rows, rehearsal.kinematics.chain)
    programmed = programmed_signal(_moves(rehearsal), len(q), cycle_s)
    shown = (*_signals(made, q, cycle_s), *programmed, *parts_of(project, rehearsal, q))
    signals = {signal.name: signal for signal in shown}
    header = {
        "kind": "plan",
        "label": label,
        "duration_s": rehearsal.total_us / 1e6,
        "tick_s": cycle_s,
        "cycle_s": cycle_s,
        "thinned": thinned(len(q), cycle_s, drawn_off(made)),
        "meta": {
            "program": {"name": label, "text": project.source.text},
            "robot": robot,
            "scene": scene_of(project.cell, point_poses(project, rehearsal.kinematics)).as_json(),
            "events": [],
            "report": _report(project, rehearsal, found),
        },
        "charts": [asdict(chart) for chart in charts.of_plan(charts.Shown(robot=robot, signals=signals))],
        "notes": [asdict(note) for note in _notes(project, rehearsal, found, doubts)],
        "joints": [asdict(joint) for joint in joints.ranges(robot["axes"], [q], cycle_s)],
    }
    return pack(header, list(signals.values()))


def _moves(rehearsal: Rehearsal) -> Iterator[dict[str, Any]]:
    """Yield times and speeds of the moves, as a report has them."""
    for move in rehearsal.moves:
        times = {"start_s": move.begins_us / 1e6, "duration_s": (move.ends_us - move.begins_us) / 1e6}
        yield {**times, **speed_keys(move.speeds.moves[move.number])}


def _signals(made: Signals, q: Array, cycle_s: float) -> Iterator[Signal]:
    yield evenly(_cycle("q_link", q, cycle_s))
    # of set-points 8 ms apart: between them a peak may be a little higher
    speed = _change(q, cycle_s)
    for name, values in (
        ("dq_cmd", speed),
        ("ddq_cmd", _change(speed, cycle_s)),
        ("tool_speed", made["tool_speed"][:, None]),
    ):
        yield paired(_cycle(name, values, cycle_s))
    yield evenly(_cycle("tool", made.tool_points("q_link", 0, len(q)), cycle_s))


def _cycle(name: str, values: Array, cycle_s: float) -> Signal:
    return Signal(name=name, base="cycle", dt=cycle_s, values=values)


def _change(values: Array, dt: float) -> Array:
    """Return the rate of each row (N, k) against the row before it."""
    return np.diff(values, axis=0, prepend=values[:1]) / dt


def _robot(project: Project) -> dict[str, Any]:
    """Return a robot as the ``meta`` of a log has it, with the accelerations that a plan is held to."""
    robot = robot_of(project.cell.robot, project.cell.hand.X_flange_tool)
    limits = project.cell.robot.per_axis("limits", "acceleration").tolist()
    axes = [{**axis, "acceleration": limit} for axis, limit in zip(robot["axes"], limits, strict=True)]
    return {**robot, "axes": axes}


def _report(project: Project, rehearsal: Rehearsal, found: Iterable[Diagnostic]) -> dict[str, Any]:
    """Return of the report of a run what a plan has."""
    texts = {line.source_line: describe(line.statement) for line in project.program.statements if line.statement}
    return {
        "robot": project.cell.robot.name,
        "ok": not has_errors(found),
        "sim_time_s": rehearsal.total_us / 1e6,
        "statements": [
            {
                "line": step.origin.line or None,
                "number": step.origin.number,
                "text": texts.get(step.origin.line, ""),
                "begun": True,
                "start_s": step.begins_us / 1e6,
                "duration_s": (step.ends_us - step.begins_us) / 1e6,
                "notes": [],
            }
            for step in rehearsal.steps
        ],
        "alarms": [],
        "warnings": [],
        "printed": [],
    }


def _notes(
    project: Project, rehearsal: Rehearsal, found: Iterable[Diagnostic], doubts: Iterable[FileFault]
) -> list[notes.Note]:
    """Return the findings by time; one in the text stands where its line begins, one of another branch has no time."""
    begins: dict[int, float] = {}
    for step in rehearsal.steps:
        begins.setdefault(step.origin.line, step.begins_us / 1e6)
    program, source = file_name(project.source.path), project.source
    made = []
    for item in found:
        note = notes.of_finding(of_diagnostic(item, source), program, begins)
        if isinstance(item, Placed):
            note = replace(note, p=item.p, time_s=None if item.time_us is None else item.time_us / 1e6)
        made.append(note)
    made += [notes.of_finding(of_doubt(doubt), program, begins) for doubt in doubts]
    made += notes.of_estimates(list(project.cell.robot.estimated))
    return notes.in_order(made)
