"""By how much a point changes that is taught anew: what is shown before it is replaced."""

from dataclasses import dataclass

from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.project.points import Point
from robolang.teaching.postures import reached_point, taught_place, tool_place
from robolang.values.poses import Six
from runtime.core.faults import Fault
from runtime.core.frames import Array, inverse, pose, rotation_angle
from runtime.core.linear import matmul, norm
from runtime.core.units import DEG, MM


@dataclass(frozen=True, slots=True, kw_only=True)
class TouchUp:
    """The change of a point, mm and deg.

    ``by``: dX dY dZ of the tool and the rotation dRX dRY dRZ that takes its old orientation to the new one, about the
    fixed axes of ``frame``, the frame of the point ("" the world); ``distance`` mm and ``angle`` deg in all.
    ``joints`` (n,): what each joint turns by, and ``configuration``: the names before and after of what changes of the
    arm; None and () where the old point is not reached, with ``unreached`` as the reason.
    """

    frame: str
    by: Six
    distance: float
    angle: float
    joints: tuple[float, ...] | None = None
    configuration: tuple[tuple[str, str], ...] = ()
    unreached: Fault | None = None


def change(old: Point, new: Point, q: Array, around: Surroundings) -> TouchUp:
    """Return the change from a point to the one that is taught at joint angles q (n,) rad, for the tool in use.

    ``Fault`` RBL305 or RBL307 where one of them has a frame, a tool or a number of joints that the cell has not.
    """
    # both in the frame of the new point: an old one may have stood in another frame
    X_frame_world = inverse(lowering.frame_pose(new.frame, around.cell))
    X_old = matmul(X_frame_world, taught_place(old, around))
    X_new = matmul(X_frame_world, tool_place(q, around))
    joints, configuration, unreached = _turned(old, q, around)
    return TouchUp(
        frame=new.frame,
        by=_between(X_old, X_new),
        distance=norm(X_new[:3, 3] - X_old[:3, 3]) / MM,
        angle=rotation_angle(X_old[:3, :3], X_new[:3, :3]) / DEG,
        joints=joints,
        configuration=configuration,
        unreached=unreached,
    )


def _turned(
    old: Point, q: Array, around: Surroundings
) -> tuple[tuple[float, ...] | None, tuple[tuple[str, str], ...], Fault | None]:
    """Return joints, configuration and reason of a ``TouchUp``."""
    try:
        # from where the arm stands: of several postures of the old point the nearest is the one that was meant
        q_old = reached_point(old, around, q)
    except Fault as fault:
        return None, (), fault
    return tuple(((q - q_old) / around.cell.robot.units).tolist()), around.kinematics.changes(q_old, q), None


def _between(X_old: Array, X_new: Array) -> Six:
    """Return the translation and the rotation, about the fixed axes, from one pose to another."""
    # the rotation on the left: about the axes of the frame, as a jog of RX, RY or RZ in it turns the tool
    return lowering.six_of(pose(X_new[:3, 3] - X_old[:3, 3], matmul(X_new[:3, :3], X_old[:3, :3].T)))
