"""Flow: what holds before each statement on some way through the program.

A *fact* is anything hashable that a rule follows through a program, such as which HAND has not been followed by a LOAD
yet. ``facts_before`` finds every fact that can hold before every line. Ways through subroutines are kept apart: what
returns from a CALL or GOSUB belongs to facts that entered it from there, so a subroutine called in two places leads no
fact of one caller to the other. That is the tabulation of interprocedural analysis (Reps, Horwitz, Sagiv, "Precise
interprocedural dataflow analysis via graph reachability", POPL 1995), over lines.

Conditions are not decided, except a WHILE of a number that is not 0, which is left only by a jump or an end. An error
leads to the handler of its ON ERROR from every statement that may fail (``failing``), and RESUME back from there.

Time is linear in lines times facts; a rule keeps its facts few, and ``MAX_FACTS`` of them before one line, or
``MAX_STEPS`` for each line all in all, end the search: then nothing is said. A short program may take ``LEAST_STEPS``,
none more than ``MOST_STEPS``, which bound the memory. Neither is anything said of a program of more than ``MAX_LINES``
lines, whose facts would take more memory than the program.
"""

from robolang.analysis.failing import may_fail
from robolang.analysis.tabulation import STOPS, Fact, Kind, Search, Step, Way, Ways
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

_WORDS: dict[str, Kind] = {
    "END": "end",
    "STOP": "end",
    "RETURN": "return",
    "RESUME": "resume",
    "RESUME NEXT": "resume next",
}


def ways_of(program: Program, structure: Structure) -> Ways:
    """Return the ways out of every line."""
    ways = [
        [Way(None, "go", index + 1)] if line.statement is None else _ways(line.statement, index, program, structure)
        for index, line in enumerate(program.lines)
    ]
    if any(way.kind == "catch" for out in ways for way in out):
        for out, line in zip(ways, program.lines, strict=True):
            if line.statement is not None and may_fail(line.statement):
                out.append(Way(None, "fail"))
    return ways


def _ways(node: Statement, at: int, program: Program, structure: Structure) -> list[Way]:
    below = at + 1
    if isinstance(node, If):
        taken, other = _ways(node.then, at, program, structure), node.otherwise
        return taken + ([Way(None, "go", below)] if other is None else _ways(other, at, program, structure))
    if isinstance(node, Jump):
        to = structure.line_of(node.target)
        return [Way(node, "end")] if to is None else [Way(node, "gosub" if node.word == "GOSUB" else "go", to)]
    if isinstance(node, OnError):
        to = structure.line_of(node.target)
        return [Way(node, "go", below) if to is None else Way(node, "catch", to)]
    if isinstance(node, Wait):
        to = None if node.target is None else structure.line_of(node.target)
        return [Way(node, "go", below), *([] if to is None else [Way(node, "go", to)])]
    if isinstance(node, CallSub):
        sub = structure.subs.get(node.name.key)
        return [Way(node, "go", below)] if sub is None else [Way(node, "call", sub + 1)]
    if isinstance(node, Sub):
        return [Way(node, "go", structure.end.get(at, at) + 1)]
    if isinstance(node, Word):
        if node.word == "ON ERROR STOP":
            return [Way(node, "catch", STOPS)]
        return [Way(node, _WORDS[node.word])] if node.word in _WORDS else [Way(node, "go", below)]
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
    return Search(ways, step).run(first)
