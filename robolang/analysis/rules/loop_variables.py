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
        meaning="A FOR counts with the variable of a FOR around it.",
        remedy="Count the inner loop with another variable.",
    ),
    why="After the inner loop the variable has the inner loop's last value. What the outer loop then does with it, "
    "such as going to the next place of a row, it does with a wrong number.",
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
        around = (lines[head].statement for head in reversed(heads))
        loops = (each for each in around if isinstance(each, For))
        outer = next((each for each in loops if each.variable.key == node.variable.key), None)
        if outer is not None:
            message = f"{node.variable.text} counts a FOR around this one: its value there is lost"
            related = (Related(span=outer.variable.span, message=f"{outer.variable.text} counts here"),)
            yield SHARED.at(node.variable.span, message, related=related)


CHECK = Check(find, SHARED)
