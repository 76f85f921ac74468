"""A point that is another one with an offset, with the meaning that the offset has in a program.

``+ (x, y, z)`` shifts along the axes of the frame in force, ``* (x, y, z, rx, ry, rz)`` in the tool. A copy keeps kind,
frame, tool, configuration and comment.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from robolang.core.source import Source
from robolang.evaluation.evaluator import Evaluator, Nowhere, World
from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.interpreter.fed_line import fed_line
from robolang.interpreter.scope import Scopes
from robolang.project.points import NAME_HINT, Point, PointStore, can_be_name
from robolang.syntax.ast import Assign
from robolang.teaching.postures import reached, reached_point
from robolang.teaching.taught import Taught, pose_in, rounded, rounded_joints
from robolang.values.poses import Frame, Place
from runtime.core.faults import Fault

_COPY = "COPY_"
"""A name to assign to; nothing is called so, and nothing reads it."""


def copied(
    name: str, old: Point, offset: str, around: Surroundings, *, frame: Frame = "", world: World | None = None
) -> Taught:
    """Return a point with another name, shifted by the text of an offset, such as ``+ (0, 0, 50)``; "": not shifted.

    ``world`` is what the offset may read (``P1.Z``, ``HERE``); its other names are taught points. ``FileFault`` or
    ``Fault`` for a text that is no offset, RBL303 for a name that no point can have, and as ``postures.reached`` for
    joints that the shifted place does not have. A pose out of reach has a note.
    """
    if not can_be_name(name):
        raise Fault("RBL303", f"'{name}' cannot be the name of a point", NAME_HINT)
    # the point may not be in the store: it has been taught since that was read
    around = replace(around, points=PointStore(path=around.points.path, points=_with(old, around.points)))
    place = _place(f"{old.name} {offset}".strip(), around, frame, world or Nowhere())
    copy = old.replaced(name=name)
    if not place.shifts:
        return Taught(point=copy)
    return _shifted_joints(copy, old, place, around) if old.pose is None else _shifted_pose(copy, place, around)


def _with(point: Point, points: PointStore) -> Mapping[str, Point]:
    return {**points.points, point.name.upper(): point}


def _place(text: str, around: Surroundings, frame: Frame, world: World) -> Place:
    """Return the value of an expression over taught points."""
    # as the right side of an assignment: the one parser of the language reads it, and finds its errors
    line = fed_line(Source("offset", f"{_COPY} = {text}"))
    assert isinstance(line.statement, Assign)  # a text that makes it another statement has had its fault
    evaluator = Evaluator(Scopes(around.points.names), world)
    evaluator.frame = frame
    return evaluator.place(line.statement.value)


def _shifted_joints(copy: Point, old: Point, place: Place, around: Surroundings) -> Taught:
    """Return the joints of the shifted place: the posture that is nearest to that of the old point."""
    assert old.joints is not None
    q_old = np.array(old.joints) * around.cell.robot.units
    q = reached(place, around, q_old)
    changes = ", ".join(f"{before} to {after}" for before, after in around.kinematics.changes(q_old, q))
    notes = (f"the configuration changes: {changes}",) if changes else ()
    return Taught(point=copy.replaced(joints=rounded_joints(q, around.cell.robot)), notes=notes)


def _shifted_pose(copy: Point, place: Place, around: Surroundings) -> Taught:
    """Return the pose of the shifted place; joints may turn otherwise there, so it has no turns (``lowering``)."""
    X = lowering.joint_move(place, around).X_world_tool
    assert X is not None  # a place has a pose, joints or not
    point = copy.replaced(pose=rounded(pose_in(copy, X, around)), turns=())
    try:
        reached_point(point, around, around.q_last)
    except Fault as fault:
        return Taught(point=point, notes=(f"it is not reached from here ({fault.code}: {fault.message})",))
    return Taught(point=point)
