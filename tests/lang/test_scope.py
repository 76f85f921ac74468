import pytest

import robolang.scope as scope_module
from robolang.evaluator import MAX_ELEMENTS
from robolang.places import Place
from robolang.scope import Scope, Scopes
from runtime.faults import Fault


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
    names.stack.append(Scope(values={"X": 2.0}))
    assert (names.value("X"), names.value("P1")) == (2.0, 5.0)
    names.assign("P1", 7.0)
    names.stack.append(Scope())
    assert (names.value("X"), names.value("P1")) == (1.0, 5.0)  # of the main program, not of the caller
    names.stack.clear()
    names.stack.append(Scope())
    assert names.value("P1") == Place(point="P1")


def test_a_sub_cannot_change_what_its_caller_has(names):
    names.assign("X", 1.0)
    names.stack.append(Scope())
    names.assign("X", 2.0)
    assert names.value("X") == 2.0
    names.stack.pop()
    assert names.value("X") == 1.0


def test_constants(names):
    names.fix("K", 1.0)
    names.fix("K", 2.0)
    assert names.value("K") == 2.0
    assert code(names.assign, "K", 3.0) == "RBL531"
    names.stack.append(Scope())
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
    names.stack.append(Scope())
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
    names.stack.append(Scope())
    names.make("B", 4)
    assert code(names.make, "C", 0) == "RBL507"
    names.make("B", 4)  # in place of itself
    names.stack.pop()
    names.make("C", 4)
