"""``robolang inertia``: the inertia that the motor of every axis sees in a posture; or a map of it over two joints.

``--json`` prints one object, in SI with angles in deg and axes from 1:

    {"robot", "joints_deg", "payload_kg", "axes": [{"axis", "link_inertia", "rotor_inertia", "motor_inertia",
                                                    "compensation", "gravity"}, ...]}
    with --map  {"robot", "joints_deg", "payload_kg", "axis", "map", "smallest": {...}, "largest": {...}, "file"}

Of an arm with an axis that slides ``joints`` stands in place of ``joints_deg``, with mm of that axis, and its row has
``"kind": "prismatic"``: masses in kg and a force in N, but at the motor.
"""

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from robolang.cli import values
from robolang.cli.errors import reported, say_warnings
from robolang.cli.options import Group, JsonOptions, Option, PostureOptions
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.experiments.inertia import InertiaMap
    from runtime.core.frames import Array
    from runtime.robot.model.axis_kind import AxisKind
    from runtime.robot.model.payload import Payload
    from runtime.robot.model.spec import RobotSpec

KG_CM2 = 1e-4
"""kg m2 of a kg cm2, in which catalogues of motors give inertia."""

TICKS_DEG = 45.0
"""Distance of the ticks of a map."""


class _MapOptions(Group):
    """A map over two joints, instead of one posture."""

    PANEL: ClassVar[str] = "Map"
    over: Annotated[str | None, Option("--map", metavar="J2,J3", help="Map over the ranges of these two joints.")] = (
        None
    )
    axis: Annotated[int | None, Option("--axis", metavar="N", help="Axis that is mapped, from 1; default: 1.")] = None
    out: Annotated[Path | None, Option("--out", metavar="FILE.svg", help="Draw the map to this file.")] = None


class _CompensationOptions(PostureOptions):
    """The posture, and what the model of the robot lacks."""

    compensation: Annotated[
        Path | None, Option("--compensation", metavar="FILE", help="Compensation file of 'robolang identify'.")
    ] = None


def inertia(options: _CompensationOptions, chart: _MapOptions, output: JsonOptions) -> None:
    """Print the inertia of every axis at the joint and at the motor, and its gravity torque.

    Example: robolang inertia --robot puma560 --joints 0,45,-180,0,45,0

    Exit codes: 0 done; 2 a value or a robot cannot be used; 4 the picture cannot be written.
    """
    _check_use(chart)
    if chart.over is not None and options.compensation is not None:
        raise OptionValueError("--compensation", "cannot be used with --map: the map shows the model")
    with reported():
        from robolang.project.project import load_any_robot

        spec = load_any_robot(options.robot)
        say_warnings(spec.warnings)
        q, carried = values.posture(options.joints, spec), values.payload(options.payload, "--payload", spec)
        values.warn_outside(q, spec)
        values.note_overload(carried, "--payload", spec)
        if chart.over is None:
            found = _at_posture(spec, q, carried, options.compensation)
        else:
            found = _over_plane(spec, q, carried, chart)
        if output.as_json:
            echo(json.dumps(found))
        elif chart.over is None:
            _print(found, spec)
        else:
            _print_extremes(found, spec)


def _head(spec: "RobotSpec", q: "Array", carried: "Payload") -> dict[str, Any]:
    return {
        "robot": spec.name,
        # 12 digits: deg to rad and back changes the last of 17
        spec.joints_key: [float(f"{angle:.12g}") + 0.0 for angle in q / spec.units],
        "payload_kg": carried.mass,
    }


def _at_posture(spec: "RobotSpec", q: "Array", carried: "Payload", compensation: Path | None) -> dict[str, Any]:
    from robolang.experiments.inertia import at_posture, plain
    from runtime.dynamics.compensation import load_compensation

    extra = None if compensation is None else load_compensation(compensation, spec)
    rows = zip(spec.axes, plain(at_posture(spec, q, carried, extra)), strict=True)
    axes = [{**row, **({"kind": axis.kind.name} if axis.kind.slides else {})} for axis, row in rows]
    return {**_head(spec, q, carried), "axes": axes}


