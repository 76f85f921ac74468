"""The note about a program that has names of a cell and no cell: one line in place of a guess at each of its errors."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robolang.cli.output import echo
from robolang.core.diagnostics import safe

if TYPE_CHECKING:
    from robolang.analysis.analysis import Analysis
    from robolang.core.diagnostics import Diagnostic

_NAMES = frozenset({"RBL301", "RBL305", "RBL306"})
"""Points, tools, frames, loads and sensors that are not there."""


def note_builtin_cell(analysis: "Analysis | None", diagnostics: "Iterable[Diagnostic]") -> None:
    """Print to stderr that a program runs in the built-in cell, where names of another one are missing."""
    missing = "" if analysis is None else analysis.cell.no_cell
    if missing and any(item.code in _NAMES for item in diagnostics):
        echo(safe(f"note: there is no {missing}: the built-in cell is used"), err=True)
