"""Finding the closed form of an arm from the lines of its joints.

Six axes have the closed form of ``opw`` when, with all joints at zero,

    J1 is perpendicular to J2, J2 parallel to J3, J3 perpendicular to J4,
    J4, J5 and J6 meet in one point (the wrist centre), J4 perpendicular to J5, J5 perpendicular to J6.

The parameters follow from the lines alone. Model frame: z along J1 (upwards in the base frame, if it has an up), y
along J2 or against it, origin the foot of the base origin on J1. In the plane across y: J2 at (a1, c1), J3 at distance
c2 from it, the wrist centre at (a2, c3) from J3 with c3 >= 0 along J4, and b is its y. The two directions of y are the
same arm seen from its two sides; the one with a1 > 0 is taken, for a1 = 0 the one with x forward in the base frame.
Signs and offsets are read from the directions at zero. What remains before and after the model are constant
poses, a turn about its axis being counted as an offset of J1 or J6.

The result is verified: parameters count only when ``opw.mismatch`` over the chain of axes stays below 1e-9. An arm
whose file rounds its numbers (1.5708 for a right angle) therefore has no closed form, and is solved by Newton's method.
Called once an arm is loaded.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from runtime.core.decompositions import solve
from runtime.core.frames import Array, frozen, inverse, pose
from runtime.core.linear import dot, matmul, norm
from runtime.robot.kinematics import opw
from runtime.robot.kinematics.chain import Placed
from runtime.robot.kinematics.opw import PlacedOpw
from runtime.robot.model.spec import OpwParameters

ACCEPTED = 1e-9
"""Largest mismatch of a closed form with the chain of axes, m at a radius of 1 m."""

_LOOSE = 1e-6
"""Lines that miss each other by less, m or as a cosine, may meet; the mismatch decides."""
_SAME = 1e-12
"""Rounding of a projection, m: a length of less is zero and has no sign."""
_WELL_POSED = 1e6
"""Condition number below which lines have one meeting point; parallel lines have infinitely many."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Probe:
    """The chain of an arm with the parameters found for it, as ``opw.mismatch`` compares them."""

    axes: Sequence[Placed]
    X_last_flange: Array
    opw: OpwParameters
    name: str = "arm"
    title: str = "arm"
    n: int = 6
    lower: Array
    upper: Array


def find_opw(axes: Sequence[Placed], X_last_flange: Array) -> OpwParameters | None:
    """Return the closed-form parameters of a chain of axes, or None when its geometry has none of this kind."""
    if len(axes) != 6 or any(axis.kind.slides for axis in axes):
        return None
    frames = []
    X = np.eye(4)
    for axis in axes:
        X = matmul(X, axis.placement)
        frames.append(X)
    params = _parameters(np.stack(frames), matmul(X, X_last_flange))
    if params is None:
        return None
    none = np.zeros(0)
    probe = _Probe(axes=axes, X_last_flange=X_last_flange, opw=params, lower=none, upper=none)
    return params if opw.mismatch(probe) < ACCEPTED else None


def _parameters(frames: Array, X_base_flange: Array) -> OpwParameters | None:
    """Return parameters from the frames (6, 4, 4) of the axes and the flange at zero; None where the lines do not fit.

    t1 to t6 are the model's angles at joint angle zero, so they become the offsets.
    """
    p, z = frames[:, :3, 3], frames[:, :3, 2]
    wrist = _meeting_point(p[3:], z[3:])
    # the cosines of the four right angles; J2 and J3 must be parallel
    square = np.array([matmul(z[0], z[1]), matmul(z[2], z[3]), matmul(z[3], z[4]), matmul(z[4], z[5])])
    if wrist is None or not np.abs(square).max() < _LOOSE or not norm(np.cross(z[1], z[2])) < _LOOSE:
        return None
    X_base_opw, signs = _model_frame(p, z)
    a1, c1 = _across(X_base_opw, p[1])
    x3, z3 = _across(X_base_opw, p[2])
    c2, t2 = math.hypot(x3 - a1, z3 - c1), math.atan2(x3 - a1, z3 - c1)
    to_opw = X_base_opw[:3, :3].T
    p_wrist = matmul(to_opw, wrist - X_base_opw[:3, 3])
    fore = np.array([p_wrist[0] - x3, 0.0, p_wrist[2] - z3])
    # c3 >= 0 fixes the sign of J4, c4 >= 0 that of J6, and t4 within a quarter turn that of J5
    e4, e5, e6 = (matmul(to_opw, z[i]) for i in (3, 4, 5))
    signs[3] = -1.0 if matmul(fore, e4) < -_SAME else 1.0
    e4 = signs[3] * e4
    t23 = math.atan2(e4[0], e4[2])
    x4 = np.array([math.cos(t23), 0.0, -math.sin(t23)])  # where x points after t2 and t3
    t4 = math.atan2(-dot(e5, x4), float(e5[1]))
    if math.cos(t4) < -_SAME:
        signs[4], t4 = -1.0, math.atan2(dot(e5, x4), -float(e5[1]))
    x4_turned = math.cos(t4) * x4 + math.sin(t4) * np.array([0.0, 1.0, 0.0])
    reach = float(matmul(to_opw, X_base_flange[:3, 3] - wrist, e6))
    if reach < -_SAME or (abs(reach) <= _SAME and dot(X_base_flange[:3, 2], z[5]) < 0.0):
        signs[5], e6, reach = -1.0, -e6, -reach
    t5 = math.atan2(dot(e6, x4_turned), dot(e6, e4))
    return _with_ends(
        OpwParameters(
            a1=a1,
            a2=dot(fore, x4),
            b=float(p_wrist[1]),
            c1=c1,
            c2=c2,
            c3=dot(fore, e4),
            c4=reach,
            offsets=frozen([0.0, t2, t23 - t2, t4, t5, 0.0]),
            signs=frozen(signs),
        ),
        X_base_opw,
        X_base_flange,
    )


