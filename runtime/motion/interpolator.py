"""The interpolator of Fig 6: one joint set-point into INA in every cycle until the target is reached.

Step 210 of cycle n writes what the 8 ms interrupt of cycle n + 1 sends (step 218), so the servo gets a set-point one
cycle after it was computed. The rows come from the plan, where steps 204 to 210 were carried out and checked for
the whole move at once. Called once per cycle by the controller.
"""

from collections.abc import Callable

import numpy as np

from runtime.frames import Array
from runtime.motion.planner import LinePlan


class Interpolator:
    """Hands out the set-points of one move at a time."""

    def __init__(self) -> None:
        self._rows: Array | None = None
        self._n = 0

    def start(self, plan: LinePlan) -> None:
        """Begin a move; ``RuntimeError`` when another one still runs."""
        if self.busy:
            raise RuntimeError("a move is running")
        self._rows = plan.q
        self._n = 0

    def stop(self, stopping: Callable[[Array, int], Array]) -> None:
        """Replace the rows that are left by those of a controlled stop, ``stopping(rows, reached)``."""
        if self._rows is not None and self.busy:
            reached = self._rows[: self._n + 1]
            self._rows = np.concatenate([reached, stopping(self._rows, self._n)])

    def drop(self) -> None:
        """Forget the move: no set-point is left to send."""
        self._rows = None

    @property
    def busy(self) -> bool:
        """Whether set-points are left to send (step 222)."""
        return self._rows is not None and self._n + 1 < len(self._rows)

    def next(self) -> Array:
        """Return the joint set-point (n,) rad of this cycle; ``RuntimeError`` when the target was reached."""
        if self._rows is None or not self.busy:
            raise RuntimeError("no move is running")
        self._n += 1
        row: Array = self._rows[self._n]
        return row
