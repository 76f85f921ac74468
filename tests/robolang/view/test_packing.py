"""Columns of numbers as bytes, read back by a decoder that was written from their description."""

import gzip
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robolang.view.packing import Signal, pack
from tests.robolang.view.decoding import furthest, unpacked


def packed(*columns, name="q", **header):
    return pack(header, [Signal(name=name, base="tick", dt=0.001, values=np.array(columns, dtype=float).T)])


def read(*columns):
    header, found = unpacked(packed(*columns))
    return header["signals"][0], found["q"]


def step(values):
    known = [value for value in values if math.isfinite(value) and abs(value) <= 1e30]
    return (max(known) - min(known)) / (2**24 - 2) if known else 0.0


@settings(max_examples=200, deadline=None)
@given(
    arrays(float, st.tuples(st.integers(0, 40), st.integers(1, 4)), elements=st.floats(-1e30, 1e30, width=64)),
    st.lists(st.tuples(st.integers(0, 39), st.integers(0, 3), st.sampled_from([math.nan, math.inf, -math.inf]))),
)
def test_every_number_comes_back_within_half_a_step_and_every_gap_as_a_gap(values, gaps):
    for row, column, gap in gaps:
        if row < values.shape[0] and column < values.shape[1]:
            values[row, column] = gap
    listed, columns = read(*values.T)
    assert (listed["rows"], listed["columns"]) == values.shape
    for before, after in zip(values.T, columns, strict=True):
        rounding = np.spacing(np.abs(before[np.isfinite(before)]).max(initial=0.0))
        assert furthest(before, after) <= 0.5 * step(before) + 4 * rounding + 1e-30


def test_steps_of_both_signs_over_the_whole_range_come_back():
    values = [0.0, 1.0, 0.0, 1.0, 0.5, math.nan, 1.0, math.nan, 0.0]
    listed, (column,) = read(values)
    assert listed["step"] == [pytest.approx(1.0 / (2**24 - 2), rel=1e-15)]
    assert furthest(values, column) <= 3e-8


def test_what_is_too_large_for_a_page_is_a_gap_and_leaves_the_rest_precise():
    listed, (column,) = read([1.0, 1e300, 2.0, -math.inf])
    assert column == [1.0, None, pytest.approx(2.0), None] and listed["lo"] == [1.0]


def test_a_finest_step_makes_codes_coarser_and_never_finer():
    noise = np.random.default_rng(5).normal(size=500)

    def listed(finest):
        header, found = unpacked(
            pack({}, [Signal(name="q", base="tick", dt=1.0, values=noise[:, None], finest=finest)])
        )
        assert furthest(noise, found["q"][0]) <= 0.5 * header["signals"][0]["step"][0] * (1 + 1e-9)
        return header["signals"][0]["step"]

    assert listed(1e-3) == [1e-3]
    assert listed(1e-12) == listed(0.0) == [pytest.approx(np.ptp(noise) / (2**24 - 2))]


def test_a_constant_column_costs_nothing_and_one_without_numbers_has_no_least():
    rows = 4000
    noise = np.random.default_rng(5).normal(size=rows)
    alone = len(gzip.decompress(packed(noise)))
    assert len(gzip.decompress(packed(noise, np.full(rows, 3.25)))) - alone < 10
    listed, columns = read(np.full(rows, 3.25), np.full(rows, math.nan))
    assert listed["lo"] == [3.25, None] and listed["step"] == [0.0, 0.0]
    assert columns == [[3.25] * rows, [None] * rows]


def test_a_constant_with_gaps_keeps_its_gaps():
    _, (column,) = read([7.0, math.nan, 7.0])
    assert column == [7.0, None, 7.0]


def test_the_same_signals_give_the_same_bytes_and_carry_no_time():
    noise = np.random.default_rng(5).normal(size=500)
    first = packed(noise, label="a")
    assert packed(noise, label="a") == first
    assert first[4:8] == bytes(4)  # RFC 1952: the time of the file
    assert packed(noise, label="b") != first


def test_texts_that_are_no_utf_8_and_numbers_that_are_no_json_are_read_back():
    header, _ = unpacked(packed([1.0], label="\udcff</script>\0\u2028", margin=math.nan, most=[math.inf, 1.5]))
    assert header["label"] == "\udcff</script>\0\u2028"
    assert header["margin"] is None and header["most"] == [None, 1.5]


def test_signals_stand_one_after_another_with_their_times():
    signals = [
        Signal(name="a", base="tick", dt=0.001, values=np.arange(10.0).reshape(5, 2)),
        Signal(name="none", base="frame", dt=0.016, t0=0.5, values=np.zeros((0, 7))),
        Signal(name="b", base="cycle", dt=0.008, values=np.arange(3.0).reshape(3, 1)),
    ]
    header, found = unpacked(pack({}, signals))
    assert [(each["name"], each["base"], each["t0"], each["dt"], each["rows"]) for each in header["signals"]] == [
        ("a", "tick", 0.0, 0.001, 5),
        ("none", "frame", 0.5, 0.016, 0),
        ("b", "cycle", 0.0, 0.008, 3),
    ]
    assert found["none"] == [[]] * 7 and found["b"] == [pytest.approx([0.0, 1.0, 2.0])]
