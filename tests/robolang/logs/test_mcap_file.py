"""Our own messages in an ``.mcap``, read by the libraries of the format and by ``read_log``; files that are damaged."""

import io
import random

import numpy as np
import pytest
import zstandard
from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorSet
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from mcap_protobuf.decoder import DecoderFactory

from robolang.logs import mcap_reading
from robolang.logs.files import SUFFIXES, read_log, write_log
from robolang.logs.log import Log
from robolang.logs.records import SAMPLE
from runtime.core.faults import Fault
from tests.robolang.logs.made import PLAIN, log, meta

MATRICES = ("X_world_tool", "X_world_tool_fb")


def same(first, second):
    """Compare to the bit, NaN and -0 included."""
    return first.dtype == second.dtype and first.shape == second.shape and first.tobytes() == second.tobytes()


def written(path, made):
    write_log(path, made)
    return path


@pytest.mark.parametrize("ticks", [0, 1, 8, 5000])
def test_an_mcap_gives_every_number_to_any_reader(tmp_path, ticks):
    made = log(ticks)
    data = written(tmp_path / "l.mcap", made).read_bytes()
    reader = make_reader(io.BytesIO(data), True, [DecoderFactory()])
    samples = [sample for _, _, _, sample in reader.iter_decoded_messages(topics=["/controller"])]
    assert len(samples) == ticks
    for name, values in made.items():
        if made.base(name) == "tick" and name not in MATRICES:
            read = np.array([getattr(sample, name) for sample in samples], dtype=values.dtype).reshape(values.shape)
            assert same(read, values), name
    frames = [frame for _, _, _, frame in reader.iter_decoded_messages(topics=["/cell"])]
    for name in ("parts", "fingers"):
        read = np.array([getattr(frame, name) for frame in frames], dtype=np.float32)
        assert same(read.reshape(made[name].shape), made[name])


def test_a_log_is_written_whatever_its_scene_is(tmp_path):
    made = Log(log(16).rows, {**meta(), "scene": {"bodies": 7}})
    read = read_log(written(tmp_path / "l.mcap", made))
    assert read.meta == made.meta
    assert same(read["q_fb"], made["q_fb"])


@pytest.mark.parametrize("ticks", [1, 7, 8, 9, 16, 17, 5000])
def test_read_log_gives_the_log_that_was_written(tmp_path, ticks):
    made = log(ticks)
    read = read_log(written(tmp_path / "l.mcap", made))
    assert read.meta == made.meta
    assert list(read) == list(made)
    for name, values in made.items():
        assert same(read[name], values), name
    for name in ("line", "q_plan"):
        assert same(read.each_cycle(name), made.each_cycle(name))


def test_a_run_without_a_tick_is_read(tmp_path):
    read = read_log(written(tmp_path / "l.mcap", log(0)))
    assert read.count("t") == read.count("parts") == 0
    assert read["q_fb"].shape == (0, 6)


def test_a_field_keeps_its_number_and_type(tmp_path):
    data = written(tmp_path / "l.mcap", log(1)).read_bytes()
    schemas = {each.name: each for each in make_reader(io.BytesIO(data)).get_summary().schemas.values()}
    (file,) = FileDescriptorSet.FromString(schemas["robolang.Sample"].data).file
    kinds = FieldDescriptorProto
    fields = {field.name: (field.number, field.type, field.label) for field in file.message_type[0].field}
    assert fields["t"] == (1, kinds.TYPE_DOUBLE, kinds.LABEL_OPTIONAL)
    assert fields["q_fb"] == (7, kinds.TYPE_DOUBLE, kinds.LABEL_REPEATED)
    assert fields["line"] == (17, kinds.TYPE_INT32, kinds.LABEL_OPTIONAL)
    assert fields["wrist_mode"] == (19, kinds.TYPE_INT32, kinds.LABEL_OPTIONAL)
    assert {number for number, _, _ in fields.values()} & {9, 11} == set()  # of fields that are no more
    assert set(fields) == {name for name in log(1) if name not in (*MATRICES, "frame_t", "parts", "fingers")}


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_same_signals_give_the_same_bytes(tmp_path, suffix):
    first, second = (written(tmp_path / f"{name}{suffix}", log(3000)).read_bytes() for name in ("a", "b"))
    assert first == second


@pytest.mark.parametrize("name", ["l.txt", "npz", "l.npz.gz", "l.NPZ"])
def test_another_suffix_is_refused(tmp_path, name):
    with pytest.raises(ValueError, match=r"\.npz.*\.mcap"):
        write_log(tmp_path / name, log(1))
    assert list(tmp_path.iterdir()) == []


