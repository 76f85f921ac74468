"""An ``.mcap`` as a foreign viewer has it: nothing is known but the file and the published schemas of its messages.

The facts of these schemas, fields with their numbers and types, are in ``foxglove_schemas.json``, taken from the
``.proto`` files of github.com/foxglove/foxglove-sdk (MIT). Poses are rebuilt here by other formulas than those of the
writer, and compared with the ``.npz`` of the same run.
"""

import io
import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorSet
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from robolang.logs.files import read_log
from tests.robolang.cli.commands import ROOT, dry, robolang

PUBLISHED = json.loads(Path(__file__).with_name("foxglove_schemas.json").read_text("utf-8"))
NEAR_M = 1e-5
TOOLS = """10 TOOL POSE(0, 0, 150, 0, 30, 0)
20 MOVEJ JOINT(10, 60, -150, 20, -60, 30)
30 TOOL FLANGE
40 PRINT "moved"
50 MOVEJ JOINT(0, 77, -183, 0, -74, 0)
60 x = 1 / IN(1)
"""


class Viewer:
    """What a viewer makes of a file: messages by topic, with their times in s."""

    def __init__(self, path):
        reader = make_reader(io.BytesIO(path.read_bytes()), True, [DecoderFactory()])
        self.summary = reader.get_summary()
        self.attachments = {each.name: each for each in reader.iter_attachments()}
        self.messages = {}
        self.schemas = {}
        for schema, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
            assert (schema.encoding, channel.message_encoding) == ("protobuf", "protobuf")
            self.schemas[channel.topic] = schema.name
            self.messages.setdefault(channel.topic, []).append((message.log_time, decoded))

    def frames(self):
        """Yield the time and X_world_frame (4, 4) of every frame, at each message of moving frames."""
        known = {}
        ((_, fixed),) = self.messages["/tf_static"]
        add(known, fixed)
        for time_ns, moving in self.messages["/tf"]:
            add(known, moving)
            yield time_ns, {child: in_world(known, child) for child in known}


def add(known, message):
    for each in message.transforms:
        known[each.child_frame_id] = each.parent_frame_id, matrix(each.translation, each.rotation)


def in_world(known, frame):
    if frame == "world":
        return np.eye(4)
    parent, X = known[frame]
    return in_world(known, parent) @ X


def matrix(p, q):
    """Return the pose of a translation and a quaternion: the sandwich product of each axis."""
    w, v = q.w, np.array([q.x, q.y, q.z])
    X = np.eye(4)
    for k, e in enumerate(np.eye(3)):
        X[:3, k] = 2.0 * np.dot(v, e) * v + (w * w - np.dot(v, v)) * e + 2.0 * w * np.cross(v, e)
    X[:3, 3] = p.x, p.y, p.z
    return X


def run(folder, program, *words, code=0, physics=False):
    if physics:
        robolang("run", program, "--quiet", *words, "--log", folder / "r.npz", code=code)
        robolang("run", program, "--quiet", *words, "--log", folder / "r.mcap", code=code)
    else:
        dry(program, "--quiet", *words, "--log", folder / "r.npz", code=code)
        dry(program, "--quiet", *words, "--log", folder / "r.mcap", code=code)
    return read_log(folder / "r.npz"), Viewer(folder / "r.mcap")


@pytest.fixture(scope="module")
def carried(tmp_path_factory):
    """The run that carries a part, as a log and as a viewer sees it."""
    return run(tmp_path_factory.mktemp("carried"), ROOT / "programs" / "pick_and_place.rbl", physics=True)


@pytest.fixture(scope="module")
def tools(tmp_path_factory):
    """A run of the ideal arm that changes its tool, prints and ends with an alarm."""
    folder = tmp_path_factory.mktemp("tools")
    (folder / "p.rbl").write_text(TOOLS)
    cell = (ROOT / "robolang/project/builtin/cell.toml").read_text()
    (folder / "p.cell.toml").write_text(cell + "\n[inputs.1]\nchanges = [[0, 1], [0.5, 0]]\n")
    return run(folder, folder / "p.rbl", code=3)


# --- schemas ----------------------------------------------------------------------------------------------------------


def fields_of(message):
    kinds = FieldDescriptorProto
    names = {
        kinds.TYPE_DOUBLE: "double",
        kinds.TYPE_STRING: "string",
        kinds.TYPE_BOOL: "bool",
        kinds.TYPE_BYTES: "bytes",
        kinds.TYPE_FIXED32: "fixed32",
    }
    return {
        field.name: [field.number, names.get(field.type) or field.type_name[1:], field.label == kinds.LABEL_REPEATED]
        for field in message.field
    }


