"""What a check has found, in plain JSON types: for the log of a run and for pages, which have no folders."""

import ntpath
from typing import Any

from robolang.core.diagnostics import Diagnostic, Severity, to_json
from robolang.core.source import Source
from robolang.project.project import Project
from runtime.core.faults import lookup
from runtime.core.tomlfile import FileFault


def file_name(path: str) -> str:
    """Return the name of a file without its folders, of any system."""
    # also of a name that another system has written
    return ntpath.basename(path)


def of_project(project: Project) -> list[dict[str, Any]]:
    """Return what a run prints before it begins: the findings in the text, then what is unlikely about its files."""
    found = [of_diagnostic(item, project.source) for item in project.diagnostics]
    return found + [of_doubt(doubt) for doubt in project.cell.warnings]


def of_diagnostic(item: Diagnostic, source: Source) -> dict[str, Any]:
    """Return a finding as ``robolang check --output-format json`` has it, without folders."""
    found = to_json(item, source)
    places = [found, *found["related"]]
    for place in places:
        place["file"] = file_name(place["file"])
    return found


def of_doubt(doubt: FileFault) -> dict[str, Any]:
    """Return what is unlikely about a file, without folders."""
    return {
        "code": doubt.code,
        "name": lookup(doubt.code).name,
        "severity": Severity.WARNING.value,
        "message": doubt.message,
        "hint": doubt.hint,
        "file": file_name(doubt.path),
        "line": doubt.line,
        "column": doubt.column,
    }
