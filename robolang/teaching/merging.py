"""Two people who edit one points file or cell file: their changes put together, where nothing was changed by both."""

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from robolang.project.discovery import Texts
from robolang.project.points import read_points
from robolang.teaching.cell_document import text_of_cell
from robolang.teaching.documents import Documents
from robolang.teaching.names import FRAMES, LOADS, TOOLS
from robolang.teaching.points_document import GROUP, text_of
from robolang.teaching.saving import text_on_disk
from robolang.teaching.toml_text import Values, check_form, remove_table, rename_table, set_table, written
from runtime.cell.cell_file import parse_cell_file
from runtime.core.faults import Fault
from runtime.core.tomlfile import Source

_Key = tuple[str, str]
"""Group and name, in capitals, of a table."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """A file with tables ``[group.NAME]``; ``check`` raises ``Fault`` for a text that no such file can have."""

    groups: tuple[str, ...]
    check: Callable[[str], object]


class Merge:
    """What somebody else made of a file since it was read, onto which our texts of it are put."""

    def __init__(self, read: str, theirs: str, kind: Kind) -> None:
        self._read = read
        self._kind = kind
        self._known: dict[str, str | None] = {}
        self.theirs = theirs

    def of(self, ours: str | None) -> str | None:
        """Return ``merged`` of one of our texts, None: we have no file of our own; equal ones are merged once."""
        text = self._read if ours is None else ours
        if text not in self._known:
            self._known[text] = merged(self._read, self.theirs, text, self._kind)
        return self._known[text]

    @property
    def changed(self) -> tuple[str, ...]:
        """The names, in capitals, of what somebody else changed."""
        base, other = (_tables(text, self._kind.groups) for text in (self._read, self.theirs))
        return tuple(key[1] for key in dict.fromkeys((*base, *other)) if base.get(key) != other.get(key))


def merges(new: Documents, read: Texts) -> dict[str, Merge]:
    """Return the merges of points and cell, by the name of the field, where the file was changed on the disk and here.

    ``read``: the texts when they were last read or saved. What cannot be merged is not among them.
    """
    found = {}
    for field, path in (("points", new.points_path), ("cell", new.cell_path)):
        ours, before, theirs = getattr(new, field), read.get(path), text_on_disk(path)
        if theirs is None or ours in (None, before, theirs) or theirs == before:
            continue
        merge = Merge(_begun(new, field) if before is None else before, theirs, _kind(new, field))
        if merge.of(ours) is not None:
            found[field] = merge
    return found


def _begun(new: Documents, field: str) -> str:
    """Return what the first change of a file that is not there begins with, whoever makes it."""
    nothing = replace(new, cell=None) if field == "cell" else replace(new, points=None)
    return text_of_cell(nothing) if field == "cell" else text_of(nothing)


def _kind(new: Documents, field: str) -> Kind:
    if field == "points":
        return Kind(groups=(GROUP,), check=lambda text: read_points(Source(str(new.points_path), text)))
    where, folder = str(new.cell_path), new.cell_path.parent
    return Kind(groups=(FRAMES, TOOLS, LOADS), check=lambda text: parse_cell_file(Source(where, text), folder))


def merged(read: str, theirs: str, ours: str, kind: Kind) -> str | None:
    """Return their text with our changes since ``read`` made in it; None: both changed one table ``[group.NAME]``.

    A change that is the same on both sides is one. None as well where we changed anything else, and where the result
    would not be a file of its kind.
    """
    if ours == read:
        return theirs
    try:
        for group in kind.groups:
            check_form(Source("", theirs), group, "RBL601")
        base, other, own = (_tables(text, kind.groups) for text in (read, theirs, ours))
        changed = [key for key in dict.fromkeys((*base, *own)) if base.get(key) != own.get(key)]
        changed = [key for key in changed if own.get(key) != other.get(key)]
        if any(base.get(key) != other.get(key) for key in changed) or _rest(ours, kind) not in (
            _rest(read, kind),
            _rest(theirs, kind),
        ):
            return None
        text = _made(theirs, changed, other, own)
        kind.check(text)
    except (Fault, ValueError, TypeError, AttributeError):  # a text of theirs may be anything
        return None
    return text


_Tables = Mapping[_Key, tuple[str, Mapping[str, Any]]]
"""Spelling and values of the tables."""


def _made(theirs: str, changed: list[_Key], other: _Tables, own: _Tables) -> str:
    """Make our changes in their text: a table under a new name keeps its place and the comments around it."""
    text, removed = theirs, [key for key in changed if key not in own]
    for key in (key for key in changed if key in own):
        name, table = own[key]
        renamed = next((old for old in removed if old[0] == key[0] and other[old][1] == table), None)
        if renamed is not None and key not in other:
            text = rename_table(text, *renamed, name)
            removed.remove(renamed)
            continue
        gone: Values = dict.fromkeys(other[key][1] if key in other else ())
        text = set_table(text, key[0], name, {**gone, **{each: written(value) for each, value in table.items()}})
    for key in removed:
        text = remove_table(text, *key)
    return text


def _tables(text: str, groups: tuple[str, ...]) -> _Tables:
    whole = tomllib.loads(text)
    tables = ((group, name, table) for group in groups for name, table in whole.get(group, {}).items())
    return {(group, name.upper()): (name, dict(table)) for group, name, table in tables}


def _rest(text: str, kind: Kind) -> dict[str, Any]:
    return {key: value for key, value in tomllib.loads(text).items() if key not in kind.groups}
