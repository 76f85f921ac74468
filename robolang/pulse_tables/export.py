"""A program as positioning tables for a PLC: one for each move and channel, markers between them, a manifest.

MOVE becomes tables (document 004, ``runtime.pulses``). LOAD, HAND, WAIT, OUT and the like cannot be in one: they become
markers in the sequence; WRIST is in the moves that it governs. Loops and variables are carried out here. What depends
on a sensor or an input, or asks of a mechanism what it has no joint for, is refused at its place in the program.
Everything is made in memory, then the folder is written whole or not at all (docs/pulses.md has the files).
"""

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, assert_never

import numpy as np

from robolang.interpreter.effects import MoveTo
from robolang.project.project import Project
from robolang.pulse_tables.table_target import (
    HandMarker,
    LoadMarker,
    Marker,
    OtherMarker,
    TableMove,
    in_tables,
)
from robolang.syntax.unparse import describe
from runtime.core.program_line import named
from runtime.core.units import MM
from runtime.pulses import mechanism, panasonic_f174
from runtime.pulses.channels import Channel, ChannelFile, channels_of, default_channels, motor_pulse, read_channel_file
from runtime.pulses.emission import Pulses
from runtime.pulses.machine import Machine, RobotArm
from runtime.pulses.move import MovePulses
from runtime.pulses.table import as_csv, data_tables, rows_of

