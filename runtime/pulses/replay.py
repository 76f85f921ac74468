"""An exported folder of pulse tables, read without trust and played as a PLC plays it.

A folder holds ``manifest.json`` and one CSV file for each channel and move. This reader knows nothing of the exporter:
it takes the files as they are, integrates frequency times time row by row, puts the joints through its own forward
kinematics, and measures how far the tool point is from the straight line that was meant.

    pulses(t) = pulses(row start) +- frequency (t - row start)        until the row's target is reached
    joint     = pulses x pulse equivalent
    tool      = prod_i( placement_i Rz(q_i) ) X_last_flange X_flange_tool          of an arm; of others, their equations

Everything is checked on reading: what comes out of ``read_export`` can be played. Reading is bounded: regular files of
the folder itself, up to ``MAX_TABLE_BYTES`` and ``MAX_MANIFEST_BYTES``, no links, at most ``MAX_STEPS`` steps. Every
error is a ``FileFault`` RBL630 to RBL633 at its line; the manifest has no lines worth naming, so its keys are named.
"""

import errno
import json
import math
import os
import re
import stat
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any, Literal, NoReturn, cast

import numpy as np

from runtime.faults import Code, register
from runtime.frames import Array, frozen
from runtime.tomlfile import MAX_ABS, FileFault
from runtime.units import DEG, MM

MANIFEST = "manifest.json"
SCHEMA = 1
HEADER = "control,frequency_hz,target_pulses,steps"
MAX_MANIFEST_BYTES, MAX_TABLE_BYTES = 16_000_000, 64_000_000
MAX_STEPS = 1_000_000
"""Most time steps of all moves together."""
HIGHEST_RATE = 10_000
"""Most time steps in a second."""
ROW_TOLERANCE_S = 1e-9
"""A row lasts one time step to within this, s."""
POSE_TOLERANCE = 1e-6
"""A rotation of the manifest is one to within this."""
LONGEST_DWELL_S = 600.0
MAX_PULSES = 10**15
"""No position is further from zero, pulses: every whole number up to there is a float."""

register(
    Code(
        code="RBL630",
        name="pulse-export-unreadable",
        meaning="A folder of pulse tables, or a file in it, is missing, is not what such a folder holds or has a key "
        "that is missing or of the wrong type.",
        remedy="Name a folder that robolang export has written, or write it anew.",
    ),
    Code(
        code="RBL631",
        name="pulse-table-malformed",
        meaning="A row of a pulse table is one that no pulse channel can carry out, or the table has no proper end.",
        remedy="Write the folder anew with robolang export; tables are not to be edited.",
    ),
    Code(
        code="RBL632",
        name="pulse-table-out-of-step",
        meaning="The channels of a move would not stay together: a row is not one time step long, a table does not go "
        "on where the channel stood, or it has another number of steps than the move.",
        remedy="Write the folder anew with robolang export; the tables of a folder belong together.",
    ),
    Code(
        code="RBL633",
        name="pulse-export-schema",
        meaning="A folder of pulse tables was written by an older or newer version.",
        remedy="Update robolang, or write the folder anew with robolang export.",
    ),
    Code(
        code="RBL634",
        name="pulse-robot-mismatch",
        meaning="Pulse tables cannot drive the robot of the cell: they were written for another mechanism or tool, or "
        "start outside the joint ranges.",
        remedy="Give the cell that the program was exported with.",
    ),
    Code(
        code="RBL635",
        name="pulse-path-error",
        meaning="Pulse tables lead the tool point further from a straight line than was allowed.",
        remedy="Export with a finer pulse equivalent, a lower minimum frequency or another time step.",
    ),
)

Kind = Literal["arm", "cartesian", "cylindrical", "scara"]
Unit = Literal["deg", "mm"]
KINDS: tuple[Kind, ...] = ("arm", "cartesian", "cylindrical", "scara")


