"""New projects: in a folder of their own, or in one that is there. All files are written or none; none is replaced."""

import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from robolang.core.storage import add_files, made_folders, only_one, write_folder
from robolang.templates.arm import choose
from robolang.templates.template import template
from runtime.core.faults import Fault
from runtime.core.record import Record

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")


if TYPE_CHECKING:
    from robolang.templates.files import ProjectFiles
    from robolang.templates.fitting import Fitted


class Written(Record):
    """A project that was written: its folder, its name, the files, and those that were there and were kept.

    ``notes``: what a user has to know about the arm; ``physics``: whether it is run with its drives.
    """

    folder: Path
    name: str
    files: tuple[str, ...]
    kept: tuple[str, ...]
    notes: tuple[str, ...]
    physics: bool


def new_project(folder: Path, kind: str, robot: str) -> Written:
    """Write a project into a new folder, with those above it.

    ``Fault`` RBL706, RBL708, RBL840 to RBL843, ``FileFault`` for a robot file.
    """
    name = checked_name(folder.name)
    if os.path.lexists(folder):
        raise Fault("RBL841", f"{folder} exists already", "Give another name, or call 'robolang init' in that folder.")
    made = _made(name, folder, kind, robot)
    files = {**made.job, **made.beside}
    # after the placing: a job that does not fit leaves no folder
    with made_folders(folder.absolute().parent):
        write_folder(folder, files, ours=lambda _: False)
    return _written(folder, name, files, (), made.fitted)


def init_project(folder: Path, name: str, kind: str, robot: str) -> Written:
    """Write a project into a folder that is there; faults as ``new_project``."""
    name = checked_name(name)
    made = _made(name, folder, kind, robot)
    with only_one(folder):
        # after the placing, which takes its time, and not before: a file may have come in between
        refuse_existing(folder, made.job)
        kept = tuple(each for each in made.beside if os.path.lexists(folder / each))
        files = {**made.job, **{each: data for each, data in made.beside.items() if each not in kept}}
        add_files(folder, files)
    return _written(folder, name, files, kept, made.fitted)


def checked_name(name: str) -> str:
    """Return a name of a project; ``Fault`` RBL842 for a text that is none."""
    if not _NAME.fullmatch(name):
        raise Fault("RBL842", f"'{name}' is no name of a project")
    return name


def refuse_existing(folder: Path, names: Iterable[str]) -> None:
    """Raise ``Fault`` RBL841 where files of these names are in a folder."""
    there = [name for name in names if os.path.lexists(folder / name)]
    if there:
        raise Fault("RBL841", f"{', '.join(there)} would be overwritten in {folder}")


def _written(folder: Path, name: str, files: Iterable[str], kept: tuple[str, ...], fitted: "Fitted") -> Written:
    return Written(folder=folder, name=name, files=tuple(files), kept=kept, notes=fitted.notes, physics=fitted.physics)


def _made(name: str, folder: Path, kind: str, robot: str) -> "ProjectFiles":
    chosen, arm = template(kind), choose(robot, folder)
    # not before: its numerics take longer to import than a misspelt name to refuse
    from robolang.templates.files import project_files
    from robolang.templates.fitting import fitted

    return project_files(name, chosen, arm, fitted(chosen, arm))
