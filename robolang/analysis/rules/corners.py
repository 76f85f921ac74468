"""Blends that do not take place: a ZONE before a stop, and a LOAD between two moves that would blend."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from robolang.analysis.dataflow import facts_before
from robolang.analysis.facts import Facts
from robolang.analysis.lint_rule import Check, LintRule
from robolang.analysis.moves import MOVES
from robolang.analysis.state_reads import reads_state
from robolang.core.diagnostics import Diagnostic, Related
from robolang.core.source import Span
from robolang.evaluation.constant_folding import fixed
from robolang.syntax.ast import Load, LoadNamed, Moving, Setting, Statement, Unparsed, Word, Zone
from robolang.syntax.statements import declaration
from runtime.core.faults import Code, Stage

NO_BLEND = LintRule(
    Code(
        code="RBL413",
        name="blend-at-the-end",
        meaning="A move has a ZONE, or a ZONE is set, but no move follows into which it could blend.",
        remedy="Write FINE at the move, or remove the ZONE; the arm stops there in any case.",
        found=Stage.CELL,
    ),
    why="There is no corner to round: the arm stops there for another statement. Either a move is missing, or the ZONE "
    "makes a reader expect a motion without a stop.",
    bad="10 MOVE P1, ZONE 20\n20 HAND ON\n",
    good="10 MOVE P1\n20 HAND ON\n",
)
LOAD_IN_BLEND = LintRule(
    Code(
        code="RBL229",
        name="load-in-blend",
        meaning="A LOAD stands between two moves that would blend, so the arm stops for it.",
        remedy="Move the LOAD to where the arm stands still, such as after the HAND, or end the move before it with "
        "FINE.",
    ),
    why="The load changes while the arm stands still, not during a move. The programmed blend does not take place, and "
    "the time that it should save is lost.",
    bad="10 MOVE P1, ZONE 20\n20 LOAD (0, 0, 60), 0.8\n30 MOVE P2\n",
    good="10 LOAD (0, 0, 60), 0.8\n20 MOVE P1, ZONE 20\n30 MOVE P2\n",
    line=2,
)


class _Corner(NamedTuple):
    """The place of the ZONE that is set, of the move whose end may be passed without a stop (None: the arm stands), and
    of the setting by which it may; None: by a ZONE of its own."""

    zone: Span | None = None
    move: Span | None = None
    by: Span | None = None


class _Corners:
    """What happens at the corners: moves that blend on some branch, those that do not, and LOADs between.

    ``zones`` are the ZONEs of moves, by place of the move. ``waiting`` are, by place of a setting, moves that read the
    state of the arm, so that it comes to rest before them although the move before could blend.
    """

    def __init__(self, zones: dict[Span, Zone]) -> None:
        self.zones = zones
        self.used: set[Span] = set()
        self.lost: dict[Span, Statement | None] = {}
        self.loads: dict[Span, Span] = {}
        self.waiting: dict[Span, Moving] = {}

    def step(self, at: int, node: Statement, corner: _Corner) -> tuple[_Corner]:
        """Follow one statement."""
        if isinstance(node, MOVES):
            return (self._after_move(node, corner),)
        if isinstance(node, Setting) and node.word == "ZONE":
            # ZONE 0 sets what FINE is (docs/language.md); a value that only the run knows counts as a zone
            is_set = node.value is not None and fixed(node.value) != 0.0
            return (_Corner(node.span if is_set else None, corner.move, corner.by),)
        if not _stops(node) or corner.move is None:
            return (corner,)
        if isinstance(node, Load | LoadNamed):
            # a LOAD gets a finding of its own, RBL229, so its move is not reported as RBL413 too
            self.loads[node.span] = corner.move
        elif corner.move in self.zones:
            self.lost[corner.move] = node
        return (_Corner(corner.zone),)

    def end(self, left: Iterable[_Corner]) -> None:
        """Note the moves with a ZONE that the program ends after."""
        for corner in left:
            if corner.move is not None and corner.move in self.zones:
                self.lost.setdefault(corner.move, None)

    def _after_move(self, node: Moving, corner: _Corner) -> _Corner:
        if corner.move is not None and not reads_state(node):
            self.used.add(corner.move if corner.by is None else corner.by)
        elif corner.by is not None:
            self.waiting.setdefault(corner.by, node)
        elif corner.move in self.zones:
            self.lost[corner.move] = node
        if not _blends(node, corner.zone is not None):
            return _Corner(corner.zone)
        return _Corner(corner.zone, node.span, None if node.span in self.zones else corner.zone)


def find(facts: Facts) -> Iterator[Diagnostic]:
    """Report ZONEs of moves that nothing blends into, and LOADs that keep moves from blending."""
    moves = [node for node in facts.statements if isinstance(node, MOVES)]
    corners = _Corners({node.span: option for node in moves for option in node.options if isinstance(option, Zone)})
    # None: the program is too long or too intricate to be followed, and then nothing is reported
    before = None if facts.reached is None else facts_before(facts.flow, _Corner(), corners.step)
    if before is None:
        return
    corners.end(before[-1])  # the program ends below its last line
    yield from _lost(corners)
    yield from _waiting(corners)
    for load, span in corners.loads.items():
        related = (Related(span=span, message="the move that would blend"),)
        message = "the arm stops for this LOAD; without it the move before would blend into the next one"
        yield LOAD_IN_BLEND.at(load, message, related=related)


def _lost(corners: _Corners) -> Iterator[Diagnostic]:
    """Report ZONEs of moves after which the arm stops wherever the program goes."""
    for span, stop in corners.lost.items():
        # on one branch it may blend and on another stop: only a ZONE that never has an effect is reported
        if span not in corners.used:
            related = () if stop is None else (Related(span=stop.span, message="the arm stops for this statement"),)
            message = "no move follows into which this one could blend: the arm stops here"
            yield NO_BLEND.at(corners.zones[span].span, message, related=related)


def _waiting(corners: _Corners) -> Iterator[Diagnostic]:
    """Report settings of ZONE with which no move blends, since each next one reads the position of the arm."""
    for setting, move in corners.waiting.items():
        if setting not in corners.used:
            yield NO_BLEND.at(
                setting,
                "no move blends with this ZONE: the arm stops before each of them",
                related=(Related(span=move.span, message="this move reads the position of the arm"),),
                hint="assign HERE to a name before these moves and use that name in them, or remove the ZONE",
            )


def _blends(node: Moving, is_set: bool) -> bool:
    for option in node.options:
        if isinstance(option, Zone):
            return option.value is not None and fixed(option.value) != 0.0
    return is_set


def _stops(node: Statement) -> bool:
    """Return whether the arm comes to rest before a statement."""
    if isinstance(node, Unparsed):
        return False
    ends = isinstance(node, Word) and node.word == "END"  # has no effect of its own, but no move follows
    return ends or declaration(node).drains or reads_state(node)


CHECK = Check(find, NO_BLEND, LOAD_IN_BLEND)
