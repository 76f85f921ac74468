"""``robolang export pulses PROG -o DIR``: a program as positioning tables for a PLC with pulse channels.

The folder is written whole or not at all: manifest.json, one table for each move and channel, the same for F174
(docs/pulses.md). ``--json`` prints one object: {"machine", "step_s", "folder", "moves": [{"line", "number", "text",
"steps", "seconds", "length_mm", "speed_mm_s", "slowed", "error_mm", "notes", "channels": [...]}], "markers": [...]}.
"""

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import typer

from robolang.cli import lines
from robolang.cli.command import PlainCommand, command
from robolang.cli.errors import DIAGNOSTICS, exit_code, reported, say_warnings
from robolang.cli.options import CellOptions, Group, Option, PlotOptions, Program
from robolang.cli.output import echo, show_finding
from robolang.cli.usage import OptionValueError
from robolang.cli.values import check_plot
from runtime.core.rounding import beside
from runtime.core.units import badness

if TYPE_CHECKING:
    from rich.table import Table

    from robolang.project.project import Project
    from robolang.pulse_tables.export import Export, ExportRequest
    from runtime.pulses.channels import Channel

app = typer.Typer(no_args_is_help=True, add_completion=False, help="Write a program in the form of other controllers.")
SHORTEST_MS, LONGEST_MS = 1.0, 1000.0
LOWEST_HZ, HIGHEST_HZ = 1.0, 1e5  # the pulse outputs that the tables are made for end at 100 kHz (docs/pulses.md)


@app.callback()
def formats() -> None:
    """Keep ``pulses`` a sub-command."""


class _TableOptions(Group):
    """The machine and the form of the tables."""

    PANEL: ClassVar[str] = "Pulse tables"
    channels: Annotated[
        str | None,
        Option(
            "--channels", metavar="F.toml|NAME", help="Channel file, or xy, cylindrical or scara; default: the arm."
        ),
    ] = None
    step: Annotated[str, Option("--step", metavar="TIME", help="Length of a step, such as 10ms.")] = "10ms"
    fmin: Annotated[
        float | None,
        Option("--fmin", metavar="HZ", help="Lowest pulse frequency of every channel, Hz; default: 191."),
    ] = None
    plc: Annotated[
        str, Option("--plc", help="Form of a PLC to write beside the neutral tables.", choices=("f174", "none"))
    ] = "f174"


class _OutputOptions(PlotOptions):
    out: Annotated[
        Path, Option("--out", "-o", metavar="DIR", help="Folder to write: new, empty, or an earlier export.")
    ]


@app.command("pulses", cls=PlainCommand)
@command
def pulses(program: Program, files: CellOptions, tables: _TableOptions, output: _OutputOptions) -> None:
    """Write a program as pulse tables: steps of equal time for the pulse channels of a PLC.

    Example: robolang export pulses pick_and_place.rbl -o out

    Exit codes: 0 done; 1 the program has errors; 2 a file or an option cannot be used; 3 a move cannot be exported; 4
    the folder cannot be written.
    """
    request = _request(tables)
    check_plot(output.plot)
    with reported():
        from robolang.core.storage import check_folder, check_writable, write_folder

        # before the program is read: planning takes the most time, and would be lost
        check_folder(output.out, written_here)
        if output.plot is not None:
            check_writable(output.plot)
        from robolang.project.project import load_project

        project = load_project(program, files.cell, files.robot)
        _refuse(
            project
        )  # not cli.refuse, which plans the motion of a run: the export plans by the limits of its channels
        found = _exported(project, request)
        write_folder(output.out, {name: text.encode("utf-8") for name, text in found.files.items()}, written_here)
        if output.as_json:
            echo(json.dumps(_plain(found, output.out)))
        else:
            _print(found, output.out)
        if output.plot is not None:
            _plot(output.out, output.plot)


