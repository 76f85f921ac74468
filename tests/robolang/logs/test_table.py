"""What is exported, read back by other programs; and what columns and units signals have."""

import csv
import io
import json
import re
import sys
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from robolang.logs import table
from robolang.logs.export import check_parquet, write_csv, write_parquet
from robolang.logs.files import read_log
from robolang.logs.quantities import columns
from robolang.logs.selection import selected
from robolang.logs.table import table_of
from runtime.appearance.scene import ROLES, Scene, SceneBody, SceneJoint
from runtime.core.faults import Fault
from tests.robolang.logs.made import PLAIN, log, old

DOCS = Path(__file__).parents[3] / "docs" / "signals.md"
TICKS = 100


@pytest.fixture(params=[1, 7, TICKS, 8192])
def pieces(request, monkeypatch):
    monkeypatch.setattr(table, "PIECE", request.param)


def expected(made, name, rows):
    """Return a signal with a row for each tick, one number in each column."""
    values = made[name].reshape(len(made[name]), -1)
    if made.base(name) == "frame":
        values = values[np.arange(rows) // 16]
    return values


def same(read, values):
    return np.array_equal(np.asarray(read, np.float64).view(np.int64), np.asarray(values, np.float64).view(np.int64))


@pytest.mark.usefixtures("pieces")
def test_csv_gives_back_every_double():
    made = log(TICKS)
    stream = io.BytesIO()
    write_csv(stream, table_of(made, ()))
    heading, *rows = csv.reader(io.StringIO(stream.getvalue().decode("utf-8"), newline=""))
    numbers = np.array([[float(cell) for cell in row] for row in rows])
    at = 0
    order = ["t", *(name for name in made if name not in ("t", "frame_t"))]
    for name in order:
        values = expected(made, name, TICKS)
        width = values.shape[1]
        read = numbers[:, at : at + width]
        known = ~np.isnan(values)  # of NaN there are many, and a text has one
        assert np.array_equal(np.isnan(read), ~known), name
        assert same(read[known], values[known]), name
        assert [text.partition(" [")[0].partition(":")[0] for text in heading[at : at + width]] == [name] * width
        at += width
    assert at == numbers.shape[1] == len(heading)


@pytest.mark.usefixtures("pieces")
def test_parquet_gives_back_every_bit_with_its_unit():
    made = log(TICKS)
    stream = io.BytesIO()
    write_parquet(stream, table_of(made, ()))
    read = pq.read_table(io.BytesIO(stream.getvalue()))
    for name in made:
        if name != "frame_t":
            values = expected(made, name, TICKS)
            for column, own in zip(columns(made, name), values.T, strict=True):
                found = read[column.name].to_numpy()
                assert found.dtype == made[name].dtype
                assert found.tobytes() == np.ascontiguousarray(own).tobytes(), column.name
                assert read.schema.field(column.name).metadata == {b"unit": column.unit.encode()}
    assert json.loads(read.schema.metadata[b"robolang"]) == made.meta


def test_signals_of_frames_alone_have_a_row_for_each_frame():
    made = log(TICKS)
    found = table_of(made, ["fingers", "parts:2.x"])
    assert [column.name for column in found.columns] == ["frame_t", "fingers:left", "fingers:right", "parts:2.x"]
    assert found.rows == made.count("frame_t") == 7
    (piece,) = found.pieces()
    assert same(piece[0], made["frame_t"])
    assert same(piece[3], made["parts"][:, 1, 0])


def test_a_column_comes_once_and_the_time_first():
    found = table_of(log(8), ["q_fb:2", "t", "q_fb", "q_fb:J2"])
    assert [column.name for column in found.columns] == ["t", "q_fb:2", *(f"q_fb:{k}" for k in (1, 3, 4, 5, 6))]


@pytest.mark.parametrize("write", [write_csv, write_parquet])
@pytest.mark.parametrize("ticks", [0, 1])
def test_a_short_run_is_a_short_table(ticks, write):
    stream = io.BytesIO()
    write(stream, table_of(log(ticks), ()))
    if write is write_parquet:
        assert pq.read_table(io.BytesIO(stream.getvalue())).num_rows == ticks
    else:
        assert len(stream.getvalue().splitlines()) == ticks + 1


def test_the_stream_is_left_open():
    stream = io.BytesIO()
    write_csv(stream, table_of(log(1), ["t"]))
    assert not stream.closed
    assert stream.getvalue() == b"t [s]\n0.0\n"


def test_an_old_log_is_exported_too(tmp_path):
    path = old(tmp_path / "o.npz", t=np.arange(3.0), q_cmd=np.ones((3, 2)), line=np.array([1, 1, 2], np.int32))
    stream = io.BytesIO()
    write_csv(stream, table_of(read_log(path), ()))
    assert stream.getvalue().decode().splitlines()[:2] == ["t [s],q_cmd:1 [rad],q_cmd:2 [rad],line", "0.0,1.0,1.0,1"]


def test_parquet_without_its_library_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(Fault) as caught:
        check_parquet()
    assert caught.value.code == "RBL839"
    assert "robolang[parquet]" in caught.value.hint


# --- columns and units ------------------------------------------------------------------------------------------------


def test_every_signal_has_columns_with_the_unit_of_its_page():
    made = log(1)
    rows = re.findall(r"^\| `(\w+)` \| \(([^)]*)\) \| ([^|]+) \|", DOCS.read_text("utf-8"), re.M)
    assert {name for name, _, _ in rows} >= set(made)
    for name, _, units in rows:
        if name in made:
            found = columns(made, name)
            assert [column.index for column in found] == list(range(made[name][0].size)), name
            assert {column.unit for column in found} == set(units.strip().split(", ")), name
            assert len({column.name for column in found}) == len(found)


def test_people_see_deg_and_mm():
    made = log(1)
    assert columns(made, "q_fb")[0].shown == ("deg", pytest.approx(57.29578, abs=1e-5))
    assert columns(made, "tool_speed")[0].shown == ("mm/s", 1000.0)
    assert columns(made, "tau_sat")[0].shown == ("N m", 1.0)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("tool_error", ["tool_error"]),
        ("q_fb:2", ["q_fb:2"]),
        ("q_fb:J2", ["q_fb:2"]),
        ("tool_cmd", ["tool_cmd:x", "tool_cmd:y", "tool_cmd:z"]),
        ("X_world_tool:z", ["X_world_tool:z"]),
        ("parts:1", [f"parts:1.{each}" for each in ("x", "y", "z", "qw", "qx", "qy", "qz")]),
        ("parts:2.qz", ["parts:2.qz"]),
        ("fingers:left", ["fingers:left"]),
    ],
)
def test_signals_are_named_as_people_do(text, names):
    made = log(1)
    assert [column.name for column in selected(made, made, text)] == names


