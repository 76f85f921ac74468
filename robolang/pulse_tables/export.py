"""A program as positioning tables for a PLC: one for each move and channel, markers between them, a manifest.

MOVE becomes tables (document 004, ``runtime.pulses``). LOAD, HAND, WAIT, OUT and the like cannot be in one: they become
markers in the sequence; WRIST is in the moves that it governs. Loops and variables are carried out here. What depends
on a sensor or an input, or asks of a mechanism what it has no joint for, is refused at its place in the program.
Everything is made in memory, then the folder is written whole or not at all (docs/pulses.md has the files).
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from robolang.core.diagnostics import Diagnostic
from robolang.execution import lowering
from robolang.execution.alarms import calls
from robolang.execution.lowering import Surroundings
from robolang.interpreter.effects import Drain, Effect, MoveTo, SetHand, SetPayload, SetSeam, SetTool, SetWrist
from robolang.interpreter.machine import execute
from robolang.interpreter.program_fault import ProgramFault
from robolang.project.project import Project
from robolang.syntax import ast
from robolang.syntax.ast import Delay, Number, Wait
from robolang.syntax.unparse import describe
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.program_line import named
from runtime.core.units import MM
from runtime.motion.commands import MoveLinear
from runtime.pulses import mechanism, panasonic_f174
from runtime.pulses.channels import Channel, ChannelFile, channels_of, default_channels, motor_pulse, read_channel_file
from runtime.pulses.emission import Pulses
from runtime.pulses.machine import Machine, RobotArm
from runtime.pulses.move import MovePulses, counted, plan_move
from runtime.pulses.table import as_csv, data_tables, rows_of

MANIFEST = "manifest.json"
F174_COMMENTS = (
    "F174, absolute positions: value is a double word, word its offset from the start of the table",
    "each table is started by the step timer at its start_step",
)
SCHEMA = 1


class NotExportableError(Exception):
    """A statement that cannot be put into tables; ``diagnostic`` has its place."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


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
    """A move of the sequence: the statement and its pulses."""

    effect: MoveTo
    pulses: MovePulses
    files: tuple[str | None, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Export:
    """What is written: texts by file name, the manifest among them; ``moves`` and ``markers`` for the summary."""

    machine: Machine
    channels: tuple[Channel, ...]
    request: ExportRequest
    sequence: tuple[ExportedMove | Effect, ...]
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
    stand, start = machine.home, counted(machine.home.q, channels)
    first, placed = start, False
    sequence: list[ExportedMove | Effect] = []
    files: dict[str, str] = {}
    for effect in _effects(project):
        try:
            if isinstance(effect, MoveTo):
                command = _command(effect, project, machine, stand.q)
                if not placed:
                    machine, placed = machine.placed(command.X_world_tool[:3, 3]), True
                pulses = plan_move(machine, stand, command, channels, start, request.step_s)
                stand, start = machine.arrived(stand, command, pulses.q[-1]), pulses.end
                number = 1 + sum(isinstance(item, ExportedMove) for item in sequence)
                tables = _tables(effect, pulses, number, machine, channels, request)
                files.update({name: text for table in tables for name, text in table})
                names = tuple(table[0][0] if table else None for table in tables)
                sequence.append(ExportedMove(effect=effect, pulses=pulses, files=names))
            elif _marked(effect, project):
                sequence.append(effect)
        except Fault as fault:
            found = Diagnostic(code=fault.code, message=fault.message, span=effect.span, hint=fault.hint)
            raise NotExportableError(found) from None
    found_export = Export(machine=machine, channels=channels, request=request, sequence=tuple(sequence), files=files)
    files[MANIFEST] = json.dumps(_manifest(found_export, project, first), indent=1, allow_nan=False) + "\n"
    return found_export


def equipment(project: Project, request: ExportRequest) -> tuple[Machine, tuple[Channel, ...]]:
    """Return the machine and its channels that a request names."""
    file, machine_name = _channel_file(request.channels)
    if file is not None and file.mechanism:
        machine_name = file.mechanism
    machine: Machine
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


def _effects(project: Project) -> Iterator[Effect]:
    """Yield the effects of a program in which nothing depends on a run; a WAIT is passed, for it becomes a marker."""
    waiting = {id(line.statement) for line in project.program.lines if isinstance(line.statement, Wait)}
    passed = tuple(
        ast.replace(line, statement=Delay(seconds=Number(value=0.0, text="0"), span=line.statement.span))
        if line.statement is not None and id(line.statement) in waiting
        else line
        for line in project.program.lines
    )
    texts = {line.source_line: line.statement for line in project.program.lines}
    try:
        for effect in execute(ast.replace(project.program, lines=passed), points=project.points.names):
            original = texts[effect.line]
            yield replace(effect, node=original) if isinstance(original, Wait) else effect
    except ProgramFault as fault:
        code = "RBL431" if fault.code == "RBL532" else fault.code
        hint = fault.hint if code == fault.code else ""
        found = Diagnostic(
            code=code, message=fault.message, span=fault.origin.span, hint=hint, related=calls(fault.calls)
        )
        raise NotExportableError(found) from None


def _command(effect: MoveTo, project: Project, machine: Machine, q: Array) -> MoveLinear:
    point = project.points.get(effect.target.point)
    if effect.way != "line" or not effect.zone_mm <= 0.0:
        what = "does not stop at its end (ZONE)" if effect.way == "line" else "is not straight"
        raise Fault("RBL431", f"the move {what}; tables hold straight moves from rest to rest", "write MOVE and FINE")
    if not isinstance(machine, RobotArm) and point is not None and point.joints is not None:
        raise Fault(
            "RBL431",
            f"{point.name} is taught as joint angles of {project.cell.robot.name}, which the "
            f"{machine.name} has not: teach its pose",
        )
    kinematics = machine.kinematics if isinstance(machine, RobotArm) else _kinematics(project)
    if not isinstance(machine, RobotArm):
        if effect.target.last:
            raise Fault("RBL431", "DEPART goes by the tool's axis, which this machine does not tell: teach a point")
        q = project.cell.home
    command = lowering.move(
        effect,
        Surroundings(
            points=project.points,
            cell=project.cell,
            kinematics=kinematics,
            X_flange_tool=project.cell.hand.X_flange_tool,
            q_last=q,
        ),
    )
    assert isinstance(command, MoveLinear)
    return command


def _kinematics(project: Project) -> Any:
    from runtime.robot.kinematics.kinematics import Kinematics

    return Kinematics(project.cell.robot)


def _marked(effect: Effect, project: Project) -> bool:
    """Return whether a statement becomes a marker; ``Fault`` where it can be none."""
    if isinstance(effect, SetSeam) and effect.sensor is not None:
        raise Fault(
            "RBL431",
            "a seam sensor shifts the path as it goes, and a table is fixed before the move",
            "take the SEAM statements out, or let the controller run this program",
        )
    if isinstance(effect, SetPayload):
        lowering.payload(effect, project.cell)
    elif isinstance(effect, SetHand):
        lowering.dwell_s(effect, project.cell)
    elif isinstance(effect, SetTool):
        raise Fault("RBL431", "another tool cannot be taken in the middle of an export")
    return not isinstance(effect, SetSeam | SetWrist | Drain)


Named = tuple[str, str]


def _tables(
    effect: MoveTo,
    move: MovePulses,
    number: int,
    machine: Machine,
    channels: tuple[Channel, ...],
    request: ExportRequest,
) -> list[list[Named]]:
    """Return the files of each channel: the neutral table, then the PLC's; [] for a channel that stands."""
    found: list[list[Named]] = []
    for k, (channel, emission) in enumerate(zip(channels, move.emitted, strict=True)):
        if not emission.steps.any():
            found.append([])
            continue
        start = int(move.start[k])
        rows = rows_of(emission.steps, start, move.count, request.step_hz)
        unit, scale = channel.unit
        stem = f"{number:02d}_line{effect.line}_{channel.joint.name}"
        comments = [
            f"{machine.name}, move {number}, {named(effect.line, effect.number)}: {describe(effect.node)}",
            f"channel {channel.joint.name} from {start} pulses; one pulse is {channel.pulse / scale:.9g} {unit}; one "
            f"step is {request.step_s * 1e3:g} ms",
        ]
        texts = [(f"{stem}.csv", as_csv(rows, [*comments, "frequency in Hz, target in pulses from zero"]))]
        if request.f174:
            plc = panasonic_f174.as_csv(list(data_tables(rows, start)), channel.output, [*comments, *F174_COMMENTS])
            texts.append((f"{stem}.f174.csv", plc))
        found.append(texts)
    return found


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
        "sequence": [_entry(item, found, project) for item in found.sequence],
    }


