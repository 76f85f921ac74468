"""``robolang identify``: motor-side inertia by accelerating and braking, weight, and the compensation file of them.

The argument is a robot, or a program: then its cell's robot under its cell's controller, the hand on the flange. With
``--payload`` what the arm carries is identified in place of the arm: ``robolang weigh``.
Progress goes to stderr, the table to stdout. The output file is checked before the arm moves and written whole.
"""

import datetime
import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, cast

from robolang.cli import values
from robolang.cli.commands.weigh import weigh_subject
from robolang.cli.errors import reported, say_warnings
from robolang.cli.options import Argument, JsonOptions, Option, PlantOptions
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError
from runtime.core.units import DEG

if TYPE_CHECKING:
    from rich.table import Table

    from robolang.experiments.excitation import PlantName, Request
    from robolang.experiments.identify import Progress
    from runtime.robot.model.payload import Payload
    from runtime.robot.model.spec import RobotSpec
    from runtime.settings.profile import Profile

ENDING = ".compensation.toml"


_Subject = Annotated[
    str, Argument("PROG_OR_ROBOT", "Program file (.rbl), for the robot of its cell; or a built-in robot or robot file.")
]


class _ExperimentOptions(PlantOptions):
    """What is identified, and with what on the flange."""

    PANEL: ClassVar[str] = "Experiment"
    axis: Annotated[str, Option("--axis", metavar="all|1,2,...", help="Axes to identify, from 1.")] = "all"
    positions: Annotated[
        int, Option("--positions", metavar="N", low=1, high=50, help="Number of positions of each axis.")
    ] = 5
    error: Annotated[
        int | None,
        Option(
            "--error",
            metavar="SEED",
            low=0,
            help="Make the bodies of the simulated arm 5 to 20 % heavier, at random from this seed.",
        ),
    ] = None
    carrying: Annotated[
        str | None,
        Option(
            "--carrying", metavar="M,X,Y,Z", help="Payload carried and declared: kg, mm; default: the hand of the cell."
        ),
    ] = None
    payload: Annotated[bool, Option("--payload", help="Identify the payload, as 'robolang weigh' does.")] = False
    table: Annotated[
        int | None,
        Option("--table", metavar="K", low=2, high=7, help="Identify a table over J2 and J3, K angles of each."),
    ] = None


class _OutputOptions(JsonOptions):
    """What is printed and written."""

    out: Annotated[
        Path | None, Option("--out", metavar=f"FILE{ENDING}", help="Write the compensation to this file.")
    ] = None
    date: Annotated[str, Option("--date", metavar="YYYY-MM-DD", help="Date to write into the file.")] = ""


def identify(subject: _Subject, options: _ExperimentOptions, output: _OutputOptions) -> None:
    """Move each axis and identify its inertia at the motor and its weight; compare with the model.

    Example: robolang identify puma560

    Exit codes: 0 done; 1 with --payload, no program may declare what was weighed; 2 a file or an option cannot be used;
    3 a motion was refused or ended with an alarm; 4 a file cannot be written.
    """
    if options.payload:
        _refuse_beside_payload(options, output)
        weigh_subject(subject, options.plant, JsonOptions(as_json=output.as_json))
        return
    out = output.out
    if out is not None and not out.name.endswith(ENDING):
        raise OptionValueError("--out", f"'{out}' must end in {ENDING}")
    day = _day(output.date)
    with reported():
        from robolang.core.storage import check_writable, write_atomic
        from robolang.experiments.identify import as_json as figures
        from robolang.experiments.identify import compensation_of
        from robolang.experiments.identify import identify as run_all
        from runtime.dynamics.compensation import as_toml

        request = _request(subject, options)
        if out is not None:
            check_writable(out)
        with _progress(request) as progress:
            results = run_all(request, progress)
        if out is not None:
            text = as_toml(compensation_of(request, results, day))
            write_atomic(out, lambda stream: stream.write(text.encode("utf-8")))
        found = figures(request, results)
        if output.as_json:
            echo(json.dumps(found))
        else:
            _print(request, found)


def _refuse_beside_payload(options: _ExperimentOptions, output: _OutputOptions) -> None:
    """Refuse what only the identification of the arm takes: a weighing would ignore it."""
    for group, names in ((options, ("axis", "positions", "error", "carrying", "table")), (output, ("out", "date"))):
        for name in names:
            # an option that is given its default looks like one that is not given, and does no harm
            if getattr(group, name) != group.DEFAULTS[name]:
                raise OptionValueError(f"--{name}", "cannot be used with --payload")


def _request(subject: str, options: _ExperimentOptions) -> "Request":
    """Return the experiment; ``Fault`` or ``OptionValueError`` for what cannot be used."""
    from robolang.experiments.excitation import Request
    from robolang.experiments.identify import with_errors

    spec, profile, hand = _subject(subject)
    say_warnings(spec.warnings)
    carrying = options.carrying
    return Request(
        robot=spec,
        axes=_axes(options.axis, spec.n),
        positions=options.positions,
        plant=cast("PlantName", options.plant),
        real=None if options.error is None else with_errors(spec, options.error),
        profile=profile,
        # declared as a LOAD declares it, so the rated payload bounds it; `step` carries more, and declares less
        payload=hand if carrying is None else values.payload(carrying, "--carrying", spec, heavier=False),
        table=options.table or 0,
    )


