"""``robolang replay-pulses DIR``: exported pulse tables, read and replayed: frequencies, path error, simulated arm.

The tables are integrated as a PLC counts them (``runtime.pulses.replay``) and compared with the straight lines that the
program asks for. ``--physics`` drives the arm of the cell with them too. ``--json`` prints one object, in mm, s and Hz:

    {"folder", "program", "mechanism": {"kind", "name"}, "step_s", "seconds", "path_error_mm",
     "channels": [{"name", "unit", "per_pulse", "pulses", "highest_hz"}, ...],
     "sequence": [{"kind": "marker", "line", "number", "text", "dwell_s"},
                  {"kind": "move", "line", "number", "text", "steps", "seconds", "pulses": {channel: count},
                   "highest_hz", "highest_channel", "rows_mm", "between_mm", "end_mm",
                   "real": null or {"seconds", "error_mm", "end_mm"}}, ...],
     "physics": null or {"seconds", "alarms": [{"code", "message", "line", "number", "axis", "time_s"}, ...],
                                  "warnings"}}
"""

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from robolang.cli import lines
from robolang.cli.errors import DIAGNOSTICS, MOTION, reported, say, say_warnings
from robolang.cli.options import Argument, Group, Option, PlotOptions
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError
from robolang.cli.values import check_plot
from runtime.core.program_line import named
from runtime.core.units import badness

if TYPE_CHECKING:
    from rich.table import Table

    from robolang.pulse_tables.drive import Drive, DrivenMove
    from runtime.core.faults import Alarm
    from runtime.pulses.exported import Export, Marker
    from runtime.pulses.replay import MoveReplay


_Folder = Annotated[Path, Argument("DIR", "Folder of exported pulse tables.")]


class _ReplayOptions(Group):
    """What the tables are compared with, and whether the arm is driven with them."""

    PANEL: ClassVar[str] = "Replay"
    max_error: Annotated[
        float | None,
        Option("--max-error", metavar="MM", help="Exit code 1 if the path error of a move is larger, mm."),
    ] = None
    physics: Annotated[bool, Option("--physics", help="Drive the arm of --cell with the tables, in MuJoCo.")] = False
    cell: Annotated[str | None, Option("--cell", metavar="FILE", help="Cell file (.toml) for --physics.")] = None


def replay_pulses(folder: _Folder, options: _ReplayOptions, output: PlotOptions) -> None:
    """Replay exported pulse tables: frequencies, path error, with --physics also the simulated arm.

    Example: robolang replay-pulses out --plot out/path.svg

    Exit codes: 0 done; 1 a path error is larger than --max-error; 2 a value or a folder cannot be used, or is for
    another robot; 3 the simulated arm stopped with an alarm; 4 the plot cannot be written.
    """
    _check_use(options)
    check_plot(output.plot)
    with reported():
        from runtime.pulses.folder import read_export
        from runtime.pulses.replay import replay

        export = read_export(folder)
        if output.plot is not None:
            from robolang.core.storage import check_writable

            check_writable(output.plot)
        # the arm first: tables for another robot are refused before anything is printed or drawn
        drive = None if options.cell is None else _drive(export, options.cell)
        replays = replay(export)
        if output.plot is not None:
            from robolang.pulse_tables.plots import write_plot

            write_plot(output.plot, export, replays)
        found = _figures(folder, export, replays, drive)
        if output.as_json:
            echo(json.dumps(found))
        else:
            _print(found)
        too_far = options.max_error is not None and _is_too_far(replays, options.max_error)
    # an alarm outranks a distance: the arm has not driven the rest of the tables
    if drive is not None and drive.alarms:
        raise SystemExit(MOTION)
    if too_far:
        raise SystemExit(DIAGNOSTICS)


def _check_use(options: _ReplayOptions) -> None:
    """Refuse a distance that is none, and physics without a cell or a cell without physics."""
    if options.max_error is not None and not 0.0 <= options.max_error < math.inf:  # NaN is refused too
        raise OptionValueError("--max-error", f"{options.max_error:g} is not a distance in mm")
    if options.physics and options.cell is None:
        raise OptionValueError("--physics", "needs the cell of the arm: --cell FILE.toml")
    if options.cell is not None and not options.physics:
        raise OptionValueError("--cell", "needs --physics")


