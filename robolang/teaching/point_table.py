"""The points of a program in one table: where each is used, and whether the arm reaches it now, and how well.

*Reached* is as ``MOVEJ`` from the present joint angles finds it, under the tool in use. All poses are solved at once,
and the planner chooses among the solutions, or refuses: 500 poses take 0.3 s. An arm without a closed form is solved
pose by pose, 0.1 s each; points that are joints, which is how a new one is taught, take no time there either.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeVar

import numpy as np

from robolang.analysis.analysis import Analysis
from robolang.analysis.symbol_table import SymbolKind
from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.project.points import Point
from robolang.teaching.posture import Posture, postures
from robolang.teaching.postures import joint_planner
from robolang.teaching.taught import Kind, kind_of
from runtime.core.faults import Fault
from runtime.core.frames import Array, inverse, pose, rotation_from_rpy
from runtime.core.linear import matmul
from runtime.core.units import DEG, MM
from runtime.motion.commands import MoveJoint
from runtime.robot.kinematics.kinematics import Kinematics, Solution
from runtime.robot.kinematics.opw import NUMERIC

T = TypeVar("T")


@dataclass(frozen=True, slots=True, kw_only=True)
class PointRow:
    """A point in the table.

    ``lines``: lines of the file in which the program reads it. ``joints`` (n,) deg and ``posture``: where the arm would
    stand; None where it does not reach the point, for the reason of ``fault``. ``configuration``: that of the joints,
    else the words of the point.
    """

    point: Point
    kind: Kind
    configuration: str
    lines: tuple[int, ...]
    joints: tuple[float, ...] | None = None
    posture: Posture | None = None
    fault: Fault | None = None

    @property
    def reachable(self) -> bool:
        """Whether the arm reaches the point now."""
        return self.fault is None


def point_table(around: Surroundings, q: Array, analysis: Analysis | None = None) -> list[PointRow]:
    """Return a row for each point of ``around``, in the order of the file, reached from joint angles q (n,) rad.

    ``analysis`` is that of the program; None: none uses the points.
    """
    points = list(around.points.points.values())
    lines = {} if analysis is None else uses(analysis)
    ends = _ends(points, around, q)
    reached = [end for end in ends if not isinstance(end, Fault)]
    # one evaluation for all rows: each row by itself would take ten times as long
    near = iter(postures(np.array(reached), around.kinematics) if reached else ())
    rows = []
    for point, end in zip(points, ends, strict=True):
        row = PointRow(
            point=point,
            kind=kind_of(point),
            configuration=" ".join(point.configuration),
            lines=lines.get(point.name.upper(), ()),
        )
        rows.append(
            replace(row, fault=end) if isinstance(end, Fault) else _reached(row, end, next(near), around.kinematics)
        )
    return rows


def _reached(row: PointRow, q: Array, near: Posture, kinematics: Kinematics) -> PointRow:
    branch = kinematics.branch_of(q)
    # an arm without branches keeps the words that somebody wrote
    words = row.configuration if branch == NUMERIC else str(branch)
    return replace(row, joints=tuple((q / kinematics.units).tolist()), posture=near, configuration=words)


def uses(analysis: Analysis) -> Mapping[str, tuple[int, ...]]:
    """Return the lines, each once and in order, in which a program reads taught points, by upper-case name."""
    # a point that is taught after the text was checked is still an unknown name there
    kinds = (SymbolKind.POINT, SymbolKind.UNKNOWN)
    place = analysis.source.place
    return {
        symbol.name.upper(): tuple(sorted({place(span.start).line for span in symbol.uses}))
        for symbol in analysis.symbols.symbols
        if symbol.kind in kinds
    }


# --- where the arm would stand ---------------------------------------------------------------------------------------


def _ends(points: Sequence[Point], around: Surroundings, q: Array) -> list[Array | Fault]:
    """Return the joint angles (n,) rad of each point, or why it is not reached."""
    planner = joint_planner(around)
    # a frame or a tool that is missing is the fault of its row alone
    goals = [_attempt(goal) for goal in _goals(points, around)]
    poses = [goal.X_world_tool for goal in goals if isinstance(goal, MoveJoint) and goal.q_end is None]
    solved = iter(_solutions(poses, around, q))

    def end(goal: MoveJoint) -> Array:
        if goal.q_end is not None:
            return planner.end(q, goal, around.X_flange_tool)
        return planner.choose(next(solved), q, goal)

    return [goal if isinstance(goal, Fault) else _attempt(partial(end, goal)) for goal in goals]


def _solutions(X_world_tool: Sequence[Array | None], around: Surroundings, q: Array) -> list[list[Solution]]:
    # a file may hold joints only, and an empty array has no poses
    if not X_world_tool:
        return []
    X = matmul(np.array(X_world_tool), inverse(around.X_flange_tool))
    return around.kinematics.solutions_each(X, q)


def _goals(points: Sequence[Point], around: Surroundings) -> Iterator[Callable[[], MoveJoint]]:
    """Yield what gives the move to each point, or its fault."""
    # at once: one rotation of 500 poses takes as long as that of one
    six = np.array([point.pose or (0.0,) * 6 for point in points]).reshape(-1, 6)
    X = pose(six[:, :3] * MM, rotation_from_rpy(six[:, 3:] * DEG))
    for point, X_pose in zip(points, X, strict=True):
        yield partial(lowering.point_move, point, around, X_pose)


def _attempt(compute: Callable[[], T]) -> T | Fault:
    try:
        return compute()
    except Fault as fault:
        return fault
