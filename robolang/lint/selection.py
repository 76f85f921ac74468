"""Which findings are reported: the selections of files and of the command line, one layer over another.

A *selector* is ``ALL``, the beginning of a code (``RBL2``, ``RBL20``), a whole code or the name of one, in any case. In
one layer the longest selector that fits a code decides, and of two equal ones the one that ignores. A layer that
selects starts anew: the selections of the layers below it no longer count. Without any layer everything is reported.

An error of syntax (RBL1xx with severity error) keeps a program from running whatever is selected, so it is hidden only
by its whole code or name in ``ignore``, never by a beginning or by selecting something else.
"""

from collections.abc import Iterable

import robolang.lint.registry  # noqa: F401 - selectors are compared with every code there is
from robolang.core.diagnostics import Diagnostic, Severity
from robolang.syntax.keywords import near
from runtime.core.faults import Group, all_codes, lookup
from runtime.core.record import Record

ALL = "ALL"
_PREFIX = "RBL"
# characters of a whole code: RBL and three digits
_WHOLE = 6


class Layer(Record):
    """Selectors of one place, as ``selector`` returns them; ``select`` None: the place selects nothing."""

    select: tuple[str, ...] | None = None
    extend: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()


class Selection(Record):
    """Layers, the lowest first."""

    layers: tuple[Layer, ...] = ()

    def keeps(self, diagnostic: Diagnostic) -> bool:
        """Return whether a finding is reported."""
        if is_syntax_error(diagnostic):
            return self._is_on(diagnostic.code, whole=True)
        return self._is_on(diagnostic.code, whole=False)

    def _is_on(self, code: str, *, whole: bool) -> bool:
        """Return whether a code is on; ``whole``: only whole codes count, and selecting others takes nothing away."""
        on = True
        for layer in self.layers:
            if layer.select is not None:
                # a layer that selects switches off what it does not name, but never an error of syntax
                on = whole
            chosen = _longest(code, (*(layer.select or ()), *layer.extend), whole)
            ignored = _longest(code, layer.ignore, whole)
            if chosen or ignored:
                on = chosen > ignored
        return on


def is_syntax_error(diagnostic: Diagnostic) -> bool:
    """Return whether a finding is an error of the text itself, which no blanket suppression hides."""
    return diagnostic.severity is Severity.ERROR and lookup(diagnostic.code).group is Group.TEXT


def selector(text: str) -> str | None:
    """Return a selector as ``Layer`` takes it, the beginning of codes; None when it fits no code."""
    word = text.strip().upper()
    if word == ALL:
        # every code begins with it
        return _PREFIX
    if word.startswith(_PREFIX) and any(entry.code.startswith(word) for entry in all_codes()):
        return word
    return words().get(word)


def words() -> dict[str, str]:
    """Return the code of each word that means one, in capitals: the codes themselves and their names."""
    return {form: entry.code for entry in all_codes() for form in (entry.code, entry.name.upper())}


def guess(text: str) -> str:
    """Return what a word that is no selector, or no whole code, was probably meant to be, as a hint, or ``""``."""
    word = text.strip()
    if word.upper().startswith(_PREFIX):
        # codes that differ in their last digit only
        alike = [entry.code for entry in all_codes() if entry.code.startswith(word.upper()[: _WHOLE - 1])]
        return f"similar codes: {', '.join(alike[:5])}{', and more' if len(alike) > 5 else ''}" if alike else ""
    found = near(word, (entry.name for entry in all_codes()), cutoff=0.7)
    return f"did you mean {found}?" if found else ""


def _longest(code: str, selectors: Iterable[str], whole: bool) -> int:
    fitting = [len(item) for item in selectors if code.startswith(item)]
    longest = max(fitting, default=0)
    # ignore = RBL1 must not hide that a program cannot run; its whole code may
    return longest if longest >= _WHOLE or not whole else 0
