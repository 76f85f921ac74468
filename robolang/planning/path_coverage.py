"""Every way that a program may take in its cell, as far as conditions from outside decide it.

The simulated inputs lead a rehearsal one way. From there each condition that can go the other way (``branches``) is
sent there once, and the program rehearsed again; what is new behind it is sent its other ways in turn, until every such
condition has gone both ways or ``MOST_DETOURS`` rehearsals are done. What a detour shows is possible in the cell as far
as the program goes; that two conditions may exclude one another is not known here.

Plans are remembered (``plan_memory``), so the part that a detour shares with another rehearsal costs nothing.
"""

from collections import deque
from collections.abc import Mapping
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
"""Longest detour, us of simulated time: on its way inputs need not come as the cell simulates them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Detour:
    """A rehearsal in which conditions were sent another way: place of each and the way it took."""

    rehearsal: Rehearsal
    forced: Mapping[Span, bool]


@dataclass(frozen=True, slots=True, kw_only=True)
class Exploration:
    """The rehearsal by the simulated inputs, the detours, and the moves of the program that none of them reached."""

    rehearsal: Rehearsal
    detours: tuple[Detour, ...]
    missed: tuple[Moving, ...]


def explore(project: Project) -> Exploration:
    """Rehearse a checked program on every way that it may take."""
    plans = PlanMemory(project)
    conditions = open_conditions(project.program)
    decisions = Decisions()
    first = rehearse(project, decisions=decisions, plans=plans)
    gone: set[tuple[Span, bool]] = set()
    known: set[tuple[Span, bool]] = set()  # gone or queued: each way is queued once, behind the fewest others
    todo: deque[dict[Span, bool]] = deque()
    _queue(todo, {}, conditions, known, decisions)
    detours: list[Detour] = []
    while todo and len(detours) < MOST_DETOURS:
        forced = todo.popleft()
        place, way = next(reversed(forced.items()))
        if (place, way) in gone:
            continue
        gone.add((place, way))  # also where a fault keeps it from being asked
        decisions = Decisions(forced, patient=False)
        rehearsal = rehearse(project, decisions=decisions, plans=plans, most_us=DETOUR_US)
        detours.append(Detour(rehearsal=rehearsal, forced=forced))
        gone |= {(each, taken) for each, ways in decisions.taken.items() for taken in ways}
        _queue(todo, forced, conditions, known, decisions)
    tried = first.tried.union(*(detour.rehearsal.tried for detour in detours))
    missed = tuple(node for node in _moves(project) if node.span not in tried)
    return Exploration(rehearsal=first, detours=tuple(detours), missed=missed)


def _queue(
    todo: deque[dict[Span, bool]],
    forced: dict[Span, bool],
    conditions: Mapping[Span, object],
    known: set[tuple[Span, bool]],
    decisions: Decisions,
) -> None:
    """Queue the ways that conditions of a rehearsal did not go and that are not known yet, behind its own."""
    known |= {(place, way) for place, ways in decisions.taken.items() for way in ways}
    for place in decisions.taken:
        for way in (True, False) if place in conditions else ():
            if (place, way) not in known:
                known.add((place, way))
                todo.append({**forced, place: way})


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
