"""``robolang view PROG``: a program on a live page, with a pendant: run, step, jog, teach."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

from robolang.cli.errors import reported
from robolang.cli.live_options import PageOptions, announce
from robolang.cli.options import CellOptions, Group, Option, PhysicsOptions, Program
from robolang.cli.refuse import refuse_text
from robolang.cli.signals import handled
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.execution.session import Session
    from robolang.view.driver import Driver

_BY_SIGNAL = 128
"""Added to the number of a signal in the exit code."""


class _PaceOptions(Group):
    """How fast the program runs."""

    PANEL: ClassVar[str] = "Simulation"
    speed: Annotated[
        float, Option("--speed", metavar="X", low=0.05, high=20.0, help="Simulated time in s per s of wall time.")
    ] = 1.0


def view(program: Program, files: CellOptions, page: PageOptions, physics: PhysicsOptions, pace: _PaceOptions) -> None:
    """Show a program live in a browser, paused at its start, with the buttons of a pendant.

    Taught points are saved at once. End on the page, or Ctrl-C, brings the arm to rest and ends the command.

    Example: robolang view pick_and_place.rbl --speed 0.5

    Exit codes: 0 ended by the page; 1 the program has errors; 2 a file, an option or the port cannot be used; 130 or
    143 ended by a signal.
    """
    # NaN passes the range of an option
    if not math.isfinite(pace.speed):
        raise OptionValueError("--speed", f"{pace.speed:g} is no speed")
    with reported():
        from robolang.execution.session import Session
        from robolang.teaching.desk import Desk
        from robolang.teaching.documents import load_documents
        from robolang.view.driver import Driver
        from robolang.view.live import Live
        from robolang.view.live_page import live_page
        from robolang.view.pace import Pace
        from robolang.view.page import Bundle
        from robolang.view.page_teaching import PageTeaching

        cell = None if files.cell is None else Path(files.cell)
        teaching = PageTeaching(Desk(load_documents(Path(program), cell, files.robot)), files.robot)
        project = teaching.project()
        # not its motion: what cannot be planned is an alarm at its place, and the pendant can mend the point
        refuse_text(project)
        live = Live(live_page(Bundle.installed()), page.port or 0)
        session = Session(project, physics=not physics.no_physics, observer=live.frames)
        driver = Driver(session, live.exchange, live.frames, pace=Pace(pace.speed), teaching=teaching)
        with live.serve(session) as url, _left_by_signals(driver, session) as received:
            announce(url, page)
            driver.work()
    raise SystemExit(_BY_SIGNAL + received[0] if received else 0)


@contextmanager
def _left_by_signals(driver: "Driver", session: "Session") -> Iterator[list[int]]:
    """Leave at the first Ctrl-C or SIGTERM once the arm rests, at the second at once; yields the signals received."""
    received: list[int] = []

    def handle(number: int, _frame: object) -> None:
        received.append(number)
        if len(received) > 1:
            session.request_halt()
        driver.leave()

    with handled(handle):
        yield received
