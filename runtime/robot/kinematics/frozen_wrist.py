r"""Position-only inverse kinematics: the main axes that put the tool point in a place while the wrist is given.

With the wrist axes held, the last main link, the wrist and the tool are one rigid forearm, and the arm is one of three
axes that carries a point. For ortho-parallel arms with a spherical wrist it has a closed form. ``v`` is the tool point
seen from the wrist centre, in the frame that turns with link 3; it makes the forearm another one:

    v   = Rz(t4) Ry(t5) Rz(t6) ((0, 0, c4) + t),    a2* = a2 + vx,  b* = b + vy,  c3* = c3 + vz

With these lengths in place of a2, b and c3 the arm angles of ``opw`` put its end, now the tool point, where it should
be: two signs remain, in front of the waist or in its back, elbow on one side or the other. A continuous motion keeps
both (``Side``); where it cannot, the frozen arm is stretched, folded or above axis 1, and the motion cannot go on.

Other six-axis arms are solved by Newton steps on the position Jacobian of the main axes, each sample from the one
before it.

Source: CN103429397A (Kobe Steel), step S9, which does not give the algorithm; docs/wrist.md derives it. Lengths m,
angles rad, base frame. Called for every candidate of the wrist planner, and in each cycle under a seam sensor.
"""

import math
from dataclasses import dataclass

import numpy as np

from runtime.core.decompositions import least_squares
from runtime.core.frames import Array, inverse
from runtime.core.linear import dot, matmul
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.opw import TURN, Forearm, PlacedOpw, arm_angles
from runtime.robot.model.spec import OpwParameters

WRIST_AXES = 3
"""The wrist is the last three axes."""

MAIN_AXES = 3
"""The main axes are those before it; three of them place a point, so an arm has six axes in all."""

NEWTON_TOLERANCE = 1e-11
"""A place is met when the tool point is within this of it, m."""

_NEWTON_STEPS = 30
"""Steps from one sample of a path to the next; quadratic convergence needs a few."""
_LARGEST_STEP = 0.3
"""Rad; a step beyond is more likely to end on another side of the arm."""
_EDGE = 1e-9
"""Below this, m or as a sine, the side of a frozen arm is not defined."""


@dataclass(frozen=True, slots=True)
class Side:
    """Which of its solutions an arm with a frozen wrist is in: ``arm`` and ``elbow`` are +1 or -1, 0 on the edge."""

    arm: int
    elbow: int