def _over_plane(spec: "RobotSpec", q: "Array", carried: "Payload", chart: _MapOptions) -> dict[str, Any]:
    """Return the extremes of a map over two joints, and draw it when ``--out`` names a file."""
    from robolang.core.storage import check_writable
    from robolang.experiments.inertia import extremes, over_plane

    plane, mapped = _plane(chart.over or "", spec), _axis(chart.axis, spec)
    if chart.out is not None:
        check_writable(chart.out)
    drawn = over_plane(spec, mapped, plane, q, carried)
    if chart.out is not None:
        _draw(chart.out, spec, drawn, carried.mass)
    return {
        **_head(spec, q, carried),
        "axis": mapped + 1,
        "map": [joint + 1 for joint in plane],
        **extremes(drawn),
        "file": None if chart.out is None else str(chart.out),
    }


# --- options ---------------------------------------------------------------------------------------------------------


def _check_use(chart: _MapOptions) -> None:
    """Refuse options of a map without one, and a drawing that is no .svg file."""
    over, axis, out = chart.over, chart.axis, chart.out
    for option, value in (("--axis", axis), ("--out", out)):
        if over is None and value is not None:
            raise OptionValueError(option, "needs --map")
    if out is not None and out.suffix != ".svg":
        raise OptionValueError("--out", f"'{out}' must end in .svg")


def _plane(text: str, spec: "RobotSpec") -> tuple[int, int]:
    """Return the two joints (0-based) of ``J2,J3``; ``OptionValueError``."""
    words = text.split(",")
    if len(words) != 2:
        given = "1 is" if len(words) == 1 else f"{len(words)} are"
        raise OptionValueError("--map", f"2 joints are needed, such as J2,J3, but {given} given")
    first, second = (_joint(word.strip(), position, spec) for position, word in enumerate(words, start=1))
    if first == second:
        raise OptionValueError("--map", f"is J{first + 1} again; a map needs two different joints", 2)
    return first, second


def _joint(word: str, position: int, spec: "RobotSpec") -> int:
    given = re.fullmatch(r"[Jj]?([0-9]{1,2})", word)
    if given is None or not 1 <= int(given[1]) <= spec.n:
        shown = word if len(word) <= 40 else f"{word[:37]}..."
        raise OptionValueError("--map", f"{shown!r} is not one of J1 to J{spec.n}", position)
    return int(given[1]) - 1


def _axis(axis: int | None, spec: "RobotSpec") -> int:
    if axis is not None and not 1 <= axis <= spec.n:
        raise OptionValueError("--axis", f"{axis} is not one of 1 to {spec.n}")
    return 0 if axis is None else axis - 1


# --- output ----------------------------------------------------------------------------------------------------------


def _print(found: dict[str, Any], spec: "RobotSpec") -> None:
    from rich import box
    from rich.table import Table

    from robolang.cli.console import Console
    from robolang.core.diagnostics import safe

    kinds = [axis.kind for axis in spec.axes]
    inertias, forces = (", ".join(dict.fromkeys(getattr(kind, of) for kind in kinds)) for of in ("inertia", "force"))
    table = Table(
        title=safe(f"{found['robot']} at {_posture(found[spec.joints_key], kinds)}{_with(found['payload_kg'])}"),
        box=box.SIMPLE_HEAD,
        padding=(0, 1, 0, 0),
        pad_edge=False,
    )
    for heading in (
        "axis",
        f"link D\n{inertias}",
        f"rotor N^2 J\n{inertias}",
        "at the motor\nkg cm2",
        "compensation\nkg cm2",
        f"gravity\n{forces}",
    ):
        table.add_column(heading, justify="left" if heading == "axis" else "right", no_wrap=True)
    for row, kind in zip(found["axes"], kinds, strict=True):
        table.add_row(
            f"J{row['axis']}",
            # the unit of a row where the heading has two
            f"{row['link_inertia']:.4g}{f' {kind.inertia}' if ', ' in inertias else ''}",
            f"{row['rotor_inertia']:.4g}",
            f"{row['motor_inertia'] / KG_CM2:.4g}",
            f"{row['compensation'] / KG_CM2:.4g}",
            f"{round(row['gravity'], 3) + 0.0:.3f}",
        )
    console = Console()
    console.print(table)
    beyond = "compensation" if any(row["compensation"] for row in found["axes"]) else "J"
    console.print("D: of links and payload at the joint; N^2 J: of the rotor, N the gear ratio", style="italic")
    console.print(f"at the motor: D / N^2 + {beyond}; 1 kg cm2 = 1e-4 kg m2", style="italic")