def _drive(export: "Export", cell: str) -> "Drive":
    from robolang.project.project import load_cell_and_settings
    from robolang.pulse_tables.drive import drive, start_angles

    spec, settings = load_cell_and_settings(None, cell, None, None, {})
    say_warnings(spec.robot.warnings)
    start_angles(export, spec)  # refuses another robot, before the line that announces the motion
    echo(f"driving {spec.robot.name}: {export.seconds:.1f} s of motion", err=True)
    return drive(export, spec, settings.profile)


def _is_too_far(replays: "list[MoveReplay]", max_error: float) -> bool:
    """Name the worst move on stderr when it is further off its line than ``max_error``, mm."""
    from runtime.core.faults import Fault

    worst = max(replays, key=lambda item: badness(item.worst_mm), default=None)
    if worst is None or worst.worst_mm <= max_error:  # in this order NaN is too far
        return False
    move = worst.move
    where = f"{named(move.line, move.number)}, {move.text}"
    say(Fault("RBL635", f"{where}: {worst.worst_mm:.4f} mm off its line, {max_error:g} mm are allowed"))
    return True


# --- the figures -----------------------------------------------------------------------------------------------------


def _figures(folder: Path, export: "Export", replays: "list[MoveReplay]", drive: "Drive | None") -> dict[str, Any]:
    """Return what came of it in plain types; see the module for the keys."""
    from runtime.pulses.exported import Marker

    played = iter(replays)
    driven = iter(() if drive is None else drive.moves)  # fewer than replays where an alarm ended the drive
    sequence = [
        _marker(item) if isinstance(item, Marker) else _move(export, next(played), next(driven, None))
        for item in export.sequence
    ]
    return {
        "folder": str(folder),
        "program": export.program,
        "mechanism": {"kind": export.mechanism.kind, "name": export.mechanism.name},
        "step_s": export.step_s,
        "seconds": export.seconds,
        "path_error_mm": max((item.worst_mm for item in replays), key=badness, default=0.0),
        "channels": _channels(export, replays),
        "sequence": sequence,
        "physics": None
        if drive is None
        else {
            "seconds": drive.seconds,
            "alarms": [_alarm(alarm, drive.tick_s) for alarm in drive.alarms],
            "warnings": [_alarm(alarm, drive.tick_s) for alarm in drive.warnings],
        },
    }


def _marker(marker: "Marker") -> dict[str, Any]:
    return {
        "kind": "marker",
        "line": marker.line,
        "number": marker.number,
        "text": marker.text,
        "dwell_s": marker.dwell_s,
    }


def _move(export: "Export", found: "MoveReplay", driven: "DrivenMove | None") -> dict[str, Any]:
    move, (hz, channel) = found.move, found.fastest
    names = [item.name for item in export.channels]
    return {
        "kind": "move",
        "line": move.line,
        "number": move.number,
        "text": move.text,
        "steps": move.steps,
        "seconds": found.duration_s,
        "pulses": dict(zip(names, found.counts, strict=True)),
        "highest_hz": hz,
        "highest_channel": names[channel] if hz else None,
        "rows_mm": found.rows_mm,
        "between_mm": found.between_mm,
        "end_mm": found.end_mm,
        "real": None if driven is None else _driven(driven),
    }


def _channels(export: "Export", replays: "list[MoveReplay]") -> list[dict[str, Any]]:
    return [
        {
            "name": channel.name,
            "unit": channel.unit,
            "per_pulse": channel.per_pulse,
            "pulses": sum(item.counts[k] for item in replays),
            "highest_hz": max(
                (float(abs(item.frequency[:, k]).max(initial=0.0)) for item in replays), key=badness, default=0.0
            ),
        }
        for k, channel in enumerate(export.channels)
    ]


def _driven(move: "DrivenMove") -> dict[str, Any]:
    return {"seconds": move.seconds, "error_mm": move.error_mm, "end_mm": move.end_mm}


def _alarm(alarm: "Alarm", tick_s: float) -> dict[str, Any]:
    axis, at = None if alarm.axis is None else alarm.axis + 1, alarm.statement
    return {
        "code": alarm.code,
        "message": alarm.message,
        "line": None if at is None else at.line,
        "number": None if at is None else at.number,
        "axis": axis,
        "time_s": round(alarm.tick * tick_s, 9),
    }


# --- the table -------------------------------------------------------------------------------------------------------

_COLUMNS = ("steps", "time\n\ns", "fastest\nchannel\nHz", "error\nat row\nmm", "error\nin row\nmm", "error\nat end\nmm")
_REAL = "error\nof arm\nmm"
_NARROWEST, _WIDEST = 8, 40
_LEGEND = (
    "error: largest distance of the tool from the programmed path, at the ends of\n"
    "rows (at row) and between them (in row); at end: distance from the end point"
)


