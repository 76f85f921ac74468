"""Axes that slide: the SCARA of the library against its closed form, written out by hand."""

import numpy as np
import pytest

from runtime.core.frames import pose, rotation_about
from runtime.core.units import DEG, MM
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics

SPEC = load_builtin("cobra600")
ARM = Kinematics(SPEC)
POSTURES = np.random.default_rng(4).uniform(SPEC.lower, SPEC.upper, (50, 4))
A1, A2, D1 = 0.325, 0.275, 0.387


def by_hand(q):
    """The published rows: two links in the plane, a quill that goes down, and a tool that points down."""
    q1, q2, q3, q4 = q
    x, y = A1 * np.cos(q1) + A2 * np.cos(q1 + q2), A1 * np.sin(q1) + A2 * np.sin(q1 + q2)
    turned = rotation_about(np.array([0.0, 0.0, 1.0]), q1 + q2 - q4)
    return pose([x, y, D1 - q3], turned @ np.diag([1.0, -1.0, -1.0]))


def elbows(X):
    """Both solutions of the plane: q1, q2, q3 and q4 up to whole turns."""
    x, y, z = X[:3, 3]
    cos2 = (x * x + y * y - A1 * A1 - A2 * A2) / (2.0 * A1 * A2)
    about = np.arctan2(X[1, 0], X[0, 0])
    for q2 in (np.arccos(cos2), -np.arccos(cos2)):
        q1 = np.arctan2(y, x) - np.arctan2(A2 * np.sin(q2), A1 + A2 * np.cos(q2))
        yield np.array([q1, q2, D1 - z, q1 + q2 - about])


def turns_apart(q, other):
    off = q - other
    off[[0, 1, 3]] = np.remainder(off[[0, 1, 3]] + np.pi, 2.0 * np.pi) - np.pi
    return np.abs(off).max()


def test_forward_is_that_by_hand():
    for q in POSTURES:
        np.testing.assert_allclose(ARM.forward(q), by_hand(q), rtol=0, atol=1e-15)


def test_points_are_carried_by_the_flange():
    p = np.array([0.1, -0.2, 0.3])
    expected = ARM.forward(POSTURES) @ np.append(p, 1.0)
    np.testing.assert_allclose(ARM.chain.points(POSTURES, p), expected[:, :3], rtol=0, atol=1e-15)


def test_the_jacobian_is_the_difference_quotient():
    step = 1e-6
    for q in POSTURES[:10]:
        J = ARM.jacobian(q)
        for axis in range(4):
            beyond, before = q + step * np.eye(4)[axis], q - step * np.eye(4)[axis]
            difference = (by_hand(beyond)[:3, 3] - by_hand(before)[:3, 3]) / (2.0 * step)
            np.testing.assert_allclose(J[:3, axis], difference, rtol=0, atol=1e-9)
        np.testing.assert_array_equal(J[:, 2], [0, 0, -1, 0, 0, 0])


def test_both_elbows_are_found_and_no_others():
    for q in POSTURES[:12]:
        X = by_hand(q)
        found, expected = [each.q for each in ARM.solutions(X)], list(elbows(X))
        assert len(found) == 2
        for each in found:
            assert min(turns_apart(each, other) for other in expected) < 1e-8
            np.testing.assert_allclose(by_hand(each), X, rtol=0, atol=1e-9)


def test_a_slide_has_no_whole_turns():
    q, near = np.array([0.1, 0.2, 7.0, 0.3]), np.array([6.3, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(ARM.nearest_turns(q, near), [0.1 + 2.0 * np.pi, 0.2, 7.0, 0.3])
    assert ARM.solutions(pose([0.4, 0.1, 2.0], np.diag([1.0, -1.0, -1.0])))[0].q[2] == pytest.approx(D1 - 2.0)


def test_a_mm_counts_as_a_degree_in_a_margin():
    q = np.array([0.0, 0.5, 3.0 * MM, 0.0])
    assert float(ARM.limit_margin(q)) == pytest.approx(3.0 * DEG)
    assert np.isnan(ARM.limit_margin(np.array([0.0, np.nan, 0.1, 0.0])))


def test_a_pose_that_four_axes_cannot_take_has_no_solution():
    assert ARM.solutions(pose([0.4, 0.1, 0.3], rotation_about(np.array([1.0, 0.0, 0.0]), 3.0))) == []
