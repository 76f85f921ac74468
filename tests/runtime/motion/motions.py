"""Robots, random moves in a row, and what a sequence of set-points shows when it is looked at without the planner."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from runtime.core.faults import Fault
from runtime.core.frames import Array, pose, rotation_about
from runtime.motion.commands import Command, MoveArc, MoveJoint, MoveLinear
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.motion_planner import ChainPlan, MotionPlanner, Part
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

ROBOTS = ("puma560", "irb2400", "manutec_r3")
TOOL = pose((0.0, 0.0, 0.12))
ON_PATH = 1e-6
"""A tool point nearer to its path, m, is on it."""


@dataclass(frozen=True, kw_only=True)
class Bench:
    """A robot with its planner."""

    spec: RobotSpec
    kinematics: Kinematics
    profile: Profile
    planner: MotionPlanner

    @property
    def speed(self) -> Array:
        return self.spec.per_axis("limits", "speed")

    @property
    def acceleration(self) -> Array:
        return self.spec.per_axis("limits", "acceleration")

    def tool(self, q: Array) -> Array:
        return self.kinematics.forward(q) @ TOOL

    def home(self) -> Array:
        """A posture from which lines of some 200 mm lead anywhere, the tool in front of the arm, the wrist bent."""
        q = 0.5 * (self.spec.lower + self.spec.upper)
        q[1:] = np.radians(
            {
                "puma560": [70.0, -180.0, 20.0, 60.0, 10.0],
                "irb2400": [10.0, 20.0, 20.0, 60.0, 10.0],
                "manutec_r3": [50.0, -80.0, 20.0, 60.0, 10.0],
            }[self.spec.name]
        )
        return q

    def at_the_servo(self, q: Array) -> Array:
        """Return (3, ticks, n) as the running interpolator plays rows (N + 1, n): pushed one by one."""
        fine = FineInterpolator(self.profile.ticks_per_cycle, self.profile.period_s, q[0])
        return np.concatenate([fine.push(row) for row in [*q, q[-1], q[-1], q[-1]]], axis=1)


@cache
def bench(name: str, shape: str = "jerk") -> Bench:
    spec, profile = load_builtin(name), Profile(speed_shape=shape)
    kinematics = Kinematics(spec)
    return Bench(spec=spec, kinematics=kinematics, profile=profile, planner=MotionPlanner(spec, kinematics, profile))


def random_move(robot: Bench, q: Array, random: np.random.Generator, kind: str) -> Command:
    """Return a move from joint angles q (n,) to somewhere near, at any speed; not every one can be planned."""
    X = robot.tool(q)
    way = random.normal(size=3)
    way *= random.uniform(0.03, 0.3) / np.linalg.norm(way)
    axis = random.normal(size=3)
    end = pose(X[:3, 3] + way, rotation_about(axis / np.linalg.norm(axis), random.uniform(0.0, 0.6)) @ X[:3, :3])
    speed, acceleration = random.uniform(0.05, 1.0), random.uniform(0.3, 1.0)
    zone = random.uniform(0.002, 0.1) if random.random() < 0.85 else 0.0
    options = {"speed": speed, "acceleration": acceleration, "zone": zone}
    if kind == "line":
        return MoveLinear(X_world_tool=end, **options)
    if kind == "joint":
        return MoveJoint(X_world_tool=end, **options)
    via = pose(X[:3, 3] + way * random.uniform(0.2, 0.8) + random.normal(size=3) * 0.05)
    return MoveArc(X_via=via, X_world_tool=end, **options)


def random_chain(robot: Bench, random: np.random.Generator, moves: int) -> tuple[Array, list[Command]]:
    """Return start and moves of a chain that can be planned; kinds, speeds and zones mixed."""
    lower, upper = robot.spec.lower, robot.spec.upper
    while True:
        start = lower + (upper - lower) * random.uniform(0.3, 0.7, robot.spec.n)
        start[4] = random.choice([-1.0, 1.0]) * random.uniform(0.5, 1.2)
        if robot.tool(start)[2, 3] > 0.2:
            break
    q, commands = start, []
    while len(commands) < moves:
        command = random_move(robot, q, random, random.choice(["line", "arc", "joint"]))
        try:
            q = robot.planner.plan(q, command, TOOL).q[-1]
        except Fault:
            continue
        commands.append(command)
    return start, commands


def limits_broken(robot: Bench, q: Array, override: float = 1.0) -> list[str]:
    """Return what set-points (N + 1, n) break at the servo: as fine interpolation says, and by differences.

    Differences over a tick see a little of what lies between two ticks.
    """
    played, dq, ddq = robot.at_the_servo(q)
    dt = robot.profile.tick_s
    v, a = robot.speed * override, robot.acceleration
    checks = {
        "range": ((played >= robot.spec.lower - 1e-8) & (played <= robot.spec.upper + 1e-8)).all(),
        "speed": (np.abs(dq) <= v * (1 + 1e-9)).all(),
        "acceleration": (np.abs(ddq) <= a * (1 + 1e-9)).all(),
        "speed by differences": (np.abs(np.diff(played, axis=0)) / dt <= v * (1 + 1e-7)).all(),
        "acceleration by differences": (np.abs(np.diff(played, 2, axis=0)) / dt**2 <= a * (1 + 1e-7)).all(),
        "rest at both ends": np.abs(dq[[0, -1]]).max() < 1e-9,
    }
    return [name for name, good in checks.items() if not good]


def off_path(robot: Bench, chain: ChainPlan, part: Part, index: int) -> tuple[NDArray[np.intp], Array]:
    """Return rows of a part whose tool point is off its own path, and these points (K, 3)."""
    rows = np.flatnonzero(chain.command == index)
    points = robot.tool(chain.q[rows])[:, :3, 3]
    if part.path is not None:
        off = part.path.deviation(points)
    else:
        start, turn = part.plan.q[0], part.plan.q[-1] - part.plan.q[0]
        share = np.clip((chain.q[rows] - start) @ turn / (turn @ turn), 0.0, 1.0)
        off = np.linalg.norm(points - robot.tool(start + share[:, None] * turn)[:, :3, 3], axis=1)
    return rows[off > ON_PATH], points[off > ON_PATH]


def blends_broken(robot: Bench, chain: ChainPlan, commands: list[Command]) -> list[str]:
    """Return what the blends of a chain do wrong: a path left outside the zones, a row that belongs nowhere."""
    wrong = []
    for index, part in enumerate(chain.parts):
        _, points = off_path(robot, chain, part, index)
        inside = np.zeros(len(points), dtype=bool)
        for at in (index - 1, index):  # the corners before and behind it
            if 0 <= at < len(chain.corners):
                corner = robot.tool(chain.parts[at].plan.q[-1])[:3, 3]
                inside |= np.linalg.norm(points - corner, axis=1) <= commands[at].zone
        if not inside.all():
            wrong.append(f"path of move {index} left outside the zone")
    return wrong
