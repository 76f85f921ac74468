"""Lines that cannot run: a SUB that nothing calls, and a line that nothing leads to."""

from collections.abc import Iterator

from robolang.analysis.facts import Facts
from robolang.analysis.lint_rule import Check, LintRule
from robolang.core.diagnostics import Diagnostic
from robolang.syntax.ast import Statement, Sub, Word
from robolang.syntax.blocks import word_of
from runtime.core.faults import Code

UNREACHABLE = LintRule(
    Code(
        code="RBL221",
        name="unreachable",
        meaning="A line can never run: the program always leaves the line above, and no jump leads here.",
        remedy="Remove the line, correct the jump above it, or jump to it by a label.",
    ),
    why="The line looks like part of the work but never runs: a condition before the jump was lost, or the line is "
    "left over.",
    bad="10 *AGAIN MOVE P1\n20 GOTO *AGAIN\n30 MOVE P2\n",
    good="10 *AGAIN MOVE P1\n20 IF IN(1) THEN GOTO *AGAIN\n30 MOVE P2\n",
    line=3,
)
UNUSED_SUB = LintRule(
    Code(
        code="RBL222",
        name="sub-unused",
        meaning="A SUB is never called.",
        remedy="Call the SUB, or remove it.",
    ),
    why="The steps are written down but never run: a CALL is missing, or the SUB is left over.",
    bad="10 SPEED 200\n20 END\n30 SUB PICK\n40 MOVE P1\n50 ENDSUB\n",
    good="10 SPEED 200\n15 CALL PICK\n20 END\n30 SUB PICK\n40 MOVE P1\n50 ENDSUB\n",
    line=3,
)


def find(facts: Facts) -> Iterator[Diagnostic]:
    """Report SUBs that nothing calls, and the first of each run of other lines that nothing leads to."""
    reached = facts.reached
    if reached is None:
        return
    reported = False
    for index, line in enumerate(facts.program.lines):
        node = line.statement
        if isinstance(node, Sub):
            # the lines of a SUB that nothing calls are covered by its finding
            reported = not reached[index + 1]
            if reported:
                yield UNUSED_SUB.at(node.name.span, f"nothing calls SUB {node.name.text}")
        elif node is None:
            continue  # a comment belongs to the run of lines around it
        elif reached[index]:
            reported = False
        elif not reported and _acts(node):
            yield UNREACHABLE.at(node.span, "this line can never run: no line leads to it")
            reported = True


def _acts(node: Statement) -> bool:
    """Return whether a line does something: the end of a block or an END that is not reached does no harm."""
    return not word_of(node) and not (isinstance(node, Word) and node.word in ("END", "STOP"))


CHECK = Check(find, UNREACHABLE, UNUSED_SUB)
