"""Inverse kinematics of arms without a closed form: damped Newton steps on the Jacobian of Pinocchio.

The error of a pose is ``e = [p - p(q); log(R R(q)')]`` in the base frame, m and rad (one rad counts as 1 m). With the
Jacobian J of the flange, in the same frame, a step solves the damped least squares of Levenberg and Marquardt,

    dq = (J'J + mu E)^-1 J' e   = J' (J J' + mu E)^-1 e,        mu = DAMPING |e|^2

in the form with the smaller matrix. The damping vanishes with the error, so steps end as Newton's and converge
quadratically (T. Sugihara, Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method, IEEE Trans.
Robotics 27(5), 2011); a step that makes the error larger is taken back and damped ten times more. For redundant arms
(7 axes) the step is the shortest one, so the posture changes no more than the path asks; it is not brought back to a
preferred one. Arms with fewer than 6 axes meet a pose only if it lies in what they can reach: the least squares then
end in an error that is not zero, and the answer is NaN, as it is for any pose out of reach.

Near a singularity convergence is linear, and a pose at its very edge may be given up (NaN) though it can be met.
Called by ``Kinematics``: for each sample of a path, and for searches; m and rad, base frame.
"""

import math
from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from runtime.core.decompositions import solve
from runtime.core.frames import Array
from runtime.core.linear import cross, dot, matmul, norm

TOLERANCE = 1e-10
"""A pose is met when position (m) and orientation (rad) are within this of it."""

DAMPING = 1e-2
"""mu over |e|^2: small against J J', whose entries are about 1, as soon as the error is."""
LARGEST_STEP = 0.5
"""No joint goes further in one step, rad or m: beyond, the linear model says nothing."""

STEPS = 100
"""Most steps of one solve; those that were taken back and damped more count."""
SEEDS, MOST_SEEDS = 40, 400
"""Fewest and most starts of a search; between them it ends when it is likely to be complete."""
SAME = 1e-6
"""Solutions of a search whose joints differ by less, rad and whole turns apart, are one: near a singularity their
digits are fewer."""
_WORST_DAMPING = 1e8
"""Damping that no longer helps: the error is at a minimum that is not zero, the pose out of reach."""
_DETERMINED = 6
"""Axes with which a pose has a finite number of solutions."""


