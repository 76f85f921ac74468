"""``robolang log``: what the log of a run holds, and its signals in the formats of other programs.

``show --json`` prints one object: {"program", "robot", "ok", "duration_s", "tick_s", "cycle_s", "ticks", "signals":
[{"name", "rows", "columns": [...], "unit"}], "events": [{"time_s", "kind", "name", "value"}]}; program to cycle_s are
null for a log of an older version.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import IO, TYPE_CHECKING, Annotated, Any, ClassVar

import typer

from robolang.cli.command import PlainCommand, command
from robolang.cli.errors import reported
from robolang.cli.options import Group, JsonOptions, Option, Run
from robolang.cli.output import echo
from robolang.cli.outputs import check_outputs, output_beside
from robolang.cli.usage import OptionValueError
from robolang.core.diagnostics import safe

if TYPE_CHECKING:
    from robolang.logs.log import Log
    from robolang.logs.table import Table

app = typer.Typer(no_args_is_help=True, add_completion=False, help="Show what the log of a run holds, and export it.")
_MOST_EVENTS = 40
"""Events that ``show`` prints; ``--json`` has all."""


@app.command(cls=PlainCommand)
@command
def show(run: Run, output: JsonOptions) -> None:
    """Show what a log holds: program, robot, duration, signals with their units, events.

    Example: robolang log show run.npz

    Exit codes: 0 done; 2 the log cannot be used.
    """
    with reported():
        from robolang.logs.files import read_log

        found = _contents(read_log(run))
        if output.as_json:
            echo(json.dumps(found))
        else:
            _print(str(run), found)


class _ExportOptions(Group):
    """What is exported, in which format, and where to."""

    PANEL: ClassVar[str] = "Output"
    csv: Annotated[bool, Option("--csv", help="Write .csv: names and units in the first row.")] = False
    parquet: Annotated[bool, Option("--parquet", help="Write .parquet; needs the library pyarrow.")] = False
    out: Annotated[
        Path | None,
        Option("--out", "-o", metavar="FILE", help="File to write, .csv or .parquet; default: RUN.csv beside RUN."),
    ] = None
    signals: Annotated[
        str | None,
        Option("--signals", metavar="S1,S2,...", help="Signals, such as q_fb,tau_sat:2,tool_cmd:z; default: all."),
    ] = None


@app.command(cls=PlainCommand)
@command
def export(run: Run, output: _ExportOptions) -> None:
    """Write signals of a log as a table with a row for each tick, for spreadsheets and data frames.

    Poses of parts and fingers, of which a log has fewer rows, are repeated beside signals of ticks. Units are SI.

    Example: robolang log export run.npz --csv --signals q_fb,tool_error

    Exit codes: 0 done; 2 the log, a signal or an option cannot be used; 4 the file cannot be written.
    """
    suffix = _suffix(output)
    path = output.out or output_beside(run, suffix)
    with reported():
        from robolang.core.storage import write_atomic
        from robolang.logs.files import read_log
        from robolang.logs.table import table_of

        # before the log is read, which takes the time
        check_outputs({"--out": path}, [run])
        write = _writer(suffix)
        table = table_of(read_log(run), output.signals.split(",") if output.signals else ())
        write_atomic(path, lambda stream: write(stream, table))
        echo(f"{path} written: {table.rows} rows, {len(table.columns)} columns")


def _suffix(output: _ExportOptions) -> str:
    """Return the suffix of the format that is ordered, by an option or by the name of the file."""
    formats = {".csv": output.csv, ".parquet": output.parquet}
    ordered = {suffix for suffix, given in formats.items() if given}
    if output.out is not None:
        ordered.add(output.out.suffix)
    # also where the option and the name differ: a table under the name of another format is found by nobody
    if len(ordered) != 1 or not ordered <= formats.keys():
        raise OptionValueError("--csv, --parquet", "give one format, and a file name that ends in it: .csv or .parquet")
    return ordered.pop()


def _writer(suffix: str) -> "Callable[[IO[bytes], Table], None]":
    from robolang.logs.export import check_parquet, write_csv, write_parquet

    if suffix == ".csv":
        return write_csv
    check_parquet()
    return write_parquet


def _contents(log: "Log") -> dict[str, Any]:
    from robolang.logs.quantities import columns

    signals = []
    for name in log:
        found = columns(log, name)
        units = list(dict.fromkeys(column.unit for column in found if column.unit not in ("", "-")))
        signals.append(
            {
                "name": name,
                "rows": log.count(name),
                "columns": [column.label for column in found if column.label],
                "unit": ", ".join(units) or "-",
            }
        )
    ticks = log.count("t")
    # of a log of layout 1 nothing is known but its signals
    head: dict[str, Any] = dict.fromkeys(("program", "robot", "ok", "duration_s", "tick_s", "cycle_s"))
    if log.meta is not None:
        meta = log.meta
        head = {
            "program": meta["program"].get("name"),
            "robot": meta["robot"].get("name"),
            "ok": meta["report"].get("ok"),
            "duration_s": round(ticks * meta["tick_s"], 9),
            "tick_s": meta["tick_s"],
            "cycle_s": meta["cycle_s"],
        }
    return {**head, "ticks": ticks, "signals": signals, "events": list(filter(_is_event, log.events))}


def _is_event(event: Any) -> bool:
    """Return whether an event of a file, which is not trusted, can be shown."""
    kinds = {"time_s": int | float, "kind": str, "name": str, "value": int | float}
    return isinstance(event, dict) and all(isinstance(event.get(key), kind) for key, kind in kinds.items())


def _print(name: str, found: dict[str, Any]) -> None:
    from rich import box
    from rich.table import Table as Shown

    from robolang.cli.console import Console

    console = Console()
    for line in _head(name, found):
        console.print(safe(line), soft_wrap=True)
    table = Shown("signal", box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for heading in ("rows", "columns", "unit"):
        table.add_column(heading, justify="right" if heading == "rows" else "left")
    for signal in found["signals"]:
        table.add_row(signal["name"], str(signal["rows"]), safe(_listed(signal["columns"])), signal["unit"])
    console.print(table)
    events = found["events"]
    for event in events[:_MOST_EVENTS]:
        name = " ".join(dict.fromkeys((event["kind"], event["name"])))  # a robot has one hand, called hand
        console.print(safe(f"{event['time_s']:9.3f} s  {name} = {event['value']:g}"))
    if len(events) > _MOST_EVENTS:
        console.print(f"and {len(events) - _MOST_EVENTS} more events, in --json")


def _head(name: str, found: dict[str, Any]) -> list[str]:
    if found["program"] is None:
        return [f"{name}: {found['ticks']} ticks; of an older version, without program and robot"]
    end = "ran to its end" if found["ok"] else "ended with an alarm"
    tick, cycle = 1e3 * found["tick_s"], 1e3 * found["cycle_s"]
    return [
        f"{found['program']} on {found['robot']}: {end}",
        f"{found['duration_s']:.3f} s: {found['ticks']} ticks of {tick:g} ms, cycles of {cycle:g} ms",
    ]


def _listed(labels: list[str]) -> str:
    """Return labels in a few words: the numbers of axes as a range."""
    if labels and labels == [str(k + 1) for k in range(len(labels))]:
        return f"1 to {labels[-1]}"
    return " ".join(labels)
