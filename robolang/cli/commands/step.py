"""``robolang step``: the step response of one axis at a posture with a payload; figures, or a plot to keep."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from robolang.cli import servo_options as o
from robolang.cli import values
from robolang.cli.errors import MOTION, reported, say_warnings
from robolang.cli.values import OptionValueError, numbers
from runtime.core.rounding import beside

if TYPE_CHECKING:
    from robolang.experiments.step import PlantName, StepRequest, StepResult

MOST_S = 60.0
"""Longest time after the step, s."""


def step(
    robot: Annotated[str, typer.Option("--robot", help="Built-in robot, or a path to a .toml robot file.")],
    axis: Annotated[int, typer.Option("--axis", min=1, max=7, help="Axis that makes the step, from 1.")],
    size: Annotated[float, typer.Option("--size", help="Size of the step, deg; 0 to see the droop alone.")] = 0.5,
    joints: Annotated[str | None, typer.Option("--joints", metavar="J1,J2,...", help="Posture, deg.")] = None,
    payload: Annotated[str, typer.Option("--payload", metavar="M,X,Y,Z", help="Carried: kg, mm.")] = "0,0,0,0",
    load: Annotated[
        str | None, typer.Option("--load", metavar="M,X,Y,Z", help="Declared by LOAD; default: what is carried.")
    ] = None,
    tool: Annotated[str, typer.Option("--tool", metavar="X,Y,Z", help="Tool point at the flange, mm.")] = "0,0,0",
    seconds: Annotated[float, typer.Option("--seconds", min=0.2, max=MOST_S, help="Time after the step.")] = 1.5,
    plant: Annotated[str, typer.Option("--plant", help="'rigid' ideal arm or 'mujoco'.")] = "rigid",
    drives: Annotated[
        str, typer.Option("--drives", help="'real' limits, current loop and encoder, or 'ideal' ones.")
    ] = "real",
    lock: Annotated[bool, typer.Option("--lock-others", help="Hold the other axes fast (rigid arm).")] = False,
    profile: o.ProfileFile = None,
    servo: o.Servo = None,
    fixed_at: o.FixedAt = None,
    coupling: o.Coupling = None,
    feedforward: o.Feedforward = None,
    load_mode: o.LoadMode = None,
    servo_period: o.ServoPeriod = None,
    settings: o.Set = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
    plot: Annotated[Path | None, typer.Option("--plot", help="Write the response as .svg or .html.")] = None,
) -> None:
    """Measure the step response of one axis: overshoot, settling, rise, droop."""
    options = o.controller_options(
        servo=servo,
        fixed_at=fixed_at,
        coupling=coupling,
        feedforward=feedforward,
        load_mode=load_mode,
        servo_period=servo_period,
        settings=settings,
    )
    for option, value, choices in (("--plant", plant, ("rigid", "mujoco")), ("--drives", drives, ("real", "ideal"))):
        if value not in choices:
            raise OptionValueError(option, f"'{value}' is not one of {', '.join(choices)}")
    if plot is not None and plot.suffix not in (".svg", ".html"):
        raise OptionValueError("--plot", f"'{plot}' must end in .svg or .html")
    with reported():
        import numpy as np

        from robolang.experiments.step import StepRequest
        from robolang.experiments.step import as_json as figures
        from robolang.experiments.step import step as run_step
        from robolang.project.project import load_any_robot, load_settings
        from runtime.core.frames import pose
        from runtime.core.units import DEG, MM

        spec = load_any_robot(robot)
        say_warnings(spec.warnings)
        tool_point = np.array(numbers(tool, option="--tool", names=("x", "y", "z"))) * MM
        in_force = load_settings(spec, pose(tool_point, np.eye(3)), profile, options)
        if not (abs(size) <= 360.0):
            raise OptionValueError("--size", f"{beside(size, -360.0, 360.0)[0]} is not between -360 and 360 deg")
        if not seconds <= MOST_S:
            raise OptionValueError("--seconds", f"{beside(seconds, MOST_S)[0]} is not between 0.2 and {MOST_S:g} s")
        carried = values.payload(payload, "--payload", spec)
        values.note_overload(carried, "--payload", spec)
        declared = carried
        if load is not None:
            declared = values.payload(load, "--load", spec)
            values.note_overload(declared, "--load", spec)
        request = StepRequest(
            robot=spec,
            axis=axis - 1,
            q=values.posture(joints, spec),
            size=size * DEG,
            carried=carried,
            declared=declared,
            profile=in_force.profile,
            plant=cast("PlantName", plant),
            ideal=drives == "ideal",
            locked=lock,
            seconds=seconds,
            tool=tool_point,
        )
        if plot is not None:
            from robolang.core.storage import check_writable

            check_writable(plot)
        try:
            result = run_step(request)
        except ValueError as error:
            raise OptionValueError("--axis", str(error)) from None
        found = figures(request, result)
        if as_json:
            typer.echo(json.dumps(found))
        else:
            _print(found)
        if plot is not None:
            _write_plot(plot, request, result)
    if not result.stable:
        raise typer.Exit(MOTION)


_LINES = (
    ("true inertia with rotor", "inertia_kg_m2", "{:.4g} kg m2"),
    ("inertia in the gains", "gain_inertia_kg_m2", "{:.4g} kg m2"),
    ("overshoot", "overshoot_pct", "{:.2f} %"),
    ("settling to 2 %", "settling_s", "{:.4f} s"),
    ("rise 10 to 90 %", "rise_s", "{:.4f} s"),
    ("droop", "droop_deg", "{:.4f} deg"),
    ("peak torque", "peak_torque_nm", "{:.1f} N m"),
)


def _print(found: dict[str, Any]) -> None:
    from robolang.core.diagnostics import safe

    drives = "ideal drives" if found["ideal_drives"] else "real drives"
    typer.echo(
        safe(
            f"{found['robot']}: step of {found['size_deg']:g} deg on J{found['axis']}, {found['servo']} gains, "
            f"{found['plant']} arm, {drives}"
        )
    )
    for label, key, form in _LINES:
        if found[key] is not None:
            # adding zero turns a rounded -0.0 into 0.0
            typer.echo(f"  {label:<24} {form.format(round(found[key], 6) + 0.0)}")
    if not found["stable"]:
        typer.echo("  the axis does not come to rest")


def _write_plot(path: Path, request: "StepRequest", result: "StepResult") -> None:
    from robolang.core.storage import write_atomic
    from robolang.execution.plot import Curve, as_html, as_svg
    from runtime.core.units import DEG

    title = f"{request.robot.name}: step on J{request.axis + 1}, D' = {result.inertia:.3g} kg m2"
    curve = Curve(name=f"{request.profile.servo.mode} gains", x=result.t, y=result.response / DEG)
    svg = as_svg(title, "time, s", "angle, deg", [curve], level=request.size / DEG)
    text = as_html(title, svg) if path.suffix == ".html" else svg
    write_atomic(path, lambda stream: stream.write(text.encode("utf-8")))