class NewtonSolver:
    """Solves poses for one chain of axes: ``placements`` n times (4, 4), ``X_last_flange`` (4, 4).

    ``sliding`` are the indices of the axes that slide; they have no whole turns.
    """

    def __init__(
        self, placements: Sequence[Array], X_last_flange: Array, sliding: frozenset[int] = frozenset()
    ) -> None:
        self.n = len(placements)
        self._turning = np.array([index not in sliding for index in range(self.n)])
        self._model = pin.Model()
        parent = 0
        for index, placement in enumerate(placements):
            joint = pin.JointModelPZ() if index in sliding else pin.JointModelRZ()
            parent = self._model.addJoint(parent, joint, pin.SE3(placement), f"axis{index}")
        self._flange = pin.SE3(X_last_flange)
        self._data = self._model.createData()
        self._eye = np.eye(min(self.n, _DETERMINED))
        # keeps the matrix invertible when the error, and with it the damping, is zero at a singularity
        self._least = 1e-15 * self._eye

    def follow(self, X_base_flange: Array, q_start: Array) -> Array:
        """Return joint angles (..., n) for poses (..., 4, 4); NaN where they cannot be met.

        ``q_start`` (n,): the poses are a path, each is solved from the one before it; (..., n): each has its own.
        """
        poses = X_base_flange.reshape(-1, 4, 4)
        own = np.ndim(q_start) > 1
        starts = np.broadcast_to(q_start, (*X_base_flange.shape[:-2], self.n)).reshape(-1, self.n)
        # a pose that is not met leaves NaN, and the next one starts from the last that was
        rows = np.empty((len(poses), self.n))
        q = np.array(starts[0]) if len(poses) else np.zeros(self.n)
        for index, X in enumerate(poses):
            rows[index] = self.solve(X, starts[index] if own else q)
            if np.isfinite(rows[index, 0]):
                q = rows[index]
        return rows.reshape(*X_base_flange.shape[:-2], self.n)

    def solve(self, X_base_flange: Array, q_start: Array) -> Array:
        """Return joint angles (n,) that meet one pose (4, 4), nearest in steps from q_start (n,); NaN when none do."""
        q = np.array(q_start, dtype=np.float64)
        e = self._error(X_base_flange, q)
        size, worse = dot(e, e), 1.0
        for _ in range(STEPS):
            if norm(e[:3]) < TOLERANCE and norm(e[3:]) < TOLERANCE:
                return q
            # damped so much and still not better: no neighbour of q is
            if not worse < _WORST_DAMPING:
                break
            trial = q + self._step(q, e, DAMPING * size * worse)
            e_trial = self._error(X_base_flange, trial)
            size_trial = dot(e_trial, e_trial)
            if size_trial < size:
                q, e, size, worse = trial, e_trial, size_trial, max(1.0, 0.1 * worse)
            else:
                worse *= 10.0
        return np.full(self.n, np.nan)

    def search(self, X_base_flange: Array, near: Array, lower: Array, upper: Array) -> list[Array]:
        """Return solutions (n,) of one pose from several starts: ``near``, mid-range, and points of the ranges.

        Whole turns apart they are the same. They may be outside the ranges, and some may be missing: of an arm of up
        to 6 axes the search goes on while one was met from one start only, since then others are likely not to be met
        yet (I. J. Good, The population frequencies of species, Biometrika 40, 1953), or while those of 6 axes are odd
        in number, which they are nowhere but at a singularity. The starts are the same in every call.
        """
        # whole turns apart is the same start, so the points of a wide range lie within half a turn of its middle
        middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
        half = np.where(self._turning, np.minimum(half, math.pi), half)
        random = np.random.default_rng(1992)
        found: list[Array] = []
        met: list[int] = []
        for number in range(MOST_SEEDS + 2):
            if number > SEEDS + 1 and self._settled(met):
                break
            start = (near, middle)[number] if number < 2 else middle + half * random.uniform(-1.0, 1.0, self.n)
            q = self.solve(X_base_flange, start)
            if not np.isfinite(q).all():
                continue
            known = next((k for k, other in enumerate(found) if self._apart(q, other) < SAME), None)
            if known is None:
                found.append(q)
                met.append(1)
            else:
                met[known] += 1
        return found

    def _settled(self, met: list[int]) -> bool:
        """Return whether a search that has met each of its solutions so often is likely to be complete."""
        return self.n > _DETERMINED or (1 not in met and not (self.n == _DETERMINED and len(met) % 2))

    def point(self, q: Array, offset: Array) -> tuple[Array, Array]:
        """Return position (3,) m and Jacobian (3, n), base frame, of a point ``offset`` (3,) m of the flange frame."""
        J = pin.computeJointJacobians(self._model, self._data, q)  # of the point at the base origin, base frame
        p = (self._data.oMi[self.n] * self._flange).act(offset)
        return p, J[:3] + cross(J[3:].T, p).T

    def _error(self, X_base_flange: Array, q: Array) -> Array:
        pin.forwardKinematics(self._model, self._data, q)
        here = self._data.oMi[self.n] * self._flange
        e = np.empty(6)
        e[:3] = X_base_flange[:3, 3] - here.translation
        e[3:] = pin.log3(matmul(X_base_flange[:3, :3], here.rotation.T))
        return e

    def _step(self, q: Array, e: Array, mu: float) -> Array:
        J = self._jacobian(q)
        damped = mu * self._eye
        if self.n < _DETERMINED:
            dq = solve(matmul(J.T, J) + damped + self._least, matmul(J.T, e))
        else:
            dq = matmul(J.T, solve(matmul(J, J.T) + damped + self._least, e))
        # shortened as a whole: its direction is that of the least squares
        largest = float(np.abs(dq).max())
        return np.asarray(dq if largest <= LARGEST_STEP else dq * (LARGEST_STEP / largest))

    def _jacobian(self, q: Array) -> Array:
        """Return the Jacobian (6, n) of the flange origin, base frame: rows 0-2 linear, 3-5 angular."""
        J = pin.computeJointJacobians(self._model, self._data, q)  # of the point at the base origin, base frame
        p = (self._data.oMi[self.n] * self._flange).translation
        moved = np.array(J)
        moved[:3] += cross(J[3:].T, p).T
        return moved

    def _apart(self, q: Array, other: Array) -> float:
        """Return how far two joint vectors (n,) are apart but for whole turns, rad or m."""
        apart = q - other
        wrapped = np.remainder(apart + math.pi, 2.0 * math.pi) - math.pi
        return float(np.abs(np.where(self._turning, wrapped, apart)).max())
