"""Effects carried out as pulse tables: each move becomes tables, what a table cannot hold becomes a marker.

Nothing here depends on a run: a program that reads an input, the time or where the robot is, is refused, and so is a
move that is not straight from rest to rest. A WAIT becomes a marker; what follows it is exported as if it came true.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NoReturn, TypeAlias

import numpy as np

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Span
from robolang.evaluation.evaluator import Nowhere
from robolang.execution import lowering
from robolang.execution.alarms import failure
from robolang.execution.executor import Executor
from robolang.execution.status import ENDED
from robolang.execution.target import Requested, Untimed
from robolang.execution.world import RobotWorld
from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import (
    Drain,
    Effect,
    Halt,
    MoveTo,
    Pass,
    SetHand,
    SetOutput,
    SetPayload,
    SetSeam,
    SetTool,
    SetWrist,
    Show,
)
from robolang.interpreter.events import Failed
from robolang.project.project import Project
from robolang.syntax.ast import Wait
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import Command, MoveLinear
from runtime.pulses.channels import Channel
from runtime.pulses.machine import Machine, RobotArm
from runtime.pulses.move import MovePulses, counted, plan_move
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.payload import Payload


class NotExportableError(Exception):
    """A statement that cannot be put into tables; ``diagnostic`` has its place."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


@dataclass(frozen=True, slots=True, kw_only=True)
class TableMove:
    """A move in pulses."""

    effect: MoveTo
    pulses: MovePulses


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadMarker:
    """A LOAD, which the PLC cannot declare."""

    effect: SetPayload
    payload: Payload


@dataclass(frozen=True, slots=True, kw_only=True)
class HandMarker:
    """A HAND, with its dwell, s."""

    effect: SetHand
    dwell_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class OtherMarker:
    """Another statement that has no place in a table."""

    effect: Effect


Marker: TypeAlias = LoadMarker | HandMarker | OtherMarker


def in_tables(project: Project, machine: Machine, channels: Sequence[Channel], step_s: float) -> "TableTarget":
    """Return the target with the whole program carried out; ``NotExportableError`` at what cannot be in tables."""
    target = TableTarget(project, machine, channels, step_s)
    executor = Executor(project, target, decisions=_WaitsPass())
    while executor.advance().state not in ENDED:
        pass
    return target


# in this order: the refusals of ``Nowhere`` come before what ``RobotWorld`` would read
class _Unread(Nowhere, RobotWorld):
    """The points and tools of a cell; nothing that a run alone knows can be read."""


class _WaitsPass(Decisions):
    """Lets every WAIT come true at once."""

    def of_wait(self, place: Span, *, endless: bool) -> bool | None:
        """Return True."""
        return True


