"""Values at the prompt: in the present scope, in the middle of a wait or of a move, and nothing changes."""

import numpy as np
import pytest

from robolang.execution.measured import AXIS_FUNCTIONS
from robolang.execution.status import State
from robolang.execution.watching import evaluate, printed
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault
from runtime.core.units import MM
from tests.robolang.execution.standing import dump, fed, jogged, log_of, paused_after, session_of, stands, stops_at

TEXT = 'X = 2\nT$ = "a"\nDIM A(3)\nA(2) = 7\nMOVE P1\nCALL S(5)\nEND\nSUB S(K)\nX = 9\nMOVE P2\nDELAY 0.4\nENDSUB\n'


def number(session, text):
    found = evaluate(session.executor, text)
    assert isinstance(found, float)
    return found


def value(session, text):
    return printed(session.executor, evaluate(session.executor, text))


def test_values_are_those_of_the_scope_where_the_program_stands(tmp_path):
    session = session_of(tmp_path, TEXT)
    stops_at(session, 5)
    assert [value(session, text) for text in ("X + 1", 'T$ + "b"', "A(2)", "x > 1")] == ["3", "ab", "7", "1"]
    with pytest.raises(Fault):
        evaluate(session.executor, "K")
    stops_at(session, 10)
    assert [value(session, text) for text in ("X", "K", "A(2)", "ERR")] == ["9", "5", "7", "0"]
    session.executor.stops_before = None
    session.executor.resume()
    stands(session)
    assert value(session, "X") == "2"


def test_here_is_where_the_arm_is_commanded_to_be(tmp_path):
    """In a pause within a move, after a jog there, and in a wait; it is not where the move would have ended."""
    session = session_of(tmp_path, TEXT)
    paused_after(session, 50)
    for _ in range(2):
        before, log = dump(session.executor.snapshot()), log_of(session)
        X = session.controller.tool_poses(session.controller.areas.ina)
        assert number(session, "HERE.X") == pytest.approx(X[0, 3] / MM)
        place = evaluate(session.executor, "HERE")
        assert printed(session.executor, place).startswith(f"({X[0, 3] / MM:.3f}, {X[1, 3] / MM:.3f}, ")
        assert number(session, "DIST(HERE, P1)") > 1.0
        assert (dump(session.executor.snapshot()), log_of(session)) == (before, log)
        jogged(session, most=0.02, back=False)
    session.executor.regain()
    stands(session)
    session.executor.resume()
    while session.executor.origin.line != 11:
        assert session.executor.advance().state is State.RUNNING
    paused_after(session, 3)
    assert number(session, "DIST(HERE, P2)") < 1e-9
    assert evaluate(session.executor, "TIMER") == session.executor.time_us / 1e6


def test_an_active_frame_holds_for_values(tmp_path):
    session = session_of(tmp_path, "FRAME POSE(100, 0, 0, 0, 0, 0)\nX = 1\n")
    free = session_of(tmp_path, "FRAME POSE(100, 0, 0, 0, 0, 0)\nX = 1\n")
    stops_at(session, 2)
    stops_at(free, 1)
    assert number(session, "P1.X") == pytest.approx(number(free, "P1.X") - 100.0)


@pytest.mark.physics
@pytest.mark.parametrize("name", AXIS_FUNCTIONS)
def test_functions_of_axes_are_those_of_the_controller(tmp_path, name):
    session = session_of(tmp_path, "MOVE P1\n", physics=True)
    assert np.isfinite([number(session, f"{name}({axis})") for axis in range(1, 7)]).all()
    paused_after(session, 40)
    signals = session.controller.signals()
    expected = {
        "TORQUE": signals["tau_sat"][-1],
        "ANGLE": np.degrees(session.controller.servo.alpha),
        "RATE": np.degrees(signals["dq_fb"][-1]),
        "LAG": np.degrees(session.controller.servo.q_ref - session.controller.servo.alpha),
    }[name]
    found = [number(session, f"{name.lower()}({axis})") for axis in range(1, 7)]
    np.testing.assert_allclose(found, expected)
    for axis in (0, 7):
        with pytest.raises(Fault) as refused:
            evaluate(session.executor, f"{name}({axis})")
        assert refused.value.code == "RBL507"
    fed(session, f"DIM {name}(2)")
    assert evaluate(session.executor, f"{name}(0)") == 0.0


@pytest.mark.parametrize(
    ("text", "code", "column"),
    [("X +", "RBL111", 4), ("X = 1 2", "RBL111", 7), ("", "RBL111", 1), ("1; 2", "RBL111", 4), ("X\nY", "RBL112", 1)],
)
def test_a_text_that_is_no_expression_is_refused_at_its_place(tmp_path, text, code, column):
    session = session_of(tmp_path, "X = 1\n")
    with pytest.raises(FileFault) as refused:
        evaluate(session.executor, text)
    assert (refused.value.code, refused.value.column) == (code, column)
