"""Joint angles along a path: in the posture of the path, or with the wrist following a law of its own from a switch on.

``LineSolver`` keeps the arm configuration of the start and meets every pose of the path. ``WristSolver`` does the same
up to a switch; from there the wrist follows a ``WristLaw`` and the main axes put the tool point on the path
(S7 to S9 of CN103429397A; docs/wrist.md). Both are functions of the path parameter, so a slower move is the same curve
with more samples. ``joints`` refuses what cannot be executed, with the place on the path: out of reach (RBL410), out of
a joint's range (RBL411), through a singularity or into another configuration (RBL412). Called by the planner, before
anything moves.
"""

import math
from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array, inverse
from runtime.core.linear import matmul
from runtime.core.units import MM
from runtime.motion.fine_interpolator import FineInterpolator, through
from runtime.motion.path import Path
from runtime.motion.wrist.hold import WristTable
from runtime.motion.wrist.switch import SAME_ANGLES, WristLaw
from runtime.robot.kinematics.frozen_wrist import FrozenWrist
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.opw import Branch
from runtime.robot.model.spec import RobotSpec

RANGE_TOLERANCE = 1e-9
"""How far past its range a joint may be commanded, rad: rounding, nothing more."""

MOST_SLOWDOWN = 20.0
"""A move that would have to be slowed more runs too close to a singularity: refused rather than crawled through."""

FREE = 6
"""Axes with which an arm can turn its tool in every direction."""

