"""The joint angles at which a place of the tool is reached, as ``MOVEJ`` there finds them. Angles rad, lengths m."""

import numpy as np

from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.project.points import Point
from robolang.values.poses import Place
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.motion.joint_planner import JointPlanner
from runtime.settings.profile import Profile


def joint_planner(around: Surroundings) -> JointPlanner:
    """Return what finds the end of ``MOVEJ``."""
    # the profile decides how fast a move is, and not where it ends
    return JointPlanner(around.cell.robot, around.kinematics, Profile())


def reached(place: Place, around: Surroundings, q: Array) -> Array:
    """Return the joint angles (n,) at which ``MOVEJ`` to a place ends, from q (n,).

    ``Fault`` as of the move: RBL30x for what the cell does not have, RBL410, RBL411 or RBL412 where it is not reached.
    """
    return joint_planner(around).end(q, lowering.joint_move(place, around), around.X_flange_tool)


def reached_point(point: Point, around: Surroundings, q: Array) -> Array:
    """Return the joint angles (n,) at which ``MOVEJ`` to a taught point ends, from q (n,); ``Fault`` as ``reached``."""
    return joint_planner(around).end(q, lowering.point_move(point, around), around.X_flange_tool)


def taught_place(point: Point, around: Surroundings) -> Array:
    """Return X_world_tool (4, 4) of a taught point for the tool in use; ``Fault`` RBL305, RBL307."""
    place = lowering.point_move(point, around).X_world_tool
    assert place is not None  # a point has a pose, taught as joints or not
    return place


def tool_place(q: Array, around: Surroundings) -> Array:
    """Return X_world_tool (4, 4) of the tool in use at joint angles q (n,)."""
    return np.asarray(matmul(around.kinematics.forward(q), around.X_flange_tool))
