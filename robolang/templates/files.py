"""All files of a project: program, cell, points and test of a template, and what stands beside them in the folder."""

from collections.abc import Mapping
from pathlib import Path

from robolang.templates.arm import Arm
from robolang.templates.fitting import Fitted
from robolang.templates.template import Template
from runtime.core.faults import Fault
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
    """Contents by the name in the folder: ``job`` is what runs, ``beside`` what a folder may have already.

    ``fitted`` is the template before its arm.
    """

    job: Mapping[str, bytes]
    beside: Mapping[str, bytes]
    fitted: Fitted


def project_files(name: str, template: Template, arm: Arm, fitted: Fitted) -> ProjectFiles:
    """Return the files of a project; ``Fault`` RBL842 where its name clashes with a file of the arm."""
    words = {"@NAME@": name, "@TITLE@": template.title, "@ROBOT@": arm.name}
    beside = {}
    # replaced word by word: $ and braces belong to the workflow
    for target, source in _BESIDE.items():
        text = (_FOLDER / source).read_text("utf-8")
        for word, value in words.items():
            text = text.replace(word, value)
        beside[target] = text.encode()
    job = {f"{name}{ending}": text.encode() for ending, text in fitted.texts.items()}
    copied = {**fitted.meshes, **arm.files}
    for file in copied:
        if file in job or file in beside:
            raise Fault("RBL842", f"the robot file {file} has the name of a file of the project", "Give another name.")
    return ProjectFiles(job={**job, **copied}, beside=beside, fitted=fitted)
