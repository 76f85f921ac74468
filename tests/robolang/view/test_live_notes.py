"""The notes that a page has while a run goes on: those of its end, as soon as they are known."""

from dataclasses import asdict
from itertools import pairwise

import pytest

from robolang.execution.observer import Observer
from robolang.execution.session import Session
from robolang.logs.files import write_log
from robolang.view.live_notes import LiveNotes
from robolang.view.notes import of_run
from tests.runtime.plant.cells import BESIDE, OWN, job

CRASH = "HAND ON\nMOVE P5 + (0, 0, -180), SPEED 500\n"
PUSH = BESIDE + "MOVE P1 + (0, 55, 0), SPEED 50\nMOVE P1 + (0, 80, 0)\nHAND ON\nDELAY 1\n"


class Watching(Observer):
    """Asks for the notes in every cycle."""

    def __init__(self):
        self.notes = LiveNotes()
        self.session = None
        self.news = []

    def cycle_done(self, time_us):
        found = self.notes.news(self.session)
        if found is not None:
            self.news.append((time_us / 1e6, [asdict(each) for each in found]))


def ran(folder, text, *, watched=True):
    watching = Watching()
    session = Session(job(folder, text, OWN), observer=watching if watched else None)
    watching.session = session
    result = session.run()
    watching.cycle_done(session.executor.time_us)
    return watching, result


def happened(notes):
    """What is of the run: what was found in the text has other codes."""
    return [each for each in notes if each["code"] is None or each["code"] >= "RBL400"]


@pytest.mark.physics
@pytest.mark.parametrize("text", [CRASH, PUSH], ids=["stopped by a part", "part pushed"])
def test_live_notes_become_those_of_the_end_and_change_nothing_of_the_run(tmp_path, text):
    watching, result = ran(tmp_path, text)
    end = happened([asdict(each) for each in of_run(result.log.meta)])
    assert {"RBL535", None} <= {each["code"] for each in end}
    assert happened(watching.news[-1][1]) == end
    # each time with something new, and nothing of the future
    rows = [rows for _, rows in watching.news]
    assert all(one != other for one, other in pairwise(rows))
    assert all(each["time_s"] is None or each["time_s"] <= now for now, rows in watching.news for each in rows)
    _, unwatched = ran(tmp_path, text, watched=False)
    written = []
    for each in (result, unwatched):
        write_log(tmp_path / "run.npz", each.log)
        written.append((tmp_path / "run.npz").read_bytes())
    assert written[0] == written[1]


@pytest.mark.physics
def test_a_part_that_was_pushed_is_noted_before_the_end(tmp_path):
    watching, result = ran(tmp_path, PUSH)
    known = min(now for now, rows in watching.news if any(each["code"] == "RBL535" for each in rows))
    ends_s = result.report["sim_time_s"]
    assert known < ends_s - 0.5


def test_statements_that_are_taken_back_take_their_notes_with_them(tmp_path):
    watching, _ = ran(tmp_path, "HAND ON\nDELAY 0.01\nHAND OFF\nHAND ON\nDELAY 0.01\n")
    assert sum(each["text"] == "closed on nothing" for each in watching.news[-1][1]) == 2
    del watching.session.record.statements[2:]
    watching.cycle_done(0)
    assert sum(each["text"] == "closed on nothing" for each in watching.news[-1][1]) == 1
