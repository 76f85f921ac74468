"""The recorder: every named signal of a run, as one array each whose first dimension is the servo tick.

========================  ======  ==========================================================================
signal                    unit    meaning
========================  ======  ==========================================================================
``t``                     s       start of the tick
``q_plan``                rad     set-point in force, sent every 8 ms
``q_cmd`` ``dq_cmd``      rad     command of the tick after fine interpolation, and its speed (rad/s)
``tau_cmd``               N m     torque that the servo law asks for, at the joint
``tau_sat``               N m     torque that the motor gives, after current limit and current loop
``q_fb`` ``dq_fb``        rad     detected angle, and speed from its differences (rad/s)
``X_world_tool_fb``       m       pose of the tool from the detected angles, (4, 4)
``q_link``                rad     true angle of the link, beyond the gear spring where there is one
``X_world_tool``          m       true pose of the tool, from the true angles, (4, 4)
``D`` ``T``               kg m2   inertia and gravity torque (N m) in use, without the rotor
``D_age`` ``T_age``       ms      time since the angles were read from which they were computed
``payload_mass``          kg      mass declared by LOAD
``line`` ``number``       -       line of the file that runs, and its line number (0: none)
``wrist_mode``            -       0: wrist follows the path, 1: goes to its end angles, 2: with components held
``seam_deviation``        m, rad  what the seam sensor adds to the path, (6,), world frame
========================  ======  ==========================================================================

The hot path copies one row of five vectors per tick and one row per cycle into blocks; what follows from them is
computed once, at the end. Two runs of the same program give the same bytes.

A snapshot holds the block that is being filled and how far it is filled, and through it all blocks before: it copies
no row, and a controller that takes the snapshot over has the whole log. Rows that were recorded before a snapshot are
never written again; a recorder that goes back to one goes on in a copy of its last block. One growing array was
rejected: going back and forth between two snapshots would leave rows of one future in the log of the other.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from runtime.core.frames import Array
from runtime.core.state import State

BLOCK_CYCLES = 128
"""Cycles in a block: about 0.4 MB of a six-axis arm, which is what going back copies."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Block:
    """Rows of up to ``BLOCK_CYCLES`` cycles, from ``tick`` and ``cycle`` on, and the block before it."""

    before: "_Block | None"
    tick: int
    cycle: int
    ticks: Array
    commands: Array
    cycles: Array

    def copy(self) -> "_Block":
        return replace(self, ticks=self.ticks.copy(), commands=self.commands.copy(), cycles=self.cycles.copy())


class Recorder:
    """Collects the signals of one run of a robot with n axes."""

    def __init__(self, n: int, ticks_per_cycle: int, tick_us: int, q_link: Array | None = None) -> None:
        """``q_link`` (n,) rad: the true link angles at the start of the run (None: zero)."""
        self.n = n
        self._first_link = np.zeros(n) if q_link is None else np.array(q_link)
        self._ticks_per_cycle = ticks_per_cycle
        self._tick_us = tick_us
        self.tick = 0
        """Ticks recorded so far."""
        self.cycle = 0
        """Cycles begun so far."""
        self._block = self._new_block(None)

    def begin_cycle(self, vectors: tuple[Array, ...], motion: Array, scalars: tuple[float, int, int, int]) -> None:
        """Record what is constant in a cycle and the commanded motion (3, ticks, n) of its ticks.

        ``vectors``: q_plan, D, T, time of reading us, each (n,), and the seam's deviation (6,); ``scalars``: mass
        declared, line, line number, wrist_mode.
        """
        block = self._block
        if self.cycle - block.cycle == BLOCK_CYCLES:
            block = self._block = self._new_block(block)
        row = block.cycles[self.cycle - block.cycle]
        np.concatenate(vectors, out=row[:-4])
        row[-4:] = scalars
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
        return State(owner=type(self), values=(self._block, self.tick, self.cycle, self._first_link))

    def restore(self, state: State) -> None:
        """Go back, or on, to a mark: the log is the one that led there."""
        state.check(self)
        block, self.tick, self.cycle, self._first_link = state.values
        self._block = block.copy()

    def _new_block(self, before: _Block | None) -> _Block:
        ticks = BLOCK_CYCLES * self._ticks_per_cycle
        return _Block(
            before=before,
            tick=self.tick,
            cycle=self.cycle,
            ticks=np.zeros((ticks, 5 * self.n)),
            commands=np.zeros((ticks, 2 * self.n)),
            cycles=np.zeros((BLOCK_CYCLES, 4 * self.n + 10)),  # four vectors, six of the seam, four scalars
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

    def signals(self, tool_poses: Callable[[Array], Array]) -> dict[str, Array]:
        """Return every signal by name; ``tool_poses`` maps joint angles (N, n) to poses (N, 4, 4)."""
        n, ticks = self.n, self.tick
        filled = self._filled(-1)  # not 0: a run without a tick has its block as well
        cycles = np.concatenate([block.cycles[:count] for block, _, count in filled])
        cycles = np.repeat(cycles, self._ticks_per_cycle, axis=0)[:ticks]
        t_us = np.arange(ticks, dtype=np.int64) * self._tick_us
        age_ms = (t_us[:, None] - cycles[:, 3 * n : 4 * n]) * 1e-3
        tick = np.concatenate([block.ticks[:count] for block, count, _ in filled])
        commands = np.concatenate([block.commands[:count] for block, count, _ in filled])
        q_fb = tick[:, 2 * n : 3 * n]
        # a row has the link angle at the end of its tick; the log gives it, like all the rest, at the start
        q_link = np.concatenate([self._first_link[None], tick[:, 4 * n :]])[:ticks]
        signals = {
            "t": t_us * 1e-6,
            "q_plan": cycles[:, :n],
            "q_cmd": commands[:, :n],
            "dq_cmd": commands[:, n:],
            "tau_cmd": tick[:, :n],
            "tau_sat": tick[:, n : 2 * n],
            "q_fb": q_fb,
            "dq_fb": tick[:, 3 * n : 4 * n],
            "X_world_tool_fb": tool_poses(q_fb),
            "q_link": q_link,
            "X_world_tool": tool_poses(q_link),
            "D": cycles[:, n : 2 * n],
            "T": cycles[:, 2 * n : 3 * n],
            "D_age": age_ms,
            "T_age": age_ms.copy(),
            "payload_mass": cycles[:, -4],
            "line": cycles[:, -3].astype(np.int32),
            "number": cycles[:, -2].astype(np.int32),
            "wrist_mode": cycles[:, -1].astype(np.int8),
            "seam_deviation": cycles[:, 4 * n : 4 * n + 6],
        }
        return {name: np.ascontiguousarray(values) for name, values in signals.items()}
