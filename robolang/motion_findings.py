"""What a rehearsal shows beyond refusals: collisions with the cell, joints at the end of their range, a cycle too long.

Each set-point of a rehearsal, 8 ms apart, is looked at in the shapes that MuJoCo has of the cell, without physics: what
of the arm would be in the floor or in an obstacle (RBL421). Parts are not looked at: which of them are where is for a
run. A joint that comes nearer than ``NEAR`` to the end of its range is RBL422; a program that takes longer than it may
is RBL423. Places are those of the statements.
"""

from dataclasses import dataclass

import numpy as np

from robolang.diagnostics import Diagnostic, Severity
from robolang.motion_check import Rehearsal, RehearsedMove
from robolang.printer import describe
from robolang.project import Project
from robolang.source import Span
from runtime.plant.mujoco_plant import MujocoPlant
from runtime.units import DEG, MM

NEAR = 0.5 * DEG
"""A joint nearer than this to the end of its range is named, rad."""

@dataclass(frozen=True, slots=True, kw_only=True)
class LineTime:
    """What a line of the program takes: how often it ran, its time s, its way mm, and the joint that is fastest on it,
    by name and share of its speed limit in %."""

    line: int
    number: int | None
    text: str
    count: int
    seconds: float
    length_mm: float | None
    joint: str
    speed_pct: float | None
    margin_deg: float | None


def findings(project: Project, rehearsal: Rehearsal, max_cycle_s: float | None = None) -> tuple[Diagnostic, ...]:
    """Return what is wrong with the motion of a program, one finding of a code for a statement."""
    found = [*rehearsal.refused, *_collisions(project, rehearsal), *_near_limits(project, rehearsal)]
    total = rehearsal.total_us / 1e6
    if max_cycle_s is not None and not total <= max_cycle_s and not rehearsal.refused:
        message = f"the program takes {total:.3f} s, {total - max_cycle_s:.3f} s more than {max_cycle_s:g} s"
        found.append(Diagnostic(code="RBL423", message=message, span=Span(0, 0)))
    return tuple(found)


def _collisions(project: Project, rehearsal: Rehearsal) -> list[Diagnostic]:
    shapes = MujocoPlant(project.cell.robot, project.cell, project.profile.tick_s)
    found: dict[Span, Diagnostic] = {}
    for move in rehearsal.moves:
        span = move.effect.span
        if span in found:
            continue
        for row, q in enumerate(move.plan.q):
            touch = shapes.touching(q)
            if touch is not None:
                share = 100.0 * float(move.plan.s[row])
                message = f"at {share:.1f} % of the way {touch[0]} would be in {touch[1].removeprefix('obstacle:')}"
                found[span] = Diagnostic(code="RBL421", message=message, span=span)
                break
    return list(found.values())


def _near_limits(project: Project, rehearsal: Rehearsal) -> list[Diagnostic]:
    spec = project.cell.robot
    found: dict[Span, Diagnostic] = {}
    for move in rehearsal.moves:
        margin, axis, row = _margin(move, spec.lower, spec.upper)
        if margin < NEAR and move.effect.span not in found:
            share, at = 100.0 * float(move.plan.s[row]), float(move.plan.q[row, axis]) / DEG
            ends = f"{spec.lower[axis] / DEG:g} to {spec.upper[axis] / DEG:g} deg"
            message = (f"at {share:.1f} % of the way J{axis + 1} is at {at:.2f} deg, {margin / DEG:.2f} deg from an "
                       f"end of its range {ends}")  # fmt: skip
            found[move.effect.span] = Diagnostic(code="RBL422", severity=Severity.WARNING, message=message,
                                                 span=move.effect.span)  # fmt: skip
    return list(found.values())


def _margin(move: RehearsedMove, lower: object, upper: object) -> tuple[float, int, int]:
    """Return the smallest distance of a joint from the ends of its range, rad, its axis and the row."""
    inside = np.minimum(move.plan.q - np.asarray(lower), np.asarray(upper) - move.plan.q)
    row, axis = np.unravel_index(int(np.argmin(inside)), inside.shape)
    return float(inside[row, axis]), int(axis), int(row)


def line_times(project: Project, rehearsal: Rehearsal) -> list[LineTime]:
    """Return what each line takes, in the order of the file."""
    spec = project.cell.robot
    speed = spec.per_axis("limits", "speed")
    rows = []
    for line in project.program.statements:
        if line.source_line not in rehearsal.times_us or line.statement is None:
            continue
        moves = [move for move in rehearsal.moves if move.effect.line == line.source_line]
        joint, share, margin, length = "", None, None, None
        if moves:
            shares = np.max([np.abs(np.diff(move.plan.q, axis=0)).max(axis=0, initial=0.0) for move in moves], axis=0)
            shares = shares / project.profile.period_s / speed
            joint, share = f"J{int(np.argmax(shares)) + 1}", 100.0 * float(shares.max())
            margin = min(_margin(move, spec.lower, spec.upper)[0] for move in moves) / DEG
            lengths = [move.plan.path.length for move in moves if move.plan.path is not None]
            length = sum(lengths) / MM if lengths else None
        rows.append(LineTime(
            line=line.source_line, number=line.number, text=describe(line.statement), count=max(1, len(moves)),
            seconds=rehearsal.times_us[line.source_line] / 1e6, length_mm=length, joint=joint, speed_pct=share,
            margin_deg=margin,
        ))  # fmt: skip
    return rows
