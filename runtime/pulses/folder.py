"""The folder of an export: its manifest and its tables, made into an ``Export`` or refused.

A folder holds ``manifest.json`` and one CSV file for each channel and move. This reader knows nothing of the exporter:
it takes the files as they are, so that a mistake of the exporter cannot hide in code that both share. Everything is
checked on reading: what ``read_export`` returns can be played. The tables of a folder belong together: each continues
from the position of its channel after the move before, and lasts as long as the move. Reading is bounded: only files of
the folder itself (``runtime.pulses.manifest``), each of them one table, at most ``MAX_STEPS`` steps. Every error is a
``FileFault`` RBL630 to RBL633: a row of a table is named by its line (``runtime.pulses.rows``), a value of the manifest
by its key.
"""

import os
import stat
from pathlib import Path, PureWindowsPath
from typing import Literal, cast

import numpy as np

from runtime.core.bounded_files import stays_inside
from runtime.core.frames import frozen
from runtime.core.limits import DWELL
from runtime.core.units import MM
from runtime.pulses.exported import KINDS, Channel, Export, Kind, Load, Marker, Mechanism, Move, Table, Unit
from runtime.pulses.manifest import Object, digits, fail, quoted, read_json, reason, type_name
from runtime.pulses.rows import Rows

MANIFEST = "manifest.json"
SCHEMA = 1
MAX_STEPS = 1_000_000
"""Most time steps of all moves together."""
HIGHEST_RATE = 10_000
"""Most time steps in a second."""
LONGEST_DWELL_S = DWELL.high
"""As long as the longest move of the controller."""
MAX_PULSES = 10**15
"""No position is further from zero, pulses: every whole number up to there is a float."""


def read_export(folder: Path) -> Export:
    """Read a folder of pulse tables; ``FileFault`` RBL630 to RBL633 when it is not one that can be played."""
    try:
        is_folder = stat.S_ISDIR(os.stat(folder).st_mode)  # noqa: PTH116 - Path.stat would add nothing
    except (OSError, ValueError) as error:  # ValueError: a NUL character in the name
        fail(folder, "RBL630", f"cannot open {folder}: {reason(error)}")
    if not is_folder:
        fail(folder, "RBL630", f"{folder} is not a folder", "name the folder, not a file in it")
    path = folder / MANIFEST
    manifest = Object(path, read_json(path), "")
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


def _schema(manifest: Object) -> None:
    value = manifest.value("schema")
    if isinstance(value, bool) or not isinstance(value, int):
        manifest.fail("schema", f"must be the number {SCHEMA}, not {type_name(value)}")
    # before any other key: a folder of another version would be refused for a key that it is right to lack
    if value != SCHEMA:
        age = "a newer" if value > SCHEMA else "an older"
        hint = "update robolang" if value > SCHEMA else "write the folder anew with robolang export"
        manifest.fail("schema", f"is {digits(value)}, of {age} version; this one reads {SCHEMA}", "RBL633", hint)


def _step(manifest: Object) -> float:
    step_s = manifest.number("step_s", 1.0 / HIGHEST_RATE, 1.0)
    # then every frequency |dP| / dT is a whole number of Hz (``table``)
    if not abs(round(1.0 / step_s) * step_s - 1.0) <= 1e-9:
        manifest.fail("step_s", f"is {step_s:g} s and must be a whole part of a second")
    return step_s


_AXES: dict[Kind, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "cartesian": ((), ("x", "y", "z")),
    "cylindrical": (("theta", "r"), ("z",)),
    "scara": (("theta1", "theta2"), ("z", "theta4")),
}
"""Axes that a mechanism must have, first and in this order, and those that may follow."""


def _mechanism(table: Object) -> Mechanism:
    kind = cast(Kind, table.text("kind", KINDS))
    name = table.text("name")
    if kind == "arm":
        placements = table.poses("placements")
        if not placements:
            table.fail("placements", "has no axis")
        axes = tuple(f"J{k}" for k in range(1, len(placements) + 1))
        return Mechanism(
            kind=kind,
            name=name,
            axes=axes,
            placements=placements,
            sliding=_sliding(table, axes),
            X_last_flange=table.pose("X_last_flange"),
            X_flange_tool=table.pose("X_flange_tool"),
        )
    axes = _axes(table, kind)
    # x and y of the others follow from their angles; a coordinate that nothing moves must be stated
    moved = set(axes) if kind == "cartesian" else {"x", "y", *axes}
    constant = [0.0 if axis in moved else table.number(f"{axis}_mm") * MM for axis in "xyz"]
    lengths = (table.number("l1_mm") * MM, table.number("l2_mm") * MM) if kind == "scara" else (0.0, 0.0)
    return Mechanism(kind=kind, name=name, axes=axes, constant=frozen(constant), lengths=lengths)


def _sliding(table: Object, axes: tuple[str, ...]) -> frozenset[int]:
    """Return the indices of the axes of an arm that slide; none without the key, as in tables of arms that turn."""
    names = table.entries("slides") if "slides" in table else []
    for name in names:
        if name not in axes or names.count(name) > 1:
            shown = quoted(name) if isinstance(name, str) else type_name(name)
            table.fail("slides", f"names {shown}; each is one of {', '.join(axes)}, once")
    return frozenset(axes.index(name) for name in names)


