"""What keeps a run from ending is named at its place: a WAIT, the loop that goes on, or the statement that runs."""

import pytest

from robolang.execution import run_bounds
from robolang.execution.dry_run import rehearse
from robolang.execution.session import Session
from robolang.interpreter.rounds import Rounds
from robolang.project.project import load_project

TEXTS = {
    "wait": "LOAD (0, 0, 60), 0.8\nN = 0\nWHILE 1\nDELAY 0.02\nN = N + 1\nIF N = 3 THEN «WAIT TIMER < 0»\nWEND",
    "wait with a long timeout": "«WAIT TIMER < 0, TIMEOUT 100»",
    "while": "N = 0\n«WHILE N < 5»\nDELAY 0.02\nWEND",
    "goto over a for": "10 N = 0\n20 *AGAIN «N = N + 1»\n30 FOR I = 1 TO 5\n40 DELAY 0.008\n50 NEXT\n60 GOTO *AGAIN",
    "a loop in a sub": "CALL S\nEND\nSUB S\n«WHILE 1»\nDELAY 0.02\nWEND\nENDSUB",
    "a loop that calls a loop": "«WHILE 1»\nCALL S\nWEND\nSUB S\nFOR I = 1 TO 3\nDELAY 0.008\nNEXT\nENDSUB",
    "a loop that calls a gosub above": "GOTO *M\n*G DELAY 0.02\nRETURN\n*M\n«WHILE 1»\nGOSUB *G\nWEND",
    "within a loop that has stopped": "N = 0\n*TRY N = N + 1\nDELAY 0.008\nIF N < 3 THEN GOTO *TRY\n"
    "«WHILE N»\nDELAY 0.02\nWEND\nGOTO *TRY",
    "no loop": "N = 0\nWHILE N < 3\nN = N + 1\nDELAY 0.02\nWEND\n«DELAY 100»",
    "a motion": "LOAD (0, 0, 60), 0.8\n«MOVE P1, SPEED 20»",
}


LOOPLESS = ("no loop", "a motion")


@pytest.mark.parametrize("name", TEXTS)
def test_a_run_and_its_rehearsal_name_what_does_not_end(name, tmp_path, monkeypatch):
    monkeypatch.setattr(run_bounds, "MAX_RUN_US", 400_000)
    text = TEXTS[name]
    start, end = text.index("«"), text.index("»") - 1
    path = tmp_path / "p.rbl"
    path.write_text(text.replace("«", "").replace("»", ""))
    project = load_project(path)
    (alarm,), (refused,) = Session(project, physics=False).run().alarms, rehearse(project, every_round=True).refused
    for found in (alarm, refused):
        assert (found.code, found.span.start, found.span.end) == ("RBL509", start, end), found
    assert alarm.message == refused.message
    assert alarm.hint == refused.hint
    assert ("TIMEOUT" in alarm.hint) is name.startswith("wait")
    assert ("loop" in alarm.hint) is (not name.startswith("wait") and name not in LOOPLESS)


def test_the_loop_that_goes_on_is_the_outermost_whose_round_is_no_longer_than_all_before():
    rounds = Rounds()
    assert rounds.endless((3,), 10) is None
    rounds.turn(2, 5, 10)
    assert rounds.endless((3,), 11) is None  # one round is none yet
    rounds.turn(2, 4, 20)
    assert rounds.endless((3,), 30) == (2, 2)
    assert rounds.endless((5,), 30) == (2, 2)
    assert rounds.endless((6,), 30) is None
    assert rounds.endless((3,), 31) is None
    rounds.turn(0, 1, 25)
    rounds.turn(0, 1, 30)
    assert rounds.endless((1, 3), 30) == (0, 2)  # the outermost call decides


def test_idle_rounds_are_those_since_something_took_time_or_the_loop_ended():
    rounds = Rounds()
    assert [rounds.idle(4) for _ in range(3)] == [1, 2, 3]
    assert rounds.idle(2) == 1
    rounds.leave(4)
    assert (rounds.idle(4), rounds.idle(2)) == (1, 2)
    rounds.take_time()
    assert (rounds.idle(4), rounds.idle(2)) == (1, 1)
