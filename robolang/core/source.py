"""Program text and places in it.

A ``Span`` is a half-open range of character offsets into the text after the byte order mark is removed. Lines
end at LF, CR or CR LF and at nothing else (as editors of the Language Server Protocol count them;
``str.splitlines`` would also split at form feeds and U+2028). Lines and columns are 1-based, columns in
characters.

Reading is bounded: only a regular file of at most 1 MB is read, opened without blocking, so that a FIFO or a
device is refused and never waited for.
"""

import errno
import os
import re
import stat
from bisect import bisect_right
from functools import cached_property
from pathlib import Path
from typing import NoReturn

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from runtime.core.bounded_files import RefusedError, kind_text, read_bounded
from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, FilePlace

MAX_BYTES = 1_000_000
STANDARD_INPUT = "<stdin>"
"""The path of a program that is no file, and has none beside it."""
_LINE_END = re.compile(r"\r\n?|\n")


class Span(Record, kw_only=False):
    """A range of offsets ``[start, end)``; empty (``start == end``) where something is missing."""

    start: int
    end: int

    # Every token of a program has one, so the methods that sets and sorting call are not those of all records.

    def __init__(self, start: int, end: int) -> None:
        object.__setattr__(self, "start", start)
        object.__setattr__(self, "end", end)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Span):
            return NotImplemented
        return self.start == other.start and self.end == other.end

    def __lt__(self, other: "Span") -> bool:
        return (self.start, self.end) < (other.start, other.end)

    def __hash__(self) -> int:
        return hash((self.start, self.end))


class Place(Record):
    """A 1-based line and column."""

    line: int
    column: int


class Source(Record, kw_only=False):
    """The text of a program and its path as the user gave it."""

    __slots__ = ("__dict__",)  # for the cached properties

    path: str
    text: str

    @cached_property
    def line_spans(self) -> tuple[Span, ...]:
        """The spans of all lines without their line ends; at least one, which may be empty."""
        spans, start = [], 0
        for end in _LINE_END.finditer(self.text):
            spans.append(Span(start, end.start()))
            start = end.end()
        spans.append(Span(start, len(self.text)))
        return tuple(spans)

    @cached_property
    def _starts(self) -> tuple[int, ...]:
        return tuple(span.start for span in self.line_spans)

    def place(self, offset: int) -> Place:
        """Return the line and column of an offset in ``[0, len(text)]``."""
        line = bisect_right(self._starts, offset)
        return Place(line=line, column=offset - self._starts[line - 1] + 1)

    def line_text(self, line: int) -> str:
        """Return the text of a 1-based line without its line end."""
        span = self.line_spans[line - 1]
        return self.text[span.start : span.end]

    def slice(self, span: Span) -> str:
        """Return the text of a span."""
        return self.text[span.start : span.end]


def read_program(path: str | os.PathLike[str]) -> Source:
    """Read a program file.

    Raises ``FileFault``: RBL701 missing, RBL702 not a readable regular file, RBL106 over 1 MB (found before
    all of it is read), RBL104 not UTF-8 text (placed at the first bad byte).
    """
    name = os.fspath(path)
    return decode_program(name, read_bytes(name))


def decode_program(name: str, raw: bytes) -> Source:
    """Return the program that bytes are the text of, a byte order mark removed; ``FileFault`` RBL106, RBL104."""
    if len(raw) > MAX_BYTES:
        _fail("RBL106", f"{name} has {len(raw)} bytes, more than {MAX_BYTES}", path=name)
    return Source(name, _decode(name, raw))


def read_bytes(name: str) -> bytes:
    """Return the bytes of a program file, at most ``MAX_BYTES``; ``FileFault`` RBL701, RBL702, RBL106."""
    _refuse_other_kind(name)
    try:
        return read_bounded(name, MAX_BYTES)
    except RefusedError as refused:
        _refuse(name, refused)


def check_path(name: str) -> None:
    """Raise ``FileFault`` RBL701 for a program or a folder that does not exist."""
    if "\0" in name or not os.path.exists(name):  # noqa: PTH110 - Path would add nothing
        _fail("RBL701", f"there is no file {name}", _neighbour(name), path=name)


