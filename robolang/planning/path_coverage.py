"""Every branch that a program may take in its cell, as far as conditions from outside decide it.

The simulated inputs lead a rehearsal along some branches. Each condition on them that may take the other branch
(``branch_forcing``) is forced to take it once, and the program is rehearsed again; conditions that are new after it are
forced in turn, until both branches of every such condition were taken or ``MOST_DETOURS`` rehearsals are done. A detour
is possible in the cell as far as the program decides; that two conditions may exclude one another is not known here.

Plans are remembered (``plan_memory``), so the part that a detour shares with another rehearsal costs nothing.
"""

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from robolang.core.source import Span
from robolang.execution.dry_run import Rehearsal, rehearse
from robolang.execution.plan_memory import PlanMemory
from robolang.interpreter.branch_oracle import Decisions
from robolang.planning.branch_forcing import open_conditions
from robolang.project.project import Project
from robolang.syntax.ast import If, Moving, Statement

MOST_DETOURS = 60
"""Most rehearsals besides the first."""
DETOUR_US = 600_000_000
"""Longest detour, us of simulated time: inputs need not come there as the cell simulates them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Detour:
    """A rehearsal in which conditions were forced: place of each and the result that it was given."""

    rehearsal: Rehearsal
    forced: Mapping[Span, bool]


@dataclass(frozen=True, slots=True, kw_only=True)
class Exploration:
    """The rehearsal by the simulated inputs, the detours, and the moves of the program that were never reached."""

    rehearsal: Rehearsal
    detours: tuple[Detour, ...]
    missed: tuple[Moving, ...]


def explore(project: Project, tell: Callable[[int], None] | None = None) -> Exploration:
    """Rehearse a checked program on every branch that it may take; ``tell`` as of ``rehearse``."""
    # one branch at a time: all combinations are exponential, and a move depends on little but where it starts
    plans = PlanMemory(project)
    conditions = open_conditions(project.program)
    decisions = Decisions()
    first = rehearse(project, decisions=decisions, plans=plans, tell=tell)
    taken: set[tuple[Span, bool]] = set()
    known: set[tuple[Span, bool]] = set()  # taken or queued: each branch is queued once, after the fewest others
    todo: deque[dict[Span, bool]] = deque()
    _queue(todo, {}, conditions, known, decisions)
    detours: list[Detour] = []
    while todo and len(detours) < MOST_DETOURS:
        forced = todo.popleft()
        branch = next(reversed(forced.items()))
        if branch in taken:  # another detour has come there since it was queued
            continue
        taken.add(branch)  # also where a fault ends the detour before the condition
        # not patient: a WAIT for an input that never comes on this branch would last to the end of the detour
        decisions = Decisions(forced, patient=False)
        rehearsal = rehearse(project, decisions=decisions, plans=plans, most_us=DETOUR_US, tell=tell)
        detours.append(Detour(rehearsal=rehearsal, forced=forced))
        taken |= _taken(decisions)
        _queue(todo, forced, conditions, known, decisions)
    reached = first.reached.union(*(detour.rehearsal.reached for detour in detours))
    missed = tuple(node for node in _moves(project) if node.span not in reached)
    return Exploration(rehearsal=first, detours=tuple(detours), missed=missed)


def _queue(
    todo: deque[dict[Span, bool]],
    forced: dict[Span, bool],
    conditions: Mapping[Span, object],
    known: set[tuple[Span, bool]],
    decisions: Decisions,
) -> None:
    """Queue the branches that conditions of a rehearsal did not take and that are not known yet, after its own."""
    known |= _taken(decisions)
    for place in decisions.taken:
        for result in (True, False) if place in conditions else ():
            if (place, result) not in known:
                known.add((place, result))
                todo.append({**forced, place: result})


def _taken(decisions: Decisions) -> set[tuple[Span, bool]]:
    return {(place, result) for place, results in decisions.taken.items() for result in results}


def _moves(project: Project) -> list[Moving]:
    todo: list[Statement | None] = [line.statement for line in reversed(project.program.statements)]
    found: list[Moving] = []
    while todo:
        node = todo.pop()
        if isinstance(node, If):
            todo += [node.otherwise, node.then]
        elif isinstance(node, Moving):
            found.append(node)
    return found
