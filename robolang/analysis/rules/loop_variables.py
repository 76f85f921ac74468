"""A FOR that counts with the variable of a FOR around it."""

from collections.abc import Iterator

from robolang.analysis.facts import Facts
from robolang.analysis.lint_rule import Check, LintRule
from robolang.core.diagnostics import Diagnostic, Related
from robolang.syntax.ast import For
from runtime.core.faults import Code

SHARED = LintRule(
    Code(
        code="RBL235",
        name="loop-variable-shared",
        meaning="A FOR counts with the same variable as a FOR around it.",
        remedy="Use another variable for the inner loop.",
    ),
    why="After the inner loop the variable has the last value of the inner loop. The outer loop continues with this "
    "wrong number, for example with the wrong place of a row.",
    bad="10 FOR I = 1 TO 3\n20 FOR I = 1 TO 2\n30 PRINT I\n40 NEXT\n50 NEXT\n",
    good="10 FOR I = 1 TO 3\n20 FOR K = 1 TO 2\n30 PRINT I; K\n40 NEXT\n50 NEXT\n",
    line=2,
)


def find(facts: Facts) -> Iterator[Diagnostic]:
    """Report each inner FOR that counts with the variable of an outer one."""
    lines = facts.program.lines
    for line, heads in zip(lines, facts.blocks.inside, strict=True):
        node = line.statement
        if not isinstance(node, For):
            continue
        # the innermost first, so that the note names the loop that the variable is taken from
        around = (lines[head].statement for head in reversed(heads))
        loops = (each for each in around if isinstance(each, For))
        outer = next((each for each in loops if each.variable.key == node.variable.key), None)
        if outer is not None:
            message = f"{node.variable.text} is also the variable of a FOR around this one, which loses its value"
            related = (Related(span=outer.variable.span, message=f"{outer.variable.text} is its variable here"),)
            yield SHARED.at(node.variable.span, message, related=related)


CHECK = Check(find, SHARED)