def _axes(table: Object, kind: Kind) -> tuple[str, ...]:
    """Return the axes of a mechanism in their order; ``FileFault`` RBL630 for others than its kind has."""
    first, more = _AXES[kind]
    axes = table.entries("axes")
    for axis in axes:
        if axis not in (*first, *more) or axes.count(axis) > 1:
            shown = quoted(axis) if isinstance(axis, str) else type_name(axis)
            table.fail("axes", f"names {shown}; each axis is one of {', '.join((*first, *more))}, once")
    if tuple(axes[: len(first)]) != first or not axes:
        table.fail("axes", f"must begin with {', '.join(first)}" if first else "names no axis")
    return tuple(axes)


def _channels(manifest: Object, mechanism: Mechanism) -> tuple[Channel, ...]:
    tables = manifest.children("channels")
    if len(tables) != len(mechanism.axes):
        manifest.fail("channels", f"has {len(tables)} entries; the {mechanism.kind} has {len(mechanism.axes)} joints")
    channels = tuple(_channel(table, unit) for table, unit in zip(tables, mechanism.units, strict=True))
    names = [channel.name for channel in channels]
    for table, name in zip(tables, names, strict=True):
        if names.count(name) > 1:
            table.fail("name", f"is {quoted(name)}, which another channel has too")
    return channels


def _channel(table: Object, unit: Unit) -> Channel:
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
        name=name,
        unit=unit,
        per_pulse=per_pulse,
        min_hz=min_hz,
        max_hz=table.number("max_hz", min_hz),
        start_pulses=table.whole("start_pulses", -MAX_PULSES, MAX_PULSES),
    )


def _sequence(
    manifest: Object, folder: Path, channels: tuple[Channel, ...], step_s: float
) -> tuple[Marker | Move, ...]:
    moves = _Moves(folder, channels, step_s)
    return tuple(
        _marker(table) if table.text("kind", ("marker", "move")) == "marker" else moves.read(table)
        for table in manifest.children("sequence")
    )


def _place(table: Object) -> tuple[int, int | None, str]:
    """Return line, number and text of a statement."""
    number = None if table.value("number") is None else table.whole("number", 0, 10**9)
    return table.whole("line", 1, 10**9), number, table.text("text")


def _marker(table: Object) -> Marker:
    line, number, text = _place(table)
    # one statement is one marker; a folder with two in one was not written by an exporter of this schema
    if sum(key in table for key in ("load", "hand", "other")) != 1:
        table.fail("load", "or 'hand' or 'other': a marker has one of the three")
    if "other" in table:  # what the PLC does by itself: an input that it waits for, an output
        table.text("other")
        return Marker(line=line, number=number, text=text)
    if "load" in table:
        load = table.child("load")
        cog = frozen(np.array(load.numbers("cog_mm", 3)) * MM)
        return Marker(line=line, number=number, text=text, load=Load(mass=load.number("mass_kg", 0.0), cog=cog))
    hand = cast(Literal["on", "off"], table.text("hand", ("on", "off")))
    return Marker(line=line, number=number, text=text, hand=hand, dwell_s=table.number("dwell_s", 0.0, LONGEST_DWELL_S))


class _Moves:
    """Reads the moves of a sequence one after the other: keeps where the channels are and what has been read."""

    def __init__(self, folder: Path, channels: tuple[Channel, ...], step_s: float) -> None:
        self._folder, self._channels, self._step_s = folder, channels, step_s
        self._positions = [channel.start_pulses for channel in channels]
        self._files: set[str] = set()
        self._steps_left = MAX_STEPS

    def read(self, entry: Object) -> Move:
        """Return the next move; ``FileFault`` RBL630 to RBL632."""
        line, number, text = _place(entry)
        steps = entry.whole("steps", 0, MAX_STEPS)
        if steps > self._steps_left:
            entry.fail("steps", f"is {steps}: all moves together have more than {MAX_STEPS}")
        self._steps_left -= steps
        start, end = (frozen(np.array(entry.numbers(key, 3)) * MM) for key in ("start_mm", "end_mm"))
        first = frozen(self._positions)
        tables = self._tables(entry.child("tables"), steps)
        return Move(
            line=line,
            number=number,
            text=text,
            steps=steps,
            start=start,
            end=end,
            tables=tables,
            first=first,
            last=frozen(self._positions),
        )

    def _tables(self, names: Object, steps: int) -> tuple[Table | None, ...]:
        """Return the tables of a move by channel, None for one that stands still; the positions go on to its end."""
        known = [channel.name for channel in self._channels]
        for key in names.keys():  # noqa: SIM118 - not a dict
            if key not in known:
                names.fail(key, f"is not a channel; known: {', '.join(known)}")
        # all names before any file: a wrong name is an error of the manifest, and no file need be opened to see it
        files = [_file(names, channel, self._files) for channel in known]
        tables: list[Table | None] = []
        for k, (channel, file) in enumerate(zip(self._channels, files, strict=True)):
            table = None
            if file is not None:
                rows = Rows(self._folder / file, channel, self._step_s)
                table, self._positions[k] = rows.read(self._positions[k], steps)
            tables.append(table)
        return tuple(tables)


def _file(names: Object, channel: str, files: set[str]) -> str | None:
    """Return the file of a table, a plain name that no other table has; None where the channel stands still."""
    if names.value(channel) is None:
        return None
    file = names.text(channel)
    # a name in the folder itself, none below it: PureWindowsPath splits at both kinds of slash
    if not stays_inside(file) or PureWindowsPath(file).name != file or file in ("", "."):
        names.fail(channel, f"is {quoted(file)}, not the plain name of a file in the folder")
    if file in files:
        names.fail(channel, f"is {quoted(file)}, which another table is too")
    files.add(file)
    return file
