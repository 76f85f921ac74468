"""The recorder: what a run is made of, row by row; ``runtime.control.signals`` gives what follows from it.

=======  ==============================================================================================================
rows of  signals
=======  ==============================================================================================================
a tick   ``q_cmd`` ``dq_cmd`` ``tau_cmd`` ``tau_sat`` ``q_fb`` ``dq_fb`` ``q_link``
a cycle  ``q_plan`` ``D`` ``T`` ``read_us`` (when the angles were read from which D and T were computed)
         ``seam_deviation`` ``payload_mass`` ``line`` ``number`` ``wrist_mode`` and ``tool``, which of ``tools`` is used
a frame  every second cycle, in single precision: ``parts`` and ``fingers``, see ``Plant.moved``
=======  ==============================================================================================================

The hot path copies one row of five vectors per tick and one row per cycle into blocks. Two runs of the same program
give the same bytes.

A snapshot holds the block that is being filled and how far it is filled, and through it all blocks before: it copies
no row, and a controller that takes the snapshot over has the whole log. Rows that were recorded before a snapshot are
never written again; a recorder that goes back to one goes on in a copy of its last block. One growing array was
rejected: going back and forth between two snapshots would leave rows of one future in the log of the other.
"""

from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.frames import Array, frozen
from runtime.core.state import State

BLOCK_CYCLES = 128
"""Cycles in a block, an even number: about 0.4 MB of a six-axis arm, which is what going back copies."""
FRAME_CYCLES = 2
"""Cycles from one frame to the next: 16 ms, which is more often than a screen shows pictures of a moving part."""
WHOLE = {"line": np.int32, "number": np.int32, "wrist_mode": np.int8, "tool": np.int32}
"""Signals that are whole numbers."""
SCALARS = ("payload_mass", "line", "number", "wrist_mode", "tool")
"""Signals of a cycle with one number."""

Place = tuple[str, slice | int]
"""Where a signal is in a block: the name of an array, and its columns there."""


