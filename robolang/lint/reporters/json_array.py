"""One JSON array with an object for each finding; the keys are those of ``diagnostics.to_json``, and ``fix``.

::

    {"code": "RBL112", "name": "unknown-instruction", "severity": "error", "message": ..., "hint": ...,
     "file": "pick.rbl", "line": 1, "column": 4, "end_line": 1, "end_column": 7,
     "related": [{"message": ..., "file": ..., "line": ..., ...}],
     "fix": null | {"title": ..., "safe": true, "edits": [{"line": ..., ..., "text": ...}]}}
"""

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from robolang.lint.engine import Checked
from robolang.lint.reporters.finding import Correction, Finding, findings


def render(results: Sequence[Checked], root: Path) -> str:
    """Return the array, indented."""
    return json.dumps([as_json(item) for item in findings(results)], indent=2) + "\n"


def as_json(item: Finding) -> dict[str, Any]:
    """Return a finding as an object of plain JSON types."""
    return {
        "code": item.code,
        "name": item.name,
        "severity": item.severity.value,
        "message": item.message,
        "hint": item.hint,
        "file": item.path,
        **asdict(item.region),
        "related": [{"message": note.message, "file": item.path, **asdict(note.region)} for note in item.notes],
        "fix": None if item.fix is None else _fix(item.fix),
    }


def _fix(fix: Correction) -> dict[str, Any]:
    edits = [{**asdict(region), "text": text} for region, text in fix.edits]
    return {"title": fix.title, "safe": fix.safe, "edits": edits}
