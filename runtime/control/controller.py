"""The controller: memory areas, 8 ms cycle, background task, servo and plant wired together.

One call of ``cycle`` is one interpolation period (docs/timing.md):

    216 the interrupt suspends the dynamics task
    218 INA goes to the servos (through fine interpolation), 220 so does ITA
    204-210 the interpolator computes the next set-point into INA, at its declared cost
    212 the dynamics task resumes in what is left of the period
    400-424 meanwhile every servo tick: encoder, law, motor, one step of the plant

A request that cannot be carried out raises ``Fault`` and changes nothing. What goes wrong while running becomes a
latched ``Alarm`` and stops the arm by its category (docs/supervision.md): 1 on its path, servoing until it stands, then
the brakes; 0 at once. From then on ``cycle`` does nothing and returns False, until the alarm is acknowledged.
"""

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from runtime.control.clock import Clock, VirtualClock
from runtime.control.dynamics_task import StepCosts, dynamics_task
from runtime.control.memory_areas import Areas, AxisLoad
from runtime.control.recorder import Recorder
from runtime.control.scheduler import IdleProcessor
from runtime.core.faults import Alarm, lookup
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.program_line import ProgramLine, logged
from runtime.dynamics.equations import axis_gravity, axis_row
from runtime.dynamics.source import InertiaRows
from runtime.motion.cartesian_planner import FOLLOWS, MovePlan
from runtime.motion.commands import Command, MoveLinear
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.interpolator import Interpolator
from runtime.motion.motion_planner import ChainPlan, MotionPlanner, tracked_row
from runtime.motion.seam import SeamTracker
from runtime.motion.stop import stopping_rows
from runtime.motion.velocity_profile import check_requests
from runtime.plant.plant import Plant
from runtime.plant.touches import Touches
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.servo.axes import ServoAxes, first_moments, rotors
from runtime.servo.fixed import fixed_inertia
from runtime.servo.motor import encoder_resolution, torque_limit
from runtime.settings.profile import Profile
from runtime.supervision.finding import Finding
from runtime.supervision.supervisor import LOST, Supervisor
from runtime.supervision.torque_observer import LoadModel

