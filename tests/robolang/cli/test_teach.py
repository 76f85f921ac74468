"""``robolang teach``: one point into the points file, and what is printed and refused."""

import json

import pytest

from robolang.project.builtin import cell_text
from robolang.project.points import load_points
from tests.robolang.cli.commands import dry, robolang

POINTS = """schema = 1
# taught by hand
[points.P1]
joints = [0, 45, -90, 0, 45, 0]  # home
comment = "home"
[points.P2]
pose = [450, -150, 700, 180, 0, 90]
frame = "pallet"
"""
CELL = """schema = 1
[frames.pallet]
pose_mm_deg = [0, 0, 0, 0, 0, 10]
[tools.torch]
pose_mm_deg = [0, 0, 180, 0, 35, 0]
"""


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "p.rbl"
    path.write_text("10 MOVEJ P1\n20 MOVEJ P2\n30 MOVEJ P1\n")
    (tmp_path / "p.cell.toml").write_text(cell_text() + CELL.removeprefix("schema = 1\n"))
    (tmp_path / "p.points.toml").write_text(POINTS)
    return path


def taught(program, name):
    return load_points(program.with_name("p.points.toml")).get(name)


def teach(program, *words, code=0):
    result = robolang("teach", program, *words, "--json", code=code)
    return json.loads(result.stdout) if result.stdout else result.stderr


def test_a_new_point_as_joints(program):
    found = teach(program, "P7", "--joints", "0,45,-90,0,45,10")
    assert (found["kind"], found["joints"], found["is_new"], found["change"]) == (
        "joints",
        [0.0, 45.0, -90.0, 0.0, 45.0, 10.0],
        True,
        None,
    )
    assert found["written"] == [str(program.with_name("p.points.toml"))]
    assert taught(program, "P7").joints == (0.0, 45.0, -90.0, 0.0, 45.0, 10.0)
    # order and comments of the file stay
    assert program.with_name("p.points.toml").read_text().startswith(POINTS)


def test_a_new_point_as_a_pose_in_a_frame_with_a_tool(program):
    found = teach(program, "P7", "--pose", "450,-150,700,180,0,90", "--frame", "pallet", "--tool", "torch")
    assert (found["kind"], found["frame"], found["tool"]) == ("pose", "pallet", "torch")
    assert found["pose"] == pytest.approx([450, -150, 700, 180, 0, 90], abs=1e-3)
    assert len(found["configuration"].split()) == 3
    point = taught(program, "P7")
    assert (point.frame, point.tool, list(point.pose)) == ("pallet", "torch", found["pose"])


def test_a_new_point_in_a_frame_is_a_pose_unless_joints_are_named(program):
    joints = ("--joints", "0,45,-90,0,45,10", "--frame", "pallet")
    assert teach(program, "P7", *joints)["kind"] == "pose"
    assert teach(program, "P8", *joints, "--as", "joints")["kind"] == "joints"
    assert teach(program, "P9", "--pose", "450,-150,700,180,0,90", "--as", "joints")["kind"] == "joints"


def test_a_point_that_is_there_needs_yes(program):
    before = program.with_name("p.points.toml").read_text()
    result = robolang("teach", program, "p1", "--joints", "0,45,-90,0,45,2", code=2)
    assert "error RBL718" in result.stderr
    assert program.with_name("p.points.toml").read_text() == before
    found = teach(program, "p1", "--joints", "0,45,-90,0,45,2", "--yes")
    # the name as it was spelt, and the comment
    assert (found["point"], found["is_new"]) == ("P1", False)
    assert found["change"]["by"] == pytest.approx([0, 0, 0, 0, 0, 2], abs=1e-6)
    assert found["change"]["joints_deg"] == pytest.approx([0, 0, 0, 0, 0, 2], abs=1e-6)
    assert (taught(program, "P1").joints[5], taught(program, "P1").comment) == (2.0, "home")
    assert "# taught by hand" in program.with_name("p.points.toml").read_text()


def test_a_point_keeps_its_kind_and_frame(program):
    found = teach(program, "P2", "--pose", "460,-150,700,180,0,90", "--yes")
    # the pose is in the frame of the point
    assert (found["kind"], found["frame"]) == ("pose", "pallet")
    assert found["change"]["by"] == pytest.approx([10, 0, 0, 0, 0, 0], abs=2e-3)
    found = teach(program, "P2", "--pose", "460,-150,700,180,0,90", "--frame", "WORLD", "--yes")
    assert found["frame"] == ""
    assert found["change"]["distance_mm"] > 10.0


