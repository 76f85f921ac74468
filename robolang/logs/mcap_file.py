"""The log of a run as ``.mcap``, for log viewers and for ``robolang.read_log``.

``/controller`` has a message ``robolang.Sample`` for each tick, ``/controller/cycle`` a ``robolang.Cycle`` for each
cycle and ``/cell`` a ``robolang.Frame`` for each frame. ``/tf``, ``/tf_static``, ``/scene`` and ``/log`` are for
viewers, which draw them without a plug-in (``robolang.logs.foxglove``). Schemas are in the file, ``meta`` is an
attachment; times are simulated, in ns from power-up. A run without a tick gives a valid file.
"""

import heapq
import json
from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import IO, Any

import numpy as np

from robolang.logs import transforms
from robolang.logs.log import Log, Meta
from robolang.logs.log_messages import log_messages
from robolang.logs.records import CYCLE, FRAME, META, SAMPLE, Record
from robolang.logs.scene_messages import scene_update
from runtime.appearance.scene import Scene
from runtime.control.blocks import FRAME_CYCLES
from runtime.core.faults import Fault
from runtime.core.frames import Array

_PIECE = 256
"""Frames that are written at once, with their cycles and ticks."""

Message = tuple[int, str, bytes]
"""Time ns, topic and data of a message."""


def write_mcap(stream: IO[bytes], log: Log) -> None:
    """Write a log, piece by piece; equal logs give equal bytes."""
    from mcap.writer import Writer

    writer: Any = Writer(stream)  # in chunks packed by zstd
    writer.start()
    meta = log.needed_meta()
    scene = _scene(meta)
    text = json.dumps(meta, allow_nan=False, separators=(",", ":")).encode("ascii")
    # before the rows: who reads them in order knows the robot by then
    writer.add_attachment(create_time=0, log_time=0, name=META, media_type="application/json", data=text)
    channels = _channels(writer)
    for time_ns, topic, data in heapq.merge(_recorded(log, scene), log_messages(meta), key=_time):
        writer.add_message(channels[topic], log_time=time_ns, publish_time=time_ns, data=data)
    writer.finish()


def _scene(meta: Meta) -> Scene | None:
    # a log without a picture is better than none: what is wrong with a scene is said by those who draw it
    with suppress(Fault):
        return None if meta["scene"] is None else Scene.from_json(meta["scene"])
    return None


def _time(message: Message) -> int:
    return message[0]


def _channels(writer: Any) -> dict[str, int]:
    """Register schemas and topics, all of them in each file: a viewer shows what there could be."""
    from mcap_protobuf.schema import register_schema

    from robolang.logs.foxglove import message

    classes = {record.topic: record.message_class for record in (SAMPLE, CYCLE, FRAME)}
    classes |= {"/tf": message("FrameTransforms"), "/tf_static": message("FrameTransforms")}
    classes |= {"/scene": message("SceneUpdate"), "/log": message("Log")}
    schemas: dict[str, int] = {}
    found = {}
    for topic, each in classes.items():
        name = each.DESCRIPTOR.full_name
        if name not in schemas:
            schemas[name] = register_schema(writer, each)
        found[topic] = writer.register_channel(topic, "protobuf", schemas[name])
    return found


def _recorded(log: Log, scene: Scene | None) -> Iterator[Message]:
    """Yield what has a row in the log, in the order of time, and first what holds for all of it."""
    if scene is not None:
        yield from ((0, "/tf_static", data) for data in transforms.messages([0], list(transforms.fixed(scene))))
        yield 0, "/scene", scene_update(scene)
    rows = log.rows
    for first in range(0, rows.frames, _PIECE):
        last = min(first + _PIECE, rows.frames)
        cycles = first * FRAME_CYCLES, min(last * FRAME_CYCLES, rows.cycles)
        ticks = cycles[0] * rows.ticks_per_cycle, min(cycles[1] * rows.ticks_per_cycle, rows.ticks)
        frame_ns = _ns(log.span("frame_t", first, last))
        tick_ns = _ns(log.span("t", *ticks))
        streams: list[Iterable[Message]] = [
            _of(FRAME, frame_ns, {name: log.span(name, first, last) for name in FRAME.names}),
            _of(CYCLE, tick_ns[:: rows.ticks_per_cycle], _cycle_rows(log, *cycles)),
            _of(SAMPLE, tick_ns, {name: log.span(name, *ticks) for name in SAMPLE.names}),
        ]
        if scene is not None:
            placed = list(transforms.moving(scene, log, first, last))
            moved = transforms.messages(frame_ns, placed)
            streams.append([(ns, "/tf", data) for ns, data in zip(frame_ns, moved, strict=True)])
        yield from heapq.merge(*streams, key=_time)


def _cycle_rows(log: Log, first: int, last: int) -> dict[str, Array]:
    tools = np.stack(log.rows.tools)[log.rows.read("tool", first, last)]
    return {"read_us": log.rows.read("read_us", first, last), "X_flange_tool": tools}


def _ns(times: Array) -> list[int]:
    # rounded: 1.025 s times 1e9 is a little less than 1,025,000,000
    return [int(ns) for ns in np.rint(times * 1e9).astype(np.int64)]


def _of(record: Record, times_ns: list[int], columns: dict[str, Array]) -> Iterator[Message]:
    return ((ns, record.topic, data) for ns, data in zip(times_ns, record.messages(columns), strict=True))
