"""``robolang kin``: forward and inverse kinematics of a robot, on the command line, in mm and degrees.

``fk`` prints the pose of joint angles, ``ik`` every solution of a pose with its branch and its margin to the joint
limits, best first. The pose is X_base_tool, ``x,y,z,rx,ry,rz`` with the rotations about the fixed X, Y and Z axes in
that order; without ``--tool`` the tool is the flange. ``--json`` gives full double precision, one object a call:

    fk  {"pose_mm_deg": [x, y, z, rx, ry, rz]}
    ik  {"solutions": [{"joints_deg": [...], "branch": "RIGHTY ABOVE NOFLIP", "limit_margin_deg": number,
         "turns_deg": [[...], ...]}, ...], "complete": boolean, "not_listed": number}

``turns_deg`` holds the joint angles of a solution and all others inside the ranges that differ from them by whole
turns: a joint with a range above one turn has several angles for one place. ``complete`` is false for an arm without a
closed form, whose numeric search may have missed solutions. ``not_listed`` counts the turns beyond ``MOST_TURNS``.
``fk`` warns of joint angles outside their ranges (RBL309 on stderr), and prints their pose.
A robot may be a URDF or MJCF file: no drives are needed here. An arm without a closed form has the branch NUMERIC.
numpy, rich and the runtime are imported inside the commands, so that ``robolang --help`` stays quick.
"""

import json
from itertools import islice
from typing import TYPE_CHECKING, Annotated, Any

import typer

from robolang.cli.command import PlainCommand, command
from robolang.cli.errors import reported, say_warnings
from robolang.cli.options import JsonOptions, Option, RobotOptions
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError
from robolang.cli.values import numbers, warn_outside

if TYPE_CHECKING:
    from runtime.core.frames import Array
    from runtime.robot.kinematics.kinematics import Kinematics

app = typer.Typer(
    no_args_is_help=True, add_completion=False, help="Forward and inverse kinematics of a robot (mm, deg)."
)

POSE = ("x", "y", "z", "rx", "ry", "rz")
POSE_UNITS = ("mm", "mm", "mm", "deg", "deg", "deg")

MOST_TURNS = 1000
"""The most turns that are listed of a pose: six joints of six turns each would give 46 656 of one solution."""


class _ToolOptions(RobotOptions):
    """Which robot, with which tool."""

    tool: Annotated[
        str | None,
        Option("--tool", metavar="X,Y,Z,RX,RY,RZ", help="Tool in the flange frame, mm and deg; default: the flange."),
    ] = None


class _JointsOptions(_ToolOptions):
    joints: Annotated[str, Option("--joints", metavar="J1,J2,...", help="Joint angles, deg.")]


class _PoseOptions(_ToolOptions):
    pose: Annotated[str, Option("--pose", metavar="X,Y,Z,RX,RY,RZ", help="Pose of the tool, mm and deg.")]


@app.command(cls=PlainCommand)
@command
def fk(options: _JointsOptions, output: JsonOptions) -> None:
    """Print the pose of the tool for given joint angles.

    Example: robolang kin fk --robot puma560 --joints 0,45,-180,0,45,0

    Exit codes: 0 done, also for angles outside the joint ranges (a warning); 2 a value or a robot cannot be used.
    """
    with reported():
        _fk(options, output.as_json)


def _fk(options: _JointsOptions, as_json: bool) -> None:
    import numpy as np

    from runtime.core.frames import xyzrpy_from_pose
    from runtime.core.linear import matmul

    kinematics = _kinematics(options.robot)
    q = np.array(numbers(options.joints, option="--joints", names=_joint_names(kinematics.n))) * kinematics.units
    warn_outside(q, kinematics.spec)
    X_base_tool = matmul(kinematics.forward(q), _pose(options.tool, "--tool"))
    pose_mm_deg = _plain(xyzrpy_from_pose(X_base_tool) / _pose_scale())
    if as_json:
        echo(json.dumps({"pose_mm_deg": pose_mm_deg}))
        return
    headings = [f"{name}\n{unit}" for name, unit in zip(POSE, POSE_UNITS, strict=True)]
    _print_table(
        f"Pose of the tool, {kinematics.spec.title}", headings, [[f"{round(v, 3) + 0.0:.3f}" for v in pose_mm_deg]]
    )