# --- what an export is -----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class Mechanism:
    """What the channels move: ``axes`` name the joints of all kinds but an arm, whose joints are J1, J2, ...

    ``placements`` (4, 4) of each axis of an arm in the frame before it, then ``X_last_flange`` and ``X_flange_tool``
    (4, 4), m. ``constant`` (3,) m: the coordinates that no joint moves. ``lengths``: l1 and l2 of a scara, m.
    """

    kind: Kind
    name: str
    axes: tuple[str, ...]
    placements: tuple[Array, ...] = ()
    X_last_flange: Array = field(default_factory=lambda: frozen(np.eye(4)))
    X_flange_tool: Array = field(default_factory=lambda: frozen(np.eye(4)))
    constant: Array = field(default_factory=lambda: frozen(np.zeros(3)))
    lengths: tuple[float, float] = (0.0, 0.0)

    @property
    def units(self) -> tuple[Unit, ...]:
        """Unit of each joint."""
        return tuple("mm" if axis in "xyzr" else "deg" for axis in self.axes)


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel:
    """A pulse channel: ``per_pulse`` in ``unit``, lowest and highest frequency Hz, where it stands at first, pulses."""

    name: str
    unit: Unit
    per_pulse: float
    min_hz: float
    max_hz: float
    start_pulses: int

    @property
    def si_per_pulse(self) -> float:
        """Pulse equivalent in rad or m."""
        return self.per_pulse * (DEG if self.unit == "deg" else MM)


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """The rows of a table as they are played, R of them without the last.

    ``frequency`` (R,) Hz, negative when counting down, 0 in a wait; ``steps`` (R,); ``ends`` (R + 1,) s, the time at
    the start and at the end of each row; ``pulses`` (R + 1,), the position then.
    """

    file: str
    frequency: Array
    steps: Array
    ends: Array
    pulses: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """What a LOAD declared: mass kg, centre of gravity (3,) m in the flange frame."""

    mass: float
    cog: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Marker:
    """A statement between the moves: a ``load``, or a hand that closes or opens and waits ``dwell_s``."""

    line: int
    number: int | None
    text: str
    load: Load | None = None
    hand: Literal["on", "off"] | None = None
    dwell_s: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Move:
    """A straight move of ``steps`` time steps from ``start`` to ``end``, (3,) m each.

    ``tables`` of the M channels, None where a channel stands still; ``first`` and ``last`` (M,), the positions at the
    start and at the end, pulses.
    """

    line: int
    number: int | None
    text: str
    steps: int
    start: Array
    end: Array
    tables: tuple[Table | None, ...]
    first: Array
    last: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Export:
    """A folder of pulse tables: the moves of ``program`` for M ``channels``, in time steps of ``step_s``."""

    program: str
    mechanism: Mechanism
    step_s: float
    channels: tuple[Channel, ...]
    sequence: tuple[Marker | Move, ...]

    @property
    def moves(self) -> tuple[Move, ...]:
        """The moves in their order."""
        return tuple(item for item in self.sequence if isinstance(item, Move))

    @property
    def seconds(self) -> float:
        """Time of the whole program, moves and waiting, s."""
        return sum(item.steps * self.step_s if isinstance(item, Move) else item.dwell_s for item in self.sequence)


# --- reading ---------------------------------------------------------------------------------------------------------


def read_export(folder: Path) -> Export:
    """Read a folder of pulse tables; ``FileFault`` RBL630 to RBL633 when it is not one that can be played."""
    try:
        is_folder = stat.S_ISDIR(os.stat(folder).st_mode)  # noqa: PTH116 - Path.stat would add nothing
    except (OSError, ValueError) as error:  # ValueError: a NUL character in the name
        _fail(folder, "RBL630", f"cannot open {folder}: {_reason(error)}")
    if not is_folder:
        _fail(folder, "RBL630", f"{folder} is not a folder", "name the folder, not a file in it")
    path = folder / MANIFEST
    manifest = _Object(path, _json(path), "")
    _schema(manifest)
    mechanism = _mechanism(manifest.child("mechanism"))
    step_s = _step(manifest)
    channels = _channels(manifest, mechanism)
    return Export(
        program=manifest.text("program"),
        mechanism=mechanism,
        step_s=step_s,
        channels=channels,
        sequence=_sequence(manifest, folder, channels, step_s),
    )


def _fail(path: Path, code: str, message: str, hint: str = "", line: int = 1, column: int = 1,
          excerpt: str = "") -> NoReturn:  # fmt: skip
    raise FileFault(code, message, hint, path=str(path), line=line, column=column, excerpt=excerpt) from None


def _reason(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error)


def _read(path: Path, most: int) -> str:
    """Return the text of a small regular UTF-8 file, never of one that a link leads to; ``FileFault`` RBL630."""
    try:
        # no link: it could lead out of the folder; without waiting: a pipe would never open
        handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOFOLLOW)
    except (OSError, ValueError) as error:
        link = isinstance(error, OSError) and error.errno in (errno.ELOOP, errno.EMLINK)
        _fail(path, "RBL630", f"{path} is a link" if link else f"cannot open {path}: {_reason(error)}",
              "put the file itself into the folder" if link else "")  # fmt: skip
    try:
        info = os.fstat(handle)
        if not stat.S_ISREG(info.st_mode):
            _fail(path, "RBL630", f"{path} is not a regular file")
        if info.st_size > most:
            _fail(path, "RBL630", f"{path} has {info.st_size} bytes, more than {most}")
        with os.fdopen(handle, "rb", closefd=False) as stream:
            raw = stream.read(most + 1)
    except OSError as error:
        _fail(path, "RBL630", f"cannot read {path}: {_reason(error)}")
    finally:
        os.close(handle)
    if len(raw) > most:  # it has grown in the meantime
        _fail(path, "RBL630", f"{path} has more than {most} bytes")
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        _fail(path, "RBL630", f"{path} is not UTF-8 text (byte {error.start})", line=line)


