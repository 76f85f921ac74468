"""Where a program stands between two calls of ``Executor.advance``."""

from dataclasses import dataclass
from enum import Enum

from robolang.interpreter.effects import Origin
from robolang.interpreter.events import Failed
from runtime.core.faults import Alarm


class State(Enum):
    """What a program does between two calls of ``advance``."""

    RUNNING = "running"
    PAUSED = "paused"
    WAITING = "waiting"
    STOPPED = "stopped"
    DONE = "done"
    ALARM = "alarm"


ENDED = frozenset({State.STOPPED, State.DONE, State.ALARM})
"""States from which ``advance`` does not go on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Status:
    """Where a program stands: ``statement`` that is carried out, simulated time, and the ``fault`` that nothing caught:
    the one that ended the program, or the one of the statement that was fed last. ``alarm`` is the latched one that
    stopped the arm first, until it is acknowledged."""

    state: State
    statement: Origin | None
    time_us: int
    fault: Failed | None = None
    alarm: Alarm | None = None
