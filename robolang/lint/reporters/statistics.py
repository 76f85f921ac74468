"""How often each code was found, the commonest first."""

import json
from collections import Counter
from collections.abc import Sequence

from robolang.lint.engine import Checked
from robolang.lint.reporters.finding import findings
from runtime.core.faults import lookup


def render(results: Sequence[Checked], *, as_json: bool) -> str:
    """Return one row for each code: how often, code, name, and ``[*]`` when ``--fix`` corrects some of them."""
    found = findings(results)
    counts = Counter(item.code for item in found)
    fixable = Counter(item.code for item in found if item.fix is not None and item.fix.safe)
    # equal counts by code, so that equal results give equal texts
    order = sorted(counts, key=lambda code: (-counts[code], code))
    if as_json:
        rows = [
            {"code": code, "name": lookup(code).name, "count": counts[code], "fixable": fixable[code]} for code in order
        ]
        return json.dumps(rows, indent=2) + "\n"
    width = len(str(max(counts.values(), default=0)))
    return "".join(
        f"{counts[code]:>{width}}  {code}  {lookup(code).name}{'  [*]' if fixable[code] else ''}\n" for code in order
    )
