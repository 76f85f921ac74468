"""The search of ``flow``: which facts hold before which line, contexts kept apart.

A *context* is a part of the program that runs: the main program, what a GOSUB, a CALL or an error has led to. It is
distinguished by how, where and with which fact it was entered, and by the handler of errors then; it has a number. An
*exit* is what leaves a context, with the fact and the handler there. RETURN leaves the last GOSUB, or else the SUB;
ENDSUB leaves the SUB, so it goes through the GOSUBs in it; an error that no handler of the SUB takes leaves it as well.

A handler runs as a context of its own, whose callers are the statements that may fail: RESUME goes back to them. RETURN
in it leaves one of the GOSUBs in which the error was: which of them were begun since ON ERROR is not followed. While it
runs, no error is caught.
"""

from collections.abc import Callable, Hashable, Iterable
from typing import Generic, Literal, NamedTuple, TypeAlias, TypeVar

from robolang.syntax.ast import Statement

# facts before one line: each HAND of a program may be a fact of its own
MAX_FACTS = 64
MAX_STEPS = 64
# steps: 20 SUBs that call one another have few lines and many paths
LEAST_STEPS = 60_000
# bounds the memory, whatever the length of the program
MOST_STEPS = 1_000_000

Fact = TypeVar("Fact", bound=Hashable)
Step = Callable[[int, Statement, Fact], Iterable[Fact]]
"""From the line, a statement of it and a fact before it to the facts after it."""
Kind: TypeAlias = Literal["go", "gosub", "call", "return", "leave", "end", "catch", "fail", "resume", "resume next"]

STOPS, NOTHING = -1, -2
"""In place of a handler's line: an error ends the run, and nothing is said in this SUB."""


class Edge(NamedTuple):
    """An edge out of a line: the statement that it carries out, and where it leads.

    ``kind``: ``go`` to line ``to``; ``gosub`` or ``call`` the part whose first line is ``to``, to come back to the line
    below; ``return`` from the last GOSUB, or else the SUB; ``leave`` the SUB; ``end``: the program ends; ``catch``:
    errors lead to ``to`` from here on, and the line below is next; ``fail``: it may; ``resume``, ``resume next``.
    """

    statement: Statement | None
    kind: Kind
    to: int = -1


Edges = list[list[Edge]]


class _Caller(NamedTuple):
    """What a context goes back to: the context, line and handler that it was entered from."""

    context: int
    line: int
    handler: int


class _Exit(NamedTuple, Generic[Fact]):
    """What leaves a context. ``unwind``: a RETURN from one of the GOSUBs around."""

    kind: str
    fact: Fact
    handler: int


