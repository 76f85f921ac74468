"""Stopping before statements: where, once each, with the arm at rest, and without a trace in the log."""

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.execution.status import ENDED, State
from robolang.project.project import load_project
from tests.programs.runs import some_programs
from tests.robolang.execution.standing import ended, fed, log_of, session_of, shown, stands, stops_at


def lines_of(session):
    """The lines before which a session stops, when it stops before each."""
    found = []
    while stands(session).state not in ENDED:
        found.append(session.executor.origin.line)
        session.executor.resume()
    return found


TEXT = "X = 1\nMOVE P1\nCALL S(2)\nDELAY 0.1\nMOVE P2\nEND\nSUB S(K)\nPRINT K; X\nENDSUB\n"


def test_a_program_stops_before_each_statement_once(tmp_path):
    session = session_of(tmp_path, TEXT)
    session.executor.stops_before = lambda begun: True
    assert lines_of(session) == [1, 2, 3, 8, 9, 4, 5, 6]


def test_a_program_is_held_before_its_first_statement(tmp_path):
    session = session_of(tmp_path, "\n' one\nX = 1\nMOVE P1\n")
    session.executor.stops_before = lambda begun: True
    status = session.executor.advance(1000)
    assert (status.state, status.time_us, session.executor.origin.line) == (State.PAUSED, 0, 3)
    assert session.executor.advance(10) == status


WITHOUT_BLENDS = [path for path in some_programs("pick_and_place", "recover", "seam") if "ZONE" not in path.read_text()]


@pytest.mark.parametrize("path", WITHOUT_BLENDS, ids=lambda path: path.stem)
def test_a_run_that_stops_before_every_statement_is_the_run(path):
    whole = ended(Session(load_project(path), physics=False))
    session = Session(load_project(path), physics=False)
    session.executor.stops_before = lambda begun: True
    lines_of(session)
    assert (log_of(session), session.result(0.0).report) == whole


def test_moves_that_are_kept_run_to_their_end_before_a_stop(tmp_path):
    session = session_of(tmp_path, "MOVE P1, ZONE 30\nX = 5\nMOVE P2, ZONE 30\nMOVE P1\nPRINT X\n")
    whole = ended(session_of(tmp_path, "MOVE P1\nX = 5\nMOVE P2, ZONE 30\nMOVE P1\nPRINT X\n"))
    assert stops_at(session, 2).state is State.PAUSED
    assert session.executor.origin.line == 2
    assert not session.controller.moving
    np.testing.assert_array_equal(session.executor.world.q_last, session.controller.areas.ina)
    fed(session, "Y = 6")
    session.executor.resume()
    log, _ = ended(session)
    assert (log, shown(session)) == (whole[0], ["5"])


def test_a_stop_comes_within_the_motion_before_it(tmp_path):
    """A pause in the moves that run before a stop, and a stop of the arm there."""
    session = session_of(tmp_path, "MOVE P1, ZONE 30\nMOVE P2, ZONE 30\nPRINT 1\n")
    session.executor.stops_before = lambda begun: begun.line == 3
    session.executor.advance(40)
    session.executor.pause()
    assert stands(session).statement.line == 1
    kept = session.executor.snapshot()
    session.executor.resume()
    assert (stands(session).state, session.executor.origin.line) == (State.PAUSED, 3)
    session.executor.restore(kept)
    session.executor.stop()
    assert stands(session).state is State.STOPPED


def test_statements_that_are_fed_are_not_asked_for_and_what_they_call_is(tmp_path):
    session = session_of(tmp_path, TEXT)
    session.executor.stops_before = lambda begun: begun.line in (2, 8)
    stands(session)
    assert fed(session, "PRINT 1").state is State.PAUSED
    assert session.executor.origin.line == 2
    fed(session, "CALL S(7)")
    assert session.executor.origin.line == 8
    session.executor.resume()
    stands(session)
    assert (session.executor.origin.line, shown(session)) == (2, ["1", "71"])
    session.executor.resume()
    stands(session)
    assert session.executor.origin.line == 8


def test_a_hook_is_asked_once_for_a_statement_also_after_going_back(tmp_path):
    asked = []
    session = session_of(tmp_path, "X = 1\nX = 2\nX = 3\n")
    session.executor.stops_before = lambda begun: asked.append(begun.line) or begun.line == 2
    stands(session)
    kept = session.executor.snapshot()
    for _ in range(2):
        session.executor.restore(kept)
        session.executor.resume()
        stands(session)
    assert asked == [1, 2, 3, 3]
