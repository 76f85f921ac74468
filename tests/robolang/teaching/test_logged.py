"""Joint angles out of logs, also of logs that are damaged."""

import io
import zipfile

import numpy as np
import pytest

from robolang.teaching.logged import joints_at, joints_at_end_of
from runtime.core.faults import Fault
from tests.robolang.logs.made import old

LINES = np.array([0, 1, 1, 2, 2, 2, 1, 1, 3, 3])
Q = np.arange(60.0).reshape(10, 6)


def log(path, **changes):
    signals = {"t": 0.001 * np.arange(10), "q_cmd": Q, "line": LINES, "number": 10 * LINES}
    return old(path, **{**signals, **changes})


@pytest.fixture
def path(tmp_path):
    return log(tmp_path / "r.npz")


def test_the_end_of_the_last_execution_of_a_line(path, tmp_path):
    assert (joints_at_end_of(path, 6, 10) == Q[7]).all()
    assert (joints_at_end_of(path, 6, 20) == Q[5]).all()
    assert (joints_at_end_of(path, 6, 30) == Q[9]).all()
    # without numbers the lines of the file
    plain = log(tmp_path / "p.npz", number=0 * LINES)
    assert (joints_at_end_of(plain, 6, 1) == Q[7]).all()


@pytest.mark.parametrize(
    ("line", "time", "row"),
    [(10, 0.009, 7), (10, 0.0045, 2), (10, 0.006, 7), (20, 0.003, 5), (20, 0.0031, 5), (30, 0.008, 9)],
)
def test_the_execution_by_a_time(path, line, time, row):
    assert (joints_at_end_of(path, 6, line, time) == Q[row]).all()


@pytest.mark.parametrize(("time", "row"), [(0.0, 0), (0.003, 3), (0.0035, 3), (0.009, 9)])
def test_where_the_arm_was_at_a_time(path, time, row):
    assert (joints_at(path, 6, time) == Q[row]).all()


@pytest.mark.parametrize(
    "read",
    [
        lambda path: joints_at_end_of(path, 6, 40),
        lambda path: joints_at_end_of(path, 6, 1),  # a line of the file, of a program with numbers
        lambda path: joints_at_end_of(path, 6, 0),
        lambda path: joints_at_end_of(path, 6, 20, 0.0029),
        lambda path: joints_at(path, 6, 0.0101),
        lambda path: joints_at(path, 6, -0.001),
        lambda path: joints_at(path, 6, np.nan),
        lambda path: joints_at(path, 7, 0.003),
        lambda path: joints_at_end_of(path, 3, 10),
    ],
)
def test_what_the_log_does_not_have(path, read):
    with pytest.raises(Fault) as caught:
        read(path)
    assert caught.value.code == "RBL619"


def test_a_log_without_a_tick(tmp_path):
    path = log(tmp_path / "e.npz", t=np.zeros(0), q_cmd=np.zeros((0, 6)), line=LINES[:0], number=LINES[:0])
    for read in (lambda: joints_at(path, 6, 0.0), lambda: joints_at_end_of(path, 6, 10)):
        with pytest.raises(Fault) as caught:
            read()
        assert caught.value.code == "RBL619"


def stated(shape):
    """The header of an array, without the array."""
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": "<f8", "fortran_order": False, "shape": shape})
    return stream.getvalue()


def archive(path, **entries):
    with zipfile.ZipFile(path, "w") as file:
        for name, content in entries.items():
            file.writestr(f"{name}.npy", content)
    return path


def pickled():
    stream = io.BytesIO()
    np.save(stream, np.array([{}], dtype=object), allow_pickle=True)
    return stream.getvalue()


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"not a zip file",
        "half",
        {},
        {"t": b"\x93NUMPY"},
        {"t": stated((10**12,))},
        {"t": stated((10**400,))},
        {"t": stated((1, 1)) + b"\0" * 8},
        {"t": pickled()},
    ],
    ids=["empty", "text", "half", "nothing", "cut", "huge", "beyond", "matrix", "pickle"],
)
def test_a_damaged_log(path, tmp_path, content):
    broken = tmp_path / "b.npz"
    if isinstance(content, dict):
        archive(broken, **content)
    else:
        broken.write_bytes(path.read_bytes()[:-700] if content == "half" else content)
    with pytest.raises(Fault) as caught:
        joints_at(broken, 6, 0.003)
    assert caught.value.code == "RBL619"


def test_a_log_that_is_not_there(tmp_path):
    for path in (tmp_path / "none.npz", tmp_path):
        with pytest.raises(Fault) as caught:
            joints_at(path, 6, 0.0)
        assert caught.value.code == "RBL600"
