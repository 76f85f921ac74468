"""Workflow commands of GitHub Actions, which become annotations of the changed lines.

``::error title=robolang (RBL112),file=..,line=..,col=..,endLine=..,endColumn=..::message%0Ahelp``. In the message
``%``, CR and LF are escaped, in a property ``:`` and ``,`` as well. Columns are those of one line: of several lines the
runner drops them.
"""

from collections.abc import Sequence
from pathlib import Path

from robolang.core.diagnostics import Severity, safe
from robolang.lint.engine import Checked
from robolang.lint.reporters.finding import Finding, Region, findings, relative

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def render(results: Sequence[Checked], root: Path) -> str:
    """Return one command for each finding."""
    return "".join(f"{_command(item, root)}\n" for item in findings(results))


def _command(item: Finding, root: Path) -> str:
    region = item.region
    properties = {
        "title": f"robolang ({item.code})",
        "file": relative(item.path, root),
        **_lines(item.region),
    }
    listed = ",".join(f"{key}={_property(str(value))}" for key, value in properties.items())
    text = f"{safe(item.path)}:{region.line}:{region.column}: {item.code} {item.message}\nhelp: {item.hint}"
    return f"::{_COMMANDS[item.severity]} {listed}::{_data(text)}"


def _lines(region: Region) -> dict[str, int]:
    """Return the properties that say where a region is."""
    if region.line != region.end_line:
        return {"line": region.line, "endLine": region.end_line}
    return {"line": region.line, "col": region.column, "endLine": region.line, "endColumn": region.end_column}


def _data(text: str) -> str:
    # % first, or the escapes of the others would be escaped again
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
