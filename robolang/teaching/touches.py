"""What frames and tools are measured from: points that the arm has been brought to."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robolang.project.points import MAX_MM
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.units import MM


@dataclass(frozen=True, slots=True, kw_only=True)
class Touch:
    """A point by its name, and X (4, 4) m: where the tool stood for a frame, where the flange stood for a tool."""

    name: str
    X: Array

    @property
    def position(self) -> Array:
        """Where it is (3,), m."""
        return np.asarray(self.X[:3, 3])


def check_bounds(touches: Sequence[Touch]) -> None:
    """Raise ``Fault`` RBL309 for a touch that is nowhere or further away than any robot reaches."""
    for touch in touches:
        # NaN fails every comparison, so what is not known is refused as well
        if not np.abs(touch.X).max() <= MAX_MM * MM:
            raise Fault("RBL309", f"point {touch.name} is not within {MAX_MM / 1000.0:g} m of the base")
