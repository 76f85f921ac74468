"""Inertia of every axis and its value at the motor, by one short Newton-Euler pass per axis (docs/motor-inertia.md).

Source: CN document 003 "EFORT" (motor-end inertia in real time), 3.2 to 3.4. Equation numbers below are its sections.

A rigid arm at rest, without gravity, whose axis i alone is accelerated by 1 rad/s2, needs on that axis the torque
``M_ii 1 = D_i``, the inertia of everything beyond it. The axes before i stand still, so the pass starts at link i:

    dw_i = Z,  dv_i = 0
    for j = i+1..n:  dw_j = R_j' dw_{j-1}
                     dv_j = R_j' ( dw_{j-1} x P_j + dv_{j-1} )
    for j = n..i:    f_j = R_{j+1} f_{j+1} + m_j dv_j + dw_j x Pm_j
                     n_j = R_{j+1} n_{j+1} + P_{j+1} x (R_{j+1} f_{j+1}) - dv_j x Pm_j + I_j dw_j
    J_i = n_i . Z                                  (f_{n+1} = n_{n+1} = 0)

R_j takes frame j to frame j-1 and P_j is the origin of frame j in frame j-1; Z = (0, 0, 1) is the axis of frame j.
m_j, Pm_j = m_j c_j and I_j are mass, first moment and inertia of link j about the *origin* of its frame. All n axes
take n(n-1)/2 steps outward and n(n+1)/2 back (15 and 21 for six), against n^2 and n^2 for whole columns from the base.
Since nothing before link i enters, J_i does not depend on the angles of axes 1 to i.

The motor turns N times as fast as the joint and has 1/N of its torque: Jm_i = J_i / N_i^2, without rotor and gear.

Of two forms, ``axis_inertia`` is the recursion word for word and ``link_inertia`` the same for many postures at once.
There a link's acceleration ``(dv, dw)`` and its load ``(f, n)`` are columns of six numbers, and a step is a constant
6x6 product and a turn about z, since R_j = R0_j Rot(Z, q_j):

    (dv, dw)_j = Rot' X_j (dv, dw)_{j-1}              X_j = [[R0', -R0'[P]x], [0, R0']]
    (f, n)_j   = X_{j+1}' Rot (f, n)_{j+1} + A_j (dv, dw)_j      A_j = [[m E, -[Pm]x], [[Pm]x, I]]

Range of validity: open chains with rigid links and gears, in any posture. Speeds do not matter: the mass matrix depends
on the posture alone. SI throughout. The document has axes that turn. One that slides starts the pass with dv_i = Z,
takes P_j + q_j Z_j for P_j, and its element is f_j . Z: a mass, kg.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from runtime.core.frames import Array, frozen, skew
from runtime.core.linear import dot, matmul
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from runtime.robot.model.spec import Body, RobotSpec

if TYPE_CHECKING:
    from runtime.robot.model.load_rules import LoadMode

_Z = frozen([0.0, 0.0, 1.0])
_NOTHING = frozen(np.zeros(3))
_BLOCK = 256
"""Postures that ``link_inertia`` takes at a time: what it keeps of them stays in the processor's cache."""


