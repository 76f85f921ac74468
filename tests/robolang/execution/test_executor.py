"""The executor: it advances by cycles, pauses on the path, is fed, and goes back to snapshots, bit for bit."""

import random

import numpy as np
import pytest

from robolang.core.source import Source, Span
from robolang.execution import run_bounds
from robolang.execution.observer import Observer
from robolang.execution.session import Session
from robolang.execution.status import ENDED, State
from robolang.project.project import load_project
from tests.campaign import size, some
from tests.messages import numbers
from tests.programs.runs import PROGRAMS, ROOT
from tests.robolang.execution.standing import log_of


def project_of(tmp_path, text):
    (tmp_path / "p.rbl").write_text(text)
    return load_project(tmp_path / "p.rbl")


def fed(text):
    """A statement as a prompt has it."""
    return Source("prompt", text)


def ended(session):
    """The log and the report of a session that is carried out to its end."""
    while session.executor.advance(100).state not in ENDED:
        pass
    return log_of(session), session.result(0.0).report


STOPS = size(200, 4)
"""Random stops: the figure of the campaign, and of a sample."""


@pytest.mark.physics
@pytest.mark.parametrize("number", range(STOPS))
def test_from_a_snapshot_on_the_same_bytes_follow(number):
    """Stop at a random cycle, keep it, go on for 50 cycles, go back and go on again."""
    chance = random.Random(number)
    path = chance.choice(PROGRAMS)
    session = Session(load_project(path))
    stopped = session.executor.advance(chance.randrange(1, 600))
    kept = session.executor.snapshot()
    went = session.executor.advance(50)
    first = log_of(session)
    session.executor.advance(chance.randrange(40))
    session.executor.restore(kept)
    assert session.executor.status == stopped
    assert session.executor.advance(50) == went
    assert log_of(session) == first


BACK = [ROOT / "shop/sort.rbl", ROOT / "shop/tend.rbl", ROOT / "wrist/seam.rbl"]


@pytest.mark.parametrize("path", some(BACK, 1, 2), ids=lambda path: path.stem)
def test_a_run_that_goes_back_again_and_again_ends_as_one_that_does_not(path):
    """Steps back by restoring: log and report of the whole run are those of an uninterrupted one."""
    whole = ended(Session(load_project(path), physics=False))
    session = Session(load_project(path), physics=False)
    kept = []
    for _ in range(8):
        kept.append(session.executor.snapshot())
        session.executor.advance(97)
    for snapshot in (kept[6], kept[1], kept[5], kept[0], kept[3]):
        session.executor.restore(snapshot)
        session.executor.advance(30)
    assert ended(session) == whole
    session.executor.restore(kept[2])
    assert ended(session) == whole


def test_a_run_step_by_step_is_the_run():
    path = ROOT / "shop/palletise.rbl"
    whole, session = (Session(load_project(path), physics=False) for _ in range(2))
    assert whole.run().ok
    while session.executor.advance().state not in ENDED:
        pass
    assert log_of(session) == log_of(whole)
    assert session.executor.status.state is State.DONE


class Everything(Observer):
    """Keeps what it sees."""

    def __init__(self):
        self.seen = []

    def statement_began(self, statement):
        self.seen.append(f"{statement.line} {type(statement.node).__name__}")

    def run_began(self, run, time_us):
        self.seen.append(f"began {run.text}")

    def effect_done(self, effect):
        self.seen.append(f"done {type(effect).__name__}")

    def cycle_done(self, time_us):
        if self.seen[-1] != "cycles":
            self.seen.append("cycles")

    def alarm(self, alarm):
        self.seen.append(alarm.code)

    def printed(self, text):
        self.seen.append(f"printed {text}")


def test_an_observer_sees_every_statement_and_what_becomes_of_it(tmp_path):
    observer = Everything()
    project = project_of(tmp_path, "X = 2\nPRINT X\nZONE 30\nMOVE P1\nMOVE P2\nDELAY 0.1\nX = 1 / (X - 2)\n")
    assert not Session(project, physics=False, observer=observer).run().ok
    assert observer.seen == [
        "1 Assign",
        "2 Print",
        "began PRINT X",
        "printed 2",
        "done Show",
        "3 Setting",
        "4 Move",
        "5 Move",
        "6 Delay",
        "began MOVE P1",
        "cycles",
        "began MOVE P2",
        "cycles",
        "done MoveTo",
        "done MoveTo",
        "began DELAY 0.1",
        "cycles",
        "done Pass",
        "7 Assign",
        "RBL501",
        "cycles",
    ]


def test_a_stop_ends_the_program_and_says_so():
    session = Session(load_project(PROGRAMS[0]), physics=False)
    session.executor.advance(100)
    session.executor.stop()
    while session.executor.advance().state not in ENDED:
        pass
    assert session.executor.status.state is State.STOPPED
    assert [alarm.code for alarm in session.result(0.0).alarms] == ["RBL530"]
    with pytest.raises(RuntimeError):
        session.executor.feed(fed("PRINT 1"))


