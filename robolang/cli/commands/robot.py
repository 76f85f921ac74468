"""``robolang robot``: the robots, their data and where the data come from; arms from URDF and MJCF files."""

import math
import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

import typer

from robolang.cli.command import PlainCommand, command
from robolang.cli.errors import reported, say, say_notes, say_warnings
from robolang.cli.options import ROBOT, Argument, Group, Option
from robolang.cli.output import echo
from robolang.core.diagnostics import safe
from runtime.core.faults import Fault

if TYPE_CHECKING:
    from rich.table import Table

    from runtime.robot.files.imported import ImportedArm
    from runtime.robot.model.spec import Body, Correction, RobotSpec

app = typer.Typer(no_args_is_help=True, help="List and show robots, import robot models.")


@app.command("list", cls=PlainCommand)
@command
def list_robots() -> None:
    """List the built-in robots.

    Example: robolang robot list

    Exit codes: 0 done.
    """
    from runtime.robot.files.loader import load_builtin
    from runtime.robot.files.robot_file import library

    with reported():
        names = library()
        for name in names:
            spec = load_builtin(name)
            echo(f"{name.ljust(max(map(len, names)))}  {spec.title}, {spec.n} axes, {spec.rated_payload:g} kg")


_Robot = Annotated[str, Argument("ROBOT", ROBOT)]
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
def show(robot: _Robot) -> None:
    """Show a robot: limits, drives, gear springs, bodies, corrections of published data, sources.

    Example: robolang robot show puma560

    Exit codes: 0 done; 2 the robot cannot be used, or has a body that cannot exist.
    """
    worst = 0
    with reported():
        from robolang.project.project import load_any_robot
        from runtime.robot.files.arm_file import is_model
        from runtime.robot.files.sidecar_file import sidecar_path

        # lexists: of a link that leads nowhere load_any_robot says so, where exists() would show a robot without drives
        if is_model(robot) and not os.path.lexists(sidecar_path(Path(robot))):
            worst = _show_model(robot)
        else:
            _show_robot(load_any_robot(robot))
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
        from runtime.robot.files.estimate import estimate
        from runtime.robot.files.importer import read_model
        from runtime.robot.files.known import known_of
        from runtime.robot.files.sidecar import template
        from runtime.robot.files.sidecar_file import NO_OVERLAY, sidecar_path

        target = options.output if options.output is not None else sidecar_path(file)
        arm = read_model(file, replace(NO_OVERLAY, flange=options.flange))
        say_warnings(arm.warnings)
        say_notes(arm.notes)
        estimates = estimate(known_of(arm)) if options.estimate else {}
        text = template(arm, estimates).encode()
        if not options.force and os.path.lexists(target):
            raise Fault("RBL706", f"{target} exists already", "Give another name with -o, or --force to replace it.")
        write_atomic(target, lambda stream: stream.write(text))
        if options.estimate:
            echo(safe(f"wrote {target}: {len(estimates)} values are estimates, each with its rule"))
        else:
            gaps = text.count(b"MISSING:")
            echo(safe(f"wrote {target}: {gaps} values to fill in, marked MISSING"))


def _show_robot(spec: "RobotSpec") -> None:
    """Print what is known of a robot that can be run."""
    from robolang.cli.console import Console

    say_warnings(spec.warnings)
    console = Console()
    console.print(safe(f"{spec.name}: {spec.title}, {spec.n} axes, rated payload {spec.rated_payload:g} kg"), "\n")
    for table in (_limits(spec), _wrist(spec), _drives(spec), *_springs(spec), _loops(spec), _bodies(spec)):
        console.print(table)
    for title, lines in (
        ("Corrections of published data", _corrections(spec)),
        ("Sources", list(spec.sources)),
        ("Notes", list(spec.notes)),
    ):
        if lines:
            console.print(title, style="bold")
            console.print(_bullets(lines))


def _show_model(robot: str) -> int:
    """Print what a model file without a sidecar says, and return the exit code of its bodies; it has no drives.

    A body that cannot exist is an error here as for every other command, and the tables show its figures.
    """
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
    for table in (_model_limits(arm), _model_bodies(arm)):
        console.print(table)
    console.print(_bullets(lines))
    return max(map(say, faults), default=0)


def _model_limits(arm: "ImportedArm") -> "Table":
    from runtime.core.units import DEG

    def shown(value: float | None, unit: float = 1.0) -> str:
        return "-" if value is None else f"{value / unit:g}"

    table = _table("Limits in the file", "range\ndeg", "speed\ndeg/s", "torque\nN m", "armature\nkg m2")
    for index, axis in enumerate(arm.axes, start=1):
        hinge = axis.hinge
        reach = f"{shown(hinge.lower, DEG)} .. {shown(hinge.upper, DEG)}"
        table.add_row(
            safe(f"J{index} {axis.name}"), reach, shown(hinge.speed, DEG), shown(hinge.effort), f"{hinge.armature:g}"
        )
    return table


def _model_bodies(arm: "ImportedArm") -> "Table":
    table = _table(
        "Bodies in their axis frames (inertia xx yy zz about the centre)", "mass\nkg", "cog\nmm", "inertia\nkg m2"
    )
    for index, axis in enumerate(arm.axes, start=1):
        cog = " ".join(f"{round(1000 * x, 3) + 0.0:g}" for x in axis.body.cog)
        table.add_row(f"J{index}", f"{axis.body.mass:g}", cog, _moments(axis.body))
    return table


