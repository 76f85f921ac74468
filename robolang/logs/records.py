"""Our own messages of a log in MCAP: a row of ticks, cycles or frames as a protobuf message, fields by name.

Numbers of fields are an interface: a field keeps its number for ever, and a number that is free stays free.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from runtime.core.frames import Array

META = "meta"
"""Name of the attachment that holds what the run was of."""
_PACKAGE = "robolang"
_DTYPES: dict[str, Any] = {"double": np.float64, "float": np.float32, "int32": np.int32}
_NOT_OF_AXES = {"seam_deviation": 6, "tool_cmd": 3, "X_flange_tool": 16, "fingers": 2}
"""Lists whose length is not the number of axes; that of ``parts`` is seven for each part."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Record:
    """A kind of message: its ``topic``, and for each field its number and type.

    Types: double, float, int32; with * a list, of a matrix row by row.
    """

    name: str
    topic: str
    fields: Mapping[str, tuple[int, str]]

    @property
    def full_name(self) -> str:
        """The name of the message with its package."""
        return f"{_PACKAGE}.{self.name}"

    def is_list(self, name: str) -> bool:
        """Return whether a field is a list."""
        return self.fields[name][1].endswith("*")

    def dtype(self, name: str) -> Any:
        """Return the type of the numbers of a field."""
        return _DTYPES[self.fields[name][1].removesuffix("*")]

    def widths(self, axes: int) -> dict[str, int]:
        """Return how long the lists are for an arm, but for those that the cell gives."""
        lists = (name for name in self.fields if self.is_list(name) and name != "parts")
        return {name: _NOT_OF_AXES.get(name, axes) for name in lists}

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the fields."""
        return tuple(self.fields)

    @cached_property
    def message_class(self) -> Any:
        """The class of the message."""
        from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

        name = f"{_PACKAGE}/{self.name.lower()}.proto"
        file = descriptor_pb2.FileDescriptorProto(name=name, package=_PACKAGE, syntax="proto3")
        message = file.message_type.add(name=self.name)
        kind = descriptor_pb2.FieldDescriptorProto
        for field, (number, form) in self.fields.items():
            message.field.add(
                name=field,
                number=number,
                type=kind.Type.Value(f"TYPE_{form.removesuffix('*').upper()}"),
                label=kind.LABEL_REPEATED if form.endswith("*") else kind.LABEL_OPTIONAL,
            )
        # a pool of its own: the common one belongs to the process
        pool = descriptor_pool.DescriptorPool()
        pool.Add(file)
        return message_factory.GetMessageClass(pool.FindMessageTypeByName(self.full_name))

    def messages(self, columns: Mapping[str, Array]) -> Iterator[bytes]:
        """Yield a message for each row of columns (N, ...), one for each field."""
        lists = [
            # not reshape(n, -1): of a log without a tick numpy cannot infer the other size
            values.reshape(len(values), math.prod(values.shape[1:])).tolist() if form.endswith("*") else values.tolist()
            for values, (_, form) in ((columns[name], self.fields[name]) for name in self.fields)
        ]
        for row in zip(*lists, strict=True):
            made = self.message_class(**dict(zip(self.fields, row, strict=True)))
            yield made.SerializeToString(deterministic=True)


SAMPLE = Record(
    name="Sample",
    topic="/controller",
    fields={
        "t": (1, "double"),
        "q_plan": (2, "double*"),
        "q_cmd": (3, "double*"),
        "dq_cmd": (4, "double*"),
        "tau_cmd": (5, "double*"),
        "tau_sat": (6, "double*"),
        "q_fb": (7, "double*"),
        "dq_fb": (8, "double*"),
        # 9 and 11 were poses of the tool as matrices, which are transforms now
        "q_link": (10, "double*"),
        "D": (12, "double*"),
        "T": (13, "double*"),
        "D_age": (14, "double*"),
        "T_age": (15, "double*"),
        "payload_mass": (16, "double"),
        "line": (17, "int32"),
        "number": (18, "int32"),
        "wrist_mode": (19, "int32"),
        "seam_deviation": (20, "double*"),
        "tool_cmd": (21, "double*"),
        "tool_error": (22, "double"),
        "tool_speed": (23, "double"),
    },
)
"""Signals of a tick."""
CYCLE = Record(
    name="Cycle",
    topic="/controller/cycle",
    fields={"read_us": (1, "double*"), "X_flange_tool": (2, "double*")},
)
"""What the signals of a log are computed from beside those of a tick: when angles were read, and the tool in use."""
FRAME = Record(name="Frame", topic="/cell", fields={"parts": (1, "float*"), "fingers": (2, "float*")})
"""Poses of all parts one after another, and the fingers."""
