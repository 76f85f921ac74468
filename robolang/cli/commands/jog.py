"""``robolang jog [PROG] AXIS AMOUNT ...``: jogs from the start state of a cell, one after the other, for scripts.

``--json`` prints one object, in mm and deg: ``{"jogs": [{"jog", "joints", "pose", "remarks"}, ...]}``; the first entry,
whose ``jog`` is null, is where the arm stands before them, and ``pose`` is that of the tool in the world.
"""

import json
import re
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from robolang.cli.errors import INTERRUPTED, MOTION, exit_code, reported, say_all
from robolang.cli.options import Argument, CellOptions, Group, JsonOptions, Option, PhysicsOptions
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.pendant.live import Live
    from robolang.project.project import Project
    from robolang.teaching.jogging import JogRequest
    from runtime.robot.model.spec import RobotSpec

_AXIS = re.compile(r"(?:J[1-9]|R?[XYZ])", re.IGNORECASE)
_POSE = ("X", "Y", "Z", "RX", "RY", "RZ")

_Words = Annotated[
    list[str],
    Argument("[PROG] AXIS AMOUNT ...", "Program file (.rbl), for its cell; then jogs, J3 +5 (deg) or X -10 (mm)."),
]


class _JogOptions(Group):
    """From where, in which frame and how fast."""

    PANEL: ClassVar[str] = "Jog"
    joints: Annotated[
        str | None,
        Option("--joints", metavar="J1,J2,...", help="Where the arm stands, deg; default: home of the cell."),
    ] = None
    frame: Annotated[
        str, Option("--frame", help="Frame in which X to RZ count.", choices=("world", "base", "tool"))
    ] = "world"
    speed: Annotated[
        float, Option("--speed", metavar="%", help="Speed, % of that of MANUAL: 250 mm/s.", low=1, high=100)
    ] = 25.0


def jog(words: _Words, options: _JogOptions, files: CellOptions, arm: PhysicsOptions, output: JsonOptions) -> None:
    """Jog the arm from the start state of a cell, and print where it stands after each jog.

    Example: robolang jog Z -50 J1 10

    Exit codes: 0 done; 2 an argument, an option or a file cannot be used; 3 a jog was refused or ended with an alarm:
    those before it are printed; 130 stopped by a signal.
    """
    with reported():
        # NaN passes the bounds of an option
        if not 1.0 <= options.speed <= 100.0:
            raise OptionValueError("--speed", f"{options.speed:g} is not from 1 to 100")
        program, jogs = (None, words) if _AXIS.fullmatch(words[0]) else (words[0], words[1:])
        project = _project(program, files, options.joints)
        requests = _requests(jogs, project.cell.robot)
        live = _live(project, physics=not arm.no_physics)
        rows, code = _jogged(live, requests, options)
        # also after a jog that was refused: those before it have been done
        if output.as_json:
            echo(json.dumps({"jogs": rows}))
        else:
            _print(rows, project.cell.robot.n)
    if code:
        raise SystemExit(code)


_NEAR_DEG = 0.2
"""How near to its end every axis has to be after a jog, deg."""


def _project(program: str | None, files: CellOptions, joints: str | None) -> "Project":
    """Return the cell with its arm at home, or at the joints that were given, and no program to run."""
    import numpy as np

    from robolang.analysis.analysis import Analysis
    from robolang.cli import values
    from robolang.core.source import Source, read_program
    from robolang.project.project import load_project
    from robolang.teaching.documents import UNNAMED

    # errors of its text are no reason not to jog in its cell; that it is there is checked
    path = UNNAMED if program is None else read_program(Path(program)).path
    project = load_project(Analysis(source=Source(path, "")), files.cell, files.robot)
    if joints is None:
        return project
    robot = project.cell.robot
    names = tuple(f"J{i}" for i in range(1, robot.n + 1))
    q = np.array(values.numbers(joints, option="--joints", names=names)) * robot.units
    for _, sentence in values.outside(q, robot):
        raise OptionValueError("--joints", sentence)
    return replace(project, cell=replace(project.cell, home=q))


