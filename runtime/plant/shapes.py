"""The shapes of arm, hand, parts and obstacles in given postures: what meets, and the distances between them.

No physics and no time: a posture is written into the model and MuJoCo computes poses and distances from it alone.
The links of an elastic arm stand at the set-points, without the twist of the gears.
"""

from collections.abc import Mapping
from typing import Any, cast

import mujoco
import numpy as np

from runtime.cell.cell import CellSpec
from runtime.cell.gripper import FINGERS, finger_sign
from runtime.core.frames import Array, pose
from runtime.plant.cell_model import CLEARANCE, CellModel
from runtime.plant.touches import Pair
from runtime.robot.model.spec import RobotSpec

AWAY = pose([0.0, 0.0, 1000.0])
"""Where a part is put that is not in the cell."""
MARGIN = 1e-4
"""Shapes of parts that are nearer than this meet, m."""
MET = 1e-6
"""Distance at which a pad has met a part, or a part its support, m."""
ADVANCES = 100
"""Most steps of a conservative advancement."""


class Shapes:
    """The shapes of a robot in its cell, which stay as they were put last."""

    def __init__(self, spec: RobotSpec, cell: CellSpec) -> None:
        self._cell = CellModel.of(spec, cell)
        self._model: Any = self._cell.model
        self._data: Any = mujoco.MjData(self._model)
        self._qpos = cast(Array, self._data.qpos)
        self._stroke = cell.hand.stroke
        self._quaternion = np.empty(4)
        for name in self._cell.parts:
            # MuJoCo lists only shapes that overlap or are nearer than their margin: a part that stands on its support
            # has no gap, and by rounding would be listed in one row and not in the next
            self._model.geom(f"part:{name}").margin = MARGIN

    def lay(self, parts: Mapping[str, Array], opening: float) -> None:
        """Put parts to X_world_part (4, 4), all others away from the cell, and the fingers ``opening`` m apart."""
        for name in self._cell.parts:
            self._put(name, parts.get(name, AWAY))
        self._qpos[self._cell.fingers] = opening / 2.0

    def _put(self, name: str, X: Array) -> None:
        at = self._cell.parts[name]
        mujoco.mju_mat2Quat(self._quaternion, X[:3, :3].ravel())
        self._qpos[at : at + 3], self._qpos[at + 3 : at + 7] = X[:3, 3], self._quaternion

    def meeting(self, q: Array, held: Mapping[str, Array]) -> tuple[bytes, Array]:
        """Return which shapes meet at joint angles q (n,) rad, and the distances (k,) m, negative inside one another.

        The held parts are put to X_world_part (4, 4), those that ``lay`` has put stay. ``pairs_of`` names the shapes.
        """
        for name, X in held.items():
            self._put(name, X)
        self._qpos[self._cell.motors] = q
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        contact = self._data.contact
        # bytes, since the same shapes meet in row after row: the names are looked up once for each key
        return contact.geom.tobytes(), contact.dist

    def pairs_of(self, meeting: bytes) -> list[Pair]:
        """Return the names of the shapes of a ``meeting``, in the order of its distances."""
        names = self._cell.shapes
        return [(names[a], names[b]) for a, b in np.frombuffer(meeting, dtype=np.int32).reshape(-1, 2).tolist()]

    def faces(self, q: Array, name: str) -> tuple[float, float] | None:
        """Return from where to where a part reaches between the pads along y of the tool, m; None: it is not there.

        Each pad goes inwards by its distance from the part until it meets it (conservative advancement).
        """
        self._qpos[self._cell.motors] = q
        left = self._advance(0, name)
        right = None if left is None else self._advance(1, name)
        return None if left is None or right is None or not left > right else (right, left)

    def _advance(self, index: int, name: str) -> float | None:
        """Close one finger of the open hand onto a part; return where its pad meets it along y of the tool, m."""
        side, stroke = FINGERS[index], self._stroke
        pad, part = int(self._model.geom(f"pad_{side}").id), int(self._model.geom(f"part:{name}").id)
        at = stroke / 2.0
        for _ in range(ADVANCES):
            self._qpos[self._cell.fingers.start + index] = at
            mujoco.mj_kinematics(self._model, self._data)
            distance = mujoco.mj_geomDistance(self._model, self._data, pad, part, stroke, None)
            # never outwards: a part that overlaps the open pad is met there
            at -= max(distance, 0.0)
            if not at >= -stroke / 2.0:
                return None
            if distance <= MET:
                break
        return finger_sign(side) * at

    def gap_below(self, name: str, most: float, inside: float) -> float | None:
        """Return how far a part that ``lay`` has put would fall until it rests on something, m.

        None: over ``most``, or it is in something by more than ``inside``, and physics would throw it out.
        """
        at = self._cell.parts[name]
        own = self._cell.shapes.index(f"part:{name}")
        others = [index for index, other in enumerate(self._cell.shapes) if index != own and not _of_arm(other)]
        fallen, z = 0.0, float(self._qpos[at + 2])
        for _ in range(ADVANCES):
            self._qpos[at + 2] = z - fallen
            mujoco.mj_kinematics(self._model, self._data)
            # distances are cut at the last argument: a part that is further away falls too far in any case
            distance = min(
                mujoco.mj_geomDistance(self._model, self._data, own, other, 2.0 * most + MARGIN, None)
                for other in others
            )
            if distance <= MET:
                return fallen if distance >= -inside else None
            fallen += distance
            if not fallen <= most:
                return None
        return fallen

    def folded(self, q: Array) -> Pair | None:
        """Return which shape of the arm or the hand would be in another link at joint angles q (n,) rad, and in which.

        Checked with the hand open, for the pairs that meet in a run as well: none of an arm whose shapes are not known.
        """
        self._qpos[self._cell.motors] = q
        self._qpos[self._cell.fingers] = self._stroke / 2.0
        mujoco.mj_kinematics(self._model, self._data)
        for first, second in self._cell.own_pairs:
            if mujoco.mj_geomDistance(self._model, self._data, first, second, CLEARANCE, None) < -CLEARANCE:
                return self._cell.shapes[second], self._cell.shapes[first]
        return None


def _of_arm(name: str) -> bool:
    return name.startswith(("link", "palm", "cup", "pad_", "shank_"))
