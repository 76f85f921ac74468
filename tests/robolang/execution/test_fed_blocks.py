"""Several lines that are fed: whole blocks, carried out where the program stands, by the rules of one statement."""

import pytest

from robolang.core.source import Source
from robolang.execution.status import ENDED, State
from robolang.execution.timeline import Timeline
from robolang.interpreter import run_limits
from tests.robolang.execution.standing import (
    dump,
    fed,
    jogged,
    log_of,
    paused_after,
    session_of,
    shown,
    stands,
    stops_at,
)

PROGRAM = """X = 1
ON ERROR GOTO *H
FOR I = 1 TO 2
CALL S(I)
NEXT
GOSUB *G
PRINT "end"; X
END
*G X = X + 10
RETURN
*H PRINT "caught"
RESUME NEXT
SUB S(K)
PRINT "S"; K
ENDSUB
"""


def finished(session):
    session.executor.stops_before = None
    session.executor.resume()
    assert stands(session).state in ENDED
    return shown(session)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("PRINT 1\nPRINT 2", ["1", "2"]),
        ("FOR J = 1 TO 3\nPRINT J\nNEXT\nPRINT 9", ["1", "2", "3", "9"]),
        ("FOR J = 1 TO 2\nFOR L = 1 TO 2\nPRINT J; L\nNEXT\nNEXT", ["11", "12", "21", "22"]),
        ("Y = 0\nWHILE Y < 3\nY = Y + 1\n\n' so\nPRINT Y\nWEND", ["1", "2", "3"]),
        ("IF X = 1 THEN\nPRINT 1\nELSEIF X = 2 THEN\nPRINT 2\nELSE\nPRINT 3\nENDIF", ["1"]),
        ("IF X = 5 THEN\nPRINT 1\nELSEIF TIMER < 0 THEN\nPRINT 2\nELSE\nPRINT 3\nENDIF", ["3"]),
        ("SELECT X\nCASE 4, 5\nPRINT 1\nCASE TIMER, 1\nPRINT 2\nCASE ELSE\nPRINT 3\nENDSELECT", ["2"]),
        ("FOR J = 1 TO 2\nCALL S(J * 10)\nGOSUB *G\nNEXT\nPRINT X", ["S10", "S20", "21"]),
        ("FOR J = 1 TO 2\nIF J = 2 THEN CALL S(7)\nNEXT", ["S7"]),
        ("FOR J = 3 TO 1\nPRINT J\nNEXT", []),
    ],
)
def test_blocks_are_carried_out_and_the_program_stands_where_it_stood(tmp_path, text, expected):
    for line in (1, 4, 6, 14):
        session = session_of(tmp_path, PROGRAM)
        stops_at(session, line)
        fed(session, "X = 1")
        session.executor.stops_before = None
        before, seen = (session.executor.origin, session.executor.calls, session.executor.level), shown(session)
        status = fed(session, text)
        assert (status.state, status.fault) == (State.PAUSED, None)
        assert (session.executor.origin, session.executor.calls, session.executor.level) == before
        if line == 14:  # GOSUB is not of this SUB
            continue
        assert shown(session)[len(seen) :] == expected


def test_the_loops_of_the_program_go_on_around_it(tmp_path):
    session = session_of(tmp_path, PROGRAM)
    stops_at(session, 5)
    fed(session, "FOR J = 1 TO 3\nPRINT J\nNEXT")
    fed(session, "FOR I = 1 TO 1\nX = X + 100\nNEXT")
    assert finished(session) == ["S1", "1", "2", "3", "S2", "end111"]


def test_a_fault_is_at_its_place_in_the_text_and_the_program_does_not_catch_it(tmp_path):
    session = session_of(tmp_path, PROGRAM)
    stops_at(session, 4)
    text = "FOR J = 1 TO 3\nY = 1 / (2 - J)\nPRINT J\nNEXT"
    session.executor.feed(Source("prompt", text))
    fault = stands(session).fault
    assert (fault.code, fault.origin.line) == ("RBL501", 0)
    assert fault.origin.source.slice(fault.origin.span) == "1 / (2 - J"
    assert finished(session) == ["1", "S1", "S2", "end11"]