def _posture(joints: list[float], kinds: "list[AxisKind]") -> str:
    """Return joints in brackets, with one unit after them or, where there are two, with that of each."""
    if len(set(kinds)) == 1:
        return f"({', '.join(f'{at:g}' for at in joints)}) {kinds[0].unit}"
    return f"({', '.join(f'{at:g} {kind.unit}' for at, kind in zip(joints, kinds, strict=True))})"


def _print_extremes(found: dict[str, Any], spec: "RobotSpec") -> None:
    from robolang.core.diagnostics import safe

    first, second = found["map"]
    one, other, mapped = (spec.axes[axis - 1].kind for axis in (first, second, found["axis"]))
    over = f"over J{first} and J{second}{_with(found['payload_kg'])}"
    echo(safe(f"{found['robot']}: inertia of J{found['axis']} at the motor {over}"))
    low, high = (found[name]["motor_inertia"] for name in ("smallest", "largest"))
    if not high - low > 1e-9 * high:  # rounding is no extreme at a posture
        echo(f"  {low / KG_CM2:.4g} kg cm2 everywhere: these two joints do not change it")
    for name in ("smallest", "largest") if high - low > 1e-9 * high else ():
        at = found[name]
        x, y = at["joints" if one.slides or other.slides else "joints_deg"]
        where = f"J{first} {x:.1f}{'' if one is other else f' {one.unit}'}, J{second} {y:.1f} {other.unit}"
        echo(
            f"  {name:<9} {at['motor_inertia'] / KG_CM2:.4g} kg cm2 (link D {at['link_inertia']:.4g} {mapped.inertia}) "
            f"at {where}"
        )
    if found["file"] is not None:
        echo(safe(f"  drawn in {found['file']}"))


def _with(mass: float) -> str:
    return f" with {mass:g} kg" if mass else ""


def _held(spec: "RobotSpec", joint: int, q: float) -> str:
    kind = spec.axes[joint].kind
    return f"J{joint + 1} {round(q / kind.size, 3) + 0.0:g}{f' {kind.unit}' if spec.slides.any() else ''}"


def _draw(path: Path, spec: "RobotSpec", found: "InertiaMap", mass: float) -> None:
    from robolang.core.storage import write_atomic
    from robolang.execution.plot import Labels, as_map_svg

    (first, one), (second, other) = (
        (f"J{joint + 1}", kind) for joint, kind in zip(found.joints, found.kinds, strict=True)
    )
    title = f"{spec.name}{_with(mass)}: inertia of J{found.axis + 1} at its motor, D / N^2 + J"
    others = [joint for joint in range(found.axis + 1, spec.n) if joint not in found.joints]  # it depends on these
    held = ", ".join(_held(spec, joint, float(found.q[joint])) for joint in others)
    # one unit is said once
    held += "" if spec.slides.any() or not held else " deg"
    svg = as_map_svg(
        Labels(title=title, x=f"{first}, {one.unit}{f' (at {held})' if held else ''}", y=f"{second}, {other.unit}"),
        "kg cm2",
        found.x / one.size,
        found.y / other.size,
        found.motor / KG_CM2,
        # 45 mm are no usual distance of ticks
        every=None if one.slides or other.slides else TICKS_DEG,
    )
    write_atomic(path, lambda stream: stream.write(svg.encode("utf-8")))
