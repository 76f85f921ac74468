"""Statements that are fed to a program: their place is in their own text, and never in that of the program."""

import numpy as np
import pytest

from robolang.core.diagnostics import render, to_json
from robolang.core.source import Source
from robolang.execution.observer import Observer
from robolang.execution.session import Session
from robolang.execution.status import ENDED, State
from robolang.project.project import load_project
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault


def session_of(tmp_path, text, observer=None):
    (tmp_path / "p.rbl").write_text(text)
    return Session(load_project(tmp_path / "p.rbl"), physics=False, observer=observer)


def until(session, *states):
    while session.executor.advance().state not in states:
        pass
    return session.executor.status


class Seen(Observer):
    def __init__(self):
        self.lines, self.runs = [], []

    def statement_began(self, statement):
        self.lines.append(statement.line)

    def run_began(self, run, time_us):
        self.runs.append(run.text)


def test_an_alarm_of_a_fed_statement_is_at_its_place_in_its_own_text(tmp_path):
    seen = Seen()
    session = session_of(tmp_path, "DIM Q(3)\nQ(1) = 5\nMOVE P1\n", seen)
    executor = session.executor
    until(session, *ENDED)
    executor.feed(Source("prompt", "   MOVE P2"))
    status = executor.advance(20)
    assert (status.statement.line, status.statement.source) == (0, Source("prompt", "   MOVE P2"))
    executor.stop()
    assert until(session, *ENDED).alarm.code == "RBL530"
    result = session.result(0.0)
    (alarm,) = result.alarms
    assert render(alarm, session.project.source).startswith("prompt:1:4: error RBL530")
    assert (to_json(alarm, session.project.source)["file"], result.report["alarms"][0]["column"]) == ("prompt", 4)
    assert set(np.unique(result.log["line"])) == {0, 3}
    assert [(row["line"], row["text"]) for row in result.report["statements"]] == [(3, "MOVE P1"), (None, "MOVE P2")]
    assert seen.lines == [1, 2, 3, 0]


def test_a_fault_of_a_fed_statement_is_at_its_place_in_its_own_text(tmp_path):
    session = session_of(tmp_path, "X = 1\n")
    until(session, State.DONE)
    session.executor.feed("Y = X / 0")
    origin = until(session, State.PAUSED).fault.origin
    assert (origin.line, origin.source.path, origin.source.slice(origin.span)) == (0, "fed statement", "X / 0")


def test_a_warning_of_a_fed_move_is_not_taken_for_that_of_the_program_at_the_same_place(tmp_path):
    text = "MOVEJ P1, TIME 0.1"  # it takes longer: RBL429
    session = session_of(tmp_path, text + "\n")
    until(session, State.DONE)
    for _ in range(2):
        session.executor.feed("MOVEJ P2")
        until(session, State.PAUSED)
        session.executor.feed(text)
        until(session, State.PAUSED)
    places = [(item.code, item.source is None) for item in session.result(0.0).warnings if item.code == "RBL429"]
    assert places == [("RBL429", True), ("RBL429", False)]


@pytest.mark.parametrize(
    ("text", "code", "column"),
    [
        ("  MOV P1", "RBL112", 3),
        ("MOVE P1 +", "RBL111", 10),
        ("", "RBL111", 1),
        ("' a comment", "RBL111", 1),
        ("X = 1\n  FOR I = 1 TO 3\nY = 1", "RBL211", 3),
        ("X = 1\nNEXT", "RBL212", 1),
        ("X = 1\n10 X = 2", "RBL111", 1),
        ("X = 1\n*A X = 2", "RBL111", 1),
        ("SUB S()\nX = 1\nENDSUB", "RBL111", 1),
        ("X = 1\nMOV P1", "RBL112", 1),
    ],
)
def test_a_text_that_is_not_whole_statements_is_refused_at_its_place(tmp_path, text, code, column):
    session = session_of(tmp_path, "X = 1\n")
    until(session, State.DONE)
    before = session.executor.status
    with pytest.raises(FileFault) as refused:
        session.executor.feed(Source("prompt", text))
    assert (refused.value.code, refused.value.path, refused.value.column) == (code, "prompt", column)
    with pytest.raises(Fault, match="FOR"):
        session.executor.feed("FOR I = 1 TO 3")
    assert session.executor.status == before


