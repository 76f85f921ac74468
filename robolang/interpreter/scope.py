"""What names stand for while a program runs: variables, constants, arrays, taught points, loops and returns.

The main program has one scope, every CALL one of its own with the parameters in it. A name is looked up in the scope of
the running SUB, then in that of the main program, then among the taught points; an assignment goes to the running
scope, so a SUB cannot change what its caller has.

ON ERROR belongs to the scope in which it is executed. An error goes to the innermost scope that has a handler: the
CALLs inside of that scope are given up, and the GOSUBs that it has begun since, so that a handler without RESUME leaves
nothing that accumulates. RESUME goes back to where that scope was: the statement that failed, its GOSUBs open again, or
the CALL in which it failed.

Memory is counted where it is given out, and comes back when a SUB ends: names and elements of arrays (``MAX_CELLS``,
RBL507), and what texts and the offsets after poses hold beyond that (``MAX_TEXTS``, RBL506).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import robolang.core.run_codes  # noqa: F401 - the codes raised here must be registered
from robolang.interpreter.arrays import Array
from robolang.values.poses import Place, Value, kind_of
from runtime.core.faults import Fault
from runtime.core.limits import SIZE

MAX_CELLS = 1_000_000
"""Most elements of all arrays and names with a value together."""
MAX_TEXTS = 10_000_000
"""Most characters of all texts that names and arrays hold."""
SHIFT = 32
"""Characters that an offset after a pose counts as."""


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

    ``handler``: line of its ON ERROR, ``STOPS``, or None without one; ``gosubs``: how many of ``returns``
    stay when the handler is reached; ``failure``: what the handler deals with, None when it does not run. ``cells`` and
    ``texts`` are what the scope has of ``MAX_CELLS`` and ``MAX_TEXTS``.
    """

    back: int = -1  # the main program has no CALL to go back to
    values: dict[str, Value] = field(default_factory=dict)
    arrays: dict[str, Array] = field(default_factory=dict)
    constants: set[str] = field(default_factory=set)
    loops: list[Loop] = field(default_factory=list)
    returns: list[int] = field(default_factory=list)
    handler: int | None = None
    gosubs: int = 0
    failure: Failure | None = None
    cells: int = 0
    texts: int = 0

    def copy(self) -> "Scope":
        """Return a scope of the same state; values are immutable, and arrays share what neither changes."""
        return replace(
            self,
            values=self.values.copy(),
            arrays={key: array.copy() for key, array in self.arrays.items()},
            constants=self.constants.copy(),
            loops=[replace(loop) for loop in self.loops],
            returns=self.returns.copy(),
        )


