"""A machine whose joints are positioned by pulses: where its tool is, and which joint values put it on a line.

The method needs forward and inverse kinematics and nothing else, so every mechanism is a ``Machine``: the robots of the
library (``RobotArm``) and mechanisms given by a few lengths (``mechanism``). A machine is immutable; its present joint
values are passed to it. Joint values are rad or m, points m.
"""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.linear import matmul
from runtime.motion.cartesian_planner import CartesianPlanner, PathCurve
from runtime.motion.commands import MoveLinear
from runtime.motion.velocity_profile import SpeedLimits
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """A joint: name, whether it turns, and its limits in rad or m, /s and /s2 (infinite: none stated)."""

    name: str
    rotary: bool
    lower: float
    upper: float
    speed: float = np.inf
    acceleration: float = np.inf


@dataclass(frozen=True, slots=True, kw_only=True)
class Stand:
    """Where a machine is: joint values q (M,), and the rotation R (3, 3) of its tool (None: not known yet)."""

    q: Array
    R: Array | None = None


class LineCurve(Protocol):
    """The curve of one straight move. ``limits`` of its path parameter, None where the tool is already there."""

    @property
    def limits(self) -> SpeedLimits | None:
        """Bounds of ds/dt for s from 0 to 1."""

    @property
    def length(self) -> float:
        """Length of the path of the tool point, m."""

    @property
    def ends(self) -> tuple[Array, Array]:
        """The tool point (3,) m at start and end."""

    def joints(self, s: Array) -> Array:
        """Return joint values (N, M) at path parameters s (N,); ``Fault`` RBL410, 411, 412 or 431."""


class Machine(Protocol):
    """Kinematics of a machine."""

    @property
    def name(self) -> str:
        """Its name in messages and tables."""

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Its joints in order."""

    @property
    def home(self) -> Stand:
        """Where it is when a program starts."""

    def placed(self, point: Array) -> "Machine":
        """Return the machine with coordinates that have no joint as they are at a program's first point (3,) m."""

    def curve(self, stand: Stand, command: MoveLinear) -> LineCurve:
        """Return the curve of a move from ``stand``; ``Fault`` where there is none."""

    def arrived(self, stand: Stand, command: MoveLinear, q: Array) -> Stand:
        """Return where the machine is when a move along its ``curve`` has ended at q (M,)."""

    def points(self, q: Array) -> Array:
        """Return the tool points (K, 3) m at joint values q (K, M)."""

    def described(self) -> dict[str, Any]:
        """Return all that a reader of the tables needs to know of the kinematics, as JSON (docs/pulses.md)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmCurve:
    """The curve of a robot arm, as the planner of a run chooses it: with its wrist changes."""

    planned: PathCurve
    ends: tuple[Array, Array]

    @property
    def limits(self) -> SpeedLimits | None:
        """Bounds of ds/dt."""
        return self.planned.limits

    @property
    def length(self) -> float:
        """Length of the path of the tool point, m."""
        return self.planned.path.length

    def joints(self, s: Array) -> Array:
        """Return q (N, n) rad at path parameters s (N,)."""
        return self.planned.joints(s)


class RobotArm:
    """A robot of the library with a tool; ``home`` (n,) rad, m of an axis that slides."""

    def __init__(self, spec: RobotSpec, profile: Profile, X_flange_tool: Array, home: Array) -> None:
        self._spec, self._profile, self._X_flange_tool = spec, profile, X_flange_tool
        self._kinematics = Kinematics(spec)
        # the planner of a run, so that tables and a run take the same curve, wrist changes and refusals included
        self._planner = CartesianPlanner(spec, self._kinematics, profile)
        self.name = spec.name
        self.home = Stand(q=frozen(home))
        self.joints = tuple(
            Joint(
                name=f"J{number}",
                rotary=not axis.kind.slides,
                lower=axis.limits.lower,
                upper=axis.limits.upper,
                speed=axis.limits.speed,
                acceleration=axis.limits.acceleration,
            )
            for number, axis in enumerate(spec.axes, start=1)
        )

    @property
    def kinematics(self) -> Kinematics:
        """The arm's kinematics, for placing taught points."""
        return self._kinematics

    def with_tool(self, X_flange_tool: Array) -> "RobotArm":
        """Return the same arm with another tool (4, 4)."""
        return RobotArm(self._spec, self._profile, X_flange_tool, self.home.q)

    def placed(self, point: Array) -> "RobotArm":
        """Return the arm itself: it has joints for every coordinate."""
        return self

    def curve(self, stand: Stand, command: MoveLinear) -> ArmCurve:
        """Return the curve that a run of this move would take; ``Fault`` RBL404, 410, 411, 412."""
        planned = self._planner.curve(stand.q, command, self._X_flange_tool)
        return ArmCurve(planned=planned, ends=(planned.path.X_start[:3, 3], planned.path.X_end[:3, 3]))

    def arrived(self, stand: Stand, command: MoveLinear, q: Array) -> Stand:
        """Return the stand at q (n,)."""
        return Stand(q=frozen(q))

    def points(self, q: Array) -> Array:
        """Return the tool points (K, 3) m."""
        return np.asarray(matmul(self._kinematics.forward(q), self._X_flange_tool)[..., :3, 3])

    def described(self) -> dict[str, Any]:
        """Return the chain of axes, by which a reader computes its own kinematics."""
        slides = [joint.name for joint in self.joints if not joint.rotary]
        return {
            "kind": "arm",
            "name": self.name,
            **({"slides": slides} if slides else {}),
            "placements": [axis.placement.tolist() for axis in self._spec.axes],
            "X_last_flange": self._spec.X_last_flange.tolist(),
            "X_flange_tool": self._X_flange_tool.tolist(),
        }