MANIFEST = "manifest.json"
F174_COMMENTS = (
    "F174, absolute positions: value is a double word, word its offset from the start of the table",
    "each table is started by the step timer at its start_step",
)
SCHEMA = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportRequest:
    """How to export: ``channels`` a channel file or the name of a built-in mechanism (None: the cell's robot).

    ``step_hz`` steps a second, a whole number; ``min_hz`` in place of the channels'; ``f174`` writes that form too.
    """

    channels: str | None = None
    step_hz: int = 100
    min_hz: float | None = None
    f174: bool = True

    @property
    def step_s(self) -> float:
        """Length of a step, s."""
        return 1.0 / self.step_hz


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportedMove:
    """A move of the sequence: the statement, its pulses and its files, None for a channel that stands."""

    effect: MoveTo
    pulses: MovePulses
    files: tuple[str | None, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Export:
    """What is written: texts by file name, the manifest among them; ``moves`` and ``markers`` for the summary."""

    machine: Machine
    channels: tuple[Channel, ...]
    request: ExportRequest
    sequence: tuple[ExportedMove | Marker, ...]
    files: dict[str, str]

    @property
    def moves(self) -> list[ExportedMove]:
        """The moves in order."""
        return [item for item in self.sequence if isinstance(item, ExportedMove)]


def export(project: Project, request: ExportRequest) -> Export:
    """Return the tables of a checked program; ``NotExportableError`` at a statement that cannot be exported.

    ``Fault`` or ``FileFault`` for channel and mechanism files that cannot be used.
    """
    machine, channels = equipment(project, request)
    carried_out = in_tables(project, machine, channels, request.step_s)
    tables = _Tables(carried_out.machine, channels, request)
    sequence = tuple(tables.of(item) if isinstance(item, TableMove) else item for item in carried_out.sequence)
    found = Export(
        machine=carried_out.machine, channels=channels, request=request, sequence=sequence, files=tables.files
    )
    # json would write NaN as a word that no other reader of JSON takes
    manifest = json.dumps(_manifest(found, project, carried_out.first), indent=1, allow_nan=False) + "\n"
    return replace(found, files={**tables.files, MANIFEST: manifest})


def equipment(project: Project, request: ExportRequest) -> tuple[Machine, tuple[Channel, ...]]:
    """Return the machine and its channels that a request names."""
    file, machine_name = _channel_file(request.channels)
    if file is not None and file.mechanism:
        machine_name = file.mechanism
    machine: Machine
    # the path is one beside the channel file
    if machine_name.endswith(".toml") and file is not None:
        found = mechanism.load_file(file.mechanism_path())
        machine, pulse = found, found.pulse
    elif machine_name in mechanism.library():
        found = mechanism.load_builtin(machine_name)
        machine, pulse = found, found.pulse
    else:
        cell = project.cell
        if machine_name not in ("", cell.robot.name) and file is not None:
            known = ", ".join(mechanism.library())
            file.table.fail(
                "RBL610",
                f"'{machine_name}' is no built-in mechanism ({known}), no .toml file and not "
                f"the robot of the cell, {cell.robot.name}",
                key="mechanism",
            )
        machine = RobotArm(cell.robot, project.profile, cell.hand.X_flange_tool, cell.home)
        pulse = tuple(motor_pulse(axis.motor.gear_ratio) for axis in cell.robot.axes)
    if file is None:
        return machine, default_channels(machine.joints, pulse, request.min_hz)
    return machine, channels_of(file, machine.joints, pulse, machine.name, request.min_hz)


def _channel_file(name: str | None) -> tuple[ChannelFile | None, str]:
    """Return the channel file that is named, or the built-in mechanism."""
    if name is None:
        return None, ""
    if name in mechanism.library():
        return None, name
    return read_channel_file(Path(name)), ""


class _Tables:
    """The files of the moves so far."""

    def __init__(self, machine: Machine, channels: tuple[Channel, ...], request: ExportRequest) -> None:
        self._machine, self._channels, self._request = machine, channels, request
        self.files: dict[str, str] = {}
        self._moves = 0

    def of(self, move: TableMove) -> ExportedMove:
        """Add the files of a move."""
        self._moves += 1
        names = tuple(self._channel(move, k) for k in range(len(self._channels)))
        return ExportedMove(effect=move.effect, pulses=move.pulses, files=names)

    def _channel(self, move: TableMove, k: int) -> str | None:
        """Add the neutral table of channel k, then the PLC's, and return its name; None where the channel stands."""
        effect, channel, request = move.effect, self._channels[k], self._request
        emission, start = move.pulses.emitted[k], int(move.pulses.start[k])
        if not emission.steps.any():
            return None
        rows = rows_of(emission.steps, start, move.pulses.count, request.step_hz)
        unit, scale = channel.unit
        # the count first: a line in a loop makes several moves, and files then sort as they are played
        stem = f"{self._moves:02d}_line{effect.line}_{channel.joint.name}"
        where = named(effect.line, effect.number)
        comments = [
            f"{self._machine.name}, move {self._moves}, {where}: {describe(effect.node)}",
            f"channel {channel.joint.name} from {start} pulses; one pulse is {channel.pulse / scale:.9g} {unit}; one "
            f"step is {request.step_s * 1e3:g} ms",
        ]
        self.files[f"{stem}.csv"] = as_csv(rows, [*comments, "frequency in Hz, target in pulses from zero"])
        if request.f174:
            plc = list(data_tables(rows, start))
            self.files[f"{stem}.f174.csv"] = panasonic_f174.as_csv(plc, channel.output, [*comments, *F174_COMMENTS])
        return f"{stem}.csv"


# --- the manifest ----------------------------------------------------------------------------------------------------


def _manifest(found: Export, project: Project, start: Pulses) -> dict[str, Any]:
    return {
        "schema": SCHEMA,
        "program": Path(project.source.path).name,
        "mechanism": found.machine.described(),
        "step_s": found.request.step_s,
        "channels": [
            {
                "name": channel.joint.name,
                "unit": channel.unit[0],
                "per_pulse": channel.pulse / channel.unit[1],
                "min_hz": channel.min_hz,
                "max_hz": channel.max_hz,
                "output": channel.output,
                "start_pulses": int(at),
            }
            for channel, at in zip(found.channels, start, strict=True)
        ],
        "sequence": [_entry(item, found) for item in found.sequence],
    }


def _entry(item: ExportedMove | Marker, found: Export) -> dict[str, Any]:
    effect = item.effect
    head = {"line": effect.line, "number": effect.number, "text": describe(effect.node)}
    match item:
        case ExportedMove():
            return {"kind": "move", **head, **_of_move(item, found)}
        case LoadMarker():
            # rounded: 15.7 mm, stored in m, comes back as 15.699999999999998
            cog = [float(x) for x in np.round(item.payload.cog / MM, 9)]
            return {"kind": "marker", **head, "load": {"mass_kg": item.payload.mass, "cog_mm": cog}}
        case HandMarker():
            return {"kind": "marker", **head, "hand": "on" if item.effect.closed else "off", "dwell_s": item.dwell_s}
        case OtherMarker():
            return {"kind": "marker", **head, "other": type(effect.node).__name__.lower()}
        case _:
            assert_never(item)


def _of_move(move: ExportedMove, found: Export) -> dict[str, Any]:
    start, end = ((point / MM).tolist() for point in move.pulses.curve.ends)
    tables = {channel.joint.name: file for channel, file in zip(found.channels, move.files, strict=True)}
    plc = {name: file.replace(".csv", ".f174.csv") for name, file in tables.items() if file is not None}
    return {
        "steps": move.pulses.count,
        "start_mm": start,
        "end_mm": end,
        "tables": tables,
        "f174": plc if found.request.f174 else {},
        "summary": summary(move, found),
    }


def summary(move: ExportedMove, found: Export) -> dict[str, Any]:
    """Return the figures of a move in plain types: s, mm, mm/s, Hz, and per channel what was done to it."""
    pulses, step_s = move.pulses, found.request.step_s
    steps = pulses.steps
    return {
        "steps": pulses.count,
        # 57 steps of 0.01 s are 0.5700000000000001 s
        "seconds": round(pulses.count * step_s, 9),
        "length_mm": pulses.curve.length / MM,
        "speed_mm_s": 0.0 if steps is None else steps.speed * pulses.curve.length / MM,
        "slowed": pulses.slowed,
        "error_mm": float(pulses.error.max()) / MM,
        "notes": list(pulses.notes),
        "channels": [
            {
                "name": channel.joint.name,
                "pulses": int(each.steps.sum()),
                "highest_hz": highest,
                "raised": each.raised,
                "rule": each.rule,
                "debt_pulses": each.debt,
                "settled_pulses": each.settled,
                "tables": _count(each.steps, int(start), pulses.count, found.request.step_hz),
            }
            for channel, each, start, highest in zip(
                found.channels, pulses.emitted, pulses.start, pulses.highest_hz(step_s), strict=True
            )
        ],
    }


def _count(steps: Pulses, start: int, count: int, step_hz: int) -> int:
    return sum(1 for _ in data_tables(rows_of(steps, start, count, step_hz), start))