def test_the_schemas_in_the_file_are_those_that_are_published(tools):
    _, viewer = tools
    schemas = {each.name: each for each in viewer.summary.schemas.values() if each.name.startswith("foxglove.")}
    assert set(schemas) == {"foxglove.FrameTransforms", "foxglove.SceneUpdate", "foxglove.Log"}
    for schema in schemas.values():
        assert schema.encoding == "protobuf"
        files = FileDescriptorSet.FromString(schema.data).file
        found = {f"{file.package}.{each.name}": each for file in files for each in file.message_type}
        assert schema.name in found
        for name, published in PUBLISHED.items():
            assert fields_of(found[name]) == published["fields"], name
            enums = {each.name: {value.name: value.number for value in each.value} for each in found[name].enum_type}
            assert enums == published["enums"]
        assert set(found) == {*PUBLISHED, "google.protobuf.Timestamp", "google.protobuf.Duration"}


def test_topics_have_their_schemas(tools):
    _, viewer = tools
    assert viewer.schemas == {
        "/tf": "foxglove.FrameTransforms",
        "/tf_static": "foxglove.FrameTransforms",
        "/scene": "foxglove.SceneUpdate",
        "/log": "foxglove.Log",
        "/controller": "robolang.Sample",
        "/controller/cycle": "robolang.Cycle",
        "/cell": "robolang.Frame",
    }


@pytest.mark.physics
def test_messages_are_in_the_order_of_time(carried):
    _, viewer = carried
    chunks = viewer.summary.chunk_indexes
    assert len(chunks) > 2
    assert all(before.message_end_time <= after.message_start_time for before, after in pairwise(chunks))
    for found in viewer.messages.values():
        times = [time_ns for time_ns, _ in found]
        assert times == sorted(times)


# --- transforms -------------------------------------------------------------------------------------------------------


def near(X, other):
    return np.abs(X[:3, 3] - other[:3, 3]).max() < NEAR_M and np.abs(X[:3, :3] - other[:3, :3]).max() < 1e-7


@pytest.mark.physics
def test_tool_and_part_are_where_the_log_has_them(carried):
    log, viewer = carried
    step = 16
    true, parts = log["X_world_tool"][::step], log["parts"]
    count = 0
    for k, (time_ns, frames) in enumerate(viewer.frames()):
        assert time_ns == round(log["frame_t"][k] * 1e9)
        assert near(frames["tool"], true[k])
        assert near(frames["tool_point"], true[k])
        part = frames["part:part"]
        assert np.abs(part[:3, 3] - parts[k, 0, :3]).max() < NEAR_M
        w, x, y, z = (float(each) for each in parts[k, 0, 3:])
        turn = type("Q", (), {"w": w, "x": x, "y": y, "z": z})
        assert np.abs(part[:3, :3] - matrix(type("P", (), {"x": 0, "y": 0, "z": 0}), turn)[:3, :3]).max() < 1e-6
        count += 1
    assert count == log.count("parts") == 331
    assert np.ptp(parts[:, 0, 2]) > 0.1  # it was carried


@pytest.mark.physics
def test_fingers_are_as_far_from_the_tool_as_the_log_has_them(carried):
    log, viewer = carried
    found = []
    for _, frames in viewer.frames():
        inside = [np.linalg.inv(frames["tool"]) @ frames[f"finger_{side}"] for side in ("left", "right")]
        found.append([X[:3, 3] for X in inside])
    places = np.array(found)
    moved = np.linalg.norm(places - places[0], axis=2)
    assert np.abs(moved - np.abs(log["fingers"] - log["fingers"][0])).max() < NEAR_M
    assert moved.max() > 0.01


def test_the_tool_point_is_that_of_the_tool_in_use(tools):
    log, viewer = tools
    true = log["X_world_tool"][::16]
    apart = 0
    for k, (_, frames) in enumerate(viewer.frames()):
        assert near(frames["tool_point"], true[k])
        apart += not near(frames["tool"], true[k])
    assert 0 < k < log.count("parts")
    assert apart == k + 1  # neither of the two tools is that of the hand


def test_every_message_of_moving_frames_has_its_time(tools):
    _, viewer = tools
    for time_ns, message in viewer.messages["/tf"]:
        for each in message.transforms:
            assert each.timestamp.seconds * 1_000_000_000 + each.timestamp.nanos == time_ns


# --- scene ------------------------------------------------------------------------------------------------------------


def primitives(entity):
    return [each for kind in ("cubes", "spheres", "cylinders", "triangles") for each in getattr(entity, kind)]


