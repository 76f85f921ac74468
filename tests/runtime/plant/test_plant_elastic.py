"""Elastic gears in the MuJoCo plant against two masses on a spring: frequency, decay, wind-up, energy."""

import numpy as np
import pytest

from runtime.plant.gears import PHASE_PER_STEP, fastest_spring, physics_steps, spring_frequencies
from runtime.plant.mujoco_plant import MujocoPlant
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from tests.runtime.plant.elastic import CELL, SPEC, empty, frictionless, only, true_arm, undamped, with_motors

pytestmark = pytest.mark.physics

ELASTIC = [0, 1, 2]


def ringing(axis: int, damped: bool) -> tuple[np.ndarray, float, float, float]:
    """Let one axis ring for 0.75 s after a blow of 4 ms.

    Returns the twist less its mean per tick (0.25 ms), and of that axis K, N^2 J and the inertia of its link.
    """
    spec = only(SPEC if damped else undamped(SPEC), axis)
    plant, model = MujocoPlant(spec, empty(spec), 0.25e-3), true_arm()
    hold = model.gravity(plant.q_link.copy())
    blow = np.eye(6)[axis] * 100.0
    twist = []
    for tick in range(3000):
        assert plant.step(hold + (blow if tick < 16 else 0.0))
        twist.append(plant.q[axis] - plant.q_link[axis])
    motor = spec.axes[axis].motor
    M = model.mass_matrix(np.array(CELL.home))[axis, axis]
    rest = np.array(twist[40:])
    return rest - rest.mean(), motor.stiffness, motor.reflected_inertia, float(M)


def frequency(signal: np.ndarray, tick_s: float) -> float:
    """Angular frequency from the first to the last upward passage of zero, rad/s."""
    up = np.flatnonzero((signal[:-1] < 0.0) & (signal[1:] >= 0.0))
    exact = up - signal[up] / (signal[up + 1] - signal[up])
    return 2.0 * np.pi * (len(exact) - 1) / ((exact[-1] - exact[0]) * tick_s)


@pytest.mark.parametrize("axis", ELASTIC)
def test_an_axis_rings_like_two_masses_on_a_spring(axis):
    twist, K, J_motor, J_link = ringing(axis, damped=False)
    expected = np.sqrt(K * (1.0 / J_motor + 1.0 / J_link))
    assert frequency(twist, 0.25e-3) == pytest.approx(expected, rel=2e-3)
    # undamped: the swing of the last quarter is that of the first
    quarter = len(twist) // 4
    assert np.ptp(twist[-quarter:]) == pytest.approx(np.ptp(twist[:quarter]), rel=0.03)


@pytest.mark.parametrize("axis", ELASTIC)
def test_a_ring_dies_away_as_the_damper_says(axis):
    """Decay rate C / 2 (1/J_motor + 1/J_link), from the peaks of the first ten swings."""
    twist, K, J_motor, J_link = ringing(axis, damped=True)
    both = 1.0 / J_motor + 1.0 / J_link
    C = SPEC.axes[axis].motor.damping
    period = round(2.0 * np.pi / np.sqrt(K * both) / 0.25e-3)
    swings = [np.ptp(twist[k * period : (k + 1) * period]) for k in (0, 3)]
    rate = np.log(swings[0] / swings[1]) / (3 * period * 0.25e-3)
    assert rate == pytest.approx(0.5 * C * both, rel=0.05)


def test_frequencies_of_one_axis_are_the_formula():
    spec = only(SPEC, 1)
    J_link = float(ArmModel(spec).mass_matrix(np.zeros(6))[1, 1])
    motor = spec.axes[1].motor
    expected = np.sqrt(motor.stiffness * (1.0 / motor.reflected_inertia + 1.0 / J_link))
    assert spring_frequencies(spec, np.zeros(6)) == pytest.approx([expected], rel=1e-5)


def held(home_deg: list | None = None) -> MujocoPlant:
    """The arm hanging in its gears for half a second, motors fed with the weight."""
    cell = empty(home_deg=home_deg)
    plant, model = MujocoPlant(SPEC, cell), true_arm()
    for _ in range(500):
        assert plant.step(model.gravity(plant.q_link.copy()))
    return plant


@pytest.mark.parametrize("home_deg", [None, [30, 80, 10, 0, 0, 0], [0, -60, 90, 0, 40, 0]])
def test_the_wind_up_at_rest_is_weight_over_spring(home_deg):
    plant = held(home_deg)
    twist = plant.q - plant.q_link
    weight = true_arm().gravity(plant.q_link.copy())
    np.testing.assert_allclose(twist[:3], (weight / SPEC.per_axis("motor", "stiffness"))[:3], atol=2e-8)
    np.testing.assert_array_equal(twist[3:], 0.0)
    assert np.abs(twist[1]) > 1e-4  # rad: a weight that is worth compensating


