"""Two priorities on one virtual processor: the 8 ms cycle, and a background task in the time that is left.

Time is counted in whole microseconds. A cycle starts with its interrupt; the foreground (interpolation) then takes
its declared cost Ci, and the background task gets what is left of the period, a slice at a time between servo
ticks. A step of the background whose cost exceeds the slice is suspended and goes on, with what was already paid,
in the next one. So the cycle keeps its period whatever the background costs, and one axis is refreshed every
``n Cd P / (P - Ci)`` on average (docs/timing.md).
"""

from typing import Protocol

from runtime.core.state import State, Stateful


class Task(Protocol):
    """A background task that never ends, as steps with declared costs."""

    @property
    def cost_us(self) -> int:
        """Cost of the step that comes next, us."""

    def work(self, now_us: int) -> None:
        """Carry out that step; it ends at ``now_us``."""

    def snapshot(self) -> State:
        """Return the state of the task."""

    def restore(self, state: State) -> None:
        """Put a state back."""


class IdleProcessor(Stateful):
    """Runs one background task of priority 2 in the idle time of the cycles."""

    VALUES = ("now_us", "overruns", "_busy_until_us", "_owed_us")
    PARTS = ("_task",)

    def __init__(self, task: Task) -> None:
        self.now_us = 0
        """Virtual time up to which the processor has worked."""
        self.overruns = 0
        """Cycles whose foreground had not finished when the next one started."""
        self._busy_until_us = 0
        self._task = task
        self._owed_us = task.cost_us

    def begin_cycle(self, foreground_us: int) -> None:
        """Take the processor for the foreground, at the interrupt that starts a cycle."""
        # late work is not dropped: it delays the foreground of this cycle and starves the background
        if self._busy_until_us > self.now_us:
            self.overruns += 1
        self._busy_until_us = max(self._busy_until_us, self.now_us) + foreground_us

    def advance(self, until_us: int) -> None:
        """Let the background run in the idle time from now until ``until_us``."""
        start, owed, task = max(self.now_us, self._busy_until_us), self._owed_us, self._task
        while start + owed <= until_us:
            start += owed
            task.work(start)
            owed = task.cost_us
        # paid in part: the step goes on in the next idle time, so that a step longer than a slice still ends
        self._owed_us = owed - max(0, until_us - start)
        self.now_us = until_us
