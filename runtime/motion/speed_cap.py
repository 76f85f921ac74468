"""The cap on the speed of the arm in MANUAL: neither tool point nor flange passes it, at any servo tick.

A planned move under a cap takes the override at which it keeps below (``MotionPlanner.plan``); what is refused stays
what is refused at full speed. Gear springs let the arm swing about its command, the more the faster it gains speed: so
a move takes ``GAINED_S`` at least to gain the cap, and commands keep to ``PLANNED`` of it. What is left is for the
swing of the links (docs/decisions/0044).

With J the Jacobian of the flange and r the place of the tool point in its frame, turned into the base frame:

    v_flange = J_v dq,    v_tool = J_v dq + (J_w dq) x r

Called before anything moves; m, rad, s.
"""

from dataclasses import dataclass

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.linear import cross, matmul
from runtime.core.rounding import beside
from runtime.core.units import MM
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.robot.kinematics.kinematics import Kinematics

MANUAL_SPEED = 0.25
"""Cap of MANUAL, m/s: the reduced speed of ISO 10218-1, for tool point and flange."""

PLANNED = 0.95
"""Share of a cap that commands keep to."""

GAINED_S = 0.25
"""Time in which a move under a cap gains it, at least, s."""

POINTS = ("tool point", "flange")
"""What is held to a cap, in the order of ``speeds``."""

_SLACK = 1.0 + 1e-9
"""A cap is kept when it is passed by no more than rounding."""


def speeds(kinematics: Kinematics, q: Array, dq: Array, X_flange_tool: Array) -> Array:
    """Return the speeds (2, N) m/s of tool point and flange at joint angles q (N, n) and joint speeds dq (N, n)."""
    # the flange carries the Jacobian; the tool point adds only its lever, so one set of frames serves both
    J, R = kinematics.jacobian_and_rotation(q)
    twist = matmul(J, dq[..., None])[..., 0]
    lever = matmul(R, X_flange_tool[:3, 3])
    tool = twist[..., :3] + cross(twist[..., 3:], lever)
    return np.asarray(np.sqrt(np.stack([(tool**2).sum(axis=-1), (twist[..., :3] ** 2).sum(axis=-1)])))


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedCap:
    """A cap of ``most`` m/s on ``X_flange_tool`` (4, 4) and flange of one arm, as ``fine`` plays its rows."""

    most: float
    kinematics: Kinematics
    fine: FineInterpolator
    X_flange_tool: Array

    def ratio(self, motion: Array) -> float:
        """Return the largest speed of a motion (3, ticks, n), as ``FineInterpolator`` gives it, over the planned one.

        Up to 1 the cap is kept.
        """
        fastest = speeds(self.kinematics, motion[0], motion[1], self.X_flange_tool)
        return float(fastest.max()) / (self.most * PLANNED)

    def easing(self, motion: Array) -> float:
        """Return the share, up to 1, of the joint accelerations of a motion (3, ticks, n) that gains the cap slowly."""
        return self.gaining(float(speeds(self.kinematics, motion[0], motion[2], self.X_flange_tool).max()))

    @property
    def gained(self) -> float:
        """The acceleration that gains the cap slowly, m/s2."""
        return self.most / GAINED_S

    def gaining(self, acceleration: float) -> float:
        """Return the share, up to 1, of an acceleration, m/s2, that gains the cap slowly."""
        return self.gained / acceleration if not acceleration <= self.gained else 1.0

    def kept(self, motion: Array) -> bool:
        """Return whether a motion (3, ticks, n) keeps to the planned share of the cap."""
        return self.ratio(motion) <= _SLACK

    def check(self, motion: Array) -> None:
        """Refuse a motion (3, ticks, n) that does not keep to the planned share of the cap; ``Fault`` RBL404."""
        fastest = speeds(self.kinematics, motion[0], motion[1], self.X_flange_tool).max(axis=1)
        worst = int(np.argmax(fastest))
        if not fastest[worst] <= self.most * PLANNED * _SLACK:
            speed, most = beside(fastest[worst] / MM, self.most * PLANNED / MM, form=".1f")
            raise Fault(
                "RBL404",
                f"the {POINTS[worst]} would move at {speed} mm/s and may move at {most} mm/s in MANUAL",
                "Send slower set-points, or switch to AUTO.",
            )
