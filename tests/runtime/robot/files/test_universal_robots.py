"""UR5e and UR10e: the published rows multiplied out by hand, poses solved back, bodies as they were published."""

import numpy as np
import pytest

from runtime.core.units import MM
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.arm_model import ArmModel
from tests.campaign import size

ROWS = {
    "ur5e": ([0.1625, 0, 0, 0.1333, 0.0997, 0.0996], [0, -0.425, -0.3922, 0, 0, 0]),
    "ur10e": ([0.1807, 0, 0, 0.17415, 0.11985, 0.11655], [0, -0.6127, -0.57155, 0, 0, 0]),
}
ALPHA = [90, 0, 0, 90, -90, 0]
MASS = {"ur5e": 17.7, "ur10e": 29.104}
POSTURES = np.random.default_rng(5).uniform(-np.pi, np.pi, (200, 6))


def by_hand(name, q):
    X = np.eye(4)
    for theta, d, a, alpha in zip(q, *ROWS[name], np.radians(ALPHA), strict=True):
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
        X = X @ np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]])
    return X


@pytest.mark.parametrize("name", ROWS)
def test_the_flange_is_that_of_the_published_rows(name):
    arm = Kinematics(load_builtin(name))
    for q in POSTURES[:50]:
        np.testing.assert_allclose(arm.forward(q), by_hand(name, q), rtol=0, atol=1e-15)


def test_the_zero_pose_of_the_ur5e_is_the_known_one():
    X = Kinematics(load_builtin("ur5e")).forward(np.zeros(6))
    assert X[:3, 3] / MM == pytest.approx([-817.2, -232.9, 62.8], abs=1e-9)


@pytest.mark.parametrize("name", ROWS)
def test_poses_are_solved_back(name):
    arm, rng = Kinematics(load_builtin(name)), np.random.default_rng(6)
    for q in POSTURES[: size(200, 60)]:
        X = arm.forward(q)
        found = arm.newton.solve(X, q + rng.uniform(-0.05, 0.05, 6))
        np.testing.assert_allclose(arm.forward(found), X, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", ROWS)
def test_bodies_are_used_as_published(name):
    spec = load_builtin(name)
    assert spec.corrections == ()
    assert spec.warnings == ()
    assert sum(axis.body.mass for axis in spec.axes) == pytest.approx(MASS[name])
    # stretched forward, the shoulder holds what the published masses weigh at their centres
    q = np.zeros(6)
    lever = sum(
        axis.body.mass * (X @ np.append(axis.body.cog, 1.0))[0]
        for axis, X in list(zip(spec.axes, Kinematics(spec).chain.axis_frames(q), strict=True))[1:]
    )
    assert abs(ArmModel(spec).gravity(q)[1]) == pytest.approx(9.81 * abs(lever), rel=1e-12)


@pytest.mark.parametrize("name", ROWS)
def test_the_arm_can_carry_its_rated_payload(name):
    spec = load_builtin(name)
    _, upper, fore, *_ = np.abs(ROWS[name][1])
    held = np.abs(ArmModel(spec).gravity(np.zeros(6)))[1:3] + 9.81 * spec.rated_payload * np.array([upper + fore, fore])
    assert (held < spec.per_axis("limits", "torque")[1:3]).all()
