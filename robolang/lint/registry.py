"""The rules of ``robolang check``: what is known of a code beyond its name, meaning and remedy.

Code, name, meaning and remedy are in the registry of ``runtime.core.faults``; here is what a page of documentation
needs besides: why the finding matters, a program that has it, the same program without it, and what ``--fix`` does. A
code without an entry is a rule all the same: it can be selected, ignored and suppressed, and its page is short. One
module holds the entries of one group of a hundred codes; a new one is a ``Rule`` in its list and, after ``python -m
robolang.lint.pages``, a page.
"""

from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING

import robolang.core.codes  # noqa: F401 - fills the registry of codes
from runtime.core.faults import Code, all_codes

if TYPE_CHECKING:
    from robolang.lint.rule import Rule

CHECKED = ("RBL1", "RBL2", "RBL3", "RBL40", "RBL413", "RBL415", "RBL507", "RBL534")
"""Beginnings of the codes that reading and checking a program can find."""


OF_THE_MOTION = frozenset(
    {
        "RBL410",
        "RBL411",
        "RBL412",
        "RBL414",
        "RBL416",
        "RBL419",
        "RBL421",
        "RBL422",
        "RBL423",
        "RBL424",
        "RBL425",
        "RBL426",
        "RBL427",
        "RBL428",
        "RBL429",
        "RBL434",
        "RBL435",
        "RBL440",
        "RBL441",
    }
)
"""Codes that only planning the motion finds: ``robolang check --motion``, and of refusals ``robolang run``."""

OF_THE_RUN = frozenset(
    {"RBL307", "RBL309", "RBL401", "RBL402", "RBL403", "RBL404", "RBL405", "RBL415", "RBL507", "RBL534"}
)
"""Codes of values, which a run may work out: checking finds those of numbers alone."""


def is_rule(code: str) -> bool:
    """Return whether checking a program can find a code, its motion included."""
    return code.startswith(CHECKED) or code in OF_THE_MOTION


def is_looked_for(code: str) -> bool:
    """Return whether a check without motion finds a code wherever it is; else its absence says nothing."""
    return code.startswith(CHECKED) and code not in OF_THE_RUN


def codes() -> list[Code]:
    """Return every code that checking a program can find, in numeric order, with or without a page."""
    return [entry for entry in all_codes() if is_rule(entry.code)]


@cache
def rules() -> "MappingProxyType[str, Rule]":
    """Return the rules that have a page, by code in numeric order; ``ValueError`` for a code with two."""
    # Pages are long texts that a check without findings never shows: they are read when one is asked for.
    from robolang.lint.rules import meaning, motion, planning, point, run, text

    found: dict[str, Rule] = {}
    for module in (text, meaning, point, motion, planning, run):
        for rule in module.RULES:
            if rule.code in found:
                raise ValueError(f"{rule.code} has two pages")
            found[rule.code] = rule
    return MappingProxyType({code: found[code] for code in sorted(found)})


def rule(code: str) -> "Rule | None":
    """Return the page of a code; None when it has none."""
    return rules().get(code)