def test_a_wait_is_a_state_of_its_own(tmp_path):
    session = Session(project_of(tmp_path, "DELAY 0.1\nWAIT TIMER > 0.2\n"), physics=False)
    assert session.executor.advance(5).state is State.RUNNING
    status = session.executor.advance(15)
    assert (status.state, status.statement.line, status.time_us) == (State.WAITING, 2, 160_000)
    assert session.executor.advance(100).state is State.DONE


def test_statements_are_fed_where_the_program_stands(tmp_path):
    seen = Everything()
    session = Session(project_of(tmp_path, "X = 1\nDELAY 0.1\nPRINT X\n"), physics=False, observer=seen)
    executor = session.executor
    executor.pause()
    assert executor.advance().state is State.PAUSED
    executor.feed(fed("MOVE P1"))
    with pytest.raises(RuntimeError):
        executor.advance(1)
        executor.feed(fed("PRINT 1"))
    while executor.advance().state is State.RUNNING:
        pass
    assert executor.status.state is State.PAUSED
    went = executor.status.time_us
    assert executor.advance(10).time_us == went > 100_000
    executor.feed(fed("X = 1 / 0"))
    assert executor.advance(10).fault.code == "RBL501"
    executor.feed(fed("PRINT TIMER"))
    assert executor.advance(10).fault is None
    executor.resume()
    assert executor.advance(100).state is State.DONE
    executor.feed(fed("PRINT X + 1"))
    executor.advance(10)
    assert [text for text in seen.seen if text.startswith("printed")] == [
        f"printed {went / 1e6:g}",
        "printed 1",
        "printed 2",
    ]


def commanded(session):
    """The commanded tool points (ticks, 3), m."""
    q = session.controller.signals()["q_cmd"]
    return session.controller.tool_poses(q)[:, :3, 3]


def paused_at(project, cycle, physics=False):
    """A session whose arm rests after a pause at a cycle."""
    session = Session(project, physics=physics)
    session.executor.advance(cycle)
    session.executor.pause()
    while (state := session.executor.advance().state) is not State.PAUSED:
        assert state not in ENDED
    return session


MOVES = (
    "SPEED 400\nMOVE P1\nMOVEC P1 + (60, 60, 0), P1 + (0, 120, 0)\n"
    "SPLINE (P1 + (0, 120, 60), P1 + (60, 120, 80), P1 + (0, 60, 0))\nMOVE P2, ZONE 40\nMOVE P1\n"
)


@pytest.mark.parametrize("cycle", range(7, 400, size(13, 131)))
def test_a_pause_rests_on_the_path_and_the_move_goes_on_where_it_rests(tmp_path, cycle):
    project = project_of(tmp_path, MOVES)
    whole = Session(project, physics=False)
    assert whole.run().ok
    session = paused_at(project, cycle)
    resting = session.executor.status
    assert session.executor.advance(10) == resting
    kept = session.executor.snapshot()
    session.executor.resume()
    (log, report), points = ended(session), commanded(session)
    assert report["ok"], report["alarms"]
    path = commanded(whole)
    far = np.array([np.sqrt(((path - point) ** 2).sum(axis=1).min()) for point in points[::7]])
    step = np.sqrt((np.diff(path, axis=0) ** 2).sum(axis=1)).max()
    assert far.max() <= step / 2 + 1e-5  # no farther from a tick of the plan than its neighbours are
    for run, other in zip(session.record.statements, whole.record.statements, strict=True):
        assert run.text == other.text
        if run.path is not None and "ZONE" not in run.text and run is not session.record.statements[-1]:
            off = run.path.deviation(points[run.first_tick : run.end_tick]).max()
            assert off <= other.path.deviation(path[other.first_tick : other.end_tick]).max() + 2e-6
    np.testing.assert_array_equal(session.controller.areas.ina, whole.controller.areas.ina)
    limits = session.controller.spec.per_axis("limits", "acceleration")
    dq = session.controller.signals()["dq_cmd"]
    assert (np.abs(np.diff(dq, axis=0)) / 1e-3 <= limits * 1.05).all()
    session.executor.restore(kept)
    session.executor.resume()
    assert ended(session) == (log, report)


def test_a_pause_holds_dwells_and_waits(tmp_path):
    project = project_of(tmp_path, "DELAY 0.4\nWAIT TIMER > 0.6, TIMEOUT 1\nPRINT TIMER\n")
    whole = ended(Session(project, physics=False))
    for cycle in (20, 60):
        session = paused_at(project, cycle)
        assert session.executor.status.time_us == cycle * 8000
        session.executor.resume()
        assert ended(session) == whole


@pytest.mark.parametrize("resumed", [False, True])
def test_a_pause_can_be_resumed_or_stopped_before_the_arm_rests(tmp_path, resumed):
    session = Session(project_of(tmp_path, MOVES), physics=False)
    session.executor.advance(40)
    session.executor.pause()
    assert session.executor.advance(2).state is State.RUNNING
    if resumed:
        session.executor.resume()
        assert ended(session)[1]["ok"]
    else:
        session.executor.stop()
        assert [alarm["code"] for alarm in ended(session)[1]["alarms"]] == ["RBL530"]


