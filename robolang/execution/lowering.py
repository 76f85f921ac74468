"""From the units and names of a program to what the controller takes: the one place where mm, deg and % become SI.

An effect of the interpreter and the facts of the project (taught points, cell) give a motion command, a payload or a
waiting time. Errors are ``Fault`` values with a code; the session adds the place in the program.

A place (``robolang.values.poses``) becomes a pose of the tool point in the world:

    taught pose     X_world_frame X_pose, and where it was taught with another tool X inverse(X_taught) X_tool
    taught joints   forward kinematics of them, with the tool in use; the move ends at these very joints
    + (x, y, z)     the point shifted along the axes of the frame that was active
    * (x, ..., rz)  X Trans(x, y, z) Rz Ry Rx: in the tool where it then is
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from robolang.interpreter.effects import MoveTo, SetHand, SetPayload, SetSeam
from robolang.project.points import Point, PointStore
from robolang.project.project import Project
from robolang.values.poses import Frame, Place, Shift, Six
from runtime.cell.cell import CellSpec
from runtime.cell.seam_sensor import SeamSensor
from runtime.core.faults import Fault
from runtime.core.frames import Array, inverse, pose_from_xyzrpy, xyzrpy_from_pose
from runtime.core.limits import DWELL
from runtime.core.linear import matmul
from runtime.core.units import DEG, MM, PERCENT
from runtime.motion.commands import Command, MoveArc, MoveJoint, MoveLinear, MoveSpline
from runtime.motion.seam import SeamTracker
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.drives import beyond_range
from runtime.robot.model.payload import Payload, declared


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What a place depends on: taught points, cell, kinematics, tool in use, and the joints q_last (n,) rad at which
    the motion before ends."""

    points: PointStore
    cell: CellSpec
    kinematics: Kinematics
    X_flange_tool: Array
    q_last: Array


def pose_si(pose_mm_deg: tuple[float, ...]) -> Array:
    """Return the pose (4, 4) in m of (x, y, z, rx, ry, rz) in mm and deg."""
    return pose_from_xyzrpy(np.array(pose_mm_deg) * ([MM] * 3 + [DEG] * 3))


def six_of(X: Array) -> Six:
    """Return (x, y, z, rx, ry, rz) in mm and deg of a pose (4, 4)."""
    x, y, z, rx, ry, rz = (xyzrpy_from_pose(X) / ([MM] * 3 + [DEG] * 3)).tolist()
    return x, y, z, rx, ry, rz


def payload(effect: SetPayload, cell: CellSpec) -> Payload:
    """Return the payload of a LOAD; ``Fault`` RBL305, RBL401, RBL402 or RBL403."""
    if effect.name:
        # effects have names in capitals, and a cell file spells them in any case
        loads = {key.upper(): value for key, value in cell.loads.items()}
        if effect.name not in loads:
            known = ", ".join(sorted(cell.loads)) or "none"
            raise Fault("RBL305", f"the cell has no load {effect.name} (known: {known})")
        load = loads[effect.name]
        return declared(load.mass, load.cog, cell.robot.rated_payload)
    inertia = None
    if effect.inertia_kg_m2:  # products of inertia as elements of the tensor, with their own signs
        xx, yy, zz, xy, xz, yz = effect.inertia_kg_m2
        inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return declared(effect.mass_kg, np.array(effect.cog_mm) * MM, cell.robot.rated_payload, inertia)


def move(effect: MoveTo, around: Surroundings, acceleration: float = 1.0) -> Command:
    """Return the motion command of a move; ``Fault`` RBL30x or RBL40x.

    ``acceleration`` is that of a move without ACCEL (``Profile.acceleration``).
    """
    goal = _goal(effect.target, around)
    options: dict[str, Any] = {
        "X_world_tool": goal.X,
        "q_end": goal.q_end,
        "configuration": goal.configuration,
        "turns": goal.turns,
        "acceleration": acceleration if effect.accel_pct is None else effect.accel_pct * PERCENT,
        "duration": effect.time_s,
        "zone": effect.zone_mm * MM,
        "override": effect.override_pct * PERCENT,
    }
    if effect.path == "joint":
        return MoveJoint(speed=(100.0 if effect.speed_pct is None else effect.speed_pct) * PERCENT, **options)
    options["speed"] = None if effect.speed_mm_s is None else effect.speed_mm_s * MM
    options["wrist"], options["held"] = effect.wrist, effect.held
    through = tuple(_goal(place, around).X for place in effect.via)
    if effect.path == "arc":
        return MoveArc(X_via=through[0], **options)
    return MoveSpline(X_through=through, **options) if effect.path == "spline" else MoveLinear(**options)


def joint_move(place: Place, around: Surroundings) -> MoveJoint:
    """Return the command of ``MOVEJ`` to a place, without options; ``Fault`` as of ``move``."""
    return _joint_move(_goal(place, around))


def point_move(point: Point, around: Surroundings, X: Array | None = None) -> MoveJoint:
    """Return the command of ``MOVEJ`` to a taught point, in the store of ``around`` or not; ``Fault`` RBL305, RBL307.

    X (4, 4): its pose in its frame, where that has been computed for many points at once.
    """
    return _joint_move(_at_point(point, around, X))


def _joint_move(goal: "_Goal") -> MoveJoint:
    return MoveJoint(q_end=goal.q_end, X_world_tool=goal.X, configuration=goal.configuration, turns=goal.turns)


def components(place: Place, frame: Frame, around: Surroundings) -> Six:
    """Return a place in a frame, mm and deg; ``Fault`` as of ``move``."""
    return six_of(matmul(inverse(frame_pose(frame, around.cell)), _goal(place, around).X))