def _subject(subject: str) -> "tuple[RobotSpec, Profile, Payload]":
    """Return robot, controller and what hangs on the flange: of a program's cell, or of a robot on its own."""
    from robolang.core.source import read_program
    from robolang.project.project import load_any_robot, load_cell_and_settings
    from runtime.robot.model.payload import NO_PAYLOAD, Payload
    from runtime.settings.profile import Profile

    if not subject.lower().endswith(".rbl"):
        return load_any_robot(subject), Profile(), NO_PAYLOAD
    read_program(subject)
    cell, settings = load_cell_and_settings(Path(subject), None, None, None, {})
    return cell.robot, settings.profile, Payload(mass=cell.hand.mass, cog=cell.hand.cog)


def _day(date: str) -> str:
    try:
        return datetime.date.fromisoformat(date).isoformat() if date else ""
    except ValueError:
        raise OptionValueError("--date", f"'{date[:40]}' is not a day as in 2026-11-24") from None


def _axes(text: str, n: int) -> tuple[int, ...]:
    """Return the 0-based axes of ``all`` or a list of numbers, each once and in order."""
    if text.strip() == "all":
        return tuple(range(n))
    axes = set()
    for position, part in enumerate(text.split(","), start=1):
        # isascii: isdecimal() is true for digits of every script; [:9]: int() refuses more than 4300 of them
        if not (part.strip().isdecimal() and part.isascii() and 1 <= int(part[:9]) <= n):
            raise OptionValueError("--axis", f"'{part.strip()[:20]}' is not one of 1 to {n}, or all", position)
        axes.add(int(part) - 1)
    return tuple(sorted(axes))


@contextmanager
def _progress(request: "Request") -> Iterator["Progress"]:
    """Yield the progress function: a live line on a terminal, one line per position elsewhere."""

    def text(axis: int, number: int, q: float) -> str:
        return f"J{axis + 1}, position {number} of {request.places(axis)}, {q / DEG:.1f} deg"

    if sys.stderr is not None and sys.stderr.isatty():
        from robolang.cli.console import Console

        with Console(stderr=True).status("planning") as status:
            yield lambda axis, number, q: status.update(text(axis, number, q))
    else:
        yield lambda axis, number, q: echo(text(axis, number, q), err=True)


_UNIT = 1e-6
_COLUMNS = (
    ("identified", "identified_kg_m2"),
    ("links of\nthe model", "model_kg_m2"),
    ("compensation", "compensation_kg_m2"),
    ("spread", "spread_kg_m2"),
    ("rotor", "rotor_kg_m2"),
)


def _print(request: "Request", found: dict[str, Any]) -> None:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    from robolang.cli.console import Console
    from robolang.core.diagnostics import safe

    real = ", bodies 5 to 20 % heavier than the model" if found["model_errors"] else ""
    places = f"{request.positions} position{'' if request.positions == 1 else 's'} of each axis"
    if any("table" in row for row in found["axes"]):
        places += f", a table of {request.table} angles of each joint"
    console = Console()
    title = f"{found['robot']}: inertia at the motor in 1e-6 kg m2, {places}, {found['plant']} arm{real}"
    console.print(safe(title), soft_wrap=True)
    table = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("axis", no_wrap=True)
    for heading in ("accel.\nrad/s2", *(heading for heading, _ in _COLUMNS), "error\n%"):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in found["axes"]:
        # a real robot would have no such column: nobody knows its true inertia
        off = (row["identified_kg_m2"] / row["true_kg_m2"] - 1.0) * 100.0
        figures = (f"{row[key] / _UNIT:.3f}" for _, key in _COLUMNS)
        table.add_row(f"J{row['axis']}", f"{row['acceleration_rad_s2']:.2f}", *figures, f"{off:+.2f}")
    console.print(table)
    if "first_moments_kg_m" in found:
        console.print(_weights(found))


def _weights(found: dict[str, Any]) -> "Table":
    """Return the table of what the same passes say of friction and weight, N m at the joints."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("axis", no_wrap=True)
    for heading in (
        "friction\nN m",
        "at\nrad/s",
        "weight not in\nthe model, N m",
        "first moment not in\nthe model, kg m",
    ):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in found["axes"]:
        moment = found["first_moments_kg_m"][row["axis"] - 1]
        known = "friction_nm" in row  # weight and friction part over three positions or more (docs/identification.md)
        table.add_row(
            f"J{row['axis']}",
            f"{row['friction_nm']:.2f}" if known else "-",
            f"{row['speed_rad_s']:.2f}",
            f"{row['weight_beyond_nm']:.3f}" if known else "-",
            ", ".join(f"{round(h, 4) + 0.0:.4f}" for h in moment),
        )
    return table
