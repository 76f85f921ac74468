"""The ideal arm: conserves energy, carries what its hand took, and stops at a state that is not finite."""

import numpy as np
import pytest

from robolang.project.project import builtin_cell
from runtime.plant.rigid_plant import RigidPlant
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload

CELL = builtin_cell()
SPEC = CELL.robot


def hand_model() -> ArmModel:
    model = ArmModel(SPEC)
    model.set_payload(Payload(mass=CELL.hand.mass, cog=CELL.hand.cog))
    return model


def kinetic_energy(model: ArmModel, plant: RigidPlant) -> float:
    M = model.mass_matrix(plant.q) + np.diag(spec_rotors(SPEC))
    return float(0.5 * plant.dq @ M @ plant.dq)


def energy_error(tick_s: float) -> float:
    """Kinetic energy of a free swing against the work of gravity, summed by the trapezoid rule, over 0.4 s."""
    model, plant = hand_model(), RigidPlant(SPEC, CELL, tick_s)
    work, power = 0.0, 0.0
    for _ in range(round(0.4 / tick_s)):
        plant.step(np.zeros(SPEC.n))
        now = float(-model.gravity(plant.q) @ plant.dq)
        work, power = work + 0.5 * (power + now) * tick_s, now
    assert work > 5.0
    return abs(kinetic_energy(model, plant) - work) / work


def test_free_swing_conserves_energy_and_the_error_falls_with_the_tick():
    errors = [energy_error(tick_s) for tick_s in (1e-3, 0.5e-3, 0.25e-3)]
    assert errors[0] < 0.01
    assert errors[1] < 0.6 * errors[0]
    assert errors[2] < 0.6 * errors[1]


def test_it_stands_still_under_the_gravity_torque_of_its_true_load():
    plant = RigidPlant(SPEC, CELL)
    torque = hand_model().gravity(np.array(plant.q))
    start = plant.q.copy()
    for _ in range(200):
        plant.step(torque)
    np.testing.assert_allclose(plant.q, start, atol=1e-12)


@pytest.fixture
def at_the_part() -> RigidPlant:
    plant = RigidPlant(SPEC, CELL)
    from runtime.core.frames import inverse
    from runtime.robot.kinematics.kinematics import Kinematics

    X = np.array(CELL.parts[0].X_world_part)
    X[:3, :3] = np.diag([-1.0, 1.0, -1.0])
    kinematics = Kinematics(SPEC)
    plant.q[:] = kinematics.inverse_branch(X @ inverse(CELL.hand.X_flange_tool), kinematics.branch_of(plant.q), plant.q)
    return plant


def test_a_closed_hand_carries_the_true_mass_of_the_part_and_an_open_one_leaves_it(at_the_part):
    plant = at_the_part
    plant.close_hand(True)
    assert plant.hand().holding == "part"
    model = ArmModel(SPEC)
    part, hand = CELL.parts[0], CELL.hand
    mass = hand.mass + part.mass
    p_part = hand.X_flange_tool[:3, 3]
    model.set_payload(Payload(mass=mass, cog=(hand.mass * hand.cog + part.mass * p_part) / mass))
    q = plant.q.copy()
    plant.step(model.gravity(q))
    np.testing.assert_allclose(plant.dq, 0.0, atol=1e-12)
    plant.q[0] += 0.2
    moved = plant.parts()["part"]
    plant.close_hand(False)
    np.testing.assert_allclose(plant.parts()["part"], moved)
    assert np.linalg.norm(moved[:3, 3] - part.X_world_part[:3, 3]) > 0.05
    assert plant.hand().holding is None


def test_a_hand_that_closes_elsewhere_takes_nothing():
    plant = RigidPlant(SPEC, CELL)
    plant.close_hand(True)
    assert plant.hand().holding is None


def test_a_torque_that_is_not_finite_changes_nothing():
    plant = RigidPlant(SPEC, CELL)
    before = plant.q.copy()
    assert not plant.step(np.array([0.0, np.nan, 0.0, 0.0, 0.0, 0.0]))
    np.testing.assert_array_equal(plant.q, before)
    assert np.isfinite(plant.dq).all()