def _requests(words: list[str], robot: "RobotSpec") -> "list[JogRequest]":
    """Return the jogs of the command line; ``OptionValueError`` for one that is none."""
    from robolang.teaching.jogging import read_jog, sliding_of
    from runtime.core.faults import Fault

    if not words:
        raise OptionValueError("AXIS AMOUNT", "a jog is needed, such as J3 +5 or X -10")
    requests = []
    for at in range(0, len(words), 2):
        pair = " ".join(words[at : at + 2])
        try:
            requests.append(read_jog(pair, robot.n, sliding_of(robot)))
        except Fault as fault:
            raise OptionValueError(f"'{pair}'", f"{fault.message}. {fault.hint}") from None
    return requests


def _live(project: "Project", *, physics: bool) -> "Live":
    """Return the controller in MANUAL, the arm in its start state."""
    import sys

    from robolang.pendant.interrupts import Signals
    from robolang.pendant.live import Live
    from robolang.pendant.output import PlainOutput
    from runtime.core.units import DEG

    # nothing follows a jog that would need the arm in position: dry friction may hold an axis a little short of it
    profile = project.profile
    project = project.with_profile(replace(profile, in_position=max(profile.in_position, _NEAR_DEG * DEG)))
    live = Live(project, PlainOutput(sys.stderr, sys.stderr), Signals(), physics=physics, realtime=False)
    live.limit_speed(True)
    _declare_hand(project, live)
    return live


def _declare_hand(project: "Project", live: "Live") -> None:
    """Declare what hangs on the flange in the start state: no program does it for a jog."""
    from runtime.core.faults import Fault
    from runtime.robot.model.payload import declared

    hand = project.cell.hand
    # a hand that no LOAD may declare is found by the supervision, as in a program
    with suppress(Fault):
        live.controller.load(declared(hand.mass, hand.cog, project.cell.robot.rated_payload))


def _jogged(live: "Live", requests: "list[JogRequest]", options: _JogOptions) -> tuple[list[dict[str, Any]], int]:
    """Jog; return where the arm stood before and after each, and the exit code of the jog that ended them, or 0."""
    import numpy as np

    from robolang.pendant.failure import Failure
    from robolang.teaching.jog_remarks import remarks
    from robolang.teaching.jogging import JogSettings, plan_jog
    from runtime.core.faults import Fault

    settings = JogSettings().with_frame(options.frame).with_speed(options.speed)
    rows = [_row(live)]
    for request in requests:
        text = f"{request.axis} {request.amount:+g}"
        try:
            plan = plan_jog(live.controller, request, settings)
            live.play(plan.rows, f"jog {text}")
        except Fault as fault:
            # whatever its code is: the jog is refused, and not the text of a program
            say_all(fault)
            return rows, MOTION
        except Failure as failure:
            echo(failure.text, err=True)
            return [*rows, _row(live, text)], exit_code(failure.codes[0])
        rows.append(_row(live, text, remarks(request, plan)))
        # Ctrl-C stops a jog on its path
        if np.abs(live.q - plan.rows[-1]).max() > 0.0:
            return rows, INTERRUPTED
    return rows, 0


def _row(live: "Live", jog: str | None = None, remarks: tuple[str, ...] = ()) -> dict[str, Any]:
    arm = live.arm
    return {"jog": jog, "joints": [*arm.joints], "pose": [*arm.tool_in_world], "remarks": [*remarks]}


def _print(rows: list[dict[str, Any]], joints: int) -> None:
    from robolang.pendant.output import Column, Table, as_text

    units = [("deg", f"J{i}") for i in range(1, joints + 1)] + [
        ("mm" if len(name) == 1 else "deg", name) for name in _POSE
    ]
    columns = (Column(heading="jog"), *(Column(heading=name, unit=unit, number=True) for unit, name in units))
    # adding zero turns a rounded -0.0 into 0.0
    cells = tuple(
        (row["jog"] or "start", *(f"{round(value, 3) + 0.0:.3f}" for value in (*row["joints"], *row["pose"])))
        for row in rows
    )
    echo(as_text(Table(columns=columns, rows=cells)))
    for row in rows:
        for remark in row["remarks"]:
            echo(f"{row['jog']}: {remark}")
