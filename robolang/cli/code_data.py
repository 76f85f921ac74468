"""A code as plain JSON types, for ``robolang rules --json`` and ``robolang explain --json``."""

from typing import Any

from runtime.core.faults import Code


def code_data(entry: Code) -> dict[str, Any]:
    """Return what is known of a code; what only the page of a rule says is null for a code that has no page."""
    from robolang.lint.registry import rule

    known = rule(entry.code)
    return {
        "code": entry.code,
        "name": entry.name,
        "meaning": entry.meaning,
        "remedy": entry.remedy,
        "severity": None if known is None else known.severity.value,
        "why": None if known is None else known.why,
        "example": None if known is None else known.example,
        "instead": None if known is None else known.instead,
        "fix": None if known is None or not known.fix else known.fix,
        "found_by": None if known is None else known.found_by,
    }
