"""Two people who teach into one points file: their changes put together, where no point was changed by both."""

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from robolang.project.points import read_points
from robolang.teaching.documents import Documents
from robolang.teaching.points_document import GROUP, point_values, text_of
from robolang.teaching.saving import text_on_disk
from robolang.teaching.toml_text import remove_table, rename_table, set_table
from runtime.core.faults import Fault
from runtime.core.tomlfile import Source

_Points = Mapping[str, Mapping[str, Any]]


class Merge:
    """What somebody else made of a points file since it was read, onto which our texts are put."""

    def __init__(self, read: str, theirs: str) -> None:
        self._read = read
        self._known: dict[str, str | None] = {}
        self.theirs = theirs

    def of(self, ours: str | None) -> str | None:
        """Return ``merged`` of one of our texts, None: we have no file of our own; equal ones are merged once."""
        text = self._read if ours is None else ours
        if text not in self._known:
            self._known[text] = merged(self._read, self.theirs, text)
        return self._known[text]

    @property
    def changed(self) -> tuple[str, ...]:
        """The names, in capitals, of the points that somebody else changed."""
        base, other = _points(self._read), _points(self.theirs)
        return tuple(name for name in dict.fromkeys((*base, *other)) if base.get(name) != other.get(name))


def merge_of(new: Documents, read: str | None) -> Merge | None:
    """Return the merge of a points file that was changed on the disk and here; None where nothing is to be merged.

    ``read``: its text when it was last read or saved, None: there was none.
    """
    theirs = text_on_disk(new.points_path)
    if theirs is None or new.points is None or theirs in (read, new.points) or read == new.points:
        return None
    # without a file both began with what the first change writes
    merge = Merge(text_of(replace(new, points=None)) if read is None else read, theirs)
    return None if merge.of(new.points) is None else merge


def merged(read: str, theirs: str, ours: str) -> str | None:
    """Return their text of a points file with our changes since ``read`` made in it; None: both changed one point.

    A change that is the same on both sides is one. None as well where a text cannot be used, or where we changed more
    than points.
    """
    if theirs == read:
        return ours
    try:
        base, other, own = (_points(text) for text in (read, theirs, ours))
        changed = [name for name in dict.fromkeys((*base, *own)) if base.get(name) != own.get(name)]
        changed = [name for name in changed if own.get(name) != other.get(name)]
        if any(base.get(name) != other.get(name) for name in changed) or _rest(read) != _rest(ours):
            return None
        return _made(theirs, ours, changed, own)
    except (Fault, tomllib.TOMLDecodeError, ValueError):
        return None


def _made(theirs: str, ours: str, changed: list[str], own: _Points) -> str:
    """Make our changes in their text: a point under a new name keeps its place and the comments around it."""
    base_like = _points(theirs)
    store = read_points(Source(GROUP, ours))
    text, removed = theirs, [name for name in changed if name not in own]
    for name in (name for name in changed if name in own):
        point = store.points[name]
        renamed = next((old for old in removed if base_like[old] == own[name]), None)
        if renamed is not None and name not in base_like:
            text = rename_table(text, GROUP, renamed, point.name)
            removed.remove(renamed)
        else:
            text = set_table(text, GROUP, point.name, point_values(point))
    for name in removed:
        text = remove_table(text, GROUP, name)
    read_points(Source(GROUP, text))
    return text


def _points(text: str) -> _Points:
    return {name.upper(): table for name, table in tomllib.loads(text).get(GROUP, {}).items()}


def _rest(text: str) -> dict[str, Any]:
    return {key: value for key, value in tomllib.loads(text).items() if key != GROUP}
