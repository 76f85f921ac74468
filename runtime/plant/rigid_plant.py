"""The ideal arm: rigid links and rotors, no friction, no contacts, nothing between torque and motion.

    (M(q) + N^2 J) ddq = tau - h(q, dq)            integrated by semi-implicit Euler, one tick at a time

Gears are rigid too, also where the robot file gives a spring: ``q_link`` is ``q``. It runs in place of MuJoCo
(``--no-physics``) and in tests of the control loop. Its hand is exact: closing it takes the part whose centre is within
``REACH`` of the tool point, or a cup the part that it seals on, however heavy it is, and the arm then carries that
part's true mass; opening it leaves the part there.
"""

from typing import ClassVar

import numpy as np

from runtime.cell.cell import CellSpec
from runtime.cell.sealing import seals
from runtime.core.frames import Array, inverse, quaternion
from runtime.core.linear import matmul, norm
from runtime.core.state import Stateful
from runtime.plant.plant import HandState
from runtime.plant.touches import Pair
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec

REACH = 0.01
"""Largest distance of a part's centre from the tool point at which the hand takes it, m."""


class RigidPlant(Stateful):
    """Plant without physics engine; see ``Plant`` for the meaning of each method."""

    BUFFERS = ("q", "dq")
    VALUES: ClassVar[tuple[str, ...]] = ("_parts", "_closed", "_holding", "_X_tool_part")
    PARTS = ("_model",)
    bodies = None

    def __init__(self, spec: RobotSpec, cell: CellSpec, tick_s: float = 1e-3) -> None:
        self.tick_s = tick_s
        self.q = np.array(cell.home, dtype=np.float64)
        self.dq = np.zeros(spec.n)
        self.q_link = self.q
        self._spec = spec
        self._cell = cell
        # a model of its own: that of the controller carries what LOAD declared, this one what really hangs there
        self._model = ArmModel(spec, rotors=spec_rotors(spec))
        self._parts = {part.name: np.array(part.X_world_part) for part in cell.parts}
        self._closed = False
        self._holding: str | None = None
        self._X_tool_part = np.eye(4)
        self._carry()

    def step(self, tau: Array) -> bool:
        """Advance one tick under joint torques tau (n,)."""
        ddq = self._model.acceleration(self.q, self.dq, tau)
        # speed first, and the angle with the new speed (semi-implicit): explicit Euler would add energy in every swing
        dq = self.dq + self.tick_s * ddq
        if not np.isfinite(dq).all():
            return False
        self.dq[:] = dq  # in place: servo, recorder and controller hold these arrays
        self.q += self.tick_s * dq
        return True

    def why_invalid(self) -> str:
        """Return why the last step was refused."""
        return "" if np.isfinite(self.dq).all() and np.isfinite(self.q).all() else "a joint speed is not finite"

    def close_hand(self, closed: bool) -> None:
        """Take or leave a part at once."""
        if closed and not self._closed:
            self._take()
        if not closed and self._holding is not None:
            # it stays in the air: nothing falls without physics
            self._parts[self._holding] = matmul(self._X_world_tool(), self._X_tool_part)
            self._holding = None
        self._closed = closed
        self._carry()

    def hand(self) -> HandState:
        """Return the state of the hand."""
        return HandState(
            closed=self._closed, opening=0.0 if self._closed else self._cell.hand.stroke, holding=self._holding
        )

    def parts(self) -> dict[str, Array]:
        """Return the pose X_world_part (4, 4) of every part."""
        poses = dict(self._parts)
        if self._holding is not None:
            poses[self._holding] = matmul(self._X_world_tool(), self._X_tool_part)
        return poses

    def moved(self) -> Array:
        """Return pose of each part and distance of each pad, as ``Plant.moved``."""
        poses = [np.concatenate([X[:3, 3], quaternion(X[:3, :3])]) for X in self.parts().values()]
        return np.concatenate([*poses, np.full(2, self.hand().opening / 2.0)])

    def touching(self) -> frozenset[Pair]:
        """Return nothing: there are no contacts."""
        return frozenset()

    def gripped(self) -> tuple[str, ...]:
        """Return the part that the hand holds."""
        return () if self._holding is None else (self._holding,)

    def _X_world_tool(self) -> Array:
        return np.asarray(matmul(self._model.flange(self.q), self._cell.hand.X_flange_tool))

    def _take(self) -> None:
        X_tool_world = inverse(self._X_world_tool())
        for name, X_world_part in self._parts.items():
            X_tool_part = matmul(X_tool_world, X_world_part)
            if self._takes(name, X_tool_part):
                self._holding, self._X_tool_part = name, X_tool_part
                return

    def _takes(self, name: str, X_tool_part: Array) -> bool:
        hand = self._cell.hand
        # not by the centre of the part: the rim is on its surface, however large the part is
        if hand.is_cup:
            part = next(part for part in self._cell.parts if part.name == name)
            return seals(hand, np.eye(4), part, X_tool_part)
        return norm(X_tool_part[:3, 3]) <= REACH

    def _carry(self) -> None:
        """Give the arm the true mass of the hand and of what it holds."""
        hand = self._cell.hand
        mass, moment = hand.mass, hand.mass * np.asarray(hand.cog)
        for part in self._cell.parts:
            if part.name == self._holding:
                # the centre of gravity of a mesh is not in the middle of its box
                X = matmul(hand.X_flange_tool, self._X_tool_part)
                centre = X[:3, 3] + matmul(X[:3, :3], part.cog)
                mass, moment = mass + part.mass, moment + part.mass * centre
        self._model.set_payload(Payload(mass=mass, cog=moment / mass if mass else np.zeros(3)))
