"""What the effects of a program are carried out on: a controller, a dry run or pulse tables.

The executor does what the three have in common and calls a target for the rest: ``begin`` with every effect, then the
method of its kind. An effect that takes time is started by its method; the executor then runs a ``cycle`` whenever the
effect ``goes_on``, and calls ``finish``. What a target cannot do is a ``Fault`` of the method that was called.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from robolang.execution.world import RobotWorld
from robolang.interpreter.effects import (
    Drain,
    Effect,
    Halt,
    MoveTo,
    Origin,
    Pass,
    SetHand,
    SetOutput,
    SetPayload,
    SetSeam,
    SetTool,
    SetWrist,
    Show,
)
from robolang.interpreter.events import Failed
from robolang.project.project import Project
from runtime.core.faults import Alarm, Fault
from runtime.core.frames import Array
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.commands import Command
from runtime.robot.model.payload import Payload


@dataclass(frozen=True, slots=True, kw_only=True)
class Requested:
    """A move that the program requests: its effect, and the command that it was lowered to."""

    effect: MoveTo
    command: Command


class Effects(Protocol):
    """What is done with each kind of effect. A new kind needs a method here, and so in every target."""

    def begin(self, effect: Effect) -> None:
        """Take note of an effect before anything of it is done; ``Fault`` for one that cannot be carried out here."""

    def rehearse(self, q_start: Array, command: Command) -> MovePlan:
        """Return the plan of a move from q_start (n,) rad that the next one may blend into."""

    def move(self, chain: Sequence[Requested], *, more: bool = False) -> None:
        """Start moves that blend into one another; of a move without a zone a chain of one.

        ``more``: others may follow without a stop (``extend``).
        """

    def wrist(self, effect: SetWrist) -> None:
        """Take note of WRIST: every move carries the setting that holds for it."""

    def drain(self, effect: Drain) -> None:
        """Take note that motion has ended, since the program reads what changes with it."""

    def load(self, effect: SetPayload, payload: Payload) -> None:
        """Declare a payload."""

    def hand(self, effect: SetHand, cycles: int) -> None:
        """Close or open the hand and wait so many cycles."""

    def seam(self, effect: SetSeam) -> None:
        """Follow a seam sensor from now on, or none."""

    def tool(self, effect: SetTool, X_flange_tool: Array) -> None:
        """Use another tool, X_flange_tool (4, 4)."""

    def output(self, effect: SetOutput) -> None:
        """Take note of an output; its signal has been set."""

    def wait(self, effect: Pass, cycles: int) -> None:
        """Wait so many cycles."""

    def show(self, effect: Show) -> None:
        """Show a line of text."""

    def halt(self, effect: Halt) -> None:
        """Take note of STOP or PAUSE; after STOP nothing comes."""


class Target(Effects, Protocol):
    """Effects, and the time that they take."""

    statement: Origin | None
    """Statement that is carried out."""

    @property
    def world(self) -> RobotWorld:
        """What the program reads, by the clock of the target; the executor keeps its state."""

    @property
    def time_us(self) -> int:
        """Time since the program began, us."""

    @property
    def alarms(self) -> Sequence[Alarm]:
        """Alarms that end the program; the arm stops by itself, ``brake`` lets it."""

    @property
    def at_rest(self) -> bool:
        """Whether the arm has come to the rest that an alarm asks for."""

    @property
    def q(self) -> Array:
        """Joint angles (n,) rad at which motion has ended: where the next move begins."""

    @property
    def move_reached(self) -> int:
        """Which of the moves that were started last has been reached, from 0."""

    @property
    def more_due(self) -> bool:
        """Whether ``extend`` is to be called now, so that the moves that run go on without a stop."""

    def extend(self, chain: Sequence[Requested], *, more: bool) -> int:
        """Let more moves follow those that run; return how many of these are over and left out from now on.

        ``more`` as of ``move``. ``Fault`` RBL4xx where they cannot: the motion stops at its end.
        """

    def measured(self, key: str, index: int) -> float | None:
        """Return what an axis, from 1, measures by the name of a function in ``measured``; None: there is none.

        ``Fault`` RBL507 for an axis that the robot does not have.
        """

    silent: bool
    """Whether cycles of the past are run once more: neither seen by an observer nor paced."""

    def goes_on(self) -> bool:
        """Return whether the effect that was started needs another cycle; called before each and after the last."""

    def cycle(self) -> bool:
        """Run a cycle; False when there is nothing to go on with."""

    def finish(self) -> None:
        """End the effect that was started: its cycles are over, or an alarm has ended them."""

    def brake(self, *, at_once: bool) -> None:
        """Run a cycle of coming to rest after an alarm; ``at_once`` ends the motion here (category 0)."""

    def hold(self) -> bool:
        """Come to rest on the path, so that ``go_on`` can follow; returns whether the command rests."""

    def go_on(self) -> None:
        """Go on where ``hold`` has interrupted the motion."""

    def set_aside(self) -> Any:
        """Return what is left of a wait, or of a motion at rest, for ``take_up``; then nothing goes on by itself."""

    def take_up(self, left: Any) -> None:
        """Go on with what was set aside; a motion rests until ``go_on``."""

    def play(self, rows: Array, origin: Origin, text: str) -> None:
        """Start joint set-points (K, n) rad, one a cycle, as a statement of its own; ``Fault`` RBL404, 411 or 544."""

    def abandon(self) -> None:
        """Forget what is left of the set-points that rest; ``finish`` comes next."""

    def stop(self) -> None:
        """Raise the alarm of a stop from outside (category 1)."""

    def acknowledge(self) -> None:
        """Take note of the alarms, so that effects can be carried out again; ``RuntimeError`` where they cannot."""

    def fail(self, fault: Failed) -> None:
        """End with a fault that the program does not catch."""

    def refuse(self, effect: Effect, fault: Fault) -> None:
        """Take note of an effect that is refused: the program answers (ON ERROR), unless this raises."""

    def adopt(self, project: Project) -> None:
        """Go on with an edited project of the same robot."""

    def rename(self, place: Callable[[Origin], Origin]) -> None:
        """Name the statements of the record, and those that run, by their places in an edited text."""

    def renamed(self, left: Any, place: Callable[[Origin], Origin]) -> Any:
        """Return what was set aside, its statements named anew."""

    def snapshot(self) -> Any:
        """Return all on which the future depends, as a value that nothing changes."""

    def restore(self, snapshot: Any) -> None:
        """Put a snapshot back."""


class Untimed:
    """The part of a target in which no cycle is run: what takes time is over at once."""

    statement: Origin | None = None
    time_us = 0
    alarms: Sequence[Alarm] = ()
    at_rest = True
    move_reached = 0
    silent = False

    def goes_on(self) -> bool:
        """Return False: nothing goes on."""
        return False

    @property
    def more_due(self) -> bool:
        """Return False: nothing runs that more moves could follow."""
        return False

    def extend(self, chain: Sequence[Requested], *, more: bool) -> int:
        """Refuse: nothing runs that more moves could follow."""
        raise RuntimeError("moves are extended on a controller only")

    def cycle(self) -> bool:
        """Run nothing."""
        return False

    def finish(self) -> None:
        """Do nothing."""

    def brake(self, *, at_once: bool) -> None:
        """Do nothing: nothing moves."""

    def hold(self) -> bool:
        """Return True: nothing moves."""
        return True

    def go_on(self) -> None:
        """Do nothing."""

    def set_aside(self) -> None:
        """Do nothing: no wait takes cycles."""

    def take_up(self, left: Any) -> None:
        """Do nothing."""

    def play(self, rows: Array, origin: Origin, text: str) -> None:
        """Refuse: there is no arm to move."""
        raise RuntimeError("set-points are played on a controller only")

    def abandon(self) -> None:
        """Do nothing: nothing moves."""

    def measured(self, key: str, index: int) -> None:
        """Return None: nothing is measured."""

    def adopt(self, project: Project) -> None:
        """Refuse: what has been planned would stay."""
        raise RuntimeError("a program is edited on a controller only")

    def rename(self, place: Callable[[Origin], Origin]) -> None:
        """Do nothing: no project is adopted."""

    def renamed(self, left: Any, place: Callable[[Origin], Origin]) -> Any:
        """Return what was set aside."""
        return left

    def stop(self) -> None:
        """Do nothing: the executor takes no further effect."""

    def acknowledge(self) -> None:
        """Do nothing: there are no alarms."""

    def snapshot(self) -> dict[str, Any]:
        """Return all attributes; containers are copied, what is in them never changes."""
        return {name: _own(value) for name, value in vars(self).items()}

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Put the attributes back."""
        vars(self).update({name: _own(value) for name, value in snapshot.items()})


def _own(value: Any) -> Any:
    return value.copy() if isinstance(value, list | dict | set) else value
