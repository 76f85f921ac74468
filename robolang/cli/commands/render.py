"""``robolang render PROG|RUN``: a picture or a film of a run, of a program that is run for it or of a log."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

from robolang.cli.errors import MOTION, reported
from robolang.cli.options import Argument, CellOptions, Group, Option, PhysicsOptions
from robolang.cli.output import echo
from robolang.cli.outputs import check_outputs, output_beside
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.logs.log import Log
    from robolang.view.pictures import Postures

Subject = Annotated[
    str,
    Argument("PROG|RUN", "Program file (.rbl), which is run, log of a run (.npz, .mcap), or folder of pulse tables."),
]
_SIZE = re.compile(r"(\d{1,5})x(\d{1,5})")


class _PictureOptions(Group):
    """What is drawn, and where to."""

    PANEL: ClassVar[str] = "Picture"
    out: Annotated[
        Path | None,
        Option("--out", "-o", metavar="FILE", help="File: .png, .gif, .webp or .mp4; default: PROG or RUN with .png."),
    ] = None
    view: Annotated[
        str | None,
        Option(
            "--view",
            choices=("iso", "front", "side", "top"),
            help="View of the whole cell; default: the camera of the cell, else iso.",
        ),
    ] = None
    at: Annotated[float | None, Option("--at", metavar="S", help="Time of a .png, s; default: the end.")] = None
    size: Annotated[
        str | None,
        Option("--size", metavar="WxH", help="Pixels; default: 1280x720, of a .gif or .webp 640x360."),
    ] = None
    fps: Annotated[
        int | None, Option("--fps", metavar="N", low=1, high=60, help="Pictures of a film per second; default: 15.")
    ] = None
    no_labels: Annotated[
        bool, Option("--no-labels", help="Leave out the names of the points, as a picture below 480 pixels does.")
    ] = False


def render(subject: Subject, files: CellOptions, picture: _PictureOptions, physics: PhysicsOptions) -> None:
    """Draw a run: a .png at one time, a .gif, .webp or .mp4 of all of it. Films need the extra [video].

    Example: robolang render run.npz -o run.png --at 2.0 --view side

    Exit codes: 0 done, also if the run of the program ended with an alarm, which is then 3; 1 the program has errors; 2
    a file or an option cannot be used, or nothing can draw; 4 the file cannot be written.
    """
    out = picture.out if picture.out is not None else output_beside(subject, ".png")
    if out.suffix in (".rbl", ".toml", ".npz"):
        raise OptionValueError("--out", f"'{out}' would be a program, a cell or a log; name a picture")
    if picture.fps is not None and out.suffix == ".png":
        raise OptionValueError("--fps", f"'{out}' is one picture; name a .gif, .webp or .mp4 for a film")
    size = _size(picture.size)
    with reported():
        from robolang.view.pictures import USUAL_RATE, Order
        from robolang.view.pictures import render as draw

        labels = not picture.no_labels
        order = Order(
            path=out, view=picture.view, at=picture.at, size=size, rate=picture.fps or USUAL_RATE, labels=labels
        )
        # before a run that takes its time
        order.check()
        check_outputs({"--out": out}, [subject, files.cell, files.robot])
        drawn, code = _subject(subject, files, physics)
        for note in draw(drawn, order, _progress()):
            echo(f"note: {note}", err=True)
        echo(f"{out}: {out.stat().st_size / 1e6:.2f} MB")
    if code:
        raise SystemExit(code)


def _size(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    found = _SIZE.fullmatch(text)
    if found is None:
        raise OptionValueError("--size", f"'{text}' must be width and height in pixels, such as 1280x720")
    return int(found[1]), int(found[2])


def _subject(subject: str, files: CellOptions, physics: PhysicsOptions) -> "tuple[Log | Postures, int]":
    """Return what is drawn, and the exit code of a run, or 0."""
    if not Path(subject).is_dir():
        return _log(subject, files, physics)
    _refuse_files(files, physics, "pulse tables have")
    from robolang.view.table_replay import TableReplay
    from runtime.pulses.folder import read_export

    return TableReplay(read_export(Path(subject))), 0


def _refuse_files(files: CellOptions, physics: PhysicsOptions, others: str) -> None:
    if files.cell is not None or files.robot is not None or physics.no_physics:
        raise OptionValueError("--cell, --robot, --no-physics", f"are for a program; {others} their own")


def _log(subject: str, files: CellOptions, physics: PhysicsOptions) -> "tuple[Log, int]":
    """Return the log of a file, or of a run of the program, and the exit code of its alarms, or 0."""
    if Path(subject).suffix in (".npz", ".mcap"):  # a reader of logs knows better what is wrong with them
        _refuse_files(files, physics, "logs have")
        from robolang.logs.files import read_log

        return read_log(subject), 0
    from robolang.cli.refuse import refuse
    from robolang.cli.run_progress import shown
    from robolang.execution.plan_memory import PlanMemory
    from robolang.execution.session import Session
    from robolang.project.project import load_project
    from runtime.appearance.own_meshes import own_meshes

    project = load_project(subject, files.cell, files.robot)
    for note in own_meshes(project.cell.robot.meshes).notes:
        echo(f"note: the mesh {note}; its link is drawn from the joint frames", err=True)
    plans = PlanMemory(project)
    accepted = refuse(project, plans=plans)
    with shown(False, accepted.steps) as progress:
        session = Session(project, physics=not physics.no_physics, observer=progress, plans=plans)
        progress.follow(session.controller)
        result = session.run()
    for alarm in result.alarms:
        echo(f"the run ended with an alarm: {alarm.code} {alarm.message}", err=True)
    return result.log, 0 if result.ok else MOTION


def _progress() -> Callable[[int, int, str], None]:
    """Return what prints how far the drawing is: the library at first, then every tenth of a film."""
    tenths = 0

    def drawn(done: int, count: int, library: str) -> None:
        nonlocal tenths
        if done == 1:
            echo(f"drawing {count} picture{'s' if count > 1 else ''} with {library}", err=True)
        if count > 1 and 10 * done // count > tenths:
            tenths = 10 * done // count
            echo(f"{done} of {count} pictures", err=True)

    return drawn
