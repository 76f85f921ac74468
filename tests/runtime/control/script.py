"""A script of requests for one controller, with a part in the hand and a seam, that can be taken back with it.

Each step is a request and the number of cycles that it takes at least; the next one is made when the command rests. The
script knows which step comes next and since which cycle the last one runs: two integers, its own snapshot.
"""

import dataclasses

import numpy as np

from robolang.project.project import builtin_cell
from runtime.cell.seam_sensor import SeamSensor, SensorSpec
from runtime.cell.sensor_file import SensorFile
from runtime.control.controller import Controller
from runtime.core.frames import pose_from_xyzrpy
from runtime.core.program_line import ProgramLine
from runtime.motion.commands import MoveJoint, MoveLinear
from runtime.motion.seam import SeamTracker
from runtime.plant.rigid_plant import RigidPlant
from runtime.robot.model.payload import Payload
from runtime.settings.profile import Profile, ServoOptions
from tests.runtime.recorded import rows_of

CELL = builtin_cell()
EMPTY = Payload(mass=CELL.hand.mass, cog=CELL.hand.cog)
FULL = Payload(mass=2.3, cog=np.array([0.0, 0.0, 0.095]))
SENSOR = SensorSpec.of(
    SensorFile(
        kind="sine",
        deviation=(0.0, 1.0, 2.0, 0.0, 0.0, 0.5),
        over_mm=60.0,
        rows=(),
        noise=(0.05, 0.05, 0.05, 0.01, 0.01, 0.01),
        lost=0.1,
        seed=5,
        in_line_frame=True,
        filter_ms=40.0,
        most_mm=20.0,
        most_deg=10.0,
        lost_ms=100.0,
    )
)
PLANTS = ("rigid", "mujoco")


def controller(plant: str, **settings: object) -> Controller:
    """Return a new controller of the built-in cell at its home."""
    profile = Profile(**settings)
    if plant == "rigid":
        profile = dataclasses.replace(profile, servo=ServoOptions(friction_compensation=0.0))
        return Controller(CELL.robot, RigidPlant(CELL.robot, CELL, profile.tick_s), profile, CELL.hand.X_flange_tool)
    from runtime.plant.mujoco_plant import MujocoPlant

    return Controller(CELL.robot, MujocoPlant(CELL.robot, CELL, profile.tick_s), profile, CELL.hand.X_flange_tool)


def at(x: float, y: float, z: float, speed: float = 0.3, zone: float = 0.0) -> MoveLinear:
    """A straight move to a place in mm, the tool pointing down."""
    X = pose_from_xyzrpy([x / 1e3, y / 1e3, z / 1e3, np.pi, 0.0, np.pi])
    return MoveLinear(X_world_tool=X, speed=speed, zone=zone)


def go(*commands):
    def request(robot: Controller, line: int) -> None:
        robot.move_chain(commands, [ProgramLine(line=line + k, number=10) for k in range(len(commands))])

    return request


def call(name, *arguments):
    def request(robot: Controller, line: int) -> None:
        robot.statement = ProgramLine(line=line, number=20)
        getattr(robot, name)(*arguments)

    return request


def seam(on: bool):
    def request(robot: Controller, line: int) -> None:
        robot.seam(SeamTracker("torch", SENSOR.limits, 8e-3, SeamSensor(SENSOR).read) if on else None)

    return request


def swing(robot: Controller, line: int) -> None:
    k = np.arange(1, 61)[:, None] / 60
    robot.play(robot.areas.ina + 0.1 * np.sin(np.pi * k) ** 4 * np.array([0.0, 0.0, 0.0, 1.0, -1.0, 1.0]))


def stop(robot: Controller, line: int) -> None:
    """A move, and 20 cycles later the stop of it, in the middle of its way."""
    go(at(480, -100, 840, speed=0.5))(robot, line)


STEPS = [
    (call("load", EMPTY), 0),
    (go(at(480, -220, 740, zone=0.03), at(480, -220, 640, speed=0.2)), 20),
    (call("hand", True), 40),
    (call("load", FULL), 0),
    (go(at(480, -220, 740, zone=0.04), at(480, -120, 740, zone=0.04), at(480, -120, 840)), 0),
    (seam(True), 0),
    (go(at(480, -180, 840, speed=0.15), at(540, -180, 840, speed=0.15)), 0),
    (seam(False), 0),
    (swing, 0),
    (go(MoveJoint(X_world_tool=at(480, -220, 740).X_world_tool, speed=0.5)), 0),
    (go(at(480, -220, 641, speed=0.1)), 10),
    (call("hand", False), 40),
    (call("load", EMPTY), 0),
    (stop, 0),
    (call("acknowledge"), 0),
    (go(at(480, -220, 700)), 10),
]
STOPPED = 13
"""The step in whose middle the arm is stopped."""


class Script:
    """Makes the requests of ``STEPS`` in order; ``state`` is (next step, cycle of the last one, whether it stopped)."""

    def __init__(self, robot: Controller) -> None:
        self.robot = robot
        self.state = (0, 0, False)

    @property
    def over(self) -> bool:
        return self.state[0] == len(STEPS) and self._rests()

    def cycle(self) -> bool:
        """Make the requests that are due and run one cycle; False when the script is over."""
        robot, step = self.robot, self.state[0]
        cycle = robot.recorder.cycle
        if step == STOPPED + 1 and not self.state[2] and cycle - self.state[1] == 20:
            robot.alarm("RBL530", "stopped by the script")
            self.state = (*self.state[:2], True)
        while self._rests():
            if step == len(STEPS):
                return False
            request, _ = STEPS[step]
            request(robot, step + 1)
            step += 1
            self.state = (step, cycle, self.state[2])
        robot.cycle()
        return True

    def _rests(self) -> bool:
        step, since, stopped = self.state
        if step == STOPPED + 1 and not (stopped and self.robot.halted):
            return False
        least = STEPS[step - 1][1] if step else 0
        return not self.robot.moving and self.robot.recorder.cycle - since >= least

    def run(self, cycles: int) -> None:
        for _ in range(cycles):
            if not self.cycle():
                return

    def finish(self) -> None:
        while self.cycle():
            pass


def log_of(robot: Controller) -> dict[str, bytes]:
    """Return all that is recorded as bytes."""
    return rows_of(robot.recorder)


def outcome(robot: Controller) -> tuple[object, ...]:
    """Return what else a run leaves behind: alarms, warnings, parts, hand, touches."""
    touches = [] if robot.touches is None else robot.touches.records
    parts = {name: X.tobytes() for name, X in robot.plant.parts().items()}
    return (robot.alarms, robot.warnings, parts, robot.plant.hand(), touches, robot.statement)
