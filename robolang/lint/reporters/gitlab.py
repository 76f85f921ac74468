"""Code Quality report of GitLab: an array of findings with a fingerprint that survives edits elsewhere."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from robolang.core.diagnostics import Severity
from robolang.lint.engine import Checked
from robolang.lint.reporters.finding import Finding, findings, fingerprints, relative

_SEVERITIES = {Severity.ERROR: "major", Severity.WARNING: "minor", Severity.INFO: "info"}


def render(results: Sequence[Checked], root: Path) -> str:
    """Return the report."""
    found = findings(results)
    marked = zip(found, fingerprints(found, root), strict=True)
    return json.dumps([_issue(item, mark, root) for item, mark in marked], indent=2) + "\n"


def _issue(item: Finding, fingerprint: str, root: Path) -> dict[str, Any]:
    region = item.region
    positions = {
        "begin": {"line": region.line, "column": region.column},
        "end": {"line": region.end_line, "column": region.end_column},
    }
    return {
        "description": f"{item.code} {item.message}",
        "check_name": item.name,
        "fingerprint": fingerprint,
        "severity": _SEVERITIES[item.severity],
        "location": {"path": relative(item.path, root), "positions": positions},
    }
