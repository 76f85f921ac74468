"""The rules of ``robolang check``: what is known of a code beyond its name, meaning and remedy.

Code, name, meaning and remedy are in the registry of ``runtime.core.faults``; here is what a page of documentation
needs besides: why the finding matters, a program that has it, the same program without it, and what ``--fix`` does. A
code without an entry is a rule all the same: it can be selected, ignored and suppressed, and its page is short. One
module holds the entries of one group of a hundred codes; a new one is a ``Rule`` in its list and, after ``python -m
robolang.lint.pages``, a page.
"""

from dataclasses import dataclass
from functools import cache
from types import MappingProxyType

import robolang.core.codes  # noqa: F401 - fills the registry of codes
from robolang.core.diagnostics import Severity
from runtime.core.faults import Code, all_codes, lookup

_MOST_LINES = 20

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """What a page says of one code.

    ``bad`` is a program that yields the code at 1-based ``line`` and nowhere else, ``good`` its correction. ``shown``
    is printed in place of a ``bad`` that cannot be: too long, or with invisible characters; a byte that is not UTF-8
    is written as its surrogate, ``\\udcb0`` for B0. ``fix`` says what ``--fix`` does; empty: there is none.
    ``motion``: the finding needs the motion, in the built-in cell. ``points``: ``bad`` and ``good`` are the points file
    ``pick.points.toml`` beside a program; ``line`` 0: there is no such file, and ``bad`` shows the folder.
    """

    code: str
    severity: Severity = Severity.ERROR
    why: str
    bad: str
    good: str
    line: int = 1
    shown: str = ""
    fix: str = ""
    motion: bool = False
    points: bool = False

    @property
    def found_by(self) -> str:
        """Option and command with which a finding appears."""
        return "check --motion" if self.motion else "check"

    @property
    def entry(self) -> Code:
        """Name, meaning and remedy of the code."""
        return lookup(self.code)

    @property
    def example(self) -> str:
        """The program that has the finding, as it is printed: without a line end at its end."""
        return _printed(self.shown or self.bad)

    @property
    def instead(self) -> str:
        """Its correction, as it is printed."""
        return _printed(self.good)


def _printed(program: str) -> str:
    """Return the lines of a program with one kind of line end, of many the first."""
    lines = program.splitlines()
    return "\n".join(lines if len(lines) <= _MOST_LINES else [*lines[:2], "' and so on"])


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
def rules() -> MappingProxyType[str, Rule]:
    """Return the rules that have a page, by code in numeric order; ``ValueError`` for a code with two."""
    from robolang.lint.rules import meaning as meaning_rules
    from robolang.lint.rules import motion as motion_rules
    from robolang.lint.rules import planning as planning_rules
    from robolang.lint.rules import point as point_rules
    from robolang.lint.rules import run as run_rules
    from robolang.lint.rules import text as text_rules

    found: dict[str, Rule] = {}
    for module in (text_rules, meaning_rules, point_rules, motion_rules, planning_rules, run_rules):
        for rule in module.RULES:
            if rule.code in found:
                raise ValueError(f"{rule.code} has two pages")
            found[rule.code] = rule
    return MappingProxyType({code: found[code] for code in sorted(found)})


def rule(code: str) -> Rule | None:
    """Return the page of a code; None when it has none."""
    return rules().get(code)