def test_the_arm_starts_at_rest_in_its_springs():
    """Motors at home, links below it; half a second later nothing has moved."""
    cell = empty()
    plant = MujocoPlant(SPEC, cell)
    first = plant.q_link.copy()
    np.testing.assert_array_equal(plant.q, cell.home)
    assert np.abs(first - cell.home).max() > 1e-4
    model = true_arm()
    for _ in range(500):
        assert plant.step(model.gravity(first))
    assert np.abs(plant.q_link - first).max() < 1e-6


def test_the_tool_hangs_on_the_links_not_on_the_motors():
    plant = held()
    kinematics = Kinematics(SPEC)
    np.testing.assert_allclose(
        plant.X_world_tool(), kinematics.forward(plant.q_link) @ CELL.hand.X_flange_tool, atol=1e-12
    )
    at_the_motors = kinematics.forward(plant.q) @ CELL.hand.X_flange_tool
    assert np.linalg.norm((plant.X_world_tool() - at_the_motors)[:3, 3]) > 5e-4


def energy_error(tick_s: float) -> float:
    """Push the frictionless, undamped arm for 0.3 s; relative difference of work done and energy stored."""
    spec, model = undamped(SPEC), true_arm()
    plant = MujocoPlant(spec, empty(spec), tick_s)
    K = spec.per_axis("motor", "stiffness")[:3]
    push, hold = np.array([60.0, 50.0, -25.0, 8.0, 6.0, -2.0]), model.gravity(plant.q_link.copy())

    def spring() -> float:
        return float(K @ (plant.q - plant.q_link)[:3] ** 2) / 2.0

    work, stored = 0.0, spring()
    link, links = plant.q_link.copy(), plant.q_link.copy()
    for _ in range(round(0.3 / tick_s)):
        dq, link = plant.dq.copy(), plant.q_link.copy()
        assert plant.step(hold + push)
        work += float((hold + push) @ (dq + plant.dq)) / 2.0 * tick_s
        links = plant.q_link.copy()
        work -= float((model.gravity(link) + model.gravity(links)) @ (links - link)) / 2.0
    dq_link = plant.dq.copy()
    dq_link[:3] += plant._last_qvel[plant._gears]
    rotors = float(plant.dq @ (spec_rotors(spec) * plant.dq)) / 2.0
    kinetic = float(dq_link @ model.mass_matrix(links) @ dq_link) / 2.0 + rotors
    assert kinetic > 5.0
    return abs(kinetic + spring() - stored - work) / kinetic


def test_energy_is_work_and_the_error_falls_with_the_step():
    coarse, fine = energy_error(1e-3), energy_error(0.125e-3)
    assert coarse < 0.01
    assert fine < 0.35 * coarse


# the seam ------------------------------------------------------------------------------------------------------------


def test_a_rigid_robot_has_no_angles_of_its_own_for_the_links():
    spec = load_builtin("irb2400")
    plant = MujocoPlant(spec, empty(spec, [0, 20, 10, 0, 40, 0]))
    assert plant.q_link is plant.q
    assert fastest_spring(spec) == 0.0
    assert plant._substeps == 1


@pytest.mark.parametrize("tick_s", [1e-3, 0.5e-3, 0.25e-3])
def test_the_physics_step_is_a_share_of_the_springs_period(tick_s):
    plant = MujocoPlant(SPEC, empty(), tick_s)
    assert fastest_spring(SPEC) * tick_s / plant._substeps <= PHASE_PER_STEP
    assert plant._substeps == physics_steps(SPEC, tick_s, 1e-3)
    stiff = with_motors(SPEC, stiffness=[100.0 * axis.motor.stiffness for axis in SPEC.axes])
    assert physics_steps(stiff, tick_s, 1e-3) >= 4 * plant._substeps


def test_the_live_arrays_are_the_same_objects_and_cannot_be_written():
    plant = MujocoPlant(SPEC, empty())
    arrays = (plant.q, plant.dq, plant.q_link)
    before = [array.copy() for array in arrays]
    for _ in range(5):
        plant.step(np.full(6, 100.0))
    assert all(a is b for a, b in zip(arrays, (plant.q, plant.dq, plant.q_link), strict=True))
    assert all(not np.array_equal(a, b) for a, b in zip(arrays, before, strict=True))
    for array in arrays:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_an_invalid_state_leaves_the_last_valid_angles_of_motors_and_links():
    plant = MujocoPlant(frictionless(SPEC), empty())
    for _ in range(3):
        plant.step(np.full(6, 50.0))
    last = plant.q.copy(), plant.dq.copy(), plant.q_link.copy()
    assert not plant.step(np.full(6, np.nan))
    for kept, now in zip(last, (plant.q, plant.dq, plant.q_link), strict=True):
        np.testing.assert_array_equal(now, kept)
