"""The direction of a move whose tool makes an exact half turn: both directions are equally short.

Two rotations take the tool there, about one axis to either side (``frames.principal_axes``). The choice is, in this
order,

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
    """A direction with its end q (n,) rad, NaN where there is none; ``fits`` is how much of rule 1 it keeps.

    0: the path leaves a range or the reach; 1: it can be executed; 2: it also ends at the taught angles.
    """

    line: LineSolver
    end: Array
    fits: int


def in_order(lines: Sequence[LineSolver], s: Array, q_end: Array | None) -> list[LineSolver]:
    """Return the solvers of one move, a path for each direction, best first.

    s (N + 1,): path parameter of the samples; q_end (n,) rad: the taught end, None where a pose is taught.
    """
    trials = [_tried(line, s, q_end) for line in lines]
    # the first is the positive turn (rule 3); another one has to be better, not only as good
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
    # the joint nearest to an end of its range decides; alike within SAME_ROOM, so that rounding does not
    room = [np.minimum(each.end - spec.lower, spec.upper - each.end)[differ].min() for each in (trial, best)]
    return bool(room[0] > room[1] + SAME_ROOM)
