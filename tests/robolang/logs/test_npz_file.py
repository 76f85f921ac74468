"""The log as a file of numpy: every number comes back, what follows is the same, and it repeats."""

import json

import numpy as np
import pytest

import robolang
from robolang.logs.files import write_log
from runtime.core.faults import Fault
from tests.robolang.logs.made import OLD, PLAIN, log, old

STORED = {
    *("meta", "t", "line", "q_cmd", "dq_cmd", "q_fb", "dq_fb", "tau_cmd", "tau_sat", "q_link", "tools"),
    *(f"cycle/{name}" for name in ("q_plan", "D", "T", "read_us", "payload_mass", "number", "wrist_mode")),
    *("cycle/seam_deviation", "cycle/tool", "frame/parts", "frame/fingers"),
}


def same(one, other):
    return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()


@pytest.mark.parametrize("ticks", [0, 1, 7, 8, 9, 1024, 1025, 9000])
def test_a_log_that_is_read_is_the_log_that_was_written(tmp_path, ticks):
    made = log(ticks)
    write_log(tmp_path / "l.npz", made)
    read = robolang.read_log(tmp_path / "l.npz")
    assert list(read) == list(made)
    for name, values in made.items():
        assert same(read[name], values), name
    assert read.meta == json.loads(json.dumps(made.meta))
    assert read.version == 2
    assert read.events == [{"time_s": 0.004, "kind": "output", "name": "3", "value": 1.0}]
    for name in ("q_plan", "line", "number", "wrist_mode"):
        assert same(read.each_cycle(name), made.each_cycle(name)), name
        assert len(read.each_cycle(name)) == -(-ticks // 8)


def test_numpy_reads_the_rows_under_their_names(tmp_path):
    made = log(100)
    write_log(tmp_path / "l.npz", made)
    with np.load(tmp_path / "l.npz", allow_pickle=False) as stored:
        assert set(stored) == STORED
        for name in ("t", "line", "q_cmd", "dq_cmd", "q_fb", "dq_fb", "tau_cmd", "tau_sat", "q_link"):
            assert same(stored[name], np.asarray(made[name])), name
        assert stored["cycle/q_plan"].shape == (13, 6)
        assert stored["frame/parts"].shape == (7, 2, 7)
        assert stored["frame/parts"].dtype == stored["frame/fingers"].dtype == np.float32


@pytest.mark.parametrize("numbers", [PLAIN, np.append(PLAIN, np.nan)], ids=["plain", "nan"])
def test_any_span_is_that_of_the_whole(numbers):
    made = log(2500, numbers)
    for name, values in made.items():
        for first, last in ((0, 0), (0, 1), (5, 17), (1020, 1030), (16, 2500)):
            rows = slice(first, min(last, len(values)))
            assert same(made.span(name, first, rows.stop), np.ascontiguousarray(values[rows])), (name, first, last)


def test_a_tool_counts_from_the_cycle_in_which_it_is_used():
    made = log(80, PLAIN)
    z = made["X_world_tool"][:, :3, 2]
    p = made["X_world_tool"][:, :3, 3]
    flange = made["X_world_tool"][::1, :3, 3] - z * np.repeat([0.1 * (k % 3) for k in range(10)], 8)[:, None]
    from runtime.robot.kinematics.chain import Chain

    chain: Chain = made._chain
    assert np.abs(flange - chain.flange(made["q_link"])[:, :3, 3]).max() < 1e-12
    assert np.abs(made["tool_error"] - np.linalg.norm(made["tool_cmd"] - p, axis=1)).max() < 1e-12
    # between two ticks of one cycle the tool is the same
    moved = np.linalg.norm(np.diff(p[:8], axis=0), axis=1) / 1e-3
    assert np.abs(made["tool_speed"][1:8] - moved).max() < 1e-9
    assert made["tool_speed"][0] == 0.0


def test_a_log_of_layout_1_gives_what_it_has(tmp_path):
    signals = {"t": 0.001 * np.arange(4), "q_cmd": np.ones((4, 6)), "line": np.arange(4), "number": np.zeros(4, int)}
    read = robolang.read_log(old(tmp_path / "o.npz", **signals))
    assert (read.version, read.meta, read.events, set(read)) == (1, None, [], set(OLD))
    assert all(same(read[name], values) for name, values in signals.items())
    assert "parts" not in read
    for asked in (read.needed_meta, lambda: read.require("parts"), lambda: read.each_cycle("line")):
        with pytest.raises(Fault) as caught:
            asked()
        assert caught.value.code == "RBL820"
        assert "o.npz" in caught.value.message
