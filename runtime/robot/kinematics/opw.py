"""Closed-form kinematics of ortho-parallel arms with a spherical wrist, branch by branch.

Source of the parameters: M. Brandstoetter, A. Angerer, M. Hofbaur, "An analytical solution of the inverse
kinematics problem of industrial serial manipulators with an ortho-parallel basis and a spherical wrist", 2014. The
solution is derived here from the geometry, in a form that keeps its digits at the borders. Lengths in m, angles in
rad, ``theta = sign q + offset``; sh, t1 and so on are explained in docs/kinematics.md.

Forward: the flange is the end of one product of elementary motions, from the base outwards,

    Tz(c1) Rz(t1) T(a1, b, 0) Ry(t2) Tz(c2) Ry(t3) T(a2, 0, c3) Rz(t4) Ry(t5) Rz(t6) Tz(c4)

with a constant pose before it and one after it where an arm's own base and flange frames differ (``PlacedOpw``).

Inverse, arm. The wrist centre ``w = p - c4 R ez`` does not depend on J4 to J6. Seen in the frame of the waist it is
at (r, b) of the ground plane, so with rho = hypot(wx, wy) and sh = +1 or -1 (in front of the waist or in its back)

    r = sh sqrt((rho - |b|)(rho + |b|)),    t1 = atan2(wy, wx) - atan2(b, r)

Shoulder, elbow and wrist centre form a triangle with sides c2, k = hypot(a2, c3) and d = hypot(u, v), where
u = r - a1 and v = wz - c1. The angle g by which the arm turns off the straight line at the elbow follows from the
law of cosines. Written for half the angle it needs no acos, whose digits vanish when the arm is stretched (g = 0)
or folded (g = pi):

    tan^2(g/2) = ((c2 + k)^2 - d^2) / (d^2 - (c2 - k)^2),    both factored as (x - y)(x + y)
    t3 = g - atan2(a2, c3),    t2 = atan2(u, v) - atan2(k sin g, c2 + k cos g)

Inverse, wrist. ``W = (Rz(t1) Ry(t2 + t3))' R = Rz(t4) Ry(t5) Rz(t6)`` has the third column
(cos t4 sin t5, sin t4 sin t5, cos t5). t4 comes from it; t5 and t6 are then read from ``Rz(t4)' W = Ry(t5) Rz(t6)``
instead of from W, so that an error of t4 next to the singularity is made good by t6.

Branches. Three choices of two name the eight solutions. Each is a property of the arm, not of the signs and zeros
of its joints, except that the wrist's is the sign that a teach pendant shows.

* RIGHTY: r >= 0, the wrist centre is in front of the waist (on the +x side of the frame that turns with t1);
  LEFTY: r < 0, in its back. Most industrial arms have b = 0: there this is front and back. The Puma 560 has b < 0
  (an arm that reaches forward is right of the waist), so RIGHTY looks like a person's right arm, as its makers named
  it. An arm with b > 0 is RIGHTY too when it reaches forward.
* ABOVE: sh sin(g) >= 0, for an arm that reaches outwards the elbow is on the upper side of the line from shoulder
  to wrist centre; BELOW: on the lower side. The elbow is the corner of the triangle; a2 belongs to the forearm.
* NOFLIP: sin(J5) >= 0, with J5 in the robot's own direction and counted from the straight wrist; FLIP: < 0. From
  one to the other J4 and J6 turn half a turn and J5 changes its sign.

For the Puma 560 these are the classical l/r, u/d, n/f. Lee and Ziegler (1984) call the arm RIGHT when turning J2 up
raises the wrist, which is r > 0; the 'r' of Paul and Zhang (1986), J1 = atan2(y, x) + asin(d3 / rho), leads to
r > 0 too. By this rule, and in the tests, the toolbox's poses are: qz RIGHTY BELOW NOFLIP, qr and qs RIGHTY ABOVE
NOFLIP (on the border: their wrist is straight, and only a3 keeps the elbow off the straight line, by 2.7 deg), qn =
(0, 45, 180, 0, 45, 0) deg RIGHTY ABOVE NOFLIP, 'run'. Versions of the toolbox disagree on n and f: in the MATLAB
one that takes the wrist from Euler angles 'n' gives J5 >= 0, in the Python one J5 <= 0. Controllers' manuals have
NOFLIP for J5 > 0 (softMC, WRISTCMD), so that is the rule here.

Singularities. Wrist, J5 = 0: only J4 and J6 together are determined; J4 is taken from the reference, else 0.
Shoulder, wrist centre on axis 1 (b = 0): J1 is free and is taken likewise; with b != 0 front and back merge
at rho = |b| and J1 stays determined. Elbow, arm stretched or folded: ABOVE and BELOW merge. At each of them the
pose is still met exactly. Beyond reach (rho < |b|, or d outside [|c2 - k|, c2 + k]) a branch is NaN.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from runtime.core.frames import Array, pose, rotation_about
from runtime.core.frames import inverse as inverse_pose
from runtime.core.linear import matmul
from runtime.robot.kinematics.chain import Placed
from runtime.robot.model.spec import OpwParameters

ROUNDING = 5e-13
"""A length in m or a sine below this is rounding: a pose out of reach by less is on the border, an arm within it of
a singularity is at the singularity. Small enough that a pose is met to 1e-12 m all the same."""

BORDER = 1e-4
"""A posture this near to the border of two branches has both names: m from axis 1, sines of elbow and wrist (0.1 mm,
0.006 deg). Taught angles have three decimals, and rounding must not decide in which of the two the arm is."""

TURN = 2.0 * math.pi

_Z = np.array([0.0, 0.0, 1.0])
# all zeros, where a file is checked by eye, and three postures with every joint away from zero and right angles
_PROBES = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.3, -0.7, 1.1, -1.9, 0.8, 2.3],
        [-2.2, 1.3, -0.4, 0.6, -1.7, -0.9],
        [1.6, 2.5, 2.9, 3.0, 2.1, -2.6],
    ]
)


class Arm(Enum):
    """Side of axis 1 on which the wrist centre lies; the value is the sign of r."""

    RIGHTY = 1
    LEFTY = -1


class Elbow(Enum):
    """Side of the line from shoulder to wrist centre on which the elbow lies."""

    ABOVE = 1
    BELOW = -1


class Wrist(Enum):
    """Sign of J5, counted from the straight wrist."""

    NOFLIP = 1
    FLIP = -1


@dataclass(frozen=True, slots=True, kw_only=True)
class Branch:
    """One of the eight solutions of a pose, by name; as text ``LEFTY ABOVE NOFLIP``."""

    arm: Arm
    elbow: Elbow
    wrist: Wrist

    def __str__(self) -> str:
        return f"{self.arm.name} {self.elbow.name} {self.wrist.name}"

    @classmethod
    def parse(cls, text: str) -> "Branch":
        """Return the branch named by three words, in any order and case; ``ValueError`` for anything else."""
        for branch in BRANCHES:
            if sorted(text.upper().split()) == sorted(str(branch).split()):
                return branch
        raise ValueError(f"'{text}' is not a branch: one of RIGHTY LEFTY, of ABOVE BELOW and of NOFLIP FLIP is needed")


BRANCHES = tuple(Branch(arm=arm, elbow=elbow, wrist=wrist) for arm in Arm for elbow in Elbow for wrist in Wrist)
"""The eight branches, in the order in which ``inverse`` returns them."""


class _Unbranched(Branch):
    """The branch of an arm without a closed form: it has no name, and its three choices mean nothing."""

    __slots__ = ()

    def __str__(self) -> str:
        return "NUMERIC"


NUMERIC: Branch = _Unbranched(arm=Arm.RIGHTY, elbow=Elbow.ABOVE, wrist=Wrist.NOFLIP)
"""Stands for a branch where there are none to choose from; equal to none of ``BRANCHES``."""

# signs of the eight branches, (3, 8): arm, elbow, wrist
_SIGNS = np.array([(b.arm.value, b.elbow.value, b.wrist.value) for b in BRANCHES], dtype=np.float64).T


@dataclass(frozen=True, slots=True, kw_only=True)
class PlacedOpw(OpwParameters):
    """The parameters of an arm whose frames are not the model's: constant poses (4, 4) before and after it."""

    X_base_opw: Array
    X_opw_flange: Array

    @classmethod
    def between(cls, params: OpwParameters, X_base_opw: Array, X_opw_flange: Array) -> "PlacedOpw":
        """Return parameters with constant poses (4, 4) before and after the model."""
        own = {field.name: getattr(params, field.name) for field in fields(OpwParameters)}
        return cls(**own, X_base_opw=X_base_opw, X_opw_flange=X_opw_flange)


