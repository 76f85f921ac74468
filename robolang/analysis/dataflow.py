"""Flow: what holds before each statement on some path through the program.

A *fact* is anything hashable that a rule follows through a program, such as which HAND has not been followed by a LOAD
yet. ``facts_before`` finds every fact that can hold before every line. Paths through subroutines are kept apart: what
returns from a CALL or GOSUB belongs to facts that entered it from there, so a subroutine called in two places leads no
fact of one caller to the other. That is the tabulation of interprocedural analysis (Reps, Horwitz, Sagiv, "Precise
interprocedural dataflow analysis via graph reachability", POPL 1995), over lines.

Conditions are not decided, except a WHILE of a number that is not 0, which is left only by a jump or an end. An error
leads to the handler of its ON ERROR from every statement that may fail (``failing``), and RESUME back from there.

Time is linear in lines times facts; a rule keeps its facts few, and ``MAX_FACTS`` of them before one line, or
``MAX_STEPS`` for each line all in all, end the search: then nothing is said. A short program may take ``LEAST_STEPS``,
none more than ``MOST_STEPS``, which bound the memory. A program of more than ``MAX_LINES`` lines
is not searched either: its facts would take more memory than the program.
"""

from robolang.analysis.failing import may_fail
from robolang.analysis.tabulation import STOPS, Edge, Edges, Fact, Kind, Search, Step
from robolang.evaluation.constant_folding import fixed
from robolang.syntax.ast import (
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
from robolang.syntax.blocks import Structure

MAX_LINES = 50_000

_WORDS: dict[str, tuple[Kind] | tuple[Kind, int]] = {
    "END": ("end",),
    "STOP": ("end",),
    "RETURN": ("return",),
    "RESUME": ("resume",),
    "RESUME NEXT": ("resume next",),
    "ON ERROR STOP": ("catch", STOPS),
}
"""Kind and target of the edge of statements that consist of words; the others go on with the line below."""


def edges_of(program: Program, structure: Structure) -> Edges:
    """Return the edges out of every line."""
    edges = [
        [Edge(None, "go", index + 1)] if line.statement is None else _edges(line.statement, index, program, structure)
        for index, line in enumerate(program.lines)
    ]
    # without a handler an error ends the run: no line is entered by it, and most programs save the search these edges
    if any(edge.kind == "catch" for out in edges for edge in out):
        for out, line in zip(edges, program.lines, strict=True):
            if line.statement is not None and may_fail(line.statement):
                out.append(Edge(None, "fail"))
    return edges


def _edges(node: Statement, at: int, program: Program, structure: Structure) -> list[Edge]:
    below = at + 1
    if isinstance(node, If):
        taken, other = _edges(node.then, at, program, structure), node.otherwise
        return taken + ([Edge(None, "go", below)] if other is None else _edges(other, at, program, structure))
    if isinstance(node, Jump | OnError | Wait):
        return _edges_to_target(node, below, structure)
    if isinstance(node, CallSub):
        sub = structure.subs.get(node.name.key)
        return [Edge(node, "go", below)] if sub is None else [Edge(node, "call", sub + 1)]
    if isinstance(node, Sub):
        return [Edge(node, "go", structure.end.get(at, at) + 1)]  # a SUB is entered by CALL alone
    if isinstance(node, Word):
        return [Edge(node, *_WORDS.get(node.word, ("go", below)))]
    if isinstance(node, Head | Block | Case | For | Next):
        return _block_edges(node, at, program, structure)
    return [Edge(node, "go", below)]


def _edges_to_target(node: Jump | OnError | Wait, below: int, structure: Structure) -> list[Edge]:
    """Return the edges of a statement that names a line; one that is not there is an error of its own (RBL202)."""
    to = None if node.target is None else structure.line_of(node.target)
    if isinstance(node, Jump):
        return [Edge(node, "end")] if to is None else [Edge(node, "gosub" if node.word == "GOSUB" else "go", to)]
    if to is None:
        return [Edge(node, "go", below)]
    if isinstance(node, OnError):
        return [Edge(node, "catch", to)]
    return [Edge(node, "go", below), Edge(node, "go", to)]


def _block_edges(node: Head | Block | Case | For | Next, at: int, program: Program, structure: Structure) -> list[Edge]:
    """Return the edges out of a line of a block that is reached from above, as the interpreter takes them."""
    past = structure.end.get(at, at) + 1
    if isinstance(node, For):
        return _entered(node, _goes_round(node), at, past)
    if isinstance(node, Next):
        # to the first line inside, not to FOR: that sets the variable and counts the rounds once
        return [Edge(node, "go", structure.after.get(at, at) + 1), Edge(node, "go", at + 1)]
    if isinstance(node, Head) and node.word == "WHILE":
        return _entered(node, bool(fixed(node.value)), at, past)
    word = "CASE" if isinstance(node, Case) else node.word
    if word in ("IF", "SELECT"):
        return [Edge(node, "go", to) for to in _branches(at, program, structure)]
    # ELSE, ELSEIF and CASE are reached from above by the branch before them, which ends there: on after the block
    edges = {
        "WEND": Edge(node, "go", structure.after.get(at, at + 1)),
        "ENDSUB": Edge(node, "leave"),
        "ENDIF": Edge(node, "go", at + 1),
        "ENDSELECT": Edge(node, "go", at + 1),
    }
    return [edges.get(word, Edge(node, "go", past))]


def _entered(node: For | Head, always: bool, at: int, past: int) -> list[Edge]:
    """Return the edges out of the head of a loop: into it, and past it unless its condition always holds."""
    inside = Edge(node, "go", at + 1)
    return [inside] if always else [inside, Edge(node, "go", past)]


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


def facts_before(edges: Edges, first: Fact, step: Step[Fact]) -> list[set[Fact]] | None:
    """Return the facts that can hold before every line, ``first`` before line 0, and those after the last line.

    None when they are too many.
    """
    return Search(edges, step).run(first)
