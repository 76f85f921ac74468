"""``robolang compare PROG``: one program with other gains, other LOADs and a starved dynamics task, in one table."""

import json
import os
from collections.abc import Callable
from typing import Annotated, Any

import typer

from robolang.cli import servo_options as o
from robolang.cli.errors import MOTION, reader_may_leave, reported
from robolang.cli.refuse import refuse
from robolang.cli.values import OptionValueError


def compare(
    program: Annotated[str, typer.Argument(metavar="PROG", help="Program file (.rbl).")],
    cell: Annotated[str | None, typer.Option(help="Cell file (.toml); default: the one beside the program.")] = None,
    robot: Annotated[str | None, typer.Option(help="Built-in robot or robot file, in place of the cell's.")] = None,
    only: Annotated[str | None, typer.Option("--only", metavar="NAME,...", help="These variants only.")] = None,
    no_physics: Annotated[bool, typer.Option("--no-physics", help="Ideal arm instead of MuJoCo.")] = False,
    profile: o.ProfileFile = None,
    feedforward: o.Feedforward = None,
    load_mode: o.LoadMode = None,
    servo_period: o.ServoPeriod = None,
    settings: o.Set = None,
    jobs: Annotated[int | None, typer.Option("--jobs", min=1, max=64, help="Runs at a time.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Compare scheduled gains with fixed ones, right LOADs with wrong ones."""
    options = o.controller_options(
        feedforward=feedforward, load_mode=load_mode, servo_period=servo_period, settings=settings
    )
    with reported():
        from robolang.experiments.compare import VARIANTS, Request
        from robolang.experiments.compare import compare as run_all

        names = [item.name for item in VARIANTS] if only is None else only.split(",")
        unknown = sorted(set(names) - {item.name for item in VARIANTS})
        if unknown:
            known = ", ".join(item.name for item in VARIANTS)
            raise OptionValueError("--only", f"'{unknown[0]}' is not a variant; known: {known}")
        variants = tuple(item for item in VARIANTS if item.name in names)
        request = Request(
            program=program, cell=cell, robot=robot, profile=profile, options=options, physics=not no_physics
        )
        refuse(request.project(variants[0]))
        for variant in variants[1:]:
            request.project(variant)  # a bound of stability that only this variant breaks is found before the first run
        rows = run_all(request, variants, jobs or min(2, os.cpu_count() or 1), _progress(len(variants)))
        with reader_may_leave():
            if as_json:
                typer.echo(json.dumps({"program": program, "physics": not no_physics, "variants": rows}, indent=2))
            else:
                _print(program, rows)
    if not all(row["ok"] for row in rows):
        raise typer.Exit(MOTION)


def _progress(count: int) -> Callable[[str], None]:
    finished: list[str] = []

    def done(title: str) -> None:
        finished.append(title)
        typer.echo(f"{len(finished)}/{count} {title}", err=True)

    return done


_COLUMNS = (
    ("over-\nshoot\n%", "overshoot_pct", "{:.2f}"),
    ("settle\n2 %\ns", "settling_s", "{:.3f}"),
    ("joint\nmax\ndeg", "joint_error_deg", "{:.4f}"),
    ("joint\nrms\ndeg", "joint_rms_deg", "{:.4f}"),
    ("tool\nmax\nmm", "tool_error_mm", "{:.3f}"),
    ("tool\nrms\nmm", "tool_rms_mm", "{:.3f}"),
    ("off\npath\nmm", "path_deviation_mm", "{:.3f}"),
    ("droop\n\ndeg", "droop_deg", "{:.4f}"),
)


def _print(program: str, rows: list[dict[str, Any]]) -> None:
    from rich import box
    from rich.table import Table

    from robolang.cli.console import Console
    from robolang.core.diagnostics import safe

    console = Console()
    console.print(safe(program), style="italic", soft_wrap=True)
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("variant", no_wrap=False)
    for heading, _, _ in _COLUMNS:
        table.add_column(heading, justify="right", no_wrap=True)
    for row in rows:
        title = row["title"] if row["changes"] else f"{row['title']}: changes nothing"
        table.add_row(title, *("-" if row[key] is None else form.format(row[key]) for _, key, form in _COLUMNS))
    console.print(table)
    _print_axes(console, rows)
    for row in rows:
        if row["note"]:
            console.print(safe(f"{row['title']}: {row['note']}"), soft_wrap=True)
        for alarm in row["alarms"]:
            place = f"{alarm['file']}:{alarm['line']}:{alarm['column']}"
            text = f"{row['title']}: stopped at {place}, {alarm['time_s']:.3f} s: {alarm['code']} {alarm['message']}"
            console.print(safe(text), soft_wrap=True)


def _print_axes(console: Any, rows: list[dict[str, Any]]) -> None:
    from rich import box
    from rich.table import Table

    measured = [row for row in rows if row["per_axis"]]
    if not measured:
        return
    count = len(measured[0]["per_axis"]["joint_error_deg"])
    table = Table(title="Largest error of each axis, deg", box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("variant")
    for axis in range(count):
        table.add_column(f"J{axis + 1}", justify="right", no_wrap=True)
    for row in measured:
        table.add_row(row["title"], *(f"{value:.4f}" for value in row["per_axis"]["joint_error_deg"]))
    console.print(table)
