"""Which direction a move takes whose tool makes an exact half turn: both are equally short.

Two rotations take the tool there, about one axis to either side (``frames.principal_axes``). Taken is, in this order,

    1  the one that keeps every joint within its range, without the wrist leaving the posture of the path, and that ends
       in the taught joint angles where there are some
    2  the one that ends farther from the ends of the ranges; only joints in which the two ends differ are compared
    3  the one that is positive about the tool

So a loop over a pallet turns the same in every row, whatever rounding does to its poses (docs/decisions/0030). Called
by the planner of runs, dry runs and pulse tables, for such moves only. Angles rad.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.path_ik import LineSolver
from runtime.motion.wrist.switch import SAME_ANGLES
from runtime.robot.kinematics.kinematics import SAME_ROOM


@dataclass(frozen=True, slots=True, kw_only=True)
class _Trial:
    """A direction as tried: its end q (n,) rad, NaN where there is none; ``fits`` counts what of rule 1 it keeps."""

    line: LineSolver
    end: Array
    fits: int


def in_order(lines: Sequence[LineSolver], s: Array, q_end: Array | None) -> list[LineSolver]:
    """Return the solvers of one move, a path for each direction, in the order in which they are to be tried.

    s (N + 1,): path parameter of the samples; q_end (n,) rad: the taught end, None where a pose is taught.
    """
    trials = [_tried(line, s, q_end) for line in lines]
    best = trials[0]
    for trial in trials[1:]:
        if _is_better(trial, best):
            best = trial
    return [best.line, *(trial.line for trial in trials if trial is not best)]


def _tried(line: LineSolver, s: Array, q_end: Array | None) -> _Trial:
    end = line.rows(s)[-1]
    try:
        line.joints(s)
    except Fault:
        return _Trial(line=line, end=end, fits=0)
    arrives = q_end is None or bool(np.abs(end - q_end).max() <= SAME_ANGLES)
    return _Trial(line=line, end=end, fits=2 if arrives else 1)


def _is_better(trial: _Trial, best: _Trial) -> bool:
    if trial.fits != best.fits:
        return trial.fits > best.fits
    spec = trial.line.arm.spec
    differ = ~(np.abs(trial.end - best.end) <= SAME_ROOM)
    if not differ.any():
        return False
    room = [np.minimum(each.end - spec.lower, spec.upper - each.end)[differ].min() for each in (trial, best)]
    return bool(room[0] > room[1] + SAME_ROOM)
