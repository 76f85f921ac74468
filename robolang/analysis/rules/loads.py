"""A HAND that changes what the arm carries, and no LOAD before the next move.

The fact that is followed is what the hand holds, and whether a LOAD has declared it since (``_Hold``).
"""

from collections.abc import Iterator
from typing import NamedTuple

from robolang.analysis.dataflow import facts_before
from robolang.analysis.facts import Facts
from robolang.analysis.lint_rule import Check, LintRule
from robolang.analysis.moves import MOVES
from robolang.core.diagnostics import Diagnostic, Related
from robolang.core.source import Span
from robolang.syntax.ast import Hand, HandState, Load, LoadNamed, Moving, Statement
from runtime.core.faults import Code

LOAD_MISSING = LintRule(
    Code(
        code="RBL228",
        name="load-missing",
        meaning="The hand closes or opens, and the arm moves on without a new LOAD.",
        remedy="Write a LOAD with all that the arm now carries after the HAND.",
    ),
    why="The controller computes gravity and inertia from the last LOAD. With the load of the empty hand the arm sags "
    "under the part, leaves its path, and is stopped because the payload does not match.",
    bad="10 LOAD (0, 0, 60), 0.8\n20 MOVE P1\n30 HAND ON\n40 MOVE P2\n",
    good="10 LOAD (0, 0, 60), 0.8\n20 MOVE P1\n30 HAND ON\n35 LOAD (0, 0, 95), 2.3\n40 MOVE P2\n",
    line=3,
)


class _Hold(NamedTuple):
    """Whether the hand is closed, the HAND since which no LOAD has come, if any, and whether one has come at all.

    ``declared`` is set by a finding too, ``loaded`` by a LOAD only.
    """

    closed: bool = False
    pending: Span | None = None
    declared: bool = False
    loaded: bool = False


def find(facts: Facts) -> Iterator[Diagnostic]:
    """Report every HAND that changes what is held and is followed by a move before a LOAD."""
    found: dict[Span, tuple[Moving, bool]] = {}

    def step(at: int, node: Statement, hold: _Hold) -> tuple[_Hold]:
        if isinstance(node, Hand):
            return (_after_hand(node, hold),)
        if isinstance(node, Load | LoadNamed):
            return (_Hold(hold.closed, declared=True, loaded=True),)
        if isinstance(node, MOVES) and hold.pending is not None:
            # declared from here on: one finding for a HAND, however many moves follow it
            found.setdefault(hold.pending, (node, hold.loaded))
            return (hold._replace(pending=None, declared=True),)
        return (hold,)

    hands = [node for node in facts.statements if isinstance(node, Hand)]
    if not hands or facts.reached is None or facts_before(facts.flow, _Hold(), step) is None:
        return
    for hand in (node for node in hands if node.span in found):
        does = "grasps" if hand.state is HandState.ON else "opens"
        move, loaded = found[hand.span]
        computes = "the LOAD before this line" if loaded else "no load, since there is no LOAD before this line"
        yield LOAD_MISSING.at(
            hand.span,
            f"the hand {does} and the arm moves on without a new LOAD: the controller still computes with {computes}",
            related=(Related(span=move.span, message="the arm moves here"),),
        )


def _after_hand(node: Hand, hold: _Hold) -> _Hold:
    closes = node.state is HandState.ON
    # a HAND that repeats the state of the hand changes nothing that the arm carries
    if closes is not hold.closed:
        return hold._replace(closed=closes, pending=node.span, declared=False)
    if not hold.declared and hold.pending is None:  # a hand that is open at the start weighs something, too
        return hold._replace(pending=node.span)
    return hold


CHECK = Check(find, LOAD_MISSING)
