"""What is done while a motion rests on its path: fed statements, set-points of one's own, the return to the path."""

from itertools import product

import numpy as np
import pytest

from robolang.execution.executor import RegainLimits
from robolang.execution.session import Session
from robolang.execution.status import ENDED, State
from robolang.project.project import load_project
from runtime.core.faults import Fault
from runtime.core.units import DEG
from tests.campaign import some
from tests.programs.runs import ROOT
from tests.robolang.execution.standing import (
    by_hand,
    dump,
    ended,
    fed,
    jogged,
    log_of,
    paused_after,
    session_of,
    shown,
    stands,
    stops_at,
    there_and_back,
)

MOVES = "\n".join(
    [
        "SPEED 300",
        "MOVE P1 + (0, 0, 90)",
        "MOVE P1 + (0, 60, 90), ZONE 20",
        "MOVE P2 + (0, 0, 90), ZONE 20",
        "MOVE P1 + (0, 0, 90)",
        "PRINT HERE.X",
    ]
)


def commanded(session):
    return session.controller.signals()["q_cmd"]


def planned(session):
    return session.controller.signals()["q_plan"][::8]


def moved(rows):
    """The set-points that differ from the one before."""
    return rows[np.append(True, (np.diff(rows, axis=0) != 0.0).any(axis=1))]


def regained(session, **limits):
    session.executor.regain(**limits)
    return stands(session)


# --- play ------------------------------------------------------------------------------------------------------------


