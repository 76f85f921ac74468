"""Taught points, set and removed in the text of the points file: its comments, order and layout stay.

A program without a points file on the built-in cell has the built-in points: the first change writes them all into a
file of its own. Each function returns new documents. A text that is damaged or of a newer schema is left alone:
``FileFault`` RBL30x at the place.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from robolang.project.builtin import points_text
from robolang.project.points import Point, PointStore, read_points
from robolang.teaching.documents import Documents
from robolang.teaching.names import POINTS, check_free, check_not_taken
from robolang.teaching.toml_text import (
    Values,
    check_form,
    number,
    numbers,
    remove_table,
    rename_table,
    set_table,
    written,
)
from runtime.core.faults import Fault
from runtime.core.tomlfile import Source

Pose = tuple[float, float, float, float, float, float]
"""mm, mm, mm, deg, deg, deg."""
GROUP = POINTS
MM_DIGITS, DEG_DIGITS = 3, 4
"""Decimals of mm and deg in the file: 1 um and 0.0001 deg; see ``number``."""


def set_point(documents: Documents, point: Point, robot: str = "") -> Documents:
    """Teach a point, new or anew: every key of it is written, those that are empty are removed.

    A new point comes after the last one. ``robot``: on which it is taught, for a file that is written anew.
    ``Fault`` RBL718: no name for a point, or a variable, frame or tool has it; ``FileFault`` RBL30x.
    """
    text = text_of(documents, robot)
    if read_text(_source(documents, text)).get(point.name) is None:
        check_free(documents, GROUP, point.name)
    return _with(documents, set_table(text, GROUP, point.name, point_values(point)))


def remove_point(documents: Documents, name: str) -> Documents:
    """Remove a point; ``Fault`` RBL301, ``FileFault`` RBL30x."""
    text = text_of(documents)
    return _with(documents, remove_table(text, GROUP, _point(documents, text, name).name))


def copy_point(documents: Documents, name: str, new: str, pose: Pose | None = None) -> Documents:
    """Add a point with the values of another one, ``pose`` (mm, deg) in place of its own; after the last point.

    ``Fault`` RBL301: there is no such point; RBL718: the new name is not free.
    """
    point = _point(documents, text_of(documents), name)
    check_not_taken(taught(documents).get(new), new)
    if pose is not None:
        point = point.replaced(pose=pose, joints=None)
    return set_point(documents, point.replaced(name=new))


def rename_in_points(documents: Documents, name: str, new: str) -> Documents:
    """Give a point another name in the points file alone; see ``renaming`` for all files."""
    text = text_of(documents)
    return _with(documents, rename_table(text, GROUP, _point(documents, text, name).name, new))


def taught(documents: Documents) -> PointStore:
    """Return the points of documents, the built-in ones where these count; ``FileFault`` RBL30x."""
    return read_text(_source(documents, text_of(documents)))


def _point(documents: Documents, text: str, name: str) -> Point:
    found = read_text(_source(documents, text)).get(name)
    if found is None:
        raise Fault("RBL301", f"there is no point {name}", "Name a point that is taught.")
    return found


def text_of(documents: Documents, robot: str = "") -> str:
    """Return the text of the points file, or of the one that is written with the first change."""
    robot = robot or documents.robot
    if documents.points is not None:
        check_form(_source(documents, documents.points), GROUP, "RBL303")
        return documents.points
    if documents.cell is not None:
        return f"schema = 1\n{f'robot = {written(robot)}' + chr(10) if robot else ''}"
    text = points_text()
    return text if not robot else text.replace('robot = "puma560"', f"robot = {written(robot)}")


def _source(documents: Documents, text: str) -> Source:
    return Source(str(documents.points_path), text)


@lru_cache(maxsize=4)
def read_text(source: Source) -> PointStore:
    """Return the points of a text, read once for all that is done with it; ``FileFault`` RBL30x."""
    return read_points(source)


def _with(documents: Documents, text: str) -> Documents:
    # what was written is read as a run reads it, so that no file can come of it that a run refuses
    read_text(_source(documents, text))
    return replace(documents, points=text)


def point_values(point: Point) -> Values:
    """Return a point as its keys are written; what it does not have is None."""
    return {
        "pose": None if point.pose is None else pose_text(point.pose),
        "joints": None if point.joints is None else numbers(number(each, DEG_DIGITS) for each in point.joints),
        "frame": written(point.frame) if point.frame else None,
        "tool": written(point.tool) if point.tool else None,
        "configuration": written(" ".join(point.configuration)) if point.configuration else None,
        "turns": numbers(str(each) for each in point.turns) if point.turns else None,
        "comment": written(point.comment) if point.comment else None,
    }


def pose_text(pose: Sequence[float]) -> str:
    """Return a pose (mm, deg) as a points file and a cell file have it."""
    return numbers(number(each, MM_DIGITS if axis < 3 else DEG_DIGITS) for axis, each in enumerate(pose))
