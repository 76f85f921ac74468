"""The drive train of one controller: from the set-points in INA to the plant, and back to what supervision finds.

In every cycle ``send`` takes INA through fine interpolation to the servos, and ITA with it (steps 218 and 220); ``run``
lets the servos work tick by tick, each with the plant and the dynamics task; ``judge`` and what follows it check the
cycle that has just run. It knows nothing of moves and stops nothing: a finding is a value.
"""

import math
import re

import numpy as np

from runtime.control.dynamics_task import DynamicsTask, StepCosts
from runtime.control.memory_areas import Areas
from runtime.control.recorder import Recorder
from runtime.control.scheduler import IdleProcessor
from runtime.core.frames import Array
from runtime.core.program_line import ProgramLine, logged
from runtime.core.state import Stateful
from runtime.dynamics.source import InertiaRows
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.plant.plant import Plant
from runtime.plant.touches import Loss, Touches
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from runtime.servo.axes import ServoAxes, bandwidths, first_moments, rotors
from runtime.servo.fixed import fixed_inertia
from runtime.servo.motor import encoder_resolution, torque_limit
from runtime.settings.profile import Profile
from runtime.supervision.drive_data import DriveData
from runtime.supervision.finding import Finding
from runtime.supervision.supervisor import LOST, Supervisor
from runtime.supervision.torque_observer import LoadModel

AT_REST = 0.01
"""Detected joint speed below which an arm that has stopped is held by its brakes, rad/s."""


def drive_data(spec: RobotSpec, profile: Profile) -> DriveData:
    """Return what supervision knows of the drives of a robot under a profile."""
    return DriveData(
        torque=torque_limit(spec),
        resolution=encoder_resolution(spec),
        lag=(1.0 - profile.servo.velocity_feedforward) / bandwidths(spec, profile.servo)[0],
        ticks=profile.ticks_per_cycle,
        tick_s=profile.tick_s,
        friction=profile.servo.friction_compensation,
    )


def load_model(spec: RobotSpec, profile: Profile) -> LoadModel:
    """Return the arm by which torques are judged, with what an identification has found of it."""
    return LoadModel(spec, rotors(spec, profile.servo), first_moments(spec, profile.servo))


