"""The moves E1, E2 and E3 of docs/wrist.md, carried out as the document does: constant speed, no acceleration limit."""

from dataclasses import dataclass, replace

import numpy as np

from runtime.core.frames import Array, inverse, pose, rotation_angles
from runtime.motion.path import LinePath
from runtime.motion.wrist.switch import PathTiming, Trigger, WristLimits, first_trigger, law_from
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.frozen_wrist import FrozenWrist
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.settings.profile import PostureLaw, WristOptions

SPEC = load_builtin("irb2400")
KINEMATICS = Kinematics(SPEC)
TOOL = pose((0.0, 0.0, 0.2))
FROZEN = FrozenWrist(KINEMATICS, TOOL)
SECONDS = 4.0

E1 = (-20, 10, 30, 10, 65, -15), (0, -10, 45, -55, -65, 85)
E2 = (15, 20, 10, -70, -10, 5), (25, 15, 0, -45, 10, 35)
E3 = (0, -10, -20, 55, 10, 85), (-15, -10, 0, 30, -10, 50)

NOTHING = WristOptions(look_ahead=0, shape="linear").only()
C1_ANY = replace(NOTHING, speed_condition="any")
C1_ALL = replace(NOTHING, speed_condition="all")
C3 = replace(NOTHING, range_condition=True)
C4 = replace(NOTHING, deviation_condition="moving")
C6 = replace(NOTHING, guard=True)


@dataclass(frozen=True, kw_only=True)
class Done:
    """A move: joint angles (N + 1, n) deg, poses planned and taken, the trigger, the sample of the switch."""

    q_deg: Array
    planned: Array
    taken: Array
    dt: float
    trigger: Trigger | None

    @property
    def switch(self) -> int:
        return len(self.q_deg) - 1 if self.trigger is None else self.trigger.index - 1

    def speed(self, axes: slice, first: int = 0) -> Array:
        """Largest speed of each axis from sample ``first`` on, deg/s."""
        return np.abs(np.diff(self.q_deg[first:, axes], axis=0)).max(axis=0) / self.dt

    @property
    def off_line_mm(self) -> float:
        return 1e3 * float(np.linalg.norm((self.taken - self.planned)[:, :3, 3], axis=1).max())

    @property
    def tool_speed_mm_s(self) -> Array:
        return 1e3 * np.linalg.norm(np.diff(self.taken[:, :3, 3], axis=0), axis=1) / self.dt

    @property
    def posture_deg(self) -> float:
        return float(np.degrees(rotation_angles(self.planned[:, :3, :3], self.taken[:, :3, :3]).max()))


def path_of(move, posture: PostureLaw = "rpy") -> LinePath:
    start, end = (KINEMATICS.forward(np.radians(q)) @ TOOL for q in move)
    return LinePath.between(start, end, posture)


def conventional(move, s: Array, path: LinePath) -> Array:
    q_start = np.radians(move[0])
    q = KINEMATICS.inverse_branch(path.poses(s) @ inverse(TOOL), KINEMATICS.branch_of(q_start), q_start)
    q = np.unwrap(q, axis=0)
    q[0] = q_start
    return q


def carry_out(
    move, options: WristOptions, speed_deg_s, *, dt: float = 0.01, posture: PostureLaw = "rpy", range_deg: float = 180.0
) -> Done:
    """Carry a move out by the flow chart S1 to S12."""
    path, s = path_of(move, posture), np.linspace(0.0, 1.0, round(SECONDS / dt) + 1)
    q, q_end = conventional(move, s, path), np.radians(move[1])
    reach = np.radians(range_deg) * np.ones(3)
    limits = WristLimits(speed=np.radians(np.broadcast_to(speed_deg_s, 3)), lower=-reach, upper=reach)
    trigger = first_trigger(q, q_end, PathTiming(s=s, period_s=dt, length=path.length), limits, options)
    if trigger is not None:
        k = trigger.index - 1
        law = law_from(q, s, k, q_end[3:], options.shape, options.width)
        rest = FROZEN.solve(path.points(s[k + 1 :]), law.angles(s[k + 1 :]), q[k], FROZEN.side_of(q[k]))
        q = np.concatenate([q[: k + 1], rest])
    return Done(q_deg=np.degrees(q), planned=path.poses(s), taken=KINEMATICS.forward(q) @ TOOL, dt=dt, trigger=trigger)
