"""Kinematics of a robot: where the flange is, which joint angles put it there, how it moves with the joints.

``Kinematics`` is what planner, session, cell and command line use. Forward kinematics and the Jacobian
come from the chain of axes of the arm (the same data that Pinocchio and MuJoCo are built from). Inverse kinematics is
the closed form (``opw``) where the arm has one: given in its robot file, where it must match the chain to 1e-9 m, or
found from the joint lines (``closed_form``). Other arms of 2 to 7 axes are solved by damped Newton steps (``newton``);
their only branch is ``NUMERIC``. All arrays are in the base frame, m and rad, and broadcast over leading dimensions.

    X_base_flange = prod_i (placement_i Rz(q_i)) X_last_flange
    column i of the Jacobian = [ z_i x (p_flange - p_i) ; z_i ],   z_i and p_i: direction of and a point on axis i

An axis that slides has Tz(q_i) and the column [ z_i ; 0 ]; its coordinate is m, and nothing here turns it.

Turns. Both solutions give each angle up to whole turns of 2 pi, and a joint with a range above one turn has several
of them in it. Of those inside the range the one nearest to a reference is taken: the present joint angles, or the
middle of the range. Where none is inside, the one nearest to the middle is returned, and the margin is negative. Half a
turn from the reference two are equally near: the one farther from the ends of the range is taken, or else the larger.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from runtime.core.frames import Array, frozen, is_half_turn
from runtime.core.linear import cross, matmul
from runtime.core.units import DEG
from runtime.robot.kinematics import opw
from runtime.robot.kinematics.chain import Chain
from runtime.robot.kinematics.closed_form import find_opw
from runtime.robot.kinematics.newton import NewtonSolver
from runtime.robot.kinematics.opw import BRANCHES, NUMERIC, TURN, Branch, Geometry
from runtime.robot.model.spec import OpwParameters

LIMIT_ROUNDING = 1e-9
"""A joint this far outside its range, rad, is not turned by a whole turn to bring it in."""

REDUNDANT_ABOVE = 6
"""With more axes an arm meets a pose with infinitely many joint angles."""

SAME_ANGLES = 1e-9
"""Two branches whose joints differ by less, rad, are one solution (they merge at a singularity)."""

SAME_ROOM = 0.01 * DEG
"""Two angles whose distances from the ends of the range differ by less, rad, count as equally far: taught angles have
three decimals, and rounding must not decide which of the two a robot takes."""

MOST_NUMERIC, MOST_REDUNDANT = 16, 8
"""Most solutions of Newton's method that are listed: of arms of up to 6 axes, which have 16 at most, and of 7."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Solution:
    """Joint angles that meet a pose: q (n,) rad, its branch, and its smallest distance to a limit, rad.

    A negative ``limit_margin`` says how far the worst joint is outside its range.
    """

    q: Array
    branch: Branch
    limit_margin: float


