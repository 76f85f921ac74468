"""Golden logs that are damaged, hostile or of another robot: refused with a code, in memory bounded by the run."""

import io
import os
import tracemalloc
import zipfile

import numpy as np
import pytest

from robolang.testing.golden import read_golden, write_golden
from runtime.core.faults import Fault
from runtime.core.units import MM
from runtime.robot.model.axis_kind import PRISMATIC, REVOLUTE
from tests.messages import numbers

N = 40
Q = np.random.default_rng(1).normal(size=(N, 6)).astype(np.float32)
LINE = np.arange(N, dtype=np.int32)


def packed(compression=zipfile.ZIP_DEFLATED, **members):
    """A zip file of these members, each an array or the bytes of one."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", compression) as archive:
        for name, value in members.items():
            archive.writestr(f"{name}.npy", value if isinstance(value, bytes) else npy(value))
    return stream.getvalue()


def npy(array, **options):
    stream = io.BytesIO()
    np.save(stream, array, **options)
    return stream.getvalue()


def header(shape, kind="<f4", rows=b""):
    """The bytes of an array with a header of one's own."""
    text = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text + rows


def refused(path, axes=6, most=N):
    with pytest.raises(Fault) as caught:
        read_golden(path, axes, most)
    return caught.value.code


def with_(array, place, value):
    array = array.copy()
    array[place] = value
    return array


def most(angle):
    """The same bound of six axes that turn, deg."""
    return [(REVOLUTE, angle)] * 6


def test_what_is_written_is_read(tmp_path):
    path = tmp_path / "g.npz"
    write_golden(path, Q.astype(np.float64), LINE.astype(np.int64))
    found = read_golden(path, 6, N)
    assert found.cycles == N
    problem, summary = found.difference(Q, LINE, most(0.0))
    assert problem is None
    assert numbers(summary) == [N, 0]
    assert len(read_golden(path, 6, 5).q) == 5


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"PK\x05\x06",
        b"x" * 5000,
        packed(),
        packed(q=Q),
        packed(q=Q, line=LINE, more=LINE),
        packed(q=Q, line=LINE)[:-30],
        packed(q=Q, lines=LINE),
        packed(q=with_(Q, (3, 2), np.nan), line=LINE),
        packed(q=with_(Q, (N - 1, 5), -np.inf), line=LINE),
        packed(q=Q.astype(complex), line=LINE),
        packed(q=Q.astype(int), line=LINE),
        packed(q=Q.astype(">f4"), line=LINE),
        packed(q=Q, line=LINE.astype(float)),
        packed(q=np.asfortranarray(Q), line=LINE),
        packed(q=Q[:, :5], line=LINE),
        packed(q=Q.reshape(-1), line=LINE),
        packed(q=Q[None], line=LINE),
        packed(q=Q, line=LINE[:-1]),
        packed(q=Q, line=LINE[:, None]),
        packed(q=npy(np.array([[None] * 6]), allow_pickle=True), line=LINE[:1]),
        packed(q=header((N, 6)), line=LINE),
        packed(q=header((10**9, 6)), line=LINE),
        packed(q=header((10**8, 6)), line=header((10**8,), "<i4")),
        packed(q=b"\x93NUMPY\x01\x00\xff\xff" + b"(" * 70000, line=LINE),
        packed(q=b"", line=b""),
        packed(zipfile.ZIP_LZMA, q=Q, line=LINE),
        packed(q=Q, line=LINE).replace(b"\x14\x00\x00\x00\x08\x00", b"\x14\x00\x01\x00\x08\x00"),  # encrypted
    ],
)
def test_what_is_no_golden_log_is_refused(tmp_path, data):
    path = tmp_path / "g.npz"
    path.write_bytes(data)
    assert refused(path) == "RBL711"


def test_a_flipped_bit_is_noticed(tmp_path):
    path = tmp_path / "g.npz"
    data = bytearray(packed(zipfile.ZIP_STORED, q=Q, line=LINE))
    data[data.index(Q.tobytes()) + 13] ^= 1
    path.write_bytes(data)
    assert refused(path) == "RBL711"


