"""The record of a run: its statements, payloads and controller while it goes on, its result when it ends."""

from dataclasses import dataclass, field

from robolang.core.diagnostics import Diagnostic
from robolang.execution.run_report import Report
from robolang.interpreter.effects import Effect, Origin
from robolang.logs.log import Log
from robolang.project.points import Point
from robolang.project.project import Project
from runtime.control.controller import Controller
from runtime.core.faults import Alarm
from runtime.motion.cartesian_planner import WristChange
from runtime.motion.path import Path
from runtime.motion.reached import Reached
from runtime.motion.speeds import Speeds

GOES_ON = -1
"""``end_tick`` of a statement that has not ended: tick 0 is one at which a statement may end."""
LAMPS = ("", "WRIST", "WRIST HOLD")
"""What the lamp shows by ``wrist_mode``."""


@dataclass(slots=True, kw_only=True)
class StatementRun:
    """What became of one statement: where it stands, its first and last tick, the path it moved on.

    ``begun``: whether it was reached; the moves of a row that was stopped before them were not.
    ``wrist`` is what its plan did with the wrist, ``seam`` the sensor it moved under, ``lost`` the readings that this
    one lost meanwhile; ``lamp`` what the pendant's lamp shows now, by ``wrist_mode`` (``controller_target.LAMPS``).
    ``effect`` is what was carried out, a WAIT's the first, with zone 0 where the move did not blend; None: given
    set-points. ``points`` are the taught points that it names, as they were. ``rest``: joint angles (n,) deg where the
    arm came to rest short of the end of the effect, or at the end of given set-points. ``speeds`` are those of its
    chain, in which it is move ``at``; None: it is no planned move.
    """

    origin: Origin
    text: str
    first_tick: int
    end_tick: int = GOES_ON
    path: Path | None = None
    planned_s: float | None = None
    wrist: WristChange | None = None
    seam: str | None = None
    lost: int = 0
    lamp: str = ""
    begun: bool = True
    effect: Effect | None = None
    points: tuple[Point, ...] = ()
    rest: tuple[float, ...] | None = None
    speeds: Speeds | None = None
    at: int = 0
    notes: list[str] = field(default_factory=list)

    @property
    def reached(self) -> Reached | None:
        """What became of the speed of a planned move."""
        # judged when a report is made, and only then
        return None if self.speeds is None else self.speeds.moves[self.at]

    @property
    def ended(self) -> bool:
        """Whether the statement has ended, if only for now: a wait may go on."""
        return self.end_tick != GOES_ON


@dataclass(frozen=True, slots=True, kw_only=True)
class RunResult:
    """Outcome of a run: ``report`` of plain JSON types with attributes, ``log`` arrays by signal name.

    ``ok``: the program ran to its end. ``alarms`` ended it otherwise, the one that stopped the arm first; ``warnings``
    did not: both at the statements that ran.
    """

    ok: bool
    alarms: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...]
    report: Report
    log: Log


@dataclass(slots=True, kw_only=True)
class RunRecord:
    """A run as it goes on; ``payloads`` are the rows of ``payload_history`` in the report, ``shown`` what PRINT showed:
    time s and text."""

    project: Project
    controller: Controller
    physics: bool
    statements: list[StatementRun] = field(default_factory=list)
    payloads: list[dict[str, object]] = field(default_factory=list)
    shown: list[tuple[float, str]] = field(default_factory=list)
    acknowledged: list[Alarm] = field(default_factory=list)
    """Alarms that the controller no longer holds."""
    kept_for: str = ""
    """The options for which the log is kept, in words; empty: no option leaves it out."""

    @property
    def alarms(self) -> list[Alarm]:
        """All alarms of the run, in order."""
        return [*self.acknowledged, *self.controller.alarms]
