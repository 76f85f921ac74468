"""Edits of a program since the controller has taken it: the next one without errors is taken, whatever came between."""

from dataclasses import dataclass

from robolang.teaching.line_map import LineMap


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
