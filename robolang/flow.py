"""Flow: what holds before each statement on some way through the program.

A *fact* is anything hashable that a rule follows through a program, such as which HAND has not been followed by a LOAD
yet. ``facts_before`` finds every fact that can hold before every line. Ways through subroutines are kept apart: what
returns from a CALL or GOSUB belongs to facts that entered it from there, so a subroutine called in two places leads no
fact of one caller to the other. That is the tabulation of interprocedural analysis (Reps, Horwitz, Sagiv, "Precise
interprocedural dataflow analysis via graph reachability", POPL 1995), over lines.

Conditions are not decided, except a WHILE of a number that is not 0, which is left only by a jump or an end. ON ERROR
leads to its handler from where it stands. RESUME leads nowhere that is not reached anyway.

Time is linear in lines times facts; a rule keeps its facts few, and ``MAX_FACTS`` of them before one line, or
``MAX_STEPS`` for each line all in all, end the search: then nothing is said. A short program may take ``LEAST_STEPS``,
none more than ``MOST_STEPS``, which bound the memory. Neither is anything said of a program of more than ``MAX_LINES``
lines, whose facts would take more memory than the program.
"""

from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from typing import Generic, Literal, TypeAlias, TypeVar

from robolang.constants import fixed
from robolang.nodes import (
    Block,
    CallSub,
    Case,
    For,
    Head,
    If,
    Jump,
    Next,
    OnError,
    Program,
    Statement,
    Sub,
    Wait,
    Word,
)
from robolang.structure import Structure

MAX_FACTS = 64
MAX_STEPS = 64
LEAST_STEPS = 20_000
MOST_STEPS = 1_000_000
MAX_LINES = 50_000

Fact = TypeVar("Fact", bound=Hashable)
Step = Callable[[int, Statement, Fact], Iterable[Fact]]
"""From the line, a statement of it and a fact before it to the facts after it."""


Kind: TypeAlias = Literal["go", "gosub", "call", "return", "leave", "end"]


@dataclass(frozen=True, slots=True)
class Way:
    """A way out of a line: the statement that it carries out, and where it leads.

    ``kind``: ``go`` to line ``to``; ``gosub`` or ``call`` the part whose first line is ``to``, to come back to the line
    below; ``return`` from the last GOSUB, or else the SUB; ``leave`` the SUB; ``end``: the program ends.
    """

    statement: Statement | None
    kind: Kind
    to: int = -1


Ways = list[list[Way]]


def ways_of(program: Program, structure: Structure) -> Ways:
    """Return the ways out of every line."""
    return [
        [Way(None, "go", index + 1)] if line.statement is None else _ways(line.statement, index, program, structure)
        for index, line in enumerate(program.lines)
    ]


def _ways(node: Statement, at: int, program: Program, structure: Structure) -> list[Way]:
    below = at + 1
    if isinstance(node, If):
        taken, other = _ways(node.then, at, program, structure), node.otherwise
        return taken + ([Way(None, "go", below)] if other is None else _ways(other, at, program, structure))
    if isinstance(node, Jump):
        to = structure.line_of(node.target)
        return [Way(node, "end")] if to is None else [Way(node, "gosub" if node.word == "GOSUB" else "go", to)]
    if isinstance(node, Wait | OnError):
        to = None if node.target is None else structure.line_of(node.target)
        return [Way(node, "go", below), *([] if to is None else [Way(node, "go", to)])]
    if isinstance(node, CallSub):
        sub = structure.subs.get(node.name.key)
        return [Way(node, "go", below)] if sub is None else [Way(node, "call", sub + 1)]
    if isinstance(node, Sub):
        return [Way(node, "go", structure.end.get(at, at) + 1)]
    if isinstance(node, Word):
        kinds: dict[str, Kind] = {"END": "end", "STOP": "end", "RESUME": "end", "RESUME NEXT": "end",
                                  "RETURN": "return"}  # fmt: skip
        return [Way(node, kinds[node.word])] if node.word in kinds else [Way(node, "go", below)]
    if isinstance(node, Head | Block | Case | For | Next):
        return _block_ways(node, at, program, structure)
    return [Way(node, "go", below)]


def _block_ways(node: Head | Block | Case | For | Next, at: int, program: Program, structure: Structure) -> list[Way]:
    """Return the ways out of a line of a block, reached from above as in the interpreter."""
    past = structure.end.get(at, at) + 1
    if isinstance(node, Head) and node.word in ("IF", "SELECT"):
        return [Way(node, "go", to) for to in _branches(at, program, structure)]
    if isinstance(node, For):
        return [Way(node, "go", at + 1), *([] if _goes_round(node) else [Way(node, "go", past)])]
    if isinstance(node, Head) and node.word == "WHILE":
        always = bool(fixed(node.value))
        return [Way(node, "go", at + 1), *([] if always else [Way(node, "go", past)])]
    if isinstance(node, Next):
        return [Way(node, "go", structure.after.get(at, at) + 1), Way(node, "go", at + 1)]
    word = node.word if isinstance(node, Block | Head) else "CASE"
    if word == "WEND":
        return [Way(node, "go", structure.after.get(at, at + 1))]
    if word == "ENDSUB":
        return [Way(node, "leave")]
    return [Way(node, "go", at + 1 if word in ("ENDIF", "ENDSELECT") else past)]


