"""``robolang robot``: the robots, their data and where the data come from; arms from URDF and MJCF files."""

import json
import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

import typer

from robolang.cli.command import PlainCommand, command
from robolang.cli.errors import reported, say, say_notes, say_warnings
from robolang.cli.options import ROBOT, Argument, Group, JsonOptions, Option, robots
from robolang.cli.output import echo
from robolang.core.diagnostics import safe
from runtime.core.faults import Fault

if TYPE_CHECKING:
    from runtime.robot.model.spec import RobotSpec

app = typer.Typer(no_args_is_help=True, add_completion=False, help="List and show robots, import robot models.")


@app.command("list", cls=PlainCommand)
@command
def list_robots(output: JsonOptions) -> None:
    """List the built-in robots: axes, reach, payload, and what is estimated.

    Example: robolang robot list

    Exit codes: 0 done.
    """
    from runtime.robot.files.loader import load_builtin
    from runtime.robot.files.robot_file import library

    with reported():
        from robolang.cli.robot_data import summary

        rows = [summary(load_builtin(name)) for name in library()]
        if output.as_json:
            echo(json.dumps(rows, indent=2))
            return
        from robolang.cli.console import Console
        from robolang.cli.robot_tables import robots

        Console().print(robots(rows))


_Robot = Annotated[str, Argument("ROBOT", ROBOT, robots)]
_Model = Annotated[Path, Argument("FILE", "URDF or MJCF file (.urdf, .xml).")]


class _SidecarOptions(Group):
    """What is written, and where."""

    PANEL: ClassVar[str] = "Sidecar"
    output: Annotated[
        Path | None,
        Option("--output", "-o", metavar="FILE", help="File to write; default: NAME.robot.toml beside FILE."),
    ] = None
    flange: Annotated[
        str | None, Option("--flange", metavar="NAME", help="Frame that carries the tool; default: the last one.")
    ] = None
    force: Annotated[bool, Option("--force", help="Replace an existing file.")] = False
    estimate: Annotated[
        bool, Option("--estimate", help="Estimate what is missing from mass, reach and torque, each value marked.")
    ] = False


@app.command(cls=PlainCommand)
@command
def show(robot: _Robot, output: JsonOptions) -> None:
    """Show a robot: limits, drives, gear springs, bodies, corrections, sources, and what is estimated (~).

    Example: robolang robot show puma560

    Exit codes: 0 done; 2 the robot cannot be used, or has a body that cannot exist.
    """
    worst = 0
    with reported():
        from runtime.robot.files.arm_file import is_model
        from runtime.robot.files.sidecar_file import sidecar_path

        if output.as_json:
            _show_json(robot)
            return
        # lexists: of a link that leads nowhere ``_loaded`` says so, where exists() would show a robot without drives
        if is_model(robot) and not os.path.lexists(sidecar_path(Path(robot))):
            worst = _show_model(robot)
        else:
            _show_robot(_loaded(robot))
    if worst:
        raise SystemExit(worst)


@app.command("import", cls=PlainCommand)
@command
def import_model(file: _Model, options: _SidecarOptions) -> None:
    """Write a sidecar for a URDF or MJCF file: a robot file for the missing data, each marked MISSING or estimated.

    Example: robolang robot import arm.urdf -o arm.robot.toml

    Exit codes: 0 done; 2 the model cannot be used; 4 the sidecar exists or cannot be written.
    """
    with reported():
        from robolang.core.storage import write_atomic
        from runtime.core.tomlfile import Source, read_source
        from runtime.robot.files.estimate import estimate
        from runtime.robot.files.importer import read_model, with_sidecar
        from runtime.robot.files.known import known_of
        from runtime.robot.files.sidecar import template
        from runtime.robot.files.sidecar_file import NO_OVERLAY, read_sidecar, sidecar_path

        # read first: what is no file has no name for a sidecar
        arm = read_model(file, replace(NO_OVERLAY, flange=options.flange))
        target = options.output if options.output is not None else sidecar_path(file)
        # placeholders are what --estimate replaces; its note would name the command that runs
        say_warnings(each for each in arm.warnings if not (options.estimate and each.code == "RBL642"))
        say_notes(arm.notes)
        estimates = estimate(known_of(arm)) if options.estimate else {}
        text = template(arm, estimates).encode()
        if not options.force and os.path.lexists(target):
            raise Fault("RBL706", f"{target} exists already", "Give another name with -o, or --force to replace it.")
        write_atomic(target, lambda stream: stream.write(text))
        if options.estimate:
            spec = with_sidecar(read_source(file), read_sidecar(Source(str(target), text.decode()), file.name))
            echo(safe(f"wrote {target}: {len(spec.estimated)} values are estimates, each with its rule"))
            _say_weights(spec)
        else:
            gaps = text.count(b"MISSING:")
            echo(safe(f"wrote {target}: {gaps} values to fill in, marked MISSING"))