# --- the manifest ----------------------------------------------------------------------------------------------------

_TOKENS = re.compile(r'"(?:[^"\\]|\\.)*"|(-?(?:NaN|Infinity))', re.DOTALL)


def _json(path: Path) -> dict[str, Any]:
    """Return the object of a strict JSON file; ``FileFault`` RBL630 at the line of an error."""
    text = _read(path, MAX_MANIFEST_BYTES)
    try:
        found = json.loads(text, parse_constant=_constant, parse_float=_finite, object_pairs_hook=_once)
    except json.JSONDecodeError as error:
        _fail_in(path, text, error.pos, f"{path.name} is not JSON: {error.msg}")
    except _ConstantError as error:
        at = next((match.start() for match in _TOKENS.finditer(text) if match[1]), 0)
        _fail_in(path, text, at, f"{path.name} is not strict JSON: {error} is not a number")
    except RecursionError:
        _fail(path, "RBL630", f"{path.name} is nested too deeply")
    except ValueError as error:  # int() refuses a literal of thousands of digits
        _fail(path, "RBL630", f"{path.name} is not strict JSON: {error}")
    if not isinstance(found, dict):
        _fail(path, "RBL630", f"{path.name} must hold an object, not {_kind(found)}")
    return found


class _ConstantError(ValueError):
    """NaN or Infinity in a JSON text."""


def _constant(word: str) -> NoReturn:
    raise _ConstantError(word)


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{_shown(text)} is too large")
    return value


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice, _ = Counter(key for key, _ in pairs).most_common(1)[0]
        raise ValueError(f"an object has the key {_shown(twice)} twice")
    return found


def _fail_in(path: Path, text: str, at: int, message: str) -> NoReturn:
    start = text.rfind("\n", 0, at) + 1
    _fail(path, "RBL630", message, line=text.count("\n", 0, at) + 1, column=at - start + 1,
          excerpt=text[start:].partition("\n")[0].removesuffix("\r"))  # fmt: skip


def _kind(value: object) -> str:
    names = {bool: "a boolean", str: "a text", int: "a number", float: "a number", list: "a list", dict: "an object"}
    return names.get(type(value), "null")


def _shown(text: str) -> str:
    return f"'{text}'" if len(text) <= 40 else f"'{text[:37]}...'"


