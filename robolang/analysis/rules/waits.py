"""WAITs that may never end, and WAITs for a number."""

from collections.abc import Iterator

from robolang.analysis.facts import Facts
from robolang.analysis.lint_rule import Check, LintRule
from robolang.core.diagnostics import Diagnostic
from robolang.evaluation.constant_folding import fixed
from robolang.syntax.ast import Wait
from runtime.core import limits
from runtime.core.faults import Code

NO_TIMEOUT = LintRule(
    Code(
        code="RBL223",
        name="wait-without-timeout",
        meaning="A WAIT has no TIMEOUT: if its condition never becomes true, the program waits for ever.",
        remedy="Add TIMEOUT t, and GOTO or ON ERROR for the case that the time ends.",
    ),
    why="If a sensor fails or a plug comes loose, the cell stands still without a message. With a TIMEOUT the program "
    "can state which signal is missing. If waiting without end is intended, as for a start button, write noqa.",
    bad="10 WAIT IN(1) = 1\n20 MOVE P1\n",
    good="10 WAIT IN(1) = 1, TIMEOUT 5\n20 MOVE P1\n",
)
FOR_A_NUMBER = LintRule(
    Code(
        code="RBL233",
        name="wait-for-a-number",
        meaning="The condition of a WAIT is a number other than 0, so it is true at once.",
        remedy="Write DELAY for a pause, or a condition such as IN(1) = 1 for a signal.",
    ),
    why="In other languages WAIT with a number is a pause. Here it waits for a condition, and every number but 0 is "
    "true: the program continues at once, before a valve or a gripper has moved.",
    bad="10 WAIT 2\n20 MOVE P1\n",
    good="10 DELAY 2\n20 MOVE P1\n",
)


def find(facts: Facts) -> Iterator[Diagnostic]:
    """Report WAITs without a TIMEOUT and WAITs for a number."""
    for node in facts.statements:
        if not isinstance(node, Wait):
            continue
        # WAIT 0 is never true: it waits for ever, which is the finding below
        if value := fixed(node.condition):
            delay = f"DELAY {value:g} waits for {value:g} s" if 0.0 < value <= limits.DELAY.high else ""
            message = f"WAIT {value:g} does not wait: its condition is a number other than 0"
            yield FOR_A_NUMBER.at(node.span, message, hint=delay)
        elif node.timeout is None:
            message = "this WAIT has no TIMEOUT: if its condition never becomes true, the program waits here for ever"
            yield NO_TIMEOUT.at(node.span, message)


CHECK = Check(find, NO_TIMEOUT, FOR_A_NUMBER, beside_errors=True)