def _loaded(robot: str) -> "RobotSpec":
    """Return a robot, of a model file without drives too: what it lacks is estimated."""
    from robolang.project.project import load_any_robot
    from runtime.robot.files.arm_file import is_model
    from runtime.robot.files.importer import load_file

    return load_file(Path(robot)) if is_model(robot) else load_any_robot(robot)


def _show_json(robot: str) -> None:
    """Print a robot as JSON; of a model without a sidecar as the ideal arm that it is, with everything estimated."""
    from robolang.cli.robot_data import whole

    spec = _loaded(robot)
    say_warnings(spec.warnings)
    echo(json.dumps(whole(spec), indent=2))


_MOST = 3
"""Estimates that the summary of an import names."""


def _say_weights(spec: "RobotSpec") -> None:
    """Print which estimates matter most; nothing for an arm that cannot make the move by which they are compared."""
    from robolang.cli.console import Console
    from robolang.experiments.estimate_weights import weights

    with Console(stderr=True).status("comparing the estimates"):
        found = weights(spec)[:_MOST]
    if found:
        echo("what matters most, by runs with each estimate halved and doubled:")
    for weight in found:
        change = "halved" if weight.scale < 1.0 else "doubled"
        echo(f"  {weight.key} {change}: {weight.text}")


def _show_robot(spec: "RobotSpec") -> None:
    """Print what is known of a robot that can be run."""
    from robolang.cli import robot_tables as tables
    from robolang.cli.console import Console
    from runtime.robot.model.estimated import mark

    say_warnings(spec.warnings)
    console = Console()
    payload = f"{mark(spec.estimated, 'rated_payload_kg')}{spec.rated_payload:g} kg"
    console.print(safe(f"{spec.name}: {spec.title}, {spec.n} axes, rated payload {payload}"), "\n")
    ordered = (tables.limits, tables.wrist, tables.drives, tables.loops, tables.bodies)
    for table in [*(each(spec) for each in ordered[:3]), *tables.springs(spec), *(each(spec) for each in ordered[3:])]:
        console.print(table)
    for title, lines in (
        ("No drives: an ideal arm", [] if spec.undriven is None else [spec.undriven.message]),
        ("Estimates (~)", tables.estimates(spec)),
        ("Corrections of published data", tables.corrections(spec)),
        ("Sources", list(spec.sources)),
        ("Notes", list(spec.notes)),
    ):
        if lines:
            console.print(title, style="bold")
            console.print(tables.bullets(lines))


def _show_model(robot: str) -> int:
    """Print what a model file without a sidecar says, and return the exit code of its bodies; it has no drives.

    A body that cannot exist is an error here as for every other command, and the tables show its figures.
    """
    from robolang.cli import robot_tables as tables
    from robolang.cli.console import Console
    from runtime.robot.files.importer import read_model
    from runtime.robot.files.sidecar_file import sidecar_path
    from runtime.robot.kinematics.kinematics import Kinematics

    path = Path(robot)
    arm = read_model(path)
    say_warnings(arm.warnings)
    faults = [axis.impossible for axis in arm.axes if axis.impossible is not None]
    form = "closed form" if Kinematics(arm).closed_form else "Newton's method"
    lines = [
        f"Inverse kinematics: {form}.",
        f"Drives: none. 'robolang robot import' writes {sidecar_path(path).name}, to be filled in.",
        *(f"{fault.code} {fault.message}" for fault in faults),
    ]
    console = Console()
    console.print(safe(f"{arm.title}, {arm.n} axes; the flange is {arm.flange!r}"), "\n")
    for table in (tables.model_limits(arm), tables.model_bodies(arm)):
        console.print(table)
    console.print(tables.bullets(lines))
    return max(map(say, faults), default=0)
