"""The signals of a run by name: those that are recorded, and those that follow from them, computed when they are read.

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
``tool_cmd``              m       commanded tool point, (3,)
``tool_error``            m       distance of the true tool point from it
``tool_speed``            m/s     speed of the true tool point
``frame_t``               s       time of a frame
``parts``                 m, -    pose of each part, (m, 7): x y z and quaternion w x y z, world frame
``fingers``               m       distance of each finger pad from the tool point, (2,)
========================  ======  ==========================================================================

The last three have a row for each frame, all others one for each servo tick. Poses of the tool are of the tool that is
in use (TOOL). Any span of ticks can be computed alone, and gives the same bytes as the whole.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from runtime.control.blocks import FRAME_CYCLES
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.robot.kinematics.chain import Chain

Base = Literal["tick", "frame"]

PIECE = 16_384
"""Poses that are computed at once: a few MB, in place of some times the whole signal."""
KEPT = 4_000_000
"""A signal of at most so many bytes is kept, since programs read it again and again: a minute of a six-axis arm."""

OF_TICKS = frozenset(("q_cmd", "dq_cmd", "tau_cmd", "tau_sat", "q_fb", "dq_fb", "q_link"))
"""Recorded signals with one row a tick."""
OF_CYCLES = ("q_plan", "D", "T", "payload_mass", "line", "number", "wrist_mode", "seam_deviation")
"""Recorded signals with one row a cycle."""
OF_FRAMES = ("frame_t", "parts", "fingers")
"""Signals with one row a frame."""


class Rows(Protocol):
    """What is recorded of a run; ``read`` gives rows of one signal in its base. ``tools`` are X_flange_tool (4, 4)."""

    @property
    def ticks(self) -> int:
        """Ticks of the run."""

    @property
    def cycles(self) -> int:
        """Cycles, the last one perhaps not whole."""

    @property
    def frames(self) -> int:
        """Frames, each at the start of every second cycle."""

    @property
    def ticks_per_cycle(self) -> int:
        """Ticks in a cycle."""

    @property
    def tick_us(self) -> int:
        """Duration of a tick, us."""

    @property
    def tools(self) -> tuple[Array, ...]:
        """The tools that have been used, X_flange_tool (4, 4)."""

    def read(self, name: str, first: int, last: int) -> Array:
        """Return rows ``first`` to before ``last`` of a recorded signal."""


class Signals(Mapping[str, Array]):
    """Arrays by name, computed when they are read; first dimension ticks, or frames (``base``)."""

    def __init__(self, rows: Rows, chain: Chain) -> None:
        self._rows, self._chain = rows, chain
        self._known: dict[str, Array] = {}

    @property
    def rows(self) -> Rows:
        """What is recorded."""
        return self._rows

    def __getitem__(self, name: str) -> Array:
        """Return a whole signal; ``KeyError``."""
        if name not in self._known:
            whole = self.span(name, 0, self.count(name))
            if whole.nbytes > KEPT:
                return whole
            whole.setflags(write=False)  # everybody who reads it has the same array
            self._known[name] = whole
        return self._known[name]

    def __iter__(self) -> Iterator[str]:
        """Yield the names, those of ticks first."""
        return iter(_MADE)

    def __len__(self) -> int:
        """Return how many signals there are."""
        return len(_MADE)

    def __contains__(self, name: object) -> bool:
        """Return whether there is such a signal, without computing it."""
        return name in _MADE

    def base(self, name: str) -> Base:
        """Return what a row of a signal is."""
        return "frame" if name in OF_FRAMES else "tick"

    def count(self, name: str) -> int:
        """Return how many rows a signal has."""
        return self._rows.frames if self.base(name) == "frame" else self._rows.ticks

    def span(self, name: str, first: int, last: int) -> Array:
        """Return rows ``first`` to before ``last`` of a signal, computed without the others; ``KeyError``."""
        # of an angle that is not finite follow poses of NaN, which say enough
        with np.errstate(invalid="ignore", over="ignore"):
            return np.ascontiguousarray(_maker(name)(self, first, last))

    def each_cycle(self, name: str) -> Array:
        """Return a signal of ``OF_CYCLES`` with one row for each cycle, where ``self[name]`` repeats it each tick."""
        return self._rows.read(name, 0, self._rows.cycles)

    def tool_poses(self, q: Array, first: int) -> Array:
        """Return X_world_tool (N, 4, 4) at joint angles q (N, n) rad of the ticks from ``first`` on."""
        poses = np.empty((len(q), 4, 4))
        for at in range(0, len(q), PIECE):
            X = self._chain.flange(q[at : at + PIECE])
            tools = self._of_cycle("tool", first + at, first + at + len(X))
            # nearly always one tool, and then one product for all
            for tool in sorted(set(tools.tolist())):
                rows = np.flatnonzero(tools == tool)
                poses[at + rows] = matmul(X[rows], self._rows.tools[tool])
        return poses

    def tool_points(self, name: str, first: int, last: int) -> Array:
        """Return the tool point (N, 3), m in the world, at joint angles ``name`` of ticks ``first`` to before ``last``.

        Where no orientation is needed: much quicker than ``tool_poses``, whose last bits differ.
        """
        return self.points_at(self._rows.read(name, first, last), np.arange(first, last))

    def points_at(self, q: Array, ticks: NDArray[np.int64]) -> Array:
        """Return the tool point (N, 3), m in the world, at joint angles q (N, n) rad of ticks (N,) in order."""
        points = np.empty((len(q), 3))
        if not len(q):
            return points
        cycles = ticks // self._rows.ticks_per_cycle
        tools = self._rows.read("tool", int(cycles[0]), int(cycles[-1]) + 1)[cycles - cycles[0]]
        with np.errstate(invalid="ignore", over="ignore"):
            for tool in sorted(set(tools.tolist())):
                rows = np.flatnonzero(tools == tool)
                points[rows] = self._chain.points(q[rows], self._rows.tools[tool][:3, 3])
        return points

    def _of_tick(self, name: str, first: int, last: int) -> Array:
        return self._rows.read(name, first, last)

    def _of_cycle(self, name: str, first: int, last: int) -> Array:
        ticks = self._rows.ticks_per_cycle
        # whole cycles are read, and the ticks before and after are cut off
        start = first // ticks
        rows = self._rows.read(name, start, max(start, -(-last // ticks)))
        return np.repeat(rows, ticks, axis=0)[first - start * ticks : last - start * ticks]

    def _t_us(self, first: int, last: int) -> Array:
        return np.arange(first, last, dtype=np.float64) * self._rows.tick_us

    def _t(self, first: int, last: int) -> Array:
        return self._t_us(first, last) * 1e-6

    def _age(self, first: int, last: int) -> Array:
        return np.asarray((self._t_us(first, last)[:, None] - self._of_cycle("read_us", first, last)) * 1e-3)

    def _poses(self, name: str, first: int, last: int) -> Array:
        return self.tool_poses(self._rows.read(name, first, last), first)

    def _tool_cmd(self, first: int, last: int) -> Array:
        return self._poses("q_cmd", first, last)[:, :3, 3]

    def _tool_error(self, first: int, last: int) -> Array:
        return _lengths(self._tool_cmd(first, last) - self._poses("q_link", first, last)[:, :3, 3])

    def _tool_speed(self, first: int, last: int) -> Array:
        q = self._rows.read("q_link", max(first - 1, 0), last)
        # the arm stands at the start; both ends with the tool of the later tick: a change of the tool is no motion
        before = q[:-1] if first else np.concatenate([q[:1], q[:-1]])
        moved = (self.tool_poses(each, first)[:, :3, 3] for each in (q[len(q) - len(before) :], before))
        return _lengths(next(moved) - next(moved)) / (self._rows.tick_us * 1e-6)

    def _frame_t(self, first: int, last: int) -> Array:
        frame_us = FRAME_CYCLES * self._rows.ticks_per_cycle * self._rows.tick_us
        return np.arange(first, last, dtype=np.float64) * frame_us * 1e-6


def _lengths(vectors: Array) -> Array:
    """Return the lengths (N,) of vectors (N, 3)."""
    return np.asarray(np.sqrt((vectors * vectors).sum(axis=1)))


_Make = Callable[[Signals, int, int], Array]


def _recorded(name: str) -> _Make:
    if name in OF_CYCLES:
        return lambda signals, first, last: signals._of_cycle(name, first, last)
    return lambda signals, first, last: signals._of_tick(name, first, last)


def _posed(name: str) -> _Make:
    return lambda signals, first, last: signals._poses(name, first, last)


_MADE: dict[str, _Make] = {
    "t": Signals._t,
    **{name: _recorded(name) for name in ("q_plan", "q_cmd", "dq_cmd", "tau_cmd", "tau_sat", "q_fb", "dq_fb")},
    "X_world_tool_fb": _posed("q_fb"),
    "q_link": _recorded("q_link"),
    "X_world_tool": _posed("q_link"),
    **{name: _recorded(name) for name in ("D", "T")},
    "D_age": Signals._age,
    "T_age": Signals._age,
    **{name: _recorded(name) for name in OF_CYCLES[3:]},
    "tool_cmd": Signals._tool_cmd,
    "tool_error": Signals._tool_error,
    "tool_speed": Signals._tool_speed,
    "frame_t": Signals._frame_t,
    "parts": _recorded("parts"),
    "fingers": _recorded("fingers"),
}
"""How each signal is made, in the order of a log."""


def _maker(name: str) -> _Make:
    if name not in _MADE:
        raise KeyError(f"there is no signal {name!r}; these are known: {', '.join(_MADE)}")
    return _MADE[name]


NAMES = tuple(_MADE)
"""All signals, in the order of a log."""