class Geometry(Protocol):
    """The geometry that kinematics needs: of a ``RobotSpec``, or of an imported arm without drives."""

    @property
    def name(self) -> str: ...  # noqa: D102
    @property
    def title(self) -> str: ...  # noqa: D102
    @property
    def n(self) -> int: ...  # noqa: D102
    @property
    def axes(self) -> Sequence[Placed]: ...  # noqa: D102
    @property
    def X_last_flange(self) -> Array: ...  # noqa: D102
    @property
    def lower(self) -> Array: ...  # noqa: D102
    @property
    def upper(self) -> Array: ...  # noqa: D102
    @property
    def opw(self) -> OpwParameters | None: ...  # noqa: D102


def forward(params: OpwParameters, q: ArrayLike) -> Array:
    """Return X_base_flange (..., 4, 4) of joint angles q (..., 6) rad."""
    t1, t2, t3, t4, t5, t6 = np.moveaxis(params.signs * np.asarray(q, dtype=np.float64) + params.offsets, -1, 0)
    y = np.array([0.0, 1.0, 0.0])
    R_base_waist = rotation_about(_Z, t1)
    R_waist_upper = rotation_about(y, t2)
    R_waist_fore = rotation_about(y, t2 + t3)
    p_waist_wrist = (
        np.array([params.a1, params.b, 0.0])
        + params.c2 * R_waist_upper[..., :, 2]
        + matmul(R_waist_fore, np.array([params.a2, 0.0, params.c3]))
    )
    R = matmul(R_base_waist, R_waist_fore, rotation_about(_Z, t4), rotation_about(y, t5), rotation_about(_Z, t6))
    p = matmul(R_base_waist, p_waist_wrist[..., None])[..., 0] + params.c1 * _Z + params.c4 * R[..., :, 2]
    X = pose(p, R)
    return np.asarray(matmul(params.X_base_opw, X, params.X_opw_flange)) if isinstance(params, PlacedOpw) else X


