"""The controller: memory areas, 8 ms cycle, background task, servo and plant wired together.

One call of ``cycle`` is one interpolation period (docs/timing.md):

    216 the interrupt suspends the dynamics task
    218 INA goes to the servos (through fine interpolation), 220 so does ITA
    204-210 the interpolator computes the next set-point into INA, at its declared cost
    212 the dynamics task resumes in what is left of the period
    400-424 meanwhile every servo tick: encoder, law, motor, one step of the plant

A request that cannot be carried out raises ``Fault`` and changes nothing. What goes wrong while running becomes a
latched ``Alarm``: from then on ``cycle`` does nothing and returns False.
"""

from collections.abc import Iterator

import numpy as np

from runtime.areas import Areas, AxisLoad
from runtime.clock import Clock, VirtualClock
from runtime.dynamics.equations import axis_gravity, axis_row
from runtime.dynamics.task import StepCosts, dynamics_task
from runtime.faults import Alarm, lookup
from runtime.frames import Array
from runtime.motion.commands import MoveLinear
from runtime.motion.fine import FineInterpolator
from runtime.motion.interpolator import Interpolator
from runtime.motion.planner import LinePlan, LinePlanner
from runtime.plant.plant import Plant
from runtime.profile import Profile
from runtime.recorder import Recorder
from runtime.robot.kinematics import Kinematics
from runtime.robot.model import ArmModel
from runtime.robot.payload import Payload
from runtime.robot.spec import RobotSpec
from runtime.scheduler import IdleProcessor
from runtime.servo.axes import ServoAxes
from runtime.servo.fixed import fixed_inertia