class _Object:
    """An object of the manifest being read: typed getters that name the key, as in ``channels.2.min_hz``."""

    def __init__(self, path: Path, data: dict[str, Any], name: str) -> None:
        self._path, self._data, self._name = path, data, name

    def __contains__(self, key: str) -> bool:
        return key in self._data

    def name(self, key: str) -> str:
        """Return the dotted name of a key, list entries counted from 1."""
        return f"{self._name}.{key}" if self._name else key

    def fail(self, key: str, message: str, code: str = "RBL630", hint: str = "") -> NoReturn:
        """Raise ``FileFault`` for a key: ``'channels.2.min_hz' MESSAGE``."""
        _fail(self._path, code, f"'{self.name(key)}' {message}", hint)

    def value(self, key: str) -> Any:
        """Return whatever a key holds."""
        if key not in self._data:
            self.fail(key, "is missing")
        return self._data[key]

    def keys(self) -> list[str]:
        """Return the keys that are there."""
        return list(self._data)

    def number(self, key: str, low: float = -MAX_ABS, high: float = MAX_ABS) -> float:
        """Return a number from ``low`` to ``high``."""
        return self._checked(key, self.value(key), low, high)

    def _checked(self, key: str, value: object, low: float, high: float) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(key, f"must be a number, not {_kind(value)}")
        if not low <= value <= high:  # before float(): an integer may be beyond any float
            shown = f"{value:g}" if isinstance(value, float) else _whole(value)
            self.fail(key, f"is {shown} and must be between {low:g} and {high:g}")
        return float(value)

    def whole(self, key: str, low: int, high: int) -> int:
        """Return a whole number from ``low`` to ``high``, written as one."""
        value = self.value(key)
        if isinstance(value, bool) or not isinstance(value, int):
            self.fail(key, "must be a whole number" + ("" if isinstance(value, float) else f", not {_kind(value)}"))
        self._checked(key, value, low, high)
        return value

    def numbers(self, key: str, count: int, low: float = -MAX_ABS, high: float = MAX_ABS) -> list[float]:
        """Return a list of ``count`` numbers."""
        return self._numbers(key, self.value(key), count, low, high)

    def _numbers(self, key: str, value: object, count: int, low: float, high: float) -> list[float]:
        if not isinstance(value, list) or len(value) != count:
            got = f"{len(value)} entries" if isinstance(value, list) else _kind(value)
            self.fail(key, f"must be a list of {count} numbers, not {got}")
        return [self._checked(key, item, low, high) for item in value]

    def text(self, key: str, choices: Sequence[str] = ()) -> str:
        """Return a text, one of ``choices`` when given."""
        value = self.value(key)
        if not isinstance(value, str):
            self.fail(key, f"must be a text, not {_kind(value)}")
        if choices and value not in choices:
            self.fail(key, f"is {_shown(value)} and must be one of {', '.join(choices)}")
        return value

    def entries(self, key: str) -> list[Any]:
        """Return a list."""
        value = self.value(key)
        if not isinstance(value, list):
            self.fail(key, f"must be a list, not {_kind(value)}")
        return value

    def child(self, key: str) -> "_Object":
        """Return the object that a key holds."""
        return self._child(key, self.value(key))

    def _child(self, key: str, value: object) -> "_Object":
        if not isinstance(value, dict):
            self.fail(key, f"must be an object, not {_kind(value)}")
        return _Object(self._path, value, self.name(key))

    def children(self, key: str) -> "list[_Object]":
        """Return the objects of a list."""
        return [self._child(f"{key}.{count}", value) for count, value in enumerate(self.entries(key), start=1)]

    def pose(self, key: str) -> Array:
        """Return a pose (4, 4), m."""
        return self._pose(key, self.value(key))

    def poses(self, key: str) -> tuple[Array, ...]:
        """Return a list of poses (4, 4), m."""
        return tuple(self._pose(f"{key}.{count}", value) for count, value in enumerate(self.entries(key), start=1))

    def _pose(self, key: str, value: object) -> Array:
        if not isinstance(value, list) or len(value) != 4:
            self.fail(key, "must be a pose of 4 rows of 4 numbers")
        X = np.array([self._numbers(f"{key}.{row}", each, 4, -MAX_ABS, MAX_ABS) for row, each in enumerate(value, 1)])
        R = X[:3, :3]
        off = max(float(np.abs(R @ R.T - np.eye(3)).max()), float(np.abs(X[3] - (0.0, 0.0, 0.0, 1.0)).max()))
        if off > POSE_TOLERANCE or np.linalg.det(R) < 0.0:
            self.fail(key, "is not a pose: three rows of a rotation with a position in m, then 0, 0, 0, 1")
        return frozen(X)


def _whole(value: int) -> str:
    """Return an integer for a message; it may have more digits than Python is willing to print."""
    return str(value) if abs(value) < 10**20 else f"a whole number of {value.bit_length()} bits"


def _schema(manifest: _Object) -> None:
    value = manifest.value("schema")
    if isinstance(value, bool) or not isinstance(value, int):
        manifest.fail("schema", f"must be the number {SCHEMA}, not {_kind(value)}")
    if value != SCHEMA:
        age = "a newer" if value > SCHEMA else "an older"
        hint = "update robolang" if value > SCHEMA else "write the folder anew with robolang export"
        manifest.fail("schema", f"is {_whole(value)}, of {age} version; this one reads {SCHEMA}", "RBL633", hint)


def _step(manifest: _Object) -> float:
    step_s = manifest.number("step_s", 1.0 / HIGHEST_RATE, 1.0)
    if abs(round(1.0 / step_s) * step_s - 1.0) > 1e-9:
        manifest.fail("step_s", f"is {step_s:g} s and must be a whole part of a second")
    return step_s


_AXES: dict[Kind, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "cartesian": ((), ("x", "y", "z")),
    "cylindrical": (("theta", "r"), ("z",)),
    "scara": (("theta1", "theta2"), ("z", "theta4")),
}
"""Axes that a mechanism must have, first and in this order, and those that may follow."""