# without slots: cached_property keeps X_j and A_j in the instance, which is made anew with every LOAD
@dataclass(frozen=True, kw_only=True, eq=False)
class LinkChain:
    """The arm as the pass needs it, in the frames of its axes (3.2); read-only arrays.

    ``rotations`` (n, 3, 3) and ``offsets`` (n, 3) m: R0_j and P_j, frame j at angle zero in frame j-1. ``masses`` (n,)
    kg, ``moments`` (n, 3) kg m (first moments Pm_j), ``inertias`` (n, 3, 3) kg m2 about the frame's origin.
    ``gear_ratios`` (n,): N, signed. ``sliding``: the indices of the axes that slide.
    """

    rotations: Array
    offsets: Array
    masses: Array
    moments: Array
    inertias: Array
    gear_ratios: Array
    sliding: frozenset[int] = frozenset()

    @property
    def n(self) -> int:
        """Number of axes."""
        return len(self.masses)

    @cached_property
    def steps(self) -> Array:
        """X_j (n, 6, 6): accelerations (dv, dw) of frame j-1 to those of j at angle zero; X_j' takes loads back."""
        X = np.zeros((self.n, 6, 6))
        X[:, :3, :3] = X[:, 3:, 3:] = self.rotations.transpose(0, 2, 1)
        X[:, :3, 3:] = matmul(-self.rotations.transpose(0, 2, 1), skew(self.offsets))
        return frozen(X)

    @cached_property
    def bodies(self) -> Array:
        """A_j (n, 6, 6): accelerations (dv, dw) of link j to the load (f, n) that gives it them."""
        A = np.zeros((self.n, 6, 6))
        A[:, :3, :3] = self.masses[:, None, None] * np.eye(3)
        A[:, 3:, :3] = skew(self.moments)
        A[:, :3, 3:] = -A[:, 3:, :3]
        A[:, 3:, 3:] = self.inertias
        return frozen(A)


def link_chain(spec: RobotSpec, payload: Payload = NO_PAYLOAD, mode: "LoadMode" = "add") -> LinkChain:
    """Return the chain of a robot that carries ``payload`` (in the flange frame).

    3.2: m* = m + mL, Pm* = Pm + mL rL, I* = I + IL, with I(origin) = I(cog) + m (|r|^2 E - r r'). ``replace`` puts the
    payload in the place of the last link, as ``ArmModel.set_payload`` does.
    """
    bodies = [axis.body for axis in spec.axes]
    parts = [_about_origin(body) for body in bodies]
    load = _about_origin(_carried(payload, spec.X_last_flange))
    # the payload is fixed to the last link, so the two are one body of the chain
    parts[-1] = load if mode == "replace" else _sum(parts[-1], load)
    return LinkChain(
        rotations=frozen([axis.placement[:3, :3] for axis in spec.axes]),
        offsets=frozen([axis.placement[:3, 3] for axis in spec.axes]),
        masses=frozen([mass for mass, _, _ in parts]),
        moments=frozen([moment for _, moment, _ in parts]),
        inertias=frozen([inertia for _, _, inertia in parts]),
        gear_ratios=frozen(spec.per_axis("motor", "gear_ratio")),
        sliding=frozenset(np.flatnonzero(spec.slides).tolist()),
    )


_Moments = tuple[float, Array, Array]


def _about_origin(body: Body) -> _Moments:
    """Return mass, first moment (3,) and inertia (3, 3) of a body about its frame's origin."""
    r = body.cog
    return body.mass, body.mass * r, body.inertia + body.mass * (matmul(r, r) * np.eye(3) - np.outer(r, r))


def _sum(a: _Moments, b: _Moments) -> _Moments:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _carried(payload: Payload, X_last_flange: Array) -> Body:
    """Return the payload as a body in the frame of the last axis."""
    R, p = X_last_flange[:3, :3], X_last_flange[:3, 3]
    return Body(mass=payload.mass, cog=matmul(R, payload.cog) + p, inertia=matmul(R, payload.inertia, R.T))


# --- the recursion of 3.4, one axis and one posture ------------------------------------------------------------------


def axis_inertia(chain: LinkChain, q: Array, axis: int) -> float:
    """Return J_i = n_i . Z, kg m2 at the joint, of axis ``axis`` (0-based) at q (n,) rad, without the rotor.

    3.4 as printed: links i+1 to n outward, n to i back.  Raises ``IndexError`` where there is no such axis.
    """
    return dot(_loads(chain, q, axis, last=axis)[axis], _Z)


def inertia_row(chain: LinkChain, q: Array, axis: int) -> Array:
    """Return row ``axis`` of the mass matrix (n,), kg m2, without rotors; its element ``axis`` is J_i.

    3.4 continued: the torque of every axis under the unit acceleration of one is M_ji = n_j . Z. Before link i nothing
    moves, and only the load of the links beyond is carried back to the base. M is symmetric: row and column are one.
    """
    return frozen([matmul(load, _Z) for load in _loads(chain, q, axis, last=0)])