AT_REST = 0.01
"""Detected joint speed below which an arm that has stopped is held by its brakes, rad/s."""
LONGEST_REST_US = 500_000
"""Longest time that a stopped command waits for the arm to stand before the brakes hold it, us."""
_RUNS_AWAY = ("RBL513", "RBL514", "RBL515")
_BLOCKED = ("RBL511", "RBL512", "RBL515", "RBL516")
"""Alarms of an axis that something may have stopped."""


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
        planner: MotionPlanner | None = None,
    ) -> None:
        """``planner`` plans what is requested: one that remembers plans (``robolang.execution.plan_memory``)."""
        self.spec = spec
        self.plant = plant
        self.profile = profile
        self.kinematics = kinematics or Kinematics(spec)
        self.X_flange_tool = X_flange_tool
        self.statement: ProgramLine | None = None
        """Statement that runs, for the log and for alarms; None: none does."""
        self.alarms: list[Alarm] = []
        """Latched alarms, the one that stopped the arm first."""
        self.warnings: list[Alarm] = []
        """What was found without stopping the arm."""
        self.halted = False
        """Whether the brakes hold the arm: nothing moves until ``acknowledge``."""
        self._rest_us = self._loaded_us = 0
        self.late_cycles = 0
        """Cycles that started late against the wall clock (only when paced)."""
        self._clock = clock or VirtualClock()
        moments = first_moments(spec, profile.servo)
        self._model = ArmModel(spec, first_moments=moments)
        source, tables = profile.inertia_source, profile.servo.rotor_tables
        own = source == "pass" and not tables
        self._rows = None if own else InertiaRows(spec, self._model, source, tables)
        q = np.array(plant.q)
        self.areas = Areas(spec.n, q)
        self._power_up(q)
        self._fixed = self._fixed_inertia()
        self.servo = ServoAxes(spec, profile.servo, profile.tick_s, q, self._fixed)
        self._hold(q)
        self.processor = IdleProcessor(self._dynamics)
        self.recorder = Recorder(spec.n, profile.ticks_per_cycle, profile.tick_us, plant.q_link)
        self._planner = planner or MotionPlanner(spec, self.kinematics, profile)
        self._override = 1.0
        self._tracker: SeamTracker | None = None
        self._waiting: list[tuple[MovePlan, MoveLinear]] = []  # under the tracker a move begins where the last one led
        self._before = 0  # moves of a row before those that the interpolator has
        self._statements: tuple[ProgramLine, ...] = ()
        self.wrist_mode = FOLLOWS
        """Whether the wrist follows the path at the set-point in INA, or goes its own way
        (``runtime.motion.cartesian_planner``).
        """
        self._interpolator = Interpolator()
        self._fine = fine or FineInterpolator(profile.ticks_per_cycle, profile.period_s, self.areas.ina)
        self._fine.hold(self.areas.ina)
        servo = self.servo
        self._recorded = (servo.tau_cmd, servo.tau, servo.alpha, servo.beta, plant.q_link)
        self._supervisor = Supervisor(
            spec,
            profile.supervision,
            torque=torque_limit(spec),
            resolution=encoder_resolution(spec),
            lag=(1.0 - profile.servo.velocity_feedforward) / spec.per_axis("bandwidths", "position"),
            ticks=profile.ticks_per_cycle,
            tick_s=profile.tick_s,
            friction=profile.servo.friction_compensation,
            model=LoadModel(spec, rotors(spec, profile.servo), moments),
        )
        self._overruns = 0
        self._no_deviation = np.zeros(6)
        self.touches = None if plant.bodies is None else Touches(plant.bodies, plant.gripped)
        """What the arm, the hand and held parts touch; None where the plant knows no contacts."""

    def _power_up(self, q: Array, now_us: int = 0) -> None:
        """Fill ITA once for all axes before the brakes open, so that no servo ever works with an empty cell."""
        for axis in range(self.spec.n):
            row = axis_row(self._model, q, axis) if self._rows is None else self._rows.row(q, axis)
            T = axis_gravity(self._model, q, axis)
            self.areas.ita[axis] = AxisLoad(
                D=float(row[axis]), T=T, row=row, read_us=now_us, version=0, payload_version=self.areas.sda_version
            )

    def _hold(self, q: Array) -> None:
        """Let the servos hold motors that stand at q (n,) rad: currents against the weight, command and reference."""
        T = np.array([cell.T for cell in self.areas.ita])
        self.servo.motors.i[:] = T / self.servo.motors.Ktn
        self.areas.ina = np.clip(self.servo.resting_command(q, T), self.spec.lower, self.spec.upper)
        self.servo.q_ref = q

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
            rows=self._rows,
        )

    # requests ---------------------------------------------------------------------------------------------------

    def load(self, payload: Payload) -> None:
        """LOAD: store the payload in SDA (step 106). It reaches the servo axis by axis within one refresh."""
        self.areas.declare(payload)
        self._loaded_us = self.time_us
        self._supervisor.declare(payload, self.profile.load_mode)

    def hand(self, closed: bool) -> None:
        """HAND ON / HAND OFF: tell the tool drive circuit (steps 110 and 114)."""
        self._refuse_while_latched()
        self.plant.close_hand(closed)
        self._supervisor.hand_moves()
        if self.touches is not None:
            self.touches.hand(closed, self.statement)

    def move(self, command: Command) -> MovePlan:
        """Plan a move from the commanded position and start it; ``Fault`` RBL4xx before anything moves."""
        return self.move_chain([command]).parts[0].plan

    def move_chain(self, commands: Sequence[Command], statements: Sequence[ProgramLine] = ()) -> ChainPlan:
        """Plan moves in a row, blended where they have zones, and start them; ``ChainFault`` RBL4xx before any moves.

        ``statements``, one for each: ``statement`` becomes that of a move with the cycle that sends its first row, in
        the middle of a blend. Under a seam sensor moves are straight and do not blend: zones are taken as 0.
        """
        self._refuse_while_latched()
        if statements and len(statements) != len(commands):
            raise ValueError(f"{len(commands)} moves have {len(statements)} statements")
        here, tracker = np.array(self.areas.ina), self._tracker
        if tracker is None:
            chain = self._planner.chain(here, commands, self.X_flange_tool, self._override)
            self._interpolator.start(chain)
        else:
            tracked = tracked_row(commands)
            q_from = here if tracker.q_calculated is None else tracker.q_calculated
            chain = self._planner.chain(q_from, tracked, self.X_flange_tool, self._override)
            if self._interpolator.busy:
                raise RuntimeError("a move is running")
            self._waiting = [(part.plan, command) for part, command in zip(chain.parts, tracked, strict=True)]
        self._before, self._statements = 0 if tracker is None else -1, tuple(statements)
        self._start_waiting()
        self._name_statement()
        return chain

    def _start_waiting(self) -> None:
        """Start the next move under the tracker, if one waits and none runs: from where the seam has led the arm."""
        tracker, lines = self._tracker, self._planner.lines
        while tracker is not None and self._waiting and not self._interpolator.busy:
            plan, command = self._waiting.pop(0)
            here = np.array(self.areas.ina)
            q_from = here if tracker.q_calculated is None else tracker.q_calculated
            self._interpolator.start(plan, lines.tracked(plan, command, q_from, here, tracker, self.X_flange_tool))
            self._before += 1

    def _name_statement(self) -> None:
        if self._statements:
            self.statement = self._statements[self.chain_index]

    @property
    def override(self) -> float:
        """Share in (0, 1] of every speed, for moves that are planned from now on; accelerations stay."""
        return self._override

    @override.setter
    def override(self, share: float) -> None:
        check_requests(("OVERRIDE in %", share * 100.0, 100.0))
        self._override = min(share, 1.0)

    def rehearse(self, q_start: Array, command: Command) -> MovePlan:
        """Return the plan of a motion from q_start (n,) rad, without starting it; ``Fault`` RBL4xx."""
        if isinstance(command, MoveLinear) and self._tracker is not None:
            command = replace(command, tracked=True)
        return self._planner.plan(q_start, command, self.X_flange_tool, self._override)

    @property
    def chain_index(self) -> int:
        """Which move of the row the set-point in INA belongs to, from 0; the last one when all have been sent."""
        return self._before + self._interpolator.command

    def use_tool(self, X_flange_tool: Array) -> None:
        """TOOL: the tool point of the moves that follow, X_flange_tool (4, 4)."""
        self.X_flange_tool = X_flange_tool

    def seam(self, tracker: SeamTracker | None) -> None:
        """SEAM ON: the moves that follow go where the tracker's sensor sees the seam; None, SEAM OFF, ends that."""
        self._tracker, self._waiting = tracker, []

    @property
    def seam_deviation(self) -> Array:
        """Deviation (6,) that is superposed on the path, m and rad in the world; zeros without SEAM ON."""
        return self._no_deviation if self._tracker is None else self._tracker.deviation

    def _refuse_while_latched(self) -> None:
        if self.alarms:
            raise RuntimeError(f"{self.alarms[0].code} is latched; acknowledge it first")

    def acknowledge(self) -> None:
        """Take note of the latched alarms: the servos hold the arm where it stands, and moves are possible again.

        The interrupted move is not resumed, and a seam is no longer followed. ``RuntimeError`` while the arm is still
        stopping, and when the plant's state is no longer valid.
        """
        if not self.alarms:
            return
        if not self.halted:
            raise RuntimeError("the arm is still stopping")
        q = np.array(self.plant.q)
        if self.plant.why_invalid() or not np.isfinite(q).all():
            raise RuntimeError("the state of the plant is no longer valid")
        self._interpolator.drop()
        self._tracker, self.wrist_mode = None, FOLLOWS
        if self.areas.sda_version:
            (self._rows or self._model).set_payload(self.areas.sda, self.profile.load_mode)
        self._power_up(q, self.time_us)
        self.servo = ServoAxes(self.spec, self.profile.servo, self.profile.tick_s, q, self._fixed)
        self._hold(np.array(self.servo.alpha))
        servo = self.servo
        self._recorded = (servo.tau_cmd, servo.tau, servo.alpha, servo.beta, self.plant.q_link)
        self._fine.hold(self.areas.ina)
        self._supervisor.restart(self.recorder.tick)
        self.alarms = []
        self.halted = False

    # state ------------------------------------------------------------------------------------------------------

    @property
    def time_us(self) -> int:
        """Simulated time since power-up, us."""
        return self.recorder.tick * self.profile.tick_us

    @property
    def moving(self) -> bool:
        """Whether set-points are left to send or the command has not come to rest; never with the brakes on."""
        return not self.halted and (self._interpolator.busy or bool(self._waiting) or not self._fine.settled)

    @property
    def position_error(self) -> float:
        """Largest distance of a detected joint angle from its command and lead, rad."""
        return float(np.abs(self.servo.q_ref - self.servo.alpha).max())

    @property
    def overruns(self) -> int:
        """Cycles whose foreground work, or whose start against the wall clock, came too late."""
        return self.processor.overruns + self.late_cycles

    def tool_poses(self, q: Array) -> Array:
        """Return X_world_tool (..., 4, 4) at joint angles q (..., n)."""
        return np.asarray(matmul(self.kinematics.forward(q), self.X_flange_tool))

    # the cycle --------------------------------------------------------------------------------------------------

    def cycle(self) -> bool:
        """Run one interpolation period; False once the brakes hold the arm, and nothing is done from then on."""
        if self.halted:
            return False
        areas, profile = self.areas, self.profile
        start_us = self.time_us
        self.late_cycles += self._clock.wait_until(start_us)
        motion = self._send()
        if motion is None:
            return False
        foreground_us = 0
        self._start_waiting()
        next_row = self._interpolator.busy
        if next_row:
            areas.ina = self._interpolator.next()
            foreground_us = profile.interpolation_cost_us
            self.wrist_mode = self._interpolator.mode
            fault = self._interpolator.fault
            if fault is not None and not self.alarms:
                self._name_statement()
                self.alarm(fault.code, fault.message)
        self.processor.begin_cycle(foreground_us)
        start_tick = self.recorder.tick
        if not self._run_ticks(start_us, motion):
            return False
        if self.touches is not None:
            self._touch(self.touches, start_tick)
        if self.profile.supervision.enabled or self.alarms:  # a stop is seen to its end in any case
            self._supervise(start_us, motion)
        if next_row:  # what has been judged is the row before it
            self._name_statement()
        return not self.halted

    def _send(self) -> Array | None:
        """Steps 218 and 220: set-points and loads go to the servos; returns the motion (3, ticks, n) of the cycle.

        None, with RBL510 latched, when a cell of ITA is not finite.
        """
        cells = self.areas.ita
        if not math.isfinite(sum([cell.D + cell.T for cell in cells])):
            self._raise_non_finite(self.servo.q_ref)
            return None
        D = np.array([cell.D for cell in cells])
        T = np.array([cell.T for cell in cells])
        read_us = np.array([cell.read_us for cell in cells], dtype=np.float64)
        motion = self._fine.push(self.areas.ina)
        rows = np.array([cell.row for cell in cells]) if self.servo.coupled else None
        self.servo.take(D, T, motion, rows)
        self.recorder.begin_cycle(
            (self.areas.ina, D, T, read_us, self.seam_deviation),
            motion,
            (self.areas.sda.mass, *logged(self.statement), self.wrist_mode),
        )
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
        servo, cells = self.servo, self.areas.ita
        for name, values in (
            ("inertia D in ITA", np.array([cell.D for cell in cells])),
            ("gravity torque T in ITA", np.array([cell.T for cell in cells])),
            ("set-point in INA", self.areas.ina),
            ("command q_cmd", q_cmd),
            ("detected angle q_fb", servo.alpha),
            ("torque tau_cmd", servo.tau_cmd),
            ("torque tau_sat", servo.tau),
        ):
            bad = ~np.isfinite(values)
            if bad.any():
                axis = int(np.argmax(bad))
                self.alarm("RBL510", f"the {name} of J{axis + 1} is {values[axis]}", axis)
                return
        why = self.plant.why_invalid()
        bad = ~(np.isfinite(self.plant.q) & np.isfinite(self.plant.dq))
        named = re.search(r"(?:DOF|QPOS|QVEL) (\d+)", why)  # MuJoCo counts degrees of freedom, the arm's come first
        found = int(np.argmax(bad)) if bad.any() else int(named[1]) if named else self.spec.n
        axis_or_none = found if found < self.spec.n else None
        self.alarm("RBL510", f"the state of the plant is no longer valid{': ' + why if why else ''}", axis_or_none)

    # supervision and stops --------------------------------------------------------------------------------------

    def _supervise(self, start_us: int, motion: Array) -> None:
        """Judge the cycle that has just run; while a stop runs, only what makes it fail counts."""
        supervisor, recorder = self._supervisor, self.recorder
        rows = recorder.recent(supervisor.observer.rows)
        found = supervisor.judge(rows, self.servo.law.reference, motion[1], recorder.tick)
        if self.alarms:
            self._follow_stop(found)
            return
        if found is None and self.moving:
            cells, version = self.areas.ita, self.areas.sda_version
            oldest = start_us - min([cell.read_us for cell in cells])
            waiting = any(cell.payload_version != version for cell in cells)
            found = supervisor.stale(oldest, start_us - self._loaded_us if waiting else 0, recorder.tick)
        overruns = self.processor.overruns  # not those of the wall clock: the host is no part of the controller
        if overruns != self._overruns or supervisor.was_late:
            found = found or supervisor.late(overruns != self._overruns, recorder.tick)
            self._overruns = overruns
        if found is not None:
            self._latch(found)

    def _touch(self, touches: Touches, start_tick: int) -> None:
        """Take the contacts of the cycle that has just run; a lost part stops the arm."""
        lost = touches.cycle(start_tick, self.statement, self.plant.touching())
        if lost is not None and not self.alarms and self.profile.supervision.enabled:
            self._stop_by(self._alarm_of(Finding(code="RBL536", message=lost.message, tick=lost.tick), lost.place))

    def _follow_stop(self, found: Finding | None) -> None:
        """See a controlled stop to its end: brakes when the arm stands, at once when it does not follow."""
        lost = self._supervisor.watch.lost_track(LOST)
        if found is not None and found.code in _RUNS_AWAY and found.code != self.alarms[0].code:
            self._latch(found)
            self.halt()
        elif lost is not None:
            self.alarm("RBL518", f"J{lost + 1} did not follow the controlled stop", lost)
        elif not self.moving:
            self._rest_us += self.profile.period_us
            if bool((np.abs(self.servo.beta) <= AT_REST).all()) or self._rest_us > LONGEST_REST_US:
                self.halt()

    def halt(self) -> None:
        """Stop at once (category 0): the brakes hold the arm from this tick on."""
        self._interpolator.drop()
        self._waiting = []
        self.wrist_mode = FOLLOWS
        self.halted = True

    def _latch(self, found: Finding) -> None:
        if found.warning:
            self.warnings.append(self._alarm_of(found))
        else:
            self._stop_by(self._alarm_of(found))

    def alarm(
        self,
        code: str,
        message: str,
        axis: int | None = None,
        *,
        hint: str = "",
        statement: ProgramLine | None = None,
        calls: tuple[ProgramLine, ...] = (),
    ) -> None:
        """Latch an alarm at a statement, by default the one that runs, and stop the arm by its category."""
        found = Finding(code=code, message=message, axis=axis, tick=self.recorder.tick)
        self._stop_by(self._alarm_of(found, statement, hint, calls))

    def warn(self, code: str, message: str, hint: str = "", statement: ProgramLine | None = None) -> None:
        """Keep a warning at a statement, None: the running one, and the current tick; the arm goes on."""
        found = Finding(code=code, message=message, tick=self.recorder.tick, warning=True)
        self.warnings.append(self._alarm_of(found, statement, hint))

    def warn_of_touches(self) -> None:
        """Take what has been touched so far and should not have been into ``warnings``; once, at the end of a run."""
        for touch in [] if self.touches is None else self.touches.records:
            if touch.noticed:
                code = "RBL537" if touch.fixed else "RBL535"
                found = Finding(code=code, message=touch.message, tick=touch.tick, warning=True)
                self.warnings.append(self._alarm_of(found, touch.place))
        self.warnings.sort(key=lambda alarm: alarm.tick)

    def _alarm_of(
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
            statement=statement or self.statement,
            calls=calls,
            hint=hint or entry.remedy,
        )

    def _stop_by(self, alarm: Alarm) -> None:
        if self.touches is not None and alarm.code in _BLOCKED:
            self.touches.blocked()
        self.alarms.append(alarm)
        self._waiting = []
        if alarm.category == 0:
            self.halt()
        elif len(self.alarms) == 1:
            self._rest_us = 0
            limits = self.spec.per_axis("limits", "speed"), self.spec.per_axis("limits", "acceleration")
            self._interpolator.stop(lambda rows, at, whole: stopping_rows(rows, at, self._fine, *limits, whole))
