"""Energy, dry friction, rest on the table and repeatability of the MuJoCo plant."""

from dataclasses import replace

import numpy as np
import pytest

from robolang.project.builtin import cell_text
from runtime.core.frames import Array, pose_from_xyzrpy
from runtime.core.tomlfile import Source
from runtime.core.units import DEG
from runtime.plant.hand import hand_body
from runtime.plant.mujoco_plant import MujocoPlant
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import RobotSpec
from tests.runtime.from_texts import parse_cell

pytestmark = pytest.mark.physics

CELL = parse_cell(Source("cell.toml", cell_text()))
SPEC = CELL.robot
ROTORS = spec_rotors(SPEC)


def true_model() -> ArmModel:
    """The arm with its open hand, as it really is."""
    hand = hand_body(CELL.hand, CELL.hand.stroke)
    model = ArmModel(SPEC)
    model.set_payload(Payload(mass=hand.mass, cog=hand.cog, inertia=hand.inertia))
    return model


def without_friction(spec: RobotSpec) -> RobotSpec:
    def bare(motor: object) -> object:
        return replace(motor, viscous_friction=0.0, coulomb_friction=(0.0, 0.0))  # type: ignore[type-var]

    return replace(spec, axes=tuple(replace(axis, motor=bare(axis.motor)) for axis in spec.axes))


def energy_error(tick_s: float) -> float:
    """Push the frictionless arm for 0.3 s; returns the relative difference of kinetic energy and work done.

    The kinetic energy is Pinocchio's with the rotors', the work is that of motors and gravity (trapezoidal).
    """
    model, plant = true_model(), MujocoPlant(without_friction(SPEC), CELL, tick_s)
    push = np.array([8.0, 6.0, -4.0, 1.0, 1.0, -0.5])
    work = 0.0
    for _ in range(round(0.3 / tick_s)):
        q, dq = plant.q.copy(), plant.dq.copy()
        gravity = model.gravity(q)
        tau = gravity + push
        assert plant.step(tau)
        gravity_mean = (gravity + model.gravity(plant.q.copy())) / 2.0
        work += float((tau - gravity_mean) @ (dq + plant.dq)) / 2.0 * tick_s
    dq = plant.dq.copy()
    kinetic = float(dq @ ((model.mass_matrix(plant.q.copy()) + np.diag(ROTORS)) @ dq)) / 2.0
    assert kinetic > 1.0  # J: the arm has really moved
    return abs(kinetic - work) / kinetic


def test_energy_is_work_and_the_error_falls_with_the_step() -> None:
    coarse, fine = energy_error(1e-3), energy_error(0.25e-3)
    assert coarse < 1e-3
    assert fine < 0.35 * coarse + 1e-9


def friction_at_constant_speed(direction: float) -> Array:
    """Turn all joints at 0.1 rad/s; returns the mean torque (n,) that only dry friction explains."""
    model, plant = true_model(), MujocoPlant(SPEC, CELL)
    viscous = np.array([axis.motor.joint_viscous_friction for axis in SPEC.axes])
    goal, integral, torques = np.full(SPEC.n, 0.1 * direction), np.zeros(SPEC.n), []
    for tick in range(800):
        q, dq = plant.q.copy(), plant.dq.copy()
        error = goal - dq
        integral += error * 1e-3
        inertia = np.diag(model.mass_matrix(q)) + ROTORS
        tau = model.torque(q, dq, np.zeros(SPEC.n)) + inertia * (60.0 * error + 900.0 * integral)
        assert plant.step(tau)
        if tick >= 600:
            torques.append(tau - model.torque(q, dq, np.zeros(SPEC.n)) - viscous * dq)
    np.testing.assert_allclose(plant.dq, goal, rtol=5e-3)
    return np.mean(torques, axis=0)


@pytest.mark.parametrize(("direction", "side"), [(1.0, 0), (-1.0, 1)], ids=["forward", "backward"])
def test_dry_friction_is_the_published_one_in_each_direction(direction: float, side: int) -> None:
    """Published motor figures times |G|; where G is negative, the joint's forward is the motor's backward."""
    ratios = [-62.6111, 107.815, -53.7063, 76.0364, 71.923, 76.686]
    motor = [(0.395, 0.435), (0.126, 0.071), (0.132, 0.105), (11.2e-3, 16.9e-3), (9.26e-3, 14.5e-3), (3.96e-3, 10.5e-3)]
    joint = [abs(g) * pair[side if g > 0.0 else 1 - side] for g, pair in zip(ratios, motor, strict=True)]
    np.testing.assert_allclose(friction_at_constant_speed(direction) * direction, joint, rtol=5e-3)