def test_a_loop_without_an_end_is_found(tmp_path, monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_IDLE", 50)
    session = session_of(tmp_path, PROGRAM)
    stops_at(session, 4)
    fault = fed(session, "Y = 1\nWHILE Y > 0\nY = Y + 1\nWEND").fault
    assert fault.code == "RBL508"
    assert fault.origin.source.slice(fault.origin.span) == "WHILE Y > 0"
    assert finished(session) == ["S1", "S2", "end11"]


BLOCK = "FOR J = 1 TO 2\nDELAY 0.08\nMOVE P1 + (0, 0, 20 * J)\nPRINT J\nNEXT\nPRINT 9"


@pytest.mark.parametrize("cycle", [4, 40, 90])
def test_a_pause_a_snapshot_and_what_is_fed_in_the_middle(tmp_path, cycle):
    whole = session_of(tmp_path, PROGRAM)
    stops_at(whole, 4)
    fed(whole, BLOCK)
    session = session_of(tmp_path, PROGRAM)
    stops_at(session, 4)
    session.executor.feed(BLOCK)
    paused_after(session, cycle)
    kept = session.executor.snapshot()
    for _ in range(2):
        fed(session, "FOR J = 5 TO 6\nQ = J\nNEXT\nJ = 1")
        jogged(session)
        if session.executor.displaced is not None:
            session.executor.regain()
        stands(session)
        session.executor.resume()
        stands(session)
        assert shown(session) == shown(whole)[: len(shown(session))]
        assert finished(session)[-3:] == ["S1", "S2", "end11"]
        session.executor.restore(kept)
    session.executor.stop()
    assert stands(session).state is State.STOPPED
    session.executor.acknowledge()
    session.executor.begin_again()
    assert session.executor.origin.line == 4
    assert finished(session)[-3:] == ["S1", "S2", "end11"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("FOR J = 1 TO 3\nIF J = 2 THEN GOTO *G\nNEXT\nPRINT 9", ["S1", "caught", "end"]),
        ("PRINT 7\nEND\nPRINT 8", ["7"]),
    ],
)
def test_a_jump_into_the_program_leaves_the_text(tmp_path, text, expected):
    session = session_of(tmp_path, PROGRAM.replace("RETURN\n*H", 'PRINT "end"\nEND\n*H'))
    stops_at(session, 5 if "GOTO" in text else 3)
    assert fed(session, text).state is State.PAUSED
    found = finished(session)
    assert found == (["S1", "end"] if "GOTO" in text else expected)


def test_a_return_that_is_fed_within_a_fed_call_leads_to_the_next_line_of_its_text(tmp_path):
    session = session_of(tmp_path, PROGRAM)
    stops_at(session, 3)
    session.executor.stops_before = lambda begun: begun.line == 14
    session.executor.feed("CALL S(5)\nPRINT 6\nCALL S(7)\nPRINT 8")
    stands(session)
    fed(session, "RETURN")
    session.executor.resume()
    stands(session)
    assert shown(session) == ["6"]
    fed(session, "PRINT 1\nRETURN")
    session.executor.resume()
    stands(session)
    assert shown(session) == ["6", "1", "8"]
    assert session.executor.origin.line == 3
    assert finished(session)[-3:] == ["S1", "S2", "end11"]


def test_back_over_a_block_that_was_fed(tmp_path):
    session = session_of(tmp_path, PROGRAM)
    timeline = Timeline(session.executor)
    stops_at(session, 4)
    before = dump(session.executor.snapshot()), log_of(session)
    fed(session, BLOCK)
    timeline.back()
    assert (dump(session.executor.snapshot()), log_of(session)) == before
