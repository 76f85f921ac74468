"""A live view of a session: its exchange, its frames and its server, from the first page to the end of the run."""

import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from typing import Any

from robolang.core.storage import strict
from robolang.execution.findings import file_name
from robolang.execution.log_meta import point_poses, robot_of
from robolang.execution.session import Session
from robolang.view.charts import of_live
from robolang.view.exchange import Exchange
from robolang.view.frames import Frames, layout
from robolang.view.guard import LivePage
from robolang.view.joints import ranges
from robolang.view.packing import FORMAT
from robolang.view.server import LiveServer
from runtime.appearance.cell_scene import scene_of
from runtime.control.clock import wall_s
from runtime.core.faults import Fault

FIRST_PAGE_S = 30.0
"""How long a run that is followed waits for its first page, s."""
LAST_PAGE_S = 600.0
"""How long pages are shown the end of a run, s."""
IDLE_S = 0.1


class Live:
    """Pages that follow a session. Hand ``frames`` to the session as its observer, then ``serve`` it."""

    def __init__(self, page: LivePage, port: int = 0, *, watched_only: bool = False) -> None:
        """``port`` 0: any that is free. ``watched_only``: no page may command."""
        self.exchange = Exchange(watched_only=watched_only)
        self.frames = Frames(self.exchange)
        self._page, self._port = page, port
        self._session: Session | None = None
        self._left = False

    @contextmanager
    def serve(self, session: Session) -> Iterator[str]:
        """Serve the page meanwhile; yields its address. ``Fault`` RBL834 for a port that cannot be used."""
        self.follow(session)
        server = LiveServer(self.exchange, self._page, self._port)
        # after the first status: a page that comes at once finds one
        server.start()
        try:
            yield server.url
        finally:
            server.close()

    def follow(self, session: Session) -> None:
        """Show another session from now on, to pages that come later too."""
        self.exchange.greet({"layout": layout(session.controller), "header": header_of(session)})
        self._session = session
        self._settle()
        self.frames.follow(session)

    def show(self) -> None:
        """Show where the session stands now, also after it was taken back."""
        self._settle()
        self.frames.show()

    def _settle(self) -> None:
        """Let the pages have the statements that the record has: what is taken back is seen by no observer."""
        if self._session is None:
            return
        # made apart first, in the words of the frames: pages get only what differs
        story = Exchange()
        record, teller = self._session.record, Frames(story)
        tick_us = self._session.project.profile.tick_us
        for run in record.statements:
            if run.begun:
                teller.run_began(run, run.first_tick * tick_us)
        self.exchange.begun.settle(story.begun)
        self.exchange.notify()

    def wait_for_page(self) -> bool:
        """Wait for the first page, for ``FIRST_PAGE_S`` at most: a run may be over before a browser is there.

        Return whether one has come.
        """
        until = wall_s() + FIRST_PAGE_S
        while not self.exchange.pages and wall_s() < until:
            self.exchange.wait(IDLE_S)
        return bool(self.exchange.pages)

    def remain(self) -> None:
        """Show the end of a run until its pages are closed or ``leave``, for ``LAST_PAGE_S`` at most."""
        until, facts = wall_s() + LAST_PAGE_S, self.frames.extra
        self.frames.extra = lambda: {**facts(), "finished": True}
        self.frames.show()
        while self.exchange.pages and not self._left and wall_s() < until:
            order = self.exchange.take()
            if order is None:
                self.exchange.wait(IDLE_S)
            else:
                self.exchange.reply(order.page, order.id, Fault("RBL836", "the run is over"))

    def leave(self) -> None:
        """End ``remain``; safe to call from a signal handler."""
        self._left = True
        self.exchange.wake()


def header_of(session: Session) -> dict[str, Any]:
    """Return what a page knows of a run before it has begun, in the form of that of a packed run."""
    project, controller = session.project, session.controller
    cell, profile = project.cell, project.profile
    robot = robot_of(cell.robot, cell.hand.X_flange_tool)
    name = file_name(project.source.path)
    header = {
        "format": FORMAT,
        "kind": "live",
        "label": name,
        "duration_s": 0.0,
        "tick_s": profile.tick_s,
        "cycle_s": profile.period_s,
        "thinned": None,
        "meta": {
            "program": {"name": name, "text": project.source.text},
            "robot": robot,
            "scene": scene_of(cell, point_poses(project, controller.kinematics)).as_json(),
            "report": {"robot": cell.robot.name, "servo": profile.servo.mode, "statements": []},
        },
        "signals": [],
        "charts": [asdict(chart) for chart in of_live(robot)],
        "notes": [],
        "joints": [asdict(joint) for joint in ranges(robot["axes"], (), profile.tick_s)],
    }
    # plain JSON: no NaN and no infinite limit of a joint
    plain = strict(header)
    assert isinstance(plain, dict)
    return plain


def open_page(url: str) -> bool:
    """Open an address in a browser with a window of its own; return whether there is one."""
    try:
        browser = webbrowser.get()
    except webbrowser.Error:
        return False
    # one that runs in the terminal would take the terminal away from the run
    if type(browser) is webbrowser.GenericBrowser:
        return False
    return browser.open(url)
