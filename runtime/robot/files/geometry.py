"""From the geometry of a robot file to joint frames: rows of Denavit-Hartenberg, or the joint axes as lines in space.

Both forms end in the same three things: the placement of every joint frame in the one before it (z is the joint axis),
the frame in which the file states the body of each axis, and the flange in the last joint frame.

``form = "dh"``: standard rows ``A_i = Rz(q + theta_offset) Tz(d) Tx(a) Rx(alpha)``. Bodies are stated in DH frame i,
which is the joint frame i followed by ``Tz(d) Tx(a) Rx(alpha)``; the last of them is the flange.

``form = "lines"``: at the zero pose each axis is a line, given by a point on it (``origin_m``) and its ``direction``,
both in the base frame; so is the flange. This is how data sheets and most simulation libraries describe an arm. The
body of an axis is stated in a frame with that origin and axes parallel to the base at the zero pose. With X_base_i
the joint frame at the zero pose,

    placement_i = X_base_{i-1}^-1 X_base_i,      R_base_i = [x y z],  z = direction,  y = z x x

where x is the base axis that is most nearly square to z, made square to it. Any other choice turns the joint frame
about its own axis, which no result depends on; this one keeps right angles exact. Read at start, no rate.
"""

import math
from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array, inverse, pose
from runtime.core.linear import matmul, norm
from runtime.core.units import DEG
from runtime.robot.files.robot_file import DhRow, FlangeRow, LineRow, RobotFile
from runtime.robot.model.spec import dh_transform


@dataclass(frozen=True, slots=True, kw_only=True)
class Geometry:
    """Joint frames of an arm at joint angle zero.

    ``placements`` (4, 4) per axis, in the joint frame before it; ``X_joint_body`` (4, 4) per axis, the frame of its
    body data in its joint frame; ``X_last_flange`` (4, 4).
    """

    placements: tuple[Array, ...]
    X_joint_body: tuple[Array, ...]
    X_last_flange: Array


def geometry_of(file: RobotFile) -> Geometry:
    """Return the frames of the arm that a robot file describes."""
    rows = [axis.row for axis in file.axes]
    if file.flange is None:
        return _dh([row for row in rows if isinstance(row, DhRow)])
    return _lines([row for row in rows if isinstance(row, LineRow)], file.flange)


def _dh(rows: list[DhRow]) -> Geometry:
    """Return the frames of Denavit-Hartenberg rows, m and deg."""
    placements, bodies = [], []
    placement = np.eye(4)
    # a row is a turn about the joint and then a fixed pose: the fixed pose of one row and the offset of the next are
    # the placement of the next joint
    for row in rows:
        X_joint_dh = dh_transform(row.d_m, row.a_m, row.alpha_deg * DEG)
        placements.append(matmul(placement, _turn(row.theta_offset_deg * DEG)))
        bodies.append(X_joint_dh)
        placement = X_joint_dh
    return Geometry(placements=tuple(placements), X_joint_body=tuple(bodies), X_last_flange=placement)


def _lines(rows: list[LineRow], flange: FlangeRow) -> Geometry:
    """Return the frames of joint lines in the base frame at the zero pose."""
    placements, bodies = [], []
    X_base_before = np.eye(4)
    for row in rows:
        direction = np.array(row.direction)
        R_base_joint = _frame_about(direction / norm(direction))
        X_base_joint = pose(np.array(row.origin_m), R_base_joint)
        placements.append(matmul(inverse(X_base_before), X_base_joint))
        bodies.append(pose(rotation=R_base_joint.T))
        X_base_before = X_base_joint
    return Geometry(
        placements=tuple(placements),
        X_joint_body=tuple(bodies),
        X_last_flange=matmul(inverse(X_base_before), _flange(flange)),
    )


def _frame_about(z: Array) -> Array:
    """Return the rotation (3, 3) of a frame with a unit vector as its z, as the module says."""
    x = np.eye(3)[int(np.argmin(np.abs(z)))]
    x = x - matmul(x, z) * z
    x = x / norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _flange(row: FlangeRow) -> Array:
    """Return X_base_flange at the zero pose."""
    rx, ry, rz = (angle * DEG for angle in row.rotation_deg)
    return pose(row.position_m, matmul(_about(2, rz), _about(1, ry), _about(0, rx)))


def _about(axis: int, angle: float) -> Array:
    """Return the rotation about a base axis, exact at right angles."""
    c, s = _cos_sin(angle)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[j, j], R[j, k], R[k, j], R[k, k] = c, -s, s, c
    return R


def _turn(angle: float) -> Array:
    return pose(rotation=_about(2, angle))


def _cos_sin(angle: float) -> tuple[float, float]:
    # cos(pi/2) is 6e-17 in floating point: rounded away, so that right angles are exact in every model built from it
    return round(math.cos(angle), 15) + 0.0, round(math.sin(angle), 15) + 0.0
