"""``robolang step``: the step response of one axis at a posture with a payload; figures, or a plot to keep."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, cast

from robolang.cli import values
from robolang.cli.controller_settings import Settings, settings_of
from robolang.cli.errors import MOTION, reported, say_warnings
from robolang.cli.options import ControllerOptions, Option, PlantOptions, PlotOptions, PostureOptions
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError
from robolang.cli.values import check_plot, numbers
from runtime.core.rounding import beside

if TYPE_CHECKING:
    from robolang.experiments.step import PlantName, StepRequest, StepResult
    from runtime.core.frames import Array
    from runtime.robot.model.axis_kind import AxisKind
    from runtime.robot.model.payload import Payload
    from runtime.robot.model.spec import RobotSpec

MOST_S = 60.0
"""Longest time after the step, s."""
MOST_DEG = 360.0
"""Largest step, deg: one turn; of an axis that slides as many mm."""


class _StepOptions(PostureOptions):
    """The step, and what it is made with."""

    PANEL: ClassVar[str] = "Step"
    axis: Annotated[int, Option("--axis", metavar="N", low=1, high=7, help="Axis that makes the step, from 1.")]
    size: Annotated[float, Option("--size", metavar="DEG", help="Size of the step, deg or mm; 0: only the droop.")] = (
        0.5
    )
    load: Annotated[
        str | None,
        Option("--load", metavar="M,X,Y,Z", help="Payload that LOAD declares: kg, mm; default: the carried one."),
    ] = None
    tool: Annotated[str, Option("--tool", metavar="X,Y,Z", help="Tool point in the flange frame, mm.")] = "0,0,0"
    seconds: Annotated[
        float, Option("--seconds", metavar="S", low=0.2, high=MOST_S, help="Simulated time after the step, s.")
    ] = 1.5


class _ArmOptions(PlantOptions):
    """Which arm makes the step."""

    plant: str = "rigid"  # as the published experiments, docs/servo.md
    drives: Annotated[
        str,
        Option(
            "--drives",
            help="real: with limits, current loop and encoder; ideal: without.",
            choices=("real", "ideal"),
        ),
    ] = "real"
    lock: Annotated[bool, Option("--lock-others", help="Lock the other axes; needs --plant rigid.")] = False


def step(options: _StepOptions, arm: _ArmOptions, controller: ControllerOptions, output: PlotOptions) -> None:
    """Measure the step response of one axis: overshoot, settling, rise, droop.

    Example: robolang step --robot puma560 --axis 2 --payload 2.5,0,0,100

    Exit codes: 0 done; 2 a value or a file cannot be used; 3 the axis does not come to rest, or an alarm stopped it; 4
    the plot cannot be written.
    """
    settings = settings_of(controller)
    check_plot(output.plot)
    with reported():
        from robolang.experiments.step import as_json as figures
        from robolang.experiments.step import step as run_step

        if arm.lock and arm.plant == "mujoco":
            raise OptionValueError("--lock-others", "needs --plant rigid")
        request = _request(options, arm, controller.profile, settings)
        if output.plot is not None:
            from robolang.core.storage import check_writable

            check_writable(output.plot)
        try:
            result = run_step(request)
        except ValueError as error:  # an axis that the robot has not: all else was refused above
            raise OptionValueError("--axis", str(error)) from None
        found = figures(request, result)
        if output.as_json:
            echo(json.dumps(found))
        else:
            _print(found, request.robot.axes[request.axis].kind)
        if output.plot is not None:
            _write_plot(output.plot, request, result)
    if not result.stable:
        raise SystemExit(MOTION)


def _request(options: _StepOptions, arm: _ArmOptions, profile: str | None, settings: Settings) -> "StepRequest":
    """Return the experiment; ``Fault`` or ``OptionValueError`` for what cannot be used."""
    import numpy as np

    from robolang.experiments.step import StepRequest
    from robolang.project.project import load_any_robot, load_settings
    from runtime.core.frames import pose
    from runtime.core.units import MM

    spec = load_any_robot(options.robot)
    say_warnings(spec.warnings)
    tool_point = np.array(numbers(options.tool, option="--tool", names=("x", "y", "z"))) * MM
    in_force = load_settings(spec, pose(tool_point, np.eye(3)), profile, settings)
    # an axis that the robot has not is left to the experiment
    kind = spec.axes[min(options.axis, spec.n) - 1].kind
    _check_numbers(options, kind.unit)
    q, size = values.posture(options.joints, spec), options.size * kind.size
    _check_range(q, options.axis - 1, size, spec)
    carried = _payload(options.payload, "--payload", spec)
    return StepRequest(
        robot=spec,
        axis=options.axis - 1,
        q=q,
        size=size,
        carried=carried,
        declared=carried if options.load is None else _payload(options.load, "--load", spec),
        profile=in_force.profile,
        plant=cast("PlantName", arm.plant),
        ideal=arm.drives == "ideal",
        locked=arm.lock,
        seconds=options.seconds,
        tool=tool_point,
    )


def _check_numbers(options: _StepOptions, unit: str) -> None:
    """Refuse a size or a time that the step cannot have; written so that NaN is refused too."""
    size, seconds = options.size, options.seconds
    if not abs(size) <= MOST_DEG:
        shown = beside(size, -MOST_DEG, MOST_DEG)[0]
        raise OptionValueError("--size", f"{shown} is not between {-MOST_DEG:g} and {MOST_DEG:g} {unit}")
    if not seconds <= MOST_S:
        raise OptionValueError("--seconds", f"{beside(seconds, MOST_S)[0]} is not between 0.2 and {MOST_S:g} s")


def _check_range(q: "Array", axis: int, size: float, spec: "RobotSpec") -> None:
    """Refuse a posture q (n,) rad and a step of ``size`` rad (m of a slide) that leave the range of a joint.

    An axis that the robot has not is left to the experiment.
    """
    for joint, sentence in values.outside(q, spec):
        raise OptionValueError("--joints", sentence, joint + 1)
    end = q.copy()
    end[axis : axis + 1] += size  # a slice, which an axis that is not there leaves empty
    for _, sentence in values.outside(end, spec):
        raise OptionValueError("--size", f"at the end of the step {sentence}")


def _payload(text: str, option: str, spec: "RobotSpec") -> "Payload":
    """Return a payload, with a note on stderr if it is over the rated one."""
    payload = values.payload(text, option, spec)
    values.note_overload(payload, option, spec)
    return payload


def _lines(kind: "AxisKind") -> tuple[tuple[str, str, str], ...]:
    """Return label, key and form of each figure that is printed of an axis of a kind."""
    mass = "mass" if kind.slides else "inertia"
    unit = kind.inertia.replace(" ", "_")
    return (
        (f"true {mass} with rotor", f"inertia_{unit}", f"{{:.4g}} {kind.inertia}"),
        (f"{mass} in the gains", f"gain_inertia_{unit}", f"{{:.4g}} {kind.inertia}"),
        ("overshoot", "overshoot_pct", "{:.2f} %"),
        ("settling to 2 %", "settling_s", "{:.4f} s"),
        ("rise 10 to 90 %", "rise_s", "{:.4f} s"),
        # z: the droop is the one figure with a sign, and -0.0000 would look like a direction
        ("droop", f"droop_{kind.unit}", f"{{:z.4f}} {kind.unit}"),
        (f"peak {kind.effort}", kind.force_key.replace("max", "peak"), f"{{:.1f}} {kind.force}"),
    )


def _print(found: dict[str, Any], kind: "AxisKind") -> None:
    from robolang.core.diagnostics import safe

    drives = "ideal drives" if found["ideal_drives"] else "real drives"
    echo(
        safe(
            f"{found['robot']}: step of {found[f'size_{kind.unit}']:g} {kind.unit} on J{found['axis']}, "
            f"{found['servo']} gains, {found['plant']} arm, {drives}"
        )
    )
    for label, key, form in _lines(kind):
        if found[key] is not None:
            echo(f"  {label:<24} {form.format(found[key])}")
    if not found["stable"]:
        echo("  the axis does not come to rest")


def _write_plot(path: Path, request: "StepRequest", result: "StepResult") -> None:
    from robolang.core.storage import write_atomic
    from robolang.execution.plot import Curve, Labels, as_html, as_svg

    kind = request.robot.axes[request.axis].kind
    title = f"{request.robot.name}: step on J{request.axis + 1}, D' = {result.inertia:.3g} {kind.inertia}"
    curve = Curve(name=f"{request.profile.servo.mode} gains", x=result.t, y=result.response / kind.size)
    y = f"{'position' if kind.slides else 'angle'}, {kind.unit}"
    svg = as_svg(Labels(title=title, x="time, s", y=y), [curve], level=request.size / kind.size)
    text = as_html(title, svg) if path.suffix == ".html" else svg
    write_atomic(path, lambda stream: stream.write(text.encode("utf-8")))
