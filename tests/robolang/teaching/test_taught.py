"""Points made of where the arm stands bring it back there, under every tool and frame."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robolang.execution import lowering
from robolang.project.points import Point
from robolang.teaching import points_document
from robolang.teaching.documents import Documents
from robolang.teaching.postures import reached_point, tool_place
from robolang.teaching.taught import taught_point
from runtime.core.faults import Fault
from runtime.core.frames import inverse
from runtime.core.units import DEG
from runtime.robot.kinematics.singularity import singularities
from tests.campaign import size
from tests.robolang.teaching.surroundings import surroundings, torch, without_closed_form

Q = np.array([20.0, 60.0, 10.0, 30.0, 40.0, -200.0]) * DEG


def random_postures(around, count, seed=1):
    """Postures inside the ranges and off the singularity of the wrist, where a pose has less to say."""
    spec, rng = around.cell.robot, np.random.default_rng(seed)
    rows = rng.uniform(spec.lower, spec.upper, (20 * count, spec.n))
    near = singularities(around.kinematics.opw, rows)
    clear = (near.wrist > 5 * DEG) & (near.elbow > 5 * DEG) & (near.shoulder > 0.02)
    return rows[clear][:count]


def test_a_new_point_is_joints_with_four_decimals():
    around = surroundings()
    found = taught_point("P7", None, Q + 1.23456789e-5, around)
    assert found.point == Point(name="P7", joints=(20.0007, 60.0007, 10.0007, 30.0007, 40.0007, -199.9993))
    assert found.notes == ()


def test_a_new_point_in_a_frame_is_a_pose_in_it():
    around = surroundings()
    found = taught_point("P7", None, Q, around, frame="PALLET")
    assert (found.point.joints, found.point.frame, found.point.tool) == (None, "pallet", "")
    X = inverse(around.cell.frames["pallet"]) @ around.kinematics.forward(Q) @ around.X_flange_tool
    assert found.point.pose == pytest.approx(lowering.six_of(X), abs=5.1e-4)
    assert found.point.configuration == tuple(str(around.kinematics.branch_of(Q)).split())
    # J6 has a range above one turn and stands at -200 deg
    assert found.point.turns == (0, 0, 0, 0, 0, -1)


@pytest.mark.parametrize("robot", ["puma560", "irb2400", "manutec_r3"])
@pytest.mark.parametrize("frame", ["", "PALLET"])
@pytest.mark.parametrize("tool", ["hand", "torch"])
def test_a_point_brings_the_arm_back(robot, frame, tool):
    around = surroundings(robot=robot)
    around = torch(around) if tool == "torch" else around
    other = surroundings(robot=robot)  # the flange returns under the tool of the hand too
    for q in random_postures(around, size(500, 10)):
        found = taught_point("P7", "pose", q, around, frame=frame)
        assert found.notes == ()
        assert found.point.tool == ("torch" if tool == "torch" else "")
        for start in (around.cell.home, 0.5 * (around.cell.robot.lower + around.cell.robot.upper), q):
            assert reached_point(found.point, around, start) == pytest.approx(q, abs=0.1 * DEG)
            assert reached_point(found.point, other, start) == pytest.approx(q, abs=0.1 * DEG)
        joints = taught_point("P7", "joints", q, around, frame=frame).point
        assert reached_point(joints, around, around.cell.home) == pytest.approx(q, abs=0.000051 * DEG)


def test_a_tool_without_a_name_is_noted():
    around = replace(surroundings(), X_flange_tool=lowering.pose_si((0, 0, 50, 0, 10, 0)))
    found = taught_point("P7", "pose", Q, around)
    assert (found.point.tool, len(found.notes)) == ("", 1)
    assert reached_point(found.point, around, Q) == pytest.approx(Q, abs=0.1 * DEG)
    # joint angles do not depend on the tool
    assert taught_point("P7", "joints", Q, around).notes == ()


def test_a_frame_without_a_name_is_noted():
    around = surroundings()
    found = taught_point("P7", "pose", Q, around, frame=(100.0, 0.0, 0.0, 0.0, 0.0, 90.0))
    assert (found.point.frame, len(found.notes)) == ("", 1)
    assert found.point.pose == taught_point("P7", "pose", Q, around).point.pose
    assert taught_point("P7", None, Q, around, frame=(100.0, 0.0, 0.0, 0.0, 0.0, 90.0)).point.joints is not None
    world = taught_point("P7", "pose", Q, around, frame="WORLD")
    assert (world.point.frame, world.notes) == ("", ())


def test_a_touch_up_keeps_kind_frame_tool_and_comment():
    around = surroundings()
    old = Point(name="P3", pose=(1.0, 2.0, 3.0, 0.0, 0.0, 0.0), frame="pallet", tool="torch", comment="edge")
    # neither the tool nor the frame of the point is in use
    new = taught_point("P3", None, Q, around, frame="", old=old).point
    assert (new.frame, new.tool, new.comment, new.joints) == ("pallet", "torch", "edge", None)
    assert reached_point(new, around, around.cell.home) == pytest.approx(Q, abs=0.1 * DEG)
    old = Point(name="P3", joints=(0.0,) * 6, comment="home")
    new = taught_point("P3", None, Q, around, frame="PALLET", old=old).point
    assert (new.pose, new.comment, new.frame) == (None, "home", "")


def test_more_decimals_beside_a_limit():
    around = surroundings()
    q = np.array(Q)
    q[5] = around.cell.robot.upper[5]
    found = taught_point("P7", "pose", q, around)
    assert found.notes == ()
    assert reached_point(found.point, around, around.cell.home) == pytest.approx(q, abs=0.1 * DEG)


@pytest.mark.parametrize("at", ["the limit", "J4 30 deg"])
def test_the_file_keeps_every_decimal_that_a_point_needs(at):
    around = surroundings()
    q = np.array(Q)
    q[5] = around.cell.robot.upper[5] if at == "the limit" else q[5]
    documents = Documents(path=Path("p.rbl"), program="", points="schema = 1\n", cell="", cell_path=Path("cell.toml"))
    for kind in ("joints", "pose"):
        point = taught_point("P7", kind, q, around).point
        assert points_document.taught(points_document.set_point(documents, point)).get("P7") == point


def test_joints_are_not_rounded_out_of_their_range():
    around = surroundings()
    spec = around.cell.robot
    narrow = replace(spec.axes[0], limits=replace(spec.axes[0].limits, upper=20.000069 * DEG))
    around = replace(around, cell=replace(around.cell, robot=replace(spec, axes=(narrow, *spec.axes[1:]))))
    q = np.array(Q)
    q[0] = 20.000069 * DEG
    assert taught_point("P7", "joints", q, around).point.joints[0] == 20.0


def test_a_pose_at_a_singularity_is_noted():
    around = surroundings()
    q = np.array([20.0, 60.0, 10.0, 30.0, 0.0, 50.0]) * DEG
    found = taught_point("P7", "pose", q, around)
    assert len(found.notes) == 1
    # the tool is where it was, although the joints may not be
    X = tool_place(reached_point(found.point, around, around.cell.home), around)
    assert X == pytest.approx(tool_place(q, around), abs=1e-5)


def test_a_pose_that_is_read_back_from_here_only_is_noted():
    # an exact pose: from here J4 keeps its angle at the singularity, from elsewhere it does not
    q = np.array([0.0, 0.0, 0.0, 30.0, 0.0, -30.0]) * DEG
    around = surroundings()
    found = taught_point("P7", "pose", q, around)
    assert reached_point(found.point, around, q) == pytest.approx(q, abs=1e-3 * DEG)
    assert len(found.notes) == 1


def test_an_arm_without_a_closed_form_keeps_its_posture_or_is_noted():
    around = without_closed_form(surroundings())
    spec = around.cell.robot
    for q in np.random.default_rng(0).uniform(spec.lower, spec.upper, (4, spec.n)):
        found = taught_point("P7", "pose", q, around)
        assert found.point.configuration == ()
        back = reached_point(found.point, around, around.cell.home)
        assert bool(found.notes) == bool(np.abs(back - q).max() > 0.1 * DEG)
        # the tool is where it was in any case
        assert tool_place(back, around) == pytest.approx(tool_place(q, around), abs=1e-5)


@pytest.mark.parametrize("name", ["7P", "MOVE", "", "P 1", "Pä", "P1\n"])
def test_a_name_that_no_point_can_have(name):
    with pytest.raises(Fault) as caught:
        taught_point(name, None, Q, surroundings())
    assert caught.value.code == "RBL303"


@pytest.mark.parametrize(
    ("q", "code"),
    [
        (Q[:5], "RBL307"),
        (np.array([np.nan, *Q[1:]]), "RBL309"),
        (np.array([200.0 * DEG, *Q[1:]]), "RBL309"),
    ],
)
def test_joints_that_the_robot_does_not_have(q, code):
    with pytest.raises(Fault) as caught:
        taught_point("P7", "joints", q, surroundings())
    assert caught.value.code == code


@pytest.mark.parametrize("old", [{"frame": "shelf"}, {"tool": "laser"}])
def test_a_frame_or_a_tool_that_the_cell_lacks(old):
    old = Point(name="P7", pose=(0.0,) * 6, **old)
    with pytest.raises(Fault) as caught:
        taught_point("P7", None, Q, surroundings(), old=old)
    assert caught.value.code == "RBL305"
    with pytest.raises(Fault) as caught:
        taught_point("P7", None, Q, surroundings(), frame="SHELF")
    assert caught.value.code == "RBL305"