def _loads(chain: LinkChain, q: Array, axis: int, last: int) -> list[Array]:
    """Return n_j (3,) of links ``last`` to n in their frames, f_j where it slides, at their place in a list."""
    if not 0 <= axis < chain.n:
        raise IndexError(f"axis {axis} of {chain.n}")
    R, P = _frames(chain, q)
    # links before the axis stand still, so their accelerations stay zero and their own inertia does not enter
    dw, dv = [_NOTHING] * chain.n, [_NOTHING] * chain.n
    (dv if axis in chain.sliding else dw)[axis] = _Z
    for j in range(axis + 1, chain.n):
        dw[j], dv[j] = outward(R[j], P[j], dw[j - 1], dv[j - 1])
    # no weight: the pass is at rest without gravity, T_i is computed apart (``equations``)
    loads = [_NOTHING] * chain.n
    Rf = Rn = _NOTHING  # R_{j+1} f_{j+1}, and R_{j+1} n_{j+1} + P_{j+1} x (R_{j+1} f_{j+1})
    for j in range(chain.n - 1, last - 1, -1):
        f, n = back(chain, j, dw[j], dv[j], (Rf, Rn))
        loads[j] = f if j in chain.sliding else n
        Rf = matmul(R[j], f)
        Rn = matmul(R[j], n) + cross(P[j], Rf)
    return loads


def _frames(chain: LinkChain, q: Array) -> tuple[list[Array], list[Array]]:
    """Return R_j and P_j of every link at q (n,)."""
    R, P = list(chain.rotations), list(chain.offsets)
    for j, value in enumerate(q.tolist()):
        if j in chain.sliding:
            P[j] = P[j] + value * R[j][:, 2]
        else:
            R[j] = matmul(R[j], _about_z(value))
    return R, P


def outward(R: Array, P: Array, dw: Array, dv: Array) -> tuple[Array, Array]:
    """Return (dw_j, dv_j) from those of link j-1: R_j' dw, R_j' (dw x P_j + dv)."""
    return matmul(R.T, dw), matmul(R.T, cross(dw, P) + dv)


def back(chain: LinkChain, j: int, dw: Array, dv: Array, beyond: tuple[Array, Array]) -> tuple[Array, Array]:
    """Return (f_j, n_j) of link j (0-based); ``beyond``: force and moment of link j+1 at the origin of frame j."""
    Rf, Rn = beyond
    Pm = chain.moments[j]
    f = Rf + chain.masses[j] * dv + cross(dw, Pm)
    n = Rn - cross(dv, Pm) + matmul(chain.inertias[j], dw)
    return f, n