def _mechanism(table: _Object) -> Mechanism:
    kind = cast(Kind, table.text("kind", KINDS))
    name = table.text("name")
    if kind == "arm":
        placements = table.poses("placements")
        if not placements:
            table.fail("placements", "has no axis")
        return Mechanism(kind=kind, name=name, axes=tuple(f"J{k}" for k in range(1, len(placements) + 1)),
                         placements=placements, X_last_flange=table.pose("X_last_flange"),
                         X_flange_tool=table.pose("X_flange_tool"))  # fmt: skip
    axes = _axes(table, kind)
    moved = set(axes) if kind == "cartesian" else {"x", "y", *axes}
    constant = [0.0 if axis in moved else table.number(f"{axis}_mm") * MM for axis in "xyz"]
    lengths = (table.number("l1_mm") * MM, table.number("l2_mm") * MM) if kind == "scara" else (0.0, 0.0)
    return Mechanism(kind=kind, name=name, axes=axes, constant=frozen(constant), lengths=lengths)


def _axes(table: _Object, kind: Kind) -> tuple[str, ...]:
    first, more = _AXES[kind]
    axes = table.entries("axes")
    for axis in axes:
        if axis not in (*first, *more) or axes.count(axis) > 1:
            shown = _shown(axis) if isinstance(axis, str) else _kind(axis)
            table.fail("axes", f"names {shown}; each axis is one of {', '.join((*first, *more))}, once")
    if tuple(axes[: len(first)]) != first or not axes:
        table.fail("axes", f"must begin with {', '.join(first)}" if first else "names no axis")
    return tuple(axes)


def _channels(manifest: _Object, mechanism: Mechanism) -> tuple[Channel, ...]:
    tables = manifest.children("channels")
    if len(tables) != len(mechanism.axes):
        manifest.fail("channels", f"has {len(tables)} entries; the {mechanism.kind} has {len(mechanism.axes)} joints")
    channels = tuple(_channel(table, unit) for table, unit in zip(tables, mechanism.units, strict=True))
    names = [channel.name for channel in channels]
    for table, name in zip(tables, names, strict=True):
        if names.count(name) > 1:
            table.fail("name", f"is {_shown(name)}, which another channel has too")
    return channels


def _channel(table: _Object, unit: Unit) -> Channel:
    name = table.text("name")
    if not (0 < len(name) <= 40 and name.isprintable()):
        table.fail("name", "must be 1 to 40 printable characters")
    if table.text("unit", ("deg", "mm")) != unit:
        table.fail("unit", f"must be {unit}, the unit of this joint")
    per_pulse = table.number("per_pulse")
    if per_pulse == 0.0:
        table.fail("per_pulse", "must not be 0")
    min_hz = table.number("min_hz", 0.0)
    return Channel(
        name=name, unit=unit, per_pulse=per_pulse, min_hz=min_hz, max_hz=table.number("max_hz", min_hz),
        start_pulses=table.whole("start_pulses", -MAX_PULSES, MAX_PULSES),
    )  # fmt: skip


def _sequence(manifest: _Object, folder: Path, channels: tuple[Channel, ...],
              step_s: float) -> tuple[Marker | Move, ...]:  # fmt: skip
    tables = manifest.children("sequence")
    left = MAX_STEPS
    files: set[str] = set()
    stands = tuple(channel.start_pulses for channel in channels)
    sequence: list[Marker | Move] = []
    for table in tables:
        if table.text("kind", ("marker", "move")) == "marker":
            sequence.append(_marker(table))
            continue
        move, stands = _move(table, folder, channels, step_s, stands, files, left)
        left -= move.steps
        sequence.append(move)
    return tuple(sequence)


def _place(table: _Object) -> tuple[int, int | None, str]:
    """Return line, number and text of a statement."""
    number = None if table.value("number") is None else table.whole("number", 0, 10**9)
    return table.whole("line", 1, 10**9), number, table.text("text")


def _marker(table: _Object) -> Marker:
    line, number, text = _place(table)
    if ("load" in table) == ("hand" in table):
        table.fail("load", "and 'hand': a marker has one of the two")
    if "load" in table:
        load = table.child("load")
        cog = frozen(np.array(load.numbers("cog_mm", 3)) * MM)
        return Marker(line=line, number=number, text=text, load=Load(mass=load.number("mass_kg", 0.0), cog=cog))
    hand = cast(Literal["on", "off"], table.text("hand", ("on", "off")))
    return Marker(line=line, number=number, text=text, hand=hand, dwell_s=table.number("dwell_s", 0.0, LONGEST_DWELL_S))