class Controller:
    """A robot controller over one plant. Joint vectors are (n,), SI and radians."""

    def __init__(
        self,
        spec: RobotSpec,
        plant: Plant,
        profile: Profile,
        X_flange_tool: Array,
        clock: Clock | None = None,
        kinematics: Kinematics | None = None,
        fine: FineInterpolator | None = None,
    ) -> None:
        self.spec = spec
        self.plant = plant
        self.profile = profile
        self.kinematics = kinematics or Kinematics(spec)
        self.X_flange_tool = X_flange_tool
        self.line = 0
        """Program line that runs, for the log and for alarms."""
        self.alarms: list[Alarm] = []
        self.late_cycles = 0
        """Cycles that started late against the wall clock (only when paced)."""
        self._clock = clock or VirtualClock()
        self._model = ArmModel(spec)
        q = np.array(plant.q)
        self.areas = Areas(spec.n, q)
        self._power_up(q)
        self.servo = ServoAxes(spec, profile.servo, profile.tick_s, q, self._fixed_inertia())
        self.servo.motors.i[:] = [cell.T for cell in self.areas.ita] / self.servo.motors.Ktn
        self.processor = IdleProcessor(self._dynamics)
        self.recorder = Recorder(spec.n, profile.ticks_per_cycle, profile.tick_us)
        self._planner = LinePlanner(spec, self.kinematics, profile)
        self._interpolator = Interpolator()
        self._fine = fine or FineInterpolator(profile.ticks_per_cycle, profile.period_s, q)
        self._q_cmd = q
        servo = self.servo
        self._recorded = (servo.tau_cmd, servo.tau, servo.alpha, servo.beta)

    def _power_up(self, q: Array) -> None:
        """Fill ITA once for all axes before the brakes open, so that no servo ever works with an empty cell."""
        for axis in range(self.spec.n):
            row, T = axis_row(self._model, q, axis), axis_gravity(self._model, q, axis)
            self.areas.ita[axis] = AxisLoad(D=float(row[axis]), T=T, row=row, read_us=0, version=0, payload_version=0)

    def _fixed_inertia(self) -> Array:
        """Return the inertia (n,) of gains that do not follow the posture; zeros where they do."""
        if self.profile.servo.mode != "fixed":
            return np.zeros(self.spec.n)
        return fixed_inertia(self.spec, self.profile.servo, self.X_flange_tool)

    def _dynamics(self, processor: IdleProcessor) -> Iterator[int]:
        return dynamics_task(
            self.areas,
            self._model,
            StepCosts.of_axis(self.profile.axis_cost_us),
            read_angles=lambda: self.servo.alpha,
            now_us=lambda: processor.now_us,
            load_mode=self.profile.load_mode,
        )

    # requests ---------------------------------------------------------------------------------------------------

    def load(self, payload: Payload) -> None:
        """LOAD: store the payload in SDA (step 106). It reaches the servo axis by axis within one refresh."""
        self.areas.declare(payload)

    def hand(self, closed: bool) -> None:
        """HAND ON / HAND OFF: tell the tool drive circuit (steps 110 and 114)."""
        self.plant.close_hand(closed)

    def move(self, command: MoveLinear) -> LinePlan:
        """Plan a straight move from the commanded position and start it; ``Fault`` RBL4xx before anything moves."""
        plan = self._planner.plan(np.array(self.areas.ina), command, self.X_flange_tool)
        self._interpolator.start(plan)
        return plan

    # state ------------------------------------------------------------------------------------------------------

    @property
    def time_us(self) -> int:
        """Simulated time since power-up, us."""
        return self.recorder.tick * self.profile.tick_us

    @property
    def moving(self) -> bool:
        """Whether set-points are left to send or the command has not come to rest."""
        return self._interpolator.busy or not self._fine.settled

    @property
    def position_error(self) -> float:
        """Largest distance of a detected joint angle from its command, rad."""
        return float(np.abs(self._q_cmd - self.servo.alpha).max())

    @property
    def overruns(self) -> int:
        """Cycles whose foreground work, or whose start against the wall clock, came too late."""
        return self.processor.overruns + self.late_cycles

    def tool_poses(self, q: Array) -> Array:
        """Return X_world_tool (..., 4, 4) at joint angles q (..., n)."""
        return np.asarray(self.kinematics.forward(q) @ self.X_flange_tool)

    # the cycle --------------------------------------------------------------------------------------------------

    def cycle(self) -> bool:
        """Run one interpolation period; False when an alarm is latched and nothing was done."""
        if self.alarms:
            return False
        areas, profile = self.areas, self.profile
        start_us = self.time_us
        self.late_cycles += self._clock.wait_until(start_us)
        motion = self._send()
        foreground_us = 0
        if self._interpolator.busy:
            areas.ina = self._interpolator.next()
            foreground_us = profile.interpolation_cost_us
        self.processor.begin_cycle(foreground_us)
        return self._run_ticks(start_us, motion)

    def _send(self) -> Array:
        """Steps 218 and 220: set-points and loads go to the servos; returns the motion (3, ticks, n) of the cycle."""
        cells = self.areas.ita
        D = np.array([cell.D for cell in cells])
        T = np.array([cell.T for cell in cells])
        read_us = np.array([cell.read_us for cell in cells], dtype=np.float64)
        motion = self._fine.push(self.areas.ina)
        self._q_cmd = motion[0, -1]
        rows = np.stack([cell.row for cell in cells]) if self.servo.coupled else None
        self.servo.take(D, T, motion, rows)
        self.recorder.begin_cycle(self.areas.ina, D, T, read_us, motion, self.areas.sda.mass, self.line)
        return motion

    def _run_ticks(self, start_us: int, motion: Array) -> bool:
        tick, q, step = self.servo.tick, self.plant.q, self.plant.step
        record, advance, recorded = self.recorder.record, self.processor.advance, self._recorded
        tick_us = self.profile.tick_us
        now_us = start_us
        for k in range(self.profile.ticks_per_cycle):
            if not step(tick(k, q)):
                self._raise_non_finite(motion[0, k])
                return False
            record(recorded)
            now_us += tick_us
            advance(now_us)
        return True

    def _raise_non_finite(self, q_cmd: Array) -> None:
        """Latch RBL510 and name the first hand-over that was not finite, from the command to the plant."""
        servo = self.servo
        for name, values in (("command q_cmd", q_cmd), ("detected angle q_fb", servo.alpha),
                             ("torque tau_cmd", servo.tau_cmd), ("torque tau_sat", servo.tau)):  # fmt: skip
            bad = ~np.isfinite(values)
            if bad.any():
                axis = int(np.argmax(bad))
                self.alarm("RBL510", f"the {name} of J{axis + 1} is {values[axis]}", axis)
                return
        why = self.plant.why_invalid()
        self.alarm("RBL510", f"the state of the plant is no longer valid{': ' + why if why else ''}")

    def alarm(self, code: str, message: str, axis: int | None = None) -> None:
        """Latch an alarm at the running line and the current tick."""
        self.alarms.append(
            Alarm(
                code=code,
                message=message,
                tick=self.recorder.tick,
                axis=axis,
                line=self.line or None,
                hint=lookup(code).remedy,
            )
        )
