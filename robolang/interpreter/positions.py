"""Where a program stands inside of a statement: what the next step does, as frozen values.

No generator and no frame of Python is kept between two steps, so a place in a program can be copied, kept and returned
to. ``Cursor`` is the place; a statement that was fed suspends it (``Suspended``).
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from typing import TypeAlias

from robolang.interpreter.events import Done, Failed
from robolang.interpreter.fed_line import Fed
from robolang.interpreter.scope import Scope
from robolang.syntax.ast import Statement, Wait
from robolang.syntax.tree import Node
from robolang.values.poses import Value
from runtime.core.faults import Fault


@dataclass(frozen=True, slots=True)
class Due:
    """The line at the cursor has not begun."""


@dataclass(frozen=True, slots=True)
class Begun:
    """The beginning of the statement has been reported; the statement is to be carried out."""


@dataclass(frozen=True, slots=True)
class Drained:
    """Motion has ended for a statement, or for the branch of an IF on one line; it is to be carried out."""

    node: Statement


@dataclass(frozen=True, slots=True)
class Asking:
    """Motion has ended for the condition of an ELSEIF, ``at`` its line."""

    at: int


@dataclass(frozen=True, slots=True)
class Comparing:
    """Motion has ended for the values of a CASE, ``at`` its line; ``chosen``: the value of the SELECT."""

    at: int
    chosen: Value


@dataclass(frozen=True, slots=True)
class WaitDue:
    """Motion has ended for a WAIT; its time is to begin."""

    node: Wait


@dataclass(frozen=True, slots=True)
class Waiting:
    """A WAIT since ``began``, s, for at most ``timeout``, s; ``forced``: the branch that it takes, None: either."""

    node: Wait
    began: float
    timeout: float
    forced: bool | None


@dataclass(frozen=True, slots=True)
class Given:
    """The last effect of the statement has been given; the program goes on at line ``to``, None: the next one.

    ``takes_time``: the effect has taken time at the next step; a refused one has not.
    """

    to: int | None = None
    takes_time: bool = False


Position: TypeAlias = Due | Begun | Drained | Asking | Comparing | WaitDue | Waiting | Given

DUE, BEGUN, GIVEN, MOVED = Due(), Begun(), Given(), Given(takes_time=True)


@dataclass(slots=True)
class Cursor:
    """The place of a program: index of the line that runs, below 0 of what was fed, and the position inside of its
    statement.

    ``part``: line and part of the statement that is carried out, such as the branch of an IF: a fault is located there.
    ``refused``: the fault of the effect that was given, to be answered by the next step; ``ended``: the event of every
    further step; ``fed``: the text that was fed, until it is over.
    """

    at: int = 0  # not the line of an ELSEIF or CASE: RESUME takes the head of the block again
    position: Position = DUE
    part: tuple[int, Node | None] = (0, None)
    refused: Fault | None = None
    ended: Done | Failed | None = None
    fed: Fed | None = None

    def copy(self) -> "Cursor":
        """Return the same place."""
        return copy(self)


@dataclass(frozen=True, slots=True)
class Suspended:
    """The place that a statement which was fed has suspended, and how many scopes and GOSUBs there were."""

    cursor: Cursor
    depth: int
    returns: int

    def is_awaited(self, stack: Sequence[Scope]) -> bool:
        """Return whether a CALL or GOSUB that was fed has not returned yet."""
        # by the return address: a jump, an error or RETURN may have left the call, and then nothing comes back
        called = len(stack) > self.depth and stack[self.depth].back < 0
        gone = [] if len(stack) < self.depth else stack[self.depth - 1].returns[self.returns :][:1]
        return called or any(back < 0 for back in gone)
