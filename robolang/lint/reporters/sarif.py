"""SARIF 2.1.0 (OASIS), for code scanning.

One run; its rules are those of the results, with the whole page of each as help: the pages have no address that a
``helpUri`` could name. Uris are relative to the root of the repository, columns count characters, fingerprints survive
edits elsewhere, fixes are replacements of regions.
"""

import json
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any
from urllib.parse import quote

from robolang.core.diagnostics import Severity
from robolang.lint.engine import Checked
from robolang.lint.pages import page
from robolang.lint.reporters.finding import Correction, Finding, Region, findings, fingerprints, relative
from runtime.core.faults import lookup

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}


def render(results: Sequence[Checked], root: Path) -> str:
    """Return the log."""
    found = findings(results)
    codes = sorted({item.code for item in found})
    levels = {item.code: _LEVELS[item.severity] for item in found}
    marked = zip(found, fingerprints(found, root), strict=True)
    version = import_module("robolang").__version__  # by name: the package itself leads to the numerics (a lazy import)
    run = {
        "tool": {
            "driver": {
                "name": "robolang",
                "version": version,
                "semanticVersion": version,
                "rules": [_rule(code, levels[code]) for code in codes],
            }
        },
        "columnKind": "unicodeCodePoints",
        "results": [_result(item, codes.index(item.code), mark, root) for item, mark in marked],
    }
    return json.dumps({"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2) + "\n"


def _rule(code: str, level: str) -> dict[str, Any]:
    entry = lookup(code)
    return {
        "id": code,
        "name": entry.name,
        "shortDescription": {"text": entry.meaning},
        "fullDescription": {"text": entry.meaning},
        "help": {"text": entry.remedy, "markdown": page(code)},
        "defaultConfiguration": {"level": level},
    }


def _result(item: Finding, index: int, fingerprint: str, root: Path) -> dict[str, Any]:
    where = _location(item.path, item.region, root)
    result = {
        "ruleId": item.code,
        "ruleIndex": index,
        "level": _LEVELS[item.severity],
        "message": {"text": f"{item.message}. Help: {item.hint}"},
        "locations": [where],
        "partialFingerprints": {"robolang/v1": fingerprint},
    }
    if item.notes:
        notes = [{"message": {"text": note.message}, **_location(item.path, note.region, root)} for note in item.notes]
        result["relatedLocations"] = notes
    if item.fix is not None:
        result["fixes"] = [_fix(item.fix, item.path, root)]
    return result


def _fix(fix: Correction, path: str, root: Path) -> dict[str, Any]:
    replacements = [{"deletedRegion": _region(region), "insertedContent": {"text": text}} for region, text in fix.edits]
    change = {"artifactLocation": {"uri": _uri(path, root)}, "replacements": replacements}
    return {"description": {"text": fix.title}, "artifactChanges": [change]}


def _location(path: str, region: Region, root: Path) -> dict[str, Any]:
    return {"physicalLocation": {"artifactLocation": {"uri": _uri(path, root)}, "region": _region(region)}}


def _region(region: Region) -> dict[str, int]:
    return {
        "startLine": region.line,
        "startColumn": region.column,
        "endLine": region.end_line,
        "endColumn": region.end_column,
    }


def _uri(path: str, root: Path) -> str:
    # surrogateescape: a file name that is not UTF-8 becomes the bytes that it has on the disk
    return quote(relative(path, root), safe="/", errors="surrogateescape")