def _move(entry: _Object, folder: Path, channels: tuple[Channel, ...], step_s: float, stands: tuple[int, ...],
          files: set[str], most: int) -> tuple[Move, tuple[int, ...]]:  # fmt: skip
    """Return a move and where its channels stand after it; ``files`` have been read, ``most`` steps are left."""
    line, number, text = _place(entry)
    steps = entry.whole("steps", 0, MAX_STEPS)
    if steps > most:
        entry.fail("steps", f"is {steps}: all moves together have more than {MAX_STEPS}")
    start, end = (frozen(np.array(entry.numbers(key, 3)) * MM) for key in ("start_mm", "end_mm"))
    names = entry.child("tables")
    known = [channel.name for channel in channels]
    for key in names.keys():  # noqa: SIM118 - not a dict
        if key not in known:
            names.fail(key, f"is not a channel; known: {', '.join(known)}")
    found: list[Table | None] = []
    last: list[int] = []
    here = [_file(names, channel, files) for channel in known]
    for channel, file, at in zip(channels, here, stands, strict=True):
        table, ends_at = (None, at) if file is None else _Rows(folder / file, channel, step_s).read(at, steps)
        found.append(table)
        last.append(ends_at)
    move = Move(line=line, number=number, text=text, steps=steps, start=start, end=end, tables=tuple(found),
                first=frozen(stands), last=frozen(last))  # fmt: skip
    return move, tuple(last)


def _file(names: _Object, channel: str, files: set[str]) -> str | None:
    """Return the name of a table's file, a plain one that no other table has; None where the channel stands still."""
    if names.value(channel) is None:
        return None
    file = names.text(channel)
    # a Windows path must be refused on Linux too: the same folder means the same on both
    plain = all(kind(file).name == file for kind in (PurePosixPath, PureWindowsPath))
    if not plain or file in ("", ".", "..") or "\0" in file:
        names.fail(channel, f"is {_shown(file)}, not the plain name of a file in the folder")
    if file in files:
        names.fail(channel, f"is {_shown(file)}, which another table is too")
    files.add(file)
    return file


# --- the tables ------------------------------------------------------------------------------------------------------

_WHOLE = r"0|[1-9][0-9]{0,14}"
_ROW = re.compile(rf"(up|down|wait|end),({_WHOLE}),({_WHOLE}|-[1-9][0-9]{{0,14}}),({_WHOLE})")
_CONTROLS = ("up", "down", "wait", "end")
_FREQUENCY, _TARGET, _STEPS = 1, 2, 3


