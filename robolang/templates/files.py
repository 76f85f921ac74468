"""All files of a project: program, cell, points and test of a template, and what stands beside them in the folder."""

from collections.abc import Mapping
from pathlib import Path

from robolang.templates.arm import Arm
from robolang.templates.template import Template
from runtime.core.record import Record

_FOLDER = Path(__file__).parent / "folder"
_BESIDE = {
    ".github/workflows/robolang.yml": "robolang.yml",
    ".editorconfig": "editorconfig",
    ".vscode/settings.json": "settings.json",
    "README.md": "README.md",
}
"""Files of the folder by their names in a project."""


class ProjectFiles(Record):
    """Contents by the name in the folder: ``job`` is what runs, ``beside`` what a folder may have already."""

    job: Mapping[str, bytes]
    beside: Mapping[str, bytes]


def project_files(name: str, template: Template, arm: Arm, texts: Mapping[str, str]) -> ProjectFiles:
    """Return the files of a project; ``texts`` are those of the template, placed, by ending."""
    words = {"@NAME@": name, "@TITLE@": template.title, "@ROBOT@": arm.name}
    beside = {}
    # replaced word by word: $ and braces belong to the workflow
    for target, source in _BESIDE.items():
        text = (_FOLDER / source).read_text("utf-8")
        for word, value in words.items():
            text = text.replace(word, value)
        beside[target] = text.encode()
    job = {f"{name}{ending}": text.encode() for ending, text in texts.items()}
    return ProjectFiles(job={**job, **arm.files}, beside=beside)