def _request(tables: _TableOptions) -> "ExportRequest":
    from robolang.pulse_tables.export import ExportRequest

    step_hz, fmin = _step_hz(tables.step), tables.fmin
    if fmin is not None and not LOWEST_HZ <= fmin <= HIGHEST_HZ:  # NaN is refused too
        shown = beside(fmin, LOWEST_HZ, HIGHEST_HZ)[0]
        raise OptionValueError("--fmin", f"{shown} is not between {LOWEST_HZ:g} and {HIGHEST_HZ:.0f} Hz")
    return ExportRequest(channels=tables.channels, step_hz=step_hz, min_hz=fmin, f174=tables.plc == "f174")


def _exported(project: "Project", request: "ExportRequest") -> "Export":
    """Return the tables; leave, with the place of the move, when one cannot be exported."""
    from robolang.core.diagnostics import render
    from robolang.pulse_tables.export import export
    from robolang.pulse_tables.table_target import NotExportableError

    try:
        return export(project, request)
    except NotExportableError as error:
        show_finding(render(error.diagnostic, project.source))
        raise SystemExit(exit_code(error.diagnostic.code)) from None


def written_here(name: str) -> bool:
    """Return whether a file of that name may be one of an earlier export."""
    # a folder with any other file is left alone: it may be the user's, and the whole folder would be replaced
    return name == "manifest.json" or re.fullmatch(r"\d+_line\d+_\w+(\.f174)?\.csv", name) is not None


def _step_hz(text: str) -> int:
    """Return steps a second; a step must be a whole share of a second, for frequencies to be whole numbers."""
    found = re.fullmatch(r"([0-9]+(?:\.[0-9]*)?|\.[0-9]+) *(ms|s)?", text.strip().lower())
    if found is None:
        raise OptionValueError("--step", f"'{text[:20]}' is not a time such as 10ms")
    ms = float(found[1]) * (1000.0 if found[2] == "s" else 1.0)
    if not SHORTEST_MS <= ms <= LONGEST_MS:
        shown, shortest, longest = beside(ms, SHORTEST_MS, LONGEST_MS)
        raise OptionValueError("--step", f"{shown} ms is not between {shortest} and {longest} ms")
    whole = round(1000.0 / ms)
    # to 1e-9: 1000 / 3.3333333333 is meant as 300
    if not abs(1000.0 / ms - whole) <= 1e-9 * whole:
        near = ", ".join(f"{1000.0 / each:g}ms" for each in (whole + 1, max(whole, 1)))
        raise OptionValueError(
            "--step", f"{ms:g} ms does not divide a second, so frequencies would be no whole numbers; near it: {near}"
        )
    return whole


def _refuse(project: "Project") -> None:
    """Print what is wrong with the text; leave when it has errors."""
    from robolang.core.diagnostics import render

    say_warnings(project.cell.warnings)
    for item in project.diagnostics:
        show_finding(render(item, project.source))
    if not project.ok:
        raise SystemExit(DIAGNOSTICS)


def _plain(found: "Export", out: Path) -> dict[str, Any]:
    from robolang.pulse_tables.export import MANIFEST, summary

    # from the manifest: what is printed is what was written
    sequence = json.loads(found.files[MANIFEST])["sequence"]
    head = ("line", "number", "text")
    moves = [{key: entry[key] for key in head} for entry in sequence if entry["kind"] == "move"]
    return {
        "machine": found.machine.name,
        "step_s": found.request.step_s,
        "folder": str(out),
        "moves": [{**entry, **summary(move, found)} for entry, move in zip(moves, found.moves, strict=True)],
        "markers": [
            {key: value for key, value in entry.items() if key != "kind"}
            for entry in sequence
            if entry["kind"] == "marker"
        ],
    }


_LEGEND = (
    "raised: steps raised to the lowest frequency; tables: tables for the PLC to\n"
    "start; debt: most pulses by which a channel is ahead or late after a step"
)


