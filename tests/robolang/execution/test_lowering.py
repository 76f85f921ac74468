"""From what a program writes to SI: units, places, frames, tools and percentages."""

import numpy as np
import pytest

from robolang.evaluation.evaluator import Nowhere
from robolang.execution import lowering
from robolang.execution.lowering import Surroundings
from robolang.interpreter.effects import MoveTo, SetPayload
from robolang.project.project import builtin_cell, load_project
from robolang.values.poses import Place
from runtime.core.faults import Fault
from runtime.motion.commands import MAX, MoveArc, MoveJoint, MoveLinear, MoveSpline
from runtime.robot.kinematics.kinematics import Kinematics
from tests.robolang.helpers import parsed
from tests.robolang.running import execute


@pytest.fixture(scope="module")
def around(tmp_path_factory):
    path = tmp_path_factory.mktemp("p") / "p.rbl"
    path.write_text("MOVE P1\n")
    project = load_project(path)
    cell = project.cell
    return Surroundings(
        points=project.points,
        cell=cell,
        kinematics=Kinematics(cell.robot),
        X_flange_tool=cell.hand.X_flange_tool,
        q_last=np.array(cell.home),
    )


def command(text, around, acceleration=1.0):
    *_, effect = execute(parsed(text), Nowhere(), around.points.names)
    assert isinstance(effect, MoveTo)
    return lowering.move(effect, around, acceleration)


def six(text, around):
    return lowering.six_of(command(text, around).X_world_tool)


def fault(text, around):
    with pytest.raises(Fault) as caught:
        command(text, around)
    return caught.value.code


def test_units(around):
    found = command("MOVE P1, SPEED 200, ACCEL 50, ZONE 5", around)
    assert isinstance(found, MoveLinear)
    assert (found.speed, found.acceleration, found.zone, found.duration) == pytest.approx((0.2, 0.5, 0.005, None))
    assert command("MOVE P1, TIME 3", around).duration == 3.0
    assert [command(f"MOVEJ P1{text}", around, 0.3).acceleration for text in ("", ", ACCEL 50", ", ACCEL MAX")] == [
        0.3,
        0.5,
        MAX,
    ]
    joint = command("MOVEJ P1, SPEED 20", around)
    assert isinstance(joint, MoveJoint)
    assert joint.speed == pytest.approx(0.2)
    arc = command("MOVEC P1, P2, WRIST HOLD TILT", around)
    assert isinstance(arc, MoveArc)
    assert (arc.wrist, arc.held) == ("auto", ("TILT",))
    spline = command("SPLINE (P1, P2, P3), WRIST HOLD ADVANCE", around)
    assert isinstance(spline, MoveSpline)
    assert (len(spline.X_through), spline.held) == (2, ("ADVANCE",))
    for found, name in zip((*spline.X_through, spline.X_world_tool), ("P1", "P2", "P3"), strict=True):
        np.testing.assert_array_equal(found, command(f"MOVE {name}", around).X_world_tool)


@pytest.mark.parametrize(
    "move",
    [
        "MOVE P1, SPEED 200",
        "MOVE P1, TIME 3",
        "MOVE P1",
        "MOVEJ P1, SPEED 20",
        "MOVEJ P1",
        "MOVEC P1, P2",
        "SPLINE (P1, P2)",
        "APPROACH P1, 50",
        "DEPART 50, TIME 2",
    ],
)
def test_an_override_is_left_to_the_planner(around, move):
    whole, half = (command(f"{lead}{move}", around) for lead in ("", "OVERRIDE 50\n"))
    assert (whole.override, half.override) == (1.0, 0.5)
    assert (whole.speed, whole.duration) == (half.speed, half.duration)


def test_a_pose_is_where_it_says(around):
    assert six("MOVE POSE(400, -200, 800, 170, 10, 20)", around) == pytest.approx((400, -200, 800, 170, 10, 20))
    assert six("MOVE POSE(400, -200, 800, 180, 0, 0) + (1, 2, 3)", around)[:3] == pytest.approx((401, -198, 803))
    assert six("MOVE POSE(400, -200, 800, 180, 0, 0) * (1, 2, 3)", around)[:3] == pytest.approx((401, -202, 797))
    turned = six("MOVE POSE(400, -200, 800, 0, 0, 0) * (0, 0, 0, 0, 0, 30)", around)
    assert turned == pytest.approx((400, -200, 800, 0, 0, 30), abs=1e-9)
    assert six("MOVE (P1 + (5, 0, 0)) * (0, 0, 5)", around) == pytest.approx(
        six("MOVE (P1 * (0, 0, 5)) + (5, 0, 0)", around)
    )
    assert six("MOVE P1", around) == pytest.approx(six("MOVE P1 + (0, 0, 0)", around))


