"""TOML files with located errors: the one reader of robot, cell, points and profile files.

A ``Table`` hands out its keys by type and remembers which were read; ``Table.done`` rejects the rest, so a
misspelt key never passes silently. Every error is a ``FileFault`` with file, line, column, code and hint.
Reading is bounded: only regular files up to 1 MB are opened. Imports the standard library only.
"""

import math
import re
import tomllib
from collections.abc import Callable, Iterable, Sequence
from collections.abc import Set as AbstractSet
from pathlib import Path
from typing import Any, NoReturn, TypeVar

import runtime.core.file_codes  # noqa: F401 - registers what is raised here
from runtime.core.bounded_files import RefusedError, read_bounded, resolved_inside, stays_inside
from runtime.core.faults import Fault
from runtime.core.record import Record
from runtime.core.rounding import beside
from runtime.core.toml_places import clash, lines_of, locate

Prepare = Callable[[dict[str, Any]], dict[str, Any]]
MAX_BYTES = 1_000_000
"""Files of this kind are written by hand: some kilobytes."""
MAX_ABS = 1e9
"""A larger number is in no unit of any key."""
TWICE = "is given twice"
"""The message of a key or table that is there twice; lint gives it a code of its own."""

_BARE_WORD = re.compile(r"[^=]*=\s*([A-Za-z_][\w./ -]*?)\s*(?:#.*)?")
"""A line whose value is a word without quotes."""
_CLASHES = ("Cannot overwrite a value", "Cannot declare", "Cannot mutate immutable", "Cannot redefine")
"""Beginnings of the messages of tomllib for a key or table that is there already; it has no error classes."""


class FilePlace(Record, kw_only=False):
    """A place in a file: its name, 1-based line and column, and the text of the line."""

    path: str
    line: int = 1
    column: int = 1
    excerpt: str = ""


class FileFault(Fault):
    """A fault at a place in a file."""

    def __init__(self, code: str, message: str, hint: str, place: FilePlace) -> None:
        super().__init__(code, message, hint)
        self.place = place
        self.path, self.line, self.column, self.excerpt = place.path, place.line, place.column, place.excerpt

    def __str__(self) -> str:
        return f"{self.path}:{self.line}:{self.column}: {self.code} {self.message}"


class Source(Record, kw_only=False):
    """The text of a file and its name as the user gave it."""

    path: str
    text: str

    def fault(self, code: str, message: str, hint: str = "", keys: Sequence[str | int] = ()) -> FileFault:
        """Return a ``FileFault`` at the place of the key path ``keys`` (best match)."""
        line, column = locate(self.text, keys)
        lines = lines_of(self.text)
        excerpt = lines[line - 1] if 0 < line <= len(lines) else ""
        return FileFault(code, message, hint, FilePlace(self.path, line, column, excerpt))

    def fail(self, code: str, message: str, hint: str = "", keys: Sequence[str | int] = ()) -> NoReturn:
        """Raise ``FileFault`` at the place of the key path ``keys`` (best match)."""
        raise self.fault(code, message, hint, keys)


