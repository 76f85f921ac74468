"""A jog that has left the place where a program stands: the arm returns there before the program goes on."""

import numpy as np
import pytest

from tests.robolang.view.driving import INPUT, PROGRAM, Bench


@pytest.fixture
def bench(tmp_path, monkeypatch):
    return Bench(tmp_path, monkeypatch, PROGRAM)


def leave(bench, axis, **jog):
    """Start the program, pause it on its path, and jog away from there."""
    bench.send("start")
    bench.turns(150)
    assert bench.do("pause") is None
    bench.rest(alive=bench.jog(axis, **jog))


def test_a_program_that_was_left_by_a_jog_returns_to_its_path_first(bench):
    leave(bench, "X", step=10)
    bench.send("start")
    bench.turns(2)
    assert bench.facts.doing == "return"
    while bench.facts.doing != "nothing":
        bench.turn()
    assert (bench.facts.state, bench.facts.mode) == ("done", "AUTO")


def test_a_return_from_afar_is_refused_and_changes_nothing(bench):
    leave(bench, "J1", step=30, speed=100)
    before = bench.q
    assert bench.do("start") == "RBL541"
    assert (bench.facts.state, bench.facts.mode) == ("paused", "MANUAL")
    assert (bench.q == before).all()


def test_a_pause_on_the_return_leaves_the_program_where_it_stands(bench):
    leave(bench, "X", step=10)
    bench.send("start")
    bench.turns(10)
    assert bench.do("pause") is None
    assert bench.facts.state == "paused"


STANDING = """MOVEJ HERE + (0, 0, 20)
OUT(1) = 1
WAIT IN(1) = 1
MOVE HERE + (0, 0, 20), SPEED 400
"""


@pytest.fixture
def standing(tmp_path, monkeypatch):
    """Stands before its second statement."""
    bench = Bench(tmp_path, monkeypatch, STANDING, cell=INPUT)
    assert bench.do("step") is None
    bench.stood = bench.q
    return bench


@pytest.mark.parametrize("word", ["start", "step"])
def test_after_a_jog_between_two_statements_the_arm_returns_before_the_next(standing, word):
    standing.jogged("Z", 40)
    standing.jogged("X", 5)
    standing.send(word)
    standing.turns(2)
    assert (standing.facts.doing, standing.facts.outputs) == ("return", [])
    while standing.facts.doing == "return":
        standing.turn()
    while standing.facts.outputs == []:
        standing.turn()
    assert (standing.q == standing.stood).all()


def test_a_jog_in_a_wait_is_taken_back_as_well(standing):
    standing.send("start")
    standing.turns(30)
    assert standing.do("pause") is None
    standing.jogged("Z", 40)
    standing.send("start")
    standing.turns(2)
    assert standing.facts.doing == "return"
    standing.turns(500)
    assert (standing.facts.state, standing.facts.doing) == ("waiting", "program")
    assert (standing.q == standing.stood).all()


@pytest.mark.parametrize(("axis", "step"), [("Z", 51), ("J1", 11), ("J6", -11)])
def test_a_return_from_too_far_between_two_statements_is_refused(standing, axis, step):
    standing.jogged(axis, step)
    before = standing.q
    for word in ("start", "step"):
        assert standing.do(word) == "RBL541"
    assert (standing.facts.mode, standing.facts.next, standing.facts.outputs) == ("MANUAL", 2, [])
    assert (standing.q == before).all()
    # jogged back to within the limits
    standing.jogged(axis, -0.6 * step)
    assert standing.do("step") is None
    assert (standing.q == standing.stood).all()


def test_a_program_that_has_not_begun_begins_where_the_arm_is(bench):
    for again in (False, True):
        if again:
            assert bench.do("step") is None
            assert bench.do("restart") is None
        number = bench.jog("Z", step=60, speed=100)
        bench.rest(alive=number)
        bench.send("step")
        bench.turns(2)
        assert bench.facts.doing == "program"
        bench.rest()


def test_a_return_that_is_stopped_begins_anew(standing):
    standing.jogged("Z", 40)
    standing.send("start")
    standing.turns(20)
    assert standing.do("pause") is None
    assert (standing.facts.state, standing.facts.outputs) == ("paused", [])
    assert standing.do("step") is None
    assert (standing.q == standing.stood).all()


def test_after_an_alarm_in_a_jog_the_arm_returns_to_where_the_program_stood(standing):
    number = standing.jog("Z", step=40, speed=100)
    standing.turns(100, alive=number)
    assert standing.do("stop") is None
    assert standing.do("reset") is None
    assert (standing.facts.next, standing.facts.over, standing.facts.can_continue) == (2, True, True)
    assert np.abs(standing.q - standing.stood).max() > 1e-3
    assert standing.do("step") is None
    assert standing.facts.outputs == [[1, 1.0]]
    assert (standing.q == standing.stood).all()