def test_chunks_are_packed(tmp_path):
    data = written(tmp_path / "l.mcap", log(5000, PLAIN)).read_bytes()
    chunks = make_reader(io.BytesIO(data)).get_summary().chunk_indexes
    assert {chunk.compression for chunk in chunks} == {"zstd"}
    assert len(data) < sum(chunk.uncompressed_size for chunk in chunks) / 3


# --- files that are not trusted ---------------------------------------------------------------------------------------


def refused(path, code="RBL619"):
    with pytest.raises(Fault) as caught:
        read_log(path)
    assert caught.value.code == code
    assert str(path) in caught.value.message
    return caught.value


def test_a_file_that_cannot_be_read(tmp_path):
    assert refused(tmp_path / "absent.mcap", "RBL600")
    (tmp_path / "folder.mcap").mkdir()
    assert refused(tmp_path / "folder.mcap", "RBL600")


def test_a_torn_file_is_refused_wherever_it_ends(tmp_path):
    whole = written(tmp_path / "l.mcap", log(200)).read_bytes()
    path = tmp_path / "torn.mcap"
    for end in [*range(40), *range(40, len(whole), 997), *range(len(whole) - 40, len(whole))]:
        path.write_bytes(whole[:end])
        with pytest.raises(Fault, match=r"RBL619|RBL820"):
            read_log(path)


def test_changed_bytes_give_the_same_log_or_a_fault(tmp_path):
    made = log(100, PLAIN)
    whole = written(tmp_path / "l.mcap", made).read_bytes()
    # what is after the data is an index, which is not read
    chosen = random.Random(7)
    path = tmp_path / "changed.mcap"
    found = set()
    for _ in range(300):
        at = chosen.randrange(len(whole))
        path.write_bytes(whole[:at] + bytes([whole[at] ^ (1 << chosen.randrange(8))]) + whole[at + 1 :])
        try:
            read = read_log(path)
            found.add("read")
            # a topic that has lost its name is no topic of ours
            assert read.count("t") in (0, 100)
            assert read.meta == made.meta
            assert read.count("t") == 0 or all(same(read[name], made[name]) for name in made)
        except Fault as fault:
            found.add(fault.code)
            assert fault.code in ("RBL619", "RBL820", "RBL821")
    assert {"read", "RBL619"} <= found


def mcap(path, write, **how):
    """Write a file with the library, as another program would."""
    with path.open("wb") as stream:
        writer = Writer(stream, **how)
        writer.start()
        write(writer)
        writer.finish()
    return path


def add_samples(writer, rows, topic="/controller", name="robolang.Sample"):
    channel = writer.register_channel(topic, "protobuf", writer.register_schema(name, "protobuf", b""))
    for row in rows:
        writer.add_message(channel, log_time=0, publish_time=0, data=row)


def add_meta(writer, text):
    writer.add_attachment(create_time=0, log_time=0, name="meta", media_type="application/json", data=text)


META = b'{"format": 3}'


def test_a_file_without_meta_or_of_another_version(tmp_path):
    assert refused(mcap(tmp_path / "a.mcap", lambda writer: None), "RBL820")
    assert refused(mcap(tmp_path / "b.mcap", lambda writer: add_samples(writer, [b""])), "RBL820")
    assert refused(mcap(tmp_path / "c.mcap", lambda writer: add_meta(writer, META)), "RBL821")
    assert refused(mcap(tmp_path / "d.mcap", lambda writer: add_meta(writer, b"[" * 100_000)))
    assert refused(mcap(tmp_path / "e.mcap", lambda writer: add_meta(writer, b'{"format": 2}')))


def with_meta(rows, **channel):
    import json

    def write(writer):
        add_meta(writer, json.dumps(meta()).encode())
        add_samples(writer, rows, **channel)

    return write


def row(**fields):
    lists = {name: [0.0] * width for name, width in SAMPLE.widths(6).items()}
    return SAMPLE.message_class(**{**lists, **fields}).SerializeToString()


@pytest.mark.parametrize("rows", [[row()], [row(q_fb=[0.0] * 5)], [b"\x07"], [b""]])
def test_rows_that_do_not_go_together_are_refused(tmp_path, rows):
    assert refused(mcap(tmp_path / "l.mcap", with_meta(rows)))


@pytest.mark.parametrize("channel", [{"topic": "/other"}, {"name": "other.Sample"}])
def test_what_is_not_ours_is_left_out(tmp_path, channel):
    read = read_log(mcap(tmp_path / "l.mcap", with_meta([b"\xff\xff"], **channel)))
    assert read.count("t") == 0


