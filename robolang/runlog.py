"""The log of a run as a file: ``.npz`` for numpy, ``.mcap`` for log viewers.

``.npz`` holds one array per signal of ``runtime.recorder``, first dimension the servo ticks. ``.mcap`` holds one
protobuf message ``robolang.Sample`` per tick on the channel ``/controller``, with the schema inside, so a viewer
that reads MCAP shows the fields by name. Both repeat byte for byte.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

import numpy as np

from robolang.storage import write_atomic
from runtime.frames import Array

SUFFIXES = (".npz", ".mcap")


def write_log(path: Path, signals: Mapping[str, Array]) -> None:
    """Write the signals to ``path`` in the format of its suffix; ``ValueError`` for another one, ``Fault`` RBL706."""
    if path.suffix not in SUFFIXES:
        raise ValueError(f"{path} must end in .npz or .mcap")
    writer = _write_npz if path.suffix == ".npz" else _write_mcap
    write_atomic(path, lambda stream: writer(stream, signals))


def _write_npz(stream: IO[bytes], signals: Mapping[str, Array]) -> None:
    np.savez(stream, allow_pickle=False, **signals)


def _write_mcap(stream: IO[bytes], signals: Mapping[str, Array]) -> None:
    from mcap_protobuf.writer import Writer

    message_class = _message_class(signals)
    columns = {name: values.reshape(len(values), -1).tolist() for name, values in signals.items()}
    scalars = {name for name, values in signals.items() if values.ndim == 1}
    times_ns = np.rint(signals["t"] * 1e9).astype(np.int64).tolist()
    with Writer(stream) as writer:
        for row, time_ns in enumerate(times_ns):
            fields: dict[str, Any] = {
                name: column[row][0] if name in scalars else column[row] for name, column in columns.items()
            }
            writer.write_message("/controller", message_class(**fields), log_time=time_ns, publish_time=time_ns)


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
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName("robolang.Sample"))
