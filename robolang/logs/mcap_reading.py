"""Reading a log from ``.mcap``: the rows of our own messages, and ``meta``. The file is not trusted.

Lengths are compared with what is there before anything is read, and sizes of chunks before anything is unpacked. What
other programs have added to the file, other topics, attachments or records, is left out.
"""

import os
import struct
import zlib
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import IO, Any

import numpy as np

from robolang.logs.log import Log
from robolang.logs.meta import damaged, read_meta, ticks_of, unreadable
from robolang.logs.records import CYCLE, FRAME, META, SAMPLE, Record
from runtime.control.blocks import FRAME_CYCLES, WHOLE
from runtime.core.bounded_files import RefusedError, regular_file
from runtime.core.faults import Fault
from runtime.core.frames import Array

MOST_RECORD = 64_000_000
"""Most bytes of a record, and of what a chunk unpacks to; ours have about a million."""
MOST_BYTES = 4_000_000_000
"""Most bytes of all messages of a kind: half an hour of ticks of 0.25 ms. They are kept in memory."""
MOST_PACKED = 50
"""How many times the size of the file all chunks unpack to at most: 2 to 7 in a log, and 9 of an arm at rest."""
_AT_ONCE = 1_000_000
"""Bytes of messages after which their numbers are packed."""
_MAGIC = b"\x89MCAP0\r\n"
_HEAD = struct.Struct("<BQ")
_RECORDS = {record.topic: record for record in (SAMPLE, CYCLE, FRAME)}
_OF_CYCLES = ("q_plan", "D", "T", "payload_mass", "line", "number", "wrist_mode", "seam_deviation")
"""Signals of a cycle that a file has in each tick."""


def read_mcap(path: Path) -> Log:
    """Return the log in a file of ``robolang run --log FILE.mcap``, with all its rows in memory.

    ``Fault`` RBL600 for a file that cannot be read, RBL619 for one that is no log or is damaged, RBL820 for one of an
    older version, which had no ``meta``, and RBL821 for one of a later version.
    """
    from google.protobuf.message import DecodeError
    from mcap.exceptions import McapError
    from mcap.stream_reader import CRCValidationError
    from zstandard import ZstdError

    try:
        with regular_file(path) as stream:
            return _Reading(path).log(stream)
    except (RefusedError, OSError) as error:
        reason = error.reason if isinstance(error, RefusedError) else error.strerror
        raise unreadable(path, reason) from None
    except (ValueError, KeyError, TypeError, IndexError, EOFError, OverflowError, struct.error) as error:
        raise damaged(path, error) from None
    except (DecodeError, McapError, CRCValidationError, ZstdError) as error:
        raise damaged(path, error) from None


def _payloads(stream: IO[bytes]) -> Iterator[tuple[int, bytes]]:
    """Yield operation code and content of each record."""
    left = os.fstat(stream.fileno()).st_size - 2 * len(_MAGIC)
    if stream.read(len(_MAGIC)) != _MAGIC:
        raise ValueError("it does not begin as an MCAP file")
    while left > 0:
        if not left >= _HEAD.size:
            raise ValueError("the file is cut off")
        code, length = _HEAD.unpack(stream.read(_HEAD.size))
        left -= _HEAD.size + length
        if not length <= MOST_RECORD:
            raise ValueError(f"a record of {length} bytes")
        if not left >= 0:
            raise ValueError("the file is cut off")
        yield code, stream.read(length)
    if stream.read() != _MAGIC:
        raise ValueError("the file is cut off")


