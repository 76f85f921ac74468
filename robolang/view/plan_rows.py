"""The set-points of a planned motion as rows of a log: its tool points and speeds are made as those of a run."""

import numpy as np

from robolang.execution.dry_run import Rehearsal
from robolang.project.project import Project
from runtime.core.frames import Array


class PlanRows:
    """``runtime.control.signals.Rows`` of a rehearsal: a tick is a cycle, and the links are on their set-points."""

    ticks_per_cycle = 1
    frames = 0

    def __init__(self, project: Project, rehearsal: Rehearsal) -> None:
        self.tick_us = project.profile.period_us
        self.q = joint_angles(rehearsal, np.asarray(project.cell.home), self.tick_us)
        self.ticks = self.cycles = len(self.q)
        self.tools = (project.cell.hand.X_flange_tool, *(move.X_flange_tool for move in rehearsal.moves))
        self._tool = np.zeros(self.ticks, dtype=np.int32)
        for k, move in enumerate(rehearsal.moves):
            self._tool[move.sent_us // self.tick_us :] = k + 1

    def read(self, name: str, first: int, last: int) -> Array:
        """Return rows of ``q_link`` (N, n) rad, or of ``tool`` (N,): number of the tool in ``tools``."""
        return np.asarray((self._tool if name == "tool" else self.q)[first:last])


def joint_angles(rehearsal: Rehearsal, home: Array, period_us: int) -> Array:
    """Return the set-points (cycles + 1, n) rad of a rehearsal that starts at ``home`` (n,) rad, a row each cycle."""
    q = np.tile(home, (rehearsal.total_us // period_us + 1, 1))
    held, at = home, 0
    for move in rehearsal.moves:
        begin = move.sent_us // period_us
        q[at:begin] = held
        held, at = move.q[-1], begin + len(move.q)
        q[begin:at] = move.q[: len(q) - begin]  # a run that is cut at its longest time ends within a move
    q[at:] = held
    return q
