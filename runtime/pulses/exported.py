"""An export: the content of a folder of pulse tables, once it has been read.

A mechanism whose joints are moved by one pulse channel each, and a sequence of straight moves with markers between
them. A move has a table for each channel that does not stand still; all of them start together, and each runs by
itself, row by row:

    pulses(t) = pulses(row start) +- frequency (t - row start)        until the row's target is reached
    joint     = pulses x pulse equivalent

``runtime.pulses.folder`` makes an ``Export`` of a folder and lets nothing through that cannot be played,
``runtime.pulses.replay`` plays it, ``robolang.pulse_tables.drive`` drives an arm with it.
"""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

import runtime.pulses.codes  # noqa: F401 - registers what is raised here
from runtime.core.frames import Array, frozen
from runtime.core.units import DEG, MM

Kind = Literal["arm", "cartesian", "cylindrical", "scara"]
Unit = Literal["deg", "mm"]
KINDS: tuple[Kind, ...] = ("arm", "cartesian", "cylindrical", "scara")


@dataclass(frozen=True, slots=True, kw_only=True)
class Mechanism:
    """The mechanism that the channels move; ``axes`` are its joints, J1, J2, ... of an arm.

    ``placements`` (4, 4) of each axis of an arm in the frame before it, then ``X_last_flange`` and ``X_flange_tool``
    (4, 4), m; ``sliding`` are the indices of the axes of an arm that slide along z. ``constant`` (3,) m: coordinates
    that no joint moves. ``lengths``: l1 and l2 of a scara, m.
    """

    kind: Kind
    name: str
    axes: tuple[str, ...]
    placements: tuple[Array, ...] = ()
    X_last_flange: Array = field(default_factory=lambda: frozen(np.eye(4)))
    X_flange_tool: Array = field(default_factory=lambda: frozen(np.eye(4)))
    sliding: frozenset[int] = frozenset()
    constant: Array = field(default_factory=lambda: frozen(np.zeros(3)))
    lengths: tuple[float, float] = (0.0, 0.0)

    @property
    def units(self) -> tuple[Unit, ...]:
        """Unit of each joint."""
        return tuple("mm" if axis in "xyzr" or k in self.sliding else "deg" for k, axis in enumerate(self.axes))


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel:
    """A pulse channel: ``per_pulse`` in ``unit``, lowest and highest frequency Hz, position at the start, pulses."""

    name: str
    unit: Unit
    per_pulse: float
    min_hz: float
    max_hz: float
    start_pulses: int

    @property
    def si_per_pulse(self) -> float:
        """Pulse equivalent in rad or m."""
        return self.per_pulse * (DEG if self.unit == "deg" else MM)


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """The rows of a table as they are played, R of them without the last.

    ``frequency`` (R,) Hz, negative when counting down, 0 in a wait; ``steps`` (R,); ``ends`` (R + 1,) s, the time at
    the start and at the end of each row; ``pulses`` (R + 1,), the position then.
    """

    file: str
    frequency: Array
    steps: Array
    ends: Array
    pulses: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """The payload of a LOAD: mass kg, centre of gravity (3,) m in the flange frame."""

    mass: float
    cog: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Marker:
    """A statement between the moves: a ``load``, or a hand that closes or opens and waits ``dwell_s``."""

    line: int
    number: int | None
    text: str
    load: Load | None = None
    hand: Literal["on", "off"] | None = None
    dwell_s: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Move:
    """A straight move of ``steps`` time steps from ``start`` to ``end``, (3,) m each.

    ``tables`` of the M channels, None where a channel stands still; ``first`` and ``last`` (M,), the positions at the
    start and at the end, pulses.
    """

    line: int
    number: int | None
    text: str
    steps: int
    start: Array
    end: Array
    tables: tuple[Table | None, ...]
    first: Array
    last: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Export:
    """A folder of pulse tables: the moves of ``program`` for M ``channels``, in time steps of ``step_s``."""

    program: str
    mechanism: Mechanism
    step_s: float
    channels: tuple[Channel, ...]
    sequence: tuple[Marker | Move, ...]

    @property
    def moves(self) -> tuple[Move, ...]:
        """The moves in their order."""
        return tuple(item for item in self.sequence if isinstance(item, Move))

    @property
    def seconds(self) -> float:
        """Time of the whole program, moves and waiting, s."""
        return sum(item.steps * self.step_s if isinstance(item, Move) else item.dwell_s for item in self.sequence)
