"""Supervision of a run: the checks of every cycle in the order in which they name a fault.

Order: encoders and the checks of every tick (``watch``), unexpected torque and payload (``observer``), age of the
dynamics. The first finding ends the cycle's checks: what comes after it is mostly its consequence. A program that
has not declared any payload gets a warning where one that declared a wrong one is stopped. Called by the controller at
the end of each cycle.
"""

import math

import numpy as np

from runtime.core.frames import Array
from runtime.core.rounding import beside
from runtime.core.state import Stateful
from runtime.robot.model.load_rules import LoadMode
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.settings.supervision import SupervisionLimits
from runtime.supervision.drive_data import DriveData
from runtime.supervision.finding import Finding
from runtime.supervision.tick_monitor import Watch
from runtime.supervision.torque_observer import FEWEST, STRIDE, LoadModel, Observer

MOVING = 0.02
"""Commanded speed, as a share of the fastest joint's limit, from which the payload is weighed."""
CONFIRMED = 2
"""Residuals in a row over the collision limit, estimates in a row off the declared payload."""
UNEXPLAINED = 4.0
"""Standard deviations on one axis that no payload explains, in the mean, for a collision or a drive fault."""
SURE = 0.08
"""Largest standard deviation of an estimate that is believed, as a share of the rated payload."""
LOST = 3.0
"""Share of the following-error limit at which a controlled stop has failed."""