def mismatch(spec: Geometry) -> float:
    """Return the largest difference in m between the closed form and the chain of axes of a six-axis arm.

    The larger of the distance of the flange origins and of the angle between the flange frames (as a chord) at a
    radius of 1 m, over a few fixed joint vectors, among them all zeros. Called when a robot file is loaded; the
    chain is multiplied out here so that the check shares no code with what it checks.
    """
    if spec.opw is None:
        raise ValueError(f"{spec.name} has no closed form")
    X = np.eye(4)
    for axis, angles in zip(spec.axes, _PROBES.T, strict=True):
        X = matmul(X, axis.placement, pose(rotation=rotation_about(_Z, angles)))
    difference = forward(spec.opw, _PROBES) - matmul(X, spec.X_last_flange)
    position = np.linalg.norm(difference[:, :3, 3], axis=-1)
    orientation = np.linalg.norm(difference[:, :3, :3], axis=(-2, -1)) / math.sqrt(2.0)
    return float(np.max(np.maximum(position, orientation)))


def branch_of(params: OpwParameters, q: ArrayLike) -> Branch:
    """Return the branch of one joint vector q (6,) rad; on a border (see the module) RIGHTY, ABOVE, NOFLIP."""
    r, elbow, wrist = _sides(params, q)
    return Branch(
        arm=Arm.RIGHTY if r >= -ROUNDING else Arm.LEFTY,
        elbow=Elbow.ABOVE if elbow >= -ROUNDING else Elbow.BELOW,
        wrist=Wrist.NOFLIP if wrist >= -ROUNDING else Wrist.FLIP,
    )