def test_what_is_no_file_is_refused(tmp_path):
    assert refused(tmp_path / "none.npz") == "RBL600"
    assert refused(tmp_path) == "RBL600"
    os.mkfifo(tmp_path / "pipe")
    assert refused(tmp_path / "pipe") == "RBL600"
    (tmp_path / "zero").symlink_to("/dev/zero")
    assert refused(tmp_path / "zero") == "RBL600"


def largest(path, most=N):
    """Memory that reading takes, in bytes."""
    tracemalloc.start()
    try:
        try:
            read_golden(path, 6, most)
        except Fault as fault:
            assert fault.code == "RBL711"
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_memory_is_bounded_by_the_run_and_not_by_the_file(tmp_path):
    rows = 400_000
    zeros = bytes(24 * rows)
    bomb, plain, many = (tmp_path / name for name in ("bomb.npz", "plain.npz", "many.npz"))
    bomb.write_bytes(packed(q=header((rows, 6), rows=zeros), line=header((rows,), "<i4", bytes(4 * rows))))
    plain.write_bytes(packed(q=Q, line=LINE))
    with zipfile.ZipFile(many, "w") as archive:
        for number in range(3000):
            archive.writestr(f"{number}.npy", b"")
    ordinary = largest(plain)
    assert ordinary < 1_000_000
    assert largest(bomb) < 4 * ordinary
    assert largest(many) < 4 * ordinary


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 9.0])
def test_a_run_that_differs_is_named_by_its_first_cycle(tmp_path, value):
    path = tmp_path / "g.npz"
    write_golden(path, Q, LINE)
    golden = read_golden(path, 6, N)
    assert golden.difference(with_(Q, (7, 4), value), LINE, most(1000.0 if value != 9.0 else 0.01))[0] == 7
    assert golden.difference(Q, with_(LINE, 3, 99), most(0.01))[0] == 3
    assert golden.difference(Q[:30], LINE[:30], most(0.01))[0] == 30
    assert golden.difference(Q[:0], LINE[:0], most(0.01))[0] == 0
    assert golden.difference(np.vstack([Q, Q]), np.hstack([LINE, LINE]), most(0.01))[0] == N


@pytest.mark.parametrize(
    ("off", "mm", "at"), [(0.015, 0.02, None), (0.025, 0.02, 7), (0.5, 0.02, 7), (np.nan, 0.02, 7), (np.nan, np.inf, 7)]
)
def test_a_slide_has_a_bound_of_its_own_in_mm(tmp_path, off, mm, at):
    path = tmp_path / "g.npz"
    write_golden(path, Q[:, :2] * 0.1, LINE)
    golden = read_golden(path, 2, N)
    # the difference itself in double: a float32 of the run would round some nm
    q = with_(golden.q.astype(np.float64), (7, 1), golden.q[7, 1] + off * MM)
    found, text = golden.difference(q, LINE, [(REVOLUTE, 0.0), (PRISMATIC, mm)])
    assert found == at
    assert "mm" in text
    if at is None:
        assert numbers(text) == [N, 0, pytest.approx(off, rel=0.1)]
    elif np.isfinite(off):
        assert numbers(text) == [pytest.approx(off, rel=0.01), mm]


def test_a_difference_of_a_turn_is_no_less_for_a_slide_beside_it(tmp_path):
    path = tmp_path / "g.npz"
    write_golden(path, Q[:, :2], LINE)
    golden = read_golden(path, 2, N)
    # the slide is further off, and within its bound
    q = with_(golden.q.astype(np.float64), (3, 0), golden.q[3, 0] + np.radians(0.5))
    q[3, 1] += 2.0 * MM
    found, text = golden.difference(q, LINE, [(REVOLUTE, 0.1), (PRISMATIC, 1000.0)])
    assert found == 3
    assert numbers(text) == [0.5, 0.1]
