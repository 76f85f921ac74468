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

Memory is bounded: a block that is full and no longer read in every cycle goes into a file without a name, or, where
nobody needs the log (``fold``), is handed over once and dropped.
"""

from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from runtime.control.blocks import BLOCK_CYCLES, FRAME_CYCLES, WHOLE, Block, InMemory, Layout
from runtime.control.spill import Spill
from runtime.core.frames import Array, frozen
from runtime.core.state import State


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Recorded:
    """The rows of a run up to some tick, which stay while the recorder goes on: ``runtime.control.signals.Rows``.

    Reading rows that are in a file may raise ``OSError``.
    """

    blocks: tuple[Block, ...]
    layout: Layout
    first_link: Array
    ticks: int
    tick_us: int
    tools: tuple[Array, ...]

    @property
    def ticks_per_cycle(self) -> int:
        """Ticks in a cycle."""
        return self.layout.ticks_per_cycle

    @property
    def cycles(self) -> int:
        """Cycles recorded so far; one may have begun whose first tick failed, which is not counted."""
        return -(-self.ticks // self.ticks_per_cycle)

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
        return values.reshape(len(values), self.layout.parts, 7) if name == "parts" else values

    def _gathered(self, name: str, first: int, last: int) -> Array:
        # never without a piece: the columns of a run without a row have a shape, too
        pieces = list(self._pieces(name, first, max(first, last)))
        return np.concatenate(pieces).astype(WHOLE.get(name, pieces[0].dtype), copy=False)

    def _pieces(self, name: str, first: int, last: int) -> Iterator[Array]:
        array = self.layout.columns[name].array
        starts = [block.first(array) for block in self.blocks]
        for at in range(max(0, bisect_right(starts, first) - 1), len(starts)):
            end = min(last, starts[at + 1]) if at + 1 < len(starts) else last
            yield self.blocks[at].data.read(name, max(0, first - starts[at]), max(0, end - starts[at]))
            if end == last:
                break


Fold = Callable[[Recorded, int, int], None]
"""What takes the rows of the ticks from one to before another, which are then dropped."""


class Recorder:
    """Collects what a run of a robot with n axes is made of."""

    def __init__(self, n: int, ticks_per_cycle: int, tick_us: int, parts: int = 0) -> None:
        """``parts``: how many parts the cell has. ``begin`` says where the run starts."""
        self.n = n
        self._layout = Layout(n=n, parts=parts, ticks_per_cycle=ticks_per_cycle)
        self._first_link = frozen(np.zeros(n))
        self._tools: tuple[Array, ...] = (frozen(np.eye(4)),)
        self._tool = 0
        self._ticks_per_cycle = ticks_per_cycle
        self._tick_us = tick_us
        self.tick = 0
        """Ticks recorded so far."""
        self.cycle = 0
        """Cycles begun so far."""
        self.spill = Spill()
        """Where old blocks go; replaced before the run."""
        self.fold: Fold | None = None
        """What takes old blocks in place of the file; set before the run."""
        self.failed: OSError | None = None
        """Why old blocks stay in memory: the file could not be written."""
        self._data = InMemory.empty(self._layout)
        self._block = Block(before=None, tick=0, cycle=0, data=self._data)

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
        if self.cycle - self._block.cycle == BLOCK_CYCLES:
            self._next_block()
        data, at = self._data, self.cycle - self._block.cycle
        row = data.cycles[at]
        np.concatenate(vectors, out=row[:-5])
        row[-5:-1], row[-1] = scalars, self._tool
        if not at % FRAME_CYCLES and moved is not None:
            data.frames[at // FRAME_CYCLES] = moved()
        self.cycle += 1
        at = self.tick - self._block.tick
        commands = data.commands[at : at + self._ticks_per_cycle]
        commands[:, : self.n], commands[:, self.n :] = motion[0], motion[1]

    def record(self, parts: tuple[Array, Array, Array, Array, Array]) -> None:
        """Record one tick: (tau_cmd, tau_sat, q_fb, dq_fb) and the true link angles at its end, each (n,)."""
        np.concatenate(parts, out=self._data.ticks[self.tick - self._block.tick])
        self.tick += 1

    def recent(self, ticks: int) -> Array:
        """Return at most the last ``ticks`` rows (ticks, 4 n) of (tau_cmd, tau_sat, q_fb, dq_fb), to be read only."""
        first, block = max(0, self.tick - ticks), self._block
        # nearly always in one block, and then a view of it: this is read in every cycle
        if first >= block.tick:
            return self._data.ticks[first - block.tick : self.tick - block.tick, : 4 * self.n]
        rows = self._recorded(first)
        names = ("tau_cmd", "tau_sat", "q_fb", "dq_fb")
        return np.concatenate([rows.read(name, first, self.tick) for name in names], axis=1)

    def recorded(self) -> Recorded:
        """Return all rows up to now, or those that are still there."""
        return self._recorded(0)

    def latest(self) -> Recorded:
        """Return the rows of at least the last two ticks, without those of long ago: they show where a run stands."""
        return self._recorded(max(0, self.tick - 2))

    def _recorded(self, first: int) -> Recorded:
        """Return the rows from the block on that holds tick ``first``."""
        found = [self._block]
        while found[-1].tick > first and (before := found[-1].before) is not None:
            found.append(before)
        return Recorded(
            blocks=tuple(found[::-1]),
            layout=self._layout,
            first_link=self._first_link,
            ticks=self.tick,
            tick_us=self._tick_us,
            tools=self._tools,
        )

    def snapshot(self) -> State:
        """Return a mark in the log: its last block and how far that is filled."""
        if self.fold is not None:
            raise RuntimeError("a run that does not keep its log cannot go back")
        return State(
            owner=type(self), values=(self._block, self.tick, self.cycle, self._first_link, self._tools, self._tool)
        )

    def restore(self, state: State) -> None:
        """Go back, or on, to a mark: the log is the one that led there."""
        state.check(self)
        block, self.tick, self.cycle, self._first_link, self._tools, self._tool = state.values
        self._data = block.data.copy()
        self._block = Block(before=block.before, tick=block.tick, cycle=block.cycle, data=self._data)

    def _next_block(self) -> None:
        full = self._block
        self._data = InMemory.empty(self._layout)
        self._block = Block(before=full, tick=self.tick, cycle=self.cycle, data=self._data)
        # the block before stays: what judges a cycle reads the rows of the last ones
        old = full.before
        if old is None:
            return
        if self.fold is not None:
            # with a tick more: the first link angle of a block is in the block before it
            self.fold(self._recorded(max(0, old.tick - 1)), old.tick, full.tick)
            old.before = None
        elif self.failed is None and isinstance(old.data, InMemory):
            try:
                old.data = old.data.sealed(self.spill)
            except OSError as error:
                self.failed = error