_OF_A_PROGRAM = {".cell.toml": "a cell file", ".points.toml": "a points file", ".test.toml": "a test file"}
_SHOWN = 3


def _refuse_other_kind(name: str) -> None:
    """Raise ``FileFault`` RBL702 for what the name shows to be no program."""
    if name.endswith((".npz", ".mcap")):
        hint = f"Give the program. 'robolang report {name}' shows the log in a page."
        _fail("RBL702", f"{name} is the log of a run, not a program", hint, path=name)
    for ending, kind in _OF_A_PROGRAM.items():
        if name.endswith(ending):
            program = f"{name.removesuffix(ending)}.rbl"
            _fail("RBL702", f"{name} is {kind}, not a program", f"Give the program: {program}", path=name)
    if name.endswith(".toml"):
        _fail("RBL702", f"{name} is a file with settings, not a program", "Give the program (.rbl).", path=name)


def _programs_in(folder: str) -> str:
    """Return a hint that names the programs of a folder, or ``""``."""
    try:
        found = sorted(each for each in os.listdir(folder) if each.endswith(".rbl"))  # noqa: PTH208
    except OSError:
        return ""
    shown = [os.path.normpath(os.path.join(folder, each)) for each in found[:_SHOWN]]  # noqa: PTH118
    return f"Name the file: {', '.join(shown)}{', ...' if len(found) > _SHOWN else ''}" if found else ""


def _refuse(name: str, refused: RefusedError) -> NoReturn:
    """Raise the ``FileFault`` of a file that is not read."""
    error = refused.error
    # before the size: a folder or a pipe opens without an error, too
    if refused.mode is not None:
        hint = _programs_in(name) if stat.S_ISDIR(refused.mode) else ""
        _fail("RBL702", f"{name} is {kind_text(refused.mode)}, not a file", hint, path=name)
    if error is None:
        _fail("RBL106", f"{name} has {refused.size} bytes, more than {MAX_BYTES}", path=name)
    if refused.opened:
        _fail("RBL702", f"cannot read {name}: {refused.reason}", path=name)
    if isinstance(error, FileNotFoundError):
        _fail("RBL701", f"there is no file {name}", _neighbour(name), path=name)
    # no file can have such a name, so it is missing, not refused
    missing = isinstance(error, ValueError) or error.errno in (errno.ENOTDIR, errno.ENAMETOOLONG)
    reason = "the name contains a NUL character" if isinstance(error, ValueError) else refused.reason
    _fail("RBL701" if missing else "RBL702", f"cannot open {name}: {reason}", path=name)


def _decode(name: str, raw: bytes) -> str:
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        # With utf-8-sig the reported offset is relative to the text after the mark.
        skipped = 3 if raw.startswith(b"\xef\xbb\xbf") else 0
        before = raw[skipped : skipped + error.start].decode("utf-8", "replace")
        _not_text(name, raw, before, f"byte {raw[skipped + error.start]:#04x} is not UTF-8 text")
    # UTF-16 without its mark is valid UTF-8, full of NUL characters
    if "\0" in text:
        _not_text(name, raw, text[: text.index("\0")], "a NUL character: this is not a text file")
    return text


def _not_text(name: str, raw: bytes, before: str, message: str) -> NoReturn:
    # Windows editors that save "Unicode" write UTF-16 with this mark
    utf16 = raw[:2] in (b"\xff\xfe", b"\xfe\xff")
    hint = "the file looks like UTF-16; save it as UTF-8" if utf16 else ""
    place = Source(name, before).place(len(before))
    _fail("RBL104", message, hint, path=name, place=place)


def _fail(code: str, message: str, hint: str = "", *, path: str, place: Place | None = None) -> NoReturn:
    at = FilePlace(path, place.line, place.column) if place else FilePlace(path)
    raise FileFault(code, message, hint, at)


def _neighbour(name: str) -> str:
    """Return a hint when the name only lacks its suffix."""
    # robolang run pick: the ending is what is left out most often
    try:
        there = Path(f"{name}.rbl").is_file()
    except OSError:  # a name of 255 bytes can exist, and is too long with the ending
        there = False
    return f"did you mean {name}.rbl?" if there else ""
