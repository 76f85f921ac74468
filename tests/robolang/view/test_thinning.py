"""Long signals as pairs: no peak is lost, and a signal that is short enough is the same object."""

import math

import numpy as np
import pytest

from robolang.view import thinning
from robolang.view.packing import Signal


@pytest.fixture(autouse=True)
def few(monkeypatch):
    monkeypatch.setattr(thinning, "MOST_ROWS", 20)
    monkeypatch.setattr(thinning, "EVEN_ROWS", 20)


def signal(*columns):
    return Signal(name="q", base="tick", dt=0.5, values=np.array(columns, dtype=float).T)


def test_a_short_signal_stays():
    short = signal(np.arange(20))
    assert thinning.paired(short) is short
    assert thinning.evenly(short).values.tolist() == short.values.tolist()


@pytest.mark.parametrize("rows", [21, 30, 57, 100, 101, 999])
def test_pairs_are_the_extremes_of_each_bin_in_their_order(rows):
    values = np.random.default_rng(rows).normal(size=(2, rows))
    found = thinning.paired(signal(*values))
    size = thinning.bin_rows(rows)
    assert len(found.values) <= 20 and found.base == "pairs" and found.dt == 0.5 * size / 2
    for column, thin in zip(values, found.values.T, strict=True):
        for k in range(0, rows, size):
            part = column[k : k + size].tolist()
            least, largest = min(part), max(part)
            expected = [least, largest] if part.index(least) < part.index(largest) else [largest, least]
            if len(part) == 1:
                expected = part * 2
            assert thin[2 * k // size : 2 * k // size + 2].tolist() == expected


def test_the_robot_of_half_an_hour_has_a_posture_every_cycle(monkeypatch):
    monkeypatch.undo()
    assert [thinning.even_step(rows) for rows in (0, 240_000, 240_001, 1_800_000)] == [1, 1, 2, 8]
    assert thinning.thinned(60_000, 0.001, 0.0) is None
    short, long = (str(thinning.thinned(rows, 0.001, 8.4e-5)) for rows in (240_000, 1_800_000))
    assert "mm" not in short and " 8 ms" in long and "0.084 mm" in long


def test_gaps_lose_no_peak_and_a_bin_of_gaps_is_a_gap():
    values = np.zeros(40)
    values[:8] = math.nan
    values[17:19] = math.nan, 5.0
    found = thinning.paired(signal(values)).values[:, 0]
    assert np.isnan(found[:4]).all() and np.isfinite(found[4:]).all() and found[4:].max() == 5.0


def test_even_rows_are_rows_of_the_signal_at_their_times():
    found = thinning.evenly(signal(np.arange(50)))
    assert found.values[:, 0].tolist() == [0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 33, 36, 39, 42, 45, 48]
    assert found.dt == 1.5 and found.base == "tick"
