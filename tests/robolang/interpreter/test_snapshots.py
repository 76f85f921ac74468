"""Snapshots of a machine: after each, at every step, the program goes on as it did, and nothing changes a snapshot."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import Pass, Show
from robolang.interpreter.events import DONE, Failed, LineBegun
from robolang.interpreter.machine import Machine
from robolang.interpreter.snapshot import MachineSnapshot
from robolang.planning.branch_forcing import open_conditions
from tests.campaign import examples
from tests.robolang.helpers import parsed
from tests.robolang.interpreter.stepping import EVERYTHING, Driver, programs, refusals

LONGEST = 80
"""Events of a program that are followed."""
AHEAD = 15
"""Events that are compared after a snapshot."""

CONSTANT = {
    "Machine._ready",
    "RunState.program",
    "RunState.world",
    "RunState.lines",
    "RunState.structure",
    "Scopes._points",
    "Evaluator._names",
    "Evaluator._world",
    "Actions._values",
    "Actions._scopes",
    "Decisions._patient",
    "MachineSnapshot.program",
    "Fed.lines",
    "Fed.first",
    "Fed._program",
    "Array._own",  # which blocks are shared is not state: it decides who copies
}
"""What a machine is made of and does not change while the program runs."""


def names_of(thing):
    if is_dataclass(thing):
        return [each.name for each in fields(thing)]
    slots = [name for kind in type(thing).__mro__ for name in getattr(kind, "__slots__", ())]
    return [*slots, *getattr(thing, "__dict__", ())]


def is_ours(thing):
    return type(thing).__module__.startswith("robolang.interpreter") or type(thing).__name__ == "Evaluator"


def dump(thing):
    """All that an object holds, as values that later changes do not reach; without what is constant."""
    if is_ours(thing):
        kind = type(thing).__name__
        frozen = is_dataclass(thing) and thing.__dataclass_params__.frozen
        held = {name: dump(getattr(thing, name)) for name in names_of(thing) if f"{kind}.{name}" not in CONSTANT}
        return f"{kind} (frozen)" if frozen else kind, held
    if isinstance(thing, Mapping):
        return {key: dump(value) for key, value in thing.items()}
    if isinstance(thing, set | frozenset):
        return set(thing)
    if isinstance(thing, list | tuple):
        return [dump(value) for value in thing]
    return thing


def held_by(dumped):
    """Every attribute in a dump that can be assigned, as ``Class.name``, with what it holds."""
    if isinstance(dumped, tuple):
        kind, held = dumped
        for name, value in held.items():
            if "frozen" not in kind:
                yield f"{kind}.{name}", value
            yield from held_by(value)
    elif isinstance(dumped, dict | list):
        for value in dumped.values() if isinstance(dumped, dict) else dumped:
            yield from held_by(value)


def followed(driver, most=LONGEST):
    """The events of a program, with the state before each, and what the machine and the snapshot then held."""
    events, states = [], []
    while len(events) < most and events[-1:] != [DONE] and not isinstance((events or [None])[-1], Failed):
        state = driver.keep()
        states.append((state, dump(driver.machine), dump(state.machine)))
        events.append(driver.step())
    return events, states


@given(programs, refusals, st.integers(0, 2))
@examples(300, 30)
def test_after_a_snapshot_the_events_are_the_same(program, refused, seed):
    driver = Driver(program, refused, seed, Decisions())
    events, states = followed(driver)
    for at, (state, held, kept) in enumerate(states):
        expected = events[at : at + AHEAD]
        assert dump(state.machine) == kept, "going on has changed a snapshot"
        for machine in (driver, driver.fresh()):  # one that has gone on, one at its beginning
            machine.take_back(state)
            assert dump(machine.machine) == held
            assert machine.steps(len(expected)) == expected


def test_every_attribute_changes_in_a_run_or_is_listed_as_constant():
    """A new attribute shows up here: it changes in this program, or belongs into ``CONSTANT``."""
    driver = Driver(EVERYTHING, {3}, decisions=Decisions({next(iter(open_conditions(EVERYTHING))): True}))
    dumps = [held for _, held, _ in followed(driver, 2000)[1]]
    dumps.append(dump(driver.machine))
    driver.machine.feed(parsed("GOSUB *G").lines[0])
    dumps.append(dump(driver.machine))
    seen = {}
    for held in dumps:
        for name, value in held_by(held):
            seen.setdefault(name, []).append(value)
    still = {name for name, values in seen.items() if all(value == values[0] for value in values)}
    assert still == set(), "is that restored? change it in EVERYTHING, or list it in CONSTANT"


@pytest.mark.parametrize("name", [each.name for each in fields(MachineSnapshot) if each.name != "program"])
def test_each_field_of_a_snapshot_is_missed_without_it(name):
    """With one field of the beginning in its place, some state is not that of its snapshot."""
    driver = Driver(EVERYTHING, {3}, decisions=Decisions({next(iter(open_conditions(EVERYTHING))): True}))
    _, states = followed(driver, 2000)
    if name == "suspended":
        driver.machine.feed(parsed("GOSUB *G").lines[0])
        states.append((driver.keep(), dump(driver.machine), None))
    first, missed = states[0][0].machine, 0
    for state, held, _ in states:
        driver.take_back(replace(state, machine=replace(state.machine, **{name: getattr(first, name)})))
        missed += dump(driver.machine) != held
    assert missed > 0


# --- what a snapshot is kept apart from ------------------------------------------------------------------------------


def state_at(text, most):
    """A driver after so many statements have begun, and its state."""
    driver = Driver(parsed(text))
    while most:
        most -= isinstance(driver.step(), LineBegun)
    return driver, driver.keep()


def shown(driver):
    return [event.text for event in driver.steps(500) if isinstance(event, Show)]


@pytest.mark.parametrize(
    ("text", "statements"),
    [
        ("DIM a(600)\na(1) = 1\na(1) = a(1) + 1\na(600) = a(1)\nPRINT a(1); a(600)", 3),
        ("DIM a(3)\nCALL s\nPRINT a(1)\nSUB s\na(1) = a(1) + 1\nPRINT a(1)\nENDSUB", 4),
        ("x = 1\nx = x + 1\nPRINT x", 2),
        ("CALL s(1)\nSUB s(p)\np = p + 1\nPRINT p\nENDSUB", 2),
        ("FOR i = 1 TO 3\nPRINT i\nNEXT", 3),
        ("GOSUB *G\nPRINT 2\nEND\n*G PRINT 1\nRETURN", 2),
        ("CONST k = 1\nCONST k = 1\nPRINT k", 1),
        ("x = 0\nON ERROR GOTO *H\nPRINT 1 / x\nPRINT 2\nEND\n*H PRINT ERR\nRESUME NEXT", 2),
    ],
)
def test_a_snapshot_is_restored_as_often_as_one_likes(text, statements):
    driver, state = state_at(text, statements)
    kept = dump(state.machine)
    first = shown(driver)
    assert first
    for _ in range(3):
        driver.take_back(state)
        assert shown(driver) == first
        assert dump(state.machine) == kept


def test_a_snapshot_inside_of_a_wait_keeps_when_it_began():
    driver, _ = state_at("WAIT IN(1) = 5, TIMEOUT 0.08, GOTO *L\nPRINT 1\n*L PRINT TIMER", 1)
    driver.steps(4)
    state = driver.keep()
    rest = driver.steps(50)
    assert sum(isinstance(event, Pass) for event in rest) == 7
    driver.take_back(state)
    assert driver.steps(50) == rest


def test_a_snapshot_keeps_what_is_left_to_force():
    program = parsed("FOR i = 1 TO 3\nIF IN(1) = 5 THEN PRINT i\nNEXT")
    (place,) = open_conditions(program)
    decisions = Decisions({place: True})
    driver = Driver(program, decisions=decisions)
    state = driver.keep()
    assert shown(driver) == ["1"]
    assert decisions.taken == {place: {True, False}}
    driver.take_back(state)
    assert decisions.taken == {}
    assert shown(driver) == ["1"]


def test_a_snapshot_of_another_program_is_refused():
    one, other = (Machine(parsed(text), None, ()) for text in ("x = 1", "x = 2"))
    with pytest.raises(ValueError, match="program"):
        one.restore(other.snapshot())


def test_a_snapshot_shares_the_blocks_of_arrays_that_do_not_change():
    driver, _ = state_at("DIM a(99999)\na(7) = 1\na(7) = 2\nPRINT a(7)", 3)
    blocks = [driver.keep().machine.scopes[0].arrays["A"]._blocks]
    driver.step()
    blocks.append(driver.keep().machine.scopes[0].arrays["A"]._blocks)
    assert [one is other for one, other in zip(*blocks, strict=True)] == [False] + [True] * (len(blocks[0]) - 1)
