"""The memory areas through which tasks hand data to each other (docs/architecture.md).

=====  ==========================================  =======================  ============================
area   contents                                    written by               read by
=====  ==========================================  =======================  ============================
PA     the program                                 loader                   session (``Program``)
PDA    taught points                               teaching                 session (``PointStore``)
SDA    payload declared by LOAD                    LOAD, step 106           dynamics task
ITA    inertia and gravity torque of every axis    dynamics task, step 308  8 ms interrupt, step 220
INA    joint set-points                            interpolator, step 210   8 ms interrupt, step 218
ANG    angles of the axis being computed           dynamics task, step 302  dynamics task
=====  ==========================================  =======================  ============================

PA and PDA belong to the language and live in the session; the other four are here. What one task hands to another
is one frozen object swapped by one assignment, so a reader sees the old one or the new one, never a mixture. ANG is
the dynamics task's own and is written in place.
"""

from dataclasses import dataclass, field

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.state import Stateful
from runtime.robot.model.payload import NO_PAYLOAD, Payload

EMPTY_ROW = frozen(np.zeros(0))


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisLoad:
    """One cell of ITA: ``D`` kg m2 and ``T`` N m of one axis, and what they were computed from.

    ``row`` (n,) is the axis' whole row of the mass matrix, kg m2, for a servo that couples the axes.

    ``read_us`` is the time of the encoder reading (ANG), ``version`` counts refreshes of this axis (0: never),
    ``payload_version`` counts the LOADs: the one that was in SDA.
    """

    D: float
    T: float
    row: Array = field(default_factory=lambda: EMPTY_ROW, compare=False)
    read_us: int
    version: int
    payload_version: int


class Areas(Stateful):
    """SDA, ITA, INA and ANG of one controller with n axes."""

    BUFFERS = ("ang",)
    VALUES = (
        "sda",
        "sda_version",
        "ita",
        "ina",
        "refreshes",
        "longest_refresh_us",
        "_first_us",
        "_last_us",
    )

    def __init__(self, n: int, q: Array) -> None:
        self.sda: Payload = NO_PAYLOAD
        self.sda_version = 0
        # one cell for all axes is safe: cells are frozen, and ``publish`` replaces them
        self.ita: list[AxisLoad] = [AxisLoad(D=0.0, T=0.0, read_us=0, version=0, payload_version=0)] * n
        self.ina: Array = np.array(q)
        self.ang: Array = np.array(q)

        self.refreshes = [0] * n
        """How often each axis was refreshed."""
        self.longest_refresh_us = 0
        """Longest time between two refreshes of one axis, us."""
        self._first_us = [0] * n
        self._last_us = [0] * n

    def publish(self, axis: int, load: AxisLoad, now_us: int) -> None:
        """Store a new cell of ITA (step 308) and keep count."""
        self.ita[axis] = load
        # the first refresh ends no interval: before it the cell was that of power-up
        if self.refreshes[axis]:
            self.longest_refresh_us = max(self.longest_refresh_us, now_us - self._last_us[axis])
        else:
            self._first_us[axis] = now_us
        self.refreshes[axis] += 1
        self._last_us[axis] = now_us

    @property
    def mean_refresh_us(self) -> float:
        """Mean time between two refreshes of one axis, us; 0 when no axis was refreshed twice."""
        spans = [
            (last - first, count - 1)
            for first, last, count in zip(self._first_us, self._last_us, self.refreshes, strict=True)
            if count > 1
        ]
        return sum(span for span, _ in spans) / sum(count for _, count in spans) if spans else 0.0

    def declare(self, payload: Payload) -> None:
        """Store the payload of a LOAD in SDA (step 106)."""
        self.sda = payload
        self.sda_version += 1
