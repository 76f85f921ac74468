"""Moves that run before the program has set their speed or their tool, where it sets one elsewhere."""

from collections.abc import Iterator

from robolang.analysis.dataflow import facts_before
from robolang.analysis.facts import Facts
from robolang.analysis.lint_rule import Check, LintRule
from robolang.analysis.moves import MOVES, has_option
from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Span
from robolang.syntax.ast import MoveJ, Moving, Setting, Speed, Statement, Time
from runtime.core.faults import Code

SPEED_UNSET = LintRule(
    Code(
        code="RBL226",
        name="speed-unset",
        meaning="A move runs before the program has set a speed for it, although the program sets speeds for other "
        "moves.",
        remedy="Set SPEED or SPEEDJ before the first move, or give the move its own SPEED or TIME.",
    ),
    why="A program that sets a speed for some moves does so on purpose. The others run at the robot's default speed, "
    "which is too fast for most tasks and differs between robots.",
    bad="10 MOVE P1\n20 SPEED 250\n30 MOVE P2\n",
    good="10 SPEED 250\n20 MOVE P1\n30 MOVE P2\n",
)
TOOL_UNSET = LintRule(
    Code(
        code="RBL227",
        name="tool-unset",
        meaning="A move runs before the program has set TOOL, which it sets later.",
        remedy="Set TOOL before the first move.",
    ),
    why="The move uses the tool point of the hand. Once TOOL is set, as in a second round of the program, the same "
    "line moves the arm to another place.",
    bad="10 MOVE P1\n20 TOOL POSE(0, 0, 180, 0, 0, 0)\n30 MOVE P2\n",
    good="10 TOOL POSE(0, 0, 180, 0, 0, 0)\n20 MOVE P1\n30 MOVE P2\n",
)

_SPEEDS = (("SPEED", False, "the robot's default speed"), ("SPEEDJ", True, "full speed"))
"""Setting, whether it is that of joint moves, and the speed without it."""


def find(facts: Facts) -> Iterator[Diagnostic]:
    """Report the first move of each kind that can run before its speed was set, and the first before the tool was."""
    if facts.reached is None:
        return
    all_moves = [node for node in facts.statements if isinstance(node, MOVES)]
    for word, joint, default in _SPEEDS:
        moves = [node for node in all_moves if isinstance(node, MoveJ) is joint]
        # a program that sets no speed at all accepts the robot's default
        if _sets(facts, word) or any(has_option(node, Speed) for node in moves):
            yield from _speed(facts, moves, word, default)
    yield from _tool(facts, all_moves)


def _speed(facts: Facts, moves: list[Moving], word: str, default: str) -> Iterator[Diagnostic]:
    # TIME gives a move its speed, too
    unset = _before_setting(facts, word, {node.span for node in moves if not has_option(node, Speed, Time)})
    if unset:
        more = f" and {len(unset) - 1} other moves" if len(unset) > 1 else ""
        message = f"{word} is not set before this move{more}: it runs at {default}"
        yield SPEED_UNSET.at(unset[0].span, message)


def _tool(facts: Facts, moves: list[Moving]) -> Iterator[Diagnostic]:
    # a program that never sets TOOL means the hand's own tool point
    unset = _before_setting(facts, "TOOL", {node.span for node in moves}) if _sets(facts, "TOOL") else []
    if unset:
        message = "TOOL is set elsewhere, but not before this move: it uses the tool point of the hand"
        yield TOOL_UNSET.at(unset[0].span, message)


def _sets(facts: Facts, word: str) -> bool:
    return any(isinstance(node, Setting) and node.word == word for node in facts.statements)


def _before_setting(facts: Facts, word: str, moves: set[Span]) -> list[Statement]:
    """Return those of the moves that can run before a setting was made, by place."""
    found: dict[Span, Statement] = {}

    def step(at: int, node: Statement, is_set: bool) -> tuple[bool]:
        if isinstance(node, Setting) and node.word == word:
            return (True,)
        if not is_set and node.span in moves:
            found[node.span] = node
        return (is_set,)

    if facts_before(facts.flow, False, step) is None:
        return []
    return [found[span] for span in sorted(found, key=lambda span: span.start)]


CHECK = Check(find, SPEED_UNSET, TOOL_UNSET)
