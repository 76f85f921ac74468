"""The interpolator of Fig 6: one joint set-point into INA in every cycle until the target is reached.

Step 210 of cycle n writes what the 8 ms interrupt of cycle n + 1 sends (step 218), so the servo gets a set-point one
cycle after it was computed. The rows come from the plan, where steps 204 to 210 were carried out and checked for
the whole move at once; under a seam sensor each is computed in its own cycle (``seam``). Called once per cycle by the
controller. Joint angles rad.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.state import Stateful
from runtime.motion.cartesian_planner import EXCEPTION, FOLLOWS, MovePlan
from runtime.motion.motion_planner import ChainPlan
from runtime.motion.seam import SeamMove
from runtime.motion.stop import on_curve


@dataclass(frozen=True, slots=True, kw_only=True)
class _Held:
    """Rows of a move that is paused, with their modes and commands; it rests ``at`` a place between them.

    ``own``: they are those of a plan.
    """

    rows: Array
    modes: tuple[int, ...]
    commands: tuple[int, ...]
    at: float
    own: bool


_HISTORY = 3
"""Set-points before one of which the command there is made."""


class Interpolator(Stateful):
    """Hands out the set-points of one move at a time, or of moves in a row."""

    VALUES = ("_rows", "_modes", "_commands", "_n", "_held", "_own", "fault")

    def __init__(self) -> None:
        self._rows: Array | None = None
        self._modes: tuple[int, ...] = ()
        self._commands: tuple[int, ...] = ()
        self.seam: SeamMove | None = None
        """The move under a seam sensor that runs, None: another one or none. Its owner keeps and restores it."""
        self._n = 0
        self._held: _Held | None = None
        self._own: tuple[int, int] | None = None  # from which row on they are those of the plan, and how many before it
        self.fault: Fault | None = None
        """Why the last set-point has to stop the arm: the seam cannot be followed (RBL524 to 526)."""

    def start(self, plan: MovePlan | ChainPlan, seam: SeamMove | None = None) -> None:
        """Begin a move, with ``seam`` point by point; ``RuntimeError`` when another one still runs."""
        if self.busy or self._held is not None:
            raise RuntimeError("a move is running")
        self._rows, self._modes, self.seam, self.fault = plan.setpoints, tuple(plan.modes.tolist()), seam, None
        self._commands = tuple(plan.command.tolist()) if isinstance(plan, ChainPlan) else (0,) * len(plan.q)
        if seam is not None:
            # a copy: the rows of the plan are those without deviation, and each is replaced in its cycle
            self._rows = np.array(self._rows)
            self._rows[0] = seam.here
        self._n, self._own = 0, (0, 0) if seam is None else None

    def extend(self, plan: ChainPlan, left_out: int) -> None:
        """Go on with another plan from the row that has been reached; it leaves out so many rows of the one before."""
        row = self.row
        if row is None:
            raise RuntimeError("the rows of the plan do not run")
        self._rows, self._modes = plan.setpoints, tuple(plan.modes.tolist())
        self._commands = tuple(plan.command.tolist())
        self._n, self._own = row - left_out, (0, 0)

    @property
    def row(self) -> int | None:
        """Number of the row of the plan that has been reached, None where others run: a stop, a pause, a seam."""
        if self._own is None or self._rows is None or self._held is not None:
            return None
        # a while after a pause: the first set-points after it are none of the plan
        first, before = self._own
        return self._n + before if self._n >= first else None

    def stop(self, stopping: Callable[[Array, int, bool], Array]) -> None:
        """Replace the rows that are left by those of a stop, ``stopping(rows, reached, whether they end at rest)``."""
        self._held = None
        if self._rows is not None and self.busy:
            # the rows of a stop lie between those of the plan, so all are logged with the mode of the row reached
            rows, reached, mode, whole = self._rows, self._rows[: self._n + 1], self.mode, True
            if self.seam is not None:
                # the readings to come are not known, so the stop runs on the deviation as it settles now
                rest, whole = self.seam.rest(self._n + 1)
                rows, self.seam = np.concatenate([reached, rest]), None
            self._rows = np.concatenate([reached, stopping(rows, self._n, whole)])
            self._modes, self._commands = (mode,) * len(self._rows), (self.command,) * len(self._rows)
            self._own = None

    def hold(self, pausing: Callable[[Array, int], Array]) -> None:
        """Replace the rows that are left by the places ``pausing(rows, reached)`` on them, and keep them for ``go_on``.

        A move under a seam sensor is left to end: its sensor would go on to see the seam.
        """
        if self._rows is None or not self.busy or self._held is not None or self.seam is not None:
            return
        rows, at = self._rows, self._n
        course = pausing(rows, at)
        if course[-1] < len(rows) - 1:
            own = self.row == at
            self._held = _Held(rows=rows, modes=self._modes, commands=self._commands, at=float(course[-1]), own=own)
            self._own = None
            self._play(self._held, course, rows[: at + 1], list(range(at + 1)))

    def go_on(self, resuming: Callable[[Array, float], Array]) -> None:
        """Go on where ``hold`` has come to rest, at the places ``resuming(rows, rest)``."""
        held, self._held = self._held, None
        if held is not None and self._rows is not None:
            course = resuming(held.rows, held.at)
            self._play(held, course, self._rows[-1:], [int(np.ceil(held.at))])
            if held.own:
                # once it moves on by a row a cycle, the rows are those of the plan
                even = np.append(np.diff(course) == 1.0, True) & (course == np.floor(course))
                first = len(course) - int(np.argmin(np.append(even[::-1], False)))
                self._own = first + 1 + _HISTORY, len(held.rows) - len(self._rows)

    def _play(self, held: "_Held", course: Array, reached: Array, passed: list[int]) -> None:
        """Hand out what is at these places of held rows, after those that have been reached, numbers ``passed``."""
        towards = [*passed, *np.ceil(course).astype(int).tolist()]  # between two rows it moves towards the later one
        self._rows = np.concatenate([reached, on_curve(held.rows, course, reached[-1])])
        self._modes = tuple([held.modes[k] for k in towards])
        self._commands = tuple([held.commands[k] for k in towards])
        self._n = len(reached) - 1

    def drop(self) -> None:
        """Forget the move: no set-point is left to send."""
        self._rows = self.seam = self.fault = self._held = None

    @property
    def command(self) -> int:
        """Number of the move of a chain that the last set-point belongs to; of a stop, that in which it began."""
        return self._commands[self._n] if self._commands else 0

    @property
    def is_held(self) -> bool:
        """Whether ``hold`` has interrupted a move."""
        return self._held is not None

    @property
    def busy(self) -> bool:
        """Whether set-points are left to send (step 222)."""
        return self._rows is not None and self._n + 1 < len(self._rows)

    @property
    def mode(self) -> int:
        """``wrist_mode`` of the last set-point; the wrist follows the path when none is left."""
        if not self.busy:
            return FOLLOWS
        if self.seam is not None:
            return FOLLOWS if self.seam.law is None else EXCEPTION
        return self._modes[self._n]

    def next(self) -> Array:
        """Return the joint set-point (n,) rad of this cycle; ``RuntimeError`` when the target was reached."""
        if self._rows is None or not self.busy:
            raise RuntimeError("no move is running")
        self._n += 1
        if self.seam is not None:
            self._rows[self._n], self.fault = self.seam.next(self._n)
            if self._n + 1 == len(self._rows):
                self.seam.finish()
        row: Array = self._rows[self._n]
        return row
