"""Forward and inverse kinematics in mm and deg."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from robolang.api.arguments import joints_of, pose_of, robot_of
from robolang.core.calls import checked
from runtime.core.frames import Array, xyzrpy_from_pose
from runtime.core.frames import inverse as inverted
from runtime.core.linear import matmul
from runtime.core.units import DEG, MM
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.spec import RobotSpec


class Pose(NamedTuple):
    """A pose: position mm, and turns about the fixed x, y and z axes in this order, deg."""

    x: float
    y: float
    z: float
    rx: float
    ry: float
    rz: float


@dataclass(frozen=True, slots=True, kw_only=True)
class JointSolution:
    """Joints of a pose, deg, mm of an axis that slides; ``margin_deg``: distance of the nearest joint from its limit,
    negative outside, a mm of an axis that slides counted as a deg."""

    joints: tuple[float, ...]
    branch: str
    margin_deg: float


@checked
def forward(robot: str | Path | RobotSpec, joints: Sequence[float], *, tool: Sequence[float] | None = None) -> Pose:
    """Return the pose of the tool in the base at joints, deg, of an axis that slides mm.

    ``tool``: x, y, z mm and rx, ry, rz deg in the flange; None: the flange. ``Fault`` RBL703 for a wrong argument,
    RBL6xx for a file.
    """
    spec = robot_of(robot)
    X = matmul(Kinematics(spec).forward(joints_of(joints, spec)), pose_of(tool, "tool"))
    return Pose(*_plain(xyzrpy_from_pose(X) / ([MM] * 3 + [DEG] * 3)))


@checked
def inverse(
    robot: str | Path | RobotSpec, pose: Sequence[float], *, tool: Sequence[float] | None = None
) -> list[JointSolution]:
    """Return the joint angles that put the tool at a pose in the base, the ones farthest from the limits first.

    An empty list: the pose is out of reach. ``pose`` and ``tool``: x, y, z mm and rx, ry, rz deg. Of each solution one
    turn is given, that in the range; ``Fault`` as ``forward``.
    """
    kinematics = Kinematics(robot_of(robot))
    X = matmul(pose_of(pose, "pose"), inverted(pose_of(tool, "tool")))
    slides = kinematics.turning == 0.0
    found = sorted(kinematics.solutions(X), key=lambda each: -each.limit_margin)
    return [
        JointSolution(
            joints=tuple(_plain(np.where(slides, each.q / kinematics.units, np.rad2deg(each.q)))),
            branch=str(each.branch),
            margin_deg=float(np.rad2deg(each.limit_margin)),
        )
        for each in found
    ]


def _plain(values: Array) -> list[float]:
    # no negative zeros
    return [float(value) + 0.0 for value in values]