@app.command(cls=PlainCommand)
@command
def ik(options: _PoseOptions, output: JsonOptions) -> None:
    """Print every set of joint angles that puts the tool at a pose, the one farthest from the limits first.

    Example: robolang kin ik --robot puma560 --pose 596.3,-150.05,657.65,0,90,0

    Exit codes: 0 done; 1 the pose is out of reach, or reached only outside the ranges; 2 a value or a robot cannot be
    used.
    """
    with reported():
        _ik(options, output.as_json)


def _ik(options: _PoseOptions, as_json: bool) -> None:
    from runtime.core.frames import inverse
    from runtime.core.linear import matmul

    kinematics = _kinematics(options.robot)
    X_base_flange = matmul(_pose(options.pose, "--pose"), inverse(_pose(options.tool, "--tool")))
    solutions, left = _solutions_deg(kinematics, X_base_flange)
    if as_json:  # before the refusal: an empty list is an answer, and a script reads it
        echo(json.dumps({"solutions": solutions, "complete": kinematics.closed_form, "not_listed": left}))
    if not solutions:
        _say_out_of_reach(kinematics)
        raise SystemExit(1)
    if not as_json:
        _print_table(
            f"Joint angles, {kinematics.spec.title}",
            ["branch", *_headings(kinematics), "margin\ndeg" if kinematics.turning.all() else "margin\ndeg, mm"],
            [row for solution in solutions for row in _solution_rows(solution, _keys(kinematics))],
            caption=_caption(kinematics, solutions, left),
        )
    if not any(solution[_keys(kinematics)[1]] >= 0.0 for solution in solutions):
        _say_outside(kinematics)
        raise SystemExit(1)


def _caption(kinematics: "Kinematics", solutions: list[dict[str, Any]], left: int) -> str:
    lines = ["margin: distance to the nearest joint limit; negative: outside the range"]
    if any(len(solution[_keys(kinematics)[2]]) > 1 for solution in solutions):
        lines.append("rows without a branch: as the row above, with joints turned by whole turns")
    if left:
        lines.append(f"{left} more turns are not listed")
    if not kinematics.closed_form:
        lines.append("numeric, without a closed form: solutions may be missing")
    return "\n".join(lines)


def _kinematics(robot: str) -> "Kinematics":
    """Return the kinematics of a built-in robot or a robot file; ``FileFault`` or a usage error otherwise."""
    from pathlib import Path

    from runtime.robot.files.arm_file import ROBOT_ENDINGS, is_model
    from runtime.robot.files.importer import load_file, read_arm
    from runtime.robot.files.loader import load_builtin
    from runtime.robot.files.robot_file import library
    from runtime.robot.kinematics.kinematics import Kinematics

    # not load_any_robot: it wants the drives that a model lacks
    if is_model(robot):
        arm = read_arm(Path(robot))  # drives are not needed to say where the tool is
        say_warnings(arm.warnings)
        return Kinematics(arm)
    if robot.lower().endswith(ROBOT_ENDINGS):
        spec = load_file(Path(robot))
        say_warnings(spec.warnings)
        return Kinematics(spec)
    try:
        return Kinematics(load_builtin(robot))
    except KeyError:
        known = ", ".join(library())
        raise OptionValueError(
            "--robot", f"{robot!r} is not a robot; known: {known}, or a .toml, .urdf or .xml file"
        ) from None


def _pose(text: str | None, option: str) -> "Array":
    """Return the pose (4, 4) in m of ``x,y,z,rx,ry,rz`` in mm and deg; the identity for None."""
    import numpy as np

    from runtime.core.frames import pose_from_xyzrpy

    if text is None:
        return np.eye(4)
    values = numbers(text, option=option, names=POSE)
    return pose_from_xyzrpy([value * scale for value, scale in zip(values, _pose_scale(), strict=True)])


