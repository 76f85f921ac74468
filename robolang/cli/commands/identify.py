"""``robolang identify``: motor-side inertia by accelerating and braking, weight, and the compensation file of them.

The argument is a robot, or a program: then its cell's robot under its cell's controller, the hand on the flange. With
``--payload`` what the arm carries is identified in place of the arm: ``robolang weigh``.
Progress goes to stderr, the table to stdout. The output file is tried before the arm moves and written whole.
"""

import datetime
import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from robolang.cli import values
from robolang.cli.commands.weigh import weigh
from robolang.cli.errors import reported, say_warnings
from robolang.cli.values import OptionValueError

if TYPE_CHECKING:
    from rich.table import Table

    from robolang.experiments.excitation import PlantName, Request
    from robolang.experiments.identify import Progress
    from runtime.robot.model.payload import Payload
    from runtime.robot.model.spec import RobotSpec
    from runtime.settings.profile import Profile

ENDING = ".compensation.toml"
POSITIONS = 5


def identify(
    subject: Annotated[
        str, typer.Argument(metavar="PROG_OR_ROBOT", help="Program, for its cell; built-in robot or robot file.")
    ],
    axis: Annotated[str, typer.Option("--axis", metavar="all|1,2,...", help="Axes to identify, from 1.")] = "all",
    positions: Annotated[int, typer.Option("--positions", min=1, max=50, help="Places of each axis.")] = POSITIONS,
    plant: Annotated[str, typer.Option("--plant", help="'mujoco' or 'rigid' ideal arm with friction.")] = "mujoco",
    error: Annotated[
        int | None, typer.Option("--error", metavar="SEED", min=0, help="Real bodies 5 to 20 % heavier than the model.")
    ] = None,
    carrying: Annotated[
        str | None,
        typer.Option("--carrying", metavar="M,X,Y,Z", help="Carried and declared: kg, mm; default: the cell's hand."),
    ] = None,
    payload: Annotated[
        bool, typer.Option("--payload", help="Identify what is carried, as 'robolang weigh' does.")
    ] = False,
    table: Annotated[
        int | None, typer.Option("--table", metavar="K", min=2, max=7, help="Table over J2 and J3, K angles each.")
    ] = None,
    out: Annotated[Path | None, typer.Option("--out", metavar=f"FILE{ENDING}", help="Write the compensation.")] = None,
    date: Annotated[str, typer.Option("--date", metavar="YYYY-MM-DD", help="Date that the file states.")] = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Identify inertia at the motor and weight of each axis, and what the model lacks of them."""
    if payload:
        given = {
            "--axis": axis != "all",
            "--positions": positions != POSITIONS,
            "--error": error is not None,
            "--carrying": carrying is not None,
            "--table": table is not None,
            "--out": out is not None,
            "--date": date != "",
        }
        for option in (name for name, there in given.items() if there):
            raise OptionValueError(option, "it has no place beside --payload")
        program = _is_program(subject)
        weigh(subject if program else None, None, None if program else subject, None, plant, None, as_json)
        return
    if plant not in ("rigid", "mujoco"):
        raise OptionValueError("--plant", f"'{plant}' is not one of rigid, mujoco")
    if out is not None and not out.name.endswith(ENDING):
        raise OptionValueError("--out", f"'{out}' must end in {ENDING}")
    day = _day(date)
    with reported():
        from robolang.core.storage import check_writable, write_atomic
        from robolang.experiments.excitation import Request
        from robolang.experiments.identify import as_json as figures
        from robolang.experiments.identify import compensation_of, with_errors
        from robolang.experiments.identify import identify as run_all
        from runtime.dynamics.compensation import as_toml

        spec, profile, hand = _subject(subject)
        say_warnings(spec.warnings)
        request = Request(
            robot=spec,
            axes=_axes(axis, spec.n),
            positions=positions,
            plant=cast("PlantName", plant),
            real=None if error is None else with_errors(spec, error),
            profile=profile,
            payload=hand if carrying is None else values.payload(carrying, "--carrying", spec, heavier=False),
            table=table or 0,
        )
        if out is not None:
            check_writable(out)
        with _progress(request) as progress:
            results = run_all(request, progress)
        if out is not None:
            text = as_toml(compensation_of(request, results, day))
            write_atomic(out, lambda stream: stream.write(text.encode("utf-8")))
        found = figures(request, results)
        if as_json:
            typer.echo(json.dumps(found))
        else:
            _print(request, found)


def _is_program(subject: str) -> bool:
    return subject.lower().endswith(".rbl")


def _subject(subject: str) -> "tuple[RobotSpec, Profile, Payload]":
    """Return robot, controller and what hangs on the flange: of a program's cell, or of a robot on its own."""
    from robolang.project.project import load_any_robot, load_cell_and_settings
    from runtime.robot.model.payload import NO_PAYLOAD, Payload
    from runtime.settings.profile import Profile

    if not _is_program(subject):
        return load_any_robot(subject), Profile(), NO_PAYLOAD
    if not Path(subject).exists():
        raise OptionValueError("PROG_OR_ROBOT", f"there is no file '{subject}'")
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
        if not (part.strip().isdecimal() and part.isascii() and 1 <= int(part[:9]) <= n):
            raise OptionValueError("--axis", f"'{part.strip()[:20]}' is not one of 1 to {n}, or all", position)
        axes.add(int(part) - 1)
    return tuple(sorted(axes))


@contextmanager
def _progress(request: "Request") -> Iterator["Progress"]:
    """Yield the progress function: a live line on a terminal, one line per position elsewhere."""

    def text(axis: int, number: int, q: float) -> str:
        return f"J{axis + 1}, position {number} of {request.places(axis)}, {q * 57.29577951308232:.1f} deg"

    if sys.stderr is not None and sys.stderr.isatty():
        from robolang.cli.console import Console

        with Console(stderr=True).status("planning") as status:
            yield lambda axis, number, q: status.update(text(axis, number, q))
    else:
        yield lambda axis, number, q: typer.echo(text(axis, number, q), err=True)


_UNIT = 1e-6
_COLUMNS = (
    ("identified", "identified_kg_m2"),
    ("links of\nthe model", "model_kg_m2"),
    ("compen-\nsation", "compensation_kg_m2"),
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
    for heading in ("accel.\nrad/s2", *(heading for heading, _ in _COLUMNS), "off the\nplant, %"):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in found["axes"]:
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
    for heading in ("friction\nN m", "at\nrad/s", "weight off\nmodel, N m", "first moment of the\nlink beyond, kg m"):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in found["axes"]:
        moment = found["first_moments_kg_m"][row["axis"] - 1]
        known = "friction_nm" in row
        table.add_row(
            f"J{row['axis']}",
            f"{row['friction_nm']:.2f}" if known else "-",
            f"{row['speed_rad_s']:.2f}",
            f"{row['weight_beyond_nm']:.3f}" if known else "-",
            ", ".join(f"{round(h, 4) + 0.0:.4f}" for h in moment),
        )
    return table
