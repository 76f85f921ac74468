"""A point made of where the arm stands, so that the program that reads it brings the arm back there.

The *commanded* joint angles are taught, not the felt ones: those lag by the yield of the gears and by what friction
holds, and a program commands. A point is taught

    as joints   the angles themselves: the posture, whatever tool and frame are in use later
    as a pose   the tool in the frame, with configuration and turns; the tool by its name, where it has one

A new point is a pose where a frame of the cell is in force, since whoever works in a frame needs points that follow it,
and joints elsewhere (docs/decisions/0048). A point that is taught anew keeps its kind, frame, tool and comment. Values
have three decimals of mm and four of deg, and more where only these bring the same joint angles back.
"""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.project.points import NAME_HINT, Point, can_be_name
from robolang.teaching.points_document import DEG_DIGITS, MM_DIGITS
from robolang.teaching.postures import reached_point, tool_place
from robolang.teaching.toml_text import MOST_DIGITS
from robolang.values.poses import Frame, Six
from runtime.core.faults import Fault
from runtime.core.frames import Array, inverse
from runtime.core.linear import matmul
from runtime.core.units import DEG
from runtime.robot.kinematics.opw import NUMERIC, TURN
from runtime.robot.model.drives import beyond_range
from runtime.robot.model.spec import RobotSpec

Kind: TypeAlias = Literal["joints", "pose"]

