import io

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from robolang.execution.runlog import SUFFIXES, write_log

NAN = float("nan")


def signals(ticks):
    """Signals of every shape and type that the recorder has, with the numbers that are hard to keep."""
    odd = np.array([0.0, -0.0, 1e-320, 1e308, np.inf, -np.inf, NAN, 1 / 3])
    grid = np.resize(odd, (ticks, 6))
    return {
        "t": np.arange(ticks) * 1000 * 1e-6,
        "q_fb": np.ascontiguousarray(grid),
        "X_world_tool_fb": np.ascontiguousarray(np.resize(odd, (ticks, 4, 4))),
        "line": np.resize(np.array([0, 10, -1, 2**31 - 1], dtype=np.int32), ticks),
        "wrist_mode": np.resize(np.array([0, 1, 2], dtype=np.int8), ticks),
    }


@pytest.mark.parametrize("ticks", [0, 1, 8, 5000])
def test_an_mcap_gives_back_every_number(tmp_path, ticks):
    log = signals(ticks)
    write_log(tmp_path / "l.mcap", log)
    reader = make_reader(io.BytesIO((tmp_path / "l.mcap").read_bytes()), True, [DecoderFactory()])
    (schema,) = reader.get_summary().schemas.values()
    assert schema.name == "robolang.Sample"
    samples = [sample for _, _, _, sample in reader.iter_decoded_messages()]
    assert reader.get_summary().statistics.message_count == len(samples) == ticks
    for name, values in log.items():
        read = np.array([getattr(sample, name) for sample in samples], dtype=values.dtype).reshape(values.shape)
        assert np.array_equal(read.view(np.int8), values.view(np.int8)), name  # to the bit, NaN and -0 included


@pytest.mark.parametrize("ticks", [0, 8])
def test_an_npz_gives_back_every_number(tmp_path, ticks):
    log = signals(ticks)
    write_log(tmp_path / "l.npz", log)
    with np.load(tmp_path / "l.npz", allow_pickle=False) as read:
        assert list(read) == list(log)
        for name, values in log.items():
            assert read[name].dtype == values.dtype
            assert np.array_equal(read[name].view(np.int8), values.view(np.int8)), name


def test_a_field_keeps_its_number_and_type(tmp_path):
    from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorSet

    write_log(tmp_path / "l.mcap", signals(1))
    (schema,) = make_reader(io.BytesIO((tmp_path / "l.mcap").read_bytes())).get_summary().schemas.values()
    (file,) = FileDescriptorSet.FromString(schema.data).file
    kinds = FieldDescriptorProto
    assert [(field.name, field.number, field.type, field.label) for field in file.message_type[0].field] == [
        ("t", 1, kinds.TYPE_DOUBLE, kinds.LABEL_OPTIONAL),
        ("q_fb", 2, kinds.TYPE_DOUBLE, kinds.LABEL_REPEATED),
        ("X_world_tool_fb", 3, kinds.TYPE_DOUBLE, kinds.LABEL_REPEATED),
        ("line", 4, kinds.TYPE_INT32, kinds.LABEL_OPTIONAL),
        ("wrist_mode", 5, kinds.TYPE_INT32, kinds.LABEL_OPTIONAL),
    ]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_same_signals_give_the_same_bytes(tmp_path, suffix):
    for name in ("a", "b"):
        write_log(tmp_path / f"{name}{suffix}", signals(3000))
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


@pytest.mark.parametrize("name", ["l.txt", "npz", "l.npz.gz", "l.NPZ"])
def test_another_suffix_is_refused(tmp_path, name):
    with pytest.raises(ValueError, match=r"\.npz.*\.mcap"):
        write_log(tmp_path / name, signals(1))
    assert list(tmp_path.iterdir()) == []
