"""How far an executor has come, as plain data that a snapshot copies."""

from dataclasses import dataclass
from enum import Enum, auto
from typing import Any, TypeAlias

from robolang.execution.target import Requested
from robolang.interpreter.effects import Effect, Origin
from robolang.interpreter.events import Done, Failed, FedEnded


class Phase(Enum):
    """What an executor does next."""

    READY = auto()  # the program goes on
    BUSY = auto()  # an effect has been started
    STOPPING = auto()  # an alarm: the arm comes to rest
    OVER = auto()


End: TypeAlias = Done | Failed | FedEnded


@dataclass(frozen=True, slots=True, kw_only=True)
class Aside:
    """A DELAY, a WAIT or the dwell of a HAND that a fed statement interrupts: what is ``left`` of it on the target.

    ``depth``: of the machine, when it is taken up again.
    """

    depth: int
    doing: tuple[Effect, ...]
    statement: Origin | None
    left: Any


@dataclass(slots=True, kw_only=True)
class Progress:
    """All of an executor that changes, besides machine, world and target.

    ``request``: the effect that the program has yielded last; ``doing``: the effects that have been started; ``chain``:
    moves that are kept, since the next one may blend into them; ``due``: what comes when these have ended; ``aside``:
    waits that statements which are fed interrupt, the innermost last. ``ends_us``: the simulated time at which the run
    is too long.
    """

    ends_us: int
    phase: Phase = Phase.READY
    request: Effect | None = None
    doing: tuple[Effect, ...] = ()
    chain: tuple[Requested, ...] = ()
    due: Effect | End | None = None
    aside: tuple[Aside, ...] = ()
    tracked: bool = False
    pausing: bool = False
    resting: bool = False
    resumed: bool = False
    fault: Failed | None = None