def _print(found: "Export", out: Path) -> None:
    from robolang.cli.console import Console
    from robolang.core.diagnostics import safe

    plain, console = _plain(found, out), Console()
    moves, markers = plain["moves"], plain["markers"]
    title = f"{found.machine.name}: pulse tables in steps of {found.request.step_s * 1e3:g} ms"
    console.print(safe(title), soft_wrap=True)
    console.print(_moves_table(found, moves, markers))
    by_channel = _table("channel", "one pulse", "lowest\nHz", "highest\nHz", "raised\nsteps", "tables", "debt\npulses")
    for k, channel in enumerate(found.channels):
        by_channel.add_row(*_channel_row(channel, [entry["channels"][k] for entry in moves]))
    console.print(by_channel)
    console.print(_LEGEND, style="italic", soft_wrap=True)
    for note in _notes(moves):
        console.print(safe(note), soft_wrap=True)
    seconds = sum(entry["seconds"] for entry in moves)
    worst = max((entry["error_mm"] for entry in moves), key=badness, default=0.0)
    total = f"{len(found.files)} files in {out}: {len(moves)} moves of {seconds:.2f} s, {len(markers)} "
    total += f"markers between them; largest path error {worst:.4f} mm"
    console.print(safe(total), soft_wrap=True)


def _table(*headings: str, statement_width: int | None = None) -> "Table":
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for heading in headings:
        table.add_column(
            heading,
            justify="left" if heading in ("statement", "channel") else "right",
            no_wrap=True,
            overflow="ellipsis",
            max_width=statement_width if heading == "statement" else None,
        )
    return table


def _moves_table(found: "Export", moves: list[dict[str, Any]], markers: list[dict[str, Any]]) -> "Table":
    """Return the table of moves and markers in the order of the program, at most 80 columns wide."""
    from robolang.core.diagnostics import safe
    from robolang.pulse_tables.export import ExportedMove

    where = lines.headings([*moves, *markers])
    headings = ("statement", "steps", "time\ns", "speed\nmm/s", "raised\nsteps", "tables", "error\nmm")
    # what the other columns leave of 80
    table = _table(*where, *headings, statement_width=26 if len(where) == 1 else 21)
    move_rows = ((*lines.cells(entry, where), *_move_row(entry)) for entry in moves)
    marker_rows = ((*lines.cells(entry, where), safe(entry["text"])) for entry in markers)
    for item in found.sequence:  # two lists that keep their order, merged as the program has them
        table.add_row(*next(move_rows if isinstance(item, ExportedMove) else marker_rows))
    return table


def _move_row(entry: dict[str, Any]) -> tuple[str, ...]:
    from robolang.core.diagnostics import safe

    channels = entry["channels"]
    return (
        safe(entry["text"]),
        str(entry["steps"]),
        f"{entry['seconds']:.2f}",
        f"{entry['speed_mm_s']:.1f}",
        str(sum(channel["raised"] for channel in channels)),
        str(sum(channel["tables"] for channel in channels)),
        f"{entry['error_mm']:.4f}",
    )


def _channel_row(channel: "Channel", moves: list[dict[str, Any]]) -> tuple[str, ...]:
    unit, scale = channel.unit
    return (
        channel.joint.name,
        f"{channel.pulse / scale:.6g} {unit}",
        f"{channel.min_hz:g}",
        str(max((move["highest_hz"] for move in moves), default=0)),
        str(sum(move["raised"] for move in moves)),
        str(sum(move["tables"] for move in moves)),
        str(max((move["debt_pulses"] for move in moves), default=0)),
    )


def _notes(moves: list[dict[str, Any]]) -> list[str]:
    """Return what a move says of itself, and which channels are too slow to keep running."""
    notes = []
    for entry in moves:
        held = [channel["name"] for channel in entry["channels"] if channel["rule"] == "hold"]
        waits = [f"{', '.join(held)}: stands between pulses, too slow for the lowest frequency"] if held else []
        notes += [f"{lines.name(entry)}: {note}" for note in [*entry["notes"], *waits]]
    return notes


def _plot(folder: Path, file: Path) -> None:
    """Draw what a PLC would do with the tables, from the files themselves."""
    from robolang.pulse_tables.plots import write_plot
    from runtime.pulses.folder import read_export
    from runtime.pulses.replay import replay

    # read back and not kept: a plot of what a PLC gets shows an error of the writer too
    found = read_export(folder)
    write_plot(file, found, replay(found))
