"""What names stand for while a program runs: variables, constants, arrays, taught points, loops and returns.

The main program has one scope, every CALL one of its own with the parameters in it. A name is looked up in the scope of
the running SUB, then in that of the main program, then among the taught points; an assignment goes to the running
scope, so a SUB cannot change what its caller has.

ON ERROR belongs to the scope that says it. Of an error the innermost scope decides that has said it: the CALLs inside
of that scope are given up, and the GOSUBs that it has begun since, so what a handler leaves behind does not pile up.
RESUME goes back to where that scope was: the statement that failed, its GOSUBs open again, or the CALL in which it
failed.
"""

from dataclasses import dataclass, field

from robolang.evaluator import MAX_ELEMENTS
from robolang.places import Place, Value, kind_of
from runtime.faults import Fault

MAX_CELLS = 1_000_000
"""Most elements of all arrays together."""


@dataclass(slots=True)
class Loop:
    """A FOR that runs: its line, rounds left, and the step of its variable."""

    line: int
    variable: str
    rounds: int
    step: float


STOPS = -1
"""In place of a handler's line: ON ERROR STOP."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """An error that a handler deals with: the line to go back to, and the GOSUBs that were open there."""

    line: int
    returns: tuple[int, ...]


@dataclass(slots=True)
class Scope:
    """Names of the main program or of one CALL; ``back``: the line to go on at after it.

    ``handler``: line of its ON ERROR, ``STOPS``, or None where it has said nothing; ``gosubs``: how many of ``returns``
    stay when the handler is reached; ``failure``: what the handler deals with, None when it does not run.
    """

    back: int = -1
    values: dict[str, Value] = field(default_factory=dict)
    arrays: dict[str, list[Value]] = field(default_factory=dict)
    constants: set[str] = field(default_factory=set)
    loops: list[Loop] = field(default_factory=list)
    returns: list[int] = field(default_factory=list)
    handler: int | None = None
    gosubs: int = 0
    failure: Failure | None = None


class Scopes:
    """The scopes of a running program, that of the main program first."""

    def __init__(self, points: frozenset[str]) -> None:
        self._points = points
        self.stack = [Scope()]

    @property
    def here(self) -> Scope:
        """The scope that runs."""
        return self.stack[-1]

    # --- GOSUB and ON ERROR ------------------------------------------------------------------------------------------

    def go_back(self) -> int | None:
        """Return the line at which the last GOSUB of the running scope goes on, and end it; None without one."""
        here = self.here
        line = here.returns.pop() if here.returns else None
        here.gosubs = min(here.gosubs, len(here.returns))
        return line

    def on_error(self, handler: int) -> None:
        """Let a line of the running scope deal with errors, or ``STOPS``; a handler that runs is at its end."""
        here = self.here
        here.handler, here.gosubs, here.failure = handler, len(here.returns), None

    def catch(self, line: int) -> int | None:
        """Return the line of the handler of an error on a line, and give up what it leaves; None: it ends the run."""
        index = next((k for k in reversed(range(len(self.stack))) if self.stack[k].handler is not None), 0)
        scope = self.stack[index]
        if scope.handler in (None, STOPS) or scope.failure is not None:
            return None
        inner = self.stack[index + 1 :]
        del self.stack[index + 1 :]
        scope.failure = Failure(line=inner[0].back - 1 if inner else line, returns=tuple(scope.returns))
        del scope.returns[scope.gosubs :]
        return scope.handler

    def resume(self) -> int | None:
        """Return the line that failed and let the handler be at its end; None when none runs in the running scope."""
        here = self.here
        failure, here.failure = here.failure, None
        if failure is None:
            return None
        here.returns[:] = failure.returns
        return failure.line

    # --- names -------------------------------------------------------------------------------------------------------

    def value(self, key: str) -> Value | None:
        """Return the value of a name, None when it has none."""
        for scope in (self.stack[-1], self.stack[0]):
            if key in scope.values:
                return scope.values[key]
        return Place(point=key) if key in self._points else None

    def element(self, key: str, index: int) -> Value | None:
        """Return an element of an array, None when there is no such array; ``Fault`` RBL507."""
        array = self._array(key)
        return None if array is None else array[self._checked(key, array, index)]

    def assign(self, key: str, value: Value) -> None:
        """Give a name of the running scope a value; ``Fault`` RBL531 for a constant and for another kind of value."""
        check_kind(key, value)
        if key in self.here.constants or key in self.stack[0].constants:
            raise Fault("RBL531", f"{key} is a constant and keeps its value")
        self.here.values[key] = value

    def fix(self, key: str, value: Value) -> None:
        """Give a name a value that stays; the same CONST may be run again."""
        self.here.constants.discard(key)
        self.assign(key, value)
        self.here.constants.add(key)

    def make(self, key: str, largest: int) -> None:
        """Make an array of elements 0 to ``largest``, all 0 or empty; ``Fault`` RBL507."""
        if not 0 <= largest < MAX_ELEMENTS:
            raise Fault("RBL507", f"an array of {largest + 1} elements: 1 to {MAX_ELEMENTS} are possible")
        others = sum(len(array) for scope in self.stack for name, array in scope.arrays.items()
                     if not (scope is self.here and name == key))  # fmt: skip
        if others + largest + 1 > MAX_CELLS:
            raise Fault("RBL507", f"all arrays together would have more than {MAX_CELLS} elements")
        empty: Value = "" if key.endswith("$") else 0.0
        self.here.arrays[key] = [empty] * (largest + 1)

    def put(self, key: str, index: int, value: Value) -> None:
        """Give an element of an array a value; ``Fault`` RBL507, RBL532."""
        check_kind(key, value)
        array = self._array(key)
        if array is None:
            raise Fault("RBL532", f"there is no array {key}: DIM {key}(n) makes one")
        array[self._checked(key, array, index)] = value

    def _array(self, key: str) -> list[Value] | None:
        for scope in (self.stack[-1], self.stack[0]):
            if key in scope.arrays:
                return scope.arrays[key]
        return None

    def _checked(self, key: str, array: list[Value], index: int) -> int:
        if not 0 <= index < len(array):
            raise Fault("RBL507", f"{key} has the elements 0 to {len(array) - 1}, no {index}")
        return index


def check_kind(key: str, value: Value) -> None:
    """Raise ``Fault`` RBL531 unless a name that ends in $ gets a text, and any other name none."""
    if key.endswith("$") is not isinstance(value, str):
        raise Fault("RBL531", f"{kind_of(value)} is assigned to {key}; names that end in $ hold texts, and only they "
                    "do")  # fmt: skip
