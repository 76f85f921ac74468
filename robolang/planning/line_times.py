"""What each line of a rehearsed program takes, and how near its moves come to the limits of the arm."""

from dataclasses import dataclass

import numpy as np

from robolang.execution.dry_run import Rehearsal, RehearsedMove
from robolang.execution.speed_keys import NO_SPEED, of_runs, speed_keys
from robolang.project.project import Project
from robolang.syntax.unparse import describe
from runtime.core.frames import Array
from runtime.core.units import DEG, MM
from runtime.robot.kinematics.singularity import singularities
from runtime.robot.model.spec import OpwParameters, RobotSpec


@dataclass(frozen=True, slots=True, kw_only=True)
class LineTime:
    """What a line of the program takes: how often it ran, its time s, the length of its paths mm, and the name of its
    fastest joint with the share of its speed limit in %; ``margin_deg``: the least distance of a joint from the ends of
    its range, ``margin_mm`` that of one that slides; ``wrist_deg``: how far the wrist is from straight, where it is
    singular, on a path of the tool. The keys of ``speed_keys`` are those of several runs (``of_runs``)."""

    line: int
    number: int | None
    text: str
    count: int
    seconds: float
    length_mm: float | None
    joint: str
    speed_pct: float | None
    margin_deg: float | None
    margin_mm: float | None
    wrist_deg: float | None
    programmed_mm_s: float | None
    reached_mm_s: float | None
    programmed_pct: float | None
    reached_pct: float | None
    highest_mm_s: float | None
    highest_pct: float | None
    limited_by: str | None
    limited_why: str | None


def line_times(project: Project, rehearsal: Rehearsal) -> list[LineTime]:
    """Return what each line takes, in the order of the file."""
    spec = project.cell.robot
    speed = spec.per_axis("limits", "speed")
    opw = rehearsal.kinematics.opw
    rows = []
    for line in project.program.statements:
        if line.source_line not in rehearsal.times_us or line.statement is None:
            continue
        moves = [move for move in rehearsal.moves if move.effect.line == line.source_line]
        joint, share = _fastest(moves, speed, project.profile.period_s) if moves else ("", None)
        margin_deg, margin_mm = _margins(moves, spec)
        rows.append(
            LineTime(
                line=line.source_line,
                number=line.number,
                text=describe(line.statement),
                count=rehearsal.runs[line.source_line],
                seconds=rehearsal.times_us[line.source_line] / 1e6,
                length_mm=_length_mm(moves),
                joint=joint,
                speed_pct=share,
                margin_deg=margin_deg,
                margin_mm=margin_mm,
                wrist_deg=_wrist_deg(opw, moves),
                **of_runs([speed_keys(move.speeds.moves[move.number]) for move in moves] or [NO_SPEED]),
            )
        )
    return rows


def _fastest(moves: list[RehearsedMove], limits: Array, period: float) -> tuple[str, float]:
    """Return the joint that moves fastest for its limit, ``limits`` (n,) rad/s, and its share of that in %."""
    # a move that goes nowhere has one row and no step
    steps = np.max([np.abs(np.diff(move.q, axis=0)).max(axis=0, initial=0.0) for move in moves], axis=0)
    shares = steps / period / limits
    return f"J{int(np.argmax(shares)) + 1}", 100.0 * float(shares.max())


def _length_mm(moves: list[RehearsedMove]) -> float | None:
    """Return the length of all paths of the tool; None: joint moves only."""
    lengths = [move.plan.path.length for move in moves if move.plan.path is not None]
    return sum(lengths) / MM if lengths else None


def _margins(moves: list[RehearsedMove], spec: RobotSpec) -> tuple[float | None, float | None]:
    """Return the least distance of joints from the ends of their ranges: of those that turn, deg, and slide, mm."""
    if not moves:
        return None, None
    each = np.min([np.minimum(move.q - spec.lower, spec.upper - move.q).min(axis=0) for move in moves], axis=0)
    slides = spec.slides
    of = (each[~slides] / DEG, each[slides] / MM)
    turning, sliding = (float(margins.min()) if len(margins) else None for margins in of)
    return turning, sliding


def _wrist_deg(opw: OpwParameters | None, moves: list[RehearsedMove]) -> float | None:
    paths = [move for move in moves if move.plan.path is not None]
    # no closed form, no such measure of its singular postures
    if opw is None or not paths:
        return None
    return float(np.min([singularities(opw, move.q).wrist.min() for move in paths])) / DEG


def range_margin(move: RehearsedMove, spec: RobotSpec) -> tuple[float, int, int]:
    """Return the smallest distance of a joint from the ends of its range, rad or m, its axis and the row.

    Of axes that turn and axes that slide a mm counts as a deg, as in ``RobotSpec.bound``.
    """
    inside = np.minimum(move.q - spec.lower, spec.upper - move.q)
    row, axis = np.unravel_index(int(np.argmin(inside / spec.bound(1.0))), inside.shape)
    return float(inside[row, axis]), int(axis), int(row)
