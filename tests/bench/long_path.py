"""Ten thousand short moves without a stop: what their planning costs, and the memory of their run (``make bench``)."""

import math
import os
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from robolang.execution.dry_run import rehearse
from robolang.execution.plan_memory import PlanMemory
from robolang.execution.session import Session
from robolang.execution.status import ENDED
from robolang.project.project import Project
from tests.bench import figures
from tests.bench.figures import Row
from tests.bench.gcode_campaign import CELL
from tests.bench.short_moves import Polyline

MOVES = 10_000
STEP_MM, SPEED, RADIUS_MM = 0.5, 100.0, 100.0
PAGE_MB = os.sysconf("SC_PAGE_SIZE") / 1e6
BLOCK = 125
"""Cycles between two readings of the memory."""


def path(moves: int) -> Polyline:
    """Return moves of 0.5 mm at SPEED 100, round and round on a circle."""
    turn = np.arange(moves + 1) * 2.0 * math.asin(0.5 * STEP_MM / RADIUS_MM)
    corners = np.stack([900.0 + RADIUS_MM * np.cos(turn), RADIUS_MM * np.sin(turn)], axis=1)
    return Polyline(corners=corners, speed=SPEED, zone=0.5 * STEP_MM)


def memory_mb() -> float:
    """Return the resident memory of this process, MB."""
    return int(Path("/proc/self/statm").read_text("ascii").split()[1]) * PAGE_MB


def measured(moves: int) -> tuple[float, float, float, float]:
    """Return the processor time of planning and of the run, the time of the robot, s, and the growth of memory, MB."""
    project = Project.from_text(path(moves).text, cell=CELL)
    plans = PlanMemory(project)
    begins = time.process_time()
    rehearsal = rehearse(project, plans=plans)
    planned_s, lasts_s = time.process_time() - begins, rehearsal.total_us / 1e6
    assert not rehearsal.refused, rehearsal.refused
    del rehearsal
    executor = Session(project, physics=False, plans=plans, log=False).executor
    begins, memory = time.process_time(), []
    while executor.advance(BLOCK).state not in ENDED:
        memory.append(memory_mb())
    # what is made once is there after a quarter of the run
    return planned_s, time.process_time() - begins, lasts_s, memory[-1] - memory[len(memory) // 4]


def rows(smallest: bool) -> Iterator[Row]:
    """Plan and run the path."""
    planned_s, run_s, lasts_s, growth_mb = measured(300 if smallest else MOVES)
    yield Row(
        figure="10,000 moves of 0.5 mm at SPEED 100: processor time of planning against the time of the robot",
        form="{:.2f}: {:.1f} of {:.1f} s",
        values=(planned_s / lasts_s, planned_s, lasts_s),
    )
    yield Row(
        figure="growth of the memory over the last three quarters of their run, and its processor time",
        form="{:.1f} MB, {:.1f} s",
        values=(growth_mb, run_s),
    )


if __name__ == "__main__":
    figures.run(rows)
