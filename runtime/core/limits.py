"""The ranges that values must be in: one table for ``check``, the interpreter, the planners and the signals of a cell.

It lies below the language because planners and controller refuse the same values when no program has been checked. What
a robot allows beyond that (reach, joints) is its file's or the planner's. Every comparison is written so that NaN fails
it.
"""

import math

from runtime.core.faults import Fault
from runtime.core.record import Record
from runtime.core.rounding import beside

ROUNDING = 1e-12
"""Share by which a value may pass a limit of the robot. Planners compare after a conversion to SI and back, by which
1001 mm/s become 1001.0000000000001."""


class Limit(Record):
    """A range: ``low`` to ``high`` in a unit; ``above``: low itself is not in it; ``whole``: numbers without a part."""

    name: str
    unit: str
    low: float
    high: float
    code: str
    above: bool = False
    whole: bool = False

    def fault(self, value: float, high: float | None = None) -> Fault | None:
        """Return why a value cannot be taken, None when it can; ``high``: the robot's upper limit, where it is lower.

        A value that passes ``high`` by no more than ``ROUNDING`` is within.
        """
        # never wider: a robot that is faster than the language allows is not run so
        top = self.high if high is None else min(high, self.high)
        most = top if high is None else top * (1.0 + ROUNDING)
        inside = (self.low < value if self.above else self.low <= value) and value <= most
        if inside and (not self.whole or value == math.floor(value)):
            return None
        shown, least, greatest = beside(value, self.low, top, form=".10g")
        of = f"{self.name} is {shown}{self._unit}"
        if self.above:
            return Fault(
                self.code,
                f"{of} and must be above {least} and at most {greatest}{self._unit}",
                f"give {self.name} in {self.unit}, above {least} to {greatest}",
            )
        kind = "a whole number from" if self.whole else "from"
        allowed = f"{kind} {least} to {greatest}{self._unit}"
        return Fault(self.code, f"{of} and must be {allowed}", f"give {allowed.removeprefix('from ')}")

    def checked(self, value: float, high: float | None = None) -> float:
        """Return a value; ``Fault`` when it is out of range (see ``fault``)."""
        fault = self.fault(value, high)
        if fault is not None:
            raise fault
        return value

    @property
    def _unit(self) -> str:
        return f" {self.unit}" if self.unit else ""


SPEED = Limit(name="SPEED", unit="mm/s", low=0.0, high=10_000.0, code="RBL404", above=True)
SPEED_PCT = Limit(name="SPEED of MOVEJ", unit="%", low=0.0, high=100.0, code="RBL404", above=True)
SPEEDJ = Limit(name="SPEEDJ", unit="%", low=0.0, high=100.0, code="RBL404", above=True)
ACCEL = Limit(name="ACCEL", unit="%", low=0.0, high=100.0, code="RBL404", above=True)
OVERRIDE = Limit(name="OVERRIDE", unit="%", low=0.0, high=100.0, code="RBL404", above=True)
# the set-points of a move are held in memory as a whole, so a move of hours cannot be planned
TIME = Limit(name="TIME", unit="s", low=0.0, high=600.0, code="RBL404", above=True)
ZONE = Limit(name="ZONE", unit="mm", low=0.0, high=1e5, code="RBL415")
DISTANCE = Limit(name="the distance", unit="mm", low=0.0, high=1e5, code="RBL404")
DWELL = Limit(name="the waiting time of HAND", unit="s", low=0.0, high=600.0, code="RBL405")
# a day: longer than any program runs
DELAY = Limit(name="DELAY", unit="s", low=0.0, high=86_400.0, code="RBL405")
PULSE = Limit(name="PULSE", unit="s", low=0.0, high=86_400.0, code="RBL405")
TIMEOUT = Limit(name="TIMEOUT", unit="s", low=0.0, high=86_400.0, code="RBL405")
INPUT = Limit(name="the number of an input", unit="", low=1.0, high=1024.0, code="RBL534", whole=True)
OUTPUT = Limit(name="the number of an output", unit="", low=1.0, high=1024.0, code="RBL534", whole=True)
SIZE = Limit(name="the largest index of an array", unit="", low=0.0, high=99_999.0, code="RBL507", whole=True)

SETTINGS = {"SPEED": SPEED, "SPEEDJ": SPEEDJ, "ACCEL": ACCEL, "OVERRIDE": OVERRIDE, "ZONE": ZONE}
"""Limits of the settings by their word."""