class Supervisor(Stateful):
    """Watches one robot; ``model`` is what torques are judged by, that of the robot file by default."""

    VALUES = ("weighing", "_payload", "_since", "_unexpected", "_suspect", "_late", "_warned", "_first_tick", "_cycle")
    PARTS = ("watch", "observer")

    def __init__(
        self, spec: RobotSpec, limits: SupervisionLimits, drives: DriveData, model: LoadModel | None = None
    ) -> None:
        self._limits, self._ticks, self._rated = limits, drives.ticks, spec.rated_payload
        self.watch = Watch(spec, limits, drives)
        self.observer = Observer(spec, limits, drives, model)
        self._collision = limits.collision * drives.torque
        self._kinds = [axis.kind for axis in spec.axes]
        self._top = spec.per_axis("limits", "speed")
        self.weighing = False
        """Whether the payload is being weighed, so that no declared one is judged; collisions are."""
        self._payload: Payload | None = None
        self._stale_us = limits.stale_s * 1e6
        self._since = self._unexpected = self._suspect = self._late = 0
        self._warned = False
        self._first_tick = self._cycle = 0

    def declare(self, payload: Payload, mode: LoadMode) -> None:
        """LOAD: from here on this is what should hang on the flange."""
        self._payload = payload
        self.observer.declare(payload, mode)
        self._weigh_anew()

    def hand_moves(self) -> None:
        """HAND ON or OFF: what was weighed no longer counts."""
        self.observer.restart()
        self._weigh_anew()

    def _weigh_anew(self) -> None:
        """Forget the estimates of another payload."""
        self._warned, self._suspect = False, 0

    def restart(self, tick: int) -> None:
        """Begin anew after an acknowledged fault; rows before ``tick`` no longer count."""
        self.observer.restart()
        self._first_tick = tick
        self._since = self._unexpected = self._suspect = 0

    def judge(self, rows: Array, q_cmd: Array, dq_cmd: Array, end_tick: int) -> Finding | None:
        """Judge the cycle that ended before ``end_tick``; rows (.., 4 n) end with it, commands are (ticks, n)."""
        found = self.watch.cycle(rows[-self._ticks :], q_cmd, dq_cmd, end_tick - self._ticks)
        if found is not None:
            return found
        self._cycle ^= 1
        if self._cycle or end_tick - self._first_tick < self.observer.rows:
            return None  # a residual covers two cycles
        return self._torques(rows[-self.observer.rows :], end_tick - 1)

    def _torques(self, rows: Array, tick: int) -> Finding | None:
        observer, n = self.observer, len(self._collision)
        # tau_sat, which the motors gave, not tau_cmd: a saturated drive is no collision
        observer.update(rows[:, n : 2 * n], rows[:, 2 * n : 3 * n])
        ratio = np.abs(observer.residual) / (self._collision + 2.0 * observer.sigma)
        self._unexpected = 0 if ratio.max() <= 1.0 else self._unexpected + 1
        if self._unexpected >= CONFIRMED:
            return self._collided(int(np.argmax(ratio)), tick)
        self._since += 1
        # weighed in motion only: at rest dry friction carries any weight within its band
        if self._since >= STRIDE and not float((self.watch.peak / self._top).max()) <= MOVING:
            self._since = 0
            observer.learn()
            # a LOAD that is wrong is the reason to weigh, and must not stop it
            if observer.steps >= FEWEST and not self.weighing:
                return self._weigh(tick)
        return None

    def _collided(self, axis: int, tick: int) -> Finding:
        most = float(self._collision[axis] + 2.0 * self.observer.sigma[axis])
        torque, bound = beside(float(self.observer.residual[axis]), most, form="+.1f")
        kind = self._kinds[axis]
        return Finding(
            code="RBL516",
            tick=tick,
            axis=axis,
            message=f"the {kind.effort} of J{axis + 1} differs by {torque} {kind.force} from what its motion and "
            f"payload need; the limit is {bound} {kind.force}",
        )

    def _weigh(self, tick: int) -> Finding | None:
        observer, limits = self.observer, self._limits
        leftover = np.abs(observer.leftover)
        # before the mass: what a contact adds to the torque falsifies the estimate as well, and LOAD would be blamed
        if math.isfinite(limits.collision) and not leftover.max() <= UNEXPLAINED:
            return self._unexplained(int(np.argmax(leftover)), tick)
        if limits.payload_mismatch == "off" or self._warned:
            return None  # one finding for each LOAD: the estimate goes on and would repeat it every few cycles
        return self._mismatch(tick)

    def _mismatch(self, tick: int) -> Finding | None:
        """Compare the estimated mass with the declared one; a finding after ``CONFIRMED`` estimates that differ."""
        mass, sigma = self.observer.estimate()
        declared = self._payload.mass if self._payload is not None else 0.0
        near = abs(mass - declared) <= self._limits.payload_tolerance * self._rated
        self._suspect = 0 if near or sigma > SURE * self._rated else self._suspect + 1
        if self._suspect < CONFIRMED:
            return None
        self._warned = True
        return Finding(
            code="RBL517",
            tick=tick,
            # a program without LOAD has declared nothing wrong: it goes on
            warning=self._limits.payload_mismatch == "warn" or self._payload is None,
            message=f"{f'declared {declared:.2f} kg' if self._payload else 'no LOAD yet'}, "
            f"estimated {mass:.2f} +- {sigma:.2f} kg",
        )

    def _unexplained(self, axis: int, tick: int) -> Finding:
        kind = self._kinds[axis]
        return Finding(
            code="RBL516",
            tick=tick,
            axis=axis,
            message=f"the {kind.effort} of J{axis + 1} differs on average by {self.observer.unexplained[axis]:+.1f} "
            f"{kind.force} from what its motion needs with any payload, which is "
            f"{abs(self.observer.leftover[axis]):.1f} times the uncertainty of this average",
        )

    def stale(self, oldest_us: float, payload_us: float, tick: int) -> Finding | None:
        """Judge the age of the oldest cell of ITA in use, and how long ago the LOAD was that has not reached it."""
        if not oldest_us <= self._stale_us:
            age, most = beside(oldest_us / 1000.0, self._stale_us / 1000.0, form=".0f")
            why = f"inertia and gravity torque in use are {age} ms old"
        elif not payload_us <= self._stale_us:
            age, most = beside(payload_us / 1000.0, self._stale_us / 1000.0, form=".0f")
            why = f"the LOAD of {age} ms ago has not reached all axes"
        else:
            return None
        return Finding(code="RBL521", tick=tick, message=f"{why}, more than {most} ms")

    @property
    def was_late(self) -> bool:
        """Whether the last cycle was late."""
        return self._late > 0

    def late(self, overrun: bool, tick: int) -> Finding | None:
        """Count cycles that came too late, in a row; a warning first, a stop when it does not end."""
        self._late = self._late + 1 if overrun else 0
        if self._late == 1:
            return Finding(code="RBL520", tick=tick, message="a cycle took longer than its period", warning=True)
        if self._late >= self._limits.overruns:
            message = f"{self._late} cycles in a row took longer than the period"
            return Finding(code="RBL520", tick=tick, message=message)
        return None
