"""Outputs and the inputs that follow them can be taken back, pulses that still run included."""

import pytest

from runtime.cell.signals import InputSpec, Signals, read_input
from runtime.core.tomlfile import FileFault, Source, load_table
from tests.messages import numbers


def test_signals_go_back_to_a_snapshot_again_and_again():
    signals = Signals({1: InputSpec(follows=7, delay_us=1000)})
    signals.set(7, 1.0, 0, off_us=5000)
    kept = signals.snapshot()
    for _ in range(2):
        signals.set(7, 0.0, 2000)
        signals.set(8, 1.0, 2000)
        assert (signals.output(7, 3000), signals.output(8, 3000), signals.input(1, 4000)) == (0.0, 1.0, 0.0)
        signals.restore(kept)
        assert (signals.output(7, 3000), signals.output(8, 3000), signals.input(1, 4000)) == (1.0, 0.0, 1.0)
        assert signals.output(7, 5000) == 0.0
    other = Signals({})
    other.restore(kept)
    other.set(7, 0.0, 1000)
    assert signals.output(7, 3000) == 1.0


@pytest.mark.parametrize("changes", ['[1, "on"]', '[[1, "on"]]', "[[1]]", "[[1, 1, 1]]", "[[1, true]]", "[1]"])
def test_changes_that_are_no_pairs_of_numbers_are_answered_with_their_form(changes):
    with pytest.raises(FileFault) as caught:
        read_input(load_table(Source("cell.toml", f"changes = {changes}\n")))
    assert (caught.value.code, caught.value.line) == ("RBL613", 1)
    assert numbers(caught.value.hint) == [1.0, 0.0]  # the states that may be meant by a word


@pytest.mark.parametrize("changes", ["[[0, nan]]", "[[inf, 1]]"])
def test_changes_that_are_not_finite_keep_their_code(changes):
    with pytest.raises(FileFault) as caught:
        read_input(load_table(Source("cell.toml", f"changes = {changes}\n")))
    assert caught.value.code == "RBL604"


class Counted(list):
    """A list that counts how often it is read from its start."""

    reads = 0

    def __iter__(self):
        self.reads += 1
        return super().__iter__()


def test_a_forced_input_does_not_cost_what_was_forced_before():
    signals = Signals({1: InputSpec(changes=((0, 5.0),)), 2: InputSpec(changes=((0, 6.0),))})
    signals._held = history = Counted()
    before = signals.snapshot()
    reads = history.reads
    for at in range(100):
        signals.force(1 + at % 2, float(at), at)
    assert (history.reads, len(history)) == (reads, 100)
    assert dict(signals.forced) == {1: 98.0, 2: 99.0}
    after = signals.snapshot()
    signals.force(1, None, 100)
    assert (signals.input(1, 100), signals.input(2, 100)) == (5.0, 99.0)
    signals.restore(after)
    assert dict(signals.forced) == {1: 98.0, 2: 99.0}
    signals.restore(before)
    assert signals.forced == {}


def test_changes_of_a_forced_input_are_those_that_it_had_in_turn():
    signals = Signals({1: InputSpec(changes=((0, 5.0), (25, 6.0)))})
    for us, state in ((10, 1.0), (10, 2.0), (20, 2.0), (30, None), (40, 6.0), (50, 0.0), (60, 0.0)):
        signals.force(1, state, us)
    assert signals.input_changes(55) == {1: [(0, 5.0), (10, 2.0), (30, 6.0), (50, 0.0)]}
