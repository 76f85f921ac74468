"""The rules of ``robolang check``: every code that checking a program can find, and its page.

A code carries its stage and its group (``runtime.core.faults.Code``). A page adds why the finding matters, a program
that has it, the same program without it, and what ``--fix`` does. A lint rule of ``robolang.analysis.rules`` has code
and page in its own file. The pages of other codes, which the parser, the checker and the planner raise, are in
``robolang.lint.rules``, one module for each group. A code without a page is a rule all the same: it can be selected,
ignored and suppressed.
"""

from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING

from robolang.analysis.rules import checks
from robolang.core.diagnostics import Severity
from runtime.core.faults import Code, all_codes

if TYPE_CHECKING:
    from robolang.lint.rule import Rule

checks()  # registers the codes of the lint rules


def codes() -> list[Code]:
    """Return every code that checking a program can find, in numeric order, with or without a page."""
    return [entry for entry in all_codes() if entry.is_rule]


@cache
def rules() -> "MappingProxyType[str, Rule]":
    """Return the rules that have a page, by code in numeric order; ``ValueError`` for a code with two."""
    # Pages are long texts that a check without findings never shows: they are imported when one is needed.
    from robolang.lint.rule import Rule
    from robolang.lint.rules import meaning, motion, planning, point, run, text

    pages = [rule for module in (text, meaning, point, motion, planning, run) for rule in module.RULES]
    for rule in (rule for check in checks() for rule in check.rules):
        warning = Severity.WARNING
        pages.append(
            Rule(code=rule.code.code, severity=warning, why=rule.why, bad=rule.bad, good=rule.good, line=rule.line)
        )
    found: dict[str, Rule] = {}
    for page in pages:
        if page.code in found:
            raise ValueError(f"{page.code} has two pages")
        found[page.code] = page
    return MappingProxyType({code: found[code] for code in sorted(found)})


def rule(code: str) -> "Rule | None":
    """Return the page of a code; None when it has none."""
    return rules().get(code)
