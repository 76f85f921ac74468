"""An edited program in the place of the one that is carried out: what moves along, and what is refused."""

from dataclasses import replace

import pytest

from robolang.analysis.analysis import Analysis
from robolang.core.source import Source
from robolang.execution.status import ENDED, State
from robolang.execution.timeline import Timeline
from robolang.project.project import load_project
from robolang.teaching.line_map import lines_between
from runtime.core.faults import Fault
from tests.robolang.execution.standing import (
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
)


def edited(session, old, new):
    """Put other lines in the place of some of the text, and let the session go on with that."""
    project = session.executor.project
    text = project.source.text.replace(old, new)
    assert text != project.source.text
    after = load_project(Analysis(source=Source(project.source.path, text)))
    assert after.ok, after.diagnostics
    session.executor.adopt(after, lines_between(project.source.text, text))


def finished(session):
    session.executor.stops_before = None
    session.executor.resume()
    assert stands(session).state in ENDED
    return shown(session)


CALLS = """X = 1
FOR I = 1 TO 3
CALL S(I)
NEXT
PRINT "end"
END
SUB S(K)
ON ERROR GOTO *H
GOSUB *G
PRINT K; X
RETURN
*G X = X + 1
RETURN
*H PRINT ERR
RESUME NEXT
ENDSUB
"""


def test_the_same_edit_as_none_changes_nothing(tmp_path):
    whole = finished(session_of(tmp_path, CALLS))
    for line in (1, 3, 4, 9, 10, 12, 13):
        session = session_of(tmp_path, CALLS)
        stops_at(session, line)
        edited(session, "END\nSUB", "END\n\nSUB")
        assert session.executor.origin.line == line + (line > 6)
        assert finished(session) == whole


@pytest.mark.parametrize("line", [9, 10, 12, 13])
def test_calls_loops_and_handlers_move_along(tmp_path, line):
    session = session_of(tmp_path, CALLS)
    stops_at(session, line)
    edited(session, "X = 1\n", "X = 1\n' one\nY = 9\nZ = 8\n")
    assert session.executor.origin.line == line + 3
    assert [each.line for each in session.executor.calls] == [6, 12][: 2 if line > 10 else 1]
    edited(session, "PRINT K; X", "W = 1 / (K - K)\nPRINT K; X")
    # where it stands at the PRINT, the line that is put before it comes in the next call
    assert finished(session) == ["501", "12", "501", "22", "501", "32", "end"][line == 10 :]


def test_a_statement_where_the_program_stands_may_change_or_go(tmp_path):
    session = session_of(tmp_path, CALLS)
    stops_at(session, 10)
    edited(session, "PRINT K; X", "PRINT X; K")
    assert session.executor.origin.line == 10
    kept = session.executor.snapshot()
    assert finished(session) == ["21", "22", "23", "end"]
    session.executor.restore(kept)
    edited(session, "PRINT X; K\n", "")
    assert session.executor.origin.line == 10
    assert finished(session) == ["end"]
    session = session_of(tmp_path, "X = 1\nPRINT X\n")
    stops_at(session, 2)
    edited(session, "PRINT X\n", "")
    assert finished(session) == []


@pytest.mark.parametrize(
    ("line", "old", "new"),
    [
        (10, "CALL S(I)", "X = X"),
        (10, "CALL S(I)\n", ""),
        (13, "GOSUB *G\n", ""),
        (10, "FOR I = 1 TO 3\nCALL S(I)\nNEXT\n", "CALL S(1)\n"),
        (3, "FOR I = 1 TO 3\nCALL S(I)\nNEXT\n", "CALL S(1)\n"),
        (3, "FOR I = 1 TO 3\nCALL S(I)", "FOR J = 1 TO 3\nCALL S(J)"),
        (3, "FOR I = 1 TO 3\nCALL S(I)\nNEXT\n", "WHILE X > 0\nCALL S(X)\nWEND\n"),
        (10, "ON ERROR GOTO *H\n", "ON ERROR STOP\n*H PRINT 1\n"),
    ],
)
def test_what_the_program_is_inside_of_must_stay(tmp_path, line, old, new):
    session = session_of(tmp_path, CALLS)
    stops_at(session, line)
    before, log = dump(session.executor.snapshot()), log_of(session)
    if "*H PRINT 1" in new:
        old, new = "*H PRINT ERR\nRESUME NEXT\n", ""
        edited(session, "ON ERROR GOTO *H\n", "ON ERROR STOP\n")
        before = dump(session.executor.snapshot())
    with pytest.raises(Fault) as refused:
        edited(session, old, new)
    assert refused.value.code == "RBL543"
    assert (dump(session.executor.snapshot()), log_of(session)) == (before, log)


WAITS = "X = 1\nDELAY 0.2\nWAIT TIMER > 0.4, TIMEOUT 1\nPRINT TIMER\nMOVE P1, ZONE 20\nMOVE P2\nPRINT HERE.X\n"


@pytest.mark.parametrize("cycle", [10, 35, 80, 150, 220])
def test_what_is_carried_out_goes_on_as_it_was(tmp_path, cycle):
    """A wait and a motion at rest, with lines above them and below; the log has the new lines from then on."""
    alone = session_of(tmp_path, WAITS)
    paused_after(alone, cycle)
    alone.executor.resume()
    whole, _ = ended(alone)
    session = session_of(tmp_path, WAITS)
    line = paused_after(session, cycle).statement.line
    edited(session, "X = 1\n", "X = 1\nY = 1\nZ = 1\n")
    assert session.executor.status.statement.line == line + 2
    edited(session, "PRINT HERE.X\n", "PRINT 5\n")
    session.executor.resume()
    log, report = ended(session)
    del whole["line"], log["line"]
    assert log == whole
    assert shown(session)[-1] == "5"
    assert [row["line"] for row in report["statements"]] == [4, 5, 6, 7, 8, 9]