class FrozenWrist:
    """Position-only kinematics of one six-axis arm with one tool; ``X_flange_tool`` (4, 4)."""

    def __init__(self, kinematics: Kinematics, X_flange_tool: Array) -> None:
        self._kinematics = kinematics
        self._X_flange_tool = X_flange_tool
        self._main = kinematics.n - WRIST_AXES
        if self._main != MAIN_AXES:
            raise ValueError(f"an arm of {kinematics.n} axes has no wrist and three main axes")
        self._opw = kinematics.opw

    def side_of(self, q: Array) -> Side | None:
        """Return the side of joint angles q (n,) rad; None for an arm without a closed form."""
        params = self._opw
        if params is None:
            return None
        forearm = self._forearm(params, np.asarray(q)[None, self._main :])
        a2, c3 = forearm.a2, forearm.c3
        theta = params.signs * q + params.offsets
        g = float(theta[2] + np.arctan2(a2[0], c3[0]))
        r = params.a1 + params.c2 * math.sin(theta[1]) + math.hypot(a2[0], c3[0]) * math.sin(theta[1] + g)
        # the elbow is counted as seen from the arm, as in ``opw``; on the edge of the arm as if it were in front
        arm = 0 if abs(r) < _EDGE else int(math.copysign(1, r))
        bend = math.sin(g)
        return Side(arm, 0 if abs(bend) < _EDGE else int(math.copysign(1, bend)) * (arm or 1))

    def solve(self, p_base_tool: Array, q_wrist: Array, q_before: Array, side: Side | None) -> Array:
        """Return all joint angles (N, n) with the tool point at p_base_tool (N, 3) and the wrist at q_wrist (N, 3).

        The samples are a path that goes on from joint angles ``q_before`` (n,): main axes are those of ``side`` (from
        ``side_of``), turned to be continuous with it. NaN where the place is out of reach.
        """
        if self._opw is None or side is None:
            main = self._newton(p_base_tool, q_wrist, q_before[: self._main])
        else:
            main = self._closed(self._opw, p_base_tool, q_wrist, side)
            # whole turns counted from the start serve unless a joint crosses half a turn; then the path is unwrapped
            main += TURN * np.round((q_before[: self._main] - main) / TURN)
            if len(main) > 1 and not np.abs(np.diff(main, axis=0)).max(initial=0.0) <= math.pi:
                main = np.unwrap(np.concatenate([q_before[None, : self._main], main]), axis=0)[1:]
        return np.concatenate([main, q_wrist], axis=1)

    def _closed(self, params: OpwParameters, p: Array, q_wrist: Array, side: Side) -> Array:
        """Return the main axes (N, 3) rad that put the tool point at p (N, 3) m with the wrist at q_wrist (N, 3)."""
        if isinstance(params, PlacedOpw):
            X = inverse(params.X_base_opw)
            p = matmul(p, X[:3, :3].T) + X[:3, 3]
        with np.errstate(invalid="ignore"):
            t1, t2, t3 = arm_angles(params, p, side.arm, side.elbow, self._forearm(params, q_wrist))
        theta = np.stack([t1, t2, t3], axis=-1)
        theta[np.isnan(theta).any(axis=-1)] = np.nan
        return np.asarray((theta - params.offsets[:3]) * params.signs[:3])

    def _forearm(self, params: OpwParameters, q_wrist: Array) -> Forearm:
        """Return a2*, b* and c3* (N,) of the forearm that ends in the tool point, wrist at q_wrist (N, 3)."""
        t4, t5, t6 = (params.signs[3:] * q_wrist + params.offsets[3:]).T
        X = self._X_flange_tool
        x, y, z = (matmul(params.X_opw_flange, X) if isinstance(params, PlacedOpw) else X)[:3, 3]
        z = z + params.c4
        c4, s4, c5, s5, c6, s6 = np.cos(t4), np.sin(t4), np.cos(t5), np.sin(t5), np.cos(t6), np.sin(t6)
        u, w = c6 * x - s6 * y, s6 * x + c6 * y  # after Rz(t6)
        forward = c5 * u + s5 * z  # after Ry(t5)
        return Forearm(params.a2 + c4 * forward - s4 * w, params.b + s4 * forward + c4 * w, params.c3 - s5 * u + c5 * z)

    def _newton(self, p_base_tool: Array, q_wrist: Array, q_main: Array) -> Array:
        """Return the main axes (N, 3) rad of a path, each sample from the one before; NaN from the first not met on."""
        rows = np.full((len(p_base_tool), self._main), np.nan)
        main = np.array(q_main)
        for k, (p, wrist) in enumerate(zip(p_base_tool, q_wrist, strict=True)):
            found = self._newton_step_by_step(p, wrist, main)
            if found is None:
                break  # the samples after it could only be met on another side of the arm
            rows[k] = main = found
        return rows

    def _newton_step_by_step(self, p: Array, q_wrist: Array, q_main: Array) -> Array | None:
        q = np.concatenate([q_main, q_wrist])
        offset = self._X_flange_tool[:3, 3]
        for _ in range(_NEWTON_STEPS):
            p_tool, J = self._kinematics.newton.point(q, offset)
            error = p - p_tool
            if not dot(error, error) > NEWTON_TOLERANCE**2:
                return q[: self._main] if np.isfinite(q).all() else None
            # small singular values are cut: stretched, the arm cannot move outwards, and a huge step would be no help
            step = least_squares(J[:, : self._main], error, rcond=1e-6)
            largest = float(np.abs(step).max())
            q[: self._main] += step if largest <= _LARGEST_STEP else step * (_LARGEST_STEP / largest)
        return None