def test_a_stop_after_the_end_changes_nothing(tmp_path):
    session = session_of(tmp_path, "PRINT 1\n")
    ended = until(session, State.DONE)
    session.executor.stop()
    session.executor.halt()
    assert session.executor.advance(10) == ended
    session.executor.feed("PRINT 2")
    assert until(session, State.PAUSED).fault is None
    assert [text for _, text in session.record.shown] == ["1", "2"]


@pytest.mark.parametrize("text", ["PRINT 1\n", "X = 1\nPRINT X\n", "HAND ON\n", "MOVE P1\n", "OUT(1) = 1\n"])
@pytest.mark.parametrize("pauses", [False, True])
def test_a_stop_before_the_first_cycle_carries_nothing_out(tmp_path, text, pauses):
    session = session_of(tmp_path, text)
    if pauses:
        session.executor.pause()
    session.executor.stop()
    assert until(session, *ENDED).state is State.STOPPED
    result = session.result(0.0)
    assert [item.code for item in result.alarms] == ["RBL530"]
    assert not any(row["begun"] for row in result.report["statements"])
    if "MOVE" not in text:  # a planned move is braked on its path, from its first set-point
        assert np.ptp(result.log["q_cmd"], axis=0).max() < 1e-12  # rounding of the interpolator
    assert (session.record.shown, session.controller.plant.hand().closed) == ([], False)


def test_an_executor_tells_where_the_program_is_and_what_it_knows(tmp_path):
    """At a line that a prompt stops at, moves before it may still be kept, since they blend."""
    session = session_of(tmp_path, "X = 4\nCALL S(2)\nSUB S(K)\nMOVE P1, ZONE 20\nMOVE P2\nENDSUB\n")
    executor = session.executor
    assert (executor.origin, executor.calls) == (None, ())
    while (executor.origin is None or executor.origin.line != 5) and executor.advance():
        pass
    assert [each.line for each in executor.calls] == [2]
    assert [dict(scope.values) for scope in executor.variables] == [{"X": 4.0}, {"K": 2.0}]


def test_a_wait_begins_once(tmp_path):
    seen = Seen()
    session = session_of(tmp_path, "WAIT TIMER > 0.2\nDELAY 0.1\nWAIT TIMER > 0.5\n", seen)
    until(session, State.DONE)
    assert seen.runs == ["WAIT TIMER > 0.2", "DELAY 0.1", "WAIT TIMER > 0.5"]


def test_a_snapshot_keeps_what_was_warned_of_and_acknowledged(tmp_path):
    session = session_of(tmp_path, "FOR I = 1 TO 2\nMOVEJ P1, TIME 0.1\nMOVEJ P2\nNEXT\n")
    executor = session.executor
    start = executor.snapshot()
    until(session, State.DONE)
    warnings = session.result(0.0).warnings
    assert "RBL429" in {item.code for item in warnings}
    executor.restore(start)
    assert session.result(0.0).warnings == ()
    until(session, State.DONE)
    assert session.result(0.0).warnings == warnings
    executor.feed("MOVE P1")
    executor.advance(20)
    running = executor.snapshot()
    executor.stop()
    until(session, *ENDED)
    executor.acknowledge()
    noted = executor.snapshot()
    executor.restore(running)
    assert session.result(0.0).alarms == ()
    executor.restore(noted)
    assert [item.code for item in session.result(0.0).alarms] == ["RBL530"]


def paused(session, cycle):
    session.executor.advance(cycle)
    session.executor.pause()
    return until(session, State.PAUSED)


