"""What the report measures of each statement, taken from the rows of a run piece by piece.

The largest of a statement is the largest of its pieces, to the last bit, so the rows of a run are read once and need
not be kept: without ``--log`` the recorder hands each block over and drops it (``Recorder.fold``).
"""

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, replace

import numpy as np

from robolang.execution.result import RunRecord, StatementRun
from runtime.control.recorder import Recorded
from runtime.control.signals import Signals
from runtime.core.frames import Array
from runtime.core.units import DEG, MM, PERCENT
from runtime.motion.path import Path
from runtime.servo.motor import torque_limit

_LAG = 8
"""Cycles that the tool may come after the plan: two of the interpolator, one to be sent, those of the servo."""
_PIECE = 8192
"""Ticks that are measured at once."""


@dataclass(slots=True, kw_only=True)
class Measured:
    """The largest of one statement so far, None before its first tick; ``wrist``: the first and the last tick in which
    the wrist did not follow the path."""

    joint_deg: float | None = None
    joint_mm: float | None = None
    tool_mm: float | None = None
    path_mm: float | None = None
    torque_pct: float | None = None
    seam_mm: float | None = None
    seam_deg: float | None = None
    wrist: tuple[int, int] | None = None


class Measures:
    """Measures of the statements of a record, up to the tick that was taken last."""

    def __init__(self, record: RunRecord) -> None:
        self._record = record
        self._torque = torque_limit(record.controller.spec)
        self._found: list[Measured] = []
        self._tick = 0
        self._open = 0
        """Statements that ended before that tick."""

    def complete(self, recorded: Recorded) -> list[Measured]:
        """Return what has been measured of each statement up to now; the run may go on."""
        # of a copy: the rows that are still there come again when they are dropped
        other = copy(self)
        other._found = [replace(each) for each in self._found]
        for first in range(self._tick, recorded.ticks, _PIECE):
            other.take(recorded, first, min(first + _PIECE, recorded.ticks))
        other._reach(len(self._record.statements))
        return other._found

    def take(self, recorded: Recorded, first: int, last: int) -> None:
        """Measure the ticks from ``first`` to before ``last``, which follow those before."""
        self._tick = last
        piece = _Piece(recorded, self._record, self._torque, first, last)
        for at, run in self._running(first, last):
            piece.measure(run, self._found[at])

    def _running(self, first: int, last: int) -> Iterator[tuple[int, StatementRun]]:
        """Yield the statements that ran in some of these ticks, with their numbers."""
        statements = self._record.statements
        while self._open < len(statements) and _ended_by(statements[self._open], first):
            self._open += 1
        self._reach(len(statements))
        for at in range(self._open, len(statements)):
            run = statements[at]
            if run.begun and run.first_tick < last and not _ended_by(run, first):
                yield at, run

    def _reach(self, count: int) -> None:
        self._found += [Measured() for _ in range(count - len(self._found))]


class _Piece:
    """Measures of each tick of a piece of a run."""

    def __init__(self, recorded: Recorded, record: RunRecord, torque: Array, first: int, last: int) -> None:
        spec = record.controller.spec
        log = Signals(recorded, record.controller.kinematics.chain)
        self._first, self._last = first, last
        self._p_tool = log.span("X_world_tool", first, last)[:, :3, 3]
        self._tool_mm = np.linalg.norm(log.span("tool_cmd", first, last) - self._p_tool, axis=1) / MM
        joints, slides = np.abs(log.span("q_cmd", first, last) - log.span("q_link", first, last)), spec.slides
        self._joint_deg = joints[:, ~slides].max(axis=1) / DEG if not slides.all() else None
        self._joint_mm = joints[:, slides].max(axis=1) / MM if slides.any() else None
        self._torque_pct = np.abs(log.span("tau_sat", first, last) / torque).max(axis=1) / PERCENT
        self._wrist_mode = log.span("wrist_mode", first, last)
        self._deviation = log.span("seam_deviation", first, last)

    def measure(self, run: StatementRun, found: Measured) -> None:
        """Take the ticks of a statement."""
        end = run.end_tick if run.ended else self._last
        begin = max(run.first_tick, self._first)
        span = slice(begin - self._first, min(end, self._last) - self._first)
        if span.stop <= span.start:
            return
        if self._joint_deg is not None:
            found.joint_deg = _larger(found.joint_deg, self._joint_deg[span])
        if self._joint_mm is not None:
            found.joint_mm = _larger(found.joint_mm, self._joint_mm[span])
        found.tool_mm = _larger(found.tool_mm, self._tool_mm[span])
        found.torque_pct = _larger(found.torque_pct, self._torque_pct[span])
        if run.path is not None:
            # a seam sensor takes the tool off the programmed path on purpose, which is no error of the servo
            points = (self._p_tool - self._deviation[:, :3])[span]
            off = np.min([path.deviation(points) for path in _paths_about(run, run.path)], axis=0)
            found.path_mm = _larger(found.path_mm, off / MM)
        if run.seam is not None:
            deviation = self._deviation[span]
            found.seam_mm = _larger(found.seam_mm, np.linalg.norm(deviation[:, :3], axis=1) / MM)
            found.seam_deg = _larger(found.seam_deg, np.abs(deviation[:, 3:]).max(axis=1) / DEG)
        on = np.flatnonzero(self._wrist_mode[span]) + begin
        if len(on):
            found.wrist = (int(on[0]) if found.wrist is None else found.wrist[0], int(on[-1]))


def _paths_about(run: StatementRun, path: Path) -> list[Path]:
    """Return the path of a move with those of its chain that the tool may still be on, or on already."""
    if run.speeds is None:
        return [path]
    parts = run.speeds.chain.parts
    own = parts[run.at]
    near = [path]
    # the arm follows the rows of a plan some cycles later, and moves of a chain may be shorter than that
    for step in (-1, 1):
        at = run.at + step
        while 0 <= at < len(parts) and parts[at].last >= own.first - _LAG and parts[at].first <= own.last + _LAG:
            beside = parts[at].path
            near += [] if beside is None else [beside]
            at += step
    return near


def _ended_by(run: StatementRun, tick: int) -> bool:
    return run.ended and run.end_tick <= tick


def _larger(before: float | None, values: Array) -> float:
    """Return the larger of a number and the largest of values; NaN if any is."""
    largest = values.max()
    return float(largest if before is None else np.maximum(before, largest))