def _places(n: int, parts: int) -> dict[str, Place]:
    """Return where the signals of an arm of n axes are."""
    found: dict[str, Place] = {}
    for array, names, width in (
        ("ticks", ("tau_cmd", "tau_sat", "q_fb", "dq_fb", "q_link"), n),
        ("commands", ("q_cmd", "dq_cmd"), n),
        ("cycles", ("q_plan", "D", "T", "read_us"), n),
    ):
        found |= {name: (array, slice(at * width, (at + 1) * width)) for at, name in enumerate(names)}
    found["seam_deviation"] = "cycles", slice(4 * n, 4 * n + 6)
    found |= {name: ("cycles", 4 * n + 6 + at) for at, name in enumerate(SCALARS)}
    return {**found, "parts": ("frames", slice(0, 7 * parts)), "fingers": ("frames", slice(7 * parts, 7 * parts + 2))}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Block:
    """Rows of up to ``BLOCK_CYCLES`` cycles, from ``tick`` and ``cycle`` on, and the block before it."""

    before: "_Block | None"
    tick: int
    cycle: int
    ticks: Array
    commands: Array
    cycles: Array
    frames: Array

    def copy(self) -> "_Block":
        """Return a block that is written on in place of this one."""
        ticks, commands = self.ticks.copy(), self.commands.copy()
        return replace(self, ticks=ticks, commands=commands, cycles=self.cycles.copy(), frames=self.frames.copy())

    def first(self, array: str) -> int:
        """Return the number of the first row of an array."""
        if array in ("ticks", "commands"):
            return self.tick
        return self.cycle if array == "cycles" else self.cycle // FRAME_CYCLES


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Recorded:
    """The rows of a run up to some tick, which stay while the recorder goes on: ``runtime.control.signals.Rows``."""

    blocks: tuple[_Block, ...]
    places: dict[str, Place]
    first_link: Array
    parts: int
    ticks: int
    cycles: int
    ticks_per_cycle: int
    tick_us: int
    tools: tuple[Array, ...]

    @property
    def frames(self) -> int:
        """Frames recorded so far."""
        return -(-self.cycles // FRAME_CYCLES)

    def read(self, name: str, first: int, last: int) -> Array:
        """Return rows ``first`` to before ``last`` of a signal, of the base in which it is recorded."""
        if name == "q_link" and first < last:
            # a row has the link angle at the end of its tick; the log gives it, like all the rest, at the start
            after = self._gathered(name, max(first - 1, 0), last - 1)
            return after if first else np.concatenate([self.first_link[None], after])
        values = self._gathered(name, first, last)
        return values.reshape(len(values), self.parts, 7) if name == "parts" else values

    def _gathered(self, name: str, first: int, last: int) -> Array:
        array, columns = self.places[name]
        # never without a piece: the columns of a run without a row have a shape, too
        pieces = [values[..., columns] for values in self._pieces(array, first, max(first, last))]
        return np.concatenate(pieces).astype(WHOLE.get(name, pieces[0].dtype), copy=False)

    def _pieces(self, array: str, first: int, last: int) -> Iterator[Array]:
        starts = [block.first(array) for block in self.blocks]
        for at in range(max(0, bisect_right(starts, first) - 1), len(starts)):
            end = min(last, starts[at + 1]) if at + 1 < len(starts) else last
            yield getattr(self.blocks[at], array)[max(0, first - starts[at]) : max(0, end - starts[at])]
            if end == last:
                break


class Recorder:
    """Collects what a run of a robot with n axes is made of."""

    def __init__(self, n: int, ticks_per_cycle: int, tick_us: int, parts: int = 0) -> None:
        """``parts``: how many parts the cell has. ``begin`` says where the run starts."""
        self.n = n
        self._parts = parts
        self._first_link = frozen(np.zeros(n))
        self._tools: tuple[Array, ...] = (frozen(np.eye(4)),)
        self._tool = 0
        self._ticks_per_cycle = ticks_per_cycle
        self._tick_us = tick_us
        self.tick = 0
        """Ticks recorded so far."""
        self.cycle = 0
        """Cycles begun so far."""
        self._block = self._new_block(None)

    def begin(self, q_link: Array, X_flange_tool: Array) -> None:
        """Take the true link angles (n,) rad at the start of the run, and its first tool (4, 4)."""
        self._first_link, self._tools = frozen(q_link), (frozen(X_flange_tool),)

    def use_tool(self, X_flange_tool: Array) -> None:
        """Take the tool (4, 4) of the cycles that follow."""
        same = [at for at, X in enumerate(self._tools) if np.array_equal(X, X_flange_tool)]
        if not same:
            self._tools += (frozen(X_flange_tool),)
        self._tool = same[0] if same else len(self._tools) - 1

    def begin_cycle(
        self,
        vectors: tuple[Array, ...],
        motion: Array,
        scalars: tuple[float, int, int, int],
        moved: Callable[[], Array] | None = None,
    ) -> None:
        """Record what is constant in a cycle and the commanded motion (3, ticks, n) of its ticks.

        ``vectors``: q_plan, D, T, time of reading us, each (n,), and the seam's deviation (6,); ``scalars``: mass
        declared, line, line number, wrist_mode; ``moved`` as of the plant, called where a frame is due.
        """
        block = self._block
        if self.cycle - block.cycle == BLOCK_CYCLES:
            block = self._block = self._new_block(block)
        at = self.cycle - block.cycle
        row = block.cycles[at]
        np.concatenate(vectors, out=row[:-5])
        row[-5:-1], row[-1] = scalars, self._tool
        if not at % FRAME_CYCLES and moved is not None:
            block.frames[at // FRAME_CYCLES] = moved()
        self.cycle += 1
        at = self.tick - block.tick
        commands = block.commands[at : at + self._ticks_per_cycle]
        commands[:, : self.n], commands[:, self.n :] = motion[0], motion[1]

    def record(self, parts: tuple[Array, Array, Array, Array, Array]) -> None:
        """Record one tick: (tau_cmd, tau_sat, q_fb, dq_fb) and the true link angles at its end, each (n,)."""
        block = self._block
        np.concatenate(parts, out=block.ticks[self.tick - block.tick])
        self.tick += 1

    def recent(self, ticks: int) -> Array:
        """Return at most the last ``ticks`` rows (ticks, 4 n) of (tau_cmd, tau_sat, q_fb, dq_fb), to be read only."""
        first, block = max(0, self.tick - ticks), self._block
        # nearly always in one block, and then a view of it: this is read in every cycle
        if first >= block.tick:
            return block.ticks[first - block.tick : self.tick - block.tick, : 4 * self.n]
        gathered = np.concatenate([block.ticks[:filled] for block, filled, _ in self._filled(first)])
        return gathered[len(gathered) - (self.tick - first) :, : 4 * self.n]

    def snapshot(self) -> State:
        """Return a mark in the log: its last block and how far that is filled."""
        return State(
            owner=type(self), values=(self._block, self.tick, self.cycle, self._first_link, self._tools, self._tool)
        )

    def restore(self, state: State) -> None:
        """Go back, or on, to a mark: the log is the one that led there."""
        state.check(self)
        block, self.tick, self.cycle, self._first_link, self._tools, self._tool = state.values
        self._block = block.copy()

    def _new_block(self, before: _Block | None) -> _Block:
        ticks = BLOCK_CYCLES * self._ticks_per_cycle
        return _Block(
            before=before,
            tick=self.tick,
            cycle=self.cycle,
            ticks=np.zeros((ticks, 5 * self.n)),
            commands=np.zeros((ticks, 2 * self.n)),
            cycles=np.zeros((BLOCK_CYCLES, 4 * self.n + 6 + len(SCALARS))),  # four vectors, six of the seam
            frames=np.zeros((BLOCK_CYCLES // FRAME_CYCLES, 7 * self._parts + 2), dtype=np.float32),
        )

    def _filled(self, first: int = 0) -> list[tuple[_Block, int, int]]:
        """Return the blocks that hold tick ``first`` and later ones, with the ticks and the cycles that each holds."""
        found: list[tuple[_Block, int, int]] = []
        block: _Block | None = self._block
        end_tick, end_cycle = self.tick, self.cycle
        while block is not None and end_tick > first:
            found.append((block, end_tick - block.tick, end_cycle - block.cycle))
            end_tick, end_cycle, block = block.tick, block.cycle, block.before
        return found[::-1]

    def recorded(self) -> Recorded:
        """Return all rows up to now."""
        return Recorded(
            blocks=tuple(block for block, _, _ in self._filled(-1)),  # not 0: a run without a tick has its block too
            places=_places(self.n, self._parts),
            first_link=self._first_link,
            parts=self._parts,
            ticks=self.tick,
            cycles=-(-self.tick // self._ticks_per_cycle),  # one may have begun whose first tick failed
            ticks_per_cycle=self._ticks_per_cycle,
            tick_us=self._tick_us,
            tools=self._tools,
        )
