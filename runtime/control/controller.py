"""The controller: memory areas, 8 ms cycle, background task, servo and plant wired together.

One call of ``cycle`` is one interpolation period (docs/timing.md):

    216 the interrupt suspends the dynamics task
    218 INA goes to the servos (through fine interpolation), 220 so does ITA
    204-210 the interpolator computes the next set-point into INA, at its declared cost
    212 the dynamics task resumes in what is left of the period
    400-424 meanwhile every servo tick: encoder, law, motor, one step of the plant

It is made of three parts: ``RequestQueue`` (what moves next), ``DriveTrain`` (servo, plant and what watches them) and
``StopLogic`` (alarms and the brakes). ``snapshot`` and ``restore`` take the whole of them back to an earlier cycle.

A request that cannot be carried out raises ``Fault`` and changes nothing. What goes wrong while running becomes a
latched ``Alarm`` and stops the arm by its category (docs/supervision.md): 1 on its path, servoing until it stands, then
the brakes; 0 at once. From then on ``cycle`` does nothing and returns False, until the alarm is acknowledged.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from runtime.control.clock import Clock, VirtualClock
from runtime.control.drive_train import DriveTrain
from runtime.control.memory_areas import Areas
from runtime.control.recorder import Recorder
from runtime.control.request_queue import RequestQueue, SetAside
from runtime.control.scheduler import IdleProcessor
from runtime.control.signals import Signals
from runtime.control.stop_logic import StopLogic
from runtime.control.touch_warnings import touch_warnings
from runtime.core.faults import Alarm
from runtime.core.frames import Array
from runtime.core.limits import OVERRIDE
from runtime.core.linear import matmul
from runtime.core.program_line import ProgramLine
from runtime.core.state import State
from runtime.core.units import PERCENT
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import Command
from runtime.motion.motion_planner import ChainPlan, MotionPlanner
from runtime.motion.seam import SeamTracker
from runtime.plant.plant import Plant
from runtime.plant.touches import Touch, Touches
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.servo.axes import ServoAxes
from runtime.settings.profile import Profile
from runtime.supervision.finding import Finding


@dataclass(frozen=True, slots=True, kw_only=True)
class ControllerSnapshot:
    """A controller between two cycles, at ``time_us`` us: all that its future depends on, the plant included.

    It shares the log, the plans and the robot with the controller and copies what changes.
    """

    robot: str
    time_us: int
    requests: State
    drives: State
    stops: State
    late_cycles: int


class Controller:
    """A robot controller over one plant. Joint vectors are (n,), SI and radians."""

    def __init__(
        self,
        spec: RobotSpec,
        plant: Plant,
        profile: Profile,
        X_flange_tool: Array,
        clock: Clock | None = None,
        planner: MotionPlanner | None = None,
    ) -> None:
        """``planner`` plans what is requested: one that remembers plans (``robolang.execution.plan_memory``)."""
        self.spec = spec
        self.profile = profile
        planner = planner or MotionPlanner(spec, Kinematics(spec), profile)
        self.kinematics = planner.kinematics
        self.drives = DriveTrain(spec, plant, profile, X_flange_tool)
        self.requests = RequestQueue(spec, planner, self.drives.areas, self.drives.fine, X_flange_tool)
        self.stops = StopLogic(self.requests, self.drives, profile.period_us)
        self.late_cycles = 0
        """Cycles that started late against the wall clock (only when paced)."""
        self._clock = clock or VirtualClock()
        self._no_deviation = np.zeros(6)
        self.paced = True
        """Whether cycles keep the time of the clock; False while cycles of the past are run once more."""

    # requests -------------------------------------------------------------------------------------------------------

    def load(self, payload: Payload) -> None:
        """LOAD: store the payload in SDA (step 106). It reaches the servo axis by axis within one refresh."""
        self.drives.load(payload)

    def hand(self, closed: bool) -> None:
        """HAND ON / HAND OFF: tell the tool drive circuit (steps 110 and 114)."""
        self._refuse_while_latched()
        self.drives.hand(closed, self.statement)

    def move(self, command: Command) -> MovePlan:
        """Plan a move from the commanded position and start it; ``Fault`` RBL4xx before anything moves."""
        return self.move_chain([command]).parts[0].plan

    def move_chain(
        self, commands: Sequence[Command], statements: Sequence[ProgramLine] = (), *, more: bool = False
    ) -> ChainPlan:
        """Plan moves in a row, blended where they have zones, and start them; ``ChainFault`` RBL4xx before any moves.

        ``statements``, one for each: ``statement`` becomes that of a move with the cycle that sends its first row, in
        the middle of a blend. Under a seam sensor moves are straight and do not blend: zones are taken as 0. ``more``:
        other moves may follow without a stop (``RequestQueue.extend``).
        """
        self._refuse_while_latched()
        return self.requests.chain(commands, statements, more=more)

    def play(self, rows: Array, checked: bool = True) -> None:
        """Send joint set-points (K, n) rad, one in each cycle from the next one on, in place of a planned move.

        ``Fault`` RBL411 where a joint would leave its range and RBL404 where it would be too fast at a servo tick;
        ``ValueError`` for rows that are not (K, n) or not finite; ``RuntimeError`` while a move runs or a seam is
        followed. Nothing has moved then. ``checked`` False leaves range and speed to the supervision, for rows that
        come from elsewhere and are to be executed unchanged; ``speed_cap`` holds for them as well (RBL404).
        """
        self._refuse_while_latched()
        self.requests.play(rows, checked)

    def jump(self, q: Array) -> None:
        """Set the reference to q (n,) rad at once, without interpolation and speed: the step of a step response.

        It is held exactly until another request moves. ``RuntimeError`` while a move runs, ``Fault`` RBL411 outside the
        joint ranges and RBL404 under a speed cap.
        """
        self._refuse_while_latched()
        self.requests.jump(q)

    def rehearse(self, q_start: Array, command: Command) -> MovePlan:
        """Return the plan of a motion from q_start (n,) rad, without starting it; ``Fault`` RBL4xx."""
        return self.requests.rehearse(q_start, command)

    def use_tool(self, X_flange_tool: Array) -> None:
        """TOOL: the tool point of the moves that follow, X_flange_tool (4, 4)."""
        self.requests.X_flange_tool = X_flange_tool
        self.recorder.use_tool(X_flange_tool)

    def seam(self, tracker: SeamTracker | None) -> None:
        """SEAM ON: the moves that follow go where the tracker's sensor sees the seam; None, SEAM OFF, ends that."""
        self.requests.seam(tracker)

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
        self.requests.drop()
        self.requests.seam(None)
        self.drives.power_up(q, self.time_us, detected=True)
        self.drives.supervisor.restart(self.recorder.tick)
        self.stops.release()

    def _refuse_while_latched(self) -> None:
        if self.alarms:
            raise RuntimeError(f"{self.alarms[0].code} is latched; acknowledge it first")

    # the cycle ------------------------------------------------------------------------------------------------------

    def cycle(self) -> bool:
        """Run one interpolation period; False once the brakes hold the arm, and nothing is done from then on."""
        if self.halted:
            return False
        drives, requests = self.drives, self.requests
        start_us, start_tick = drives.time_us, drives.recorder.tick
        if self.paced:
            self.late_cycles += self._clock.wait_until(start_us)
        # before the interrupt, which sends a given row in its own cycle; a computed one waits for the next interrupt
        requests.given_row()
        motion = drives.send(requests.statement, requests.wrist_mode, self.seam_deviation)
        if motion is None:
            return self._stop_not_finite(drives.servo.q_ref)
        computed = self._interpolate()
        failed = drives.run()
        if failed is not None:
            return self._stop_not_finite(motion[0, failed])
        self._supervise(start_us, start_tick, motion)
        if computed:  # what has been judged is the row before it
            requests.name_statement()
        return not self.halted

    def _interpolate(self) -> bool:
        """Compute the next set-point into INA, if any, and let the dynamics task have the rest of the period."""
        computed = self.requests.next_row()
        fault = self.requests.interpolator.fault
        if computed and fault is not None and not self.alarms:
            # the row in INA is the one that failed, while the statement is still that of the row before it
            self.requests.name_statement()
            self.alarm(fault.code, fault.message)
        self.drives.processor.begin_cycle(self.profile.interpolation_cost_us if computed else 0)
        return computed

    def _stop_not_finite(self, q_cmd: Array) -> bool:
        """Latch RBL510 and name the first hand-over that was not finite; the command was q_cmd (n,)."""
        self.alarm("RBL510", *self.drives.not_finite(q_cmd))
        return False

    def _supervise(self, start_us: int, start_tick: int, motion: Array) -> None:
        """Judge the cycle that has just run: touches, then the checks of supervision."""
        enabled = self.profile.supervision.enabled
        lost = self.drives.touched(start_tick, self.statement)
        if lost is not None and enabled and not self.alarms:
            found = Finding(code="RBL536", message=lost.message, tick=lost.tick)
            self.stops.stop_by(self.stops.alarm_of(found, lost.place))
        if self.alarms:  # a stop is seen to its end in any case
            self.stops.follow(self.drives.judge(motion))
        elif enabled:
            self._judge(start_us, motion)

    def _judge(self, start_us: int, motion: Array) -> None:
        drives = self.drives
        found = drives.judge(motion)
        if found is None and self.moving:
            found = drives.stale(start_us)
        late = drives.late()
        if found is None and (late or drives.supervisor.was_late):
            found = drives.supervisor.late(late, drives.recorder.tick)
        if found is not None:
            self.stops.take(found)

    # stops ----------------------------------------------------------------------------------------------------------

    def hold(self) -> bool:
        """Bring the motion to rest on its path, so that ``go_on`` can resume it; returns whether the command rests.

        Call it before every cycle until it does. A move under a seam sensor comes to its end first.
        """
        self.requests.hold()
        return not self.moving

    def go_on(self) -> None:
        """Resume the motion that ``hold`` has brought to rest; the rest of the path is that of the plan."""
        self.requests.go_on()

    def set_aside(self) -> SetAside:
        """Forget the motion that ``hold`` has brought to rest, so that the arm can be moved; return it for ``take_up``.

        ``RuntimeError`` while it still moves.
        """
        return self.requests.set_aside()

    def take_up(self, left: SetAside) -> None:
        """Put a motion back that was set aside; ``go_on`` resumes it. The arm has to be where its path was left."""
        self._refuse_while_latched()
        self.requests.take_up(left)

    def halt(self) -> None:
        """Stop at once (category 0): the brakes hold the arm from this tick on."""
        self.stops.halt()

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
        self.stops.stop_by(self.stops.alarm_of(found, statement, hint, calls))

    def warn(self, code: str, message: str, hint: str = "", statement: ProgramLine | None = None) -> None:
        """Keep a warning at a statement, None: the running one, and the current tick; the arm goes on."""
        found = Finding(code=code, message=message, tick=self.recorder.tick, warning=True)
        self.warnings.append(self.stops.alarm_of(found, statement, hint))

    def warn_of_touches(self) -> None:
        """Take what has been touched so far and should not have been into ``warnings``; once, at the end of a run."""
        self.warnings.extend(self.touch_warnings([] if self.touches is None else self.touches.records))
        # touches are complete at the end only; the report lists warnings in the order of time
        self.warnings.sort(key=lambda alarm: alarm.tick)

    def touch_warnings(self, touches: Iterable[Touch]) -> list[Alarm]:
        """Return the warnings of those touches that are findings; nothing is kept."""
        return [self.stops.alarm_of(found, place, hint) for found, place, hint in touch_warnings(touches)]

    def rename(self, name: Callable[[ProgramLine], ProgramLine]) -> None:
        """Name the statements of moves, alarms and warnings anew: the program that they are of has been edited."""
        self.requests.rename(name)
        stops = self.stops
        stops.alarms, stops.warnings = (
            [alarm.replaced(statement=name(alarm.statement)) if alarm.statement else alarm for alarm in found]
            for found in (stops.alarms, stops.warnings)
        )

    # snapshots ------------------------------------------------------------------------------------------------------

    def snapshot(self) -> ControllerSnapshot:
        """Return all that the future of this controller and its plant depends on; called between two cycles.

        The log is not copied: the snapshot marks how far it goes.
        """
        return ControllerSnapshot(
            robot=self.spec.name,
            time_us=self.time_us,
            requests=self.requests.snapshot(),
            drives=self.drives.snapshot(),
            stops=self.stops.snapshot(),
            late_cycles=self.late_cycles,
        )

    def restore(self, snapshot: ControllerSnapshot) -> None:
        """Go back, or on, to a snapshot of this controller or of another one that was built from the same data.

        From there on the same requests give the same bytes. The log is the one that led to the snapshot. ``tracker``
        is a new object afterwards; areas, servo, plant and recorder stay the same ones. ``ValueError``, and nothing is
        changed, for a snapshot of another robot or on another kind of plant.
        """
        if snapshot.robot != self.spec.name:
            raise ValueError(f"the snapshot is of the robot {snapshot.robot}, not of {self.spec.name}")
        snapshot.drives.check(self.drives)  # before the first write: a refusal must leave no mixture
        self.requests.restore(snapshot.requests)
        self.drives.restore(snapshot.drives)
        self.stops.restore(snapshot.stops)
        self.late_cycles = snapshot.late_cycles
        self._clock.restart()

    def restart_clock(self) -> None:
        """Keep wall time from the next cycle on: cycles that were not run meanwhile, in a pause, are not late."""
        self._clock.restart()

    # state ----------------------------------------------------------------------------------------------------------

    @property
    def statement(self) -> ProgramLine | None:
        """Statement that runs, for the log and for alarms; None: none does."""
        return self.requests.statement

    @statement.setter
    def statement(self, statement: ProgramLine | None) -> None:
        self.requests.statement = statement

    @property
    def override(self) -> float:
        """Share in (0, 1] of every speed, for moves that are planned from now on; accelerations stay."""
        return self.requests.override

    @override.setter
    def override(self, share: float) -> None:
        OVERRIDE.checked(share / PERCENT, OVERRIDE.high)
        self.requests.override = min(share, 1.0)  # the check lets rounding above 100 % pass

    @property
    def speed_cap(self) -> float | None:
        """Cap on the speed of tool point and flange, m/s, for what is planned or given from now on; None: no cap.

        In MANUAL ``runtime.motion.speed_cap.MANUAL_SPEED``. Commands keep a margin below it for the motion of the arm.
        """
        return self.requests.speed_cap

    @speed_cap.setter
    def speed_cap(self, most: float | None) -> None:
        if most is not None and not 0.0 < most < math.inf:
            raise ValueError(f"a speed cap of {most} m/s is not above 0")
        self.requests.speed_cap = most

    @property
    def X_flange_tool(self) -> Array:
        """Tool point of the moves that follow (4, 4)."""
        return self.requests.X_flange_tool

    @property
    def weighing(self) -> bool:
        """Whether the payload is being weighed: supervision does not compare it with the declared one."""
        return self.drives.supervisor.weighing

    @weighing.setter
    def weighing(self, on: bool) -> None:
        self.drives.supervisor.weighing = on

    @property
    def wrist_mode(self) -> int:
        """Whether the wrist follows the path at the set-point in INA (``runtime.motion.cartesian_planner``)."""
        return self.requests.wrist_mode

    @property
    def chain_index(self) -> int:
        """Which move of the row the set-point in INA belongs to, from 0; the last one when all have been sent."""
        return self.requests.index

    @property
    def tracker(self) -> SeamTracker | None:
        """Tracker of the seam that moves follow; None without SEAM ON."""
        return self.requests.tracker

    @property
    def seam_deviation(self) -> Array:
        """Deviation (6,) that is superposed on the path, m and rad in the world; zeros without SEAM ON."""
        tracker = self.requests.tracker
        return self._no_deviation if tracker is None else tracker.deviation

    @property
    def alarms(self) -> list[Alarm]:
        """Latched alarms, the one that stopped the arm first."""
        return self.stops.alarms

    @property
    def warnings(self) -> list[Alarm]:
        """What was found without stopping the arm."""
        return self.stops.warnings

    @property
    def halted(self) -> bool:
        """Whether the brakes hold the arm: nothing moves until ``acknowledge``."""
        return self.stops.halted

    @property
    def moving(self) -> bool:
        """Whether set-points are left to send or the command has not come to rest; never with the brakes on."""
        return self.stops.moving

    @property
    def time_us(self) -> int:
        """Simulated time since power-up, us."""
        return self.drives.time_us

    @property
    def position_errors(self) -> Array:
        """Distance of each detected joint from its command and lead (n,), rad; a mm counts as a deg."""
        return np.asarray(np.abs(self.servo.q_ref - self.servo.alpha) / self.spec.bound(1.0))

    @property
    def position_error(self) -> float:
        """The largest of them, rad."""
        return float(self.position_errors.max())

    @property
    def overruns(self) -> int:
        """Cycles whose foreground work, or whose start against the wall clock, came too late."""
        return self.processor.overruns + self.late_cycles

    def tool_poses(self, q: Array) -> Array:
        """Return X_world_tool (..., 4, 4) at joint angles q (..., n)."""
        return np.asarray(matmul(self.kinematics.forward(q), self.X_flange_tool))

    def signals(self) -> Signals:
        """Return the signals of the run up to now, by name."""
        return Signals(self.recorder.recorded(), self.kinematics.chain)

    # parts of the drive train ---------------------------------------------------------------------------------------

    @property
    def plant(self) -> Plant:
        """The robot."""
        return self.drives.plant

    @plant.setter
    def plant(self, plant: Plant) -> None:
        self.drives.plant = plant

    @property
    def areas(self) -> Areas:
        """SDA, ITA, INA and ANG."""
        return self.drives.areas

    @property
    def servo(self) -> ServoAxes:
        """The servo of all axes; a new one after ``acknowledge``."""
        return self.drives.servo

    @property
    def processor(self) -> IdleProcessor:
        """The processor that the dynamics task shares with the cycle."""
        return self.drives.processor

    @property
    def recorder(self) -> Recorder:
        """The log so far."""
        return self.drives.recorder

    @property
    def touches(self) -> Touches | None:
        """What the arm, the hand and held parts touch; None where the plant knows no contacts."""
        return self.drives.touches
