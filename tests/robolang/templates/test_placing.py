"""Where a table can stand before an arm: reached by one configuration, away from singular postures."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from robolang.templates import placing
from robolang.templates.placing import Job, placements
from runtime.core.frames import inverse, pose, pose_from_xyzrpy
from runtime.core.units import DEG, MM
from runtime.robot.files import robot_file
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics

DOWN = [np.pi, 0.0, np.pi]
JOB = Job(
    X_table_tool=np.stack([pose_from_xyzrpy([x, y, 0.1, *DOWN]) for x, y in ((0, 0), (0.1, 0.2), (-0.1, -0.2))]),
    from_mm=(0.0, 0.0, 0.0),
    depth_mm=400.0,
    X_flange_tool=pose((0.0, 0.0, 0.1)),
)


def kinematics(name="irb2400", **changed):
    return Kinematics(replace(load_builtin(name), **changed))


def first(arm, job=JOB, count=5):
    return list(islice(placements(arm, job), count))


@pytest.mark.parametrize("name", robot_file.library())
def test_home_is_the_first_pose_over_the_table(name):
    arm = kinematics(name)
    for place in first(arm):
        tool = arm.forward(np.array(place.home) * arm.units) @ JOB.X_flange_tool
        where = np.array(place.position([0.0, 0.0, 100.0])) * MM
        assert np.allclose(tool[:3, 3], where, atol=1e-6)
        assert np.allclose(tool[:3, 2], [0, 0, -1], atol=1e-6)
        assert place.to_mm[0] >= 300.0
        assert place.to_mm[2] >= 50.0
        assert all(value % 10 == 0 for value in place.to_mm)


def test_a_place_without_room_to_the_ends_of_the_ranges_is_none():
    arm = kinematics()
    (best,) = first(arm, count=1)
    q = np.array(best.home) * arm.units
    # all ranges so narrow that only the postures over the table are left, without room
    rows = placing._rating(arm, q[None], 1.5, best.to_mm[2], JOB)
    assert rows > 0.9
    for bad in (q + 10.0, q * np.nan):
        assert placing._rating(arm, bad[None], 1.5, best.to_mm[2], JOB) == 0.0


def test_a_singular_posture_is_rated_by_how_near_it_is():
    arm = kinematics()
    (best,) = first(arm, count=1)
    q = np.array(best.home) * arm.units
    ratings = []
    for bend in (0.3, 0.03, 0.0):
        q[4] = bend
        ratings.append(placing._rating(arm, q[None], 1.5, 0.0, JOB))
    assert ratings[0] > ratings[1] > ratings[2]
    assert ratings[2] < 1e-6


def test_an_arm_that_would_lie_on_the_table_is_not_placed_there():
    arm = kinematics()
    (best,) = first(arm, count=1)
    q = np.array(best.home)[None] * arm.units
    assert placing._rating(arm, q, 1.5, best.to_mm[2], JOB) > 0.0
    assert placing._rating(arm, q, 1.5, best.to_mm[2] + 400.0, JOB) == 0.0


def test_a_job_that_is_wider_than_the_arm_reaches_has_no_place():
    wide = replace(JOB, X_table_tool=np.stack([pose_from_xyzrpy([0, y, 0.1, *DOWN]) for y in (-3.0, 3.0)]))
    assert first(kinematics(), wide) == []


def test_an_arm_without_a_closed_form_gets_the_same_kind_of_place():
    spec = load_builtin("puma560")
    # a flange that is tilted by a degree about the last joint but one: no spherical wrist is left
    axes = list(spec.axes)
    shifted = axes[4].placement @ pose((0.02, 0.0, 0.03))
    axes[4] = replace(axes[4], placement=shifted)
    arm = Kinematics(replace(spec, axes=tuple(axes), opw=None))
    assert not arm.closed_form
    (place,) = first(arm, count=1)
    tool = arm.forward(np.array(place.home) * arm.units) @ JOB.X_flange_tool
    assert np.allclose(inverse(tool)[:3, :3] @ np.array([0, 0, -1.0]), [0, 0, 1], atol=1e-6)


class Pointing:
    """An arm whose flange is 400 mm up in the middle of its ranges, the tool tilted there."""

    def __init__(self, tilt_deg):
        self.spec, self.tilt = load_builtin("puma560"), tilt_deg * DEG

    def forward(self, q):
        assert np.allclose(q, 0.5 * (self.spec.lower + self.spec.upper))
        return pose_from_xyzrpy([0.3, 0.0, 0.4, np.pi - self.tilt, 0.0, 0.0])


def test_the_table_of_an_arm_that_always_points_down_is_below_the_middle_of_its_stroke():
    assert placing._best_height(Pointing(0.0), JOB, 1.0) == pytest.approx(0.4 - 0.1 - 0.1)
    # any other arm: below its second axis
    assert placing._best_height(Pointing(10.0), JOB, 1.0) == pytest.approx(0.672 - 0.1)


def test_the_reach_counts_from_the_first_axis():
    spec = load_builtin("irb2400")
    # 100 mm to the second axis, 705 mm, 135 and 755 mm across one another, 85 mm
    assert placing._reach(Kinematics(spec)) == pytest.approx(0.1 + 0.705 + np.hypot(0.135, 0.755) + 0.085, abs=0.03)
    axes = list(spec.axes)
    axes[1] = replace(axes[1], placement=pose((0.3, 0.4, 0.615), axes[1].placement[:3, :3]))
    assert placing._reach(Kinematics(replace(spec, axes=tuple(axes), opw=None))) == pytest.approx(
        placing._reach(Kinematics(spec)) + 0.4
    )