def test_other_packing_is_refused(tmp_path):
    assert refused(mcap(tmp_path / "l.mcap", with_meta([row()]), compression=CompressionType.LZ4))


def unpacks_nothing(monkeypatch):
    def unpack(*_):
        raise AssertionError("it was unpacked")

    monkeypatch.setattr(zstandard, "decompress", unpack)


def test_a_large_record_is_refused_before_it_is_read_or_unpacked(tmp_path, monkeypatch):
    path = written(tmp_path / "l.mcap", log(100))
    unpacks_nothing(monkeypatch)
    data = path.read_bytes()
    at = 8 + 9 + int.from_bytes(data[9:17], "little")  # the record after the header
    path.write_bytes(data[: at + 1] + (2**63).to_bytes(8, "little") + data[at + 9 :])
    assert refused(path)
    monkeypatch.setattr(mcap_reading, "MOST_RECORD", len(data) - 1000)
    path.write_bytes(data)
    assert refused(path)


def test_all_rows_together_are_bounded(tmp_path, monkeypatch):
    path = written(tmp_path / "l.mcap", log(100))
    size = sum(len(each) for each in SAMPLE.messages({name: log(100)[name] for name in SAMPLE.names}))
    monkeypatch.setattr(mcap_reading, "MOST_BYTES", size)
    assert read_log(path).count("t") == 100
    monkeypatch.setattr(mcap_reading, "MOST_BYTES", size - 1)
    assert refused(path)


def test_a_chunk_that_unpacks_to_more_than_it_says_is_refused(tmp_path, monkeypatch):
    """The library would take the size from the packed bytes."""
    pack = zstandard.compress
    monkeypatch.setattr(zstandard, "compress", lambda data: pack(bytes(data) + b"\0" * 1_000_000))
    path = mcap(tmp_path / "l.mcap", with_meta([row()]))
    unpacks_nothing(monkeypatch)
    assert refused(path)


@pytest.mark.parametrize("at_once", [1, 10_000])
def test_rows_are_packed_now_and_then(tmp_path, monkeypatch, at_once):
    monkeypatch.setattr(mcap_reading, "_AT_ONCE", at_once)
    made = log(100)
    read = read_log(written(tmp_path / "l.mcap", made))
    assert all(same(read[name], values) for name, values in made.items())


def test_poses_that_are_no_numbers_are_written_and_read(tmp_path):
    made = log(64)
    assert not np.isfinite(made["q_fb"]).all()
    read = read_log(written(tmp_path / "l.mcap", Log(made.rows, {**made.meta, "scene": None})))
    assert same(read["q_fb"], made["q_fb"])


def test_a_small_file_that_unpacks_to_a_large_one_is_refused_before_that(tmp_path, monkeypatch):
    path, unpacked = tmp_path / "b.mcap", []
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        channel = writer.register_channel("/other", "protobuf", writer.register_schema("other", "protobuf", b""))
        for _ in range(40):
            writer.add_message(channel, log_time=0, publish_time=0, data=bytes(1_000_000))
        writer.finish()
    assert path.stat().st_size < 100_000
    seen = mcap_reading._Reading._chunk
    monkeypatch.setattr(
        mcap_reading._Reading, "_chunk", lambda self, chunk: (unpacked.append(chunk), seen(self, chunk))
    )
    with pytest.raises(Fault) as caught:
        read_log(path)
    assert caught.value.code == "RBL619"
    assert len(unpacked) < 10


def test_rows_that_are_read_cannot_be_changed(tmp_path):
    read = read_log(written(tmp_path / "l.mcap", log(40)))
    with pytest.raises(ValueError, match="read-only"):
        read.rows.read("q_fb", 0, 3)[0, 0] = 7.0
    with pytest.raises(ValueError, match="read-only"):
        read.rows.tools[0][0, 0] = 7.0


@pytest.mark.parametrize("kept", [0.001, 0.5, 0.999])
def test_a_file_that_is_cut_is_called_cut(tmp_path, kept):
    whole, cut = tmp_path / "l.mcap", tmp_path / "cut.mcap"
    write_log(whole, log(40, PLAIN))
    content = whole.read_bytes()
    cut.write_bytes(content[: 8 + int(kept * (len(content) - 8))])
    with pytest.raises(Fault) as refused:
        read_log(cut)
    assert refused.value.code == "RBL619" and "cut" in refused.value.message.split()
    assert "FILE.mcap" in refused.value.hint
