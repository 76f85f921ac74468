"""The log of a run as a file: ``.npz`` for numpy, ``.mcap`` for log viewers.

``.npz`` holds one array per signal of ``runtime.control.recorder``, first dimension the servo ticks. ``.mcap`` holds
one protobuf message ``robolang.Sample`` per tick on the channel ``/controller``, with the schema inside, so a viewer
that reads MCAP shows the fields by name; times are simulated, in ns from power-up. A run without a tick gives a valid
file without a message. Both repeat byte for byte: neither carries the time of day.
"""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO, Any

import numpy as np

from robolang.core.storage import write_atomic
from runtime.core.frames import Array

SUFFIXES = (".npz", ".mcap")
CHANNEL = "/controller"


def write_log(path: Path, signals: Mapping[str, Array]) -> None:
    """Write the signals to ``path`` in the format of its suffix; ``ValueError`` for another one, ``Fault`` RBL706."""
    if path.suffix not in SUFFIXES:
        raise ValueError(f"{path} must end in .npz or .mcap")
    writer = _write_npz if path.suffix == ".npz" else _write_mcap
    write_atomic(path, lambda stream: writer(stream, signals))


def _write_npz(stream: IO[bytes], signals: Mapping[str, Array]) -> None:
    # numpy dates every entry of the archive 1980-01-01, so equal signals give equal bytes
    np.savez(stream, allow_pickle=False, **signals)


def _write_mcap(stream: IO[bytes], signals: Mapping[str, Array]) -> None:
    from mcap.writer import Writer
    from mcap_protobuf.schema import register_schema

    message_class = _message_class(signals)
    writer: Any = Writer(stream)  # the writer of mcap_protobuf would name the schema only with the first message
    writer.start()
    channel = writer.register_channel(CHANNEL, "protobuf", register_schema(writer, message_class))
    # rounded: 1.025 s times 1e9 is a little less than 1,025,000,000
    times_ns = np.rint(signals["t"] * 1e9).astype(np.int64).tolist()
    for time_ns, fields in zip(times_ns, _rows(signals), strict=True):
        data = message_class(**fields).SerializeToString(deterministic=True)
        writer.add_message(channel, log_time=time_ns, publish_time=time_ns, data=data)
    writer.finish()


def _rows(signals: Mapping[str, Array]) -> Iterator[dict[str, Any]]:
    """Yield the fields of each tick: a number per scalar signal, a flat list per vector or matrix."""
    columns = [
        # not reshape(n, -1): of a log without a tick numpy cannot infer the other size
        values.tolist() if values.ndim == 1 else values.reshape(len(values), math.prod(values.shape[1:])).tolist()
        for values in signals.values()
    ]
    for row in zip(*columns, strict=True):
        yield dict(zip(signals, row, strict=True))


def _message_class(signals: Mapping[str, Array]) -> Any:
    """Build ``robolang.Sample``: a double (or int32) per scalar signal, a packed list per vector, in log order."""
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

    file = descriptor_pb2.FileDescriptorProto(name="robolang/sample.proto", package="robolang", syntax="proto3")
    message = file.message_type.add(name="Sample")
    for number, (name, values) in enumerate(signals.items(), start=1):
        kind = descriptor_pb2.FieldDescriptorProto
        message.field.add(
            name=name,
            number=number,
            type=kind.TYPE_INT32 if values.dtype.kind == "i" else kind.TYPE_DOUBLE,
            label=kind.LABEL_OPTIONAL if values.ndim == 1 else kind.LABEL_REPEATED,
        )
    # a pool of its own: the common one refuses a second ``Sample``, of a robot with other signals
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName("robolang.Sample"))