DIGITS = (MM_DIGITS, DEG_DIGITS)
"""Decimals of a taught value, mm and deg: finer than any arm repeats, and short enough to read."""
MORE_DIGITS = ((6, 7), (MOST_DIGITS, MOST_DIGITS))
"""Decimals that are tried next, where the joint angles would differ: beside a limit and beside a singularity."""
SAME = 0.1 * DEG
"""Joint angles that differ by less, rad, are the same posture: what these decimals leave open near a singularity."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Taught:
    """A point, and what whoever teaches it should know about it."""

    point: Point
    notes: tuple[str, ...] = ()


def taught_point(
    name: str, as_: Kind | None, q: Array, around: Surroundings, *, frame: Frame = "", old: Point | None = None
) -> Taught:
    """Return the point of joint angles q (n,) rad, for the tool of ``around`` and the frame in force.

    ``as_`` None: the kind of ``old``, else by the frame, as the module says. ``old`` is the point that is taught anew.
    ``Fault`` RBL303 for a name that no point can have, RBL305 for a frame or a tool of ``old`` that the cell lacks,
    RBL307 and RBL309 for joint angles that the robot does not have.
    """
    _check_name(name)
    _check_joints(q, around.cell.robot)
    named, notes = (old.frame, ()) if old is not None and old.pose is not None else _named_frame(frame, around)
    kind = as_ or (kind_of(old) if old is not None else "pose" if named else "joints")
    comment = "" if old is None else old.comment
    if kind == "joints":
        joints = rounded_joints(q, around.cell.robot)
        return Taught(point=Point(name=name, joints=joints, comment=comment))
    if old is not None and old.pose is not None:
        tool = old.tool
    else:
        tool, about_tool = _named_tool(around)
        notes += about_tool
    point = Point(name=name, pose=(0.0,) * 6, frame=named, tool=tool, comment=comment)
    point = point.replaced(configuration=_configuration(q, around), turns=_turns(q, around))
    return _as_pose(point, q, around, notes)


def kind_of(point: Point) -> Kind:
    """Return how a point is taught."""
    return "joints" if point.pose is None else "pose"


def _check_name(name: str) -> None:
    if not can_be_name(name):
        raise Fault("RBL303", f"'{name}' cannot be the name of a point", NAME_HINT)


def _check_joints(q: Array, robot: RobotSpec) -> None:
    if q.shape != (robot.n,):
        raise Fault("RBL307", f"{q.size} joint angles are given, the robot has {robot.n} axes")
    beyond = beyond_range((q / robot.units).tolist(), [axis.limits for axis in robot.axes])
    if beyond:
        raise Fault("RBL309", beyond)


# --- what is in force ------------------------------------------------------------------------------------------------


def _named_frame(frame: Frame, around: Surroundings) -> tuple[str, tuple[str, ...]]:
    """Return the frame in force as the cell spells it, "" for the world; a frame without a name cannot be written."""
    if not isinstance(frame, str):
        return "", ("the frame in force has no name in the cell: the point is taught in the world",)
    if frame.upper() in ("", "WORLD"):
        return "", ()
    lowering.frame_pose(frame, around.cell)  # refuses a frame that the cell does not have
    return next(name for name in around.cell.frames if name.upper() == frame.upper()), ()


def _named_tool(around: Surroundings) -> tuple[str, tuple[str, ...]]:
    """Return the tool in use as the cell spells it, "" for that of the hand, which programs begin with."""
    cell, X = around.cell, around.X_flange_tool
    if np.array_equal(X, cell.hand.X_flange_tool):
        return "", ()
    for name, X_named in cell.tools.items():
        if np.array_equal(X, X_named):
            return name, ()
    return "", ("the tool in use has no name in the cell: the point is the place of its tip, for any tool",)


# --- posture ---------------------------------------------------------------------------------------------------------


def _configuration(q: Array, around: Surroundings) -> tuple[str, ...]:
    branch = around.kinematics.branch_of(q)
    return () if branch == NUMERIC else tuple(str(branch).split())


def _turns(q: Array, around: Surroundings) -> tuple[int, ...]:
    """Return the whole turns of the joints, as far as one has a range in which an angle comes twice."""
    robot = around.cell.robot
    # of other joints the range decides, and a number that says the same is only more to read
    several = np.flatnonzero(around.kinematics.turning * (robot.upper - robot.lower) >= TURN)
    count = int(several[-1]) + 1 if len(several) else 0
    return tuple(int(turns) for turns in np.round(q / TURN)[:count])


def rounded(pose: Six, digits: tuple[int, int] = DIGITS) -> Six:
    """Return a pose, mm and deg, with so many decimals."""
    x, y, z, rx, ry, rz = (_plain(value, digits[axis >= 3]) for axis, value in enumerate(pose))
    return x, y, z, rx, ry, rz


def rounded_joints(q: Array, robot: RobotSpec) -> tuple[float, ...]:
    """Return joints q (n,) rad, m in deg, mm with the decimals of a point, none of them rounded out of its range."""
    # an end of a range may have more decimals than a point
    scale = 10.0**DEG_DIGITS
    least, most = (
        np.ceil(robot.lower / robot.units * scale) / scale,
        np.floor(robot.upper / robot.units * scale) / scale,
    )
    nearest = np.round(q / robot.units, DEG_DIGITS)
    return tuple(_plain(value, DEG_DIGITS) for value in np.clip(nearest, least, most))


def _plain(value: float, digits: int) -> float:
    # adding zero turns a rounded -0.0 into 0.0
    return round(float(value), digits) + 0.0


# --- as a pose -------------------------------------------------------------------------------------------------------


def pose_in(point: Point, X_world_tool: Array, around: Surroundings) -> Six:
    """Return the pose, mm and deg, that a point needs in its frame and for its tool so that the tool in use stands at
    X_world_tool (4, 4); ``Fault`` RBL305."""
    # the inverse of what ``lowering`` does with a point: the flange stands where it stands, whatever tool is in use
    X = matmul(inverse(lowering.frame_pose(point.frame, around.cell)), X_world_tool)
    if point.tool:
        X = matmul(X, inverse(around.X_flange_tool), lowering.tool(point.tool, around.cell))
    return lowering.six_of(X)


def _as_pose(point: Point, q: Array, around: Surroundings, notes: tuple[str, ...]) -> Taught:
    """Return the point with the pose of q (n,) rad, with as many decimals as bring the arm back to q."""
    exact = pose_in(point, tool_place(q, around), around)
    doubts: list[str] = []
    for digits in (DIGITS, *MORE_DIGITS):
        taught = point.replaced(pose=rounded(exact, digits))
        doubt = _read_back(taught, q, around)
        if not doubt:
            return Taught(point=taught, notes=notes)
        doubts.append(doubt)
    # more decimals do not help: the first are as good as any
    return Taught(point=point.replaced(pose=rounded(exact)), notes=(*notes, doubts[0]))


def _read_back(point: Point, q: Array, around: Surroundings) -> str:
    """Return by what a move to the point, from home or from q (n,) rad itself, ends elsewhere; empty: it does not."""
    for start in (around.cell.home, q):
        try:
            apart = np.abs(reached_point(point, around, np.asarray(start)) - q)
        except Fault as fault:
            return f"as a pose it is not reached again ({fault.code}: {fault.message}); teach it as joints"
        robot = around.cell.robot
        axis = int(np.argmax(apart / robot.units))
        if not apart[axis] <= robot.bound(SAME)[axis]:
            off = robot.axes[axis].kind.text(apart[axis], ".1f")
            return f"as a pose it does not keep the posture: J{axis + 1} may end {off} elsewhere; teach it as joints"
    return ""
