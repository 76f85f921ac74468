"""A point with an offset is where the same offset in a program brings the tool."""

import numpy as np
import pytest

from robolang.evaluation.evaluator import Nowhere
from robolang.execution import lowering
from robolang.interpreter.effects import MoveTo
from robolang.project.points import Point
from robolang.teaching.copied import copied
from robolang.teaching.postures import reached_point, taught_place
from robolang.teaching.taught import taught_point
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault
from runtime.core.units import DEG
from tests.robolang.helpers import parsed
from tests.robolang.running import execute
from tests.robolang.teaching.surroundings import surroundings

Q = np.array([20.0, 60.0, 10.0, 30.0, 40.0, 50.0]) * DEG
OFFSETS = ["+ (0, 0, 50)", "* (10, 0, -20, 0, 15, 30)", "+ (5, 0, 2 * 10) + (0, -SQR(4), 0)", "* (0, 0, -30)"]


def programmed(text, around):
    """Where a program goes, m: its last MOVE."""
    *_, effect = execute(parsed(text), Nowhere(), around.points.names)
    assert isinstance(effect, MoveTo)
    return lowering.move(effect, around).X_world_tool


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("kind", ["joints", "pose"])
@pytest.mark.parametrize("frame", ["WORLD", "PALLET"])
def test_an_offset_means_what_it_means_in_a_program(offset, kind, frame):
    around = surroundings()
    old = taught_point("P3", kind, Q, around, frame=frame).point
    around = surroundings(old)
    found = copied("P8", old, offset, around, frame="" if frame == "WORLD" else frame)
    assert found.notes == ()
    assert (found.point.name, found.point.frame, found.point.tool) == ("P8", old.frame, old.tool)
    assert (found.point.joints is None) == (kind == "pose")
    X = programmed(f"FRAME {frame}\nMOVE P3 {offset}\n", around)
    # three decimals of a joint are some 20 um at the tool
    assert taught_place(found.point, around) == pytest.approx(X, abs=4e-5)
    assert around.kinematics.changes(Q, reached_point(found.point, around, around.cell.home)) == ()


def test_a_copy_without_an_offset_is_the_point():
    old = Point(name="P3", pose=(1.0, 2.0, 3.0, 4.0, 5.0, 6.0), turns=(0, 1), configuration=("LEFTY",), comment="x")
    assert copied("P8", old, "", surroundings(old)).point == old.replaced(name="P8")


def test_a_shifted_pose_leaves_the_turns_open_as_a_program_does():
    old = taught_point("P3", "pose", Q - np.array([0, 0, 0, 0, 0, 250.0 * DEG]), surroundings()).point
    found = copied("P8", old, "+ (0, 0, 50)", surroundings(old)).point
    assert (old.turns, found.turns, found.configuration) == ((0, 0, 0, 0, 0, -1), (), old.configuration)


def test_a_pose_out_of_reach_is_noted_and_joints_are_refused():
    around = surroundings()
    old = taught_point("P3", "pose", Q, around).point
    assert len(copied("P8", old, "+ (9000, 0, 0)", around).notes) == 1
    with pytest.raises(Fault) as caught:
        copied("P8", taught_point("P3", "joints", Q, around).point, "+ (9000, 0, 0)", around)
    assert caught.value.code == "RBL410"


@pytest.mark.parametrize(
    ("offset", "code"),
    [
        ("+ (0, 0", "RBL111"),
        ("+ (0, 0, 50, 1)", "RBL531"),
        ("- (0, 0, 50)", "RBL531"),
        (".X", "RBL532"),
        ("+ (0, 0, 1/0)", "RBL501"),
        ("+ (0, 0, NAN)", "RBL502"),
        ("+ (0, 0, HERE.Z)", "RBL532"),
        ("+ (0, 0, unknown)", "RBL532"),
        ("\nMOVE P3", "RBL111"),
        ("= 5", "RBL531"),
    ],
)
def test_what_is_no_offset(offset, code):
    old = Point(name="P3", joints=tuple(Q / DEG))
    with pytest.raises((Fault, FileFault)) as caught:
        copied("P8", old, offset, surroundings(old))
    assert caught.value.code == code


def test_a_name_that_no_point_can_have():
    old = Point(name="P3", joints=tuple(Q / DEG))
    with pytest.raises(Fault) as caught:
        copied("GOTO", old, "", surroundings(old))
    assert caught.value.code == "RBL303"