def test_a_tool_that_is_named_is_written_also_where_it_is_that_of_the_hand(program):
    assert teach(program, "P7", "--pose", "450,-150,700,180,0,90", "--tool", "grip")["tool"] == "grip"
    assert teach(program, "P8", "--pose", "450,-150,700,180,0,90")["tool"] == ""


def test_the_joints_of_a_pose_are_those_nearest_to_the_point_as_it_is(program):
    pose = ("--pose", "450,-150,700,180,0,30", "--as", "joints")
    *rest, j6 = teach(program, "P7", *pose)["joints"]
    # J6 has a range of 532 deg, in which the angle comes twice
    turned = j6 - 360.0 if j6 > 0.0 else j6 + 360.0
    near = ",".join(map(str, [*rest, turned]))
    teach(program, "P7", "--joints", near, "--yes")
    assert teach(program, "P7", *pose, "--yes")["joints"][5] == pytest.approx(turned, abs=1e-3)


def test_where_a_run_stood(program, tmp_path):
    log = tmp_path / "r.npz"
    dry(program, "--log", log)
    found = teach(program, "P7", "--here-of", log, "--line", "10")
    assert found["joints"] == pytest.approx([0, 45, -90, 0, 45, 0], abs=1e-4)
    found = teach(program, "P8", "--here-of", log, "--line", "20", "--as", "pose", "--frame", "pallet")
    assert found["pose"] == pytest.approx([450, -150, 700, 180, 0, 90], abs=2e-3)
    found = teach(program, "P9", "--here-of", log, "--time", "0")
    assert len(found["joints"]) == 6


@pytest.mark.parametrize(
    ("words", "code", "error"),
    [
        ((), 2, "RBL703"),
        (("--joints", "0,0,0,0,0,0", "--pose", "1,2,3,4,5,6"), 2, "RBL703"),
        (("--joints", "0,0,0"), 2, "RBL703"),
        (("--joints", "0,0,0,0,0,nan"), 2, "RBL703"),
        (("--joints", "300,0,0,0,0,0"), 2, "RBL309"),
        (("--joints", "0,45,-90,0,45,0", "--line", "10"), 2, "RBL703"),
        (("--joints", "0,45,-90,0,45,0", "--time", "1"), 2, "RBL703"),
        (("--joints", "0,45,-90,0,45,0", "--frame", "shelf"), 2, "RBL305"),
        (("--joints", "0,45,-90,0,45,0", "--tool", "laser"), 2, "RBL305"),
        (("--pose", "4500,0,0,0,0,0"), 3, "RBL410"),
        (("--here-of", "none.npz"), 2, "RBL703"),
        (("--here-of", "none.npz", "--line", "10"), 2, "RBL600"),
        (("--here-of", "none.npz", "--time", "nan"), 2, "RBL703"),
        (("--here-of", "none.npz", "--time", "-1"), 2, "RBL703"),
    ],
)
def test_what_is_refused_writes_nothing(program, words, code, error):
    before = {path.name: path.read_bytes() for path in program.parent.iterdir()}
    result = robolang("teach", program, "P7", *words, code=code)
    assert error in result.stderr
    assert result.stdout == ""
    assert {path.name: path.read_bytes() for path in program.parent.iterdir()} == before


def test_a_name_that_cannot_be(program):
    assert "RBL303" in teach(program, "GOTO", "--joints", "0,45,-90,0,45,0", code=2)


def test_a_program_that_is_not_there(tmp_path):
    assert "RBL701" in teach(tmp_path / "no.rbl", "P7", "--joints", "0,45,-90,0,45,0", code=2)


def test_the_tables(program):
    result = robolang("teach", program, "P2", "--pose", "460,-150,700,180,0,90", "--yes")
    lines = [line.split() for line in result.stdout.splitlines()]
    before = next(line for line in lines if line[:1] == ["before"])
    after = next(line for line in lines if line[:1] == ["taught"])
    assert (before[1], after[1]) == ("450.000", "460.000")
    assert ["in", "pallet", "10.000", "0.000", "0.000", "0.000", "0.000", "0.000"] in lines
    assert ["dX", "dY", "dZ", "dRX", "dRY", "dRZ"] in lines
    assert ["dJ1", "dJ2", "dJ3", "dJ4", "dJ5", "dJ6"] in lines
    assert "10.000 mm" in result.stdout


def test_an_old_point_out_of_reach_is_noted(program):
    points = program.with_name("p.points.toml")
    points.write_text(POINTS.replace("450, -150", "4500, -150"))
    found = teach(program, "P2", "--pose", "450,-150,700,180,0,90", "--yes")
    assert found["change"]["joints_deg"] is None
    points.write_text(POINTS.replace("450, -150", "4500, -150"))
    assert "note: " in robolang("teach", program, "P2", "--pose", "450,-150,700,180,0,90", "--yes").stderr