def _branches(at: int, program: Program, structure: Structure) -> list[int]:
    """Return the first lines of the branches of an IF or SELECT, and its end where none of them may be taken."""
    end = structure.end.get(at)
    if end is None:
        return [at + 1]
    head = program.lines[at].statement
    found = [at + 1] if isinstance(head, Head) and head.word == "IF" else []
    line = structure.after[at]
    while line != end:
        found.append(line + 1)
        statement = program.lines[line].statement
        if isinstance(statement, Block) and statement.word in ("ELSE", "CASE ELSE"):
            return found
        line = structure.after[line]
    return [*found, end]


def _goes_round(node: For) -> bool:
    """Return whether a FOR of numbers alone goes round at least once."""
    first, last = fixed(node.first), fixed(node.last)
    step = 1.0 if node.step is None else fixed(node.step)
    return first is not None and last is not None and bool(step) and (last - first) * (step or 0.0) >= 0.0


def facts_before(ways: Ways, first: Fact, step: Step[Fact]) -> list[set[Fact]] | None:
    """Return the facts that can hold before every line, ``first`` before line 0, and those behind the last line.

    None when they are too many.
    """
    return _Search(ways, step).run(first)


class _Search(Generic[Fact]):
    """The tabulation: pairs of a context and a fact before a line.

    A context is where, how (``main``, ``gosub``, ``call``) and with which fact the part that runs was entered; it goes
    by a number. An exit of it is a way out, RETURN or ENDSUB, with the fact there: what leaves a GOSUB by ENDSUB leaves
    the SUB that it is in, as RETURN leaves the SUB where no GOSUB is open.
    """

    def __init__(self, ways: Ways, step: Step[Fact]) -> None:
        self._ways, self._step = ways, step
        self._before: list[set[Fact]] = [set() for _ in range(len(ways) + 1)]
        self._seen: set[tuple[int, int, Fact]] = set()
        self._work: list[tuple[int, int, Fact]] = []
        self._contexts: dict[tuple[str, int, Fact], int] = {}
        self._kinds: list[str] = []
        self._callers: list[set[tuple[int, int]]] = []
        self._exits: list[set[tuple[str, Fact]]] = []

    def run(self, first: Fact) -> list[set[Fact]] | None:
        """Search from line 0."""
        self._push(self._context("main", 0, first), 0, first)
        most = min(max(MAX_STEPS * len(self._before), LEAST_STEPS), MOST_STEPS)
        while self._work:
            if len(self._seen) > most:
                return None
            context, at, fact = self._work.pop()
            if len(self._before[at]) > MAX_FACTS:
                return None
            for way in self._ways[at] if at < len(self._ways) else ():
                for after in (fact,) if way.statement is None else self._step(at, way.statement, fact):
                    self._follow(context, at, way, after)
        return self._before

    def _context(self, kind: str, line: int, fact: Fact) -> int:
        number = self._contexts.setdefault((kind, line, fact), len(self._kinds))
        if number == len(self._kinds):
            self._kinds.append(kind)
            self._callers.append(set())
            self._exits.append(set())
        return number

    def _push(self, context: int, at: int, fact: Fact) -> None:
        if (key := (context, at, fact)) not in self._seen:
            self._seen.add(key)
            self._before[at].add(fact)
            self._work.append(key)

    def _follow(self, context: int, at: int, way: Way, fact: Fact) -> None:
        if way.kind == "go":
            self._push(context, way.to, fact)
        elif way.kind in ("gosub", "call"):
            callee = self._context(way.kind, way.to, fact)
            self._push(callee, way.to, fact)
            self._callers[callee].add((context, at + 1))
            for kind, left in tuple(self._exits[callee]):
                if way.kind == "gosub" and kind == "leave":
                    self._leave(context, kind, left)
                else:
                    self._push(context, at + 1, left)
        elif way.kind in ("return", "leave"):
            self._leave(context, way.kind, fact)

    def _leave(self, context: int, kind: str, fact: Fact) -> None:
        """Leave a context, with those around it that end as well: a list of them, since they may be many."""
        todo = [context]
        while todo:
            inner = todo.pop()
            if (kind, fact) in self._exits[inner]:
                continue
            self._exits[inner].add((kind, fact))
            for caller, line in self._callers[inner]:
                if self._kinds[inner] == "gosub" and kind == "leave":
                    todo.append(caller)
                else:
                    self._push(caller, line, fact)
