"""The load that a payload puts on the wrist: moment and inertia about each of its axes, against their ratings.

Vendors rate an arm by more than a mass: a light payload far from the flange overloads the wrist. With the linear and
angular columns (v_i, z_i) of the Jacobian at the flange, and the centre of gravity at r from it,

    w_i = v_i + z_i x r            velocity of the centre of gravity for one rad/s of axis i
    moment_i  = m g |w_i . ez|     its weight about axis i
    inertia_i = m |w_i|^2 + z_i' R I R' z_i

The limits are those of the robot file (``rated_moment_nm``, ``rated_inertia_kg_m2`` of an axis). An axis without them
gets an estimate from its drive: ``MOMENT_SHARE`` of the torque limit may hold the weight, and what is left must
accelerate the rotor and the payload as fast as the limit of acceleration says.
"""

from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array
from runtime.core.linear import cross, matmul
from runtime.core.units import GRAVITY
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import AxisSpec, RobotSpec

MOMENT_SHARE = 0.5
"""Share of the torque limit of an axis that holding a payload may take, where the robot file states no rating."""
WRIST_AXES = 3
"""The last axes, which a payload loads by where its centre of gravity is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WristLoad:
    """Of the last axes, from ``first`` (0-based) on: moment (..., k) N m and inertia (..., k) kg m2 of a payload."""

    first: int
    moment: Array
    inertia: Array


def wrist_load(kinematics: Kinematics, q: Array, payload: Payload) -> WristLoad:
    """Return the load of a payload on the wrist at joint angles q (..., n) rad."""
    first = max(0, kinematics.n - WRIST_AXES)
    J = kinematics.jacobian(q)[..., first:]
    R = kinematics.forward(q)[..., :3, :3]
    v, z = np.moveaxis(J[..., :3, :], -2, -1), np.moveaxis(J[..., 3:, :], -2, -1)
    r = matmul(R, payload.cog)[..., None, :]
    # one Jacobian serves both: the flange's, carried over to the centre of gravity
    w = v + cross(z, r)
    own = matmul(R, payload.inertia, np.swapaxes(R, -1, -2))
    inertia = payload.mass * np.sum(w * w, axis=-1) + np.einsum("...ki,...ij,...kj->...k", z, own, z)
    return WristLoad(first=first, moment=payload.mass * GRAVITY * np.abs(w[..., 2]), inertia=inertia)


def rated_moment(axis: AxisSpec) -> float:
    """Return the moment that a payload may have about an axis, N m: of the robot file, else estimated."""
    given = axis.limits.rated_moment
    return MOMENT_SHARE * axis.limits.torque if given is None else given


def rated_inertia(axis: AxisSpec) -> float:
    """Return the inertia that a payload may have about an axis, kg m2, 0 or more: of the file, else estimated."""
    given = axis.limits.rated_inertia
    if given is not None:
        return given
    # 0 where the rotor alone takes all of it: such an axis is rated for no inertia rather than for a negative one
    free = (1.0 - MOMENT_SHARE) * axis.limits.torque / axis.limits.acceleration
    return max(0.0, free - axis.motor.reflected_inertia)


def ratings(spec: RobotSpec) -> tuple[Array, Array]:
    """Return rated moments N m and inertias kg m2 (k,) of the last axes, in the order of ``wrist_load``."""
    axes = spec.axes[max(0, spec.n - WRIST_AXES) :]
    return np.array([rated_moment(axis) for axis in axes]), np.array([rated_inertia(axis) for axis in axes])
