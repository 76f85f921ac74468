"""Frames, tools and loads, set and removed in the text of the cell file: its comments, order and layout stay.

A program in the built-in cell gets a cell file of its own with the first change, made from the built-in one; the
built-in points, which belong to that cell, go into its points file. Each function returns new documents. A text that is
damaged is left alone: ``FileFault`` RBL6xx at the place.
"""

from collections.abc import Sequence
from dataclasses import replace

from robolang.project.builtin import cell_text
from robolang.teaching.documents import Documents
from robolang.teaching.names import FRAMES, LOADS, TOOLS, check_free
from robolang.teaching.points_document import pose_text, taught, text_of
from robolang.teaching.toml_text import (
    Values,
    check_form,
    number,
    numbers,
    remove_table,
    rename_table,
    set_table,
    spelling,
)
from runtime.cell.cell_file import CellFile, parse_cell_file
from runtime.core.faults import Fault
from runtime.core.tomlfile import Source

_KG_DIGITS, _MM_DIGITS = 4, 3


def set_frame(documents: Documents, name: str, pose: Sequence[float]) -> Documents:
    """Set ``[frames.NAME]``: a pose (6,) in the world, mm and deg; ``Fault`` RBL718, ``FileFault`` RBL6xx."""
    return _set(documents, FRAMES, name, {"pose_mm_deg": pose_text(pose)})


def set_tool(documents: Documents, name: str, pose: Sequence[float]) -> Documents:
    """Set ``[tools.NAME]``: a pose (6,) on the flange, mm and deg; ``Fault`` RBL718, ``FileFault`` RBL6xx."""
    return _set(documents, TOOLS, name, {"pose_mm_deg": pose_text(pose)})


def set_load(documents: Documents, name: str, mass_kg: float, cog_mm: Sequence[float]) -> Documents:
    """Set ``[loads.NAME]``: mass, and centre of gravity (3,) in the flange frame; as ``set_frame``."""
    cog = numbers(number(each, _MM_DIGITS) for each in cog_mm)
    return _set(documents, LOADS, name, {"mass_kg": number(mass_kg, _KG_DIGITS), "cog_mm": cog})


def remove_from_cell(documents: Documents, group: str, name: str) -> Documents:
    """Remove a frame, tool or load; ``Fault`` RBL305: it is not there, or points are taught in it."""
    text = _present(documents, group, name)
    users = [point.name for point in taught(documents).points.values() if _names(point.frame, point.tool, group, name)]
    if users:
        message = f"{name} cannot be removed: it is the {group[:-1]} of {', '.join(users)}"
        raise Fault("RBL305", message, "Teach these points in another one first.")
    return _with(documents, remove_table(text, group, name))


def rename_in_cell(documents: Documents, group: str, name: str, new: str) -> Documents:
    """Give a frame, tool or load another name in the cell file alone; see ``renaming`` for all files."""
    return _with(documents, rename_table(_present(documents, group, name), group, name, new))


def cell_of(documents: Documents) -> CellFile:
    """Return the cell of documents, the built-in one where they have none; ``FileFault`` RBL6xx."""
    return parse_cell_file(_source(documents, text_of_cell(documents)), documents.cell_path.parent)


def _set(documents: Documents, group: str, name: str, values: Values) -> Documents:
    _check(documents, group)
    text = text_of_cell(documents)
    if spelling(text, group, name) is None:
        check_free(documents, group, name)
    return _with(documents, set_table(text, group, name, values))


def _check(documents: Documents, group: str) -> None:
    """Raise ``FileFault`` RBL6xx for a cell file that is damaged, or in which the group cannot be edited."""
    cell_of(documents)
    check_form(_source(documents, text_of_cell(documents)), group, "RBL601")


def _present(documents: Documents, group: str, name: str) -> str:
    _check(documents, group)
    text = text_of_cell(documents)
    if spelling(text, group, name) is None:
        raise Fault("RBL305", f"the cell has no {group[:-1]} {name}", "Name one that the cell file defines.")
    return text


def _names(frame: str, tool: str, group: str, name: str) -> bool:
    return {FRAMES: frame, TOOLS: tool}.get(group, "").upper() == name.upper()


def text_of_cell(documents: Documents) -> str:
    """Return the text of the cell file, or of the one that is written with the first change."""
    return cell_text() if documents.cell is None else documents.cell


def _source(documents: Documents, text: str) -> Source:
    return Source(str(documents.cell_path), text)


def _with(documents: Documents, text: str) -> Documents:
    points = documents.points
    # outside the built-in cell a program without a points file has no points
    if documents.cell is None and points is None:
        points = text_of(documents)
    new = replace(documents, cell=text, points=points)
    cell_of(new)
    return new
