"""A lint rule: everything that is said of a finding, and the function that finds it, in one file of ``rules``.

To add a rule, write one file: a ``LintRule`` for each code and ``CHECK``, the function with its rules. The folder is
listed when the first program is checked, so there is nothing to register. The page of the rule and the table of codes
are generated.

Plain classes and no data classes: they are made at the start of every ``robolang check``.
"""

from collections.abc import Callable, Iterator

from robolang.analysis.facts import Facts
from robolang.core.diagnostics import Diagnostic, Related, Severity
from robolang.core.source import Span
from runtime.core.faults import Code, register

Find = Callable[[Facts], Iterator[Diagnostic]]


class LintRule:
    """A code with the text of its page. What it finds is a warning.

    Args:
        code: number, name, meaning and remedy; registered here.
        why: why the finding matters.
        bad: a program that has the finding at 1-based ``line`` and nowhere else.
        good: its correction.
        line: see ``bad``.
    """

    __slots__ = ("bad", "code", "good", "line", "why")

    def __init__(self, code: Code, *, why: str, bad: str, good: str, line: int = 1) -> None:
        register(code)
        self.code, self.why, self.bad, self.good, self.line = code, why, bad, good, line

    def at(self, span: Span, message: str, *, related: tuple[Related, ...] = (), hint: str = "") -> Diagnostic:
        """Return the finding at a place."""
        return Diagnostic(
            code=self.code.code, severity=Severity.WARNING, span=span, message=message, related=related, hint=hint
        )


class Check:
    """A function that finds something in a program, and the rules of what it finds.

    ``beside_errors``: it is called for programs with errors, too, since it needs a single statement only; its findings
    in a statement with an error are dropped. Others are called for programs without errors.
    """

    __slots__ = ("beside_errors", "find", "rules")

    def __init__(self, find: Find, *rules: LintRule, beside_errors: bool = False) -> None:
        self.find, self.rules, self.beside_errors = find, rules, beside_errors
