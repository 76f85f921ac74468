"""Where the lines of a program went in an edit: a machine that stands at one of them is moved along.

Lines are counted as in ``Program.lines``: from 0, blank lines left out.
"""

import re
from dataclasses import dataclass

_LINE_END = re.compile(r"\r\n?|\n")


@dataclass(frozen=True, slots=True, kw_only=True)
class LineMap:
    """From line ``start`` on, ``removed`` lines became ``added`` lines; lines before and after them are the same.

    A line that was replaced by another one is at the place of that one. The default: nothing moved.
    """

    start: int = 0
    removed: int = 0
    added: int = 0

    @property
    def inverse(self) -> "LineMap":
        """Where the lines of the edited program were before the edit."""
        return LineMap(start=self.start, removed=self.added, added=self.removed)

    def of(self, index: int) -> int | None:
        """Return the new index of a line, None when it was deleted."""
        if index < self.start:
            return index
        if index >= self.start + self.removed:
            return index + self.added - self.removed
        return index if index - self.start < self.added else None


def lines_between(old: str, new: str) -> LineMap:
    """Return how the lines of one text became those of another: what differs lies between two parts that are equal."""
    before, after = program_lines(old), program_lines(new)
    start, shortest = 0, min(len(before), len(after))
    while start < shortest and before[start] == after[start]:
        start += 1
    same = 0
    while same < shortest - start and before[-1 - same] == after[-1 - same]:
        same += 1
    return LineMap(start=start, removed=len(before) - start - same, added=len(after) - start - same)


def program_lines(text: str) -> list[str]:
    """Return the lines of a program text that are not blank, as ``Program.lines`` counts them."""
    return [line for line in _LINE_END.split(text) if line.strip(" \t")]