@pytest.mark.physics
@pytest.mark.parametrize("physics", [False, True])
def test_set_points_are_played_between_statements_and_the_program_stands_where_it_stood(tmp_path, physics):
    session = session_of(tmp_path, "X = 1\nMOVE P1\nPRINT X\n", physics)
    executor = session.executor
    stops_at(session, 3)
    rows, origin = there_and_back(session), by_hand("jog J1 +1")
    began = executor.time_us
    executor.play(rows, origin, "jog J1 +1")
    assert executor.advance(10).state is State.RUNNING
    assert executor.status.statement == origin
    assert (stands(session).state, executor.origin.line) == (State.PAUSED, 3)
    assert executor.time_us - began >= len(rows) * 8000
    np.testing.assert_array_equal(planned(session)[began // 8000 : began // 8000 + len(rows)], rows)
    np.testing.assert_array_equal(executor.world.q_last, rows[-1])
    run = session.record.statements[-1]
    assert (run.text, run.origin, run.begun) == ("jog J1 +1", origin, True)
    assert (run.end_tick - run.first_tick) * 1000 >= len(rows) * 8000
    executor.resume()
    assert ended(session)[1]["ok"]
    assert shown(session) == ["1"]


def test_set_points_are_played_in_a_wait_after_the_end_and_after_an_alarm(tmp_path):
    session = session_of(tmp_path, "DELAY 0.4\nMOVE P1\nX = 1 / (TIMER - TIMER)\n")
    executor = session.executor
    paused_after(session, 20)
    assert jogged(session).state is State.PAUSED
    assert executor.status.statement.line == 1
    executor.resume()
    assert stands(session).state is State.ALARM
    with pytest.raises(RuntimeError):
        jogged(session)
    executor.acknowledge()
    assert jogged(session).state is State.PAUSED
    delay, jog = session.record.statements[:2]
    assert [run.text for run in session.record.statements] == ["DELAY 0.4", "jog J1 +1", "MOVE P1", "jog J1 +1"]
    assert (delay.end_tick - delay.first_tick) - (jog.end_tick - jog.first_tick) == 400
    session = session_of(tmp_path, "PRINT 1\n")
    stands(session)
    assert jogged(session).state is State.PAUSED
    session.executor.resume()
    assert stands(session).state is State.DONE


@pytest.mark.parametrize("cycle", [1, 7, 20, 33, 58])
def test_a_pause_slows_played_set_points_down_at_once(tmp_path, cycle):
    session = session_of(tmp_path, "X = 1\n")
    stands(session)
    executor, most = session.executor, 0.4
    rows = there_and_back(session, most=most, cycles=80, back=False)
    executor.play(rows, by_hand("jog"), "jog")
    executor.advance(cycle)
    sent = planned(session)
    executor.pause()
    executor.advance(3)
    went, would = planned(session)[-1][0] - sent[-1][0], rows[cycle + 2][0] - rows[cycle - 1][0]
    assert 0.0 <= went < would
    assert stands(session).state is State.PAUSED
    rests = session.controller.areas.ina[0]
    assert rests < rows[-1][0]
    kept = executor.snapshot()
    for text in ("PRINT 1", "MOVE P1"):
        with pytest.raises(RuntimeError):
            executor.feed(text)
    executor.resume()
    assert stands(session).state is State.PAUSED
    np.testing.assert_array_equal(session.controller.areas.ina, rows[-1])
    executor.restore(kept)
    executor.abandon()
    assert executor.advance(10).state is State.PAUSED
    assert session.controller.areas.ina[0] == rests == executor.world.q_last[0]
    assert fed(session, "MOVE P2").fault is None
    with pytest.raises(RuntimeError):
        executor.abandon()


def test_what_cannot_be_played_changes_nothing(tmp_path):
    session = session_of(tmp_path, MOVES)
    executor = session.executor
    executor.advance(20)
    rows = there_and_back(session)
    with pytest.raises(RuntimeError):
        executor.play(rows, by_hand("jog"), "jog")
    paused_after(session, 30)
    before, log = dump(executor.snapshot()), log_of(session)
    for bad, error in ((rows + 9.0, Fault), (rows[:, :3], ValueError), (rows * np.nan, ValueError)):
        with pytest.raises(error):
            executor.play(bad, by_hand("jog"), "jog")
    assert (dump(executor.snapshot()), log_of(session)) == (before, log)
    with pytest.raises(RuntimeError):
        executor.abandon()


def test_an_alarm_while_set_points_are_played_ends_the_program_and_it_can_be_begun_again(tmp_path):
    session = session_of(tmp_path, "MOVE P1\nMOVE P2\nPRINT 1\n")
    executor = session.executor
    stops_at(session, 2)
    executor.play(there_and_back(session), by_hand("jog"), "jog")
    executor.advance(10)
    executor.stop()
    assert stands(session).alarm.statement == by_hand("jog")
    executor.acknowledge()
    executor.begin_again()
    assert (executor.status.state, executor.origin.line) == (State.PAUSED, 2)
    executor.stops_before = None
    executor.resume()
    assert stands(session).state is State.DONE
    assert shown(session) == ["1"]


# --- a motion that is set aside --------------------------------------------------------------------------------------


FED = [
    (cycle, what) for cycle in (40, 110, 150, 200, 260) for what in ("PRINT 1", "X = 5", "HAND ON, 0.1", "OUT(1) = 1")
]


@pytest.mark.parametrize(("cycle", "what"), some(FED, 0, 5, 10, 15, 18))
def test_what_is_fed_within_a_move_leaves_the_path_as_it_is(tmp_path, cycle, what):
    """The same set-points, and the same rows of the record, as of a pause alone."""
    alone = session_of(tmp_path, MOVES)
    paused_after(alone, cycle)
    assert alone.executor.displaced.joint_deg == 0.0
    alone.executor.resume()
    ended(alone)
    session = session_of(tmp_path, MOVES)
    paused_after(session, cycle)
    assert fed(session, what).fault is None
    assert session.executor.displaced.joint_deg == 0.0
    kept = session.executor.snapshot()
    for _ in range(2):
        session.executor.resume()
        _, report = ended(session)
        assert report["ok"]
        rows, others = moved(planned(session)), moved(planned(alone))
        np.testing.assert_array_equal(rows, others)
        assert shown(session)[-1:] == shown(alone)[-1:]
        moves = [run for run in session.record.statements if run.text.startswith("MOVE")]
        assert len(moves) in (4, 5)  # one of the four is carried out in two parts, unless it rested at its end
        assert all(run.begun and run.first_tick <= run.end_tick for run in moves)
        ticks = [tick for run in moves for tick in (run.first_tick, run.end_tick)]
        assert ticks == sorted(ticks)
        session.executor.restore(kept)


@pytest.mark.physics
@pytest.mark.parametrize(("cycle", "physics"), some([*product((60, 150, 200), (False, True))], 0, 3, 4))
def test_a_displaced_arm_regains_its_path_and_goes_on_as_planned(tmp_path, cycle, physics):
    session = session_of(tmp_path, MOVES, physics)
    executor = session.executor
    paused_after(session, cycle)
    left, statement = np.array(session.controller.areas.ina), executor.status.statement
    assert jogged(session, most=4.0 * DEG, back=False).state is State.PAUSED
    far = executor.displaced
    assert far.joint_deg == pytest.approx(4.0)
    X, X_left = session.controller.tool_poses(session.controller.areas.ina), session.controller.tool_poses(left)
    assert far.distance_mm == pytest.approx(1e3 * np.linalg.norm(X[:3, 3] - X_left[:3, 3]))
    assert far.angle_deg == pytest.approx(4.0)
    before = dump(executor.snapshot())
    with pytest.raises(Fault) as refused:
        executor.resume()
    assert refused.value.code == "RBL540"
    with pytest.raises(Fault) as refused:
        executor.regain(RegainLimits(joint_deg=3.9))
    assert refused.value.code == "RBL541"
    with pytest.raises(Fault):
        executor.regain(RegainLimits(distance_mm=float("nan")))
    assert dump(executor.snapshot()) == before
    assert executor.advance(5).state is State.PAUSED
    began = len(commanded(session))
    assert regained(session).state is State.PAUSED
    points = session.controller.tool_poses(commanded(session)[began:])[:, :3, 3]
    assert np.linalg.norm(np.diff(points, axis=0), axis=1).max() / 1e-3 <= 0.2502
    assert (executor.displaced.joint_deg, session.record.statements[-1].origin) == (0.0, statement)
    np.testing.assert_array_equal(session.controller.areas.ina, left)
    assert executor.regain() is False
    executor.resume()
    alone = session_of(tmp_path, MOVES, physics)
    paused_after(alone, cycle)
    alone.executor.resume()
    _, report = ended(session)
    ended(alone)
    assert report["ok"], report["alarms"]
    here, there = (np.flatnonzero((planned(each) == left).all(axis=1))[-1] for each in (session, alone))
    np.testing.assert_array_equal(planned(session)[here : here + 40], planned(alone)[there : there + 40])


def test_a_move_that_is_fed_within_a_move_leaves_its_path_and_a_jump_forgets_it(tmp_path):
    session = session_of(tmp_path, "MOVE P1\nMOVE P2\nEND\n*A PRINT 5\n")
    executor = session.executor
    paused_after(session, 40)
    fed(session, "MOVE P2")
    assert executor.displaced.joint_deg > 1.0
    kept = executor.snapshot()
    fed(session, "GOTO *A")
    assert executor.displaced is None
    executor.resume()
    assert (stands(session).state, shown(session)) == (State.DONE, ["5"])
    executor.restore(kept)
    executor.stop()
    stands(session)
    executor.acknowledge()
    assert executor.displaced is None
    executor.begin_again()
    assert executor.origin.line == 1
    executor.resume()
    assert stands(session).state is State.DONE


def test_a_motion_within_a_fed_call_is_held_as_well(tmp_path):
    session = session_of(tmp_path, "MOVE P1\nPRINT 1\nEND\nSUB S()\nMOVE P2\nPRINT 2\nENDSUB\n")
    executor = session.executor
    paused_after(session, 40)
    executor.feed("CALL S()")
    paused_after(session, 30)
    assert executor.origin.line == 5
    jogged(session, most=0.01, back=False)
    regained(session)
    executor.resume()
    stands(session)
    assert shown(session) == ["2"]
    assert executor.displaced.joint_deg > 1.0
    regained(session, limits=RegainLimits(distance_mm=1e4, joint_deg=360.0))
    executor.resume()
    assert stands(session).state is State.DONE
    assert shown(session) == ["2", "1"]


def test_where_nothing_is_held_nothing_is_regained(tmp_path):
    session = session_of(tmp_path, "MOVE P1\nPRINT 1\n")
    stops_at(session, 2)
    assert session.executor.displaced is None
    with pytest.raises(RuntimeError):
        session.executor.regain()


# --- begin again -----------------------------------------------------------------------------------------------------


def stopped_at(session, cycles):
    session.executor.advance(cycles)
    session.executor.stop()
    assert stands(session).state is State.STOPPED
    return session.executor


@pytest.mark.physics
@pytest.mark.parametrize(("at", "physics"), some([*product(((40, 2), (110, 3), (160, 5)), (False, True))], 0, 3, 4))
def test_a_move_of_a_chain_is_begun_again_with_the_names_as_they_were(tmp_path, physics, at):
    cycles, line = at
    text = "X = 1\nMOVE P1\nMOVE P1 + (0, 60, 0), ZONE 20\nX = X + 1\nMOVE P2, ZONE 20\nX = X + 1\nMOVE P1\nPRINT X\n"
    session = session_of(tmp_path, text, physics)
    executor = stopped_at(session, cycles)
    assert executor.status.statement.line == line
    with pytest.raises(Fault) as refused:
        executor.begin_again()
    assert refused.value.code == "RBL542"
    executor.acknowledge()
    executor.begin_again()
    assert (executor.status.state, executor.origin.line, executor.status.alarm) == (State.PAUSED, line, None)
    kept = executor.snapshot()
    for _ in range(2):
        executor.resume()
        assert stands(session).state is State.DONE
        assert shown(session) == ["3"]
        np.testing.assert_allclose(
            session.controller.tool_poses(session.controller.areas.ina),
            session.controller.tool_poses(executor.world.q_last),
        )
        executor.restore(kept)


def test_what_is_fed_after_the_alarm_counts(tmp_path):
    session = session_of(tmp_path, "X = 0\nY = 1 / X\nPRINT Y\n")
    executor = session.executor
    assert stands(session).state is State.ALARM
    executor.acknowledge()
    fed(session, "X = 4")
    executor.begin_again()
    assert executor.origin.line == 2
    executor.resume()
    assert stands(session).state is State.DONE
    assert shown(session) == ["0.25"]
    with pytest.raises(Fault):
        executor.begin_again()


@pytest.mark.parametrize("wait", ["DELAY 0.2", "WAIT TIMER >= 9, TIMEOUT 0.2, GOTO *A", "IF TIMER THEN DELAY 0.2"])
def test_a_wait_is_begun_anew(tmp_path, wait):
    session = session_of(tmp_path, f"DELAY 0.008\n{wait}\n*A PRINT TIMER\n")
    executor = stopped_at(session, 10)
    executor.acknowledge()
    executor.begin_again()
    began = executor.time_us
    executor.resume()
    assert stands(session).state is State.DONE
    assert shown(session) == [f"{began / 1e6 + 0.2:g}"]


def test_an_alarm_in_a_fed_call_gives_the_call_up(tmp_path):
    session = session_of(tmp_path, "X = 1\nDELAY 0.1\nPRINT X\nEND\nSUB S(K)\nMOVE P2\nENDSUB\n")
    executor = session.executor
    paused_after(session, 3)
    executor.feed("CALL S(1)")
    stopped_at(session, 20)
    executor.acknowledge()
    assert len(executor.variables) == 1
    executor.begin_again()
    assert (executor.origin.line, executor.calls) == (2, ())
    executor.resume()
    assert stands(session).state in ENDED
    assert shown(session) == ["1"]


def test_a_statement_whose_call_was_left_cannot_be_begun_again(tmp_path):
    session = session_of(tmp_path, "CALL S(0)\nPRINT 1\nEND\nSUB S(K)\nX = 1 / K\nENDSUB\n")
    executor = session.executor
    stands(session)
    executor.acknowledge()
    fed(session, "RETURN")
    with pytest.raises(Fault) as refused:
        executor.begin_again()
    assert refused.value.code == "RBL542"
    executor.resume()
    assert (stands(session).state, shown(session)) == (State.DONE, ["1"])


def test_under_a_seam_sensor_nothing_is_played(tmp_path):
    """The move under it comes to its end first, so it is never held."""
    session = Session(load_project(ROOT / "wrist/seam.rbl"), physics=False)
    executor = session.executor
    while session.controller.tracker is None:
        executor.advance()
    paused_after(session, 20)
    status, log = executor.status, log_of(session)
    with pytest.raises(Fault) as refused:
        executor.play(there_and_back(session), by_hand("jog"), "jog")
    assert refused.value.code == "RBL544"
    assert (executor.status, log_of(session), executor.displaced.joint_deg) == (status, log, 0.0)
    assert fed(session, "PRINT 1").fault is None
    assert executor.displaced.joint_deg == 0.0
    executor.resume()
    assert ended(session)[1]["ok"]
