"""What the order of statements shows: lines that cannot run, loads not declared, speeds and tools not set, lost blends.

Each rule is a fact that ``flow`` follows through the program, and what is reported where it ends badly:

    RBL221, RBL222   a line or a SUB that nothing leads to
    RBL226, RBL227   a move before SPEED, SPEEDJ or TOOL, in a program that sets one elsewhere
    RBL228           a move behind a HAND that grasped or let go, with no LOAD between them
    RBL229           a LOAD where one move would blend into the next: the arm stops for it
    RBL413           a ZONE of a move behind which the arm stops anyway

Called for programs without errors.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from robolang.analysis.dataflow import MAX_LINES, facts_before
from robolang.analysis.state_reads import reads_state
from robolang.analysis.tabulation import Way, Ways
from robolang.core.diagnostics import Diagnostic, Related, Severity
from robolang.core.source import Span
from robolang.evaluation.constant_folding import fixed
from robolang.syntax.ast import (
    Approach,
    Delay,
    Depart,
    Hand,
    HandState,
    Head,
    If,
    Load,
    LoadNamed,
    Move,
    MoveC,
    MoveJ,
    Moving,
    Out,
    Print,
    Program,
    Pulse,
    Seam,
    Setting,
    Speed,
    Statement,
    Sub,
    Time,
    Wait,
    Word,
    Zone,
)
from robolang.syntax.blocks import Structure, word_of

_STOPS = (Load, LoadNamed, Hand, Seam, Out, Pulse, Delay, Wait, Print)
"""Statements before which the arm comes to rest, besides TOOL, PAUSE and the end."""
_MOVES = (Move, MoveJ, MoveC, Approach, Depart)


def flow_check(program: Program, structure: Structure, flow: Callable[[], Ways]) -> Iterator[Diagnostic]:
    """Report what the order of the statements of a program shows, as warnings; ``flow`` gives its control flow."""
    if len(program.lines) > MAX_LINES:
        return
    ways = flow()
    before = facts_before(_resumed(program, structure, ways), True, lambda at, node, fact: (fact,))
    if before is None:  # where following nothing is too much, so is following anything
        return
    yield from _unreachable(program, before)
    for rule in (_speeds, _tools, _loads, _corners):
        yield from rule(program, ways)


def _resumed(program: Program, structure: Structure, ways: Ways) -> Ways:
    """Return the ways with those of RESUME NEXT, where a program has it: behind a CALL and a block that failed."""
    if not any(isinstance(node, Word) and node.word == "RESUME NEXT" for _, node in _parts(program)):
        return ways
    behind = {index: structure.end.get(index, index) + 1 for index, node in _parts(program) if isinstance(node, Head)}
    return [
        [*each, Way(None, "go", behind.get(index, index + 1))]
        if index in behind or any(way.kind == "call" for way in each)
        else each
        for index, each in enumerate(ways)
    ]


def _warn(code: str, span: Span, message: str, related: tuple[Related, ...] = (), hint: str = "") -> Diagnostic:
    return Diagnostic(code=code, severity=Severity.WARNING, span=span, message=message, related=related, hint=hint)


def _parts(program: Program) -> Iterator[tuple[int, Statement]]:
    """Yield every statement with its line, those of a one-line IF one by one."""
    for index, line in enumerate(program.lines):
        todo = [] if line.statement is None else [line.statement]
        while todo:
            node = todo.pop()
            if isinstance(node, If):
                todo += [part for part in (node.then, node.otherwise) if part is not None]
            yield index, node


# --- lines that cannot run -------------------------------------------------------------------------------------------


def _unreachable(program: Program, before: list[set[bool]]) -> Iterator[Diagnostic]:
    """Report SUBs that nothing calls, and the first of each run of other lines that nothing leads to."""
    said = False
    for index, line in enumerate(program.lines):
        node = line.statement
        if isinstance(node, Sub):
            said = not before[index + 1]
            if said:
                yield _warn("RBL222", node.name.span, f"nothing calls SUB {node.name.text}")
        elif node is None or before[index]:
            said = said and node is None
        elif not said and not word_of(node) and not (isinstance(node, Word) and node.word in ("END", "STOP")):
            yield _warn("RBL221", node.span, "this line can never run: nothing leads here")
            said = True


# --- speeds and tools ------------------------------------------------------------------------------------------------


def _speeds(program: Program, ways: Ways) -> Iterator[Diagnostic]:
    """Report the first straight move, and the first joint move, that can run before its speed was set."""
    parts = [node for _, node in _parts(program)]
    for word, joint, default in (("SPEED", False, "the robot's default"), ("SPEEDJ", True, "full speed")):
        moves = [node for node in parts if isinstance(node, _MOVES) and isinstance(node, MoveJ) is joint]
        said = any(isinstance(node, Setting) and node.word == word for node in parts)
        if not said and not any(isinstance(option, Speed) for node in moves for option in node.options):
            continue
        unset = _before_setting(ways, word, {node.span for node in moves if not _has(node, Speed, Time)})
        if unset:
            more = f", and {len(unset) - 1} more moves" if len(unset) > 1 else ""
            yield _warn("RBL226", unset[0].span, f"no {word} is set where this move runs{more}: it goes at {default}")


def _tools(program: Program, ways: Ways) -> Iterator[Diagnostic]:
    """Report the first move that can run before the tool was set, in a program that sets one."""
    if any(isinstance(node, Setting) and node.word == "TOOL" for _, node in _parts(program)):
        unset = _before_setting(ways, "TOOL", {node.span for _, node in _parts(program) if isinstance(node, _MOVES)})
        if unset:
            message = "TOOL is set elsewhere but not where this move runs: it goes with the hand's own tool point"
            yield _warn("RBL227", unset[0].span, message)


def _before_setting(ways: Ways, word: str, moves: set[Span]) -> list[Statement]:
    """Return those of the moves that can run before a setting was made, by place."""
    found: dict[Span, Statement] = {}

    def step(at: int, node: Statement, is_set: bool) -> tuple[bool]:
        if isinstance(node, Setting) and node.word == word:
            return (True,)
        if not is_set and node.span in moves:
            found[node.span] = node
        return (is_set,)

    if facts_before(ways, False, step) is None:
        return []
    return [found[span] for span in sorted(found, key=lambda span: span.start)]


def _has(node: Moving, *kinds: type) -> bool:
    return any(isinstance(option, kinds) for option in node.options)


# --- loads -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Hold:
    """Whether the hand is closed, the HAND since which no LOAD has come, if any, and whether one has come at all."""

    closed: bool = False
    pending: Span | None = None
    declared: bool = False


def _loads(program: Program, ways: Ways) -> Iterator[Diagnostic]:
    """Report every HAND that changes what is held and is followed by a move before a LOAD."""
    found: dict[Span, Moving] = {}

    def step(at: int, node: Statement, hold: _Hold) -> tuple[_Hold]:
        if isinstance(node, Hand) and (node.state is HandState.ON) is not hold.closed:
            return (_Hold(not hold.closed, node.span),)
        if isinstance(node, Hand) and not hold.declared and hold.pending is None:  # it was open: what it weighs?
            return (_Hold(hold.closed, node.span),)
        if isinstance(node, Load | LoadNamed):
            return (_Hold(hold.closed, declared=True),)
        if isinstance(node, _MOVES) and hold.pending is not None:
            found.setdefault(hold.pending, node)
            return (_Hold(hold.closed, declared=True),)
        return (hold,)

    if not any(isinstance(node, Hand) for _, node in _parts(program)) or facts_before(ways, _Hold(), step) is None:
        return
    for hand in (node for _, node in _parts(program) if isinstance(node, Hand) and node.span in found):
        does = "grasps" if hand.state is HandState.ON else "opens"
        related = (Related(span=found[hand.span].span, message="the arm moves here"),)
        yield _warn(
            "RBL228",
            hand.span,
            f"the hand {does} and the arm moves on without a LOAD: the controller goes on "
            "computing with the load before",
            related,
        )


# --- blends ----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Corner:
    """The place of the ZONE that is set, of the move whose end may be passed without a stop (None: the arm stands), and
    of the setting by which it may; None: by a ZONE of its own."""

    zone: Span | None = None
    move: Span | None = None
    by: Span | None = None


@dataclass(slots=True)
class _Corners:
    """What became of the corners: moves that blended on some way, those that did not, and LOADs within.

    ``zones`` are the ZONEs of moves, by place of the move. ``waiting`` are, by place of a setting, moves that read the
    state of the arm, so that it comes to rest before them although the move before could blend.
    """

    zones: dict[Span, Zone]
    used: set[Span] = field(default_factory=set)
    lost: dict[Span, Statement | None] = field(default_factory=dict)
    loads: dict[Span, Span] = field(default_factory=dict)
    waiting: dict[Span, Moving] = field(default_factory=dict)

    def step(self, at: int, node: Statement, corner: _Corner) -> tuple[_Corner]:
        """Follow one statement."""
        if isinstance(node, _MOVES):
            if corner.move is not None and not reads_state(node):
                self.used.add(corner.move if corner.by is None else corner.by)
            elif corner.by is not None:
                self.waiting.setdefault(corner.by, node)
            elif corner.move in self.zones:
                self.lost[corner.move] = node
            if not _blends(node, corner.zone is not None):
                return (_Corner(corner.zone),)
            return (_Corner(corner.zone, node.span, None if node.span in self.zones else corner.zone),)
        if isinstance(node, Setting) and node.word == "ZONE":
            is_set = node.value is not None and fixed(node.value) != 0.0
            return (_Corner(node.span if is_set else None, corner.move, corner.by),)
        if not _stops(node) or corner.move is None:
            return (corner,)
        if isinstance(node, Load | LoadNamed):
            self.loads[node.span] = corner.move
        elif corner.move in self.zones:
            self.lost[corner.move] = node
        return (_Corner(corner.zone),)


def _blends(node: Moving, is_set: bool) -> bool:
    for option in node.options:
        if isinstance(option, Zone):
            return option.value is not None and fixed(option.value) != 0.0
    return is_set


def _stops(node: Statement) -> bool:
    if isinstance(node, Setting):
        return node.word == "TOOL"
    if isinstance(node, Word):
        return node.word in ("PAUSE", "STOP", "END")
    return isinstance(node, _STOPS) or reads_state(node)


def _corners(program: Program, ways: Ways) -> Iterator[Diagnostic]:
    """Report ZONEs of moves that nothing blends into, and LOADs that keep moves from blending."""
    moves = [node for _, node in _parts(program) if isinstance(node, _MOVES)]
    zones = ((node.span, option) for node in moves for option in node.options if isinstance(option, Zone))
    corners = _Corners(dict(zones))
    before = facts_before(ways, _Corner(), corners.step)
    if before is None:
        return
    for corner in before[-1]:  # the program ends behind its last line
        if corner.move is not None and corner.move in corners.zones:
            corners.lost.setdefault(corner.move, None)
    for span, stop in corners.lost.items():
        if span not in corners.used:
            related = () if stop is None else (Related(span=stop.span, message="the arm comes to rest for this"),)
            yield _warn(
                "RBL413", corners.zones[span].span, "no move follows that this one could blend into: it stops", related
            )
    for setting, move in corners.waiting.items():
        if setting not in corners.used:
            related = (Related(span=move.span, message="this move reads where the arm is"),)
            hint = "assign HERE to a name before these moves and write them with that name, or remove the ZONE"
            yield _warn("RBL413", setting, "no move blends by this ZONE: the arm stops before each", related, hint)
    for load, span in corners.loads.items():
        related = (Related(span=span, message="the move that would blend"),)
        yield _warn(
            "RBL229", load, "the arm stops for this LOAD, where the move before it would blend into the next", related
        )
