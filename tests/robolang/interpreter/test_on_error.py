"""ON ERROR: what is caught, in which scope its handler runs, where RESUME leads, and that nothing piles up."""

import pytest

from robolang.core.source import Span
from robolang.interpreter import run_limits
from robolang.interpreter.effects import MoveTo, Show
from robolang.interpreter.program_fault import ProgramFault
from robolang.interpreter.run_limits import MAX_CALLS
from runtime.core.faults import Fault
from tests.robolang.helpers import parsed
from tests.robolang.running import POINTS, World, execute, fault, shows


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ('ON ERROR GOTO *H\nx = 1 / n\nPRINT "after"; x\nEND\n*H PRINT ERR\nn = 2\nRESUME', "501 after0.5"),
        ('ON ERROR GOTO *H\nx = SQR(n - 1)\nPRINT "after"\nEND\n*H PRINT ERR\nRESUME NEXT', "502 after"),
        ('ON ERROR GOTO *H\nIF 1 / n THEN PRINT 1\nPRINT "after"\nEND\n*H RESUME NEXT', "after"),
        (
            'y = 3\nON ERROR GOTO *H\nCALL f\nPRINT "after"\nEND\n*H PRINT y\nRESUME NEXT\n'
            "SUB f\ny = 7\nx = 1 / n\nPRINT y\nENDSUB",
            "3 after",
        ),
        ("ON ERROR GOTO *H\nFOR i = 1 TO 2\nx = 1 / n\nNEXT\nEND\n*H PRINT i\nRESUME NEXT", "1 2"),
        ("PRINT ERR", "0"),
    ],
)
def test_errors_are_caught(text, printed):
    assert " ".join(shows("n = 0\n" + text)) == printed


def test_an_error_inside_the_handler_is_not_caught():
    found = fault("n = 0\nON ERROR GOTO *H\nx = 1 / n\nEND\n*H x = SQR(n - 1)\nRESUME")
    assert (found.code, found.origin.line) == ("RBL502", 5)


def test_on_error_stop_and_a_new_handler():
    assert fault("n = 0\nON ERROR GOTO *H\nON ERROR STOP\nx = 1 / n\n*H END").origin.line == 4
    text = 'n = 0\nON ERROR GOTO *H\nx = 1 / n\n*H ON ERROR GOTO *K\nx = 1 / n\n*K PRINT "k"'
    assert shows(text) == ["k"]


def thrown(text, code="RBL410"):
    """What a program prints when its first move is refused by the session."""
    program = execute(parsed(text), World(), POINTS)
    found, effect = [], next(program, None)
    refused = False
    while effect is not None:
        if isinstance(effect, Show):
            found.append(effect.text)
        if isinstance(effect, MoveTo) and not refused:
            refused = True
            effect = program.throw(Fault(code, "no"))
            continue
        if isinstance(effect, MoveTo):
            found.append(effect.target.point)
        effect = next(program, None)
    return found


def test_a_refusal_of_the_session_is_caught_where_the_move_stands():
    text = "ON ERROR GOTO *H\nMOVE P1\nMOVE P2\nEND\n*H PRINT ERR\n"
    assert thrown(text + "RESUME") == ["410", "P1", "P2"]
    assert thrown(text + "RESUME NEXT") == ["410", "P2"]
    assert thrown(text + "MOVE A") == ["410", "A"]
    assert thrown("ON ERROR GOTO *H\nIF 1 THEN MOVE P1\nMOVE P2\nEND\n*H RESUME NEXT") == ["P2"]
    with pytest.raises(ProgramFault) as caught:
        thrown("' x\nMOVE P1")
    assert (caught.value.code, caught.value.origin.line, caught.value.origin.span) == ("RBL410", 2, Span(4, 11))


# --- scopes ----------------------------------------------------------------------------------------------------------

