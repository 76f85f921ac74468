"""Back to where a program was interrupted: how far the arm is from there, and the slow motion that returns.

A motion that rests on its path is resumed only there, on the very rows of its plan. The arm returns with all joints
together, on the shortest path of the joints, which no program has planned: so it is slow, and refused from afar.
"""

from dataclasses import dataclass

import numpy as np

from robolang.execution.target import Target
from robolang.execution.world import RobotWorld
from runtime.core.faults import Fault
from runtime.core.frames import Array, rotation_angle
from runtime.core.units import DEG, MM
from runtime.motion.commands import MoveJoint

SLOW = 0.1
"""Share of the speed of the joints."""
MOST_M_S = 0.25
"""Fastest that the tool point or the flange returns: as in manual operation (ISO 10218-1)."""
AT_REST = 1e-9
"""Difference of joint angles, rad, within which the arm is where it was."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Displaced:
    """How far the arm is from where its path was left: of the tool point mm and deg, of the joints the largest deg,
    a mm of one that slides counted as a deg; ``unit`` is that of the joint."""

    distance_mm: float = 0.0
    angle_deg: float = 0.0
    joint_deg: float = 0.0
    unit: str = "deg"

    @property
    def is_away(self) -> bool:
        """Whether the arm is elsewhere."""
        return not self.joint_deg * DEG <= AT_REST

    def __str__(self) -> str:
        return f"{self.distance_mm:.1f} mm, {self.angle_deg:.1f} deg and {self.joint_deg:.1f} {self.unit} in a joint"


@dataclass(frozen=True, slots=True, kw_only=True)
class RegainLimits:
    """The farthest that the arm returns by itself."""

    distance_mm: float = 50.0
    joint_deg: float = 10.0


DEFAULT_LIMITS = RegainLimits()


def displacement(world: RobotWorld, q_left: Array, q: Array) -> Displaced:
    """Return how far joint angles q (n,) rad are from q_left (n,)."""
    X_left, X = world.tool_pose(q_left), world.tool_pose(q)
    robot = world.around.cell.robot
    off = np.abs(q - q_left) / robot.units
    return Displaced(
        distance_mm=float(np.linalg.norm(X[:3, 3] - X_left[:3, 3])) / MM,
        angle_deg=rotation_angle(X_left[:3, :3], X[:3, :3]) / DEG,
        joint_deg=float(off.max()),
        unit=robot.axes[int(np.argmax(off))].kind.unit,
    )


def refuse_beyond(limits: RegainLimits, far: Displaced, where: str) -> None:
    """Refuse to return from so far away of ``where`` something was; ``Fault`` RBL541."""
    if not (far.distance_mm <= limits.distance_mm and far.joint_deg <= limits.joint_deg):
        raise Fault(
            "RBL541",
            f"the arm is {far} away from where {where}, more than {limits.distance_mm:g} mm or "
            f"{limits.joint_deg:g} {far.unit} in a joint",
        )


def returning(target: Target, q_left: Array, period_s: float) -> Array:
    """Return the set-points (K, n) rad, ``period_s`` s apart, that bring the arm back to q_left; ``Fault`` RBL4xx."""
    share = SLOW
    while True:
        command = MoveJoint(q_end=q_left, X_world_tool=target.world.tool_pose(q_left), speed=share, acceleration=SLOW)
        q = target.rehearse(target.q, command).q
        fastest = _fastest(target.world, q) / period_s
        if not fastest > MOST_M_S:
            rows = np.array(q[1:])
            rows[-1] = q_left  # to the bit: the path goes on from there
            return rows
        # a tenth below: the speed of the tool point is not quite proportional to that of the joints
        share *= 0.9 * MOST_M_S / fastest


def _fastest(world: RobotWorld, q: Array) -> float:
    """Return the longest step of the tool point or the flange between rows (K, n), m."""
    places = np.stack([world.tool_pose(q)[:, :3, 3], world.flange_pose(q)[:, :3, 3]])
    return float(np.linalg.norm(np.diff(places, axis=1), axis=2).max(initial=0.0))
