"""Edits of a program since the controller has taken it: the next one without errors is taken, whatever came between."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robolang.syntax.ast import Program
from robolang.teaching.line_map import LineMap

if TYPE_CHECKING:
    from robolang.execution.stepping import Breakpoint


@dataclass(frozen=True, slots=True)
class LineMoves:
    """Where the lines of a program went in several edits, one after the other."""

    edits: tuple[LineMap, ...] = ()

    def then(self, edit: LineMap) -> "LineMoves":
        """Return these edits and one more."""
        return LineMoves((*self.edits, edit))

    def of(self, index: int) -> int | None:
        """Return the new index of a line, None when one of the edits has deleted it."""
        # a line that was deleted and typed again is another one: what stood in it is not taken up
        found: int | None = index
        for edit in self.edits:
            found = None if found is None else edit.of(found)
        return found


def moved_breaks(
    breaks: "Mapping[int, Breakpoint]", before: Program, after: Program, lines: LineMap
) -> "dict[int, Breakpoint]":
    """Return breakpoints, by their lines of the file, in an edited program; those of deleted lines go."""
    at = {line.source_line: index for index, line in enumerate(before.lines)}
    found = {}
    for row, stop in breaks.items():
        index = lines.of(at[row]) if row in at else None
        if index is not None and index < len(after.lines):
            new = after.lines[index].source_line
            found[new] = replace(stop, line=new)
    return found