def changes(params: OpwParameters, q_from: ArrayLike, q_to: ArrayLike) -> tuple[tuple[str, str], ...]:
    """Return what of the branch two joint vectors (6,) rad differ in: the names before and after.

    A posture on a border has both names and differs from neither.
    """
    # both postures have to be clear of the border: one on it has the other one's name as well
    before, after = branch_of(params, q_from), branch_of(params, q_to)
    clear = [min(abs(a), abs(b)) > BORDER for a, b in zip(_sides(params, q_from), _sides(params, q_to), strict=True)]
    pairs = ((before.arm, after.arm), (before.elbow, after.elbow), (before.wrist, after.wrist))
    return tuple((a.name, b.name) for (a, b), sure in zip(pairs, clear, strict=True) if sure and a is not b)


def _sides(params: OpwParameters, q: ArrayLike) -> tuple[float, float, float]:
    """Return the numbers whose signs are the branch: r in m, and sines of the elbow (seen from the arm) and of J5."""
    theta = params.signs * np.asarray(q, dtype=np.float64) + params.offsets
    k, g = math.hypot(params.a2, params.c3), theta[2] + math.atan2(params.a2, params.c3)
    r = params.a1 + params.c2 * math.sin(theta[1]) + k * math.sin(theta[1] + g)
    return r, math.sin(g) if r >= -ROUNDING else -math.sin(g), params.signs[4] * math.sin(theta[4])


def inverse(params: OpwParameters, X_base_flange: Array, near: ArrayLike | None = None) -> Array:
    """Return the joint angles of all branches (..., 8, 6) in rad, in [-pi, pi], in the order of ``BRANCHES``.

    Poses (..., 4, 4). A branch that does not exist is NaN throughout. ``near`` (..., 6) decides J1 and J4 where a
    singularity leaves them free; zeros by default. Each row that exists meets its pose to 1e-12 m (test_opw.py).
    """
    reference = None if near is None else np.asarray(near, dtype=np.float64)[..., None, :]
    return _solve(params, X_base_flange[..., None, :, :], _SIGNS, reference)


def inverse_branch(params: OpwParameters, X_base_flange: Array, branch: Branch, near: ArrayLike | None = None) -> Array:
    """Return the joint angles (..., 6) of one branch for poses (..., 4, 4); see ``inverse``.

    Timing: called by the path planner on all samples of a move at once; one pass of array operations, no loop.
    """
    signs = np.array([branch.arm.value, branch.elbow.value, branch.wrist.value], dtype=np.float64)
    return _solve(params, X_base_flange, signs, None if near is None else np.asarray(near, dtype=np.float64))


def wrapped(angle: Array) -> Array:
    """Return angles turned by whole turns into [-pi, pi]."""
    return angle - TURN * np.round(angle / TURN)


def _solve(params: OpwParameters, X: Array, signs: Array, near: Array | None) -> Array:
    """Solve poses X (..., 4, 4) for branch signs (3, ...), broadcast against each other."""
    reference = params.offsets if near is None else params.signs * near + params.offsets
    if isinstance(params, PlacedOpw):
        X = matmul(inverse_pose(params.X_base_opw), X, inverse_pose(params.X_opw_flange))
    R, p = X[..., :3, :3], X[..., :3, 3]
    with np.errstate(invalid="ignore"):
        t1, t2, t3 = arm_angles(
            params, p - params.c4 * R[..., :, 2], signs[0], signs[1], Forearm.to_wrist(params), reference[..., 0]
        )
        W = _wrist_rotation(R, t1, t2 + t3)
        t4, t5, t6 = _wrist_angles(W, params.signs[4] * signs[2], reference[..., 3])
        theta = np.stack(np.broadcast_arrays(t1, t2, t3, t4, t5, t6), axis=-1)
        theta[np.isnan(theta).any(axis=-1)] = np.nan
        return wrapped(params.signs * (theta - params.offsets))


