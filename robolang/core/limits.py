"""The ranges that values of a program must be in: one table for ``check`` and for the interpreter.

What a robot allows beyond that (its own greatest speed, reach, joints) is its file's or the planner's. Every comparison
is written so that NaN fails it.
"""

import math

from runtime.core.faults import Fault
from runtime.core.record import Record
from runtime.core.rounding import beside


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
        """Return why a value cannot be taken, None when it can; ``high``: a lower upper limit, of the robot."""
        top = self.high if high is None else min(high, self.high)
        inside = (self.low < value if self.above else self.low <= value) and value <= top
        if inside and (not self.whole or value == math.floor(value)):
            return None
        shown, least, most = beside(value, self.low, top, form=".10g")
        of = f"{self.name} is {shown}{self._unit}"
        if self.above:
            return Fault(
                self.code,
                f"{of} and must be above {least} and at most {most}{self._unit}",
                f"give {self.name} in {self.unit}, above {least} to {most}",
            )
        kind = "a whole number from" if self.whole else "from"
        return Fault(
            self.code, f"{of} and must be {kind} {least} to {most}{self._unit}", f"give {least} to {most}{self._unit}"
        )

    def checked(self, value: float) -> float:
        """Return a value; ``Fault`` when it is out of range."""
        fault = self.fault(value)
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
TIME = Limit(name="TIME", unit="s", low=0.0, high=600.0, code="RBL404", above=True)
ZONE = Limit(name="ZONE", unit="mm", low=0.0, high=1e5, code="RBL415")
DISTANCE = Limit(name="the distance", unit="mm", low=0.0, high=1e5, code="RBL404")
DWELL = Limit(name="the waiting time of HAND", unit="s", low=0.0, high=600.0, code="RBL405")
DELAY = Limit(name="DELAY", unit="s", low=0.0, high=86_400.0, code="RBL405")
PULSE = Limit(name="PULSE", unit="s", low=0.0, high=86_400.0, code="RBL405")
TIMEOUT = Limit(name="TIMEOUT", unit="s", low=0.0, high=86_400.0, code="RBL405")
OUTPUT = Limit(name="the number of an output", unit="", low=1.0, high=1024.0, code="RBL534", whole=True)
SIZE = Limit(name="the largest index of an array", unit="", low=0.0, high=99_999.0, code="RBL507", whole=True)

SETTINGS = {"SPEED": SPEED, "SPEEDJ": SPEEDJ, "ACCEL": ACCEL, "OVERRIDE": OVERRIDE, "ZONE": ZONE}
"""Limits of the settings by their word."""
