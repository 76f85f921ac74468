"""The folder of an export: its manifest and its tables, made into an ``Export`` or refused.

A folder holds ``manifest.json`` and one CSV file for each channel and move. This reader knows nothing of the exporter:
it takes the files as they are. Everything is checked on reading: what comes out of ``read_export`` can be played. The
tables of a folder belong together: each goes on where its channel stood after the move before, and lasts as long as
the move. Reading is bounded: only files of the folder itself (``runtime.pulses.manifest``), each of them one table, at
most ``MAX_STEPS`` steps. Every error is a ``FileFault`` RBL630 to RBL633: a row of a table is named by its line
(``runtime.pulses.rows``), a value of the manifest by its key.
"""

import os
import stat
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Literal, cast

import numpy as np

from runtime.core.frames import frozen
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
LONGEST_DWELL_S = 600.0
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
    if value != SCHEMA:
        age = "a newer" if value > SCHEMA else "an older"
        hint = "update robolang" if value > SCHEMA else "write the folder anew with robolang export"
        manifest.fail("schema", f"is {digits(value)}, of {age} version; this one reads {SCHEMA}", "RBL633", hint)


def _step(manifest: Object) -> float:
    step_s = manifest.number("step_s", 1.0 / HIGHEST_RATE, 1.0)
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
        return Mechanism(
            kind=kind,
            name=name,
            axes=tuple(f"J{k}" for k in range(1, len(placements) + 1)),
            placements=placements,
            X_last_flange=table.pose("X_last_flange"),
            X_flange_tool=table.pose("X_flange_tool"),
        )
    axes = _axes(table, kind)
    moved = set(axes) if kind == "cartesian" else {"x", "y", *axes}
    constant = [0.0 if axis in moved else table.number(f"{axis}_mm") * MM for axis in "xyz"]
    lengths = (table.number("l1_mm") * MM, table.number("l2_mm") * MM) if kind == "scara" else (0.0, 0.0)
    return Mechanism(kind=kind, name=name, axes=axes, constant=frozen(constant), lengths=lengths)


def _axes(table: Object, kind: Kind) -> tuple[str, ...]:
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


def _place(table: Object) -> tuple[int, int | None, str]:
    """Return line, number and text of a statement."""
    number = None if table.value("number") is None else table.whole("number", 0, 10**9)
    return table.whole("line", 1, 10**9), number, table.text("text")


def _marker(table: Object) -> Marker:
    line, number, text = _place(table)
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


def _move(
    entry: Object,
    folder: Path,
    channels: tuple[Channel, ...],
    step_s: float,
    stands: tuple[int, ...],
    files: set[str],
    most: int,
) -> tuple[Move, tuple[int, ...]]:
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
        table, ends_at = (None, at) if file is None else Rows(folder / file, channel, step_s).read(at, steps)
        found.append(table)
        last.append(ends_at)
    move = Move(
        line=line,
        number=number,
        text=text,
        steps=steps,
        start=start,
        end=end,
        tables=tuple(found),
        first=frozen(stands),
        last=frozen(last),
    )
    return move, tuple(last)


def _file(names: Object, channel: str, files: set[str]) -> str | None:
    """Return the name of a table's file, a plain one that no other table has; None where the channel stands still."""
    if names.value(channel) is None:
        return None
    file = names.text(channel)
    # a Windows path must be refused on Linux too: the same folder means the same on both
    plain = all(kind(file).name == file for kind in (PurePosixPath, PureWindowsPath))
    if not plain or file in ("", ".", "..") or "\0" in file:
        names.fail(channel, f"is {quoted(file)}, not the plain name of a file in the folder")
    if file in files:
        names.fail(channel, f"is {quoted(file)}, which another table is too")
    files.add(file)
    return file
