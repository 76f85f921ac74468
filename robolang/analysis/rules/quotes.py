"""A text in single quotes after PRINT, which is a comment."""

import re
from collections.abc import Iterator

from robolang.analysis.facts import Facts, parts_of
from robolang.analysis.lint_rule import Check, LintRule
from robolang.core.diagnostics import Diagnostic
from robolang.syntax.ast import Print
from runtime.core.faults import Code

MAX_SHOWN = 60
"""Longest text that a remedy repeats, in characters."""
_QUOTED = re.compile(r"'([^'\"]+)'[ \t]*")

COMMENT = LintRule(
    Code(
        code="RBL234",
        name="text-is-a-comment",
        meaning="A text in single quotes after PRINT is a comment: PRINT shows an empty line.",
        remedy="Write the text in double quotes.",
    ),
    why="Other languages write texts in single quotes. Here ' begins a comment, and the operator does not see the "
    "message.",
    bad="10 PRINT 'part is missing'\n",
    good='10 PRINT "part is missing"\n',
)


def find(facts: Facts) -> Iterator[Diagnostic]:
    """Report PRINTs without a value that a text in single quotes follows."""
    for line in facts.program.statements:
        comment = line.comment
        quoted = None if comment is None else _QUOTED.fullmatch(comment.text)
        if comment is None or quoted is None:
            continue
        *_, last = parts_of(line.statement)
        # a comment in quotes after PRINT x is one that somebody wrote on purpose
        if isinstance(last, Print) and not last.items:
            hint = f'write PRINT "{quoted[1]}"' if len(quoted[1]) <= MAX_SHOWN else ""
            yield COMMENT.at(comment.span, "this is a comment, not a text: PRINT shows an empty line", hint=hint)


CHECK = Check(find, COMMENT, beside_errors=True)