def _entry(item: ExportedMove | Effect, found: Export, project: Project) -> dict[str, Any]:
    effect: Any = item.effect if isinstance(item, ExportedMove) else item
    head = {"line": effect.line, "number": effect.number, "text": describe(effect.node)}
    if isinstance(item, ExportedMove):
        start, end = ((point / MM).tolist() for point in item.pulses.way.ends)
        names = [channel.joint.name for channel in found.channels]
        plc = {
            name: file.replace(".csv", ".f174.csv")
            for name, file in zip(names, item.files, strict=True)
            if file is not None and found.request.f174
        }
        return {
            "kind": "move",
            **head,
            "steps": item.pulses.count,
            "start_mm": start,
            "end_mm": end,
            "tables": dict(zip(names, item.files, strict=True)),
            "f174": plc,
            "summary": summary(item, found),
        }
    if isinstance(item, SetPayload):
        payload = lowering.payload(item, project.cell)
        cog = [float(x) for x in np.round(payload.cog / MM, 9)]
        return {"kind": "marker", **head, "load": {"mass_kg": payload.mass, "cog_mm": cog}}
    if isinstance(item, SetHand):
        return {
            "kind": "marker",
            **head,
            "hand": "on" if item.closed else "off",
            "dwell_s": lowering.dwell_s(item, project.cell),
        }
    return {"kind": "marker", **head, "other": type(item.node).__name__.lower()}


def summary(move: ExportedMove, found: Export) -> dict[str, Any]:
    """Return the figures of a move in plain types: s, mm, mm/s, Hz, and per channel what was done to it."""
    pulses, step_s = move.pulses, found.request.step_s
    steps = pulses.steps
    return {
        "steps": pulses.count,
        "seconds": round(pulses.count * step_s, 9),
        "length_mm": pulses.way.length / MM,
        "speed_mm_s": 0.0 if steps is None else steps.speed * pulses.way.length / MM,
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