@pytest.mark.parametrize(("text", "first"), [("parts:J1", 7), ("parts:J1.x", 7), ("parts:1", 0), ("q_fb:J1", 0)])
def test_a_part_may_have_the_name_of_an_axis(text, first):
    made = log(1)
    free = {"kind": "prismatic", "axis": np.array([0.0, 0.0, 1.0]), "source": "part"}
    bodies = tuple(
        SceneBody(name=f"part:{name}", parent=None, X_parent_body=np.eye(4), joint=SceneJoint(index=k, **free))
        for k, name in enumerate(("1", "J1"))
    )
    scene = Scene(robot="r", reach=1.0, bodies=bodies, shapes=(), colours=dict.fromkeys(ROLES, "#000000"))
    made.meta = {**made.meta, "scene": scene.as_json()}
    assert selected(made, made, text)[0].index == first


@pytest.mark.parametrize(
    ("text", "offered"),
    [
        ("qfb", {"q_fb", "tau_sat"}),
        ("Q_FB", {"q_fb"}),
        ("", {"q_fb"}),
        ("q_fb:7", {"1", "6"}),
        ("q_fb:0", {"1", "6"}),
        ("q_fb:J", {"1"}),
        ("tool_cmd:X", {"x"}),
        ("parts:3", {"1.x"}),
        ("t:1", {"number"}),
    ],
)
def test_a_name_that_is_not_there_is_refused_with_those_that_are(text, offered):
    made = log(1)
    with pytest.raises(Fault) as caught:
        selected(made, made, text)
    assert caught.value.code == "RBL838"
    assert offered <= set(re.findall(r"[\w.]+", caught.value.hint))


def test_the_matrix_of_a_pose_has_its_place_under_x_y_z():
    made = log(20, PLAIN)
    for axis, letter in enumerate("xyz"):
        (column,) = selected(made, made, f"X_world_tool:{letter}")
        assert same(made["X_world_tool"].reshape(20, 16)[:, column.index], made["X_world_tool"][:, axis, 3])