def _pose_scale() -> list[float]:
    """Return metres per mm and radians per degree for the six numbers of a pose."""
    from runtime.core.units import DEG, MM

    return [{"mm": MM, "deg": DEG}[unit] for unit in POSE_UNITS]


def _solutions_deg(kinematics: "Kinematics", X_base_flange: "Array") -> tuple[list[dict[str, Any]], int]:
    """Return the solutions, best first, each with its turns, and how many turns are not listed."""
    import numpy as np

    slides, names = kinematics.turning == 0.0, _keys(kinematics)

    def shown(q: "Array") -> "Array":
        return np.where(slides, q / kinematics.units, np.rad2deg(q))

    rows, room, left = [], MOST_TURNS, 0
    for found in sorted(kinematics.solutions(X_base_flange), key=lambda s: -s.limit_margin):
        # the best solutions use the room up first; `turn_count` counts without making them
        turns = list(islice(kinematics.other_turns(found), room))
        room, left = room - len(turns), left + kinematics.turn_count(found) - len(turns)
        rows.append(
            {
                names[0]: _plain(shown(found.q)),
                "branch": str(found.branch),
                names[1]: float(np.rad2deg(found.limit_margin)),
                names[2]: [_plain(shown(each.q)) for each in (found, *turns)],
            }
        )
    return rows, left


def _keys(kinematics: "Kinematics") -> tuple[str, str, str]:
    """Return the keys of joints, margin and turns of a solution; without deg where an axis slides."""
    unit = "_deg" if kinematics.turning.all() else ""
    return f"joints{unit}", f"limit_margin{unit}", f"turns{unit}"


def _plain(values: "Array") -> list[float]:
    """Return floats without negative zeros."""
    return [float(value) + 0.0 for value in values]


def _joint_names(n: int) -> tuple[str, ...]:
    return tuple(f"J{i}" for i in range(1, n + 1))


def _headings(kinematics: "Kinematics") -> list[str]:
    axes = zip(_joint_names(kinematics.n), kinematics.spec.axes, strict=True)
    return [f"{name}\n{axis.kind.unit}" for name, axis in axes]


def _solution_rows(solution: dict[str, Any], keys: tuple[str, str, str]) -> list[list[str]]:
    """Return the row of a solution and those of its other turns, which have neither branch nor margin."""
    first, *others = [[f"{round(value, 2) + 0.0:.2f}" for value in joints] for joints in solution[keys[2]]]
    margin = f"{round(solution[keys[1]], 2) + 0.0:.2f}"
    return [[solution["branch"], *first, margin], *(["", *joints, ""] for joints in others)]


def _say_out_of_reach(kinematics: "Kinematics") -> None:
    from runtime.core.faults import lookup

    code, robot = lookup("RBL410"), kinematics.spec.title
    meaning = (
        code.meaning if kinematics.closed_form else "The numeric search reached the pose from no starting posture."
    )
    echo(f"error {code.code} {code.name} --pose: {meaning} ({robot})\n  help: {code.remedy}", err=True)


_WIDEST = 1000


def _say_outside(kinematics: "Kinematics") -> None:
    from runtime.core.faults import lookup

    code = lookup("RBL411")
    echo(
        f"error {code.code} {code.name} --pose: every posture has a joint outside its range ({kinematics.spec.title})\n"
        f"  help: {code.remedy}",
        err=True,
    )


def _print_table(title: str, headings: list[str], rows: list[list[str]], caption: str | None = None) -> None:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    from robolang.cli.console import Console

    # narrow enough that eight columns fit 80 characters uncut; Text, because a title is a robot file's own words
    table = Table(title=Text(title), caption=caption, box=SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    for heading in headings:
        table.add_column(heading, justify="left" if heading == "branch" else "right", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    console = Console()
    # a number is never cut; asked without the width of the terminal, which would be the answer otherwise
    needed = console.measure(table, options=console.options.update(max_width=_WIDEST)).maximum
    console.width = max(console.width, needed)
    console.print(table)
