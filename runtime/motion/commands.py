"""Motion requests as the controller takes them: SI, frozen, complete.

Four kinds: straight (``MoveLinear``), on an arc (``MoveArc``), on a curve through points (``MoveSpline``), all joints
together (``MoveJoint``). All have:
``duration`` s from start to stop (None: as fast as speed and limits allow); ``zone`` m, the radius about its end within
which it may go over into the next move (``runtime.motion.chain.corner``), 0: it stops there; ``q_end`` (n,) rad,
the taught joint angles of the end, turns and all; None where only its pose is taught, then with the words of
``configuration`` and the ``turns`` of the joints that the point names. What the robot cannot do is refused by the
planner (RBL4xx); a zone or an override out of range, and a joint move without an end, are misuse and raise
``ValueError``.
"""

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

from runtime.core.frames import Array
from runtime.robot.kinematics.opw import Branch

Component = Literal["TILT", "ADVANCE", "ROTATION"]
"""The tool's posture: about the direction of travel, across it and upright (``runtime.motion.wrist.hold``)."""

MAX = math.inf
"""The ``acceleration`` of a move that the limits of the joints alone bound."""

Wrist = Literal["auto", "keep"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """The options of every move. ``acceleration`` is a share of the robot's in (0, 1], or ``MAX``.

    ``speed`` None is that of the robot. ``override`` in (0, 1] is a share of every speed, those of the limits included
    (``runtime.motion.cartesian_planner``).
    """

    speed: float | None = None
    acceleration: float = 1.0
    duration: float | None = None
    q_end: Array | None = None
    configuration: tuple[str, ...] = ()
    turns: tuple[int, ...] = ()
    zone: float = 0.0
    override: float = 1.0

    @property
    def robot_share(self) -> float:
        """The share of the robot's accelerations: all of them under ``MAX``."""
        return 1.0 if self.acceleration == MAX else self.acceleration

    def __post_init__(self) -> None:
        # SPEED, ACCEL and TIME come from programs and are refused with their place (``limits``); these two are
        # set by our own code, so a bad one is a mistake there
        if not (0.0 < self.override <= 1.0):
            raise ValueError(f"an override of {self.override} is not a share in (0, 1]")
        if not (0.0 <= self.zone < math.inf):
            raise ValueError(f"a zone of {self.zone} m is not a radius")


@dataclass(frozen=True, slots=True, kw_only=True)
class PathMotion(Motion):
    """A move whose tool point has a path of its own; ``speed`` in m/s along it.

    ``wrist`` (None: as the profile says): ``auto`` may leave the posture of the path to end as taught, ``keep`` never
    does, and keeps the sign of J5. ``held`` components of the posture change as little as they can while it is left.
    """

    wrist: Wrist | None = None
    held: tuple[Component, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveLinear(PathMotion):
    """Move the tool point straight to ``X_world_tool`` (4, 4), orientation about one axis (JPH06190750A Fig 6).

    ``tracked``: a seam sensor will shift the path while it runs, so once the wrist has left its posture it does not
    return to it before the end.
    """

    X_world_tool: Array
    tracked: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveArc(PathMotion):
    """Move the tool point on a circle over the place of ``X_via`` (4, 4) to ``X_world_tool`` (4, 4).

    The orientation turns about one axis from that of the start to that of the end, in proportion to the length along
    the arc; *that of the via point is not used*. ``held`` components are counted from the tangent.
    """

    X_via: Array
    X_world_tool: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveSpline(PathMotion):
    """Move the tool on a curve of continuous curvature through poses ``X_through`` (4, 4) to ``X_world_tool`` (4, 4).

    It passes place and orientation of each (``runtime.motion.spline_path``). ``held`` as of ``MoveArc``.
    """

    X_through: tuple[Array, ...]
    X_world_tool: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveJoint(Motion):
    """Turn all joints together to ``q_end`` (n,) rad, each in proportion to its turn; the tool follows no given path.

    Where ``q_end`` is None, to the solution of ``X_world_tool`` (4, 4) that fits ``configuration`` and ``turns``, keeps
    the rest of the arm's configuration where possible, and is reached first. ``speed`` and ``acceleration`` are
    shares of the joints' limits in (0, 1] (``speed`` None: 1).
    """

    X_world_tool: Array | None = None

    def __post_init__(self) -> None:
        Motion.__post_init__(self)
        if self.q_end is None and self.X_world_tool is None:
            raise ValueError("a joint move needs joint angles or a pose to go to")


PathMove: TypeAlias = MoveLinear | MoveArc | MoveSpline
"""A move whose tool point has a path of its own."""

Command: TypeAlias = PathMove | MoveJoint


def in_configuration(branch: Branch, words: tuple[str, ...]) -> bool:
    """Return whether a branch has all the configuration words of a taught point, such as LEFTY; it may have none."""
    return set(words) <= set(str(branch).split())
