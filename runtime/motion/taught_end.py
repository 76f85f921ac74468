"""The joint angles at which a move may end: those that are taught, or those that its point leaves open.

A point is taught as joint angles, which are then the end, turns and all, or as a pose. A pose has several solutions:
configuration words and turns narrow them down, and the rest is yielded nearest first. Called by the planners of all
moves before anything moves; angles rad.
"""

from collections.abc import Iterator

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import HALF_TURN, Array, inverse, is_half_turn
from runtime.core.linear import matmul
from runtime.motion.commands import MoveJoint, PathMove, in_configuration
from runtime.motion.path_ik import LineSolver
from runtime.robot.kinematics.frozen_wrist import WRIST_AXES
from runtime.robot.kinematics.kinematics import LIMIT_ROUNDING, Kinematics


def ends(line: LineSolver, q: Array, command: PathMove) -> Iterator[Array]:
    """Yield the joint angles (n,) at which a move along a path may end.

    q (N + 1, n): the path in the configuration of its start. Of a taught pose the end in that configuration comes
    first, then the others that such a move can reach, arm and elbow as they are, those first to which the wrist turns
    least; none where the pose is out of reach. ``Fault`` RBL412 when the point names another arm or elbow, or turns
    that no solution has.
    """
    if command.q_end is not None:
        _check_configuration(line, command.q_end)
        yield np.array(command.q_end)
        return
    kept = bool(np.isfinite(q[-1]).all())
    fits = kept and as_taught(line.arm.kinematics, q[-1], command)
    if fits:
        yield q[-1]  # nearly always the one that is taken: the others are computed only when this one is refused
    others = _others(line, command)
    fitting = [end for end in others if as_taught(line.arm.kinematics, end, command)]
    yield from fitting
    # an end that is out of reach altogether is left to the path, whose refusal names the place where it is lost
    if (kept or others) and not (fits or fitting):
        raise _reached_by_none(line, command)


def _reached_by_none(line: LineSolver, command: PathMove) -> Fault:
    words = " ".join(command.configuration) or f"with turns {list(command.turns)}"
    return Fault("RBL412", f"the end is taught {words}, the move starts {line.branch}: no {line.path.move} reaches it")


def _check_configuration(line: LineSolver, q_end: Array) -> None:
    """Refuse taught end angles (n,) in another configuration of the arm than that of the start; ``Fault`` RBL412.

    Between two configurations of arm or elbow the arm passes a singularity of its main axes, where no position-only
    solve helps: the method of the wrist is for J5 alone.
    """
    there = line.arm.kinematics.branch_of(q_end)
    if (there.arm, there.elbow) != (line.branch.arm, line.branch.elbow):
        raise Fault(
            "RBL412",
            f"the end is taught {there}, the move starts {line.branch}: a {line.path.move} "
            "cannot change the configuration of the arm",
            "Teach the end in the arm configuration of the start, or go there over a via point; WRIST KEEP ends in the "
            "configuration of the start.",
        )


def _others(line: LineSolver, command: PathMove) -> list[Array]:
    """Return the solutions (n,) of the end in the configuration of arm and elbow, those nearest to the start first."""
    kinematics = line.arm.kinematics
    X_end = matmul(line.path.X_end, inverse(line.arm.X_flange_tool))
    turns = command.turns[: kinematics.n]
    found = [
        turned(kinematics, each.q, turns, line.q_start)
        for each in kinematics.solutions(X_end, line.q_start)
        if (each.branch.arm, each.branch.elbow) == (line.branch.arm, line.branch.elbow)
    ]
    found = [end for end in found if kinematics.limit_margin(end) >= -LIMIT_ROUNDING]
    found.sort(key=lambda end: float(np.abs(end - line.q_start)[-WRIST_AXES:].max()))
    return found


def turned(kinematics: Kinematics, q: Array, turns: tuple[int, ...], near: Array) -> Array:
    """Return joint angles (..., n) rad with the whole turns that a point is taught with, one number a joint.

    180 and -180 deg are the same angle with the same number of turns: the one nearer to ``near`` (n,) is taken.
    """
    if not turns:
        return q
    # joints without taught turns count from 0 here and are put back at the end
    middle = 2.0 * np.pi * np.array([*turns, *[0] * (q.shape[-1] - len(turns))])
    within = kinematics.nearest_turns(q, middle)
    half = is_half_turn(within - middle)
    either = kinematics.freer_half_turn(kinematics.nearest_turns(q, near), near)
    sides = np.sort([within, within - np.copysign(2.0 * np.pi, within - middle)], axis=0)
    within = np.where(half, np.clip(either, *sides), within)
    return np.concatenate([within[..., : len(turns)], q[..., len(turns) :]], axis=-1)


def as_taught(kinematics: Kinematics, q: Array, command: PathMove | MoveJoint) -> bool:
    """Return whether joint angles (n,) rad have the configuration and the turns that the end of a move is taught with.

    A joint has k turns within half a turn of k revolutions, the half turn itself included (``HALF_TURN`` for rounding).
    """
    turns = np.array(command.turns[: len(q)], dtype=np.float64)
    fits = in_configuration(kinematics.branch_of(q), command.configuration)
    return fits and bool((np.abs(q[: len(turns)] - 2.0 * np.pi * turns) <= np.pi + HALF_TURN).all())
