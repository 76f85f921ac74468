"""What a running program reads of the robot and the cell: inputs, time, where it is, poses as numbers.

``RobotWorld`` is the ``World`` of the evaluator. It reads and changes nothing: the session has let all motion end
before (``Drain``). Time is that of the clock that it is given, so a rehearsal without a controller has one as well.
"""

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass

import numpy as np

from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.project.points import PointStore
from robolang.values.poses import Frame, Place, Six
from runtime.cell.cell import CellSpec
from runtime.cell.signals import Signals, SignalsSnapshot
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.robot.kinematics.kinematics import Kinematics


@dataclass(frozen=True, slots=True, kw_only=True)
class WorldSnapshot:
    """A ``RobotWorld`` as it was: where motion ended, the tool in use, the outputs."""

    q_last: Array
    tool: Frame
    X_flange_tool: Array
    signals: SignalsSnapshot


class RobotWorld:
    """The world of one run: ``q_last`` (n,) rad is where the motion before ends, ``X_flange_tool`` the tool in use."""

    def __init__(self, points: PointStore, cell: CellSpec, kinematics: Kinematics, now_us: Callable[[], int]) -> None:
        self._points, self._cell, self._kinematics, self._now_us = points, cell, kinematics, now_us
        self.signals = Signals(cell.inputs)
        self.q_last: Array = np.array(cell.home)
        self.tool: Frame = ""
        """The tool in use as TOOL has named it: by its key in the cell or by its pose; "" is the tool of the hand."""
        self.X_flange_tool: Array = cell.hand.X_flange_tool

    @property
    def around(self) -> Surroundings:
        """What a place depends on, as it is now."""
        return Surroundings(
            points=self._points,
            cell=self._cell,
            kinematics=self._kinematics,
            q_last=self.q_last,
            X_flange_tool=self.X_flange_tool,
        )

    def adopt(self, points: PointStore, cell: CellSpec) -> None:
        """Read other taught points, frames and tools from now on; the tool in use stays."""
        self._points, self._cell = points, cell

    def at(self, q: Array) -> "RobotWorld":
        """Return this world with the arm at joint angles q (n,) rad; it shares the signals."""
        other = copy(self)
        other.q_last = np.array(q)
        return other

    def flange_pose(self, q: Array) -> Array:
        """Return X_world_flange (..., 4, 4) at joint angles q (..., n) rad."""
        return self._kinematics.forward(q)

    def tool_pose(self, q: Array) -> Array:
        """Return X_world_tool (..., 4, 4) at joint angles q (..., n) rad."""
        return np.asarray(matmul(self.flange_pose(q), self.X_flange_tool))

    def snapshot(self) -> WorldSnapshot:
        """Return the state of the world; its clock is not part of it."""
        return WorldSnapshot(
            q_last=np.array(self.q_last),
            tool=self.tool,
            X_flange_tool=self.X_flange_tool,
            signals=self.signals.snapshot(),
        )

    def restore(self, snapshot: WorldSnapshot) -> None:
        """Go back, or on, to a snapshot."""
        self.q_last = np.array(snapshot.q_last)
        self.tool, self.X_flange_tool = snapshot.tool, snapshot.X_flange_tool
        self.signals.restore(snapshot.signals)

    def input(self, number: int) -> float:
        """Return the state of an input; ``Fault`` RBL534."""
        return self.signals.input(number, self._now_us())

    def seconds(self) -> float:
        """Return the time since the program began, s."""
        return self._now_us() / 1_000_000

    def here(self) -> Six:
        """Return where the tool is commanded to be, mm and deg in the world."""
        return lowering.six_of(self.tool_pose(self.q_last))

    def components(self, place: Place, frame: Frame) -> Six:
        """Return a place in a frame, mm and deg."""
        return lowering.components(place, frame, self.around)

    def set_output(self, output: int, value: float, seconds: float | None) -> None:
        """Set an output now, for ``seconds`` or for good."""
        now = self._now_us()
        self.signals.set(output, value, now, None if seconds is None else now + round(seconds * 1e6))
