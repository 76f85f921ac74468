"""Writing documents to the disk: each file whole or not at all, and none over what somebody else wrote meanwhile."""

import difflib
import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.analysis.analysis import Analysis
from robolang.core.diagnostics import has_errors
from robolang.core.source import MAX_BYTES
from robolang.core.storage import only_one, remove, write_atomic
from robolang.project.discovery import Texts
from robolang.syntax.formatter import format_source
from robolang.teaching.documents import Documents
from runtime.core.bounded_files import RefusedError, read_bounded
from runtime.core.faults import Fault

_MARK = b"\xef\xbb\xbf"
"""The byte order mark that some editors write; a file keeps the one that it has."""


class SaveFault(Fault):
    """A save that stopped at a file (RBL312): ``saved`` before it, ``unsaved`` that one and those after it."""

    def __init__(self, cause: Fault, saved: Sequence[Path], unsaved: Sequence[Path]) -> None:
        done = f"; saved: {_names(saved)}" if saved else "; nothing was saved"
        super().__init__("RBL312", f"{cause.message}{done}; not saved: {_names(unsaved)}", cause.hint)
        self.saved, self.unsaved = tuple(saved), tuple(unsaved)


class ConflictFault(Fault):
    """A file that somebody else changed since it was read (RBL714), with both changes as unified diffs."""

    def __init__(self, path: Path, theirs: str, ours: str) -> None:
        super().__init__("RBL714", f"{path} has been changed on the disk since it was read")
        self.path, self.theirs, self.ours = path, theirs, ours


def as_saved(documents: Documents, analysis: Analysis) -> Documents:
    """Return documents with the program in its layout; one with an error in its text stays as it was typed."""
    formatted = format_source(documents.source, analysis.parsed)
    return documents if has_errors(formatted.diagnostics) else replace(documents, program=formatted.text)


@contextmanager
def alone(files: Iterable[Path]) -> Iterator[None]:
    """Let nobody else who uses this function save into the folders of files."""
    with ExitStack() as stack:
        # in one order: two saves never wait for each other
        for folder in sorted({os.path.dirname(os.path.realpath(path)) for path in files}):  # noqa: PTH120
            stack.enter_context(only_one(Path(folder)))
        yield


def check(new: Texts, read: Texts) -> None:
    """Raise ``ConflictFault`` where a file is not what was last read or saved, and not what is to be written either."""
    for path, text in new.items():
        there = text_on_disk(path)
        if there not in (read.get(path), text):
            raise ConflictFault(path, unified(path, read.get(path), there), unified(path, read.get(path), text))


def write(new: Texts) -> None:
    """Write files in their order, None: remove it; ``SaveFault`` at the first that cannot be written."""
    files = list(new)
    for index, path in enumerate(files):
        try:
            _write(path, new[path])
        except Fault as fault:
            raise SaveFault(fault, files[:index], files[index:]) from None


def _write(path: Path, text: str | None) -> None:
    if text is None:
        remove(path)
        return
    try:
        data = (_MARK if _raw(path).startswith(_MARK) else b"") + text.encode("utf-8")
    except UnicodeEncodeError as error:  # half of a character, from a terminal that is not UTF-8
        raise Fault("RBL104", f"{path}: character {error.start + 1} cannot be written as UTF-8") from None
    if len(data) > MAX_BYTES:
        raise Fault("RBL106", f"{path} would have {len(data)} bytes, more than the {MAX_BYTES} that can be read again")
    write_atomic(path, lambda stream: stream.write(data))


def text_on_disk(path: Path) -> str | None:
    """Return the text of a file as it is now, None where no file can be read; bytes that are no text as escapes."""
    try:
        raw = read_bounded(path, MAX_BYTES)
    except RefusedError:
        return None  # what is there instead of a file is refused where it is written
    return raw.removeprefix(_MARK).decode("utf-8", "surrogateescape")


def _raw(path: Path) -> bytes:
    try:
        return read_bounded(path, MAX_BYTES)
    except RefusedError:
        return b""


def unified(path: Path, old: str | None, new: str | None) -> str:
    """Return the unified diff of two texts of a file; None: no such file."""
    before, after = ("/dev/null" if text is None else str(path) for text in (old, new))
    return "".join(_marked(difflib.unified_diff(_lines(old or ""), _lines(new or ""), before, after)))


def _marked(lines: Iterator[str]) -> Iterator[str]:
    for line in lines:
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"


def _lines(text: str) -> list[str]:
    """Return the lines of a text with their ends, split at LF only."""
    lines = text.split("\n")
    return [*(f"{line}\n" for line in lines[:-1]), *([lines[-1]] if lines[-1] else [])]


def _names(paths: Sequence[Path]) -> str:
    return ", ".join(map(str, paths))
