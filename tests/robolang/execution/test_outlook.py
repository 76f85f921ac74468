"""The time that a run has left, against what it then takes, and where nothing is known of it."""

from dataclasses import replace

import pytest

from robolang.execution.dry_run import rehearse
from robolang.execution.observer import Observer
from robolang.execution.outlook import Outlook
from robolang.execution.plan_memory import PlanMemory
from robolang.execution.session import Session
from robolang.project.project import load_project
from tests.robolang.cli.commands import BUILTIN

CELL = (BUILTIN / "cell.toml").read_text() + "\n[inputs.1]\nchanges = [[0, 0], [0.5, 1]]\n"
SETTLE_S = 0.4


class Watched(Observer):
    """An observer that notes the time left in every cycle."""

    def __init__(self, steps):
        self.outlook, self.seen = Outlook(steps), []

    def run_began(self, run, time_us):
        self.outlook.began(run, time_us)

    def cycle_done(self, time_us):
        self.seen.append((time_us / 1e6, self.outlook.left(time_us)))


def watched(path, text, steps=None):
    path.write_text(text)
    project = load_project(path)
    plans = PlanMemory(project)
    rehearsal = rehearse(project, plans=plans)
    assert rehearsal.refused == ()
    found = Watched(rehearsal.steps if steps is None else steps)
    assert Session(project, physics=False, observer=found, plans=plans).run().ok
    return found.seen, rehearsal


def steps_of(path, text):
    path.write_text(text)
    return rehearse(load_project(path)).steps


@pytest.fixture
def program(tmp_path):
    (tmp_path / "p.cell.toml").write_text(CELL)
    return tmp_path / "p.rbl"


LOOP = """FOR I = 1 TO 3
  MOVEJ JOINT(0, 0, 0, 0, I * 10, 0)
  DELAY 0.2
NEXT I
PRINT "there"
HAND ON
"""


@pytest.mark.parametrize("text", [LOOP, "DELAY 1\n", "MOVEJ JOINT(0, 0, 0, 0, 30, 0), ZONE 20\n" + LOOP])
def test_what_is_left_is_what_the_run_then_takes(program, text):
    seen, rehearsal = watched(program, text)
    end = seen[-1][0]
    moves = len(rehearsal.moves)
    for now, left in seen:
        assert not left.waiting
        # a move takes longer than its plan by what it needs to come into position
        assert -0.009 <= end - now - left.seconds <= SETTLE_S * moves + 1e-9
    assert seen[0][1].seconds == pytest.approx(rehearsal.total_us / 1e6, abs=0.009)
    assert seen[-1][1].seconds == pytest.approx(0.0, abs=0.009)


WAITING = "WAIT IN(1) = 1\nDELAY 0.3\n"


def test_a_wait_takes_the_time_of_its_inputs(program):
    seen, rehearsal = watched(program, WAITING)
    assert [step.waits for step in rehearsal.steps] == [True, False]
    assert rehearsal.steps[0].ends_us == pytest.approx(500_000, abs=16_000)
    assert all(left.seconds == pytest.approx(seen[-1][0] - now, abs=0.02) for now, left in seen)


def test_a_wait_that_takes_longer_than_planned_says_what_comes_after_it(program):
    first, after = steps_of(program, WAITING)
    short = replace(first, ends_us=100_000), replace(after, begins_us=100_000, ends_us=400_000)
    seen, _ = watched(program, WAITING, short)
    assert {left.waiting for now, left in seen if now < 0.09} == {False}
    late = [left for now, left in seen if 0.11 < now < 0.49]
    assert {left.waiting for left in late} == {True}
    assert {left.seconds for left in late} == {0.3}


@pytest.mark.parametrize("count", [0, 1, 3])
def test_a_wait_may_be_in_the_run_or_in_the_plan_alone(program, count):
    """The plan has no WAIT, or others than the run; the statement after them is the planned one."""
    (other,) = steps_of(program, "' a line before it\nWAIT IN(1) = 1\n")
    own = steps_of(program, WAITING)[-1]
    seen, _ = watched(program, WAITING, (*[other] * count, own))
    assert seen[-1][1].seconds == pytest.approx(0.0, abs=0.009)


def test_of_another_course_nothing_is_known(program):
    other = steps_of(program, "DELAY 0.1\nMOVEJ JOINT(0, 0, 0, 0, 10, 0)\nDELAY 5\n")
    seen, _ = watched(program, "DELAY 0.1\nDELAY 0.2\n", other)
    known = [now for now, left in seen if left is not None]
    assert max(known) == pytest.approx(0.1, abs=0.009)
    assert [left for now, left in seen if now > 0.12] == [None] * sum(now > 0.12 for now, _ in seen)


def test_a_statement_after_the_last_planned_step_is_another_course(program):
    seen, _ = watched(program, "DELAY 0.1\nDELAY 0.2\n", steps_of(program, "DELAY 0.1\n"))
    assert seen[-1][1] is None


def test_without_a_step_nothing_is_left():
    assert Outlook(()).left(8_000).seconds == 0.0
