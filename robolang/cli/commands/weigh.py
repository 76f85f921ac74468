"""``robolang weigh [PROG]``: mass and centre of gravity of what the arm carries, from the torques of a short exercise.

``--json`` prints one object, in kg, mm, deg and N m:

    {"robot", "plant", "home_deg", "seconds", "amplitudes_deg", "estimated": {"mass_kg", "mass_sd_kg", "cog_mm",
     "cog_sd_mm"}, "true": {"mass_kg", "cog_mm"}, "friction_off_pct", "left_rms_nm", "left_peak_nm", "load",
     "load_note", "load_code"}

``load`` may be declared by a program; ``load_note`` is what it states otherwise than it was weighed, mostly empty.
Where no program may declare what was weighed, ``load`` is null, ``load_code`` says by which rule, exit code 1.
"""

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, cast

from robolang.cli import values
from robolang.cli.errors import reported, say_warnings
from robolang.cli.options import CellOptions, JsonOptions, Option, OptionalProgram, PlantOptions
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError
from runtime.core.rounding import beside

if TYPE_CHECKING:
    from robolang.experiments.weigh import PlantName, WeighRequest
    from runtime.cell.cell import CellSpec

MOST_AMPLITUDE = 90.0
"""Largest swing that may be given, deg; without one the exercise takes 25 deg at most (docs/weighing.md)."""


class _PayloadOptions(PlantOptions):
    """What the arm carries, and how it is swung."""

    PANEL: ClassVar[str] = "Experiment"
    payload: Annotated[
        str | None,
        Option(
            "--payload",
            metavar="M,X,Y,Z",
            help="Body carried in addition to the hand: mass, kg, and centre of gravity, mm.",
        ),
    ] = None
    amplitude: Annotated[
        float | None,
        Option(
            "--amplitude",
            metavar="DEG",
            help="Swing of the wrist axes, deg; default: the largest that fits.",
        ),
    ] = None


def weigh(program: OptionalProgram, files: CellOptions, options: _PayloadOptions, output: JsonOptions) -> None:
    """Move the arm and weigh what it carries: mass, centre of gravity, and the LOAD to write.

    Example: robolang weigh pick_and_place.rbl

    Exit codes: 0 done; 1 no program may declare what was weighed; 2 a value, a cell or a robot cannot be used; 3 the
    motion was refused or ended with an alarm.
    """
    amplitude = options.amplitude
    if amplitude is not None and not 0.0 < amplitude <= MOST_AMPLITUDE:  # NaN is refused too
        shown, most = beside(amplitude, MOST_AMPLITUDE)
        raise OptionValueError("--amplitude", f"{shown} is not above 0 and at most {most} deg")
    with reported():
        if program is not None:
            from robolang.core.source import read_program

            read_program(program)
        _weigh(program, files, options, output)


def weigh_subject(subject: str, plant: str, output: JsonOptions) -> None:
    """Weigh what the arm carries in the cell of a program, or on a robot: ``robolang identify --payload``."""
    # by the ending, as `identify` decides for everything else
    is_program = subject.lower().endswith(".rbl")
    files = CellOptions() if is_program else CellOptions(robot=subject)
    weigh(subject if is_program else None, files, _PayloadOptions(plant=plant), output)


def _weigh(program: str | None, files: CellOptions, options: _PayloadOptions, output: JsonOptions) -> None:
    from robolang.experiments.weigh import WeighRequest, carried, plan_exercise
    from robolang.experiments.weigh import as_json as figures
    from robolang.experiments.weigh import weigh as run_weigh
    from robolang.project.project import load_cell_and_settings
    from runtime.core.faults import Fault
    from runtime.core.units import DEG

    where = None if program is None else Path(program)
    cell, in_force = load_cell_and_settings(where, files.cell, files.robot, None, {})
    say_warnings(cell.robot.warnings)
    request = WeighRequest(
        cell=cell,
        added=None if options.payload is None else values.payload(options.payload, "--payload", cell.robot),
        profile=in_force.profile,
        plant=cast("PlantName", options.plant),
        amplitude=None if options.amplitude is None else options.amplitude * DEG,
    )
    _note(carried(request).mass, cell)
    # planned here as well: a refusal is printed before the promise of a motion
    _say_what_comes(request, plan_exercise(request).amplitudes)
    found = figures(request, run_weigh(request))
    if output.as_json:
        echo(json.dumps(found))
    else:
        _print(found)
    if found["load"] is None:
        raise Fault(found["load_code"], f"there is no LOAD for it: {found['load_note']}")


def _note(mass: float, cell: "CellSpec") -> None:
    rated = cell.robot.rated_payload
    if not mass <= rated:
        shown, most = beside(mass, rated)
        echo(
            f"note: hand and --payload weigh {shown} kg, over the rated {most} kg of {cell.robot.name}; no "
            "program can declare that",
            err=True,
        )


def _say_what_comes(request: "WeighRequest", amplitudes: Any) -> None:
    from robolang.experiments.weigh import SECONDS
    from runtime.core.units import DEG

    swings = ", ".join(f"J{axis + 1} {by / DEG:.3g}" for axis, by in enumerate(amplitudes) if by > 0.0)
    echo(f"weighing: {SECONDS:g} s of motion about home, swings of {swings} deg", err=True)


def _print(found: dict[str, Any]) -> None:
    from robolang.core.diagnostics import safe

    estimated, true = found["estimated"], found["true"]
    echo(safe(f"{found['robot']}, {found['plant']} arm, {found['seconds']:.1f} s"))
    echo(f"  {'':<20} {'estimated':>9}    {'+-':>6} {'true':>10}")
    _row("mass, kg", estimated["mass_kg"], estimated["mass_sd_kg"], true["mass_kg"], 3)
    if estimated["cog_mm"] is None:
        echo("  centre of gravity    unknown: the mass does not differ from nothing")
    else:
        for k, name in enumerate("xyz"):
            _row(f"cog {name}, mm", estimated["cog_mm"][k], estimated["cog_sd_mm"][k], true["cog_mm"][k], 2)
    if found["load"] is not None:
        echo(f"\n{found['load']}")
    if found["load"] is not None and found["load_note"]:
        echo(f"note: {found['load_note']}; the LOAD above is the nearest that a program may declare", err=True)


def _row(label: str, value: float, sd: float, true: float, digits: int) -> None:
    # adding zero turns a rounded -0.0 into 0.0; an uncertainty is never shown as none
    least = math.pow(10.0, -digits)
    echo(
        f"  {label:<20} {round(value, digits) + 0.0:9.{digits}f}    {max(sd, least):6.{digits}f} "
        f"{round(true, digits) + 0.0:10.{digits}f}"
    )
