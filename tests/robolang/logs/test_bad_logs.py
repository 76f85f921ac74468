"""Logs that are torn, changed, of another version or of another arm: a code, or what was written, and nothing else."""

import json
import os
import random
import struct
import zipfile
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest

from robolang.logs.files import read_log, write_log
from robolang.logs.log import Log
from robolang.logs.meta import read_meta
from robolang.teaching.logged import joints_at
from runtime.core.faults import Fault
from tests.campaign import size
from tests.fuzz.test_corpus import FOLDER
from tests.robolang.logs.made import PLAIN, log, meta, recorder

UNIT = np.eye(4).tolist()
CODES = ("RBL619", "RBL821")


@pytest.fixture(scope="module")
def good(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("good") / "l.npz"
    write_log(path, log(40, PLAIN))
    return path


@pytest.fixture(scope="module")
def expected(good) -> dict[str, bytes]:
    return contents(good)


def contents(path: Path) -> dict[str, bytes]:
    read = read_log(path)
    found = {name: values.tobytes() for name, values in read.items()}
    return found | ({} if read.meta is None else {"meta": json.dumps(read.meta).encode()})


def refused(path: Path, *codes: str) -> Fault:
    with pytest.raises(Fault) as caught:
        contents(path)
    assert caught.value.code in codes
    assert str(path) in caught.value.message
    assert caught.value.hint
    return caught.value


def test_a_log_that_is_torn_at_any_byte_is_refused(good, tmp_path):
    data, path = good.read_bytes(), tmp_path / "t.npz"
    for length in {*range(0, len(data), size(7, 211)), *range(len(data) - size(2500, 60), len(data))}:
        path.write_bytes(data[:length])
        assert refused(path, "RBL619")


def test_a_log_with_a_changed_byte_is_refused_or_gives_what_was_written(good, expected, tmp_path):
    data, path, rng = good.read_bytes(), tmp_path / "c.npz", random.Random(16)
    found = 0
    for _ in range(size(20_000, 400)):
        changed = bytearray(data)
        # half of them in the list at the end, which is read first
        at = rng.randrange(len(data) - rng.choice((len(data), 1800)), len(data))
        changed[at] ^= 1 << rng.randrange(8)
        path.write_bytes(changed)
        try:
            read = contents(path)
        except Fault as fault:
            assert fault.code in CODES, (at, fault.code)
            found += 1
        else:
            assert all(expected[name] == values for name, values in read.items()), at
    assert found > 0


def test_a_log_that_is_cut_while_it_is_open_is_refused(good, tmp_path):
    path = tmp_path / "o.npz"
    path.write_bytes(good.read_bytes())
    read = read_log(path)
    assert len(read["q_fb"]) == 40
    os.truncate(path, 3000)
    with pytest.raises(Fault) as caught:
        read.span("q_fb", 0, 40)
    assert caught.value.code == "RBL619"


def test_a_log_that_is_replaced_while_it_is_open_stays_what_it_was(good, expected, tmp_path):
    path = tmp_path / "r.npz"
    write_log(path, log(40, PLAIN))
    read = read_log(path)
    write_log(path, log(16, -PLAIN))
    assert read["q_fb"].tobytes() == expected["q_fb"]


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("huge", "RBL619"),
        ("no-width", "RBL619"),
        ("deep", "RBL619"),
        ("infinite", "RBL619"),
        ("small-t", "RBL619"),
        ("slow", "RBL619"),
        ("no-robot", "RBL619"),
        ("text-axes", "RBL619"),
        ("five-axes", "RBL619"),
        ("checksum", "RBL619"),
        ("newer", "RBL821"),
    ],
)
def test_what_a_log_states_is_compared_before_it_is_believed(name, code):
    assert refused(FOLDER / "log" / f"{name}.npz", code)


def changed_meta(path: Path, **changes: object) -> Path:
    made = Log(recorder(40, PLAIN).recorded(), meta())
    made.meta = {**meta(), **changes}
    write_log(path, made)
    return path


