"""The first columns of a table of statements: the line of the file and, where any has one, the line number."""

from collections.abc import Mapping, Sequence
from typing import Any

from runtime.core.program_line import named


def headings(rows: Sequence[Mapping[str, Any]]) -> tuple[str, ...]:
    """Return the headings for statements with ``line`` and ``number``."""
    return ("line", "no.") if any(row["number"] is not None for row in rows) else ("line",)


def cells(row: Mapping[str, Any], columns: tuple[str, ...]) -> list[str]:
    """Return the cells of a statement under ``headings``."""
    number = "" if row["number"] is None else str(row["number"])
    return [str(row["line"] or ""), number][: len(columns)]


def name(row: Mapping[str, Any]) -> str:
    """Return the line of a statement in words."""
    return named(row["line"], row["number"])
