"""Values and arrays that nothing reads."""

from collections.abc import Iterator

from robolang.analysis.facts import Facts
from robolang.analysis.lint_rule import Check, LintRule
from robolang.analysis.reads import reads
from robolang.core.diagnostics import Diagnostic
from robolang.syntax import other_languages
from robolang.syntax.ast import Assign, Const, Dim, Name, Statement
from robolang.syntax.keywords import near
from runtime.core.faults import Code

UNREAD = LintRule(
    Code(
        code="RBL225",
        name="value-unused",
        meaning="A name or an array gets a value, and nothing reads it.",
        remedy="Correct the name, use the value, or remove the line.",
    ),
    why="Usually the name is misspelt, here or where its value should be read. The program runs, but the value has no "
    "effect.",
    bad="10 COUNT = 0\n20 TOTAL = 3\n30 COUNT = COUNT + 1\n40 PRINT TOTAL\n",
    good="10 COUNT = 0\n20 TOTAL = 3\n30 COUNT = COUNT + 1\n40 PRINT TOTAL; COUNT\n",
)


def find(facts: Facts) -> Iterator[Diagnostic]:
    """Report values and arrays that nothing reads, at the first place that gives them a value."""
    given: dict[str, Name] = {}
    read: set[str] = set()
    for node in facts.statements:
        name = _gives(node)
        if name is not None:
            given.setdefault(name.key, name)
        read.update(reads(node))
    for key, name in given.items():
        if key not in read:
            known = other_languages.assigned(key)
            # guessed among the names that are read: a name that nothing reads is no help
            guess = "" if known else near(key, read)
            hint = f"did you mean {guess}?" if guess else known
            yield UNREAD.at(name.span, f"nothing reads {name.text}", hint=hint)


def _gives(node: Statement) -> Name | None:
    """Return the name to which a statement gives a value, or of an array; not that of a FOR, which counts."""
    if isinstance(node, Assign):
        return node.target if isinstance(node.target, Name) else None
    return node.name if isinstance(node, Const | Dim) else None


CHECK = Check(find, UNREAD)
