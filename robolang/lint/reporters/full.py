"""The form for people: each finding with the line it is in, a mark under the place and what would help."""

from collections.abc import Sequence
from pathlib import Path

from robolang.core.diagnostics import render as excerpt
from robolang.lint.engine import Checked


def render(results: Sequence[Checked], root: Path) -> str:
    """Return every finding with its excerpt; faults of files are not among them."""
    return "".join(f"{excerpt(item, result.source)}\n" for result in results for item in result.diagnostics)