class Scopes:
    """The scopes of a running program, that of the main program first."""

    def __init__(self, points: frozenset[str]) -> None:
        self._points = points
        self.stack = [Scope()]

    @property
    def here(self) -> Scope:
        """The scope that runs."""
        return self.stack[-1]

    def snapshot(self) -> tuple[Scope, ...]:
        """Return copies of the scopes, which nothing changes."""
        return tuple(scope.copy() for scope in self.stack)

    def restore(self, scopes: Sequence[Scope]) -> None:
        """Take back the scopes of a snapshot."""
        self.stack = [scope.copy() for scope in scopes]

    # --- CALL, GOSUB and ON ERROR -------------------------------------------------------------------------------------

    def enter(self, back: int, values: Mapping[str, Value]) -> None:
        """Begin a SUB with its parameters, to go on at a line after it; ``Fault`` RBL506, RBL507, RBL531."""
        for key, value in values.items():
            check_kind(key, value)
        scope = Scope(back=back)
        self._charge(scope, len(values), sum(map(characters, values.values())))
        scope.values.update(values)
        self.stack.append(scope)

    def leave(self) -> int | None:
        """Return the line at which the CALL of the running scope goes on, and end it; None in the main program."""
        return self.stack.pop().back if len(self.stack) > 1 else None

    def go_back(self) -> int | None:
        """Return the line at which the last GOSUB of the running scope goes on, and end it; None without one."""
        here = self.here
        line = here.returns.pop() if here.returns else None
        here.gosubs = min(here.gosubs, len(here.returns))
        return line

    def on_error(self, handler: int) -> None:
        """Let a line of the running scope deal with errors, or ``STOPS``; a handler that runs is at its end."""
        # the GOSUBs open now stay open in the handler; only those begun later are given up
        here = self.here
        here.handler, here.gosubs, here.failure = handler, len(here.returns), None

    def unwind(self, depth: int, returns: int) -> None:
        """Give up the CALLs beyond a number of scopes, and the GOSUBs of the last of them beyond a number."""
        del self.stack[depth:]
        here = self.here
        del here.returns[returns:]
        here.gosubs = min(here.gosubs, len(here.returns))

    def catch(self, line: int, outermost: int = 0) -> int | None:
        """Return the line of the handler of an error on a line, and give up what it leaves; None: nothing catches it.

        Scopes outside of number ``outermost`` have no part in it.
        """
        handlers = (k for k in reversed(range(outermost, len(self.stack))) if self.stack[k].handler is not None)
        index = next(handlers, None)
        if index is None:
            return None
        scope = self.stack[index]
        if scope.handler in (None, STOPS) or scope.failure is not None:
            return None
        inner = self.stack[index + 1 :]
        del self.stack[index + 1 :]
        # seen from the handler's scope, the CALL has failed: RESUME makes the call again, and not its last statement
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
        for scope in (self.stack[-1], self.stack[0]):  # not those between: a SUB does not depend on who calls it
            if key in scope.values:
                return scope.values[key]
        return Place(point=key) if key in self._points else None

    def element(self, key: str, index: int) -> Value | None:
        """Return an element of an array, None when there is no such array; ``Fault`` RBL507."""
        scope = self._owner(key)
        if scope is None:
            return None
        array = scope.arrays[key]
        return array[self._checked(key, array, index)]

    def assign(self, key: str, value: Value) -> None:
        """Give a name of the running scope a value; ``Fault`` RBL531 for a constant and for another kind of value."""
        check_kind(key, value)
        if key in self.here.constants or key in self.stack[0].constants:
            raise Fault("RBL531", f"{key} is a constant and keeps its value")
        self._store(key, value)

    def fix(self, key: str, value: Value) -> None:
        """Give a name a value that stays; the same CONST may be run again, to the same value. ``Fault`` RBL531."""
        if key in self.here.constants and self.here.values[key] != value:
            raise Fault("RBL531", f"{key} is a constant and keeps its value")
        if key not in self.here.constants:
            self.assign(key, value)
            self.here.constants.add(key)

    def _store(self, key: str, value: Value) -> None:
        here = self.here
        old = here.values.get(key)
        if not (isinstance(old, float) and isinstance(value, float)):  # a number in place of a number is most of them
            self._charge(here, int(old is None), characters(value) - characters(old))
        here.values[key] = value

    def make(self, key: str, largest: int) -> None:
        """Make an array of elements 0 to ``largest``, all 0 or empty; ``Fault`` RBL507."""
        SIZE.checked(largest)
        here = self.here
        old: Sequence[Value] | Array = here.arrays.get(key, ())
        self._charge(here, largest + 1 - len(old), -sum(map(characters, old)))
        empty: Value = "" if key.endswith("$") else 0.0
        here.arrays[key] = Array(largest + 1, empty)

    def put(self, key: str, index: int, value: Value) -> None:
        """Give an element of an array a value; ``Fault`` RBL507, RBL532."""
        check_kind(key, value)
        scope = self._owner(key)
        if scope is None:
            raise Fault("RBL532", f"there is no array {key}: DIM {key}(n) makes one")
        array = scope.arrays[key]
        index = self._checked(key, array, index)
        self._charge(scope, 0, characters(value) - characters(array[index]))
        array[index] = value

    def _owner(self, key: str) -> Scope | None:
        """Return the scope whose array a name means."""
        return next((scope for scope in (self.stack[-1], self.stack[0]) if key in scope.arrays), None)

    def _checked(self, key: str, array: Array, index: int) -> int:
        if not 0 <= index < len(array):
            raise Fault("RBL507", f"{key} has the elements 0 to {len(array) - 1}, no {index}")
        return index

    def _charge(self, scope: Scope, cells: int, texts: int) -> None:
        """Give a scope memory, or take it back; ``Fault`` RBL506 or RBL507 when all together would have too much."""
        if cells > 0 and sum(each.cells for each in self.stack) + cells > MAX_CELLS:
            raise Fault("RBL507", f"all arrays and names together would have more than {MAX_CELLS} elements")
        if texts > 0 and sum(each.texts for each in self.stack) + texts > MAX_TEXTS:
            raise Fault(
                "RBL506",
                f"all texts together would have more than {MAX_TEXTS} characters; an offset after a pose counts as "
                f"{SHIFT}",
            )
        scope.cells += cells
        scope.texts += texts


def characters(value: Value | None) -> int:
    """Return how many characters a value holds, or as many as its offsets count."""
    return len(value) if isinstance(value, str) else SHIFT * len(value.shifts) if isinstance(value, Place) else 0


def check_kind(key: str, value: Value) -> None:
    """Raise ``Fault`` RBL531 unless a name that ends in $ gets a text, and any other name none."""
    if key.endswith("$") is not isinstance(value, str):
        raise Fault(
            "RBL531", f"{kind_of(value)} is assigned to {key}; names that end in $ hold texts, and only they do"
        )