JUMP = math.pi / 4.0
"""A joint that turns further from one sample to the next, rad, has changed its configuration."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Arm:
    """What every solver of one robot needs: its data, its kinematics, its fine interpolation and the tool in use."""

    spec: RobotSpec
    kinematics: Kinematics
    fine: FineInterpolator
    X_flange_tool: Array


class LineSolver:
    """Joint angles along one path in one configuration: that of q_start (n,), or with ``to_end`` that of its end."""

    def __init__(self, arm: Arm, path: Path, q_start: Array, *, to_end: bool = False) -> None:
        self.arm, self.path, self.q_start = arm, path, q_start
        self._X_tool_flange = inverse(arm.X_flange_tool)
        self.branch: Branch = arm.kinematics.branch_of(q_start)
        self._known = -1 if to_end else 0
        # the answers for the last samples: a planner needs them again, and solving them is most of its time
        self._solved: tuple[Array, Array] | None = None
        self._posed: tuple[Array, Array] | None = None

    def rows(self, s: Array) -> Array:
        """Return q (N + 1, n) at path parameters s, continuous with the known end; NaN where there is no solution.

        The last answer is kept: a planner needs the same samples again for every candidate that leaves this path.
        """
        if self._solved is None or self._solved[0] is not s:
            self._solved = s, self._solve(s)
        return self._solved[1].copy()

    def planned(self, s: Array) -> Array:
        """Return the poses (N + 1, 4, 4) of the path at s, kept like the answer of ``rows``."""
        if self._posed is None or self._posed[0] is not s:
            self._posed = s, self.path.poses(s)
        return self._posed[1]

    def _solve(self, s: Array) -> Array:
        poses = matmul(self.planned(s), self._X_tool_flange)
        if self._known:  # an arm without branches follows its solution, so it has to begin where that is known
            poses = poses[::-1]
        q = self.arm.kinematics.inverse_branch(poses, self.branch, self.q_start)
        # whole turns are counted along the path, from the known end: a joint may pass half a turn on its path
        q = np.unwrap(q, axis=0) + 0.0
        q += 2.0 * math.pi * np.round((self.q_start - q[0]) / (2.0 * math.pi))
        return q[::-1] if self._known else q

    def joints(self, s: Array) -> Array:
        """Return q (N + 1, n) at path parameters s; ``Fault`` RBL410, 411, 412."""
        q = self.rows(s)
        self._check_reach(s, q)
        self._check_continuity(s, q)
        q[0] = self.q_start  # where the arm is, to the last bit, not where the inverse kinematics puts it
        check_range(self.arm, s, q)
        return q

    def setpoints(self, q: Array) -> Array:
        """Return the set-points (N + 1, n) of a command that passes joints q (N + 1, n) at its knots."""
        return through(q)

    def _check_reach(self, s: Array, q: Array) -> None:
        """Refuse a path with samples out of reach; ``Fault`` RBL410 names the first."""
        bad = ~np.isfinite(q).all(axis=1)
        if not bad.any():
            return
        first = int(np.argmax(bad))
        place = self.path.points(s[first : first + 1])[0] / MM
        raise Fault(
            "RBL410",
            f"the point ({place[0]:.1f}, {place[1]:.1f}, {place[2]:.1f}) mm at {100 * s[first]:.1f} % of the path is "
            f"out of reach of {self.arm.spec.name} ({self.branch})",
            few_axes(self.arm.spec),
        )

    def _check_continuity(self, s: Array, q: Array) -> None:
        """Refuse a path on which a joint jumps: through a singularity, or at its start; ``Fault`` RBL412."""
        jumps = np.abs(np.diff(q, axis=0))
        if not np.abs(q[0] - self.q_start).max() <= 1e-3:  # the start is itself at a singularity
            self.refuse_singular(s[:1], q, int(np.argmax(np.abs(q[0] - self.q_start))))
        # a move of a few samples is too fast, not discontinuous: the limits of the joints judge it
        if len(jumps) > 4 and not jumps.max() <= JUMP:
            step, axis = np.unravel_index(int(np.argmax(jumps)), jumps.shape)
            self.refuse_singular(s[step : step + 1], q, int(axis))

    def refuse_singular(self, s: Array, q: Array, axis: int) -> NoReturn:
        """Raise ``Fault`` RBL412 where axis moves most between two samples."""
        raise Fault(
            "RBL412",
            f"at {100 * _steepest(s, q, axis):.1f} % of the {self.path.name} J{axis + 1} would have to turn too fast: "
            f"it passes a singularity, or its end needs another configuration than {self.branch}",
        )


class WristSolver:
    """Joint angles along one path whose wrist follows ``law`` from its switch to its return, and which ends at q_end.

    From the return on, where it is before the end, ``back`` has the joints: the path in the configuration of q_end
    (n,).
    """

    def __init__(
        self,
        line: LineSolver,
        law: WristLaw | WristTable,
        q_switch: Array,
        q_end: Array,
        back: LineSolver | None = None,
    ) -> None:
        self.arm = line.arm
        self._line, self.law, self._q_end, self._back = line, law, q_end, back
        self._frozen = FrozenWrist(line.arm.kinematics, line.arm.X_flange_tool)
        self._q_switch = q_switch
        self._side = self._frozen.side_of(q_switch)

    def rows(self, s: Array) -> Array:
        """Return q (N + 1, n) at path parameters s; NaN where there is no solution."""
        # three parts: the path up to the switch, the law of the wrist, and the path again from a return on
        first, last = np.searchsorted(s, [self.law.s_switch, self.law.s_return], side="right")
        inner = s[first:last]
        parts = [self._frozen.solve(self._line.path.points(inner), self.law.angles(inner), self._q_switch, self._side)]
        if first:
            parts.insert(0, self._line.rows(s)[:first])
            parts[0][0] = self._line.q_start
        if last < len(s) and self._back is not None:
            parts.append(self._back.rows(s)[last:])
        return np.concatenate(parts)

    def joints(self, s: Array) -> Array:
        """Return q (N + 1, n) at path parameters s; ``Fault`` RBL411 or RBL412."""
        q = self.rows(s)
        lost = ~np.isfinite(q).all(axis=1)
        if lost.any():
            raise Fault(
                "RBL412",
                f"at {100 * s[int(np.argmax(lost))]:.1f} % of the {self._line.path.name} the wrist, moving to its end "
                f"angles, takes the tool point out of reach of the main axes",
            )
        # H2: the side of the frozen arm is kept, so a jump or a wrong end means that the main axes changed theirs
        jumps = np.abs(np.diff(q, axis=0))
        step, axis = np.unravel_index(int(np.argmax(jumps)), jumps.shape)
        if len(jumps) > 4 and not jumps[step, axis] <= JUMP:
            raise Fault(
                "RBL412",
                f"at {100 * s[step]:.1f} % of the {self._line.path.name} J{axis + 1} would have to "
                "change the arm configuration",
            )
        off = np.abs(q[-1] - self._q_end)
        if not off.max() <= SAME_ANGLES:
            worst = int(np.argmax(off))
            kind = self._line.arm.spec.axes[worst].kind
            raise Fault(
                "RBL412",
                f"the move would end with J{worst + 1} at {kind.text(q[-1, worst], '.1f')} in another "
                f"arm configuration, not at the taught {kind.text(self._q_end[worst], '.1f')}",
            )
        q[-1] = self._q_end
        check_range(self._line.arm, s, q)
        return q

    def setpoints(self, q: Array) -> Array:
        """Return the set-points (N + 1, n) of a command that passes joints q (N + 1, n) at its knots."""
        return through(q)

    def refuse_singular(self, s: Array, q: Array, axis: int) -> NoReturn:
        """Raise ``Fault`` RBL412 where axis moves most between two samples."""
        raise Fault(
            "RBL412",
            f"at {100 * _steepest(s, q, axis):.1f} % of the {self._line.path.name} J{axis + 1} would have to turn too "
            "fast while the wrist goes to its end angles",
        )


def few_axes(spec: RobotSpec) -> str:
    """Return what to know about poses out of reach of an arm that cannot turn its tool freely; empty for 6 axes."""
    if spec.n >= FREE:
        return ""
    return (
        f"The {spec.n} axes of {spec.name} cannot turn the tool in every direction: compare rx, ry and rz with those "
        "of HERE."
    )


def _steepest(s: Array, q: Array, axis: int) -> float:
    """Return the path parameter at which an axis (0-based) moves most between two samples of q (N + 1, n)."""
    if len(s) == len(q) and len(s) > 1:
        return float(s[int(np.argmax(np.abs(np.diff(q[:, axis]))))])
    return float(s[0])


def check_range(arm: Arm, s: Array, q: Array) -> None:
    """Refuse a path that leaves a joint's range at any servo tick, where the command may pass the set-points; RBL411.

    s (N + 1,): path parameter of the rows q (N + 1, n).
    """
    spec = arm.spec
    # cheap first: no segment leaves its set-points by more than a step of its neighbours
    # (tests/runtime/motion/test_fine_interpolator.py), so most moves need no expansion to ticks
    between = np.abs(np.diff(q, axis=0)).max(axis=0, initial=0.0)
    if (q.min(axis=0) - between >= spec.lower).all() and (q.max(axis=0) + between <= spec.upper).all():
        return
    positions = arm.fine.expand(q)[0]
    excess = np.maximum(spec.lower - positions, positions - spec.upper)
    axis = int(np.argmax(excess.max(axis=0)))
    worst = int(np.argmax(excess[:, axis]))
    if excess[worst, axis] <= RANGE_TOLERANCE:
        return
    first = int(np.argmax(excess[:, axis] > RANGE_TOLERANCE)) // arm.fine.ticks
    limits = spec.axes[axis].limits
    limit = limits.lower if positions[worst, axis] < limits.lower else limits.upper
    raise Fault(
        "RBL411",
        f"J{axis + 1} would pass its limit of {limits.kind.text(limit)} by "
        f"{limits.kind.text(excess[worst, axis], '.4g')}, "
        f"first at {100 * s[min(first, len(s) - 1)]:.1f} % of the path",
    )