def shown(session):
    return [text for _, text in session.record.shown]


@pytest.mark.parametrize("wait", ["DELAY 0.4", "WAIT TIMER >= 0.4", "HAND ON, 0.4", "IF 1 THEN DELAY 0.4"])
def test_a_wait_that_a_fed_statement_interrupts_takes_what_is_left_of_it(tmp_path, wait):
    session = session_of(tmp_path, f"{wait}\nPRINT TIMER\n")
    interrupted = paused(session, 20)
    session.executor.feed("PRINT TIMER")
    status = until(session, State.PAUSED)
    assert (status.statement, status.time_us) == (interrupted.statement, interrupted.time_us)
    kept = session.executor.snapshot()
    for _ in range(2):
        session.executor.resume()
        assert until(session, *ENDED).state is State.DONE
        assert shown(session) == ["0.16", "0.4"]
        rows = session.result(0.0).report["statements"]
        assert sum(row["duration_s"] for row in rows if row["line"] == 1) == pytest.approx(0.4)
        session.executor.restore(kept)


def test_a_motion_fed_within_a_delay_is_carried_out_and_the_delay_goes_on(tmp_path):
    session = session_of(tmp_path, "DELAY 0.4\nPRINT TIMER\n")
    began = paused(session, 20).time_us
    session.executor.feed("MOVE P1")
    went = until(session, State.PAUSED).time_us - began
    assert went > 100_000
    np.testing.assert_allclose(session.executor.world.q_last, session.controller.areas.ina)
    session.executor.resume()
    assert until(session, *ENDED).time_us == 400_000 + went
    assert {0, 1} <= set(np.unique(session.result(0.0).log["line"]))


def test_a_wait_within_a_fed_call_is_interrupted_as_well(tmp_path):
    session = session_of(tmp_path, "DELAY 0.4\nPRINT TIMER\nEND\nSUB S()\nDELAY 0.2\nPRINT 7\nENDSUB\n")
    paused(session, 20)
    session.executor.feed("CALL S()")
    paused(session, 5)
    session.executor.feed("PRINT 8")
    until(session, State.PAUSED)
    session.executor.feed("X = 1 / 0")
    assert until(session, State.PAUSED).fault.code == "RBL501"
    session.executor.resume()
    until(session, State.PAUSED)  # the CALL that was fed is over
    session.executor.resume()
    assert until(session, *ENDED).state is State.DONE
    assert shown(session) == ["8", "7", "0.6"]


@pytest.mark.parametrize(("text", "expected"), [("GOTO *A", ["5"]), ("END", [])])
def test_a_fed_jump_leaves_the_wait(tmp_path, text, expected):
    session = session_of(tmp_path, "DELAY 0.4\nPRINT 2\n*A PRINT 5\n")
    began = paused(session, 20).time_us
    session.executor.feed(text)
    until(session, State.PAUSED)
    session.executor.resume()
    assert until(session, *ENDED).time_us == began
    assert shown(session) == expected
    session.executor.feed("PRINT 9")
    assert until(session, State.PAUSED).time_us == began


def test_a_stop_of_a_statement_fed_within_a_wait_ends_the_program(tmp_path):
    session = session_of(tmp_path, "DELAY 0.4\nPRINT 2\n")
    paused(session, 20)
    session.executor.feed("MOVE P1")
    session.executor.advance(20)
    session.executor.stop()
    assert until(session, *ENDED).state is State.STOPPED
    session.executor.acknowledge()
    session.executor.feed("PRINT 9")
    until(session, State.PAUSED)
    session.executor.resume()
    assert until(session, *ENDED).state is State.DONE
    assert shown(session) == ["9"]


def test_nothing_is_fed_while_the_program_runs(tmp_path):
    session = session_of(tmp_path, "MOVE P1\nDELAY 0.4\n")
    session.executor.advance(20)
    with pytest.raises(RuntimeError, match="pause"):
        session.executor.feed("PRINT 1")