def test_dry_friction_holds_the_arm_still() -> None:
    """A torque inside [-Tf, Tb] moves nothing, one outside does."""
    model = true_model()
    for factor, moves in ((0.95, False), (1.05, True)):
        plant = MujocoPlant(SPEC, CELL)
        tau = model.gravity(CELL.home)
        tau[0] += factor * SPEC.axes[0].motor.joint_coulomb_friction[0]
        for _ in range(300):
            assert plant.step(tau)
        assert bool(abs(plant.q[0] - CELL.home[0]) > 1e-4) is moves


def test_the_part_rests_on_the_table() -> None:
    model, plant = true_model(), MujocoPlant(SPEC, CELL)
    tau = model.gravity(CELL.home)
    before = plant.parts()["part"]
    for _ in range(1000):
        assert plant.step(tau)
    moved = plant.parts()["part"] - before
    assert np.abs(moved).max() < 5e-5
    assert plant.hand().holding is None
    touches = plant.contacts()
    assert {touch.names for touch in touches} == {("obstacle:table", "part:part")}
    assert sum(touch.force for touch in touches) == pytest.approx(1.5 * 9.81, rel=1e-3)


@pytest.mark.parametrize(("friction", "slides"), [(0.1, True), (0.3, False)])
def test_the_friction_of_a_part_is_the_part_s_own(friction: float, slides: bool) -> None:
    """On a table tilted by 10 deg (tan = 0.176) the slippery part slides, whatever the table is made of."""
    table = CELL.obstacles[0]
    X_table = table.X_world_obstacle @ pose_from_xyzrpy([0.0, 0.0, 0.0, 0.0, 10.0 * DEG, 0.0])
    X_part = X_table @ pose_from_xyzrpy([0.0, 0.2, (table.size[2] + CELL.parts[0].size[2]) / 2.0, 0.0, 0.0, 0.0])
    part = replace(CELL.parts[0], friction=friction, X_world_part=X_part)
    plant = MujocoPlant(SPEC, replace(CELL, parts=(part,), obstacles=(replace(table, X_world_obstacle=X_table),)))
    tau = true_model().gravity(CELL.home)
    for _ in range(400):
        assert plant.step(tau)
    moved = float(np.linalg.norm(plant.parts()["part"][:3, 3] - X_part[:3, 3]))
    fall = 9.81 * (np.sin(10.0 * DEG) - friction * np.cos(10.0 * DEG)) * 0.4**2 / 2.0
    assert moved == pytest.approx(fall, rel=0.02) if slides else moved < 1e-4


def run(looking: bool) -> tuple[Array, Array, Array]:
    plant, rng = MujocoPlant(SPEC, CELL), np.random.default_rng(7)
    gravity = true_model().gravity(CELL.home)
    pushes = rng.normal(scale=60.0, size=(6, SPEC.n))
    trace = []
    for tick in range(600):
        if tick == 200:
            plant.close_hand(True)
        assert plant.step(gravity + rng.normal(scale=2.0, size=SPEC.n) + pushes[tick // 100])
        trace.append(plant.q.copy())
        if looking:
            plant.X_world_tool(), plant.parts(), plant.hand(), plant.contacts()
    return np.array(trace), plant.dq.copy(), plant.parts()["part"]


def test_a_run_repeats_bit_for_bit_and_looking_changes_nothing() -> None:
    first, again = run(looking=False), run(looking=True)
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    assert np.ptp(first[0], axis=0).min() > 1e-3  # it was a motion


@pytest.mark.parametrize(("tick_s", "substeps"), [(2e-3, 2), (1e-3, 1), (0.5e-3, 1), (0.25e-3, 1)])
def test_one_tick_is_whole_physics_steps_of_at_most_a_millisecond(tick_s: float, substeps: int) -> None:
    plant = MujocoPlant(SPEC, CELL, tick_s)
    assert (plant._substeps, plant.tick_s) == (substeps, tick_s)
    for _ in range(10):
        plant.step(np.zeros(SPEC.n))
    assert plant._data.time == pytest.approx(10 * tick_s)


def test_the_plant_starts_at_home_with_the_hand_open() -> None:
    plant = MujocoPlant(SPEC, CELL)
    np.testing.assert_array_equal(plant.q, CELL.home)
    assert (plant.hand().closed, plant.hand().opening) == (False, pytest.approx(CELL.hand.stroke))
    expected = ArmModel(SPEC).flange(np.array(CELL.home)) @ CELL.hand.X_flange_tool
    np.testing.assert_allclose(plant.X_world_tool(), expected, atol=1e-12)
