"""The log of a run as ``.mcap``, for log viewers.

One protobuf message ``robolang.Sample`` per tick on the channel ``/controller``, with the schema inside, so a viewer
that reads MCAP shows the fields by name; times are simulated, in ns from power-up. A run without a tick gives a valid
file without a message.
"""

import math
from collections.abc import Iterator, Mapping
from typing import IO, Any

import numpy as np

from robolang.logs.log import Log
from runtime.core.frames import Array

CHANNEL = "/controller"
_PIECE = 4096
"""Ticks that are written at once."""


def write_mcap(stream: IO[bytes], log: Log) -> None:
    """Write a log, piece by piece; equal logs give equal bytes."""
    from mcap.writer import Writer
    from mcap_protobuf.schema import register_schema

    names = [name for name in log if log.base(name) == "tick"]
    message_class = _message_class({name: log.span(name, 0, 0) for name in names})
    writer: Any = Writer(stream)  # the writer of mcap_protobuf would name the schema only with the first message
    writer.start()
    channel = writer.register_channel(CHANNEL, "protobuf", register_schema(writer, message_class))
    count = log.count("t")
    for first in range(0, count, _PIECE):
        signals = {name: log.span(name, first, min(first + _PIECE, count)) for name in names}
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
