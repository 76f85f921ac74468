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

The hot path copies one row of five vectors per tick and one row per cycle into arrays that grow by doubling; what
follows from them is computed once, at the end. Two runs of the same program give the same bytes.
"""

from collections.abc import Callable

import numpy as np

from runtime.core.frames import Array

_FIRST_ROWS = 8192


class Recorder:
    """Collects the signals of one run of a robot with n axes."""

    def __init__(self, n: int, ticks_per_cycle: int, tick_us: int, q_link: Array | None = None) -> None:
        """``q_link`` (n,) rad: the true link angles at the start of the run (None: zero)."""
        self.n = n
        self._first_link = np.zeros(n) if q_link is None else np.array(q_link)
        self._ticks_per_cycle = ticks_per_cycle
        self._tick_us = tick_us
        self._ticks = np.zeros((_FIRST_ROWS, 5 * n))
        self._commands = np.zeros((_FIRST_ROWS, 2 * n))
        self._cycles = np.zeros((_FIRST_ROWS // ticks_per_cycle + 1, 4 * n + 10))
        self.tick = 0
        """Ticks recorded so far."""
        self.cycle = 0
        """Cycles begun so far."""

    def begin_cycle(self, vectors: tuple[Array, ...], motion: Array, scalars: tuple[float, int, int, int]) -> None:
        """Record what is constant in a cycle and the commanded motion (3, ticks, n) of its ticks.

        ``vectors``: q_plan, D, T, time of reading us, each (n,), and the seam's deviation (6,); ``scalars``: mass
        declared, line, line number, wrist_mode.
        """
        if self.cycle == len(self._cycles):
            self._cycles = np.concatenate([self._cycles, np.zeros_like(self._cycles)])
        row = self._cycles[self.cycle]
        np.concatenate(vectors, out=row[:-4])
        row[-4:] = scalars
        self.cycle += 1
        end = self.tick + self._ticks_per_cycle
        if end > len(self._ticks):
            self._ticks = np.concatenate([self._ticks, np.zeros_like(self._ticks)])
            self._commands = np.concatenate([self._commands, np.zeros_like(self._commands)])
        self._commands[self.tick : end, : self.n] = motion[0]
        self._commands[self.tick : end, self.n :] = motion[1]

    def record(self, parts: tuple[Array, Array, Array, Array, Array]) -> None:
        """Record one tick: (tau_cmd, tau_sat, q_fb, dq_fb) and the true link angles at its end, each (n,)."""
        np.concatenate(parts, out=self._ticks[self.tick])
        self.tick += 1

    def recent(self, ticks: int) -> Array:
        """Return at most the last ``ticks`` rows (ticks, 4 n) of (tau_cmd, tau_sat, q_fb, dq_fb): a live view."""
        return self._ticks[max(0, self.tick - ticks) : self.tick, : 4 * self.n]

    def signals(self, tool_poses: Callable[[Array], Array]) -> dict[str, Array]:
        """Return every signal by name; ``tool_poses`` maps joint angles (N, n) to poses (N, 4, 4)."""
        n, ticks = self.n, self.tick
        cycles = np.repeat(self._cycles[: self.cycle], self._ticks_per_cycle, axis=0)[:ticks]
        t_us = np.arange(ticks, dtype=np.int64) * self._tick_us
        age_ms = (t_us[:, None] - cycles[:, 3 * n : 4 * n]) * 1e-3
        tick = self._ticks[:ticks]
        q_fb = tick[:, 2 * n : 3 * n]
        q_link = np.concatenate([self._first_link[None], tick[:, 4 * n :]])[:ticks]
        signals = {
            "t": t_us * 1e-6,
            "q_plan": cycles[:, :n],
            "q_cmd": self._commands[:ticks, :n],
            "dq_cmd": self._commands[:ticks, n:],
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
