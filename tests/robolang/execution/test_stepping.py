"""Steps, lines and breakpoints: where a program stops, in recursion too."""

import pytest

from robolang.execution.status import State
from robolang.execution.stepping import Breakpoint, Into, Over, StopsAt, To, hit, out, over
from robolang.execution.timeline import Timeline
from robolang.interpreter.events import LineBegun
from tests.robolang.execution.standing import session_of, shown, stands

TEXT = """X = 3
CALL F(X)
GOSUB *G
PRINT X
END
*G X = X + 1
CALL F(1)
RETURN
SUB F(N)
IF N = 0 THEN RETURN
CALL F(N - 1)
PRINT N
ENDSUB
"""


def goes(session, *stops):
    """Go on to one of some stops; returns the line and the level there, None at the end."""
    session.executor.stops_before = hook = StopsAt(session.executor, stops)
    session.executor.resume()
    if stands(session).state is not State.PAUSED:
        return None
    assert hook.last.stop in stops
    return session.executor.origin.line, session.executor.level


def at(session, line):
    assert goes(session, To(line=line))[0] == line
    return session


def test_a_step_into_follows_every_statement(tmp_path):
    session, lines = session_of(tmp_path, TEXT), []
    while (found := goes(session, Into())) is not None:
        lines.append(found)
    assert lines[:9] == [(1, 0), (2, 0), (10, 1), (11, 1), (10, 2), (11, 2), (10, 3), (11, 3), (10, 4)]
    assert [line for line, level in lines if level == 0] == [1, 2, 3, 4, 5]
    assert shown(session) == ["1", "2", "3", "1", "4"]


def test_a_step_over_takes_calls_as_one_statement(tmp_path):
    session, lines = session_of(tmp_path, TEXT), []
    goes(session, Into())
    while (found := goes(session, over(session.executor))) is not None:
        lines.append(found[0])
    assert lines == [2, 3, 4, 5]
    session = at(session_of(tmp_path, TEXT), 11)
    assert goes(session, over(session.executor)) == (12, 1)
    assert shown(session) == ["1", "2"]
    assert goes(session, over(session.executor)) == (13, 1)
    assert goes(session, over(session.executor)) == (3, 0)


def test_a_step_out_ends_when_the_call_has_come_back(tmp_path):
    session = at(session_of(tmp_path, TEXT), 2)
    assert goes(session, Into()) == (10, 1)
    assert goes(session, Into()) == (11, 1)
    assert goes(session, Into()) == (10, 2)
    assert goes(session, out(session.executor)) == (12, 1)
    assert goes(session, out(session.executor)) == (3, 0)
    assert goes(session, Into()) == (6, 1)
    assert goes(session, out(session.executor)) == (4, 0)
    assert goes(session, out(session.executor)) is None


def test_an_error_that_leaves_a_call_ends_a_step_over_it(tmp_path):
    text = "ON ERROR GOTO *H\nCALL S(0)\nPRINT 1\nEND\n*H RESUME NEXT\nSUB S(K)\nX = 1 / K\nENDSUB\n"
    session = at(session_of(tmp_path, text), 2)
    assert goes(session, over(session.executor)) == (5, 0)
    assert goes(session, over(session.executor)) == (3, 0)


@pytest.mark.parametrize(
    ("condition", "values"),
    [("", [1, 2, 3, 4]), ("I >= 3", [3, 4]), ("I MOD 2 = 0", [2, 4]), ("I > 9", []), ('K$ = "ok" AND I = 2', [2])],
)
def test_a_breakpoint_stops_where_its_condition_is_true(tmp_path, condition, values):
    session = session_of(tmp_path, 'K$ = "ok"\nFOR I = 1 TO 4\nX = I\nNEXT\n')
    stop, found = Breakpoint(line=3, condition=condition), []
    while goes(session, stop) is not None:
        found.append(session.executor.variables[0].values["I"])
    assert found == values


@pytest.mark.parametrize(
    ("condition", "code"), [("Q > 1", "RBL532"), ("1 / (I - I)", "RBL501"), ("I >", "RBL111"), ('"a"', "RBL531")]
)
def test_a_condition_without_a_value_stops_there(tmp_path, condition, code):
    session = session_of(tmp_path, "FOR I = 1 TO 4\nX = I\nNEXT\n")
    stop = Breakpoint(line=2, condition=condition)
    assert goes(session, stop) == (2, 0)
    assert session.executor.stops_before.last.fault.code == code
    assert goes(session, stop, Breakpoint(line=3)) == (3, 0)
    assert session.executor.stops_before.last.fault is None


def test_the_first_of_several_stops_is_named():
    class Executor:
        level = 1

    begun = LineBegun(line=7, number=None, span=None, node=None)
    stops = [Over(level=0), To(line=6), Breakpoint(line=7), Into()]
    assert hit(Executor(), begun, stops).stop == Breakpoint(line=7)
    assert hit(Executor(), begun, stops[:2]) is None


def test_steps_and_the_way_back_go_together(tmp_path):
    session = session_of(tmp_path, TEXT)
    timeline = Timeline(session.executor)
    at(session, 3)
    timeline.back(3)
    assert (session.executor.origin.line, session.executor.level) == (13, 2)
    assert goes(session, out(session.executor)) == (12, 1)
    assert goes(session, over(session.executor)) == (13, 1)
