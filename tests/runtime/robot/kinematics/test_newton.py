"""Arms without a closed form: poses are met to 1e-10 or not at all."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.core.frames import rotation_about, rotation_angle
from runtime.core.tomlfile import Source
from runtime.robot.files.importer import parse_model, read_arm
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.newton import TOLERANCE
from runtime.robot.kinematics.opw import BRANCHES, NUMERIC
from tests.campaign import examples
from tests.runtime.robot.models import ANGLES, SEVEN, chain

SEVEN_AXES = Kinematics(read_arm(SEVEN))
FIVE_AXES = Kinematics(parse_model(Source("angles.xml", ANGLES.read_text())))


def met(kinematics, q, X):
    here = kinematics.forward(q)
    return np.linalg.norm(here[:3, 3] - X[:3, 3]) < 2 * TOLERANCE and rotation_angle(here[:3, :3], X[:3, :3]) < 1e-9


def arm_of(n, seed):
    generator = np.random.default_rng(seed)
    draw = generator.uniform
    frames = [(draw(-0.4, 0.4, 3), draw(-3, 3, 3), generator.normal(size=3)) for _ in range(n)]
    return Kinematics(parse_model(Source("made.urdf", chain(frames, ((0.1, 0.2, 0.1), (0.3, 0.2, 0.1))))))


@examples(60)
@given(st.integers(2, 7), st.integers(0, 10**6))
def test_a_pose_near_by_is_met(n, seed):
    kinematics = arm_of(n, seed)
    assert not kinematics.closed_form
    q = np.random.default_rng(seed + 1).uniform(-2, 2, n)
    J = kinematics.jacobian(q)
    if np.linalg.svd(J, compute_uv=False)[-1] < 0.02:  # beside a singularity it may be given up
        return
    X = kinematics.forward(q)
    found = kinematics.inverse_branch(X, NUMERIC, q + 0.02)
    assert met(kinematics, found, X)
    if n <= 6:
        np.testing.assert_allclose(found, q, atol=1e-6)


def test_the_jacobian_is_that_of_the_chain():
    for kinematics in (SEVEN_AXES, FIVE_AXES):
        q = np.linspace(-1, 1, kinematics.n)
        kinematics.newton._error(np.eye(4), q)
        np.testing.assert_allclose(kinematics.newton._jacobian(q), kinematics.jacobian(q), atol=1e-13)


def test_a_path_is_followed_without_jumps():
    q = np.array([0.1, 0.6, 0.2, -1.2, 0.1, 0.8, 0.0])
    start = SEVEN_AXES.forward(q)
    X = np.tile(start, (500, 1, 1))
    X[:, 1, 3] += np.linspace(0.0, 0.3, 500)
    rows = SEVEN_AXES.inverse_branch(X, SEVEN_AXES.branch_of(q), q)
    np.testing.assert_allclose(rows[0], q, atol=1e-12)
    assert np.abs(np.diff(rows, axis=0)).max() < 3 * 0.3 / 500 / 0.3
    assert np.abs(np.diff(rows, n=2, axis=0)).max() < 1e-4
    np.testing.assert_allclose(SEVEN_AXES.forward(rows), X, atol=1e-9)
    apart = SEVEN_AXES.inverse_branch(X[::100], NUMERIC, rows[::100] + 0.01)  # each from its own start
    np.testing.assert_allclose(SEVEN_AXES.forward(apart), X[::100], atol=1e-9)


def test_out_of_reach_is_nan_and_the_rest_of_the_path_is_not():
    q = np.array([0.1, 0.6, 0.2, -1.2, 0.1, 0.8, 0.0])
    X = np.tile(SEVEN_AXES.forward(q), (3, 1, 1))
    X[1, :3, 3] = 3.0, 0.0, 0.0
    rows = SEVEN_AXES.inverse_branch(X, NUMERIC, q)
    assert np.isfinite(rows).all(axis=1).tolist() == [True, False, True]
    assert SEVEN_AXES.solutions(X[1]) == []


def test_five_axes_meet_what_they_can_and_refuse_the_rest():
    q = np.array([0.4, -0.3, -0.8, 0.5, 0.2])
    X = FIVE_AXES.forward(q)
    np.testing.assert_allclose(FIVE_AXES.inverse_branch(X, NUMERIC, q + 0.1), q, atol=1e-8)
    moved = X.copy()
    moved[:3, :3] = rotation_about([1.0, 0.0, 0.0], 0.3) @ X[:3, :3]
    assert np.isnan(FIVE_AXES.inverse_branch(moved, NUMERIC, q)).all()
    assert FIVE_AXES.solutions(moved) == []


def test_every_branch_of_an_arm_with_a_closed_form_is_found(puma):
    kinematics = Kinematics(puma)
    X = kinematics.forward([0.2, 1.0, -2.7, 0.3, 0.9, 0.2])
    closed = np.array([s.q for s in kinematics.solutions(X)])
    numeric = kinematics._numeric_solutions(kinematics._middle, X)
    assert len(numeric) == len(closed) == 8
    for solution in numeric:
        assert np.abs(closed - solution.q).max(axis=1).min() < 1e-8


def test_solutions_say_that_they_have_no_branch():
    X = SEVEN_AXES.forward([0.1, 0.6, 0.2, -1.2, 0.1, 0.8, 0.0])
    found = SEVEN_AXES.solutions(X)
    assert 1 < len(found) <= 8
    assert [s.limit_margin >= 0 for s in found] == sorted((s.limit_margin >= 0 for s in found), reverse=True)
    assert {str(s.branch) for s in found} == {"NUMERIC"}
    assert all(met(SEVEN_AXES, s.q, X) for s in found)
    assert NUMERIC not in BRANCHES
    again = SEVEN_AXES.solutions(X)
    np.testing.assert_array_equal([s.q for s in found], [s.q for s in again])


@pytest.mark.parametrize("scale", [1e-3, 1e-6, 1e-9])
def test_beside_a_singularity_the_pose_is_met_or_refused(scale):
    q = np.array([0.1, 0.6, 0.0, -scale, 0.0, 0.8, 0.0])
    X = SEVEN_AXES.forward(q)
    found = SEVEN_AXES.inverse_branch(X, NUMERIC, q + 0.05)
    assert np.isnan(found).all() or met(SEVEN_AXES, found, X)
