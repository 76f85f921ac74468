"""The documents of a session: what was changed, taken back and saved. The only part of the documents with a state."""

import os
from bisect import bisect_left
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.analysis.analysis import Analysis
from robolang.core.diagnostics import Edit
from robolang.core.source import Span
from robolang.project.builtin import cell_text, points_text
from robolang.project.discovery import Texts, Typed, cell_beside, own_cell
from robolang.teaching.documents import Documents
from robolang.teaching.line_map import LineMap, lines_between
from robolang.teaching.merging import Merge, merges
from robolang.teaching.saving import SaveFault, alone, as_saved, check, unified, write
from runtime.core.faults import Fault

MOST_STEPS = 200
"""So many changes can be taken back."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Step:
    """The documents before a change, or after one that was taken back, and what the change was."""

    documents: Documents
    what: str
    lines: LineMap


class Desk:
    """Documents that are edited; ``analysis`` is of the program in them, and follows every change."""

    def __init__(self, documents: Documents, read: Texts | None = None) -> None:
        """``read``: the texts that the files had when they were read; None: those of the documents."""
        self._documents = documents
        self._disk: Texts = (documents.texts if documents.named else {}) if read is None else read
        self._past: deque[_Step] = deque(maxlen=MOST_STEPS)
        self._future: list[_Step] = []
        self._dropped: list[_Step] = []
        self.analysis = Analysis(source=documents.source)
        self.lines = LineMap()
        """How the lines of the program moved in the last change, undo, redo or save."""
        self.taken_over: tuple[str, ...] = ()
        """Points, frames, tools and loads that somebody else changed on the disk, and that the last save kept."""

    @property
    def documents(self) -> Documents:
        """The documents as they are now."""
        return self._documents

    @property
    def typed(self) -> Typed:
        """What ``load_project`` takes, with the analysis that is known."""
        return self._documents.typed(self.analysis)

    @property
    def read(self) -> Texts:
        """The texts of the files as they were last read or saved; a file that was not there is not among them."""
        return {path: text for path, text in self._disk.items() if text is not None}

    @property
    def unsaved(self) -> tuple[Path, ...]:
        """The files whose text differs from what was last read or saved, in the order of saving."""
        return tuple(self._changed(self._documents))

    def change(self, new: Documents, what: str, lines: LineMap | None = None) -> None:
        """Put new documents in place of the old; ``what`` names the change where it is taken back.

        ``lines``: where the lines of the program went; None: by what differs in the texts.
        """
        if new == self._documents:
            self.lines = LineMap()  # of this change, and not of the one before
            return
        lines = lines or lines_between(self._documents.program, new.program)
        self._past.append(_Step(documents=self._documents, what=what, lines=lines))
        self._dropped, self._future = self._future, []
        self._put(new, lines)

    def undo(self) -> str:
        """Take the last change back and return what it was; ``Fault`` RBL715."""
        if not self._past:
            raise Fault("RBL715", "there is no change to take back")
        step = self._past.pop()
        self._future.append(_Step(documents=self._documents, what=step.what, lines=step.lines))
        self._put(step.documents, step.lines.inverse)
        return step.what

    def refuse(self) -> None:
        """Take the last change back for good, as if it had not been made: what ``redo`` could bring back, it can."""
        self.undo()
        self._future = self._dropped

    def redo(self) -> str:
        """Make the change that was last taken back again and return what it was; ``Fault`` RBL715."""
        if not self._future:
            raise Fault("RBL715", "there is no change that was taken back")
        step = self._future.pop()
        self._past.append(_Step(documents=self._documents, what=step.what, lines=step.lines))
        self._put(step.documents, step.lines)
        return step.what

    def diff(self) -> str:
        """Return a unified diff from the files as they were last read or saved; empty when nothing is unsaved."""
        texts = self._documents.texts
        return "".join(unified(path, self._disk.get(path), texts[path]) for path in self.unsaved)

    def save(self, *, force: bool = False) -> tuple[Path, ...]:
        """Write what is unsaved, the program through the formatter, and return the files that were written.

        Raises ``Fault`` RBL716 for a program without a name, ``ConflictFault`` RBL714 with nothing written where
        somebody else changed a file (``force`` overwrites it), ``SaveFault`` RBL312 where a file cannot be written; the
        documents are then unsaved as before, those of the files that were written excepted. Points that somebody else
        changed and that were not changed here are taken over.
        """
        if not self._documents.named:
            raise Fault("RBL716", "the program has no name yet")
        new = self._documents
        if new.path in self.unsaved:
            new = as_saved(new, self.analysis)
        self.lines, self.taken_over = LineMap(), ()
        with alone(self._changed(new)):
            # also where it is forced: points that can be put together are nobody's to lose
            found = merges(new, self._disk)
            new = _merged(new, found) or new
            files = self._changed(new)
            if not force:
                check(files, {**self._disk, **{new.path_of(field): merge.theirs for field, merge in found.items()}})
            saved: tuple[Path, ...] = ()
            try:
                write(files)
                saved = tuple(files)
            except SaveFault as fault:
                saved = fault.saved
                raise
            finally:
                self._settle(new, saved, found)
        return saved

    def _settle(self, new: Documents, saved: tuple[Path, ...], found: Mapping[str, Merge]) -> None:
        """Take over what a save has made of the documents, in the files that were written."""
        self._disk = {**self._disk, **{path: new.texts[path] for path in saved}}
        done = {field: merge for field, merge in found.items() if new.path_of(field) in saved}
        if done:
            # also in the history: an undo must not remove what somebody else taught
            self._past = deque(reversed(_rebased(reversed(self._past), done)), self._past.maxlen)
            self._future = list(reversed(_rebased(reversed(self._future), done)))
            self._put(_merged(self._documents, done) or self._documents)
            self.taken_over = tuple(name for merge in done.values() for name in merge.changed)
        if new.path in saved:
            self._put(replace(self._documents, program=new.program))

    def save_as(self, path: Path, *, force: bool = False) -> tuple[Path, ...]:
        """Give the program another name, write it there with its points and its cell, and return the files.

        A name gets the ending ``.rbl`` where it lacks it. A cell file that the new program finds beside it is not
        copied. Raises ``Fault`` RBL706 for what is no name of a file, and where one of the files is there already,
        unless ``force``; and as ``save``. The documents then have their old name.
        """
        move = _mover(self._documents, _program_path(path))
        new = move(self._documents)
        there = [file for file in new.texts if file not in self._documents.texts and os.path.lexists(file)]
        if there and not force:
            raise Fault("RBL706", f"{there[0]} is there already", "Give another name.")
        before = self._documents, self._disk, self.analysis
        self._disk = {file: self._disk.get(file) for file in new.texts}
        self._put(new)
        try:
            files = self.save(force=force)
        except Fault:
            self._documents, self._disk, self.analysis = before
            raise
        self._past = deque((replace(step, documents=move(step.documents)) for step in self._past), self._past.maxlen)
        self._future = [replace(step, documents=move(step.documents)) for step in self._future]
        return files

    def _changed(self, documents: Documents) -> Texts:
        """Return the texts that differ from the disk; nothing is lost with a program that is empty and has no name."""
        nothing = (None,) if documents.named else (None, "")
        return {
            path: text
            for path, text in documents.texts.items()
            if text != self._disk.get(path) and (text not in nothing or self._disk.get(path) is not None)
        }

    def _put(self, new: Documents, lines: LineMap | None = None) -> None:
        old = self._documents
        self._documents, self.lines = new, lines or lines_between(old.program, new.program)
        if new.path != old.path:
            self.analysis = Analysis(source=new.source)
        elif new.program != old.program:
            self.analysis = self.analysis.updated(_difference(old.program, new.program))


def _merged(documents: Documents, found: Mapping[str, Merge]) -> Documents | None:
    """Return documents on what somebody else made of the files, by the names of the fields; None: it cannot be done."""
    texts = {field: merge.of(getattr(documents, field)) for field, merge in found.items()}
    if None in texts.values():
        return None
    return replace(documents, points=texts.get("points", documents.points), cell=texts.get("cell", documents.cell))


def _rebased(steps: Iterable[_Step], found: Mapping[str, Merge]) -> list[_Step]:
    """Return steps, the nearest first, on what somebody else made of the files, as far as this can be done."""
    moved = ((step, _merged(step.documents, found)) for step in steps)
    return [replace(step, documents=new) for step, new in takewhile(lambda each: each[1] is not None, moved) if new]


def _program_path(path: Path) -> Path:
    if path.name in ("", "..") or "\0" in str(path) or os.path.isdir(path):  # noqa: PTH112 - Path raises for a name that is too long
        raise Fault("RBL706", f"'{path}' is not the name of a file", "Give a name such as pick.rbl.")
    # not with_suffix: a name such as station.2 has a dot of its own
    return path if path.suffix == ".rbl" else path.with_name(f"{path.name}.rbl")


def _mover(documents: Documents, path: Path) -> Callable[[Documents], Documents]:
    """Return what gives documents, also those of the history, the name of another program; it runs in the same cell."""
    beside = cell_beside(path)
    cell_path = documents.cell_path
    if cell_path == own_cell(documents.path) or (cell_path == documents.path.with_name("cell.toml") != beside):
        cell_path = own_cell(path)

    def move(old: Documents) -> Documents:
        new = replace(old, path=path, cell_path=cell_path, named=True)
        if old.cell is None and beside is not None:
            # the folder has a cell of its own, and a program that has none would run in that one
            new = replace(new, cell=cell_text(), points=points_text() if old.points is None else old.points)
        return new

    return move


def _difference(old: str, new: str) -> Edit:
    """Return the one edit that makes a text of another."""
    shortest = min(len(old), len(new))
    start = _most(shortest, lambda count: old[:count] == new[:count])
    same = _most(shortest - start, lambda count: old[len(old) - count :] == new[len(new) - count :])
    return Edit(span=Span(start, len(old) - same), text=new[start : len(new) - same])


def _most(limit: int, holds: Callable[[int], bool]) -> int:
    """Return the largest count up to ``limit`` for which something holds, where it holds for every smaller one."""
    return bisect_left(range(limit), True, key=lambda count: not holds(count + 1))
