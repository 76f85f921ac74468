"""``robolang compare PROG``: one program with other gains, other LOADs and a starved dynamics task, in one table."""

import json
import os
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Annotated, Any

from robolang.cli.controller_settings import settings_of
from robolang.cli.errors import MOTION, reported
from robolang.cli.options import CellOptions, JsonOptions, Option, PhysicsOptions, Program, SettingsOptions
from robolang.cli.output import echo
from robolang.cli.refuse import refuse
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.experiments.compare import Variant


class _CompareOptions(PhysicsOptions):
    """What is compared, and how many runs there are at a time."""

    only: Annotated[
        str | None, Option("--only", metavar="NAME,...", help="Run these variants only, such as scheduled,load-wrong.")
    ] = None
    jobs: Annotated[
        int | None,
        Option("--jobs", metavar="N", low=1, high=64, help="Number of runs at a time; default: 2, on one processor 1."),
    ] = None


def compare(
    program: Program,
    files: CellOptions,
    controller: SettingsOptions,
    choice: _CompareOptions,
    output: JsonOptions,
) -> None:
    """Run a program with scheduled and fixed gains, right and wrong LOADs, and compare the errors.

    Supervision is off, so that wrong LOADs and gains run to the end: alarms of supervision, such as RBL517, end a run
    of robolang run only.

    Example: robolang compare pick_and_place.rbl

    Exit codes: 0 all ran to the end; 1 the program has errors; 2 a file or an option cannot be used; 3 a move was
    refused, or a run ended with an alarm that is not one of supervision.
    """
    settings = settings_of(controller)
    with reported():
        from robolang.experiments.compare import VARIANTS, Request
        from robolang.experiments.compare import compare as run_all

        variants = _variants(choice.only, VARIANTS)
        request = Request(
            program=program,
            cell=files.cell,
            robot=files.robot,
            profile=controller.profile,
            options=settings,
            physics=not choice.no_physics,
        )
        refuse(request.project(variants[0]))
        for variant in variants[1:]:
            request.project(variant)  # a bound of stability that only this variant breaks is found before the first run
        jobs = choice.jobs or min(2, os.cpu_count() or 1)
        rows = run_all(request, variants, jobs, _progress(len(variants)))
        if output.as_json:
            found = {"program": program, "physics": request.physics, "supervision": False, "variants": rows}
            echo(json.dumps(found, indent=2))
        else:
            _print(program, rows)
    # a variant that an alarm stopped is a row of the table, and still no success
    if not all(row["ok"] for row in rows):
        raise SystemExit(MOTION)


def _variants(only: str | None, known: "tuple[Variant, ...]") -> "tuple[Variant, ...]":
    """Return the variants that ``--only`` names, all without it, in the order of the table."""
    if only is None:
        return known
    names = only.split(",")
    unknown = sorted(set(names) - {item.name for item in known})
    if unknown:
        listed = ", ".join(item.name for item in known)
        raise OptionValueError("--only", f"'{unknown[0]}' is not a variant; known: {listed}")
    # not in the order of the option: rows of two comparisons stand in the same places
    return tuple(item for item in known if item.name in names)


def _progress(count: int) -> Callable[[str], None]:
    finished: list[str] = []

    def done(title: str) -> None:
        finished.append(title)
        echo(f"{len(finished)}/{count} {title}", err=True)

    return done


_COLUMNS = (
    ("over-\nshoot\n%", "overshoot_pct", "{:.2f}"),
    ("settle\n2 %\ns", "settling_s", "{:.3f}"),
    ("joint\nmax\ndeg", "joint_error_deg", "{:.4f}"),
    ("joint\nrms\ndeg", "joint_rms_deg", "{:.4f}"),
    ("slide\nmax\nmm", "joint_error_mm", "{:.4f}"),
    ("tool\nmax\nmm", "tool_error_mm", "{:.3f}"),
    ("tool\nrms\nmm", "tool_rms_mm", "{:.3f}"),
    ("path\nmax\nmm", "path_deviation_mm", "{:.3f}"),
    ("droop\n\ndeg", "droop_deg", "{:.4f}"),
    ("droop\n\nmm", "droop_mm", "{:.4f}"),
)
"""Those of an axis that slides are of an arm that has one; ``_LEFT_OUT`` there, since 80 columns hold no more."""
_LEFT_OUT = ("joint_rms_deg", "tool_rms_mm")


def _print(program: str, rows: list[dict[str, Any]]) -> None:
    from rich import box
    from rich.table import Table

    from robolang.cli.console import Console
    from robolang.core.diagnostics import safe

    console = Console()
    console.print(safe(program), style="italic", soft_wrap=True)
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("variant", no_wrap=False)  # a title may take two lines; a number that is cut is another number
    columns = _columns(any("joint_error_mm" in row for row in rows))
    for heading, _, _ in columns:
        table.add_column(heading, justify="right", no_wrap=True)
    for row in rows:
        # equal rows would be taken for a result: there was no LOAD to make wrong, or no spring to lead
        title = row["title"] if row["changes"] else f"{row['title']}: changes nothing"
        table.add_row(title, *("-" if row[key] is None else form.format(row[key]) for _, key, form in columns))
    console.print(table)
    _print_axes(console, rows)
    # a program that supervision stops would otherwise seem to run well
    console.print("Supervision is off in every row; robolang run may stop where these runs went on.", soft_wrap=True)
    for line in (line for row in rows for line in _remarks(row)):
        console.print(safe(line), soft_wrap=True)


def _columns(slides: bool) -> list[tuple[str, str, str]]:
    """Return the columns of the table of an arm with an axis that slides, or of another."""
    out = _LEFT_OUT if slides else ("joint_error_mm", "droop_mm")
    return [column for column in _COLUMNS if column[1] not in out]


def _remarks(row: dict[str, Any]) -> Iterator[str]:
    """Yield the note of a variant, and where it stopped."""
    if row["note"]:
        yield f"{row['title']}: {row['note']}"
    for alarm in row["alarms"]:
        place = f"{alarm['file']}:{alarm['line']}:{alarm['column']}"
        yield f"{row['title']}: stopped at {place}, {alarm['time_s']:.3f} s: {alarm['code']} {alarm['message']}"


def _print_axes(console: Any, rows: list[dict[str, Any]]) -> None:
    from rich import box
    from rich.table import Table

    measured = [row for row in rows if row["per_axis"]]  # none without a MOVE that took time
    if not measured:
        return
    first = measured[0]["per_axis"]
    # on an arm with an axis that slides each column has its unit
    key = "joint_error" if "units" in first else "joint_error_deg"
    title = f"Largest error of each axis{'' if 'units' in first else ', deg'}"
    table = Table(title=title, box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("variant")
    for axis in range(len(first[key])):
        unit = f"\n{first['units'][axis]}" if "units" in first else ""
        table.add_column(f"J{axis + 1}{unit}", justify="right", no_wrap=True)
    for row in measured:
        table.add_row(row["title"], *(f"{value:.4f}" for value in row["per_axis"][key]))
    console.print(table)
