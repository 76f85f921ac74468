"""One JSON object on each line, with the keys of the form ``json``: for tools that read as it comes."""

import json
from collections.abc import Sequence
from pathlib import Path

from robolang.lint.engine import Checked
from robolang.lint.reporters.finding import findings
from robolang.lint.reporters.json_array import as_json


def render(results: Sequence[Checked], root: Path) -> str:
    """Return the lines."""
    return "".join(f"{json.dumps(as_json(item))}\n" for item in findings(results))
