"""Moves alone and in a row: each planned where the one before ends, a row joined to one path in its zones.

``MotionPlanner`` is the planner of every kind of move, alone (``plan``) or in a chain (``chain``). A chain is planned
move by move as if each stopped, so what is refused does not depend on zones; then the moves up to each stop become one
path, timed as a whole (``chaining``). Without zones the rows are those of the plans to the last bit.

Under a speed cap (``speed_cap``) a move takes the override at which it keeps the cap, and a path keeps it too.

A row in a corner belongs to both moves; in the log and for the lamp it counts as the first of them up to the middle,
then as the second.

Called by the controller before anything moves, and by the rehearsal of a program.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen
from runtime.core.units import MM, PERCENT
from runtime.motion.cartesian_planner import CartesianPlanner, MovePlan, WristChange
from runtime.motion.chain.corner import Corner
from runtime.motion.chain.paced import ChainLimits
from runtime.motion.chaining import Joined, Tail, joined
from runtime.motion.commands import Command, MoveJoint, MoveLinear
from runtime.motion.extension import extended
from runtime.motion.joint_planner import JointPlanner
from runtime.motion.path import Path
from runtime.motion.path_ik import Arm
from runtime.motion.speed_cap import PLANNED, SpeedCap
from runtime.motion.time_scaling import Pace
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

_CAPPINGS = 60
"""Overrides that are tried for a move under a cap, at most."""
_UNDER = 1.0 - 1e-3
"""Share of the cap that the next override aims at, so that a few of them are enough."""


class ChainFault(Fault):
    """The refusal of move number ``index`` (from 0) of a chain."""

    def __init__(self, fault: Fault, index: int) -> None:
        super().__init__(fault.code, fault.message, fault.hint)
        self.index = index


def tracked(command: Command) -> MoveLinear:
    """Return a move as it is planned under a seam sensor, without a zone; ``Fault`` RBL412 where it is not straight."""
    if not isinstance(command, MoveLinear):
        raise Fault("RBL412", "a seam sensor is followed on straight moves only")
    return replace(command, tracked=True, zone=0.0)


def tracked_row(commands: Sequence[Command]) -> list[MoveLinear]:
    """Return the moves of a chain as ``tracked`` does each; ``ChainFault`` RBL412 at the first that is not straight."""
    moves = []
    for index, command in enumerate(commands):
        try:
            moves.append(tracked(command))
        except Fault as fault:
            raise ChainFault(fault, index) from None
    return moves


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """One move of a chain: its own plan, and the rows ``first`` (not included) to ``last`` of the chain that are its.

    It takes the cycles between them; the first row of a chain is where it starts. ``s`` (K,) is the share of its path
    that is passed at rows first to last.
    """

    plan: MovePlan
    first: int
    last: int
    s: Array
    period_s: float

    @property
    def path(self) -> Path | None:
        """Path of the tool point; None for a joint move."""
        return self.plan.path

    @property
    def wrist(self) -> WristChange | None:
        """What the plan does with the wrist."""
        return self.plan.wrist

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of the plan, as the report shows them."""
        return self.plan.notes

    @property
    def modes(self) -> NDArray[np.int8]:
        """``wrist_mode`` of its rows, without that of row ``first``."""
        return self.plan.modes_at(self.s[1:])

    @property
    def planned_s(self) -> float:
        """Time of the part, s."""
        return (self.last - self.first) * self.period_s


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainPlan:
    """Joint angles ``q`` (N + 1, n) rad that a chain of moves passes, 8 ms apart.

    ``modes`` (N + 1,) is ``wrist_mode`` of every set-point and ``command`` (N + 1,) the number of the move that it
    belongs to, the last one at the last, ``share`` (N + 1,) how far that has come; ``corners`` lie between the
    ``parts``. ``moving``: the moves before the first have run on into it. ``tail``: what more moves may follow.
    """

    q: Array
    setpoints: Array
    modes: NDArray[np.int8]
    command: NDArray[np.int32]
    share: Array
    parts: tuple[Part, ...]
    corners: tuple[Corner, ...]
    moving: bool = False
    tail: Tail | None = None

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of all moves, as the report shows them."""
        return tuple(note for part in self.parts for note in part.notes)


class MotionPlanner:
    """Plans any move of one robot under one controller profile, alone or in a chain."""

    def __init__(self, spec: RobotSpec, kinematics: Kinematics, profile: Profile) -> None:
        self.lines = CartesianPlanner(spec, kinematics, profile)
        """Plans moves that have a path."""
        self.joints = JointPlanner(spec, kinematics, profile)
        """Plans those that have none."""
        self.kinematics = kinematics
        """The kinematics of the robot, one for all who plan with this."""
        self._spec = spec
        self._pace = Pace.of(spec, profile)
        self._limits = ChainLimits.of(spec, profile)

    @property
    def spec(self) -> RobotSpec:
        """The robot."""
        return self._spec

    @property
    def limits(self) -> ChainLimits:
        """What its chains keep to."""
        return self._limits

    def plan(
        self,
        q_start: Array,
        command: Command,
        X_flange_tool: Array,
        override: float = 1.0,
        cap: float | None = None,
    ) -> MovePlan:
        """Return the plan of one move from joint angles q_start (n,) rad; ``Fault`` RBL404, 410, 411, 412 or 416.

        ``X_flange_tool`` (4, 4) is the tool whose point moves, ``override`` in (0, 1] a share of every speed
        beside the command's own, ``cap`` m/s what tool point and flange may have at most, None: any speed.
        """
        plan = self._plan(q_start, command, X_flange_tool, override)
        return plan if cap is None else self._capped(plan, q_start, command, self._cap(cap, X_flange_tool))

    def _plan(self, q_start: Array, command: Command, X_flange_tool: Array, override: float) -> MovePlan:
        if isinstance(command, MoveJoint):
            return self.joints.plan(q_start, command, X_flange_tool, override)
        return self.lines.plan(q_start, command, X_flange_tool, override)

    def _cap(self, most: float, X_flange_tool: Array) -> SpeedCap:
        return SpeedCap(most=most, kinematics=self.kinematics, fine=self._pace.fine, X_flange_tool=X_flange_tool)

    def _capped(self, plan: MovePlan, q_start: Array, command: Command, cap: SpeedCap) -> MovePlan:
        """Return a plan at the override, up to its own, at which it keeps a cap; ``Fault`` RBL404 where none is found.

        The speed falls in proportion to the override where the move cruises, and later where it is too short for that.
        """
        # the acceleration first: the override that keeps the cap depends on it
        command = self._eased(plan, command, cap)
        share, override = 1.0, plan.override / command.override
        if command.acceleration != plan.acceleration:
            plan = self._plan(q_start, command, cap.X_flange_tool, override)
        for _ in range(_CAPPINGS):
            ratio = cap.ratio(cap.fine.expand(plan.setpoints))
            if ratio <= 1.0:
                break
            # a little below the cap: to aim at it exactly would come to it in ever smaller steps
            share *= _UNDER / ratio
            plan = self._plan(q_start, command, cap.X_flange_tool, override * share)
        else:
            raise Fault("RBL404", f"no speed of the move keeps below {cap.most * PLANNED / MM:g} mm/s")
        if share == 1.0:
            return plan
        note = f"runs at {share / PERCENT:.3g} % of its speeds, to keep below {cap.most / MM:g} mm/s"
        return replace(plan, notes=(*plan.notes, note))

    def _eased(self, plan: MovePlan, command: Command, cap: SpeedCap) -> Command:
        """Return a command that does not gain the speed of a cap too fast."""
        if len(plan.q) == 1:
            return command
        # shares of the joints' accelerations move the tool as far as it is from the axes; of a path they are its own
        if isinstance(command, MoveJoint):
            easing = cap.easing(cap.fine.expand(plan.setpoints))
        else:
            easing = cap.gaining(self._spec.path.acceleration * command.robot_share)
        share = command.robot_share * easing
        return command if share == command.acceleration else replace(command, acceleration=share)

    def chain(
        self,
        q_start: Array,
        commands: Sequence[Command],
        X_flange_tool: Array,
        override: float = 1.0,
        cap: float | None = None,
        *,
        more: bool = False,
    ) -> ChainPlan:
        """Return the plan of a chain of moves from q_start (n,) rad; ``ChainFault`` names the first that is refused.

        ``more``: others are to follow without a stop (``extend``).
        """
        plans = self._in_a_row(q_start, commands, X_flange_tool, override, cap)
        return self.join(plans, [command.zone for command in commands], X_flange_tool, cap, more=more)

    def _in_a_row(
        self, q_start: Array, commands: Sequence[Command], X_flange_tool: Array, override: float, cap: float | None
    ) -> list[MovePlan]:
        plans: list[MovePlan] = []
        # each from the end of the plan before, not from its taught end: under KEEP the two may differ
        for index, command in enumerate(commands):
            try:
                plans.append(self.plan(plans[-1].q[-1] if plans else q_start, command, X_flange_tool, override, cap))
            except Fault as fault:
                raise ChainFault(fault, index) from None
        return plans

    def extend(
        self,
        chain: ChainPlan,
        at: int,
        commands: Sequence[Command],
        X_flange_tool: Array,
        override: float = 1.0,
        cap: float | None = None,
    ) -> tuple[ChainPlan, int]:
        """Return a chain that goes on over more moves after row ``at``, and how many of its moves are left out.

        These have ended before that row. ``Fault`` RBL404 where the motion cannot go on: the chain is to end as it was
        planned, and another one follows. ``ChainFault`` as of ``chain``.
        """
        plans = self._in_a_row(chain.parts[-1].plan.q[-1], commands, X_flange_tool, override, cap)
        arm, limits = self._arm_and_limits(X_flange_tool, cap)
        before = Joined(
            q=chain.q,
            setpoints=chain.setpoints,
            command=chain.command,
            share=chain.share,
            lasts=tuple(part.last for part in chain.parts),
            corners=chain.corners,
            tail=chain.tail,
        )
        plans = [*(part.plan for part in chain.parts), *plans]
        found, left_out = extended(before, at, plans, [command.zone for command in commands], arm, limits)
        moving = chain.corners[left_out - 1].reach > 0.0 if left_out else chain.moving
        return self._chain_plan(found, plans[left_out:], moving=moving), left_out

    def _arm_and_limits(self, X_flange_tool: Array, cap: float | None) -> tuple[Arm, ChainLimits]:
        arm = Arm(spec=self._spec, kinematics=self.kinematics, fine=self._pace.fine, X_flange_tool=X_flange_tool)
        return arm, replace(self._limits, cap=None if cap is None else self._cap(cap, X_flange_tool))

    def join(
        self,
        plans: Sequence[MovePlan],
        zones: Sequence[float],
        X_flange_tool: Array,
        cap: float | None = None,
        *,
        more: bool = False,
    ) -> ChainPlan:
        """Return moves, each planned from the end of the one before, joined in the zones (m) at their ends.

        The last one stops, whatever its zone is; ``more`` as of ``chain``. ``cap`` m/s is that of ``plan``, which the
        paths keep as well.
        """
        if not plans:
            raise ValueError("a chain has at least one move")
        return self._chain_plan(joined(plans, zones, *self._arm_and_limits(X_flange_tool, cap), more=more), plans)

    def _chain_plan(self, found: Joined, plans: Sequence[MovePlan], *, moving: bool = False) -> ChainPlan:
        parts = tuple(
            Part(plan=plan, first=first, last=last, s=_shares(found, index, first, last), period_s=self._pace.period_s)
            for index, (plan, first, last) in enumerate(zip(plans, (0, *found.lasts), found.lasts, strict=False))
        )
        modes = np.concatenate([plans[0].modes[:1], *(part.modes for part in parts)])
        return ChainPlan(
            q=frozen(found.q),
            setpoints=frozen(found.setpoints),
            modes=modes,
            command=found.command,
            share=frozen(found.share),
            parts=parts,
            corners=found.corners,
            moving=moving,
            tail=found.tail,
        )


def _shares(found: Joined, index: int, first: int, last: int) -> Array:
    """Return the share of its path (K,) at the rows of a move; at the first, the last of the move before it, 0."""
    own = found.share[first : last + 1].copy()
    own[found.command[first : last + 1] != index] = 0.0
    return frozen(own)
