"""How far an executor has come, as plain data that a snapshot copies."""

from dataclasses import dataclass
from enum import Enum, auto
from typing import Any, TypeAlias

from robolang.execution.target import Requested
from robolang.interpreter.effects import Effect, MoveTo, Origin
from robolang.interpreter.events import Done, Failed, FedEnded, LineBegun
from robolang.interpreter.positions import Suspended
from robolang.interpreter.snapshot import MachineSnapshot
from runtime.core.faults import Fault
from runtime.core.frames import Array

BY_HAND = "by hand"
"""The name of the text in which set-points of no statement have their place."""


class Phase(Enum):
    """What an executor does next."""

    READY = auto()  # the program goes on
    BUSY = auto()  # an effect has been started
    STOPPING = auto()  # an alarm: the arm comes to rest
    OVER = auto()


@dataclass(frozen=True, slots=True, kw_only=True)
class PlayEnded:
    """Set-points that were given have been sent: the program stands where it stood."""


End: TypeAlias = Done | Failed | FedEnded | LineBegun | PlayEnded
"""What comes after motion besides effects; ``LineBegun``: the program is paused before that statement."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Aside:
    """What a statement that is fed, or set-points that are played, interrupt: a wait, or a motion at rest on its path.

    ``left`` of it on the target, ``depth`` of the machine when it is taken up again; of a motion ``q`` (n,) rad, where
    its path was left, and ``again``, the machine at the statement that moved (``Progress.again``).
    """

    depth: int
    doing: tuple[Effect, ...]
    request: Effect | None
    due: Effect | End | None
    statement: Origin | None
    left: Any
    q: Array
    places: tuple[MachineSnapshot, ...]
    again: MachineSnapshot | None

    @property
    def is_motion(self) -> bool:
        """Whether it is a motion, which is resumed only where its path was left."""
        return any(isinstance(each, MoveTo) for each in self.doing)


@dataclass(slots=True, kw_only=True)
class Progress:
    """All of an executor that changes, besides machine, world and target.

    ``request``: the effect that the program has yielded last; ``doing``: the effects that have been started; ``chain``:
    moves that are kept, since the next one may blend into them, and take ``chain_s`` s at their speeds; ``places``:
    the machine at each of these, or of those that are being done; ``due``: what comes when these have ended;
    ``growing``: more moves are requested for those that run, which then do not stop; ``late``: a request among them
    that is refused when they have ended. ``aside``: what is interrupted, the innermost last; ``playing``: set-points
    that were given are being sent.
    ``ends_us``: the simulated time at which the run is too long.

    ``begun``: an effect of the program has been requested; ``stood`` (n,) rad: where the arm was when it was moved by
    set-points between two statements, until the program goes on.

    ``again``: the machine at the statement that an alarm has interrupted, None: where it is; ``failed``: that place,
    once the alarm has been acknowledged.
    """

    ends_us: int
    phase: Phase = Phase.READY
    request: Effect | None = None
    doing: tuple[Effect, ...] = ()
    chain: tuple[Requested, ...] = ()
    chain_s: float = 0.0
    places: tuple[MachineSnapshot, ...] = ()
    due: Effect | End | None = None
    growing: bool = False
    late: Fault | None = None
    aside: tuple[Aside, ...] = ()
    playing: bool = False
    begun: bool = False
    stood: Array | None = None
    tracked: bool = False
    pausing: bool = False
    resting: bool = False
    resumed: bool = False
    stop_requested: bool = False
    halt_requested: bool = False
    fault: Failed | None = None
    again: MachineSnapshot | None = None
    failed: Suspended | None = None

    @property
    def grows(self) -> bool:
        """Whether the program may go on: nothing waits for the end of a motion."""
        return self.due is None and self.late is None

    @property
    def moves(self) -> bool:
        """Whether what has been started is a move of the program."""
        return any(isinstance(each, MoveTo) for each in self.doing)

    def keep(self, move: Requested, place: MachineSnapshot) -> None:
        """Keep a move, with the machine at it, after those that are kept or run."""
        # it runs when the machine is further on: where it was is kept (``Engine.interrupted_at``)
        self.places = (*(self.places if self.chain or self.growing else ()), place)
        self.chain = (*self.chain, move)