@pytest.mark.parametrize(
    "changes",
    [
        {"tick_s": 0.0},
        {"tick_s": -0.001},
        {"tick_s": 0.9},
        {"tick_s": "0.001"},
        {"cycle_s": 10.0},
        {"format": None},
        {"format": "2"},
        {"events": {}},
        {"report": []},
        {"points": None},
        {"robot": {"axes": [], "flange": [[1]], "tool": []}},
        {"robot": []},
    ],
    ids=str,
)
def test_a_meta_of_another_form_is_refused(tmp_path, changes):
    assert refused(changed_meta(tmp_path / "m.npz", **changes), "RBL619")


@pytest.mark.parametrize(("axes", "taken"), [(7, True), (8, False), (2000, False)])
def test_no_robot_has_more_axes_than_one_can_have(axes, taken):
    robot = {"axes": [{"placement": UNIT}] * axes, "flange": UNIT, "tool": UNIT}
    with nullcontext() if taken else pytest.raises(ValueError, match=f"{axes} axes"):
        read_meta(json.dumps({**meta(), "robot": robot}).encode(), "l.mcap")


def test_a_packed_meta_is_not_unpacked_beyond_its_bound(tmp_path, monkeypatch):
    monkeypatch.setattr("robolang.logs.archive.MOST_PACKED", 5000)
    made = changed_meta(tmp_path / "m.npz", program={"name": "p.rbl", "text": "x" * 5000})
    assert made.stat().st_size < 30_000
    assert refused(made, "RBL619")


@pytest.mark.parametrize("numbers", [np.array([0.5, np.nan]), np.array([np.inf, 0.5])], ids=["nan", "infinite"])
def test_angles_that_are_no_numbers_are_not_taught(tmp_path, numbers):
    write_log(tmp_path / "n.npz", log(40, numbers))
    assert len(read_log(tmp_path / "n.npz")["tool_error"]) == 40  # it can be shown
    with pytest.raises(Fault) as caught:
        joints_at(tmp_path / "n.npz", 6, 0.01)
    assert caught.value.code == "RBL619"


def test_a_log_of_another_arm_is_not_taught(good):
    with pytest.raises(Fault) as caught:
        joints_at(good, 7, 0.01)
    assert caught.value.code == "RBL619"
    assert "6 axes" in caught.value.message


def test_a_list_that_is_longer_than_any_of_a_log_is_not_read(tmp_path):
    path = tmp_path / "l.npz"
    with zipfile.ZipFile(path, "w") as file:
        for number in range(3000):
            file.writestr(f"{number}.npy", b"")
    assert "list" in refused(path, "RBL619").message or "end" in refused(path, "RBL619").message


@pytest.mark.parametrize("moved", [0, 1], ids=["where-it-is", "elsewhere"])
def test_a_list_is_not_read_by_the_end_of_a_large_file_either(tmp_path, monkeypatch, moved):
    path = tmp_path / "l.npz"
    with zipfile.ZipFile(path, "w") as file:
        for number in range(3000):
            file.writestr(f"{number}.npy", b"")
    data = path.read_bytes()
    size, at = struct.unpack("<2L", data[-10:-2])
    end = struct.pack("<4sQ2H2L4Q", b"PK\6\6", 44, 45, 45, 0, 0, 3000, 3000, size, at)
    locator = struct.pack("<4sLQL", b"PK\6\7", 0, len(data) - 22 + moved, 1)
    path.write_bytes(data[:-22] + end + locator + struct.pack("<4s4H2LH", b"PK\5\6", 0, 0, 0xFFFF, 0xFFFF, 0, 0, 0))
    with zipfile.ZipFile(path) as read:
        assert len(read.namelist()) == 3000
    monkeypatch.setattr(zipfile, "ZipFile", None)  # it is not even begun
    assert refused(path, "RBL619")


@pytest.mark.parametrize("length", [22, 41, 42, 60, 97])
def test_an_end_of_a_large_file_that_is_torn_is_refused(tmp_path, length):
    path = tmp_path / "t.npz"
    tail = struct.pack("<4sLQL", b"PK\6\7", 0, 0, 1) + struct.pack("<4s4H2LH", b"PK\5\6", 0, 0, 0, 0, 0, 0, 0)
    path.write_bytes((bytes(100) + tail)[-length:])
    assert refused(path, "RBL619")