def _bullets(lines: list[str]) -> "Table":
    from rich.table import Table

    grid = Table.grid(padding=(0, 1, 0, 0))
    for line in lines:
        grid.add_row("  -", safe(line))
    return grid


def _table(title: str, *headings: str) -> "Table":
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, title=title, title_justify="left", padding=(0, 1, 0, 0))
    table.add_column("axis", overflow="fold")
    for heading in headings:
        table.add_column(heading, justify="right", overflow="fold")  # fold: a number is never cut
    return table


def _limits(spec: "RobotSpec") -> "Table":
    from runtime.core.units import DEG

    table = _table("Limits", "range\ndeg", "speed\ndeg/s", "accel\ndeg/s2", "torque\nN m")
    for index, axis in enumerate(spec.axes, start=1):
        limits = axis.limits
        table.add_row(
            safe(f"J{index} {axis.name}"),
            f"{limits.lower / DEG:g} .. {limits.upper / DEG:g}",
            f"{limits.speed / DEG:g}",
            f"{limits.acceleration / DEG:g}",
            f"{limits.torque:g}",
        )
    return table


def _wrist(spec: "RobotSpec") -> "Table":
    from runtime.robot.kinematics.wrist_load import WRIST_AXES, rated_inertia, rated_moment

    table = _table("Payload at the wrist (~: estimated from the drive)", "moment\nN m", "inertia\nkg m2")
    # numbered before the cut: on seven axes the wrist begins at J5
    for index, axis in list(enumerate(spec.axes, start=1))[-WRIST_AXES:]:
        moment, inertia = axis.limits.rated_moment, axis.limits.rated_inertia
        table.add_row(
            safe(f"J{index} {axis.name}"),
            f"{'~' if moment is None else ''}{rated_moment(axis):.3g}",
            f"{'~' if inertia is None else ''}{rated_inertia(axis):.3g}",
        )
    return table


def _drives(spec: "RobotSpec") -> "Table":
    table = _table(
        "Drives (motor side; N^2 J at the joint)",
        "gear\nN",
        "rotor J\nkg m2",
        "N^2 J\nkg m2",
        "Kt\nN m/A",
        "limit\nA",
        "Coulomb +/-\nN m",
        "viscous\nN m s",
    )
    for index, axis in enumerate(spec.axes, start=1):
        motor = axis.motor
        table.add_row(
            f"J{index}",
            f"{motor.gear_ratio:g}",
            f"{motor.rotor_inertia:g}",
            f"{motor.reflected_inertia:.4f}",
            f"{motor.torque_constant:g}",
            f"{motor.max_current:g}",
            "{:g}/{:g}".format(*motor.coulomb_friction),
            f"{motor.viscous_friction:g}",
        )
    return table


def _springs(spec: "RobotSpec") -> "list[Table]":
    """Return one table of the gear springs, or none when every gear is rigid."""
    if not any(axis.motor.elastic for axis in spec.axes):
        return []
    table = _table(
        "Gear springs (at the joint)", "stiffness\nN m/rad", "damping\nN m s/rad", "wind-up at\ntorque limit\ndeg"
    )
    for index, axis in enumerate(spec.axes, start=1):
        motor = axis.motor
        windup = math.degrees(axis.limits.torque / motor.stiffness)
        values = (f"{motor.stiffness:g}", f"{motor.damping:g}", f"{windup:.3f}") if motor.elastic else ("rigid", "", "")
        table.add_row(f"J{index}", *values)
    return [table]


def _loops(spec: "RobotSpec") -> "Table":
    table = _table("Servo loops", "position Kp\n1/s", "velocity Kv\n1/s", "current loop\nHz", "encoder\ncounts/turn")
    for index, axis in enumerate(spec.axes, start=1):
        table.add_row(
            f"J{index}",
            f"{axis.bandwidths.position:g}",
            f"{axis.bandwidths.velocity:g}",
            f"{axis.motor.current_bandwidth / (2.0 * math.pi):g}",  # rad/s here, Hz in robot files
            f"{axis.motor.encoder_counts}",
        )
    return table


def _bodies(spec: "RobotSpec") -> "Table":
    table = _table(
        "Bodies in their axis frames (inertia xx yy zz about the centre)",
        "mass\nkg",
        "cog\nmm",
        "inertia published\nkg m2",
        "inertia used\nkg m2",
    )
    for index, (axis, published) in enumerate(zip(spec.axes, spec.published, strict=True), start=1):
        used, printed = _moments(axis.body), _moments(published)
        cog = " ".join(f"{round(1000 * x, 3) + 0.0:g}" for x in axis.body.cog)
        table.add_row(
            f"J{index}", f"{axis.body.mass:g}", cog, printed, used if used != printed else "the same"
        )  # of a column of numbers the few that differ would not be seen
    return table


def _moments(body: "Body") -> str:
    import numpy as np

    return " ".join(f"{x:.6g}" for x in np.diag(body.inertia))


def _corrections(spec: "RobotSpec") -> list[str]:
    return [f"J{item.axis + 1}: {'; '.join(_changes(item))}. {item.reason}" for item in spec.corrections]


def _changes(correction: "Correction") -> list[str]:
    axis, changes = correction.axis + 1, []
    if correction.inertia_shift:
        giver = f"link {axis - 1}" if axis > 1 else "the base"
        changes.append(f"{correction.inertia_shift:g} kg m2 across the joint, from {giver} to link {axis}")
    if correction.added_mass:
        changes.append(f"{correction.added_mass:g} kg added on the axis")
    if correction.added_inertia:
        changes.append(f"{correction.added_inertia:g} kg m2 added about every axis")
    return changes
