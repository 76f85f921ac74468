"""From the units and names of a program to what the controller takes: the one place where mm, deg and % become SI.

An effect of the interpreter and the facts of the project (taught points, cell) give a motion command, a payload or a
waiting time. Errors are ``Fault`` values with a code; the session adds the place in the program.
"""

from collections.abc import Mapping
from typing import cast

import numpy as np

from robolang.effects import MoveTo, SetHand, SetPayload
from robolang.points import Point, PointStore
from runtime.faults import Fault
from runtime.frames import Array, inverse, pose_from_xyzrpy
from runtime.motion.commands import Component, MoveLinear, Wrist
from runtime.motion.speed import MAX_DURATION
from runtime.plant.cell import CellSpec
from runtime.robot.kinematics import Kinematics
from runtime.robot.payload import Payload, declared
from runtime.units import DEG, MM, PERCENT


def pose_si(pose_mm_deg: tuple[float, ...]) -> Array:
    """Return the pose (4, 4) in m of (x, y, z, rx, ry, rz) in mm and deg."""
    return pose_from_xyzrpy(np.array(pose_mm_deg) * ([MM] * 3 + [DEG] * 3))


def payload(effect: SetPayload, cell: CellSpec) -> Payload:
    """Return the payload of a LOAD; ``Fault`` RBL401, RBL402 or RBL403."""
    return declared(effect.mass_kg, np.array(effect.cog_mm) * MM, cell.robot.rated_payload)


def move(effect: MoveTo, points: PointStore, cell: CellSpec, kinematics: Kinematics) -> MoveLinear:
    """Return the straight move of a MOVE; ``Fault`` RBL301 when its point is not taught."""
    point = points.get(effect.point)
    if point is None:
        raise Fault("RBL301", f"point {effect.point} is not taught in {points.path}")
    return MoveLinear(
        X_world_tool=target(point, cell, kinematics),
        q_end=None if point.joints is None else np.array(point.joints) * DEG,
        configuration=point.configuration,
        turns=point.turns,
        wrist=cast("Wrist | None", effect.wrist),
        held=cast("tuple[Component, ...]", effect.held),
        speed=None if effect.speed_mm_s is None else effect.speed_mm_s * MM,
        acceleration=1.0 if effect.accel_pct is None else effect.accel_pct * PERCENT,
        duration=effect.time_s,
    )


def target(point: Point, cell: CellSpec, kinematics: Kinematics) -> Array:
    """Return X_world_tool (4, 4) of a taught point; ``Fault`` RBL310 or RBL305 when the cell cannot place it.

    A pose stands in its frame (the world without one) and belongs to the tool it was taught with; joint angles give
    the pose of the tool in use, and are where the move ends.
    """
    if point.joints is not None:
        if len(point.joints) != cell.robot.n:
            raise Fault("RBL307", f"point {point.name} has {len(point.joints)} joints, the robot {cell.robot.n}")
        return np.asarray(kinematics.forward(np.array(point.joints) * DEG) @ cell.hand.X_flange_tool)
    assert point.pose is not None  # the store admits exactly one of the two
    X = pose_si(point.pose)
    if point.frame:
        X = _named(cell.frames, point.frame, f"frame of point {point.name}") @ X
    if point.tool:
        X_flange_taught = _named(cell.tools, point.tool, f"tool of point {point.name}")
        X = X @ inverse(X_flange_taught) @ cell.hand.X_flange_tool
    return np.asarray(X)


def _named(table: Mapping[str, Array], name: str, what: str) -> Array:
    entries = {key.upper(): value for key, value in table.items()}
    if name.upper() not in entries:
        known = ", ".join(sorted(entries)) or "none"
        raise Fault("RBL305", f"the {what} is '{name}', which the cell does not have (known: {known})")
    return entries[name.upper()]


def dwell_s(effect: SetHand, cell: CellSpec) -> float:
    """Return the waiting time of a HAND statement, s; ``Fault`` RBL405."""
    seconds = cell.hand.dwell if effect.dwell_s is None else effect.dwell_s
    if not 0.0 <= seconds <= MAX_DURATION:
        raise Fault("RBL405", f"a dwell of {seconds:g} s is not between 0 and {MAX_DURATION:g} s")
    return seconds
