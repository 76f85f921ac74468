"""Experiment A2 of docs/measured.md: inertia and gravity of the Puma 560 against published and derived numbers."""

import numpy as np
import pytest

from runtime.dynamics.equations import axis_gravity, axis_inertia
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from tests.runtime.dynamics import lagrangian

SPEC = load_builtin("puma560")
ROWS = lagrangian.published()
Q_PUBLISHED = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
POSTURES = np.random.default_rng(1992).uniform(SPEC.lower, SPEC.upper, (200, 6))


def model_with(payload=None, mode="add") -> ArmModel:
    model = ArmModel(SPEC)
    if payload is not None:
        model.set_payload(Payload(mass=payload[0], cog=np.array(payload[1])), mode)
    return model


def test_published_mass_matrix_and_gravity_to_every_printed_digit():
    M = model_with().mass_matrix(Q_PUBLISHED)
    diagonal = np.diag(M) + spec_rotors(SPEC)
    assert np.round(diagonal, 4).tolist() == [2.6152, 4.3038, 0.9366, 0.1926, 0.1713, 0.1941]
    assert round(float(M[0, 1]), 4) == -0.6550
    assert np.round(model_with().gravity(Q_PUBLISHED), 4).tolist() == [0, -7.9683, 8.4581, -0.0197, 0.0027, 0]


@pytest.mark.parametrize("payload", [None, (2.3, (0.0, 0.0, 0.095)), (2.5, (0.05, -0.03, 0.1))])
@pytest.mark.parametrize("mode", ["add", "replace"])
def test_unit_acceleration_equals_the_lagrangian_and_the_geometric_form(payload, mode):
    model = model_with(payload, mode)
    for q in POSTURES[:50]:
        D = [axis_inertia(model, q, axis) for axis in range(6)]
        T = [axis_gravity(model, q, axis) for axis in range(6)]
        D_geometric, T_geometric = lagrangian.geometric(ROWS, q, payload, mode)
        np.testing.assert_allclose(D, np.diag(lagrangian.mass_matrix(ROWS, q, payload, mode)), atol=1e-12)
        np.testing.assert_allclose(D, D_geometric, atol=1e-12)
        np.testing.assert_allclose(T, lagrangian.gravity(ROWS, q, payload, mode), atol=1e-12)
        np.testing.assert_allclose(T, T_geometric, atol=1e-12)


def test_whole_mass_matrix_of_the_corrected_bodies_is_that_of_the_published_ones():
    model = model_with((2.3, (0.0, 0.0, 0.095)))
    for q in POSTURES[:20]:
        published = lagrangian.mass_matrix(ROWS, q, (2.3, (0.0, 0.0, 0.095)))
        np.testing.assert_allclose(model.mass_matrix(q), published, atol=1e-12)


def test_inertia_does_not_depend_on_the_joints_before_and_at_the_axis():
    model = model_with((2.3, (0.0, 0.0, 0.095)))
    q = POSTURES[0].copy()
    for axis in range(6):
        turned = q.copy()
        turned[: axis + 1] += [0.3, -0.2, 0.5, 0.4, 0.1, 0.6][: axis + 1]
        assert axis_inertia(model, turned, axis) == pytest.approx(axis_inertia(model, q, axis), abs=1e-12)
    assert abs(axis_gravity(model, q, 0)) < 1e-12


def sampled(payload, count=60_000) -> np.ndarray:
    """Return D_ii (count, 6) over the joint ranges; the spec's figures are the extremes of 6000 other postures."""
    model = model_with(payload, "replace")
    return np.array(
        [np.diag(model.mass_matrix(q)) for q in np.random.default_rng(7).uniform(SPEC.lower, SPEC.upper, (count, 6))]
    )


BARE = None
FIVE_KG = (5.0, (0.0, 0.0, 0.1))


@pytest.mark.parametrize(
    ("payload", "ranges"),
    [
        (BARE, {0: (1.56, 4.25), 1: (1.55, 2.88), 2: (0.36, 0.36)}),
        (FIVE_KG, {0: (1.58, 8.90), 1: (1.79, 7.46), 2: (1.20, 1.76), 3: (0.002, 0.052), 4: (0.05, 0.05)}),
    ],
)
def test_ranges_over_the_joint_limits(payload, ranges):
    D = sampled(payload)
    for axis, (smallest, largest) in ranges.items():
        assert D[:, axis].min() == pytest.approx(smallest, rel=0.015, abs=0.0005)
        assert D[:, axis].max() == pytest.approx(largest, rel=0.015, abs=0.0005)


def test_ratio_of_largest_to_smallest_total_inertia():
    D = sampled(FIVE_KG) + spec_rotors(SPEC)
    np.testing.assert_allclose((D.max(axis=0) / D.min(axis=0))[:4], [4.09, 2.38, 1.31, 1.26], rtol=0.015)


@pytest.mark.parametrize(("payload", "largest"), [(BARE, 46.0), ((0.5, (0, 0, 0.05)), 49.7), (FIVE_KG, 92.4)])
def test_largest_gravity_torque_of_joint_2(payload, largest):
    model = model_with(payload, "replace")
    samples = np.random.default_rng(7).uniform(SPEC.lower, SPEC.upper, (60_000, 6))
    assert max(abs(model.gravity(q)[1]) for q in samples) == pytest.approx(largest, rel=0.005)