MAIN = 'n = 0\nwhere$ = "main"\nON ERROR GOTO *H\n'
FAIL = 'SUB fail\nwhere$ = "fail"\nx = 1 / n\nPRINT "in " + where$\nENDSUB\n'


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        # the handler of the main program runs in it; RESUME makes the CALL again, RESUME NEXT goes on behind it
        ("CALL fail\nPRINT where$\nEND\n*H PRINT where$\nn = 1\nRESUME\n" + FAIL, "main in fail main"),
        ("CALL fail\nPRINT where$\nEND\n*H PRINT where$\nRESUME NEXT\n" + FAIL, "main main"),
        ("CALL outer\nEND\n*H PRINT where$\nRESUME NEXT\nSUB outer\nCALL fail\nPRINT 1\nENDSUB\n" + FAIL, "main"),
        ("IF 1 THEN CALL fail\nPRINT 1\nEND\n*H RESUME NEXT\n" + FAIL, "1"),
        # a SUB has its own, and the caller's is in force again behind it
        (
            "CALL own\nx = 1 / n\nEND\n*H PRINT where$\nRESUME NEXT\n"
            'SUB own\nwhere$ = "own"\nON ERROR GOTO *K\nCALL fail\nPRINT "on"\nRETURN\n'
            "*K PRINT where$; ERR\nRESUME NEXT\n"
            "ENDSUB\n" + FAIL,
            "own501 on main",
        ),
        (
            "CALL own\nCALL fail\nEND\n*H PRINT where$\nRESUME NEXT\n"
            "SUB own\nON ERROR GOTO *K\nx = 1 / n\nRETURN\n*K ENDSUB\n" + FAIL,
            "main",
        ),  # left without a RESUME
        # a handler may call what has one of its own
        (
            "x = 1 / n\nPRINT 2\nEND\n*H CALL own\nRESUME NEXT\n"
            'SUB own\nON ERROR GOTO *K\nx = 1 / n\nRETURN\n*K PRINT "own"\nRESUME NEXT\nENDSUB',
            "own 2",
        ),
        # GOSUB: RESUME goes back into it
        ("GOSUB *G\nPRINT 9\nEND\n*G PRINT 1\nx = 1 / n\nPRINT 2\nRETURN\n*H PRINT ERR\nRESUME NEXT", "1 501 2 9"),
        ("GOSUB *G\nPRINT 9\nEND\n*G CALL fail\nPRINT 2\nRETURN\n*H n = 1\nRESUME\n" + FAIL, "in fail 2 9"),
        ("GOSUB *G\nPRINT 9\nEND\n*G ON ERROR GOTO *K\nx = 1 / n\n*H END\n*K PRINT 3\nRETURN", "3 9"),
    ],
)
def test_the_handler_belongs_to_the_scope_that_said_so(text, printed):
    assert " ".join(shows(MAIN + text)) == printed


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("CALL s\nEND\n*H RESUME NEXT\nSUB s\nON ERROR STOP\nx = 1 / n\nENDSUB", 9),  # the SUB wants it so
        ("CALL s\nEND\n*H RESUME NEXT\nSUB s\nON ERROR STOP\nCALL fail\nENDSUB\n" + FAIL, 13),
        ("x = 1 / n\nEND\n*H CALL fail\nRESUME\n" + FAIL, 10),  # in a handler, and what it calls has none
        ("CALL fail\nEND\n*H CALL back\nSUB back\nRESUME\nENDSUB\n" + FAIL, 8),  # RESUME belongs to the handler
    ],
)
def test_what_is_not_caught_is_named_where_it_happened(text, line):
    assert fault(MAIN + text).origin.line == line


def test_the_handler_of_a_sub_ends_with_it():
    text = "n = 0\nCALL s\nx = 1 / n\nSUB s\nON ERROR GOTO *K\nRETURN\n*K RESUME NEXT\nENDSUB"
    assert fault(text).origin.line == 3


@pytest.mark.parametrize("leave", ["RESUME NEXT", "ON ERROR GOTO *H\nGOTO *MORE"])
@pytest.mark.parametrize("how", ["CALL fail", "GOSUB *G"])
def test_a_thousand_errors_leave_nothing_behind(how, leave):
    text = f"CONST times = 1000\nc = 0\n*TOP c = c + 1\n{how}\n*MORE IF c < times THEN GOTO *TOP\nPRINT c\nEND\n"
    text += f"*G CALL fail\nRETURN\n*H IF ERR <> 501 THEN PRINT ERR\n{leave}\n" + FAIL
    assert 1000 > MAX_CALLS
    assert shows(MAIN + text) == ["1000"]


def test_depth_is_what_it_was_after_an_error():
    deep = "SUB deep(k)\nIF k > 1 THEN CALL deep(k - 1)\nIF k <= 1 THEN x = 1 / n\nENDSUB\n"
    text = f"CALL deep({MAX_CALLS})\nCALL deep({MAX_CALLS})\nPRINT 1\nEND\n*H PRINT ERR\nRESUME NEXT\n{deep}"
    assert shows(MAIN + text) == ["501", "501", "1"]
    text = text.replace(f"deep({MAX_CALLS})", f"deep({MAX_CALLS + 1})")
    assert shows(MAIN + text) == ["504", "504", "1"]


def test_a_handler_above_the_statement_that_fails_is_a_loop_as_well(monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_IDLE", 1000)
    found = fault("n = 0\nGOTO *TOP\n30 *H RESUME\n*TOP ON ERROR GOTO *H\nx = 1 / n")
    assert (found.code, found.origin.number) == ("RBL508", 30)


def test_a_move_that_is_refused_takes_no_time(monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_IDLE", 1000)
    program = execute(parsed("10 ON ERROR GOTO *H\n20 MOVE P1\n30 END\n40 *H RESUME"), World(), POINTS)
    next(program)
    with pytest.raises(ProgramFault) as caught:
        for _ in range(1001):
            program.throw(Fault("RBL410", "no"))
    assert (caught.value.code, caught.value.origin.number) == ("RBL508", 20)


@pytest.mark.parametrize("code", ["RBL505", "RBL506", "RBL508", "RBL509"])
def test_limits_of_the_run_are_not_caught(code):
    program = execute(parsed("ON ERROR GOTO *H\nDELAY 1\n*H END"), World(), POINTS)
    next(program)
    with pytest.raises(ProgramFault, match=code):
        program.throw(Fault(code, "too much"))
