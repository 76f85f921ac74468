"""The log of a run: its signals by name, computed when they are read, and ``meta``, what the run was of.

``Log`` is the same whether the run has just ended or its file is read years later. What ``meta`` holds is made by
``robolang.execution.log_meta``; docs/signals.md has its keys.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.logs.excerpt import Excerpt
from robolang.logs.human_units import HumanUnits
from runtime.control.signals import Rows, Signals
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.units import DEG, MM
from runtime.robot.kinematics.chain import Chain

VERSION = 2
"""Layout of the files that are written; those of version 1 hold every signal in every tick, and no ``meta``."""

Meta = Mapping[str, Any]
"""Plain JSON types: program, cell, points, robot, scene, events, report, tick_s, cycle_s."""


class Log(HumanUnits, Signals):
    """The signals of a run by name, first dimension ticks or frames, with what the run was of.

    ``log["tool_error"]`` is in m, ``log.tool_error_mm`` the same in mm; docs/signals.md has the names.
    """

    version = VERSION
    """Layout of the file that it was read from."""

    def __init__(self, rows: Rows, meta: Meta | None, source: str = "this log") -> None:
        """``source`` is what messages call it; ``meta`` None: nothing is known of the run but its signals."""
        chain = chain_of(meta["robot"]) if meta is not None else _NO_CHAIN
        super().__init__(rows, chain)
        self.source = source
        self.meta = meta

    @property
    def events(self) -> list[dict[str, Any]]:
        """Changes of inputs, outputs and the hand: ``time_s``, ``kind``, ``name`` and ``value``; none if unknown."""
        return [] if self.meta is None else list(self.meta["events"])

    @property
    def joint_units(self) -> Array:
        """What people measure each axis in, as SI (n,): a degree, rad, or of a sliding axis a millimetre, m."""
        kinds = [] if self.meta is None else [axis.get("kind") for axis in self.meta["robot"]["axes"]]
        # a log of the first layout has no meta, and its arm turns in every axis
        kinds = kinds or ["revolute"] * self.span("q_cmd", 0, 0).shape[1]
        return np.array([MM if kind == "prismatic" else DEG for kind in kinds])

    def at(self, ticks: NDArray[np.int64]) -> Excerpt:
        """Return the signals of some ticks (M,), counted from 0."""
        return Excerpt(self, ticks)

    def at_line(self, line: int) -> Excerpt:
        """Return the signals of the ticks in which a line ran: a line number in a program that has them, else a line of
        the file. ``Fault`` RBL838 for a line that did not run.
        """
        running = self["number"] if np.any(self["number"]) else self["line"]
        found = np.flatnonzero(running == line)
        if line == 0 or not len(found):
            ran = ", ".join(str(each) for each in np.unique(running) if each)
            raise Fault("RBL838", f"line {line} has not run in {self.source}", f"These have: {ran}.")
        return self.at(found)

    def to_pandas(self, *signals: str) -> Any:
        """Return a ``pandas.DataFrame``: see ``Excerpt.to_pandas``."""
        return self._whole().to_pandas(*signals)

    def to_polars(self, *signals: str) -> Any:
        """Return a ``polars.DataFrame``: see ``Excerpt.to_pandas``."""
        return self._whole().to_polars(*signals)

    def _whole(self) -> Excerpt:
        return self.at(np.arange(self.count("t")))

    def __repr__(self) -> str:
        """Return one line: a log holds millions of numbers."""
        name = "a program" if self.meta is None else self.meta["program"]["name"]
        return f"<Log of {name}: {self.count('t')} ticks, {len(self)} signals>"

    def require(self, *names: str) -> None:
        """Refuse a log that lacks one of these signals; ``Fault`` RBL820."""
        for name in names:
            if name not in self:
                raise self.lacks(f"the signal {name}")

    def needed_meta(self) -> Meta:
        """Return ``meta``; ``Fault`` RBL820 for a log that has none."""
        if self.meta is None:
            raise self.lacks("the program and the robot")
        return self.meta

    def lacks(self, what: str) -> Fault:
        """Return the fault of a log in which something is missing."""
        return Fault("RBL820", f"{self.source} lacks {what}: it has layout {self.version}, this version {VERSION}")


def chain_of(robot: Mapping[str, Any]) -> Chain:
    """Return the joint frames of the robot in a ``meta``."""
    placements = tuple(np.array(axis["placement"], dtype=np.float64) for axis in robot["axes"])
    # a log from before axes could slide does not say that they turn
    sliding = frozenset(index for index, axis in enumerate(robot["axes"]) if axis.get("kind") == "prismatic")
    return Chain(placements=placements, X_last_flange=np.array(robot["flange"], dtype=np.float64), sliding=sliding)


_NO_CHAIN = Chain(placements=(), X_last_flange=np.eye(4))
