"""Poses, rotations and the rotation-principal-axis method.

A pose ``X_a_b`` is a 4x4 homogeneous matrix that takes coordinates in frame b to frame a; names match like
dominoes (``X_world_base @ X_base_tool``). Orientation at the surface is RX RY RZ about the fixed X, Y, Z axes in
that order: ``R = Rz @ Ry @ Rx`` (docs/language.md). All functions broadcast over leading dimensions unless they say
otherwise. Source of the principal axis: JPH06190750A Fig 6, steps 200-208. Angles rad, lengths m.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from runtime.core.linear import dot, matmul, norm
from runtime.core.units import DEG

Array = NDArray[np.float64]

HALF_TURN = 1e-6 * DEG
"""A turn this near to 180 deg, rad, is an exact half turn. Poses that are calculated differ by rounding: 1e-14 rad, and
1e-9 where RY is 90 deg. Poses that are taught have three decimals and differ by 1e-5 rad: those take the shorter turn.
"""

_SURELY_NOT_ZERO = 0.55
"""One component of a unit vector is larger than this, since 1 / sqrt(3) = 0.577; axes at 30, 45 and 60 deg have none
that equals it, so rounding does not change which component leads."""

_NO_ROTATION = 1e-200
"""Below this the sine of an angle has no direction; the angle is then zero to the last bit."""

_EYE = np.eye(3)


def frozen(values: ArrayLike) -> Array:
    """Return a read-only float64 copy, for arrays inside frozen data."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def skew(v: ArrayLike) -> Array:
    """Return the matrix ``[v]x`` with ``[v]x @ u = v x u``; v (..., 3) -> (..., 3, 3)."""
    u = np.asarray(v, dtype=np.float64)
    x, y, z = u[..., 0], u[..., 1], u[..., 2]
    K = np.zeros((*u.shape, 3))
    K[..., 0, 1], K[..., 0, 2] = -z, y
    K[..., 1, 0], K[..., 1, 2] = z, -x
    K[..., 2, 0], K[..., 2, 1] = -y, x
    return K


def rotation_about(k: ArrayLike, angle: ArrayLike) -> Array:
    """Rodrigues: ``Rot(k, d) = I + sin(d) [k]x + (1 - cos(d)) [k]x^2``; k unit (..., 3), angle (...,) rad."""
    K = skew(k)
    d = np.asarray(angle, dtype=np.float64)[..., None, None]
    # 2 sin^2(d/2) is 1 - cos(d) without the cancellation at small angles
    return np.asarray(_EYE + np.sin(d) * K + 2.0 * np.sin(d / 2.0) ** 2 * matmul(K, K))


def principal_axis(R_from: Array, R_to: Array) -> tuple[Array, float]:
    """Return unit axis k (3,) in world and angle Theta in [0, pi] with ``Rot(k, Theta) @ R_from = R_to``.

    ``w`` is the axis times sin(Theta). Where cos(Theta) is negative w loses its digits (at Theta = pi it is
    zero), so there the axis comes from the symmetric part, ``k k' = (sym(M) - cos I) / (1 - cos)``, and w gives
    only its sign. Source: JPH06190750A Fig 6, steps 200 and 202. Single poses, 3x3.
    """
    M = matmul(R_to, R_from.T)
    w = 0.5 * np.array([M[2, 1] - M[1, 2], M[0, 2] - M[2, 0], M[1, 0] - M[0, 1]])
    sine = norm(w)
    cosine = 0.5 * (float(np.trace(M)) - 1.0)
    theta = math.atan2(sine, cosine)
    if cosine >= 0.0:
        return (w / sine if sine > _NO_ROTATION else np.array([0.0, 0.0, 1.0])), theta
    kk = (0.5 * (M + M.T) - cosine * np.eye(3)) / (1.0 - cosine)
    column = kk[:, int(np.argmax(np.diag(kk)))]  # the longest of the three, so the least rounding
    k = column / norm(column)
    return (-k if dot(k, w) < 0.0 else k), theta


def is_half_turn(angle: ArrayLike) -> NDArray[np.bool_]:
    """Return whether angles (...,) rad are half a turn to either side, within ``HALF_TURN``."""
    return np.asarray(np.abs(np.abs(np.asarray(angle, dtype=np.float64)) - np.pi) <= HALF_TURN)


def principal_axes(R_from: Array, R_to: Array) -> tuple[tuple[Array, float], ...]:
    """Return every shortest rotation from one orientation to another: axis k (3,) and angle rad of ``principal_axis``.

    There is one, except at an exact half turn: there k and -k are equally short, and both are returned. The first of
    them is positive about the tool, so that the rounding of the two orientations does not decide which one it is.
    """
    k, theta = principal_axis(R_from, R_to)
    if not is_half_turn(theta):
        return ((k, theta),)
    # judged in the frame of the tool, so that the direction does not depend on where the tool is (decision 0030)
    in_tool = matmul(R_from.T, k)
    leading = in_tool[int(np.argmax(np.abs(in_tool) > _SURELY_NOT_ZERO))]
    both = ((k, theta), (-k, 2.0 * math.pi - theta))
    return both if leading > 0.0 else both[::-1]


