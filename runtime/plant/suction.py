"""The pull of a suction cup: a force on the part that it seals on, and its reaction on the hand.

While the pump is on and the rim seals (``runtime.cell.sealing``), the pressure of the air pushes part and cup onto one
another by the holding force, along the axis of the cup and through the middle of its rim. All the rest is contact and
friction of cup and part, as with fingers: the part comes off when its weight and acceleration pull by more than the
force, slides when they shear by more than friction times what presses, and tips off when their moment is larger than
that of the force about the rim. MuJoCo's adhesion actuator was rejected: it pulls through whatever contacts there are,
so that a part which hangs by one corner of the rim is held like one that seals.
"""

from collections.abc import Sequence

import numpy as np

from runtime.cell.cell import CellSpec
from runtime.cell.sealing import seals
from runtime.core.frames import Array, pose
from runtime.plant.touches import Bodies


class Suction:
    """The cup of a cell; what it holds now is read from the forces that it has written."""

    def __init__(self, cell: CellSpec, bodies: Bodies, forces: Array, hand: int, centres: Array) -> None:
        """``forces`` (bodies, 6) N, N m on the centres of gravity in the world, those of the parts last.

        ``hand`` is the body of the hand, ``centres`` (bodies, 3) m are these centres, live.
        """
        self._cell, self._bodies, parts = cell, bodies, len(forces) - len(cell.parts)
        self._on_hand, self._on_parts = forces[hand], forces[parts:]
        self._hand, self._parts = centres[hand], centres[parts:]

    def pull(self, closed: bool) -> None:
        """Write the forces of the tick to come, for the poses of now."""
        # every tick anew, also of a part that is held: what has slid half off the rim is let go at once
        held = self._sealed() if closed else None
        self._on_parts[:] = 0.0
        self._on_hand[:] = 0.0
        if held is None:
            return
        bodies = self._bodies
        force = -self._cell.hand.grip_force * bodies.R_tool[:, 2]
        self._on_parts[held, :3], self._on_hand[:3] = force, -force
        # moments about the centres of gravity, at which MuJoCo applies what is written here
        self._on_parts[held, 3:] = np.cross(bodies.p_tool - self._parts[held], force)
        self._on_hand[3:] = np.cross(bodies.p_tool - self._hand, -force)

    def held(self) -> Sequence[str]:
        """Return the part that is pulled, if any."""
        # from the forces and not from a field of its own: they are part of the state that a snapshot holds
        return [self._bodies.names[k] for k in np.flatnonzero(self._on_parts.any(axis=1)).tolist()]

    def _sealed(self) -> int | None:
        bodies = self._bodies
        X_world_tool = pose(bodies.p_tool, bodies.R_tool)
        for k, part in enumerate(self._cell.parts):
            if seals(self._cell.hand, X_world_tool, part, pose(bodies.p[k], bodies.R[k])):
                return k
        return None
