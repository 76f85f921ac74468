"""What is shown before a point is replaced: by how much, which joints, and whether the arm stands otherwise."""

import numpy as np
import pytest

from robolang.execution import lowering
from robolang.project.points import Point
from robolang.teaching.postures import tool_place
from robolang.teaching.taught import taught_point
from robolang.teaching.touch_up import change
from runtime.core.faults import Fault
from runtime.core.frames import inverse
from runtime.core.units import DEG
from tests.robolang.teaching.surroundings import surroundings

Q = np.array([20.0, 60.0, 10.0, 30.0, 40.0, 50.0]) * DEG


def moved(around, by, frame):
    """The joints at which the tool stands at Q, shifted and turned by six values along and about a frame's axes."""
    F = around.cell.frames[frame]
    X = inverse(F) @ tool_place(Q, around)
    D = lowering.pose_si(by)
    X[:3, :3], X[:3, 3] = D[:3, :3] @ X[:3, :3], X[:3, 3] + D[:3, 3]
    branch = around.kinematics.branch_of(Q)
    return around.kinematics.inverse_branch(F @ X @ inverse(around.X_flange_tool), branch, Q)


def test_the_change_is_that_in_the_frame_of_the_point():
    around = surroundings()
    old = taught_point("P3", "pose", Q, around, frame="PALLET").point
    by = (3.0, -4.0, 12.0, 1.0, -2.0, 3.0)
    q = moved(around, by, "pallet")
    new = taught_point("P3", None, q, around, old=old).point
    found = change(old, new, q, around)
    assert found.frame == "pallet"
    assert found.by == pytest.approx(by, abs=2e-3)
    assert found.distance == pytest.approx(13.0, abs=2e-3)
    # of three turns about axes at right angles, nearly the root of the sum of squares
    assert found.angle == pytest.approx(np.sqrt(14.0), rel=0.02)
    assert found.joints == pytest.approx((q - Q) / DEG, abs=0.01)
    assert (found.configuration, found.unreached) == ((), None)


def test_nothing_changes_where_the_arm_has_not_moved():
    around = surroundings()
    old = taught_point("P3", "joints", Q, around).point
    found = change(old, old, Q, around)
    assert found.by == pytest.approx((0.0,) * 6, abs=1e-9)
    assert (found.distance, found.angle) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert found.joints == pytest.approx((0.0,) * 6, abs=1e-9)


def test_another_configuration_is_named():
    around = surroundings()
    old = taught_point("P3", "joints", Q, around).point
    q = np.array([20.0, 60.0, 10.0, 30.0 - 90.0, -40.0, 50.0]) * DEG
    found = change(old, taught_point("P3", None, q, around, old=old).point, q, around)
    assert found.configuration == (("NOFLIP", "FLIP"),)
    assert found.joints == pytest.approx((0.0, 0.0, 0.0, -90.0, -80.0, 0.0), abs=1e-6)


def test_of_several_postures_the_nearest_was_meant():
    around = surroundings()
    # written by hand, without a configuration
    old = Point(name="P3", pose=lowering.six_of(tool_place(Q, around)))
    others = around.kinematics.solutions(around.kinematics.forward(Q))
    q = next(each.q for each in others if each.limit_margin > 0.0 and around.kinematics.changes(Q, each.q))
    found = change(old, taught_point("P3", None, q, around, old=old).point, q, around)
    assert found.joints == pytest.approx((0.0,) * 6, abs=0.01)
    assert found.configuration == ()


def test_an_old_point_that_is_not_reached_has_a_reason():
    around = surroundings()
    old = Point(name="P3", pose=(9000.0, 0.0, 500.0, 0.0, 0.0, 0.0))
    found = change(old, taught_point("P3", None, Q, around, old=old).point, Q, around)
    assert (found.joints, found.configuration, found.unreached.code) == (None, (), "RBL410")
    assert found.distance > 8000.0


def test_an_old_point_of_a_frame_that_is_gone():
    around = surroundings()
    old = Point(name="P3", pose=(0.0,) * 6, frame="shelf")
    with pytest.raises(Fault) as caught:
        change(old, taught_point("P3", "pose", Q, around).point, Q, around)
    assert caught.value.code == "RBL305"
