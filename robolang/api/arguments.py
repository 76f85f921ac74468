"""Arguments of the functions that ``import robolang`` offers: units of people to SI."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from robolang.core.calls import refuse
from robolang.project.arguments import POSE, numbers
from robolang.project.project import load_any_robot
from runtime.core.faults import Fault
from runtime.core.frames import Array, pose_from_xyzrpy
from runtime.core.units import DEG, MM
from runtime.robot.model.payload import NO_PAYLOAD, Payload, declared
from runtime.robot.model.spec import RobotSpec

PayloadLike = Sequence[float] | float
"""Mass kg, or a list of it and, for a payload that is not at the flange, its centre of gravity x, y, z mm."""


def robot_of(robot: str | Path | RobotSpec) -> RobotSpec:
    """Return a robot: a built-in one by name, that of a file, or a robot as it is; ``Fault`` RBL6xx, RBL708."""
    return robot if isinstance(robot, RobotSpec) else load_any_robot(str(robot))


def joints_of(joints: Sequence[float] | None, robot: RobotSpec, argument: str = "joints") -> Array:
    """Return joints (n,) rad of angles in deg, m of mm where an axis slides; None: 0, or the nearest in the range."""
    if joints is None:
        return np.clip(np.zeros(robot.n), robot.lower, robot.upper)
    return np.array(numbers(joints, argument, [f"J{i + 1}" for i in range(robot.n)])) * robot.units


def pose_of(pose: Sequence[float] | None, argument: str) -> Array:
    """Return a pose (4, 4), m, of x, y, z mm and rx, ry, rz deg; the identity for None."""
    if pose is None:
        return np.eye(4)
    x, y, z, *turns = numbers(pose, argument, POSE)
    return pose_from_xyzrpy([x * MM, y * MM, z * MM, *(turn * DEG for turn in turns)])


def payload_of(payload: PayloadLike | None, robot: RobotSpec, argument: str, *, heavier: bool = True) -> Payload:
    """Return a payload; ``heavier``: it may be over the rated one. None: nothing is carried."""
    if payload is None:
        return NO_PAYLOAD
    # a mass alone hangs at the flange
    listed = (payload,) if isinstance(payload, int | float) else tuple(payload)
    given = (*listed, 0.0, 0.0, 0.0) if len(listed) == 1 else listed
    mass, *cog = numbers(given, argument, ("mass kg", "x mm", "y mm", "z mm"))
    try:
        rated = max(robot.rated_payload, mass) if heavier else robot.rated_payload
        return declared(mass, np.array(cog) * MM, rated)
    except Fault as fault:
        refuse(argument, fault.message)
