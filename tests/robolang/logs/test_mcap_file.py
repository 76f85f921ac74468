import io

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from robolang.logs.files import SUFFIXES, write_log
from tests.robolang.logs.made import log


@pytest.mark.parametrize("ticks", [0, 1, 8, 5000])
def test_an_mcap_gives_back_every_number(tmp_path, ticks):
    made = log(ticks)
    write_log(tmp_path / "l.mcap", made)
    reader = make_reader(io.BytesIO((tmp_path / "l.mcap").read_bytes()), True, [DecoderFactory()])
    (schema,) = reader.get_summary().schemas.values()
    assert schema.name == "robolang.Sample"
    samples = [sample for _, _, _, sample in reader.iter_decoded_messages()]
    assert reader.get_summary().statistics.message_count == len(samples) == ticks
    for name, values in made.items():
        if made.base(name) == "tick":
            read = np.array([getattr(sample, name) for sample in samples], dtype=values.dtype).reshape(values.shape)
            assert np.array_equal(read.view(np.int8), values.view(np.int8)), name  # to the bit, NaN and -0 included


def test_a_field_keeps_its_number_and_type(tmp_path):
    from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorSet

    write_log(tmp_path / "l.mcap", log(1))
    (schema,) = make_reader(io.BytesIO((tmp_path / "l.mcap").read_bytes())).get_summary().schemas.values()
    (file,) = FileDescriptorSet.FromString(schema.data).file
    kinds = FieldDescriptorProto
    fields = {field.name: (field.number, field.type, field.label) for field in file.message_type[0].field}
    assert fields["t"] == (1, kinds.TYPE_DOUBLE, kinds.LABEL_OPTIONAL)
    assert fields["q_fb"] == (7, kinds.TYPE_DOUBLE, kinds.LABEL_REPEATED)
    assert fields["X_world_tool_fb"] == (9, kinds.TYPE_DOUBLE, kinds.LABEL_REPEATED)
    assert fields["line"] == (17, kinds.TYPE_INT32, kinds.LABEL_OPTIONAL)
    assert fields["wrist_mode"] == (19, kinds.TYPE_INT32, kinds.LABEL_OPTIONAL)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_same_signals_give_the_same_bytes(tmp_path, suffix):
    for name in ("a", "b"):
        write_log(tmp_path / f"{name}{suffix}", log(3000))
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


@pytest.mark.parametrize("name", ["l.txt", "npz", "l.npz.gz", "l.NPZ"])
def test_another_suffix_is_refused(tmp_path, name):
    with pytest.raises(ValueError, match=r"\.npz.*\.mcap"):
        write_log(tmp_path / name, log(1))
    assert list(tmp_path.iterdir()) == []