class Search(Generic[Fact]):
    """The tabulation: pairs of a context and a fact before a line."""

    def __init__(self, edges: Edges, step: Step[Fact]) -> None:
        self._edges, self._step = edges, step
        # one set more than there are lines: what holds where the program ends by itself
        self._before: list[set[Fact]] = [set() for _ in range(len(edges) + 1)]
        self._seen: set[tuple[int, int, Fact, int]] = set()
        self._work: list[tuple[int, int, Fact, int]] = []
        self._contexts: dict[tuple[str, int, Fact, int], int] = {}
        self._kinds: list[str] = []
        self._callers: list[set[_Caller]] = []
        self._exits: list[set[_Exit[Fact]]] = []
        self._returning: list[tuple[str, _Caller, _Exit[Fact]]] = []
        self._returned = 0

    def run(self, first: Fact) -> list[set[Fact]] | None:
        """Search from line 0; None when there are too many facts or steps."""
        self._push(self._context("main", 0, first, NOTHING), 0, first, NOTHING)
        most = min(max(MAX_STEPS * len(self._before), LEAST_STEPS), MOST_STEPS)
        while self._work or self._returning:
            # returns count as steps: of a part with many callers and exits there are more than of its lines
            if len(self._seen) + self._returned > most:
                return None
            if self._returning:
                self._returned += 1
                self._return(*self._returning.pop())
                continue
            context, at, fact, handler = self._work.pop()
            if len(self._before[at]) > MAX_FACTS:
                return None
            for edge in self._edges[at] if at < len(self._edges) else ():
                for after in (fact,) if edge.statement is None else self._step(at, edge.statement, fact):
                    self._follow(context, at, edge, after, handler)
        return self._before

    def _context(self, kind: str, line: int, fact: Fact, handler: int) -> int:
        number = self._contexts.setdefault((kind, line, fact, handler), len(self._kinds))
        if number == len(self._kinds):
            self._kinds.append(kind)
            self._callers.append(set())
            self._exits.append(set())
        return number

    def _push(self, context: int, at: int, fact: Fact, handler: int) -> None:
        if (key := (context, at, fact, handler)) not in self._seen:
            self._seen.add(key)
            self._before[at].add(fact)
            self._work.append(key)

    def _follow(self, context: int, at: int, edge: Edge, fact: Fact, handler: int) -> None:
        if edge.kind == "go":
            self._push(context, edge.to, fact, handler)
        elif edge.kind == "catch":
            self._push(context, at + 1, fact, edge.to)
        elif edge.kind in ("gosub", "call"):
            # a SUB has handlers of its own; NOTHING sends what it does not catch to the handler of its CALL
            within = handler if edge.kind == "gosub" else NOTHING
            self._enter(edge.kind, edge.to, fact, within, _Caller(context, at, handler))
        elif edge.kind == "fail":
            self._fail(_Caller(context, at, handler), fact)
        elif edge.kind != "end":
            self._exit(context, _Exit(edge.kind, fact, handler))

    def _enter(self, kind: str, line: int, fact: Fact, handler: int, caller: _Caller) -> None:
        callee = self._context(kind, line, fact, handler)
        self._push(callee, line, fact, handler)
        if caller not in self._callers[callee]:
            self._callers[callee].add(caller)
            # the part may have been searched for an earlier caller: its exits hold for this one as well
            self._returning += [(kind, caller, left) for left in self._exits[callee]]

    def _exit(self, context: int, left: _Exit[Fact]) -> None:
        if left not in self._exits[context]:
            self._exits[context].add(left)
            self._returning += [(self._kinds[context], caller, left) for caller in self._callers[context]]

    def _fail(self, at: _Caller, fact: Fact) -> None:
        """Follow an error at a statement."""
        if at.handler >= 0:
            self._enter("handler", at.handler, fact, STOPS, at)  # an error within a handler ends the run
        elif at.handler == NOTHING:
            self._exit(at.context, _Exit("fail", fact, NOTHING))

    def _return(self, kind: str, caller: _Caller, left: _Exit[Fact]) -> None:
        """Carry an exit of a context of some kind to one of its callers."""
        if kind == "call":
            self._return_from_call(caller, left)
        elif kind == "gosub" and left.kind in ("return", "unwind"):
            self._push(caller.context, caller.line + 1, left.fact, left.handler)
            if left.kind == "unwind":
                # RETURN of a handler may leave this GOSUB or one around it: both are followed
                self._exit(caller.context, left)
        elif kind == "handler" and left.kind in ("resume", "resume next"):
            self._push(caller.context, caller.line + (left.kind == "resume next"), left.fact, caller.handler)
        elif kind == "handler" and left.kind == "return":
            self._exit(caller.context, left._replace(kind="unwind"))
        else:
            self._exit(caller.context, left)

    def _return_from_call(self, caller: _Caller, left: _Exit[Fact]) -> None:
        """Carry an exit of a SUB to one of its CALLs, where the caller's handler is in force again."""
        if left.kind == "fail":
            self._fail(caller, left.fact)
        elif left.kind in ("return", "leave", "unwind"):
            self._push(caller.context, caller.line + 1, left.fact, caller.handler)