class _Rows:
    """A CSV file being read: each row is checked against the position that the rows before it have reached."""

    def __init__(self, path: Path, channel: Channel, step_s: float) -> None:
        self._path, self._channel, self._step_s = path, channel, step_s
        text = _read(path, MAX_TABLE_BYTES)
        lines = [line.removesuffix("\r") for line in text.split("\n")]
        self._lines = lines[:-1] if len(lines) > 1 and not lines[-1] else lines
        self._line = 0

    def read(self, stands: int, steps: int) -> tuple[Table, int]:
        """Return the rows that begin at ``stands`` pulses and last ``steps`` steps, and the position at their end."""
        numbered = [(k, line) for k, line in enumerate(self._lines, start=1) if not line.startswith("#")]
        self._line = numbered[0][0] if numbered else len(self._lines)
        if not numbered or numbered[0][1] != HEADER:
            self._fail("RBL631", f"the header must be {HEADER}")
        frequency: list[int] = []
        counts: list[int] = []
        pulses = [stands]
        control, total = "", 0
        for self._line, line in numbered[1:]:
            if control == "end":
                self._fail("RBL631", "a row after the end", column=1)
            control, hz, target, count = self._fields(line)
            self._check(control, hz, target, count, pulses[-1], first=not counts)
            if control != "end":
                frequency.append(hz if control != "down" else -hz)
                counts.append(count)
                pulses.append(target)
                total += count
        if control != "end":
            self._fail("RBL631", "the table has no end", column=len(self._lines[self._line - 1]) + 1)
        if total != steps:
            self._fail("RBL632", f"{self._channel.name} ends after {total} steps, the move after {steps}")
        return self._table(frequency, counts, pulses), pulses[-1]

    def _table(self, frequency: list[int], counts: list[int], pulses: list[int]) -> Table:
        hz, steps = np.array(frequency, dtype=np.float64), np.array(counts, dtype=np.float64)
        change = np.abs(np.diff(np.array(pulses, dtype=np.float64)))
        lasts = np.where(hz == 0.0, steps * self._step_s, change / np.where(hz == 0.0, 1.0, np.abs(hz)))
        return Table(file=self._path.name, frequency=frozen(hz), steps=frozen(steps),
                     ends=frozen(np.concatenate([[0.0], np.cumsum(lasts)])), pulses=frozen(pulses))  # fmt: skip

    def _fields(self, line: str) -> tuple[str, int, int, int]:
        found = _ROW.fullmatch(line)
        if found is None:
            self._explain(line)
        control, hz, target, count = found.groups()
        return control, int(hz), int(target), int(count)

    def _explain(self, line: str) -> NoReturn:
        """Say why a line is no row."""
        parts = line.split(",")
        if len(parts) != 4:
            self._fail("RBL631", f"a row has 4 values ({HEADER}), this one {len(parts) if line else 0}", column=1)
        if parts[0] not in _CONTROLS:
            self._fail("RBL631", f"the control is {_shown(parts[0])} and must be {', '.join(_CONTROLS)}", 0)
        names = HEADER.split(",")
        for place, sign in ((_FREQUENCY, ""), (_TARGET, "-?"), (_STEPS, "")):
            if not re.fullmatch(rf"0|{sign}[1-9][0-9]{{0,14}}", parts[place]):
                wanted = f"a whole number{'' if sign else ' from 0'} of at most 15 digits"
                self._fail("RBL631", f"{names[place]} is {_shown(parts[place])}, not {wanted}", place)
        raise AssertionError(line)  # pragma: no cover - one of the four is what the pattern refuses

    def _check(self, control: str, hz: int, target: int, count: int, at: int, *, first: bool) -> None:
        if control in ("up", "down"):
            self._check_pulses(control, hz, target, count, at, first=first)
            return
        if hz:
            self._fail("RBL631", f"'{control}' has no pulses, and frequency {hz} Hz", _FREQUENCY)
        if target != at and first:
            self._fail("RBL632", f"{self._channel.name} stands at {at} pulses, and the table begins at {target}",
                       _TARGET)  # fmt: skip
        if target != at:
            self._fail("RBL631", f"'{control}' stands still at {at} pulses and cannot reach {target}", _TARGET)
        if (count < 1) == (control == "wait"):
            self._fail("RBL631", f"'{control}' with {count} steps", _STEPS)

    def _check_pulses(self, control: str, hz: int, target: int, count: int, at: int, *, first: bool) -> None:
        channel, change = self._channel, target - at
        where = f"{at} pulses" + (f", where {channel.name} stands," if first else "")
        if count != 1:
            self._fail("RBL631", f"'{control}' lasts 1 step, not {count}", _STEPS)
        if (change <= 0) if control == "up" else (change >= 0):
            self._fail("RBL631", f"'{control}' cannot lead from {where} to {target}", _TARGET)
        if not channel.min_hz <= hz <= channel.max_hz:
            self._fail("RBL631", f"{hz} Hz is not between {channel.min_hz:g} and {channel.max_hz:g} Hz, the range of "
                       f"{channel.name}", _FREQUENCY)  # fmt: skip
        if not hz or abs(abs(change) / hz - self._step_s) > ROW_TOLERANCE_S:
            lasts = f"lasts {abs(change) / hz * 1e3:.6g} ms" if hz else "never ends"
            self._fail("RBL632", f"from {where} to {target} at {hz} Hz {lasts}; a step has {self._step_s * 1e3:g} ms",
                       _FREQUENCY)  # fmt: skip

    def _fail(self, code: str, message: str, place: int = 0, column: int | None = None) -> NoReturn:
        """Raise ``FileFault`` at the ``place``-th value of the current line, or at ``column``."""
        line = self._lines[self._line - 1]
        if column is None:
            column = 1 + sum(len(part) + 1 for part in line.split(",")[:place])
        _fail(self._path, code, message, line=self._line, column=column, excerpt=line[:1000])


# --- playing ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveReplay:
    """A move played by its tables: S steps, M channels, K = S x samples + 1 times.

    ``times`` (K,) s from the start of the move; ``pulses`` (K, M); ``frequency`` (S, M) Hz, negative when counting
    down, in each step; ``points`` (K, 3) m of the tool point; ``error_mm`` (K,), its distance from the straight segment
    of the move. The largest of them: ``rows_mm`` at the row ends, ``between_mm`` between them; ``end_mm``: distance of
    the last point from the end of the segment. ``counts`` (M,): pulses that each channel sends, up and down.
    """

    move: Move
    duration_s: float
    times: Array
    pulses: Array
    frequency: Array
    points: Array
    error_mm: Array
    rows_mm: float
    between_mm: float
    end_mm: float
    counts: tuple[int, ...]

    @property
    def worst_mm(self) -> float:
        """Largest of the errors, mm."""
        return max(self.rows_mm, self.between_mm, self.end_mm)

    @property
    def fastest(self) -> tuple[float, int]:
        """Highest frequency, Hz, and its channel, from 0."""
        if not len(self.frequency):
            return 0.0, 0
        highest = np.abs(self.frequency).max(axis=0)
        return float(highest.max()), int(np.argmax(highest))


