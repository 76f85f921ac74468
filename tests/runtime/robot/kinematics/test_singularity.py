"""Distances from the singular postures, against the determinant of the Jacobian.

For a spherical wrist the determinant is that of the arm times that of the wrist:
|det J| = c2 k |sin g| |r| |sin t5|, with the names of ``runtime.robot.kinematics.singularity``.
"""

import math

import numpy as np
import pytest

from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.singularity import singularities

ROBOTS = ["puma560", "irb2400", "manutec_r3"]


@pytest.mark.parametrize("name", ROBOTS)
def test_the_determinant_is_their_product(name):
    spec = load_builtin(name)
    kinematics = Kinematics(spec)
    params = kinematics.opw
    q = np.random.default_rng(7).uniform(spec.lower, spec.upper, (200, 6))
    near = singularities(params, q)
    k = math.hypot(params.a2, params.c3)
    expected = params.c2 * k * np.sin(near.elbow) * near.shoulder * np.sin(near.wrist)
    J = kinematics.jacobian(q)
    # the flange does not stand in the wrist centre: that changes rows, not the determinant
    np.testing.assert_allclose(np.abs(np.linalg.det(J)), expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_straight_wrist_is_none_away(name):
    params = Kinematics(load_builtin(name)).opw
    q = np.zeros(6)
    q[4] = -params.offsets[4] * params.signs[4]
    near = singularities(params, q)
    assert float(near.wrist) == pytest.approx(0.0, abs=1e-12)
    assert 0.0 <= float(near.elbow) <= math.pi / 2
