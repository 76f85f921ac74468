"""First moments of the links beyond the model, from the torques that hold an arm against gravity.

A first moment h_j = m_j c_j (3,), kg m, fixed to link j, loads axis i <= j with

    T_i = g (e_z x z_i) . (R_j h_j)             R_j rotation base <- link j, z_i the axis, e_z up

and T is linear in all of them. A mass that the model lacks acts on the axes before it like a first moment of the link
before, at the origin of its own frame, so first moments alone describe all that gravity can show. The rest of the
torques of an identification at no acceleration,

    tau_i - T_i(q) = sum_j Y_ij(q) dh_j + F_i

has one friction F_i for each axis, which passes all places at one speed in one direction; gravity changes with the
posture and friction does not. Least squares; of moments that gravity cannot distinguish the smallest, in terms of
``scale`` (docs/decisions/0020). Used by ``ArmModel`` (gravity torque of the dynamics task); docs/identification.md.
"""

from dataclasses import dataclass

import numpy as np

from runtime.core.decompositions import least_squares
from runtime.core.frames import Array
from runtime.core.linear import matmul, norm
from runtime.core.units import GRAVITY
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec

READING = 5e-4
"""Standard deviation of a torque in the least squares, as a share of the axis' torque limit."""
DIGITS = 9
"""Decimals of a first moment in kg m that are kept."""
LACKING = 0.5
"""Standard deviation of a first moment beyond the model before anything is measured, as a share of ``scale``."""
ROUNDING = 1e-13
"""Pivots smaller than this share of the largest are rounding: the measurements do not determine their parameters."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Weight:
    """The fit: first moments beyond the model (n, 3) kg m in link frames, friction (n,) N m at the joint.

    ``left`` is the root mean square of the residual torques, N m.
    """

    first_moments: Array
    friction: Array
    left: float


def gravity_columns(spec: RobotSpec, q: Array) -> Array:
    """Return Y (n, n, 3), N m per kg m: torque that holds axis i under a first moment of link j, posture q (n,) rad."""
    n = spec.n
    R, rotations = np.eye(3), []
    for axis, angle in zip(spec.axes, q, strict=True):
        c, s = np.cos(angle), np.sin(angle)
        R = matmul(R, axis.placement[:3, :3], np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))
        rotations.append(R)
    Y = np.zeros((n, n, 3))
    for i in range(n):
        z = rotations[i][:, 2]
        lever = GRAVITY * np.array([-z[1], z[0], 0.0])  # g e_z x z_i
        for j in range(i, n):  # only links from the axis on turn with it
            Y[i, j] = matmul(lever, rotations[j])
    return Y


def scale(spec: RobotSpec) -> Array:
    """Return the size of the first moment of each link (n,), kg m: its own, and that of all mass beyond its end."""
    found, beyond = np.zeros(spec.n), 0.0
    for j in reversed(range(spec.n)):
        body = spec.axes[j].body
        reach = spec.axes[j + 1].placement[:3, 3] if j + 1 < spec.n else np.zeros(3)
        found[j] = body.mass * norm(body.cog) + beyond * norm(reach)
        beyond += body.mass
    return found


def weigh_links(spec: RobotSpec, payload: Payload, axes: Array, postures: Array, torques: Array, most: Array) -> Weight:
    """Return the fit to torques (K,) N m of ``axes`` (K,), 0-based, at constant speed in ``postures`` (K, n) rad.

    ``payload`` is carried by the arm and known to the model, ``most`` (n,) N m are the torque limits. Joint side, SI.
    An axis that is not among ``axes`` has no friction in the result, 0.
    """
    n, model = spec.n, ArmModel(spec)
    model.set_payload(payload)
    noise, prior = READING * most, LACKING * np.maximum(scale(spec), 1e-9)
    A, b = np.zeros((len(axes), 4 * n)), np.zeros(len(axes))
    for row, (axis, q, tau) in enumerate(zip(axes, postures, torques, strict=True)):
        A[row, : 3 * n] = (gravity_columns(spec, q)[axis] * prior[:, None]).ravel() / noise[axis]
        A[row, 3 * n + axis] = 1.0  # friction in terms of ``noise``, without a bound
        b[row] = (tau - model.gravity(q)[axis]) / noise[axis]
    # rows that hold each moment to 0 with its prior: what gravity cannot show stays as small as it may
    bound = np.hstack([np.eye(3 * n), np.zeros((3 * n, n))])
    x = least_squares(np.vstack([A, bound]), np.concatenate([b, np.zeros(3 * n)]), ROUNDING)
    left = (b - matmul(A, x)) * noise[axes]
    return Weight(
        first_moments=np.round(x[: 3 * n].reshape(n, 3) * prior[:, None], DIGITS) + 0.0,
        friction=x[3 * n :] * noise,
        left=float(np.sqrt(np.mean(left**2))) if len(left) else 0.0,
    )
