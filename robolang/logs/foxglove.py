"""Messages that viewers of MCAP files draw without a plug-in: transforms, entities of a scene, lines of a log.

Names, numbers and types of the fields are those of the public protobuf schemas ``foxglove.*`` (decision 0057); the
definitions are built here, so that no file of theirs is shipped. All of them are declared, since a viewer looks a
message up by its name and expects the whole of it.
"""

from functools import cache
from typing import Any

_FIELDS = {
    "Vector3": "double x 1, double y 2, double z 3",
    "Quaternion": "double x 1, double y 2, double z 3, double w 4",
    "Point3": "double x 1, double y 2, double z 3",
    "Pose": "Vector3 position 1, Quaternion orientation 2",
    "Color": "double r 1, double g 2, double b 3, double a 4",
    "KeyValuePair": "string key 1, string value 2",
    "FrameTransform": "Timestamp timestamp 1, string parent_frame_id 2, string child_frame_id 3, "
    "Vector3 translation 4, Quaternion rotation 5",
    "FrameTransforms": "FrameTransform* transforms 1",
    "ArrowPrimitive": "Pose pose 1, double shaft_length 2, double shaft_diameter 3, double head_length 4, "
    "double head_diameter 5, Color color 6",
    "CubePrimitive": "Pose pose 1, Vector3 size 2, Color color 3",
    "SpherePrimitive": "Pose pose 1, Vector3 size 2, Color color 3",
    "CylinderPrimitive": "Pose pose 1, Vector3 size 2, double bottom_scale 3, double top_scale 4, Color color 5",
    "LinePrimitive": "LinePrimitive.Type type 1, Pose pose 2, double thickness 3, bool scale_invariant 4, "
    "Point3* points 5, Color color 6, Color* colors 7, fixed32* indices 8",
    "TriangleListPrimitive": "Pose pose 1, Point3* points 2, Color color 3, Color* colors 4, fixed32* indices 5",
    "TextPrimitive": "Pose pose 1, bool billboard 2, double font_size 3, bool scale_invariant 4, Color color 5, "
    "string text 6",
    "ModelPrimitive": "Pose pose 1, Vector3 scale 2, Color color 3, bool override_color 4, string url 5, "
    "string media_type 6, bytes data 7",
    "SceneEntityDeletion": "Timestamp timestamp 1, SceneEntityDeletion.Type type 2, string id 3",
    "SceneEntity": "Timestamp timestamp 1, string frame_id 2, string id 3, Duration lifetime 4, bool frame_locked 5, "
    "KeyValuePair* metadata 6, ArrowPrimitive* arrows 7, CubePrimitive* cubes 8, SpherePrimitive* spheres 9, "
    "CylinderPrimitive* cylinders 10, LinePrimitive* lines 11, TriangleListPrimitive* triangles 12, "
    "TextPrimitive* texts 13, ModelPrimitive* models 14",
    "SceneUpdate": "SceneEntityDeletion* deletions 1, SceneEntity* entities 2",
    "Log": "Timestamp timestamp 1, Log.Level level 2, string message 3, string name 4, string file 5, fixed32 line 6",
}
"""Messages: type, name and number of each field; * for one that is repeated."""
_ENUMS = {
    "LinePrimitive.Type": ("LINE_STRIP", "LINE_LOOP", "LINE_LIST"),
    "SceneEntityDeletion.Type": ("MATCHING_ID", "ALL"),
    "Log.Level": ("UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"),
}
"""Enumerations inside messages; the values are numbered from 0."""
INFO, WARNING, ERROR = 2, 3, 4
"""Levels of ``Log``."""
_PACKAGE = "foxglove"


@cache
def _pool() -> Any:
    from google.protobuf import descriptor_pb2, descriptor_pool, duration_pb2, timestamp_pb2

    pool = descriptor_pool.DescriptorPool()
    needed = [module.DESCRIPTOR for module in (timestamp_pb2, duration_pb2)]
    file = descriptor_pb2.FileDescriptorProto(name="foxglove/robolang.proto", package=_PACKAGE, syntax="proto3")
    for each in needed:
        pool.AddSerializedFile(each.serialized_pb)
        file.dependency.append(each.name)
    for name, fields in _FIELDS.items():
        message = file.message_type.add(name=name)
        for field in fields.split(", "):
            _add(message, *field.split())
    for name, values in _ENUMS.items():
        owner, _, kind = name.partition(".")
        enum = next(each for each in file.message_type if each.name == owner).enum_type.add(name=kind)
        for number, value in enumerate(values):
            enum.value.add(name=value, number=number)
    pool.Add(file)
    return pool


def _add(message: Any, kind: str, name: str, number: str) -> None:
    """Declare a field of a message."""
    from google.protobuf.descriptor_pb2 import FieldDescriptorProto as Field

    plain = kind.removesuffix("*")
    field = message.field.add(name=name, number=int(number))
    field.label = Field.LABEL_REPEATED if kind.endswith("*") else Field.LABEL_OPTIONAL
    if plain.islower():
        field.type = Field.Type.Value(f"TYPE_{plain.upper()}")
        return
    field.type = Field.TYPE_ENUM if plain in _ENUMS else Field.TYPE_MESSAGE
    package = "google.protobuf" if plain in ("Timestamp", "Duration") else _PACKAGE
    field.type_name = f".{package}.{plain}"


@cache
def message(name: str) -> Any:
    """Return the class of a message, such as ``FrameTransforms``."""
    from google.protobuf import message_factory

    return message_factory.GetMessageClass(_pool().FindMessageTypeByName(f"{_PACKAGE}.{name}"))


def plain(text: str) -> str:
    """Return a text as protobuf takes it: a half of a character, which JSON may hold, becomes a question mark."""
    return text.encode("utf-8", "replace").decode("utf-8")