def frame_pose(frame: Frame, cell: CellSpec) -> Array:
    """Return X_world_frame (4, 4) of a FRAME: a frame of the cell or a pose; ``Fault`` RBL305."""
    if isinstance(frame, str):
        return _named(cell.frames, frame, "frame") if frame else np.eye(4)
    return pose_si(frame)


def tool(choice: Frame, cell: CellSpec) -> Array:
    """Return X_flange_tool (4, 4) of a TOOL: a tool of the cell or a pose; ``Fault`` RBL305."""
    return _named(cell.tools, choice, "tool") if isinstance(choice, str) else pose_si(choice)


def target(point: Point, cell: CellSpec, kinematics: Kinematics) -> Array:
    """Return X_world_tool (4, 4) of a taught point with the hand's tool; ``Fault`` RBL305, RBL307."""
    return _taught(
        point,
        Surroundings(
            # not read: the point itself is given
            points=PointStore(path=""),
            cell=cell,
            kinematics=kinematics,
            X_flange_tool=cell.hand.X_flange_tool,
            q_last=cell.home,
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Goal:
    """Where a move ends, and how where the point says so."""

    X: Array
    q_end: Array | None = None
    configuration: tuple[str, ...] = ()
    turns: tuple[int, ...] = ()


def _goal(place: Place, around: Surroundings) -> _Goal:
    goal = _base(place, around)
    if not place.shifts:
        return goal
    X = goal.X
    for shift in place.shifts:
        X = _shifted(X, shift, around.cell)
    return replace(goal, X=X, q_end=None, turns=())  # a shifted point may be reached with other angles


def _base(place: Place, around: Surroundings) -> _Goal:
    if place.point:
        point = around.points.get(place.point)
        if point is None:
            raise Fault("RBL301", f"point {place.point} is not taught in {around.points.path}")
        return _at_point(point, around)
    if place.joints is not None:
        if len(place.joints) != around.cell.robot.n:
            raise Fault("RBL307", f"JOINT has {len(place.joints)} values, the robot {around.cell.robot.n} axes")
        beyond = beyond_range(place.joints, [axis.limits for axis in around.cell.robot.axes])
        if beyond:
            raise Fault("RBL309", beyond)
        q = np.array(place.joints) * around.cell.robot.units
        return _Goal(X=_forward(q, around), q_end=q)
    if place.last:
        return _Goal(X=_forward(around.q_last, around))
    assert place.pose is not None
    return _Goal(X=matmul(frame_pose(place.frame, around.cell), pose_si(place.pose)))


def _forward(q: Array, around: Surroundings) -> Array:
    return np.asarray(matmul(around.kinematics.forward(q), around.X_flange_tool))


def _at_point(point: Point, around: Surroundings, X: Array | None = None) -> _Goal:
    # first: it refuses joints of another arm
    X = _taught(point, around, X)
    joints = None if point.joints is None else np.array(point.joints) * around.cell.robot.units
    return _Goal(X=X, q_end=joints, configuration=point.configuration, turns=point.turns)


def _taught(point: Point, around: Surroundings, X: Array | None = None) -> Array:
    """Return X_world_tool of a taught point; X: its pose, where it is known.

    A pose stands in its frame (the world without one) and belongs to the tool it was taught with; joint angles give
    the pose of the tool in use, and are where the move ends.
    """
    cell = around.cell
    if point.joints is not None:
        if len(point.joints) != cell.robot.n:
            raise Fault("RBL307", f"point {point.name} has {len(point.joints)} joints, the robot {cell.robot.n}")
        return _forward(np.array(point.joints) * cell.robot.units, around)
    assert point.pose is not None  # the store admits exactly one of the two
    X = pose_si(point.pose) if X is None else X
    if point.frame:
        X = matmul(_named(cell.frames, point.frame, f"frame of point {point.name}"), X)
    if point.tool:
        # the flange goes where it stood when the point was taught, and another tool ends where that puts it
        X_flange_taught = _named(cell.tools, point.tool, f"tool of point {point.name}")
        X = matmul(X, inverse(X_flange_taught), around.X_flange_tool)
    return np.asarray(X)


def _shifted(X: Array, shift: Shift, cell: CellSpec) -> Array:
    # here and not in the checker: the offset may be calculated while the program runs
    if not all(map(math.isfinite, shift.by)):
        raise Fault("RBL502", "an offset is not finite")
    if shift.kind == "tool":
        return np.asarray(matmul(X, pose_si(shift.by)))
    found = np.array(X)
    # an offset is a direction: of the frame only the rotation counts, not where it lies
    found[:3, 3] += matmul(frame_pose(shift.frame, cell)[:3, :3], np.array(shift.by[:3]) * MM)
    return found


def _named(table: Mapping[str, Array], name: str, what: str) -> Array:
    entries = {key.upper(): value for key, value in table.items()}
    if name.upper() not in entries:
        known = ", ".join(sorted(entries)) or "none"
        raise Fault("RBL305", f"the {what} is '{name}', which the cell does not have (known: {known})")
    return entries[name.upper()]


def dwell_s(effect: SetHand, cell: CellSpec) -> float:
    """Return the waiting time of a HAND statement, s; ``Fault`` RBL405."""
    return DWELL.checked(cell.hand.dwell if effect.dwell_s is None else effect.dwell_s)


def tracker(effect: SetSeam, project: Project) -> SeamTracker | None:
    """Return a tracker of the sensor of a cell that SEAM ON names, None for SEAM OFF."""
    if effect.sensor is None:
        return None
    # a program spells names in any case, and effects have them in capitals
    spec = {name.upper(): each for name, each in project.cell.sensors.items()}[effect.sensor]
    return SeamTracker(effect.sensor, spec.limits, project.profile.period_s, SeamSensor(spec).read)