def read_source(path: Path, code: str = "RBL600") -> Source:
    """Read a small regular UTF-8 file; ``FileFault`` with ``code`` otherwise (never blocks on a FIFO)."""
    where = Source(str(path), "")
    try:
        raw = read_bounded(path, MAX_BYTES)
    except RefusedError as refused:
        if refused.error is not None:
            where.fail(code, f"cannot {'read' if refused.opened else 'open'} {path}: {refused.reason}")
        if refused.mode is not None:
            where.fail(code, f"{path} is not a regular file")
        where.fail(code, f"{path} has {refused.size} bytes, more than {MAX_BYTES}")
    try:
        return Source(str(path), raw.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        _not_text(path, raw, error.start, code)


def _not_text(path: Path, raw: bytes, start: int, code: str) -> NoReturn:
    """Raise ``FileFault`` at a byte that is not UTF-8; ``start`` counts after a byte order mark."""
    body = raw.removeprefix(b"\xef\xbb\xbf")
    before = body[:start].decode("utf-8").split("\n")
    excerpt = lines_of(body.decode("utf-8", "replace"))[len(before) - 1]
    message = f"{path} is not UTF-8 text (byte {start})"
    raise FileFault(code, message, "", FilePlace(str(path), len(before), len(before[-1]) + 1, excerpt))


def load_table(source: Source, code: str = "RBL601", *, gather: bool = False, prepare: Prepare = dict) -> "Table":
    """Parse TOML; ``FileFault`` with ``code`` at the line of a syntax error. ``gather``: see ``Table``; ``prepare``
    gives the content in the form that is read, its keys where they are."""
    try:
        return Table(source, prepare(tomllib.loads(source.text)), (), [] if gather else None)
    except tomllib.TOMLDecodeError as error:
        text = str(error)  # tomllib has the place in its message only (attributes from Python 3.14 on)
        found = re.search(r"at line (\d+), column (\d+)", text)
        lines = lines_of(source.text)
        line, column = (int(found[1]), int(found[2])) if found else (len(lines), len(lines[-1]) + 1)
        message = re.sub(r" \(at .*\)", "" if found else " at the end of the file", text)
        hint = ""
        if text.startswith(_CLASHES):
            line, column, name, first = clash(source.text, line)
            message = f"{name} {TWICE}" + (f", first in line {first}" if first is not None else "")
            hint = "remove one of the two, or put their contents together"
        excerpt = lines[line - 1] if line <= len(lines) else ""
        if text.startswith("Invalid value") and (word := _BARE_WORD.fullmatch(excerpt)):
            message, hint = f"{word[1]} is no value", f'a text needs quotes: write "{word[1]}"'
        if not source.path.lower().endswith(".toml"):  # a program, most likely, where a cell file belongs
            message = f"{source.path} is not a TOML file: {message[:1].lower()}{message[1:]}"
            hint = "name a file of this kind, which ends in .toml"
        raise FileFault(code, message, hint, FilePlace(source.path, line, column, excerpt)) from None
    # tomllib reads arrays and tables within one another by recursion: [[[[ thousands of times
    except RecursionError:
        source.fail(code, "the file is nested too deeply")
    except ValueError as error:  # int() refuses a literal of thousands of digits
        source.fail(code, f"a value cannot be read: {error}")


class _Missing(Record, kw_only=False):
    """A key that a table lacks, noted by a reader that continues."""

    table: "Table"
    key: str


class _NotedError(Exception):
    """A key that is missing, and has been noted."""


T = TypeVar("T")


class Table:
    """One TOML table being read: typed getters, each key at most once, unknown keys rejected by ``done``.

    With ``gathered`` a reader finds every error of a file: a getter that fails notes its fault there and returns a
    substitute in the range of the key, and ``finish`` of the whole file raises all faults noted. A fault that a reader
    raises itself (``fail``) ends its part of the file: ``attempt`` notes it, unless something was noted in that part
    before, since it may follow from that.
    """

    def __init__(
        self,
        source: Source,
        data: dict[str, Any],
        keys: tuple[str | int, ...],
        gathered: "list[FileFault | _Missing] | None" = None,
        *,
        absent: bool = False,
    ) -> None:
        self.source = source
        self.keys = keys
        self._data = data
        self._asked: set[str] = set()
        self._gathered = gathered
        self._absent = absent

    def __contains__(self, key: str) -> bool:
        if key not in self._data:
            self._asked.add(key)  # a key that might have been here is known here
        return key in self._data

    def names(self) -> list[str]:
        """Return the keys present, in file order."""
        return list(self._data)

    def fault(self, code: str, message: str, hint: str = "", key: str | None = None) -> FileFault:
        """Return a ``FileFault`` at ``key`` of this table."""
        keys = (*self.keys, key) if key is not None else self.keys
        return self.source.fault(code, message, hint, keys)

    def fail(self, code: str, message: str, hint: str = "", key: str | None = None) -> NoReturn:
        """Raise ``FileFault`` at ``key`` of this table."""
        raise self.fault(code, message, hint, key)

    def name(self, key: str = "") -> str:
        """Return the dotted name of ``key`` as messages have it, axes counted from 1."""
        parts = [str(k + 1) if isinstance(k, int) else k for k in self.keys]
        return ".".join([*parts, key] if key else parts)

    # --- everything that is wrong at once ----------------------------------------------------------------------------

    def attempt(self, read: Callable[[], T]) -> T | None:
        """Return the result of reading a part of the file, None when something in it is wrong (see the class)."""
        if self._gathered is None:
            return read()
        # one list for the whole file, shared by all of its tables: more notes in it mean that this part has errors
        before = len(self._gathered)
        try:
            found = read()
        except FileFault as fault:
            if len(self._gathered) == before:
                self._gathered += [each for each in fault.all if isinstance(each, FileFault)]
            return None
        return found if len(self._gathered) == before else None

    def gather(self, read: "Callable[[Table], T]") -> T | None:
        """Return the result of reading this table; None when it is missing or something in it is wrong."""
        return None if self._absent else self.attempt(lambda: read(self))

    def finish(self) -> None:
        """Reject unknown keys and raise what was noted: the first by its place, with the ``others``."""
        self.done()
        if self._gathered:
            tables = {id(note.table): note.table for note in self._gathered if isinstance(note, _Missing)}
            faults = [note for note in self._gathered if isinstance(note, FileFault)]
            faults += [table._lacking() for table in tables.values()]
            # two readers of one key may note the same fault; faults of the file itself come before those of others
            faults = list({(fault.path, fault.line, fault.column, fault.message): fault for fault in faults}.values())
            faults.sort(key=lambda fault: (fault.path != self.source.path, fault.line, fault.column))
            faults[0].others = tuple(faults[1:])
            raise faults[0]

    def _noted(self, read: Callable[[], T], instead: T) -> T:
        """Return what a getter reads; ``instead`` where it fails and the reader continues."""
        if self._gathered is None:
            return read()
        try:
            return read()
        except _NotedError:
            return instead
        except FileFault as fault:
            self._gathered.append(fault)
            return instead

    def _missing_keys(self) -> list[str]:
        noted = self._gathered or ()
        keys = [note.key for note in noted if isinstance(note, _Missing) and note.table is self]
        return list(dict.fromkeys(keys))  # a key that is read twice is missing once

    def _lacking(self) -> FileFault:
        """Return the one fault that names every key which this table lacks."""
        keys = self._missing_keys()
        # an unknown key that resembles a missing one is most likely that one, misspelt: one fault for both
        near = {key: self._looks_like(key) for key in keys}
        hint = "; ".join(f"'{found}' looks like '{key}'" for key, found in near.items() if found)
        if len(keys) == 1:
            return self._lacks(keys[0])
        names = [f"'{self.name(key)}'" for key in keys]
        return self.fault("RBL608", f"{', '.join(names[:-1])} and {names[-1]} are missing", hint)

    def _looks_like(self, key: str) -> str:
        """Return the unknown key that may be a misspelt one, or nothing."""
        return _closest(key, set(self._data) - self._asked)

    def _lacks(self, key: str) -> FileFault:
        near = self._looks_like(key)
        return self.fault("RBL608", f"'{self.name(key)}' is missing", f"'{near}' looks like it" if near else "")

    # --- values ------------------------------------------------------------------------------------------------------

    def _take(self, key: str) -> Any:
        self._asked.add(key)
        if key not in self._data:
            if self._gathered is None:
                raise self._lacks(key)
            if not self._absent:
                self._gathered.append(_Missing(self, key))
            raise _NotedError
        return self._data[key]

    def number(
        self,
        key: str,
        default: float | None = None,
        *,
        low: float = -MAX_ABS,
        high: float = MAX_ABS,
        positive: bool = False,
    ) -> float:
        """Return a finite float in ``[low, high]`` (``positive``: above zero)."""
        if key not in self._data and default is not None:
            self._asked.add(key)  # a known key, although it is missing
            return default
        return self._noted(lambda: self._checked(key, self._take(key), low, high, positive), _within(low, high))

    def _checked(self, key: str, value: Any, low: float, high: float, positive: bool) -> float:
        # true is an int in Python, and would be taken for 1
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail("RBL613", f"'{self.name(key)}' must be a number, not {_kind(value)}", key=key)
        # compared before it is converted: an integer of thousands of digits is beyond any float
        number = float(value) if abs(value) <= MAX_ABS else math.inf
        if not math.isfinite(number):
            self.fail("RBL604", f"'{self.name(key)}' is {_shown(value)}, not a finite number", key=key)
        if not (low <= number <= high) or (positive and not number > 0.0):
            shown, bounds = _beside_range(number, low, high, positive)
            # the usual mistake at a key in metres: a drawing has mm
            mm = f"lengths are in m: write {number / 1e3:g} for {number:g} mm" if key.endswith("_m") else ""
            self.fail("RBL605", f"'{self.name(key)}' is {shown} and must be {bounds}", mm, key=key)
        return number

    def numbers(
        self,
        key: str,
        count: int | None,
        default: Sequence[float] | None = None,
        *,
        low: float = -MAX_ABS,
        high: float = MAX_ABS,
        positive: bool = False,
    ) -> tuple[float, ...]:
        """Return a list of ``count`` finite floats (None: any number)."""
        if key not in self._data and default is not None:
            self._asked.add(key)
            return tuple(default)
        return self._noted(lambda: self._numbers(key, count, low, high, positive), (_within(low, high),) * (count or 0))

    def _numbers(self, key: str, count: int | None, low: float, high: float, positive: bool) -> tuple[float, ...]:
        value = self._take(key)
        if not isinstance(value, list) or (count is not None and len(value) != count):
            got = f"{len(value)} entries" if isinstance(value, list) else _kind(value)
            form = "a list of numbers" if count is None else f"a list of {count} numbers"
            self.fail("RBL613", f"'{self.name(key)}' must be {form}, not {got}", key=key)
        return tuple(self._checked(key, item, low, high, positive) for item in value)

    def holds(self, key: str, kind: type) -> bool:
        """Return whether the value of a key is a list, a str, or a dict for a table; False without the key."""
        return isinstance(self._data.get(key), kind)

    def raw_list(self, key: str) -> list[Any]:
        """Return an optional list, its entries unchecked (empty when missing)."""
        self._asked.add(key)
        return self._noted(lambda: self._list(key), [])

    def _list(self, key: str) -> list[Any]:
        value = self._data.get(key, [])
        if not isinstance(value, list):
            self.fail("RBL613", f"'{self.name(key)}' must be a list, not {_kind(value)}", key=key)
        return value

    def integer(self, key: str, default: int | None = None, *, low: int, high: int) -> int:
        """Return an integer in ``[low, high]``."""
        value = self.number(key, None if default is None else float(default), low=low, high=high)
        return self._noted(lambda: self._whole(key, value), low)

    def _whole(self, key: str, value: float) -> int:
        if value != int(value):
            self.fail("RBL613", f"'{self.name(key)}' must be a whole number", key=key)
        return int(value)

    def text(self, key: str, default: str | None = None, *, choices: Sequence[str] = ()) -> str:
        """Return a text, one of ``choices`` when given."""
        if key not in self._data and default is not None:
            self._asked.add(key)
            return default
        return self._noted(lambda: self._text(key, choices), choices[0] if choices else "")

    def _text(self, key: str, choices: Sequence[str]) -> str:
        value = self._take(key)
        if not isinstance(value, str):
            self.fail("RBL613", f"'{self.name(key)}' must be a text, not {_kind(value)}", key=key)
        if choices and value not in choices:
            near = _closest(value, choices)
            hint = f"did you mean '{near}'?" if near else ""
            self.fail("RBL610", f"'{self.name(key)}' is '{value}'; known: {', '.join(choices)}", hint, key=key)
        return value

    def flag(self, key: str, default: bool) -> bool:
        """Return a boolean."""
        self._asked.add(key)
        return self._noted(lambda: self._flag(key, default), default)

    def _flag(self, key: str, default: bool) -> bool:
        value = self._data.get(key, default)
        if not isinstance(value, bool):
            self.fail("RBL613", f"'{self.name(key)}' must be true or false, not {_kind(value)}", key=key)
        return value

    def table(self, key: str, *, required: bool = True) -> "Table":
        """Return a sub-table (empty when it is optional and missing)."""
        if not required and key not in self._data:
            self._asked.add(key)
            return Table(self.source, {}, (*self.keys, key), self._gathered)
        # an empty table instead, whose own missing keys are not noted: the table that lacks is the error
        nothing = Table(self.source, {}, (*self.keys, key), self._gathered, absent=True)
        return self._noted(lambda: self._table(key), nothing)

    def _table(self, key: str) -> "Table":
        value = self._take(key)
        if not isinstance(value, dict):
            self.fail("RBL613", f"'{self.name(key)}' must be a table, not {_kind(value)}", key=key)
        return Table(self.source, value, (*self.keys, key), self._gathered)

    def tables(self, key: str, *, required: bool = True) -> list["Table"]:
        """Return the entries of an array of tables ``[[key]]``."""
        if not required and key not in self._data:
            self._asked.add(key)
            return []
        return self._noted(lambda: self._tables(key), [])

    def _tables(self, key: str) -> list["Table"]:
        value = self._take(key)
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            self.fail("RBL613", f"'{self.name(key)}' must be written as [[{key}]] tables", key=key)
        return [Table(self.source, item, (*self.keys, key, index), self._gathered) for index, item in enumerate(value)]

    def named_tables(self, key: str) -> dict[str, "Table"]:
        """Return the sub-tables ``[key.NAME]`` by name (empty when there are none)."""
        outer = self.table(key, required=False)
        return {name: outer.table(name) for name in outer.names()}

    def ask(self, *keys: str) -> None:
        """Count keys as known to this file, present or not."""
        self._asked.update(keys)

    def place(self, key: str) -> str:
        """Return ``file:line`` of a key of this table."""
        return f"{self.source.path}:{locate(self.source.text, (*self.keys, key))[0]}"

    def done(self) -> None:
        """Reject every key that was not read; RBL609, with the key that it resembles."""
        missing = self._missing_keys()
        for key in self._data:
            if key in self._asked or _closest(key, missing):
                continue  # reported with the missing key that it resembles: one mistake, one message
            near = _near(key, self._asked, self._data)
            hint = f"did you mean '{near}'?" if near else f"known here: {', '.join(sorted(self._asked))}"
            fault = self.fault("RBL609", f"'{self.name(key)}' is not a key of this file", hint, key=key)
            if self._gathered is None:
                raise fault
            self._gathered.append(fault)


def _near(key: str, known: AbstractSet[str], there: Iterable[str]) -> str:
    """Return the key that an unknown one may stand for, or nothing; ``position`` may stand for ``pose``."""
    free = known - set(there)  # first: a key that is there is hardly what this one was meant to be
    close = _closest(key, free) or _closest(key, known)
    begins = [] if close or len(key) < 3 else sorted(each for each in free if each[:3] == key[:3])
    return close or next(iter(begins), "")


def _closest(word: str, known: Iterable[str]) -> str:
    """Return the word that resembles another one most, or nothing."""
    import difflib  # needed for a hint only: a check starts sooner

    return next(iter(difflib.get_close_matches(word, known, n=1)), "")


def _beside_range(number: float, low: float, high: float, positive: bool) -> tuple[str, str]:
    """Return a number and the range that it is not in, in words; ``MAX_ABS`` is not named as the end of a range."""
    shown, least, most = beside(number, 0.0 if positive else low, high)
    # only the ends that exclude something are named
    if positive:
        return shown, "above 0" if high >= MAX_ABS else f"above 0 and at most {most}"
    if low <= -MAX_ABS and high < MAX_ABS:
        return shown, f"at most {most}"
    return shown, f"between {least} and {most}"


def _within(low: float, high: float) -> float:
    """Return a number of a range as a substitute, 1 where it is in the range: most checks of others accept it."""
    return min(max(low, 1.0), high)


def _kind(value: object) -> str:
    names = {bool: "a boolean", str: "a text", int: "a number", float: "a number", list: "a list", dict: "a table"}
    return names.get(type(value), type(value).__name__)


def _shown(value: float) -> str:
    """Return a number for a message; Python refuses to print an integer of more than 4300 digits."""
    if isinstance(value, int) and abs(value) >= 10**20:
        return f"a whole number of {value.bit_length()} bits"
    return str(value)


def inside(table: Table, name: str, folder: Path | None, key: str) -> Path:
    """Return the path of the file ``name`` inside ``folder``; ``FileFault`` RBL602 when it leads out of it.

    Without a folder (a cell held as text) no file can be named at all.
    """
    if folder is None:
        table.fail("RBL602", f"'{name}' is a file, and this cell has no folder", key=key)
    if not stays_inside(name):
        table.fail("RBL602", f"'{name}' is not a path inside the folder of the cell file", key=key)
    # resolved as well: a symbolic link may lead out although the name does not
    try:
        target = resolved_inside(folder / name, folder)
    except (OSError, RuntimeError, ValueError) as error:
        table.fail("RBL602", f"'{name}' cannot be followed: {error}", key=key)
    if target is None:
        table.fail("RBL602", f"'{name}' leads out of the folder of the cell file", key=key)
    return target
