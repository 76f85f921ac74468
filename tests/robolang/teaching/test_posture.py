"""What is near a posture: the end of a range, and a singular posture, each by a measure of its own."""

import numpy as np
import pytest

from robolang.teaching.posture import posture, postures
from runtime.core.units import DEG
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from tests.robolang.teaching.surroundings import surroundings, without_closed_form

KINEMATICS = Kinematics(load_builtin("puma560"))
Q = np.array([20.0, 60.0, 10.0, 30.0, 40.0, 50.0]) * DEG


def at(**joints):
    q = np.array(Q)
    for name, angle in joints.items():
        q[int(name[1]) - 1] = angle * DEG
    return posture(q, KINEMATICS)


@pytest.mark.parametrize(
    ("joint", "angle", "side", "margin"), [("J1", 159.5, "upper", 0.5), ("J5", -99.0, "lower", 1.0)]
)
def test_the_nearest_end_of_a_range(joint, angle, side, margin):
    limit = at(**{joint: angle}).limit
    assert (limit.joint, limit.side) == (int(joint[1]) - 1, side)
    assert limit.margin == pytest.approx(margin, abs=1e-9)


def test_beyond_the_end_the_margin_is_negative():
    assert at(J1=161.0).limit.margin == pytest.approx(-1.0, abs=1e-9)


def test_a_joint_that_is_not_known_is_the_nearest():
    q = np.array(Q)
    q[3] = np.nan
    found = posture(q, KINEMATICS)
    assert found.limit.joint == 3
    assert np.isnan(found.limit.margin)


def test_a_straight_wrist():
    found = at(J5=-1.5).singular
    assert (found.name, found.unit) == ("wrist", "deg")
    assert (found.distance, found.closeness) == pytest.approx((1.5, 0.75), abs=1e-9)


def test_a_stretched_elbow():
    # stretched: the forearm points to the wrist centre, atan2(a2, c3) off the joint angle
    opw = KINEMATICS.opw
    straight = -opw.signs[2] * (np.arctan2(opw.a2, opw.c3) + opw.offsets[2]) / DEG
    found = at(J3=straight + 1.0).singular
    assert (found.name, found.unit) == ("elbow", "deg")
    assert found.distance == pytest.approx(1.0, abs=1e-9)
    # the Jacobian says the same without any formula of the singular postures
    values = [
        np.linalg.svd(KINEMATICS.jacobian(replaced(Q, 2, (straight + by) * DEG)))[1][-1] for by in (0.0, 1.0, 5.0)
    ]
    assert values[0] == pytest.approx(0.0, abs=1e-9)
    assert values[0] < values[1] < values[2]


def replaced(q, axis, angle):
    q = np.array(q)
    q[axis] = angle
    return q


def test_the_wrist_centre_over_axis_1():
    # of all J2 the one that brings the wrist centre nearest to axis 1
    rows = np.tile(Q, (36001, 1))
    rows[:, 1] = np.linspace(KINEMATICS.spec.lower[1], KINEMATICS.spec.upper[1], len(rows))
    found = postures(rows, KINEMATICS)
    overhead = [each.singular for each in found if each.singular.name == "overhead"]
    assert min(each.distance for each in overhead) < 0.1
    # a length and an angle are compared by their bounds, not by their numbers
    assert max(each.distance for each in overhead) > 100.0
    assert {each.unit for each in overhead} == {"mm"}
    nearest = min(overhead, key=lambda each: each.distance)
    assert nearest.closeness == pytest.approx(nearest.distance / 20.0)


def test_an_arm_without_a_closed_form_has_no_singular_postures():
    kinematics = without_closed_form(surroundings()).kinematics
    assert kinematics.opw is None
    found = posture(Q, kinematics)
    assert found.singular is None
    assert found.limit == posture(Q, KINEMATICS).limit