def test_a_statement_that_is_carried_out_stays(tmp_path):
    for cycle, line in ((10, "DELAY 0.2\n"), (35, "WAIT TIMER > 0.4, TIMEOUT 1\n"), (150, "MOVE P1, ZONE 20\n")):
        session = session_of(tmp_path, WAITS)
        paused_after(session, cycle)
        with pytest.raises(Fault) as refused:
            edited(session, line, "")
        assert refused.value.code == "RBL543"
    session = session_of(tmp_path, WAITS)
    paused_after(session, 35)
    with pytest.raises(Fault):
        edited(session, "TIMER > 0.4", "TIMER > 0.5")


def test_a_held_move_that_is_displaced_moves_along(tmp_path):
    session = session_of(tmp_path, WAITS)
    line = paused_after(session, 150).statement.line
    jogged(session, most=0.02, back=False)
    edited(session, "X = 1\n", "X = 1\nY = 1\n")
    assert session.executor.displaced.joint_deg > 1.0
    session.executor.regain()
    assert stands(session).statement.line == line + 1
    session.executor.stop()
    session.executor.resume()
    while session.executor.advance().state not in ENDED:
        pass
    session.executor.acknowledge()
    edited(session, "Y = 1\n", "")
    session.executor.begin_again()
    assert session.executor.origin.line == line
    finished(session)
    assert session.executor.status.state is State.DONE


def test_alarms_and_warnings_are_named_by_their_new_lines(tmp_path):
    session = session_of(tmp_path, "MOVEJ P1, TIME 0.1\nX = 1\nY = 1 / (X - 1)\n")
    stands(session)
    edited(session, "MOVEJ", "' one\nMOVEJ")
    result = session.result(0.0)
    assert [row["line"] for row in result.report["alarms"]] == [4]
    assert {row["line"] for row in result.report["warnings"]} == {2}
    session.executor.acknowledge()
    edited(session, "Y = 1 / (X - 1)\n", "PRINT X\n")
    session.executor.begin_again()
    assert finished(session) == ["1"]


def test_other_points_hold_from_the_next_statement_on(tmp_path):
    session = session_of(tmp_path, "MOVE P1\nMOVE P2\nPRINT P2.X\n")
    paused_after(session, 30)
    project = session.executor.project
    point = project.points.points["P2"]
    x = point.pose[0] - 40.0
    points = {**project.points.points, "P2": point.replaced(pose=(x, *point.pose[1:]))}
    session.executor.adopt(replace(project, points=project.points.replaced(points=points)), lines_between("", ""))
    assert finished(session) == [f"{x:g}"]
    assert session.controller.tool_poses(session.controller.areas.ina)[0, 3] == pytest.approx(x / 1e3)


def test_a_program_that_runs_or_has_errors_is_not_adopted(tmp_path):
    session = session_of(tmp_path, "MOVE P1\n")
    session.executor.advance(10)
    with pytest.raises(RuntimeError):
        edited(session, "MOVE P1", "MOVE P2")
    paused_after(session, 1)
    wrong = load_project(Analysis(source=Source(session.executor.project.source.path, "MOV P1\n")))
    with pytest.raises(ValueError, match="errors"):
        session.executor.adopt(wrong, lines_between("", ""))


# --- and back --------------------------------------------------------------------------------------------------------


def test_back_over_an_edit(tmp_path):
    """Places of the old program are reached by its own cycles, and then moved to the new one."""
    session = session_of(tmp_path, "X = 1\nX = 2\nX = 3\nX = 4\nPRINT X\n")
    timeline = Timeline(session.executor)
    stops_at(session, 4)
    edited(session, "X = 3\n", "Y = 1\nX = 7\n")
    stops_at(session, 6)
    mark = timeline.back(2)
    assert (mark.label, session.executor.origin.line) == ("edit", 5)
    mark = timeline.back(1)
    assert (session.executor.origin.line, session.executor.variables[0].values["X"]) == (3, 2.0)
    assert session.executor.project.source.text.count("Y = 1")
    assert finished(session) == ["4"]
    assert session.executor.variables[0].values["Y"] == 1.0


def test_places_inside_of_lines_that_are_gone_are_skipped(tmp_path):
    session = session_of(tmp_path, "X = 1\nFOR I = 1 TO 2\nX = X + 1\nNEXT\nPRINT X\nX = 9\n")
    timeline = Timeline(session.executor)
    stops_at(session, 6)
    edited(session, "FOR I = 1 TO 2\nX = X + 1\nNEXT\n", "")
    for line in (3, 2):
        mark = timeline.back(1)
        assert (mark.skipped, session.executor.origin.line) == (0, line)
    mark = timeline.back(1)
    assert mark.skipped == 4
    assert (session.executor.origin.line, session.executor.variables[0].values) == (2, {"X": 1.0})
    assert finished(session) == ["1"]


def test_back_where_all_places_are_gone_changes_nothing(tmp_path):
    session = session_of(tmp_path, "FOR I = 1 TO 2\nX = I\nNEXT\nPRINT 1\n")
    stops_at(session, 2)
    timeline = Timeline(session.executor)
    fed(session, "Q = 1")
    stops_at(session, 4)
    del timeline._places[-1]  # but for the PRINT, all of them are in the loop
    session.executor.resume()
    stands(session)
    edited(session, "FOR I = 1 TO 2\nX = I\nNEXT\n", "")
    del timeline._places[-1]
    before = dump(session.executor.snapshot()), log_of(session)
    with pytest.raises(Fault) as refused:
        timeline.back(1)
    assert refused.value.code == "RBL545"
    assert (dump(session.executor.snapshot()), log_of(session)) == before