def _about_z(angle: float) -> Array:
    """Return Rot(Z, angle) (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def cross(a: Array, b: Array) -> Array:
    """Return a x b of two (3,); ``numpy.cross`` takes ten times as long for these."""
    (ax, ay, az), (bx, by, bz) = a.tolist(), b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


# --- the same for all axes and many postures -------------------------------------------------------------------------


def link_inertia(chain: LinkChain, q: Array) -> Array:
    """Return J (..., n), kg m2 at the joints, without rotors, at postures q (..., n) rad.

    3.4 for all axes together. Timing: offline, for maps and tables; about 0.1 us per axis and posture in large batches
    (``python -m tests.bench.inertia``).
    """
    # in blocks: the columns of all links at all postures of a large map would not fit the cache
    rows = np.asarray(q, dtype=np.float64).reshape(-1, chain.n)
    J = np.empty_like(rows)
    for start in range(0, len(rows), _BLOCK):
        block = slice(start, start + _BLOCK)
        J[block] = _block(chain, np.ascontiguousarray(rows[block].T)).T
    return J.reshape(np.shape(q))


def _block(chain: LinkChain, q: Array) -> Array:
    """Return J (n, B) at q (n, B). Columns (6, k, B): of link k, under the unit acceleration of each axis up to k."""
    n, count = q.shape
    joints = [_Slide(row) if j in chain.sliding else _Turn(np.cos(row), np.sin(row)) for j, row in enumerate(q)]
    own = [2 if j in chain.sliding else 5 for j in range(n)]  # f . Z or n . Z
    # a step back serves all axes before it: the load beyond link j is needed by each of them alike
    moved = _accelerations(chain, joints, own, count)
    J = np.empty((n, count))
    load = _product(chain.bodies[-1], moved[-1])
    J[-1] = load[own[-1], -1]
    for j in range(n - 2, -1, -1):
        beyond = joints[j + 1].back(load[:, : j + 1])
        load = _product(chain.steps[j + 1].T, beyond) + _product(chain.bodies[j], moved[j])
        J[j] = load[own[j], j]
    return J


def _accelerations(chain: LinkChain, joints: Sequence["_Joint"], own: Sequence[int], count: int) -> Sequence[Array]:
    """Return (dv, dw) of every link j as (6, j+1, B); that of its own axis, the last, is Z."""
    moved: list[Array] = []
    for j in range(chain.n):
        columns = np.zeros((6, j + 1, count))
        if j > 0:
            columns[:, :j] = joints[j].out(_product(chain.steps[j], moved[j - 1]))
        # an acceleration has dv before dw and a load f before n, so one row serves both
        columns[own[j], j] = 1.0
        moved.append(columns)
    return moved


class _Joint(Protocol):
    """A joint at many postures, between its frame at zero and its own."""

    def out(self, columns: Array) -> Array:
        """Return accelerations (6, k, B) in the joint's own frame."""

    def back(self, columns: Array) -> Array:
        """Return loads (6, k, B) in the frame of the joint at zero."""


class _Turn:
    """A joint that turns about z, by angles of cosine c and sine s (B,)."""

    def __init__(self, c: Array, s: Array) -> None:
        self._c, self._s = c, s

    def out(self, columns: Array) -> Array:
        """Return accelerations in the joint's own frame."""
        return _turned(columns, self._c, -self._s)

    def back(self, columns: Array) -> Array:
        """Return loads in the frame of the joint at zero."""
        return _turned(columns, self._c, self._s)


class _Slide:
    """A joint that slides along z, by ``shift`` (B,) m."""

    def __init__(self, shift: Array) -> None:
        self._shift = shift

    def out(self, columns: Array) -> Array:
        """Return accelerations in the joint's own frame: dv + dw x (q Z)."""
        return self._crossed(columns, columns[3:], columns[:3], 0)

    def back(self, columns: Array) -> Array:
        """Return loads in the frame of the joint at zero: n + (q Z) x f."""
        return self._crossed(columns, -columns[:3], columns[3:], 3)

    def _crossed(self, columns: Array, vector: Array, added_to: Array, row: int) -> Array:
        """Return columns with ``vector`` x (q Z) added to the three of them from ``row`` on."""
        found = np.array(columns)
        found[row] = added_to[0] + vector[1] * self._shift
        found[row + 1] = added_to[1] - vector[0] * self._shift
        return found


def _product(matrix: Array, columns: Array) -> Array:
    """Return a constant (6, 6) times columns (6, k, B), as one product of matrices."""
    return np.asarray(matmul(matrix, columns.reshape(6, -1))).reshape(columns.shape)


def _turned(columns: Array, c: Array, s: Array) -> Array:
    """Return both 3-vectors of columns (6, k, B) turned about z, by angles of cosine c and sine s (B,)."""
    out = np.empty(columns.shape)
    x, y = columns[0::3], columns[1::3]
    out[0::3] = c * x - s * y
    out[1::3] = s * x + c * y
    out[2::3] = columns[2::3]
    return out


def motor_side(chain: LinkChain, J: Array) -> Array:
    """Return J_i / N_i^2 (..., n), kg m2 at the motors, of J (..., n) at the joints (3.4, "motor end").

    The rotor's own inertia is not in it, nor the gear's: add J of the rotor, or a compensation that was identified at
    the motor, which has the rotor in it already (3.5).
    """
    return np.asarray(J / chain.gear_ratios**2)