class TableTarget(Untimed):
    """Tables of one machine: ``machine``, placed where the first move ends, and the ``sequence`` so far."""

    def __init__(self, project: Project, machine: Machine, channels: Sequence[Channel], step_s: float) -> None:
        self._project, self._channels, self._step_s = project, tuple(channels), step_s
        self.machine, self._stand = machine, machine.home
        self.first = self._start = counted(machine.home.q, self._channels)
        """Where the channels stand before the first move, pulses."""
        self.sequence: list[TableMove | Marker] = []
        self._X_flange_tool = project.cell.hand.X_flange_tool
        kinematics = machine.kinematics if isinstance(machine, RobotArm) else Kinematics(project.cell.robot)
        # no clock: to read the time is refused
        self.world = _Unread(project.points, project.cell, kinematics, lambda: 0)
        self.world.q_last = self.q

    @property
    def q(self) -> Array:
        """Joint angles (n,) rad at which motion has ended; those of the cell's home where the machine is no arm."""
        return self._stand.q if isinstance(self.machine, RobotArm) else np.array(self._project.cell.home)

    def fail(self, fault: Failed) -> NoReturn:
        """Refuse a program that cannot be carried out without a run."""
        found = failure(fault)
        # ``Nowhere`` raises RBL532 for inputs, time and poses; its hint, to assign a value, would mislead here
        raise NotExportableError(replace(found, code="RBL431", hint="") if found.code == "RBL532" else found)

    def refuse(self, effect: Effect, fault: Fault) -> NoReturn:
        """Refuse a statement at its place: no ON ERROR answers in a table."""
        raise NotExportableError(Diagnostic(code=fault.code, message=fault.message, span=effect.span, hint=fault.hint))

    # --- effects -----------------------------------------------------------------------------------------------------

    def begin(self, effect: Effect) -> None:
        """Refuse a move that a table cannot hold; ``Fault`` RBL431."""
        if not isinstance(effect, MoveTo):
            return
        if effect.path != "line" or not effect.zone_mm <= 0.0:
            what = "does not stop at its end (ZONE)" if effect.path == "line" else "is not straight"
            message = f"the move {what}; tables hold straight moves from rest to rest"
            raise Fault("RBL431", message, "write MOVE and FINE")
        if not isinstance(self.machine, RobotArm):
            self._refuse_joints(effect, self.machine)

    def _refuse_joints(self, effect: MoveTo, machine: Machine) -> None:
        """Refuse a target that is known by the joints of the arm alone."""
        point = self._project.points.get(effect.target.point)
        if point is not None and point.joints is not None:
            raise Fault(
                "RBL431",
                f"{point.name} is taught as joint angles of {self._project.cell.robot.name}, which the "
                f"{machine.name} does not have: teach its pose",
            )
        if effect.target.last:
            raise Fault(
                "RBL431", "DEPART follows the axis of the tool, which this machine does not know: teach a point"
            )

    def rehearse(self, q_start: Array, command: Command) -> MovePlan:
        """Refuse: nothing blends in a table (``begin``)."""
        raise NotImplementedError

    def move(self, chain: Sequence[Requested], *, more: bool = False) -> None:
        """Turn a straight move into pulses."""
        # a chain of one: ``begin`` refuses moves that blend
        (move,) = chain
        command = move.command
        assert isinstance(command, MoveLinear)  # ``begin`` accepts no other
        if not any(isinstance(item, TableMove) for item in self.sequence):
            self.machine = self.machine.placed(command.X_world_tool[:3, 3])
        pulses = plan_move(self.machine, self._stand, command, self._channels, self._start, self._step_s)
        self._stand, self._start = self.machine.arrived(self._stand, command, pulses.q[-1]), pulses.end
        self.sequence.append(TableMove(effect=move.effect, pulses=pulses))

    def wrist(self, effect: SetWrist) -> None:
        """Do nothing: the moves carry what it sets."""

    def drain(self, effect: Drain) -> None:
        """Mark a WAIT."""
        # here and not in ``wait``: a WAIT comes true at once, so only its Drain is left of it
        if isinstance(effect.node, Wait):
            self._mark(effect)

    def load(self, effect: SetPayload, payload: Payload) -> None:
        """Mark a LOAD."""
        self.sequence.append(LoadMarker(effect=effect, payload=payload))

    def hand(self, effect: SetHand, cycles: int) -> None:
        """Mark a HAND."""
        self.sequence.append(HandMarker(effect=effect, dwell_s=lowering.dwell_s(effect, self._project.cell)))

    def seam(self, effect: SetSeam) -> None:
        """Refuse SEAM ON."""
        if effect.sensor is not None:
            raise Fault(
                "RBL431",
                "a seam sensor shifts the path during the move, and a table is fixed before it",
                "remove the SEAM statements, or let the controller run this program",
            )

    def tool(self, effect: SetTool, X_flange_tool: Array) -> None:
        """Take the tool of all moves; ``Fault`` RBL431 for another one after the first move."""
        if np.array_equal(X_flange_tool, self._X_flange_tool):
            return
        if any(isinstance(each, TableMove) for each in self.sequence):
            raise Fault(
                "RBL431",
                "the tool cannot change in the middle of an export",
                "write one TOOL before the first move, and export what has another tool as a program of its own",
            )
        self._X_flange_tool = X_flange_tool
        if isinstance(self.machine, RobotArm):
            self.machine = self.machine.with_tool(X_flange_tool)

    def output(self, effect: SetOutput) -> None:
        """Mark OUT or PULSE."""
        self._mark(effect)

    def wait(self, effect: Pass, cycles: int) -> None:
        """Mark a DELAY."""
        self._mark(effect)

    def show(self, effect: Show) -> None:
        """Mark a PRINT."""
        self._mark(effect)

    def halt(self, effect: Halt) -> None:
        """Mark STOP or PAUSE."""
        self._mark(effect)

    def _mark(self, effect: Effect) -> None:
        self.sequence.append(OtherMarker(effect=effect))
