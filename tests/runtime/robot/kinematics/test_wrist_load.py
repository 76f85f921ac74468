"""Moment and inertia of a payload about the wrist axes, against the mass matrix and the gravity of Pinocchio."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.core.frames import frozen
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.wrist_load import rated_inertia, rated_moment, ratings, wrist_load
from runtime.robot.model.arm_model import ArmModel
from runtime.robot.model.payload import NO_PAYLOAD, Payload

PAYLOAD = Payload(
    mass=1.7,
    cog=frozen(np.array([0.05, -0.08, 0.12])),
    inertia=frozen(np.array([[0.02, 0.001, -0.002], [0.001, 0.03, 0.003], [-0.002, 0.003, 0.025]])),
)


@pytest.mark.parametrize("name", ["puma560", "irb2400", "manutec_r3"])
def test_a_payload_adds_its_moment_and_its_inertia_to_the_arm(name):
    spec = load_builtin(name)
    rows = np.random.default_rng(4).uniform(spec.lower, spec.upper, (20, spec.n))
    load = wrist_load(Kinematics(spec), rows, PAYLOAD)
    bare, carrying = ArmModel(spec), ArmModel(spec)
    bare.set_payload(NO_PAYLOAD)
    carrying.set_payload(PAYLOAD)
    assert load.first == 3
    for row, q in enumerate(rows):
        gravity = np.abs(carrying.gravity(q) - bare.gravity(q))[3:]
        inertia = np.diag(carrying.mass_matrix(q) - bare.mass_matrix(q))[3:]
        np.testing.assert_allclose(load.moment[row], gravity, atol=1e-9)
        np.testing.assert_allclose(load.inertia[row], inertia, atol=1e-9)


def test_an_arm_of_three_axes_is_loaded_on_all_of_them():
    spec = load_builtin("manutec_r3")
    short = replace(spec, axes=spec.axes[3:])
    load = wrist_load(Kinematics(short), np.zeros(3), PAYLOAD)
    assert (load.first, load.moment.shape, load.inertia.shape) == (0, (3,), (3,))
    np.testing.assert_array_equal(ratings(short), ratings(spec))


def test_published_ratings_are_used_and_others_estimated():
    spec = load_builtin("manutec_r3")
    moments, inertias = ratings(spec)
    np.testing.assert_array_equal(moments, [59, 59, 20.8])
    np.testing.assert_array_equal(inertias, [2.4, 2.4, 0.3])
    axis = load_builtin("puma560").axes[4]
    assert rated_moment(axis) == axis.limits.torque / 2
    free = axis.limits.torque / 2 - rated_inertia(axis) * axis.limits.acceleration
    assert free == pytest.approx(axis.motor.reflected_inertia * axis.limits.acceleration)


def test_the_published_load_of_the_manutec_is_what_its_wrist_is_rated_for():
    """15 kg at (0.1, 0.25, 0.1) m, y along the last axis: the load of the library's model."""
    spec = load_builtin("manutec_r3")
    load = Payload(mass=15.0, cog=frozen(np.array([0.1, 0.1, 0.25])))
    rows = np.random.default_rng(1).uniform(spec.lower, spec.upper, (20_000, spec.n))
    found = wrist_load(Kinematics(spec), rows, load)
    moments, inertias = ratings(spec)
    np.testing.assert_allclose(found.moment.max(axis=0), moments, rtol=0.01)
    np.testing.assert_allclose(found.inertia.max(axis=0), inertias, rtol=0.01)