def _print(found: dict[str, Any]) -> None:
    from robolang.cli.console import Console
    from robolang.core.diagnostics import safe

    console = Console()
    mechanism, physics = found["mechanism"], found["physics"]
    console.print(
        safe(f"{found['program']} on {mechanism['name']}, steps of {found['step_s'] * 1e3:g} ms"),
        style="italic",
        soft_wrap=True,
    )
    console.print(_table(found, console.width))
    console.print(_LEGEND, style="italic", soft_wrap=True)
    for kind, alarms in () if physics is None else (("warning", physics["warnings"]), ("stopped", physics["alarms"])):
        for alarm in alarms:
            where = "" if alarm["line"] is None else f" at {lines.name(alarm)}"
            text = f"{kind}{where}, {alarm['time_s']:.3f} s: {alarm['code']} {alarm['message']}"
            console.print(safe(text), soft_wrap=True)
    for line in _totals(found):
        console.print(line, soft_wrap=True)


def _table(found: dict[str, Any], width: int) -> "Table":
    from rich import box
    from rich.table import Table

    headings = (*_COLUMNS, *(() if found["physics"] is None else (_REAL,)))
    where = lines.headings(found["sequence"])
    rows = [[*lines.cells(row, where), *_cells(row, real=found["physics"] is not None)] for row in found["sequence"]]
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False, show_edge=False)
    for heading in where:
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("statement", no_wrap=True)
    for heading in headings:
        table.add_column(heading, justify="right", no_wrap=True)
    room, at = _room(rows, where, headings, width), len(where)
    for row in rows:
        text = row[at]
        row[at] = text if len(text) <= room else f"{text[: room - 1]}…"
        table.add_row(*row)
    return table


def _cells(row: dict[str, Any], *, real: bool) -> list[str]:
    from robolang.core.diagnostics import safe

    head = [safe(row["text"])]
    if row["kind"] == "marker":
        waits = f"{row['dwell_s']:.3f}" if row["dwell_s"] else ""  # a LOAD takes no time
        return [*head, "", waits, *([""] * (len(_COLUMNS) - 2 + real))]
    fastest = "-" if row["highest_channel"] is None else f"{row['highest_hz']:.0f} {row['highest_channel']}"
    cells = [
        str(row["steps"]),
        f"{row['seconds']:.3f}",
        fastest,
        *(f"{row[key]:.4f}" for key in ("rows_mm", "between_mm", "end_mm")),
    ]
    return [*head, *cells, *((["-"] if row["real"] is None else [f"{row['real']['error_mm']:.3f}"]) if real else [])]


def _room(rows: list[list[str]], where: tuple[str, ...], headings: tuple[str, ...], width: int) -> int:
    """Return how wide a statement may be so that the table is not wider than the console."""
    names = [*where, "", *(max(heading.split("\n"), key=len) for heading in headings)]
    widths = [max(map(len, column)) for column in zip(names, *rows, strict=True)]
    taken = sum(widths) - widths[len(where)] + 2 * (len(widths) - 1)  # two spaces between columns
    return min(max(width - taken, _NARROWEST), _WIDEST)


def _totals(found: dict[str, Any]) -> list[str]:
    """Return a line of the tables and, where it was driven, one of the simulated arm."""
    moves = [row for row in found["sequence"] if row["kind"] == "move"]
    pulses = sum(channel["pulses"] for channel in found["channels"])
    many = "1 move" if len(moves) == 1 else f"{len(moves)} moves"
    totals = [f"{many}, {sum(row['steps'] for row in moves)} steps, {found['seconds']:.3f} s, {pulses} pulses"]
    if moves:
        worst = max(moves, key=lambda row: badness(_worst(row)))
        totals[0] += f"; largest path error {_worst(worst):.4f} mm, in {lines.name(worst)}"
    driven = [row for row in moves if row["real"] is not None]
    if driven:
        worst = max(driven, key=lambda row: badness(float(row["real"]["error_mm"])))
        totals.append(
            f"simulated arm: {found['physics']['seconds']:.3f} s; largest path error "
            f"{worst['real']['error_mm']:.3f} mm, in {lines.name(worst)}"
        )
    return totals


def _worst(row: dict[str, Any]) -> float:
    return float(max(row["rows_mm"], row["between_mm"], row["end_mm"], key=badness))
