"""Warnings where a planned motion is not the one that a program states, once for a code and a statement."""

from collections.abc import Callable, Iterable

from robolang.execution.plan_findings import PlanFindings
from robolang.execution.planned_move import PlannedMove
from robolang.interpreter.effects import Origin
from robolang.project.project import Project
from runtime.control.controller import Controller
from runtime.robot.kinematics.kinematics import Kinematics


class PlanWarnings:
    """Warns on a controller; ``given`` are the codes and statements that it has warned of."""

    def __init__(self, project: Project, kinematics: Kinematics) -> None:
        self._findings = PlanFindings(project, kinematics)
        self.given: frozenset[tuple[str, Origin]] = frozenset()

    def warn(self, moves: Iterable[PlannedMove], controller: Controller) -> None:
        """Say what is found of moves."""
        for move in moves:
            for found in self._findings.of(move):
                warning = (found.code, move.effect.origin)
                if warning not in self.given:
                    # replaced and not added to: snapshots share the set
                    self.given |= {warning}
                    controller.warn(found.code, found.message, found.hint, move.effect.origin)

    def rename(self, place: Callable[[Origin], Origin]) -> None:
        """Name the statements by their places in an edited text."""
        self.given = frozenset((code, place(origin)) for code, origin in self.given)