@pytest.mark.physics
def test_every_shape_is_drawn_on_the_frame_of_its_body(carried):
    log, viewer = carried
    ((time_ns, update),) = viewer.messages["/scene"]
    assert time_ns == 0
    _, frames = next(viewer.frames())
    entities = {entity.id: entity for entity in update.entities}
    scene = log.meta["scene"]
    for body in {shape["body"] for shape in scene["shapes"]}:
        entity = entities[body]
        assert entity.frame_id == body
        assert body in frames
        assert entity.frame_locked
        assert (entity.lifetime.seconds, entity.lifetime.nanos) == (0, 0)
        expected = sum(3 if each["kind"] == "limb" else 1 for each in scene["shapes"] if each["body"] == body)
        assert len(primitives(entity)) == expected
        for each in primitives(entity):
            assert each.color.a == 1.0
    assert {text.text for text in entities["points and frames"].texts} >= set(log.meta["points"])


def ends(cylinder):
    """Return both ends of a cylinder in its body, with their radii."""
    X = matrix(cylinder.pose.position, cylinder.pose.orientation)
    half = cylinder.size.z / 2.0 * X[:3, 2]
    return [
        (X[:3, 3] - half, cylinder.size.x / 2.0 * cylinder.bottom_scale),
        (X[:3, 3] + half, cylinder.size.y / 2.0 * cylinder.top_scale),
    ]


@pytest.mark.physics
def test_shapes_have_the_places_sizes_and_colours_of_the_scene(carried):
    log, viewer = carried
    ((_, update),) = viewer.messages["/scene"]
    entities = {entity.id: entity for entity in update.entities}
    scene = log.meta["scene"]
    taken = {
        entity: {kind: iter(getattr(entities[entity], kind)) for kind in ("cubes", "spheres", "cylinders")}
        for entity in entities
    }
    kinds = set()
    for shape in scene["shapes"]:
        found, X, size = taken[shape["body"]], np.array(shape["X"]), shape["size"]
        kinds.add(shape["kind"])
        match shape["kind"]:
            case "box":
                each = next(found["cubes"])
                assert near(matrix(each.pose.position, each.pose.orientation), X)
                assert (each.size.x, each.size.y, each.size.z) == tuple(size)
            case "sphere":
                each = next(found["spheres"])
                assert each.size.x / 2.0 == pytest.approx(size[0])
            case "cylinder" | "limb":
                each = next(found["cylinders"])
                start = -size[2] / 2.0 if shape["kind"] == "cylinder" else 0.0
                for (place, radius), at, own in zip(ends(each), (start, start + size[2]), size, strict=False):
                    assert place == pytest.approx(X[:3, 3] + at * X[:3, 2], abs=1e-7)
                    assert radius == pytest.approx(own)
                if shape["kind"] == "limb":
                    for at, own in zip((0.0, size[2]), size, strict=False):
                        ball = next(found["spheres"])
                        place = ball.pose.position
                        assert [place.x, place.y, place.z] == pytest.approx(X[:3, 3] + at * X[:3, 2], abs=1e-7)
                        assert ball.size.x / 2.0 == pytest.approx(own)
        code = scene["colours"][shape["colour"]]
        assert [each.color.r, each.color.g, each.color.b] == [int(code[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    assert kinds >= {"box", "cylinder", "limb"}


# --- lines of the log, and meta ---------------------------------------------------------------------------------------


def test_what_is_printed_and_alarms_are_lines_of_the_log(tools):
    log, viewer = tools
    report = log.meta["report"]
    lines = [
        (time_ns, each.level, each.message, each.line, each.file, each.name)
        for time_ns, each in viewer.messages["/log"]
    ]
    (printed,), (alarm,) = report["printed"], report["alarms"]
    assert (round(printed["time_s"] * 1e9), 2, "moved", 0, "p.rbl", "robolang") in lines
    warned = [(time_ns, line) for time_ns, level, _, line, _, _ in lines if level == 3]
    assert warned == [(round(each["time_s"] * 1e9), each["line"]) for each in report["warnings"]] != []
    assert lines[-1][:2] == (round(alarm["time_s"] * 1e9), 4)
    assert lines[-1][2].startswith(f"{alarm['code']} ")
    assert lines[-1][3] == alarm["line"] == 6
    assert len(lines) == 2 + len(report["warnings"])


def test_the_file_holds_what_the_run_was_of(tools):
    log, viewer = tools
    assert viewer.attachments["meta"].media_type == "application/json"
    assert json.loads(viewer.attachments["meta"].data) == log.meta