def _model_frame(p: Array, z: Array) -> tuple[Array, Array]:
    """Return X_base_opw and the signs (6,) with those of J1 to J3 set."""
    signs = np.ones(6)
    signs[0] = -1.0 if z[0][2] < -0.5 else 1.0  # a waist that turns about the downward axis of the base
    up = signs[0] * z[0]
    origin = p[0] - matmul(p[0], up) * up  # the foot of the base origin on J1
    # y made exactly square to J1: the file's J2 may miss a right angle by rounding
    y = z[1] - matmul(z[1], up) * up
    y /= norm(y)
    a1 = dot(p[1] - origin, np.cross(y, up))
    forward = np.cross(y, up)
    side = a1 if abs(a1) > _LOOSE else float(forward[0] if abs(forward[0]) > _LOOSE else forward[1])
    y = -y if side < 0.0 else y
    signs[1], signs[2] = (1.0 if matmul(z[i], y) > 0.0 else -1.0 for i in (1, 2))
    return pose(origin, np.stack([np.cross(y, up), y, up], axis=-1)), signs


def _across(X_base_opw: Array, point: Array) -> tuple[float, float]:
    """Return x and z of a point (3,) in the model frame."""
    local = matmul(X_base_opw[:3, :3].T, point - X_base_opw[:3, 3])
    return float(local[0]), float(local[2])


def _meeting_point(p: Array, z: Array) -> Array | None:
    """Return the point (3,) nearest to lines p (k, 3) along z (k, 3); None when they do not meet."""
    # least squares: each line measures a point by its distance, whose projector is E - z z'
    across = np.eye(3) - z[:, :, None] * z[:, None, :]
    normal = across.sum(axis=0)
    if not np.linalg.cond(normal) < _WELL_POSED:
        return None
    point = solve(normal, matmul(across, p[..., None]).sum(axis=0)[:, 0])
    miss = np.linalg.norm(matmul(across, (point - p)[..., None])[..., 0], axis=-1)
    return point if miss.max() < _LOOSE else None


def _with_ends(params: OpwParameters, X_base_opw: Array, X_base_flange: Array) -> OpwParameters:
    """Return the parameters with the constant poses before and after the model, as offsets of J1 and J6 if possible."""
    X_base_end = matmul(X_base_opw, opw.forward(params, np.zeros(6)))
    t1, before = _split(X_base_opw)
    t6, after = _split(matmul(inverse(X_base_end), X_base_flange))
    offsets = np.array(params.offsets)
    offsets[0] += t1
    offsets[5] += t6
    # b = 2e-17 for 0 would make it an arm with a shoulder offset, whose front and back have another meaning: rounded to
    # 0.1 pm, and the mismatch judges the result
    plain = OpwParameters.of([round(length, 13) + 0.0 for length in params.lengths], offsets, params.signs)
    if before is None and after is None:
        return plain
    unmoved = frozen(np.eye(4))
    return PlacedOpw.between(plain, unmoved if before is None else before, unmoved if after is None else after)


def _split(X: Array) -> tuple[float, Array | None]:
    """Return a pose as (angle, None) when it is a turn about z alone, else as (0, the pose)."""
    turn = math.atan2(X[1, 0], X[0, 0])
    c, s = math.cos(turn), math.sin(turn)
    same = np.abs(X - np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])).max() < 1e-11
    return (turn, None) if same else (0.0, frozen(X))
