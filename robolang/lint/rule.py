"""A rule: what a page of documentation adds to a code, beyond its name, meaning and remedy."""

from dataclasses import dataclass

from robolang.core.diagnostics import Severity
from runtime.core.faults import Code, Stage, lookup

# the correction of RBL107 has a thousand lines
_MOST_LINES = 20


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """The page of one code.

    ``bad`` is a program that yields the code at 1-based ``line`` and nowhere else, ``good`` its correction. ``shown``
    is printed in place of a ``bad`` that cannot be: too long, or with invisible characters; a byte that is not UTF-8
    is written as its surrogate, ``\\udcb0`` for B0. ``fix`` describes what ``--fix`` does; empty: there is no fix.
    The example of a code that only the motion shows runs in the built-in cell. ``points``: ``bad`` and ``good`` are the
    points file ``pick.points.toml`` beside a program; ``line`` 0: there is no such file, and ``bad`` shows the folder.
    """

    code: str
    severity: Severity = Severity.ERROR
    why: str
    bad: str
    good: str
    line: int = 1
    shown: str = ""
    fix: str = ""
    points: bool = False

    @property
    def motion(self) -> bool:
        """Whether only the motion shows it."""
        return self.entry.stage is Stage.MOTION

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
