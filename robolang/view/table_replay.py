"""Exported pulse tables as postures over time: where the machine stands when a PLC plays them."""

from bisect import bisect_right
from dataclasses import dataclass

import numpy as np

from runtime.appearance.mechanisms import machine_scene
from runtime.appearance.scene import Scene
from runtime.appearance.stance import Stance
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.pulses.exported import Export, Move
from runtime.pulses.machine import Joint
from runtime.pulses.mechanism import Kind
from runtime.pulses.replay import joint_values, positions

SAMPLES = 24
"""Postures of each move by which the ranges of the joints are found, and of all by which a view is framed."""
ROOM = 0.2
"""What a joint is shown to have beyond its motion on each side, in parts of it: tables do not state its limits."""
LEAST_ROOM = 0.02
"""And at least so much, m or rad."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlayedMachine:
    """A machine as its tables know it: ``runtime.appearance.mechanisms.Machine``."""

    name: str
    kind: Kind
    joints: tuple[Joint, ...]
    lengths: tuple[float, float]
    fixed: tuple[tuple[str, float], ...]


class TableReplay:
    """The scene of exported tables and where the machine is at a time."""

    def __init__(self, export: Export) -> None:
        """``Fault`` RBL832 for tables of an arm, and for tables without a move."""
        self._export, self._starts = export, _starts(export)
        if not export.moves:
            raise Fault("RBL832", f"the tables of {export.program} have no move: there is nothing to show")
        self.scene: Scene = machine_scene(_machine(export))

    @property
    def end(self) -> float:
        """Time of the whole program, s."""
        return self._export.seconds

    def at(self, time: float) -> Stance:
        """Return the posture at a time, s; while a hand waits the machine stands."""
        item = max(bisect_right(self._starts, time) - 1, 0)
        # a wait stands at the end of the move before it, or at the start of the first one
        moves = [k for k, each in enumerate(self._export.sequence) if isinstance(each, Move)]
        last = max((k for k in moves if k <= item), default=moves[0])
        move = self._export.sequence[last]
        assert isinstance(move, Move)
        pulses = positions(move, np.array([time - self._starts[last]]))
        return Stance(axes=joint_values(self._export, pulses)[0])

    def samples(self) -> list[Stance]:
        """Return postures from start to end."""
        return [self.at(time) for time in np.linspace(0.0, self.end, SAMPLES).tolist()]


def _starts(export: Export) -> list[float]:
    times = [item.steps * export.step_s if isinstance(item, Move) else item.dwell_s for item in export.sequence]
    return [0.0, *np.cumsum(times).tolist()][: len(times)]


def _machine(export: Export) -> PlayedMachine:
    found = export.mechanism
    if found.kind == "arm":
        raise Fault("RBL832", f"these tables move {found.name}, an arm", "draw its program: robolang render PROG")
    values = np.concatenate([_values(export, move) for move in export.moves])
    low, high = values.min(axis=0), values.max(axis=0)
    room = np.maximum(ROOM * (high - low), LEAST_ROOM)
    joints = tuple(
        Joint(name=name, rotary=unit == "deg", lower=float(a), upper=float(b))
        for name, unit, a, b in zip(found.axes, found.units, low - room, high + room, strict=True)
    )
    fixed = tuple((axis, float(at)) for axis, at in zip("xyz", found.constant, strict=True) if axis not in found.axes)
    return PlayedMachine(name=found.name, kind=found.kind, joints=joints, lengths=found.lengths, fixed=fixed)


def _values(export: Export, move: Move) -> Array:
    times = np.linspace(0.0, move.steps * export.step_s, SAMPLES)
    return joint_values(export, positions(move, times))