@pytest.mark.physics
def test_a_pause_rests_with_physics_too_and_under_a_seam_sensor_at_the_end_of_the_move():
    session = paused_at(load_project(ROOT / "pick_and_place.rbl"), 200, physics=True)
    session.executor.resume()
    assert ended(session)[1]["ok"]
    session = paused_at(load_project(ROOT / "wrist/seam.rbl"), 150)
    session.executor.resume()
    assert ended(session)[1]["ok"]


def carried_out(executor, text):
    """The status after a statement of a prompt."""
    executor.feed(fed(text))
    while executor.advance().state not in (*ENDED, State.PAUSED):
        pass
    return executor.status


@pytest.mark.physics
@pytest.mark.parametrize("physics", [False, True])
@pytest.mark.parametrize(
    ("text", "code", "cycles"), [("X = 0\nMOVE P1\nX = 1 / X\n", "RBL501", None), ("MOVE P1\nMOVE P2\n", "RBL530", 60)]
)
def test_after_an_alarm_is_acknowledged_statements_are_fed_again(tmp_path, physics, text, code, cycles):
    """The program stays ended, moves begin where the arm stands, and the record keeps the alarm."""
    session = Session(project_of(tmp_path, text), physics=physics)
    executor = session.executor
    if cycles is not None:
        executor.advance(cycles)
        executor.stop()
    with pytest.raises(RuntimeError):
        executor.acknowledge()
    while executor.advance().state not in ENDED:
        pass
    with pytest.raises(RuntimeError):
        executor.feed(fed("MOVE P2"))
    executor.acknowledge()
    assert (executor.status.state, executor.status.fault) == (State.DONE, None)
    np.testing.assert_array_equal(executor.world.q_last, session.controller.areas.ina)
    acknowledged = executor.snapshot()
    assert carried_out(executor, "MOVE P2 + (0, 0, 20)").fault is None
    (log, report) = ended_by_resume(session)
    assert executor.status.state is State.DONE
    assert [alarm["code"] for alarm in report["alarms"]] == [code]
    assert not report["ok"]
    speed = session.controller.signals()["dq_cmd"]
    assert np.isfinite(speed).all()
    executor.restore(acknowledged)
    assert carried_out(executor, "MOVE P2 + (0, 0, 20)").fault is None
    assert ended_by_resume(session) == (log, report)


def ended_by_resume(session):
    """The log and the report of a session that is resumed after a pause."""
    session.executor.resume()
    return ended(session)


@pytest.mark.physics
@pytest.mark.parametrize("physics", [False, True])
def test_after_a_run_that_was_too_long_statements_have_as_long_again(tmp_path, monkeypatch, physics):
    monkeypatch.setattr(run_bounds, "MAX_RUN_US", 800_000)
    session = Session(project_of(tmp_path, "X = 1\n*TOP DELAY 0.08\nGOTO *TOP\n"), physics=physics)
    executor = session.executor
    while executor.advance().state not in ENDED:
        pass
    assert (executor.status.state, executor.status.fault.code) == (State.ALARM, "RBL509")
    executor.acknowledge()
    began = executor.status.time_us
    for text in ("PRINT X", "MOVE P1", "DELAY 0.04"):
        status = carried_out(executor, text)
        assert (status.state, status.fault) == (State.PAUSED, None)
    late = carried_out(executor, "WAIT X = 2")
    assert (late.state, late.fault.code, late.fault.origin.span) == (State.ALARM, "RBL509", Span(0, 10))
    assert numbers(late.fault.message)[0] == pytest.approx((began + 800_000) / 1e6)
    assert [alarm["code"] for alarm in session.result(0.0).report["alarms"]] == ["RBL509", "RBL509"]


def test_a_jump_that_is_fed_after_an_alarm_takes_the_program_up_there(tmp_path):
    """Names keep their values: at the second time line 30 divides by 1."""
    session = Session(project_of(tmp_path, "10 X = 0\n20 X = X + 1\n30 Y = 1 / (X - 1)\n"), physics=False)
    assert session.executor.advance(1000).state is State.ALARM
    session.executor.acknowledge()
    assert carried_out(session.executor, "GOTO 20").fault is None
    session.executor.resume()
    while session.executor.advance().state not in ENDED:
        pass
    assert session.executor.status.state is State.DONE


@pytest.mark.physics
def test_with_physics_a_run_that_goes_back_ends_as_one_that_does_not(tmp_path):
    """A blend, a hand that closes on nothing, a wait: log and report of the whole run, after several restores."""
    text = "MOVE P1, ZONE 20\nMOVE P1 + (0, 40, 0)\nHAND ON\nWAIT TIMER > 1\nMOVE P1\n"
    whole = ended(Session(project_of(tmp_path, text)))
    session = Session(project_of(tmp_path, text))
    kept = []
    for _ in range(4):
        kept.append(session.executor.snapshot())
        session.executor.advance(41)
    for number in (2, 0, 3, 1):
        session.executor.restore(kept[number])
        session.executor.advance(23)
    assert ended(session) == whole
