"""First moments beyond the model: what they weigh, and that torques give them back."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.dynamics.first_moments import gravity_columns, scale, weigh_links
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from runtime.servo.motor import torque_limit
from runtime.supervision.torque_observer import LoadModel

ROBOTS = ("puma560", "manutec_r3", "irb2400")


def shifted(spec, by):
    """Return the robot with centres of gravity moved by ``by`` (n, 3) m."""
    bodies = [replace(axis.body, cog=axis.body.cog + d) for axis, d in zip(spec.axes, by, strict=True)]
    return replace(spec, axes=tuple(replace(a, body=body) for a, body in zip(spec.axes, bodies, strict=True)))


def heavier(spec, share):
    """Return the robot with bodies heavier by ``share`` (n,), and the moments of it about the joints of the links."""
    bodies = [replace(axis.body, mass=axis.body.mass * (1.0 + s)) for axis, s in zip(spec.axes, share, strict=True)]
    return replace(spec, axes=tuple(replace(a, body=body) for a, body in zip(spec.axes, bodies, strict=True)))


def postures(spec, count=20):
    return np.random.default_rng(5).uniform(spec.lower, spec.upper, (count, spec.n))


@pytest.mark.parametrize("robot", ROBOTS)
def test_first_moments_weigh_what_moved_centres_of_gravity_weigh(robot):
    spec = load_builtin(robot)
    by = np.random.default_rng(6).normal(0.0, 0.02, (spec.n, 3))
    moments = spec.per_axis("body", "mass")[:, None] * by
    payload = Payload(mass=1.0, cog=np.array([0.0, 0.01, 0.05]))
    bare, real, model = ArmModel(spec), ArmModel(shifted(spec, by)), ArmModel(spec, first_moments=moments)
    for arm in (bare, real, model):
        arm.set_payload(payload)
    for q in postures(spec):
        T = real.gravity(q)
        np.testing.assert_allclose(model.gravity(q), T, atol=1e-6)
        np.testing.assert_allclose(
            bare.gravity(q) + np.einsum("ijx,jx->i", gravity_columns(spec, q), moments), T, atol=1e-9
        )
        np.testing.assert_array_equal(model.mass_matrix(q), bare.mass_matrix(q))
        np.testing.assert_array_equal(model.inertia_column(q, 1), bare.inertia_column(q, 1))
        dq = np.ones(spec.n)
        np.testing.assert_allclose(model.torque(q, dq, dq) - bare.torque(q, dq, dq), T - bare.gravity(q), atol=1e-6)


def test_supervision_weighs_them_too():
    spec = load_builtin("puma560")
    moments = np.zeros((6, 3))
    moments[1, 0] = 0.5
    rotors = 1.5 * spec_rotors(spec)
    model, expected = LoadModel(spec, rotors, moments), ArmModel(spec, rotors=rotors, first_moments=moments)
    for q in postures(spec, 3):
        np.testing.assert_array_equal(model.torque(q, q, q), expected.torque(q, q, q))


@pytest.mark.parametrize("robot", ROBOTS)
def test_heavier_bodies_are_seen_by_their_first_moments_alone(robot):
    """Exact torques of every axis in 200 postures, with a friction of its own each: the weight comes back everywhere.

    A mass that a link has more is seen as a moment of the link before, so masses are not among the unknowns.
    """
    spec = load_builtin(robot)
    real = ArmModel(heavier(spec, np.random.default_rng(7).uniform(0.05, 0.2, spec.n)))
    rows, friction = postures(spec, 200), np.arange(1.0, spec.n + 1)
    torques = np.array([real.gravity(q) + friction for q in rows])
    axes = np.tile(np.arange(spec.n), len(rows))
    found = weigh_links(spec, NO_PAYLOAD, axes, np.repeat(rows, spec.n, axis=0), torques.ravel(), torque_limit(spec))
    np.testing.assert_allclose(found.friction, friction, rtol=1e-3)
    assert found.left < 1e-3 * torque_limit(spec).max()
    model = ArmModel(spec, first_moments=found.first_moments)
    others = postures(spec, 300)[200:]
    off = np.array([model.gravity(q) - real.gravity(q) for q in others])
    assert (np.abs(off) < 1e-3 * torque_limit(spec)).all()


def test_without_readings_there_is_nothing():
    spec = load_builtin("puma560")
    none = np.zeros((0,), dtype=int)
    found = weigh_links(spec, NO_PAYLOAD, none, np.zeros((0, 6)), np.zeros(0), torque_limit(spec))
    assert (found.first_moments == 0.0).all()
    assert (found.friction == 0.0).all()
    assert found.left == 0.0


def test_the_size_of_a_moment_is_of_the_link_and_what_hangs_on_it():
    spec = load_builtin("puma560")
    found = scale(spec)
    own = 17.4 * np.linalg.norm([0.068, 0.006, 0.2275])
    assert found[1] == pytest.approx(own + 0.4318 * (4.8 + 0.82 + 0.34 + 0.09))
    assert found[5] == pytest.approx(np.linalg.norm(spec.axes[5].body.cog) * spec.axes[5].body.mass)
