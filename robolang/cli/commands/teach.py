"""``robolang teach PROG POINT``: one point into the points file of a program, without the prompt.

``--json`` prints one object, in mm and deg:

    {"point", "kind", "frame", "tool", "configuration", "turns", "pose", "joints", "is_new", "notes", "written",
     "change": null or {"frame", "by", "distance_mm", "angle_deg", "joints_deg", "configuration"}}

``pose`` or ``joints`` is null, whichever the point has not; of a ``change`` those of an old point out of reach.
"""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, cast

from robolang.cli.errors import reported
from robolang.cli.options import Argument, CellOptions, Group, JsonOptions, Option, Program
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robolang.project.points import Point
    from robolang.teaching.one_off import OneOff, TaughtOnce
    from robolang.teaching.taught import Kind
    from robolang.teaching.touch_up import TouchUp
    from robolang.values.poses import Six
    from runtime.core.frames import Array

POSE = ("x", "y", "z", "rx", "ry", "rz")


class _WhereOptions(Group):
    """Where the arm stands: exactly one of these, and --line and --time with --here-of."""

    PANEL: ClassVar[str] = "Place"
    joints: Annotated[str | None, Option("--joints", metavar="J1,J2,...", help="Joints of the point, deg.")] = None
    pose: Annotated[
        str | None,
        Option("--pose", metavar="X,Y,Z,RX,RY,RZ", help="Pose of the tool in the frame, mm and deg."),
    ] = None
    here_of: Annotated[
        Path | None, Option("--here-of", metavar="FILE", help="Log of a run (.npz): where the arm stood there.")
    ] = None
    line: Annotated[
        int | None,
        Option(
            "--line",
            metavar="N",
            low=1,
            help="Number of a statement, or its line in a program without numbers: where its last execution ended.",
        ),
    ] = None
    time: Annotated[
        float | None,
        Option(
            "--time",
            metavar="S",
            help="Time of the run, s: where the arm was then; with --line, the execution by then.",
        ),
    ] = None


class _PointOptions(Group):
    """What the point is."""

    PANEL: ClassVar[str] = "Point"
    as_: Annotated[
        str | None,
        Option(
            "--as",
            help="Teach joint angles, or a pose; default: as the point is, else as it is given, and in a frame a pose.",
            choices=("joints", "pose"),
        ),
    ] = None
    frame: Annotated[
        str | None,
        Option("--frame", metavar="NAME", help="Frame of the cell; default: that of the point, else the world."),
    ] = None
    tool: Annotated[
        str | None, Option("--tool", metavar="NAME", help="Tool of the cell; default: that of the hand.")
    ] = None
    yes: Annotated[bool, Option("--yes", help="Replace a point that is taught already.")] = False


_Point = Annotated[str, Argument("POINT", "Name of the point.")]


def teach(
    program: Program,
    point: _Point,
    where: _WhereOptions,
    options: _PointOptions,
    files: CellOptions,
    output: JsonOptions,
) -> None:
    """Teach one point: write it into the points file of a program, and print what changes.

    Example: robolang teach pick_and_place.rbl P6 --pose 500,0,700,180,0,0

    Exit codes: 0 done; 2 an option or a file cannot be used, or the point is there already and --yes is not given: then
    nothing is written; 3 the pose is not reached; 4 the file cannot be written.
    """
    _refuse(where)
    with reported():
        from robolang.teaching.one_off import Naming, OneOff

        naming = Naming(as_=cast("Kind | None", options.as_), frame=options.frame, tool=options.tool)
        cell = None if files.cell is None else Path(files.cell)
        one = OneOff(Path(program), point, naming, cell, files.robot)
        found = one.teach(_joints(one, where), new_as=None if where.pose is None else "pose")
        written = one.save() if options.yes or found.old is None else ()
        if output.as_json:
            echo(json.dumps(_figures(found, written)))
        else:
            _print(found, written)
        if found.old is not None and not options.yes:
            raise _there(found.old.name)


def _refuse(where: _WhereOptions) -> None:
    """Refuse options that say nothing, or more than one thing, about where the arm stands."""
    given = [name for name in ("joints", "pose", "here_of") if getattr(where, name) is not None]
    if len(given) != 1:
        message = "one of --joints, --pose and --here-of is needed" if not given else "only one of them can be given"
        raise OptionValueError(f"--{given[-1].replace('_', '-')}" if given else "--joints", message)
    for name in ("line", "time"):
        if where.here_of is None and getattr(where, name) is not None:
            raise OptionValueError(f"--{name}", "is about the log of --here-of, which is not given")
    if where.here_of is not None and where.line is None and where.time is None:
        raise OptionValueError("--here-of", "--line or --time is needed: a run stands in many places")
    if where.time is not None and not 0.0 <= where.time < float("inf"):  # NaN is refused too
        raise OptionValueError("--time", f"{where.time:g} is not a time of a run, s")


