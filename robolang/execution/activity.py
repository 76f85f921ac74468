"""What a target of a controller does between two cycles: frozen values, which a snapshot keeps."""

from dataclasses import dataclass
from typing import TypeAlias

from robolang.execution.planned_move import PlannedChain
from robolang.execution.result import StatementRun
from robolang.execution.tape import Taped
from robolang.interpreter.effects import Origin
from runtime.control.controller import ControllerSnapshot
from runtime.control.request_queue import SetAside
from runtime.core.faults import Alarm


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """Moves that are carried out: numbers ``first`` to ``last`` of the record; readings that were ``lost`` before them.

    ``sent``: whether a cycle has been run; ``waited_us`` for the arm to come into position; ``skipped``: moves of the
    chain that had been carried out when it was interrupted. ``open``: the chain, where more moves may follow it.
    """

    first: int
    last: int
    lost: int
    sent: bool = False
    waited_us: int = 0
    skipped: int = 0
    open: PlannedChain | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Pause:
    """A statement, by its number in the record, that takes so many more cycles; ``grasp``: what the hand then holds is
    noted."""

    run: int
    cycles: int
    grasp: bool = False


Activity: TypeAlias = Motion | Pause | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Left:
    """What is left of an activity that is interrupted; of a motion also its set-points and the rows of its moves."""

    activity: Activity
    motion: SetAside | None = None
    rest: tuple[StatementRun, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetSnapshot:
    """Controller, plant and record at one moment; nothing changes it."""

    controller: ControllerSnapshot
    statements: Taped[StatementRun]
    payloads: Taped[dict[str, object]]
    shown: Taped[tuple[float, str]]
    acknowledged: tuple[Alarm, ...]
    activity: Activity
    warned: frozenset[tuple[str, Origin]]
