"""Experiment A6 of docs/measured.md: the rotation-principal-axis method."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.core.frames import (
    pose,
    principal_axis,
    rotation_about,
    rotation_angle,
    rotation_from_rpy,
    rpy_from_rotation,
)
from runtime.motion.path import LinePath
from tests.campaign import examples

S = np.linspace(0.0, 1.0, 101)
angles = st.floats(-math.pi, math.pi)
rotations = st.tuples(angles, angles, angles).map(rotation_from_rpy)


def chord(angle: float) -> float:
    """Frobenius distance of two orientations that differ by an angle: independent of how the angle was found."""
    return math.sqrt(8.0) * math.sin(0.5 * angle)


@given(rotations, rotations)
@examples(200)
def test_end_pose_is_exact_and_the_angle_grows_linearly(R_start, R_end):
    path = LinePath.between(pose((0.1, 0.2, 0.3), R_start), pose((0.5, -0.2, 0.4), R_end))
    X = path.poses(S)
    np.testing.assert_allclose(X[-1], path.X_end, atol=1e-12)
    np.testing.assert_allclose(X[0], path.X_start, atol=1e-15)
    grown = [np.linalg.norm(R - R_start) for R in X[:, :3, :3]]
    np.testing.assert_allclose(grown, [chord(s * path.angle) for s in S], atol=1e-14)
    assert path.deviation(X[:, :3, 3]).max() < 1e-15


@pytest.mark.parametrize("away_from_pi", [0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3])
@pytest.mark.parametrize("k", [(1, 0, 0), (0, 1, 0), (0, 0, -1), (0.6, -0.8, 0), (-1, 1, 1), (1e-7, 1, -1e-5)])
def test_half_turns(k, away_from_pi):
    k = np.array(k) / np.linalg.norm(k)
    R_start = rotation_from_rpy([0.3, -0.4, 2.0])
    R_end = rotation_about(k, math.pi - away_from_pi) @ R_start
    axis, theta = principal_axis(R_start, R_end)
    np.testing.assert_allclose(rotation_about(axis, theta) @ R_start, R_end, atol=1e-12)
    assert theta == pytest.approx(math.pi - away_from_pi, abs=1e-12)


@pytest.mark.parametrize("angle", [0.0, 1e-15, 1e-12, 1e-9, 1e-6])
def test_small_and_no_turns(angle):
    R_start = rotation_from_rpy([0.3, -0.4, 2.0])
    R_end = rotation_about([0.0, 0.6, 0.8], angle) @ R_start
    path = LinePath.between(pose((0, 0, 0), R_start), pose((1, 0, 0), R_end))
    np.testing.assert_allclose(path.poses(S)[-1], path.X_end, atol=1e-12)
    assert path.angle == pytest.approx(angle, abs=1e-15)


@given(rotations)
@examples(200)
def test_surface_angles_come_back_as_the_same_rotation(R):
    np.testing.assert_allclose(rotation_from_rpy(rpy_from_rotation(R)), R, atol=2e-9)


def test_order_of_the_surface_angles_is_about_fixed_x_then_y_then_z():
    """Turning a vector by hand: RX 90 takes y to z, RY 90 then z to x, RZ 90 then x to y."""
    R = rotation_from_rpy(np.radians([90.0, 90.0, 90.0]))
    np.testing.assert_allclose(R @ [0, 1, 0], [0, 1, 0], atol=1e-15)


def test_deviation_is_measured_from_the_segment_not_from_the_endless_line():
    path = LinePath.between(pose((0, 0, 0)), pose((1, 0, 0)))
    points = np.array([[0.5, 0.003, 0.004], [1.02, 0.0, 0.0], [-0.01, 0.0, 0.0]])
    np.testing.assert_allclose(path.deviation(points), [0.005, 0.02, 0.01])


def test_angle_between_orientations():
    R = rotation_from_rpy([0.1, 0.2, 0.3])
    assert rotation_angle(R, rotation_about([0, 0, 1], 0.25) @ R) == pytest.approx(0.25, abs=1e-14)