def test_a_frame_turns_the_way_and_carries_the_pose(around):
    lead = "FRAME POSE(100, 0, 0, 0, 0, 90)\nMOVE "
    assert six(lead + "POSE(10, 20, 30, 0, 0, 0)", around) == pytest.approx((80, 10, 30, 0, 0, 90), abs=1e-9)
    shifted, plain = six(lead + "P1 + (10, 0, 0)", around), six("MOVE P1", around)
    assert np.subtract(shifted[:3], plain[:3]) == pytest.approx((0, 10, 0), abs=1e-9)


def test_frames_said_twice_and_the_world_and_the_flange(around):
    bench, move = "FRAME POSE(100, 50, 0, 0, 0, 90)\n", "MOVE POSE(10, 20, 30, 0, 0, 0)"
    once = six(bench + move, around)
    assert once == pytest.approx((80, 60, 30, 0, 0, 90), abs=1e-9)
    assert six(bench + bench + move, around) == pytest.approx(once)
    for back in ("FRAME WORLD\n", "FRAME POSE(0, 0, 0, 0, 0, 0)\n"):
        assert six(bench + back + move, around) == pytest.approx(six(move, around), abs=1e-9)
    assert np.array_equal(lowering.tool("FLANGE", around.cell), np.eye(4))
    assert np.array_equal(around.cell.frames["WORLD"], np.eye(4))


def test_approach_and_depart_go_back_along_the_tool(around):
    plain = np.array(six("MOVE POSE(400, -200, 800, 180, 0, 0)", around))
    approach = six("APPROACH POSE(400, -200, 800, 180, 0, 0), 50", around)
    assert approach - plain == pytest.approx([0, 0, 50, 0, 0, 0], abs=1e-9)
    here = lowering.components(Place(last=True), "", around)
    X = lowering.pose_si(here)
    assert command("DEPART 50", around).X_world_tool[:3, 3] == pytest.approx(X[:3, 3] - 0.05 * X[:3, 2])


def test_joints_are_where_the_move_ends_and_a_shift_leaves_them(around):
    text = "JOINT(10, 60, -190, 0, 30, 0)"
    found = command(f"MOVEJ {text}", around)
    assert np.rad2deg(found.q_end) == pytest.approx([10, 60, -190, 0, 30, 0])
    assert command(f"MOVEJ {text} + (0, 0, 1)", around).q_end is None


def test_what_cannot_be_lowered(around):
    assert fault("MOVEJ JOINT(1, 2, 3)", around) == "RBL307"
    assert fault("FRAME nowhere\nMOVE P1 + (0, 0, 1)", around) == "RBL305"
    assert fault("MOVEJ P1, SPEED 0 + 0", around) == "RBL404"
    *_, far = execute(parsed("MOVE P9"), Nowhere(), ("P9",))
    with pytest.raises(Fault, match="RBL301"):
        lowering.move(far, around)
    with pytest.raises(Fault, match="RBL305"):
        lowering.tool("NOTHING", around.cell)


def test_payloads():
    cell = builtin_cell()

    def payload(text):
        (effect,) = execute(parsed(text))
        assert isinstance(effect, SetPayload)
        return lowering.payload(effect, cell)

    assert payload("LOAD (0, 10, 60), 0.8").cog == pytest.approx((0, 0.01, 0.06))
    for text, code in (
        ("LOAD nothing", "RBL305"),
        ("LOAD (0, 0, 0), 9999", "RBL402"),
        ("LOAD (0, 0, 0), NAN", "RBL401"),
        ("LOAD (0, 0, 0), 1, (1, 1, 9, 0, 0, 0)", "RBL403"),
    ):
        with pytest.raises(Fault, match=code):
            payload(text)