class Kinematics:
    """Kinematics of one arm, of 2 to 7 axes. Keeps nothing between calls."""

    def __init__(self, spec: Geometry) -> None:
        self.spec = spec
        self.n = spec.n
        self._opw = spec.opw if spec.opw is not None else find_opw(spec.axes, spec.X_last_flange)
        self.chain = Chain.of(spec.axes, spec.X_last_flange)
        """The joint frames."""
        sliding = self.chain.sliding
        self.newton = NewtonSolver(self.chain.placements, spec.X_last_flange, sliding)
        """Solves what has no closed form."""
        self._lower, self._upper = frozen(spec.lower), frozen(spec.upper)
        self._middle = frozen(0.5 * (spec.lower + spec.upper))
        self.turning = frozen(np.array([0.0 if index in sliding else 1.0 for index in range(spec.n)]))
        """1 of each axis (n,) that turns, 0 of one that slides: what whole turns count for."""
        self.units = frozen(np.array([axis.kind.size for axis in spec.axes]))
        """What people type and read of each axis, as SI (n,): deg or mm."""

    @property
    def closed_form(self) -> bool:
        """Whether poses are solved in closed form, branch by branch."""
        return self._opw is not None

    @property
    def opw(self) -> OpwParameters | None:
        """Parameters of the closed form; None for an arm that has none."""
        return self._opw

    def forward(self, q: ArrayLike) -> Array:
        """Return X_base_flange (..., 4, 4) of joint angles (..., n) rad."""
        return self.chain.flange(q)

    def jacobian(self, q: ArrayLike) -> Array:
        """Return the Jacobian (..., 6, n): rows 0-2 velocity of the flange origin m/s per rad/s, 3-5 angular."""
        return self.jacobian_and_rotation(q)[0]

    def jacobian_and_rotation(self, q: ArrayLike) -> tuple[Array, Array]:
        """Return the Jacobian (..., 6, n) and the rotation (..., 3, 3) of the flange at joint angles (..., n) rad."""
        frames = list(self.chain.axis_frames(np.asarray(q, dtype=np.float64)))
        X_base_flange = matmul(frames[-1], self.spec.X_last_flange)
        columns = [
            _slide(X) if index in self.chain.sliding else _twist(X, X_base_flange[..., :3, 3])
            for index, X in enumerate(frames)
        ]
        return np.stack(columns, axis=-1), X_base_flange[..., :3, :3]

    def inverse_branch(self, X_base_flange: Array, branch: Branch, near: ArrayLike | None = None) -> Array:
        """Return the joint angles (..., n) rad of one branch for poses (..., 4, 4); NaN where it does not exist.

        With ``near`` (..., n) each joint is the whole turn nearest to it, in range or not, and J1 and J4 follow it
        where a singularity leaves them free; without, each is turned into its range. Samples of a path (N, 4, 4):
        pass the start as ``near`` and unwrap the result along the path (``np.unwrap(q, axis=0)``).
        An arm without a closed form knows no branches: the samples are solved one after the other, each from the one
        before it, the first from ``near`` (n,) or from the middle of the ranges, and NaN is where that does not
        converge to 1e-10 (m and rad).
        Timing: called by the path planner on all samples of a move at once; in closed form without a loop over poses.
        """
        if self._opw is None:
            return self.newton.follow(np.asarray(X_base_flange), self._start(near))
        q = opw.inverse_branch(self._opw, X_base_flange, branch, near)
        return self._into_range(q, None) if near is None else self.nearest_turns(q, near)

    def solutions(self, X_base_flange: Array, near: ArrayLike | None = None) -> list[Solution]:
        """Return every solution of one pose (4, 4), in the order of ``BRANCHES``; empty when out of reach.

        Each joint is turned into its range where it can be, as close to ``near`` (n,) or mid-range as the range
        allows. Branches that merge at a singularity are listed once, under the first of their names. An arm without a
        closed form gives what Newton's method finds from several starts: of a redundant arm, some of infinitely many.
        """
        params = self._opw
        if params is None:
            return self._numeric_solutions(self._start(near), X_base_flange)
        return self._distinct(self._into_range(opw.inverse(params, X_base_flange, near), near)[None])[0]

    def solutions_each(self, X_base_flange: Array, near: ArrayLike | None = None) -> list[list[Solution]]:
        """Return the ``solutions`` of poses (N, 4, 4), all solved at once where the arm has a closed form."""
        if self._opw is None:
            return [self.solutions(X, near) for X in X_base_flange]
        return self._distinct(self._into_range(opw.inverse(self._opw, X_base_flange, near), near))

    def _distinct(self, rows: Array) -> list[list[Solution]]:
        """Return the solutions of rows (N, 8, 6) rad inside the ranges, one for each branch, those that exist."""
        # inside the ranges before merging: branches that merge may lie whole turns apart
        apart: Array = np.abs(opw.wrapped(rows[:, :, None] - rows[:, None])).max(axis=-1)
        exists, same = np.asarray(~np.isnan(rows).any(axis=-1)), np.asarray(apart < SAME_ANGLES)
        margins = self.limit_margin(rows)
        found: list[list[Solution]] = []
        for row in range(len(rows)):
            kept: list[int] = []
            for branch in np.flatnonzero(exists[row]).tolist():
                if not same[row, branch, kept].any():
                    kept.append(branch)
            found.append(
                [
                    Solution(q=frozen(rows[row, b]), branch=BRANCHES[b], limit_margin=float(margins[row, b]))
                    for b in kept
                ]
            )
        return found

    def other_turns(self, solution: Solution) -> Iterator[Solution]:
        """Yield all other joint angles inside the ranges that differ from a solution there by whole turns of joints."""
        for turns in product(*(sorted(counts, key=abs) for counts in self._turns(solution))):
            if any(turns):
                q = solution.q + TURN * np.array(turns)
                yield Solution(q=frozen(q), branch=solution.branch, limit_margin=float(self.limit_margin(q)))

    def turn_count(self, solution: Solution) -> int:
        """Return how many ``other_turns`` there are."""
        return math.prod(map(len, self._turns(solution))) - 1

    def _turns(self, solution: Solution) -> list[range]:
        """Return by how many whole turns each joint can be turned inside its range; 0 for a solution outside."""
        if not solution.limit_margin >= -LIMIT_ROUNDING:
            return [range(1)] * self.n
        fewest, most = self._fewest_and_most(solution.q)
        return [range(int(low), int(high) + 1) for low, high in zip(fewest, most, strict=True)]

    def branch_of(self, q: ArrayLike) -> Branch:
        """Return the branch of one joint vector (n,) rad; ``NUMERIC`` for an arm without a closed form."""
        if self._opw is None:
            return NUMERIC
        return opw.branch_of(self._opw, q)

    def changes(self, q_from: ArrayLike, q_to: ArrayLike) -> tuple[tuple[str, str], ...]:
        """Return what of the branch two joint vectors (n,) rad differ in, as ``opw.changes``; () without branches."""
        return () if self._opw is None else opw.changes(self._opw, q_from, q_to)

    def limit_margin(self, q: ArrayLike) -> Array:
        """Return the smallest distance to a joint limit (...,) rad of joint angles (..., n), negative outside.

        A mm of an axis that slides counts as a deg, as in ``RobotSpec.bound``.
        """
        angles = np.asarray(q, dtype=np.float64)
        margins = np.minimum(angles - self._lower, self._upper - angles) / (self.units / DEG)
        return np.asarray(margins.min(axis=-1))

    def nearest_turns(self, q: ArrayLike, near: ArrayLike) -> Array:
        """Return q (..., n) rad turned by whole turns to within half a turn of ``near`` (..., n), limits or not."""
        angles = np.asarray(q, dtype=np.float64)
        turns = self.turning * np.round((np.asarray(near, dtype=np.float64) - angles) / TURN)
        return np.asarray(angles + TURN * turns)

    def freer_half_turn(self, q: Array, near: Array) -> Array:
        """Return q (..., n) rad, each joint that is half a turn from ``near`` (..., n) on the side with more room."""
        low, high = np.where(q > near, q - TURN, q), np.where(q > near, q, q + TURN)
        room_low, room_high = (np.minimum(each - self._lower, self._upper - each) for each in (low, high))
        freer = np.where(room_low > room_high + SAME_ROOM, low, high)
        return np.where(is_half_turn(q - near) & (self.turning > 0.0), freer, q)

    def _start(self, near: ArrayLike | None) -> Array:
        return self._middle if near is None else np.asarray(near, dtype=np.float64)

    def _numeric_solutions(self, near: Array, X_base_flange: Array) -> list[Solution]:
        rows = self.newton.search(np.asarray(X_base_flange), near, self._lower, self._upper)
        turned = (self._into_range(q, near) for q in rows)
        found = [Solution(q=frozen(q), branch=NUMERIC, limit_margin=float(self.limit_margin(q))) for q in turned]
        found.sort(key=lambda solution: solution.limit_margin < 0.0)  # in range first; the sort keeps the order else
        return found[: MOST_REDUNDANT if self.n > REDUNDANT_ABOVE else MOST_NUMERIC]

    def _into_range(self, q: Array, near: ArrayLike | None) -> Array:
        """Return q (..., n) rad turned by whole turns as the module says: inside the range, near the reference."""
        reference = self._middle if near is None else np.asarray(near, dtype=np.float64)
        nearest = self.freer_half_turn(self.nearest_turns(q, reference), reference)
        fewest, most = self._fewest_and_most(nearest)
        # the fewest whole turns that bring it inside; where fewest > most no turn does
        inside = nearest + TURN * np.clip(0.0, fewest, most)
        return np.where(fewest <= most, inside, self.nearest_turns(q, self._middle))

    def _fewest_and_most(self, q: Array) -> tuple[Array, Array]:
        """Return the whole turns (..., n) from q on that still end inside the range; none of an axis that slides."""
        fewest = self.turning * np.ceil((self._lower - LIMIT_ROUNDING - q) / TURN)
        return fewest, self.turning * np.floor((self._upper + LIMIT_ROUNDING - q) / TURN)


def _slide(X_base_axis: Array) -> Array:
    """Return one column (..., 6) of the Jacobian: the flange's motion for 1 m/s of an axis that slides."""
    z = X_base_axis[..., :3, 2]
    return np.concatenate([z, np.zeros_like(z)], axis=-1)


def _twist(X_base_axis: Array, p_flange: Array) -> Array:
    """Return one column (..., 6) of the Jacobian: the flange's motion for 1 rad/s of an axis."""
    z, p = X_base_axis[..., :3, 2], X_base_axis[..., :3, 3]
    return np.concatenate([cross(z, p_flange - p), z], axis=-1)