class _Reading:
    """What has been read of one file."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._meta: dict[str, Any] | None = None
        self._columns: dict[Record, _Columns] = {}
        self._schemas: dict[int, str] = {}
        self._channels: dict[int, Record] = {}
        self._left = 0

    def log(self, stream: IO[bytes]) -> Log:
        """Return the log in a stream."""
        from mcap.data_stream import ReadDataStream
        from mcap.opcode import Opcode
        from mcap.records import Attachment, Chunk

        self._left = MOST_PACKED * os.fstat(stream.fileno()).st_size
        for code, content in _payloads(stream):
            if code == Opcode.CHUNK:
                self._chunk(Chunk.read(ReadDataStream(BytesIO(content))))
            elif code == Opcode.ATTACHMENT:
                attachment = Attachment.read(ReadDataStream(BytesIO(content)))
                if attachment.name == META and self._meta is None:
                    # the library does not compare it; 0: there is none
                    if int.from_bytes(content[-4:], "little") not in (0, zlib.crc32(content[:-4])):
                        raise ValueError("the checksum of its meta is wrong")
                    self._meta = read_meta(attachment.data, self._path)
        meta = self._needed_meta()
        found = {record: self._columns_of(record).arrays() for record in _RECORDS.values()}
        return Log(ReadRows(meta, found[SAMPLE], found[CYCLE], found[FRAME]), meta, str(self._path))

    def _needed_meta(self) -> dict[str, Any]:
        if self._meta is None:
            raise Fault("RBL820", f"{self._path} lacks the program and the robot: it has layout 1, or is no log")
        return self._meta

    def _chunk(self, chunk: Any) -> None:
        import zstandard
        from mcap.records import Channel, Message, Schema
        from mcap.stream_reader import breakup_chunk

        if chunk.compression not in ("", "zstd") or not chunk.uncompressed_size <= MOST_RECORD:
            raise ValueError(f"a chunk of {chunk.uncompressed_size} bytes, packed by {chunk.compression!r}")
        self._left -= chunk.uncompressed_size
        if self._left < 0:
            raise ValueError(f"its chunks unpack to more than {MOST_PACKED} times its size")
        # the library takes the size from the packed bytes, where another one may stand
        if chunk.compression and zstandard.frame_content_size(chunk.data) != chunk.uncompressed_size:
            raise ValueError("a chunk has another size than it says")
        for each in breakup_chunk(chunk, validate_crc=True):
            if isinstance(each, Message) and each.channel_id in self._channels:
                self._columns_of(self._channels[each.channel_id]).add(each.data)
            elif isinstance(each, Schema):
                self._schemas[each.id] = each.name
            elif isinstance(each, Channel):
                self._channel(each)

    def _channel(self, channel: Any) -> None:
        record = _RECORDS.get(channel.topic)
        if record is not None and self._schemas.get(channel.schema_id) == record.full_name:
            self._channels[channel.id] = record

    def _columns_of(self, record: Record) -> "_Columns":
        if record not in self._columns:
            self._columns[record] = _Columns(record, len(self._needed_meta()["robot"]["axes"]))
        return self._columns[record]


class _Columns:
    """The fields of messages of one kind, as arrays: rows are gathered and packed now and then."""

    def __init__(self, record: Record, axes: int) -> None:
        self._record = record
        self._widths: dict[str, int] = record.widths(axes)
        self._rows: dict[str, list[Any]] = {name: [] for name in record.fields}
        self._packed: dict[str, list[Array]] = {name: [] for name in record.fields}
        self._count = self._bytes = self._unpacked = 0

    def add(self, data: bytes) -> None:
        """Add a message."""
        message = self._record.message_class.FromString(data)
        self._count += 1
        self._bytes += len(data)
        self._unpacked += len(data)
        if not self._bytes <= MOST_BYTES:
            raise ValueError(f"more than {MOST_BYTES} bytes of rows")
        for name, rows in self._rows.items():
            value = getattr(message, name)
            if self._record.is_list(name):
                # of the parts the first message says how many there are
                width = self._widths.setdefault(name, len(value))
                if len(value) != width:
                    raise ValueError(f"{name} has {len(value)} numbers, not {width}")
                rows.extend(value)
            else:
                rows.append(value)
        # as floats of Python they take four times as much
        if self._unpacked > _AT_ONCE:
            self._pack()

    def arrays(self) -> dict[str, Array]:
        """Return all rows by name, lists as (N, width)."""
        self._pack()
        found = {name: np.concatenate(pieces) for name, pieces in self._packed.items()}
        return {
            name: values.reshape(self._count, self._widths.get(name, 0)) if self._record.is_list(name) else values
            for name, values in found.items()
        }

    def _pack(self) -> None:
        self._unpacked = 0
        for name, rows in self._rows.items():
            self._packed[name].append(np.array(rows, dtype=self._record.dtype(name)))
            rows.clear()


class ReadRows:
    """The rows of a run in memory: ``runtime.control.signals.Rows``."""

    def __init__(
        self, meta: dict[str, Any], sample: dict[str, Array], cycle: dict[str, Array], frame: dict[str, Array]
    ) -> None:
        self.tick_us, self.ticks_per_cycle = ticks_of(meta)
        self.ticks, self.cycles, self.frames = len(sample["t"]), len(cycle["read_us"]), len(frame["fingers"])
        expected = -(-self.ticks // self.ticks_per_cycle), -(-self.cycles // FRAME_CYCLES)
        if (self.cycles, self.frames) != expected:
            raise ValueError(f"{self.ticks} ticks, {self.cycles} cycles and {self.frames} frames do not go together")
        matrices = cycle["X_flange_tool"].reshape(self.cycles, 4, 4)
        self.tools, tool = _numbered(matrices, np.array(meta["robot"]["tool"], dtype=np.float64))
        self._rows = {
            **{name: values for name, values in sample.items() if name not in _OF_CYCLES},
            **{name: sample[name][:: self.ticks_per_cycle] for name in _OF_CYCLES},
            "read_us": cycle["read_us"],
            "tool": tool,
            "parts": frame["parts"].reshape(self.frames, frame["parts"].shape[1] // 7, 7),
            "fingers": frame["fingers"],
        }
        # views of them are given away, as those of a file are
        for values in (*self._rows.values(), *self.tools):
            values.setflags(write=False)

    def read(self, name: str, first: int, last: int) -> Array:
        """Return rows ``first`` to before ``last`` of a recorded signal."""
        return self._rows[name][first:last].astype(WHOLE.get(name, self._rows[name].dtype), copy=False)


def _numbered(matrices: Array, start: Array) -> tuple[tuple[Array, ...], Array]:
    """Return the tools that are used, that of the start first, and which of them each cycle has (C,)."""
    if not np.isfinite(matrices).all():
        raise ValueError("a tool is not made of numbers")
    tools = {start.tobytes(): start}
    order: dict[bytes, int] = {start.tobytes(): 0}
    numbers: Array = np.zeros(len(matrices), dtype=np.intp)
    for cycle, X in enumerate(matrices):
        key = X.tobytes()
        tools.setdefault(key, X)
        numbers[cycle] = order.setdefault(key, len(order))
    return tuple(tools.values()), np.asarray(numbers)
