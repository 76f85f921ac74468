"""Programs whose motion does not stop: moves are planned ahead while the arm runs, and nothing of that is seen."""

import numpy as np
import pytest

from robolang.execution import run_bounds
from robolang.execution.dry_run import rehearse
from robolang.execution.status import State
from tests.robolang.execution.standing import ended, session_of, stands

ROUNDS = """SPEED 100
DIM C(2)
FOR K = 1 TO {rounds}
  MOVE P1 + (0, 30 * SIN(12 * K), 30 - 30 * COS(12 * K)), ZONE 8
  {inside}
NEXT
{after}
"""


@pytest.fixture(autouse=True)
def few_ahead(monkeypatch):
    monkeypatch.setattr(run_bounds, "MOST_AHEAD", 16)
    monkeypatch.setattr(run_bounds, "LONG_AHEAD", (16, 0.0))


def program(rounds=60, inside="C(1) = C(1) + 1", after="PRINT C(1)"):
    return ROUNDS.format(rounds=rounds, inside=inside, after=after)


def speeds(session):
    """The speeds of the commanded tool point, mm/s, from its first motion to its last."""
    signals, chain = session.controller.signals(), session.controller.kinematics
    tool = chain.forward(signals["q_cmd"][:: session.project.profile.ticks_per_cycle])[:, :3, 3]
    found = np.linalg.norm(np.diff(tool, axis=0), axis=1) / session.project.profile.period_s * 1e3
    moving = np.flatnonzero(found > 1.0)
    return found[moving[0] : moving[-1]]


def test_the_arm_does_not_stop_where_more_moves_are_planned_and_the_plan_is_the_run(tmp_path):
    session = session_of(tmp_path, program())
    log, report = ended(session)
    assert [text for _, text in session.record.shown] == ["60"]
    # on the circle, which begins with a sharp corner
    assert speeds(session)[300:-15].min() > 90.0
    assert (log, report) == ended(session_of(tmp_path, program()))
    planned = rehearse(session.project)
    assert not planned.refused
    assert len(planned.moves) == 60
    assert planned.total_us == session.executor.time_us
    moves = [row for row in session.record.statements if row.text.startswith("MOVE")]
    begins = [row.first_tick // session.project.profile.ticks_per_cycle * 8_000 for row in moves]
    assert [move.begins_us for move in planned.moves][1:] == begins[1:]
    lasts = [(move.ends_us - move.begins_us) / 1e6 for move in planned.moves]
    assert [row.planned_s for row in moves] == pytest.approx(lasts, abs=0.033)


def test_what_is_kept_of_a_motion_without_end_does_not_grow(tmp_path):
    move = "MOVE P1 + (0, 30 * SIN(12 * K), 30 - 30 * COS(12 * K)), ZONE 8"
    session = session_of(tmp_path, f"SPEED 100\nK = 0\n*RND\nK = K + 1\n{move}\nGOTO *RND\n")
    most = 0
    for _ in range(12):
        session.executor.advance(100)
        now = session.executor._engine.now
        most = max(most, len(now.doing), len(now.places), len(session.controller.requests._statements))
    assert session.executor.status.state is State.RUNNING
    assert len(session.record.statements) > 100
    assert most <= 48


def test_a_refusal_is_answered_when_the_moves_before_it_have_ended(tmp_path):
    inside = "IF K = 30 THEN MOVE P1 + (0, 0, 9000), ZONE 5"
    text = "ON ERROR GOTO *BAD\n" + program(rounds=40, inside=inside, after="END\n*BAD\nPRINT HERE.Z\nRESUME NEXT")
    session = session_of(tmp_path, text)
    assert not rehearse(session.project).refused
    ended(session)
    assert not session.controller.alarms
    (_, height), *others = session.record.shown
    assert not others
    start = session.project.points.get("P1").pose[2]
    # move 30 has turned by 360 deg
    assert float(height) == pytest.approx(start, abs=1e-3)
    assert sum(row.text.startswith("MOVE") for row in session.record.statements) == 40


def test_a_pause_in_it_rests_and_goes_on_without_another_stop(tmp_path):
    whole = session_of(tmp_path, program())
    ended(whole)
    session = session_of(tmp_path, program())
    session.executor.advance(150)
    session.executor.pause()
    stands(session)
    assert not session.controller.moving
    session.executor.resume()
    ended(session)
    stops = np.count_nonzero(np.diff((speeds(session) < 1.0).astype(int)) == 1)
    assert stops == 1
    last = session.controller.signals()["q_cmd"][-1]
    np.testing.assert_array_equal(last, whole.controller.signals()["q_cmd"][-1])


def test_a_stop_ends_it_on_its_path(tmp_path):
    session = session_of(tmp_path, program())
    session.executor.advance(200)
    session.executor.stop()
    ended(session)
    assert [alarm.code for alarm in session.controller.alarms] == ["RBL530"]