class DriveTrain(Stateful):
    """Areas, fine interpolation, servo, dynamics task, plant, recorder and supervision of n axes."""

    VALUES = ("_loaded_us", "_overruns")
    PARTS = ("plant", "areas", "fine", "servo", "processor", "recorder", "supervisor", "touches")

    def __init__(self, spec: RobotSpec, plant: Plant, profile: Profile, X_flange_tool: Array) -> None:
        self._spec, self._profile = spec, profile
        self.plant = plant
        moments = first_moments(spec, profile.servo)
        model = ArmModel(spec, first_moments=moments)
        source, tables = profile.inertia_source, profile.servo.rotor_tables
        bare = source == "pass" and not tables
        q = np.array(plant.q)
        self.areas = Areas(spec.n, q)
        self._task = DynamicsTask(
            self.areas,
            model,
            StepCosts.of_axis(profile.axis_cost_us),
            read_angles=lambda: self.servo.alpha,  # not the array: ``power_up`` makes a new servo
            load_mode=profile.load_mode,
            rows=None if bare else InertiaRows(spec, model, source, tables),
        )
        self._held_inertia = np.zeros(spec.n)
        if profile.servo.mode == "fixed":
            self._held_inertia = fixed_inertia(spec, profile.servo, X_flange_tool)
        self.processor = IdleProcessor(self._task)
        self.recorder = Recorder(spec.n, profile.ticks_per_cycle, profile.tick_us, len(plant.parts()))
        self.recorder.begin(plant.q_link, X_flange_tool)
        self.fine = FineInterpolator(profile.ticks_per_cycle, profile.period_s, q)
        self.power_up(q, 0)
        self.supervisor = Supervisor(spec, profile.supervision, drive_data(spec, profile), load_model(spec, profile))
        self.touches = None if plant.bodies is None else Touches(plant.bodies, plant.gripped)
        """What the arm, the hand and held parts touch; None where the plant knows no contacts."""
        self._loaded_us = self._overruns = 0

    def power_up(self, q: Array, now_us: int, detected: bool = False) -> None:
        """Let new servos hold motors that stand at q (n,) rad: currents against the weight, command and reference.

        ``detected``: the reference is what the encoders read there.
        """
        self._task.fill(q, now_us)
        self.servo = ServoAxes(self._spec, self._profile.servo, self._profile.tick_s, q, self._held_inertia)
        # after a stop the motors stand wherever they are, and a controller knows that by its encoders alone
        reference = np.array(self.servo.alpha) if detected else q
        T = np.array([cell.T for cell in self.areas.ita])
        # the motors carry the arm from the first tick on: no sag (docs/decisions/0012)
        self.servo.motors.i[:] = T / self.servo.motors.Ktn
        self.areas.ina = np.clip(self.servo.resting_command(reference, T), self._spec.lower, self._spec.upper)
        self.servo.q_ref = reference
        self.fine.hold(self.areas.ina)

    def load(self, payload: Payload) -> None:
        """Store the payload in SDA (step 106)."""
        self.areas.declare(payload)
        self._loaded_us = self.time_us
        self.supervisor.declare(payload, self._profile.load_mode)

    def hand(self, closed: bool, statement: ProgramLine | None) -> None:
        """Tell the tool drive circuit to close or open the hand (steps 110 and 114)."""
        self.plant.close_hand(closed)
        self.supervisor.hand_moves()
        if self.touches is not None:
            self.touches.hand(closed, statement)

    @property
    def time_us(self) -> int:
        """Simulated time since power-up, us."""
        return self.recorder.tick * self._profile.tick_us

    @property
    def slow(self) -> bool:
        """Whether the axes turn so slowly that the brakes may take them."""
        return bool((np.abs(self.servo.beta) <= AT_REST).all())

    # the cycle ------------------------------------------------------------------------------------------------------

    def send(self, statement: ProgramLine | None, wrist_mode: int, seam_deviation: Array) -> Array | None:
        """Steps 218 and 220: set-points and loads go to the servos; returns the motion (3, ticks, n) of the cycle.

        None when a cell of ITA is not finite. The statement, the mode and the deviation (6,) are recorded.
        """
        cells = self.areas.ita
        # one sum in place of 2 n comparisons: NaN and infinity remain in it
        if not math.isfinite(sum([cell.D + cell.T for cell in cells])):
            return None
        D = np.array([cell.D for cell in cells])
        T = np.array([cell.T for cell in cells])
        read_us = np.array([cell.read_us for cell in cells], dtype=np.float64)
        motion = self.fine.push(self.areas.ina)
        rows = np.array([cell.row for cell in cells]) if self.servo.coupled else None
        self.servo.take(D, T, motion, rows)
        self.recorder.begin_cycle(
            (self.areas.ina, D, T, read_us, seam_deviation),
            motion,
            (self.areas.sda.mass, *logged(statement), wrist_mode),
            self.plant.moved,
        )
        return motion

    def run(self) -> int | None:
        """Run the servo ticks of a cycle; the tick, from 0, at which the plant's state was no longer valid, or None."""
        # the inner loop of every run: what does not change in it is looked up once
        servo, plant = self.servo, self.plant
        tick, q, step = servo.tick, plant.q, plant.step
        record, advance = self.recorder.record, self.processor.advance
        recorded = (servo.tau_cmd, servo.tau, servo.alpha, servo.beta, plant.q_link)
        now_us, tick_us = self.time_us, self._profile.tick_us
        for k in range(self._profile.ticks_per_cycle):
            if not step(tick(k, q)):
                return k
            record(recorded)
            now_us += tick_us
            advance(now_us)
        return None

    def not_finite(self, q_cmd: Array) -> tuple[str, int | None]:
        """Return a message on the first hand-over that is not finite, from ITA to the plant, and its axis, 0-based."""
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
                return f"the {name} of J{axis + 1} is {values[axis]}", axis
        why = self.plant.why_invalid()
        bad = ~(np.isfinite(self.plant.q) & np.isfinite(self.plant.dq))
        named = re.search(r"(?:DOF|QPOS|QVEL) (\d+)", why)  # MuJoCo counts degrees of freedom, the arm's come first
        found = int(np.argmax(bad)) if bad.any() else int(named[1]) if named else self._spec.n
        message = f"the state of the plant is no longer valid{': ' + why if why else ''}"
        return message, found if found < self._spec.n else None

    # supervision ----------------------------------------------------------------------------------------------------

    def judge(self, motion: Array) -> Finding | None:
        """Return what is wrong with the ticks of the cycle that has just run, whose commands were ``motion``."""
        supervisor, recorder = self.supervisor, self.recorder
        rows = recorder.recent(supervisor.observer.rows)
        return supervisor.judge(rows, self.servo.law.reference, motion[1], recorder.tick)

    def stale(self, start_us: int) -> Finding | None:
        """Return whether the loads in use in the cycle that began at ``start_us`` are too old."""
        cells, version = self.areas.ita, self.areas.sda_version
        oldest = start_us - min([cell.read_us for cell in cells])
        waiting = any(cell.payload_version != version for cell in cells)
        waited_us = start_us - self._loaded_us if waiting else 0
        return self.supervisor.stale(oldest, waited_us, self.recorder.tick)

    def late(self) -> bool:
        """Return whether the foreground was late since the last call.

        Late starts against the wall clock do not count: the host is no part of the controller.
        """
        before, self._overruns = self._overruns, self.processor.overruns
        return before != self._overruns

    def lost_track(self) -> int | None:
        """Return the axis (0-based) that does not follow a controlled stop; None: all do."""
        return self.supervisor.watch.lost_track(LOST)

    def touched(self, start_tick: int, statement: ProgramLine | None) -> Loss | None:
        """Take the contacts of the cycle from ``start_tick`` on; return a part that was lost, if any."""
        return None if self.touches is None else self.touches.cycle(start_tick, statement, self.plant.touching())
