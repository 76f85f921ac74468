import pytest

import robolang.interpreter.scope as scope_module
from robolang.interpreter.scope import SHIFT, Scopes
from robolang.values.poses import Place, Shift
from runtime.core.faults import Fault
from runtime.core.limits import SIZE

MAX_ELEMENTS = int(SIZE.high) + 1


@pytest.fixture
def names():
    return Scopes(frozenset({"P1"}))


def code(call, *args):
    with pytest.raises(Fault) as caught:
        call(*args)
    return caught.value.code


def test_a_name_is_looked_up_from_the_inside_to_the_points(names):
    assert (names.value("P1"), names.value("X")) == (Place(point="P1"), None)
    names.assign("X", 1.0)
    names.assign("P1", 5.0)
    names.enter(1, {"X": 2.0})
    assert (names.value("X"), names.value("P1")) == (2.0, 5.0)
    names.assign("P1", 7.0)
    names.enter(1, {})
    assert (names.value("X"), names.value("P1")) == (1.0, 5.0)  # of the main program, not of the caller
    names.leave()
    names.leave()
    assert names.leave() is None
    assert names.value("P1") == 5.0
    names = Scopes(frozenset({"P1"}))
    assert names.value("P1") == Place(point="P1")


def test_a_sub_cannot_change_what_its_caller_has(names):
    names.assign("X", 1.0)
    names.enter(1, {})
    names.assign("X", 2.0)
    assert names.value("X") == 2.0
    assert names.leave() == 1
    assert names.value("X") == 1.0


def test_constants(names):
    names.fix("K", 2.0)
    names.fix("K", 2.0)  # the same statement in a loop
    assert code(names.fix, "K", 3.0) == "RBL531"
    assert names.value("K") == 2.0
    assert code(names.assign, "K", 3.0) == "RBL531"
    names.enter(1, {})
    assert code(names.assign, "K", 3.0) == "RBL531"
    assert names.value("K") == 2.0


@pytest.mark.parametrize(("key", "value"), [("S$", 1.0), ("S$", Place(last=True)), ("X", "a")])
def test_names_that_end_in_dollar_hold_texts_and_only_they_do(names, key, value):
    names.make("A", 1)
    names.make("A$", 1)
    assert code(names.assign, key, value) == "RBL531"
    assert code(names.fix, key, value) == "RBL531"
    assert code(names.put, "A$" if key == "S$" else "A", 0, value) == "RBL531"


def test_arrays(names):
    assert names.element("A", 0) is None
    assert code(names.put, "A", 0, 1.0) == "RBL532"
    names.make("A", 2)
    names.make("A$", 0)
    names.put("A", 2, Place(point="P1"))
    assert [names.element("A", index) for index in range(3)] == [0.0, 0.0, Place(point="P1")]
    assert names.element("A$", 0) == ""
    for index in (-1, 3):
        assert code(names.element, "A", index) == "RBL507"
        assert code(names.put, "A", index, 1.0) == "RBL507"
    names.enter(1, {})
    names.put("A", 0, 4.0)  # an array of the main program is one for all
    names.make("A", 0)
    assert (names.element("A", 0), names.stack[0].arrays["A"][0]) == (0.0, 4.0)


def test_the_size_of_an_array_is_bounded(names):
    names.make("A", 0)
    names.make("A", MAX_ELEMENTS - 1)
    assert code(names.make, "A", MAX_ELEMENTS) == "RBL507"
    assert code(names.make, "A", -1) == "RBL507"


def test_the_size_of_all_arrays_is_bounded(names, monkeypatch):
    monkeypatch.setattr(scope_module, "MAX_CELLS", 10)
    names.make("A", 4)
    names.enter(1, {})
    names.make("B", 4)
    assert code(names.make, "C", 0) == "RBL507"
    names.make("B", 4)  # in place of itself
    assert names.leave() == 1
    names.make("C", 4)


def test_names_count_as_elements(names, monkeypatch):
    monkeypatch.setattr(scope_module, "MAX_CELLS", 4)
    names.make("A", 1)
    names.assign("X", 1.0)
    names.enter(1, {"Y": 1.0})
    names.assign("Y", 2.0)
    assert code(names.assign, "Z", 1.0) == "RBL507"
    assert code(names.enter, 1, {"Z": 1.0}) == "RBL507"
    assert names.leave() == 1  # and gives back what the SUB had
    names.fix("Z", 1.0)
    assert code(names.fix, "W", 1.0) == "RBL507"


def test_all_texts_together_are_bounded(names, monkeypatch):
    monkeypatch.setattr(scope_module, "MAX_TEXTS", 10)
    names.make("A$", 1)
    names.put("A$", 0, "1234")
    names.assign("S$", "123456")
    for call in (
        (names.assign, "T$", "1"),
        (names.put, "A$", 1, "1"),
        (names.put, "A$", 0, "12345"),
        (names.fix, "K$", "1"),
        (names.enter, 1, {"P$": "1"}),
        (names.assign, "S$", "1234567"),
    ):
        assert code(*call) == "RBL506"
    assert (names.value("T$"), names.element("A$", 0), names.value("S$")) == (None, "1234", "123456")
    names.assign("S$", "12345")
    names.enter(1, {"P$": "1"})
    names.put("A$", 0, "")  # of the main program
    names.assign("Q$", "1234")
    assert code(names.assign, "R$", "1") == "RBL506"
    assert names.leave() == 1
    names.make("A$", 0)
    names.put("A$", 0, "12345")
    assert code(names.assign, "T$", "1") == "RBL506"
    names.make("A$", 0)
    names.assign("T$", "12345")


def test_ways_behind_poses_count_as_text(names, monkeypatch):
    monkeypatch.setattr(scope_module, "MAX_TEXTS", 3 * SHIFT)
    turn = Shift(kind="tool", by=(0.0, 0.0, 0.0, 1.0, 0.0, 0.0))
    names.make("A", 1)
    names.put("A", 0, Place(point="P1", shifts=(turn, turn)))
    names.assign("P", Place(point="P1", shifts=(turn,)))
    assert code(names.put, "A", 1, Place(point="P1", shifts=(turn,))) == "RBL506"
    names.put("A", 1, Place(point="P1"))
    names.put("A", 0, 1.0)
    names.put("A", 1, Place(point="P1", shifts=(turn, turn)))


def test_a_constant_stays_one_when_it_cannot_be_given_its_value(names):
    names.fix("K", 1.0)
    assert code(names.fix, "K", "a") == "RBL531"
    assert code(names.assign, "K", 2.0) == "RBL531"