@dataclass(frozen=True, slots=True)
class Forearm:
    """The lengths (...,), m, that say where the end of a forearm is seen from the elbow: a2 and c3 in the plane of the
    arm, b across it."""

    a2: Array
    b: Array
    c3: Array

    @staticmethod
    def to_wrist(params: OpwParameters) -> "Forearm":
        """Return the forearm that ends in the wrist centre."""
        return Forearm(*np.array([params.a2, params.b, params.c3]))


def arm_angles(
    params: OpwParameters,
    p_end: Array,
    arm: Array | int,
    elbow: Array | int,
    forearm: Forearm,
    t1_free: Array | float = 0.0,
) -> tuple[Array, Array, Array]:
    """Return t1, t2, t3 (...,) that put the end of the forearm at p_end (..., 3) m; NaN out of reach.

    The end is the wrist centre, or the tool point of a forearm whose wrist is held (``frozen_wrist``). ``arm`` and
    ``elbow`` are the signs of the branch; ``t1_free`` rad is t1 where the end lies on axis 1.
    """
    a2, b, c3 = forearm.a2, forearm.b, forearm.c3
    x, y, z = np.moveaxis(p_end, -1, 0)
    rho = np.hypot(x, y)
    r = arm * _leg(rho, np.abs(b))
    t1 = np.arctan2(y, x) - np.arctan2(b, r)
    # the end on axis 1 and no shoulder offset: any t1 meets it, and the reference decides
    t1 = np.where((rho < ROUNDING) & (np.abs(b) < ROUNDING), t1_free, t1)
    u, v = r - params.a1, z - params.c1
    d = np.hypot(u, v)
    k = np.hypot(a2, c3)
    # 'above' bends the elbow in opposite senses in front of the waist and in its back: hence arm * elbow
    g = arm * elbow * 2.0 * np.arctan2(_leg(params.c2 + k, d), _leg(d, np.abs(params.c2 - k)))
    t2 = np.arctan2(u, v) - np.arctan2(k * np.sin(g), params.c2 + k * np.cos(g))
    return t1, t2, g - np.arctan2(a2, c3)


def _leg(hypotenuse: ArrayLike, other: ArrayLike) -> Array:
    """Return sqrt(h^2 - o^2) of lengths in m, zero where o is longer by rounding only, NaN where it is longer."""
    # (h - o)(h + o) instead of h^2 - o^2: the difference of squares loses its digits at the border, where h = o
    gap = np.subtract(hypotenuse, other)
    return np.asarray(np.sqrt(np.where(gap >= -ROUNDING, np.maximum(gap, 0.0), np.nan) * np.add(hypotenuse, other)))


def _wrist_rotation(R: Array, t1: Array, t23: Array) -> tuple[Array, Array, Array]:
    """Return the rows (..., 3) of W = (Rz(t1) Ry(t23))' R."""
    c1, s1, c23, s23 = (f[..., None] for f in (np.cos(t1), np.sin(t1), np.cos(t23), np.sin(t23)))
    forward_row = c1 * R[..., 0, :] + s1 * R[..., 1, :]
    up_row = R[..., 2, :]
    return c23 * forward_row - s23 * up_row, c1 * R[..., 1, :] - s1 * R[..., 0, :], s23 * forward_row + c23 * up_row


def _wrist_angles(W: tuple[Array, Array, Array], bend: Array, t4_free: Array) -> tuple[Array, Array, Array]:
    """Return t4, t5, t6 of W = Rz(t4) Ry(t5) Rz(t6) with the sign of t5 given; t4 = t4_free where t5 = 0."""
    # t5 and t6 from W turned back by t4: next to the singularity an error of t4 is made good by t6 (see the module)
    x, y, z = W
    t4 = np.arctan2(bend * y[..., 2], bend * x[..., 2])
    t4 = np.where(np.hypot(x[..., 2], y[..., 2]) < ROUNDING, t4_free, t4)
    c4, s4 = np.cos(t4), np.sin(t4)
    t5 = np.arctan2(c4 * x[..., 2] + s4 * y[..., 2], z[..., 2])
    t6 = np.arctan2(c4 * y[..., 0] - s4 * x[..., 0], c4 * y[..., 1] - s4 * x[..., 1])
    return t4, t5, t6