def positions(move: Move, t: Array) -> Array:
    """Return the positions (K, M) of all channels, pulses, at times t (K,) s from the start of the move.

    Before the start and beyond the end they stand.
    """
    columns = [np.full(np.shape(t), at) if table is None else np.interp(t, table.ends, table.pulses)
               for at, table in zip(move.first, move.tables, strict=True)]  # fmt: skip
    return np.stack(columns, axis=-1)


def frequencies(move: Move) -> Array:
    """Return the frequency (steps, M) Hz of every channel in each time step, negative when counting down."""
    columns = [np.zeros(move.steps) if table is None else np.repeat(table.frequency, table.steps.astype(np.int64))
               for table in move.tables]  # fmt: skip
    return np.stack(columns, axis=-1)


def joint_values(export: Export, pulses: Array) -> Array:
    """Return the joint values (..., M), rad or m, at positions (..., M) in pulses."""
    return np.asarray(pulses * np.array([channel.si_per_pulse for channel in export.channels]))


def tool_points(export: Export, pulses: Array) -> Array:
    """Return the tool points (K, 3) m in the world at positions (K, M) in pulses."""
    mechanism, values = export.mechanism, joint_values(export, pulses)
    if mechanism.kind == "arm":
        return _arm_points(mechanism, values)
    joints = dict(zip(mechanism.axes, values.T, strict=True))
    x, y, z = (joints.get(axis, np.full(len(values), at)) for axis, at in zip("xyz", mechanism.constant, strict=True))
    if mechanism.kind == "cylindrical":
        x, y = joints["r"] * np.cos(joints["theta"]), joints["r"] * np.sin(joints["theta"])
    if mechanism.kind == "scara":
        l1, l2 = mechanism.lengths
        first, both = joints["theta1"], joints["theta1"] + joints["theta2"]
        x, y = l1 * np.cos(first) + l2 * np.cos(both), l1 * np.sin(first) + l2 * np.sin(both)
    return np.stack([x, y, z], axis=-1)


def _arm_points(mechanism: Mechanism, q: Array) -> Array:
    """Take the tool point from the last frame to the world, joint by joint: q (K, n) rad -> (K, 3) m."""
    tool = (mechanism.X_last_flange @ mechanism.X_flange_tool)[:3, 3]
    points = np.tile(tool, (len(q), 1))
    for placement, angle in reversed(list(zip(mechanism.placements, q.T, strict=True))):
        c, s = np.cos(angle), np.sin(angle)
        x, y, z = points.T
        turned = np.stack([c * x - s * y, s * x + c * y, z], axis=-1)
        points = turned @ placement[:3, :3].T + placement[:3, 3]
    return points


def distances(points: Array, start: Array, end: Array) -> Array:
    """Return the distance (K,) of points (K, 3) from the straight segment between two points (3,), all in m."""
    way = end - start
    length = float(np.linalg.norm(way))
    along = np.zeros(len(points)) if length < 1e-12 else np.clip((points - start) @ way / length**2, 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - start - along[:, None] * way, axis=1))


def replay(export: Export, samples_per_step: int = 4) -> list[MoveReplay]:
    """Return every move played by its tables, ``samples_per_step`` times in each time step (at least 2)."""
    if samples_per_step < 2:
        raise ValueError(f"{samples_per_step} samples in a step see nothing between the rows")
    return [_replay(export, move, samples_per_step) for move in export.moves]


def _replay(export: Export, move: Move, samples: int) -> MoveReplay:
    times = np.arange(move.steps * samples + 1) / samples * export.step_s
    pulses = positions(move, times)
    points = tool_points(export, pulses)
    error = distances(points, move.start, move.end) / MM
    between = np.arange(len(times)) % samples != 0
    return MoveReplay(
        move=move,
        duration_s=move.steps * export.step_s,
        times=frozen(times),
        pulses=frozen(pulses),
        frequency=frozen(frequencies(move)),
        points=frozen(points),
        error_mm=frozen(error),
        rows_mm=float(error[~between].max()),
        between_mm=float(error[between].max(initial=0.0)),
        end_mm=float(np.linalg.norm(points[-1] - move.end)) / MM,
        counts=tuple(_count(table) for table in move.tables),
    )


def _count(table: Table | None) -> int:
    return 0 if table is None else round(sum(abs(after - before) for before, after in pairwise(table.pulses.tolist())))
