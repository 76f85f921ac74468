"""Findings in the motion of a program, with where the tool then is and when that is."""

import numpy as np

from robolang.core.diagnostics import Diagnostic, Severity
from robolang.execution.dry_run import RehearsedHand, RehearsedMove
from runtime.core.frames import Array
from runtime.robot.kinematics.kinematics import Kinematics


class Placed(Diagnostic):
    """A finding at a place: ``p``, where the tool point is, m in the world, and ``time_us`` of the rehearsal.

    None: it is on a branch that the rehearsal by the simulated inputs does not take.
    """

    p: tuple[float, float, float]
    time_us: int | None = None


class Places:
    """Makes findings at the rows of rehearsed moves, ``period_us`` apart, and at rehearsed HANDs."""

    def __init__(self, kinematics: Kinematics, period_us: int) -> None:
        self._kinematics, self._period_us = kinematics, period_us

    def at(
        self,
        code: str,
        step: RehearsedMove | RehearsedHand,
        message: str,
        *,
        row: int = 0,
        severity: Severity = Severity.WARNING,
    ) -> Placed:
        """Return a finding at a row of the set-points of a move, or at a HAND."""
        q = np.atleast_2d(step.q)
        row = min(max(row, 0), len(q) - 1)
        first_us = step.sent_us if isinstance(step, RehearsedMove) else step.begins_us
        return Placed(
            code=code,
            severity=severity,
            message=message,
            span=step.effect.span,
            p=self.tool_point(q[row], step.X_flange_tool),
            time_us=first_us + row * self._period_us,
        )

    def tool_point(self, q: Array, X_flange_tool: Array) -> tuple[float, float, float]:
        """Return the tool point, m in the world, at joint angles q (n,) rad."""
        x, y, z = (self._kinematics.forward(q) @ X_flange_tool)[:3, 3].tolist()
        return x, y, z
