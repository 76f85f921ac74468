"""One line for each finding: ``path:line:column: severity code message``, and ``[*]`` when ``--fix`` corrects it."""

from collections.abc import Sequence
from pathlib import Path

from robolang.core.diagnostics import safe
from robolang.lint.engine import Checked
from robolang.lint.reporters.finding import Finding, findings


def render(results: Sequence[Checked], root: Path) -> str:
    """Return the lines; faults of files are not among them."""
    without = [Checked(source=result.source, diagnostics=result.diagnostics) for result in results]
    return "".join(f"{_line(item)}\n" for item in findings(without))


def _line(item: Finding) -> str:
    place = f"{safe(item.path)}:{item.region.line}:{item.region.column}"
    mark = " [*]" if item.fix is not None and item.fix.safe else ""
    return f"{place}: {item.severity.value} {item.code} {item.message}{mark}"