def _joints(one: "OneOff", where: _WhereOptions) -> "Array":
    """Return where the arm stands (n,), rad."""
    import numpy as np

    from robolang.cli import values

    if where.joints is not None:
        names = tuple(f"J{i}" for i in range(1, one.axes + 1))
        units = one.around.cell.robot.units
        return np.asarray(values.numbers(where.joints, option="--joints", names=names) * units)
    if where.pose is not None:
        return one.joints_of(cast("Six", values.numbers(where.pose, option="--pose", names=POSE)))
    from robolang.teaching.logged import joints_at, joints_at_end_of

    assert where.here_of is not None  # ``_refuse`` has seen to it
    if where.line is not None:
        return joints_at_end_of(where.here_of, one.axes, where.line, where.time)
    assert where.time is not None
    return joints_at(where.here_of, one.axes, where.time)


def _there(name: str) -> "Exception":
    from runtime.core.faults import Fault

    return Fault("RBL718", f"point {name} is taught already, and was left as it is", "Give --yes to replace it.")


# --- what is shown ---------------------------------------------------------------------------------------------------


def _figures(found: "TaughtOnce", written: tuple[Path, ...]) -> dict[str, Any]:
    point = found.taught.point
    return {
        "point": point.name,
        "kind": "joints" if point.pose is None else "pose",
        "frame": point.frame,
        "tool": point.tool,
        "configuration": " ".join(point.configuration),
        "turns": list(point.turns),
        "pose": None if point.pose is None else list(point.pose),
        "joints": None if point.joints is None else list(point.joints),
        "is_new": found.old is None,
        "notes": list(found.taught.notes),
        "written": [str(path) for path in written],
        "change": None if found.change is None else _change_figures(found.change),
    }


def _change_figures(change: "TouchUp") -> dict[str, Any]:
    return {
        "frame": change.frame,
        "by": list(change.by),
        "distance_mm": change.distance,
        "angle_deg": change.angle,
        "joints_deg": None if change.joints is None else list(change.joints),
        "configuration": [list(pair) for pair in change.configuration],
    }


def _print(found: "TaughtOnce", written: tuple[Path, ...]) -> None:
    from robolang.core.diagnostics import safe

    point, old, change = found.taught.point, found.old, found.change
    echo(safe(f"{point.name}: {_described(point)}"))
    values = [("taught", _values(point))]
    if old is not None and (old.pose is None) == (point.pose is None):  # numbers of two kinds cannot be compared
        values.insert(0, ("before", _values(old)))
    _print_rows(_headings(point), values)
    if change is not None:
        _print_change(change)
    for note in found.taught.notes:
        echo(safe(f"note: {note}"), err=True)
    for path in written:
        echo(safe(f"{path}: written"))


def _described(point: "Point") -> str:
    if point.pose is None:
        return "joints"
    parts = [f"pose in {point.frame or 'the world'}", f"tool {point.tool}" if point.tool else "tool of the hand"]
    turns = f"turns {', '.join(map(str, point.turns))}" if any(point.turns) else ""
    return ", ".join(filter(None, [*parts, " ".join(point.configuration), turns]))


def _values(point: "Point") -> "Sequence[float]":
    # a point has exactly one of the two
    return point.joints or point.pose or ()


def _headings(point: "Point") -> list[str]:
    if point.joints is not None:
        return [f"J{i}\ndeg" for i in range(1, len(point.joints) + 1)]
    return [f"{name.upper()}\n{'mm' if axis < 3 else 'deg'}" for axis, name in enumerate(POSE)]


def _print_change(change: "TouchUp") -> None:
    """Print by how much a point has changed, of the tool in the frame of the point and of the joints."""
    from robolang.core.diagnostics import safe

    headings = [f"d{name.upper()}\n{'mm' if axis < 3 else 'deg'}" for axis, name in enumerate(POSE)]
    _print_rows(headings, [(f"in {change.frame or 'the world'}", change.by)])
    if change.joints is not None:
        headings = [f"dJ{i}\ndeg" for i in range(1, len(change.joints) + 1)]
        _print_rows(headings, [("joints", change.joints)])
    echo(f"The tool moves by {change.distance:.3f} mm and turns by {change.angle:.3f} deg.")
    for before, after in change.configuration:
        echo(f"The configuration changes from {before} to {after}.")
    if change.unreached is not None:
        echo(safe(f"note: the old point is not reached ({change.unreached.message})"), err=True)


def _print_rows(headings: list[str], rows: "Sequence[tuple[str, Sequence[float]]]") -> None:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    from robolang.cli.console import Console

    table = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("")
    for heading in headings:
        table.add_column(heading, justify="right", no_wrap=True)
    for name, values in rows:
        # adding zero turns a rounded -0.0 into 0.0; Text, because a frame is named in the words of a cell file
        table.add_row(Text(name), *(f"{round(value, 3) + 0.0:.3f}" for value in values))
    console = Console()
    console.width = max(console.width, console.measure(table).maximum)  # a number is never cut
    console.print(table)