def rotation_angle(R_a: Array, R_b: Array) -> float:
    """Return the angle between two orientations in rad, in [0, pi]."""
    return principal_axis(R_a, R_b)[1]


def rotation_angles(R_a: Array, R_b: Array) -> Array:
    """Return the angles (...,) between orientations (..., 3, 3) in rad, in [0, pi], exact near zero."""
    # atan2 of twice sine and cosine: arccos of the trace alone loses half of the digits of small angles
    M = matmul(np.swapaxes(R_a, -1, -2), R_b)
    w = np.stack([M[..., 2, 1] - M[..., 1, 2], M[..., 0, 2] - M[..., 2, 0], M[..., 1, 0] - M[..., 0, 1]], axis=-1)
    return np.asarray(np.arctan2(np.linalg.norm(w, axis=-1), np.trace(M, axis1=-2, axis2=-1) - 1.0))


def rotation_from_rpy(rpy: ArrayLike) -> Array:
    """Return ``Rz(rz) @ Ry(ry) @ Rx(rx)``; rpy (..., 3) rad -> (..., 3, 3)."""
    angles = np.asarray(rpy, dtype=np.float64)
    rx, ry, rz = angles[..., 0], angles[..., 1], angles[..., 2]
    x, y, z = _EYE
    return np.asarray(matmul(rotation_about(z, rz), rotation_about(y, ry), rotation_about(x, rx)))


def rpy_from_rotation(R: Array) -> Array:
    """Return (rx, ry, rz) in rad with ry in [-pi/2, pi/2]; at ry = +-pi/2, where only a sum is defined, rx = 0.

    Half a turn is +pi, never -pi: both are the same, and rounding must not decide the sign that a program reads.
    """
    # below 1e-9 the first two terms of R are rounding and rx and rz turn about one axis: all of it is given to rz
    cy = np.hypot(R[..., 0, 0], R[..., 1, 0])
    regular = cy > 1e-9
    rx = np.where(regular, np.arctan2(R[..., 2, 1], R[..., 2, 2]), 0.0)
    ry = np.arctan2(-R[..., 2, 0], cy)
    rz = np.where(regular, np.arctan2(R[..., 1, 0], R[..., 0, 0]), np.arctan2(-R[..., 0, 1], R[..., 1, 1]))
    angles = np.stack([rx, ry, rz], axis=-1)
    return np.asarray(angles + np.where(is_half_turn(angles) & (angles < 0.0), 2.0 * np.pi, 0.0))


def quaternion(R: Array) -> Array:
    """Return the quaternion (4,), w x y z and w >= 0, of a rotation (3, 3)."""
    xx, yy, zz = R[0, 0], R[1, 1], R[2, 2]
    # four times the square of each component; the root of the largest one loses no digits (Shepperd 1978)
    squares = np.array([1.0 + xx + yy + zz, 1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz])
    wx, wy, wz = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
    xy, xz, yz = R[0, 1] + R[1, 0], R[0, 2] + R[2, 0], R[1, 2] + R[2, 1]
    largest = int(np.argmax(squares))
    row = np.array(
        [(squares[0], wx, wy, wz), (wx, squares[1], xy, xz), (wy, xy, squares[2], yz), (wz, xz, yz, squares[3])]
    )
    found = row[largest] / (2.0 * np.sqrt(squares[largest]))
    return np.asarray(-found if found[0] < 0.0 else found)


def pose(position: ArrayLike = (0.0, 0.0, 0.0), rotation: ArrayLike | None = None) -> Array:
    """Return the homogeneous matrix (..., 4, 4) of a position (..., 3) in m and a rotation (..., 3, 3)."""
    p = np.asarray(position, dtype=np.float64)
    R = np.eye(3) if rotation is None else np.asarray(rotation, dtype=np.float64)
    shape = np.broadcast_shapes(p.shape[:-1], R.shape[:-2])
    X = np.zeros((*shape, 4, 4))
    X[..., :3, :3] = R
    X[..., :3, 3] = p
    X[..., 3, 3] = 1.0
    return X


def pose_from_xyzrpy(values: Sequence[float] | Array) -> Array:
    """Return the pose of (x, y, z, rx, ry, rz) in m and rad."""
    return pose(values[:3], rotation_from_rpy(values[3:]))


def xyzrpy_from_pose(X: Array) -> Array:
    """Return (x, y, z, rx, ry, rz) in m and rad, (..., 6)."""
    return np.concatenate([X[..., :3, 3], rpy_from_rotation(X[..., :3, :3])], axis=-1)


def inverse(X: Array) -> Array:
    """Return the inverse of poses (..., 4, 4)."""
    Rt = np.swapaxes(X[..., :3, :3], -1, -2)
    return pose(-matmul(Rt, X[..., :3, 3:])[..., 0], Rt)
