"""Plans remembered by what they depend on: start, command, tool, override, speed cap; chains by plans and zones.

The plan that was checked is the plan that runs: dry run, ``Controller.rehearse`` and ``move_chain`` share one
memory, so a move that starts from bit-identical conditions gets the plan, or the refusal, that it got before.
"""

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from robolang.project.project import Project
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import Command
from runtime.motion.motion_planner import ChainPlan, MotionPlanner
from runtime.robot.kinematics.kinematics import Kinematics


class PlanMemory(MotionPlanner):
    """The planner of one project: plans nothing twice, refusals included."""

    def __init__(self, project: Project) -> None:
        robot = project.cell.robot
        super().__init__(robot, Kinematics(robot), project.profile)
        self._plans: dict[tuple[object, ...], MovePlan | Fault] = {}
        self._chains: dict[tuple[object, ...], ChainPlan] = {}

    def plan(
        self,
        q_start: Array,
        command: Command,
        X_flange_tool: Array,
        override: float = 1.0,
        cap: float | None = None,
    ) -> MovePlan:
        """Return the plan of one move, as ``MotionPlanner.plan`` does."""
        key = (q_start.tobytes(), *_key(command), X_flange_tool.tobytes(), override, cap)
        if key not in self._plans:
            try:
                self._plans[key] = super().plan(q_start, command, X_flange_tool, override, cap)
            except Fault as fault:
                self._plans[key] = fault
        found = self._plans[key]
        if isinstance(found, Fault):  # a new one: an exception that is raised again would keep all frames before
            raise Fault(found.code, found.message, found.hint)
        return found

    def join(
        self,
        plans: Sequence[MovePlan],
        zones: Sequence[float],
        X_flange_tool: Array,
        cap: float | None = None,
        *,
        more: bool = False,
    ) -> ChainPlan:
        """Return moves blended in their zones, as ``MotionPlanner.join`` does."""
        key = (
            *(id(plan) for plan in plans),
            *zones,
            X_flange_tool.tobytes(),
            cap,
            more,
        )  # plans are kept, so ids stay theirs
        if key not in self._chains:
            self._chains[key] = super().join(plans, zones, X_flange_tool, cap, more=more)
        return self._chains[key]


def _key(command: Command) -> tuple[object, ...]:
    values = (getattr(command, field.name) for field in fields(command))
    return (type(command), *map(_hashable, values))


def _hashable(value: object) -> object:
    # arrays cannot be hashed; by their bytes, since a plan is that of these very bits and of no near ones
    if isinstance(value, np.ndarray):
        return value.tobytes()
    return tuple(map(_hashable, value)) if isinstance(value, tuple) else value
