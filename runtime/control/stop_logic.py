"""What an alarm does to the arm: latched, it stops it by its category, and the brakes hold it (docs/supervision.md).

    category 1   the arm comes to rest on its path, servoing; the brakes take it when it stands
    category 0   the brakes take it at once; so does a controlled stop that the arm does not follow

The first alarm stops; later ones are kept in order. ``acknowledge`` of the controller ends it.
"""

from runtime.control.drive_train import DriveTrain
from runtime.control.request_queue import RequestQueue
from runtime.core.faults import Alarm, lookup
from runtime.core.program_line import ProgramLine
from runtime.core.state import Stateful
from runtime.supervision.finding import Finding

LONGEST_REST_US = 500_000
"""Longest time that a stopped command waits for the arm to stand before the brakes hold it, us."""
_RUNS_AWAY = ("RBL513", "RBL514", "RBL515")
"""Alarms with which a controlled stop has failed: the arm is too fast, out of range or not measured."""
_BLOCKED = ("RBL511", "RBL512", "RBL515", "RBL516")
"""Alarms of an axis that something may have stopped."""


class StopLogic(Stateful):
    """Alarms and warnings of one controller, and the stop that an alarm begins."""

    VALUES = ("alarms", "warnings", "halted", "_rest_us")

    def __init__(self, requests: RequestQueue, drives: DriveTrain, period_us: int) -> None:
        self._requests, self._drives, self._period_us = requests, drives, period_us
        self.alarms: list[Alarm] = []
        """Latched alarms, the one that stopped the arm first."""
        self.warnings: list[Alarm] = []
        """What was found without stopping the arm."""
        self.halted = False
        """Whether the brakes hold the arm."""
        self._rest_us = 0

    @property
    def moving(self) -> bool:
        """Whether set-points are left to send or the command has not come to rest; never with the brakes on."""
        return not self.halted and (self._requests.busy or not self._drives.fine.settled)

    def alarm_of(
        self, found: Finding, statement: ProgramLine | None = None, hint: str = "", calls: tuple[ProgramLine, ...] = ()
    ) -> Alarm:
        """Return the alarm of a finding at a statement; None: at the one that runs."""
        entry = lookup(found.code)
        return Alarm(
            code=found.code,
            message=found.message,
            tick=found.tick,
            axis=found.axis,
            category=entry.category,
            statement=statement or self._requests.statement,
            calls=calls,
            hint=hint or entry.remedy,
        )

    def take(self, found: Finding) -> None:
        """Keep a finding at the statement that runs: a warning, or an alarm that stops the arm."""
        if found.warning:
            self.warnings.append(self.alarm_of(found))
        else:
            self.stop_by(self.alarm_of(found))

    def stop_by(self, alarm: Alarm) -> None:
        """Latch an alarm and stop the arm by its category."""
        touches = self._drives.touches
        if touches is not None and alarm.code in _BLOCKED:
            touches.blocked()
        self.alarms.append(alarm)
        # moves that wait under a seam tracker would begin when the stop has ended the one that runs
        self._requests.wait_no_more()
        if alarm.category == 0:
            self.halt()
        elif len(self.alarms) == 1:  # a later alarm comes during the stop, which must not begin anew
            self._rest_us = 0
            self._requests.stop()

    def follow(self, found: Finding | None) -> None:
        """See a controlled stop to its end: brakes when the arm stands, at once when it does not follow.

        ``found`` is what is wrong with the cycle that has just run; only what makes the stop fail counts.
        """
        lost = self._drives.lost_track()
        # the cause of the stop goes on while the arm slows down, and is no reason to fall into the brakes
        if found is not None and found.code in _RUNS_AWAY and found.code != self.alarms[0].code:
            self.take(found)
            self.halt()
        elif lost is not None:
            message, tick = f"J{lost + 1} did not follow the controlled stop", self._drives.recorder.tick
            self.take(Finding(code="RBL518", message=message, axis=lost, tick=tick))
        elif not self.moving:
            self._rest_us += self._period_us
            if self._drives.slow or self._rest_us > LONGEST_REST_US:
                self.halt()

    def halt(self) -> None:
        """Stop at once (category 0): the brakes hold the arm from this tick on."""
        self._requests.drop()
        self.halted = True

    def release(self) -> None:
        """Open the brakes: the alarms have been acknowledged."""
        self.alarms = []
        self.halted = False
