"""A driver whose page is the test: it sends messages, takes turns, and gives the time."""

import json
from types import SimpleNamespace

from robolang.execution.session import Session
from robolang.project.builtin import cell_text
from robolang.project.project import load_project
from robolang.teaching.desk import Desk
from robolang.teaching.documents import load_documents
from robolang.view.driver import Driver
from robolang.view.exchange import Exchange
from robolang.view.frames import Frames
from robolang.view.messages import read_message
from robolang.view.page_teaching import PageTeaching

PROGRAM = """MOVEJ HERE + (0, 0, 20)
FOR N = 1 TO 3
  MOVE HERE + (0, 0, 40), SPEED 200
  MOVE HERE + (0, 0, -40), SPEED 200
NEXT N
OUT(1) = 1
PRINT "done"
"""
INPUT = cell_text() + "\n[inputs.1]\nchanges = [[0, 0]]\n"
CYCLE_S = 0.008
MOST_TURNS = 5000


class Bench:
    """A session that is driven by a page; ``now`` s is the wall time of everything."""

    def __init__(self, folder, monkeypatch, text, *, cell="", by_hand=True, physics=False, pace=None):
        self.now = 1000.0
        for module in ("exchange", "driver", "frames"):
            monkeypatch.setattr(f"robolang.view.{module}.wall_s", lambda: self.now)
        self.path = folder / "p.rbl"
        self.path.write_text(text)
        if cell:
            (folder / "p.cell.toml").write_text(cell)
        teaching = PageTeaching(Desk(load_documents(self.path))) if by_hand else None
        project = teaching.project() if teaching else load_project(self.path)
        self.exchange = Exchange()
        self.frames = Frames(self.exchange)
        self.session = Session(project, physics=physics, observer=self.frames)
        self.driver = Driver(self.session, self.exchange, self.frames, pace=pace, teaching=teaching)
        monkeypatch.setattr(self.exchange, "wait", lambda seconds: None)
        self.page = self.exchange.join()
        self._ids = 0
        if by_hand:
            self.driver.come_to_first()
        self.stood = self.q
        """Where the arm stood before it was jogged."""

    def send(self, word, page=None, **fields):
        """Send a command; its number."""
        self._ids += 1
        text = json.dumps({"do": word, "id": self._ids, **fields})
        self.exchange.receive(page or self.page, read_message(text))
        return self._ids

    def do(self, word, **fields):
        """Send a command and take turns until all rests; the code of the refusal, or None."""
        number = self.send(word, **fields)
        self.rest()
        return self.answer(number).get("code")

    def jog(self, axis="X", sign=1, frame="world", speed=25, step=None):
        return self.send("jog", axis=axis, sign=sign, frame=frame, speed=speed, step=step)

    def jogged(self, axis, step):
        """Jog by a step to its end, away from where the arm stood."""
        number = self.jog(axis, sign=1 if step > 0 else -1, step=abs(step), speed=100)
        self.rest(alive=number)
        assert abs(self.q - self.stood).max() > 1e-3

    def answer(self, number):
        found = [json.loads(text) for text in self.page.said]
        return next((each for each in found if each.get("kind") == "reply" and each["id"] == number), {})

    def turns(self, count, alive=None):
        """Take turns; the page shows that a jog is held all the while."""
        for _ in range(count):
            self.turn(alive)

    def turn(self, alive=None):
        if alive is not None:
            self.send("alive", jog=alive)
        self.now += CYCLE_S
        return self.driver.turn()

    def rest(self, alive=None):
        """Take turns until nothing moves; how many it took."""
        for count in range(1, MOST_TURNS):
            self.turn(alive)
            if self.facts.doing == "nothing":
                return count
        raise AssertionError("it does not come to rest")

    @property
    def q(self):
        return self.session.controller.areas.ina.copy()

    @property
    def facts(self):
        return SimpleNamespace(**json.loads(self.exchange.status[1]))
