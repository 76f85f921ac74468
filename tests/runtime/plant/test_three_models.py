"""Lagrangian of the published data, Pinocchio and MuJoCo: one arm, full inverse dynamics, 1e-9.

The Lagrangian (tests/runtime/dynamics/lagrangian.py) reads the robot file itself and knows neither engine; the engines
get the corrected bodies. Differences are relative to the largest value of the same kind among all postures (some
hundred N m on the Manutec).
"""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from runtime.plant.mjcf import build_mjcf
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import Body, RobotSpec
from tests.campaign import size
from tests.runtime.dynamics import lagrangian

pytestmark = pytest.mark.physics

ROBOTS = ["puma560", "manutec_r3", "cobra600"]
LOADS = {
    "puma560": (2.3, (0.01, -0.02, 0.095)),
    "manutec_r3": (13.5, (0.02, -0.03, 0.14)),
    "cobra600": (1.8, (0.02, -0.03, 0.07)),
}
R_LAST_FLANGE = {"puma560": np.eye(3), "manutec_r3": np.eye(3), "cobra600": np.diag([1.0, -1.0, -1.0])}
"""Of the flange in the frame of the last body: in a file of lines that is parallel to the base at zero."""
POSTURES = size(25, 6)


def rigid(spec: RobotSpec) -> RobotSpec:
    """The same robot with gears that do not give."""
    axes = (replace(axis, motor=replace(axis.motor, stiffness=np.inf, damping=0.0)) for axis in spec.axes)
    return replace(spec, axes=tuple(axes))


class Models:
    """Three ways to the equations of motion of one robot with one load (None: bare), rotors left out."""

    def __init__(self, name: str, load: tuple | None) -> None:
        self.spec, self.rows, self.load = load_builtin(name), lagrangian.published(name), load
        self.pinocchio, body = ArmModel(self.spec), None
        if load is not None:
            self.pinocchio.set_payload(Payload(mass=load[0], cog=np.array(load[1])))
            # MuJoCo takes no point mass: the token moments of a body published as one
            body = Body(mass=load[0], cog=np.array(load[1]), inertia=1e-12 * np.eye(3))
            self.load = (load[0], R_LAST_FLANGE[name] @ np.array(load[1]))
        self.mujoco = mujoco.MjModel.from_xml_string(build_mjcf(rigid(self.spec), payload=body))
        self.data = mujoco.MjData(self.mujoco)
        rng = np.random.default_rng(1990)
        self.q = rng.uniform(self.spec.lower, self.spec.upper, (POSTURES, self.spec.n))
        speed = self.spec.per_axis("limits", "speed")
        self.dq = rng.uniform(-speed, speed, (POSTURES, self.spec.n))
        self.ddq = rng.uniform(-10.0, 10.0, (POSTURES, self.spec.n))

    def mass_matrices(self) -> list[np.ndarray]:
        return [
            np.array([lagrangian.mass_matrix(self.rows, q, self.load) for q in self.q]),
            np.array([self.pinocchio.mass_matrix(q) for q in self.q]),
            np.array([self._mujoco_mass(q) for q in self.q]),
        ]

    def torques(self, moving: bool) -> list[np.ndarray]:
        """Inverse dynamics of the sampled motion, or gravity alone."""
        factor = 1.0 if moving else 0.0
        motion = [(q, factor * dq, factor * ddq) for q, dq, ddq in zip(self.q, self.dq, self.ddq, strict=True)]
        return [
            np.array([lagrangian.inverse_dynamics(self.rows, *m, self.load) for m in motion]),
            np.array([self.pinocchio.torque(*m) for m in motion]),
            np.array([self._mujoco_torque(*m) for m in motion]),
        ]

    def _mujoco_mass(self, q: np.ndarray) -> np.ndarray:
        self.data.qpos[:] = q
        mujoco.mj_forward(self.mujoco, self.data)
        M = np.zeros((self.spec.n, self.spec.n))
        mujoco.mj_fullM(self.mujoco, self.data, M)
        return M - np.diag(spec_rotors(self.spec))

    def _mujoco_torque(self, q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        """M ddq + h of the engine: its inverse dynamics would add friction and limits."""
        M = self._mujoco_mass(q)
        self.data.qvel[:] = dq
        mujoco.mj_forward(self.mujoco, self.data)
        return M @ ddq + self.data.qfrc_bias


def spread(values: list[np.ndarray]) -> float:
    """The largest difference between any two of the three, over the largest value."""
    scale = np.max([np.abs(v).max() for v in values])
    return float(np.max([np.abs(a - b).max() for a in values for b in values]) / scale)


@pytest.fixture(scope="module", params=[(n, full) for n in ROBOTS for full in (False, True)], ids=str)
def models(request) -> Models:
    name, loaded = request.param
    return Models(name, LOADS[name] if loaded else None)


def test_mass_matrices_agree(models):
    assert spread(models.mass_matrices()) < 1e-9


def test_gravity_agrees(models):
    assert spread(models.torques(moving=False)) < 1e-9


def test_full_inverse_dynamics_agree(models):
    assert spread(models.torques(moving=True)) < 1e-9


def test_the_velocity_terms_are_a_real_part_of_it(models):
    """What the three agree on is not nothing: at full speed tens of N m on the Manutec."""
    torques = [
        lagrangian.velocity_torque(models.rows, q, dq, models.load) for q, dq in zip(models.q, models.dq, strict=True)
    ]
    assert np.abs(torques).max() > (50.0 if models.spec.name == "manutec_r3" else 2.0)


@pytest.mark.parametrize("name", ROBOTS)
def test_the_comparison_notices_a_thousandth(name):
    models = Models(name, LOADS[name])
    models.rows[2]["mass_kg"] *= 1.001
    assert spread(models.torques(moving=False)) > 1e-6
    assert spread(models.mass_matrices()) > 1e-6
    assert spread(models.torques(moving=True)) > 1e-6


def test_the_velocity_terms_take_no_power_beyond_that_of_the_inertia():
    """dq' h = 1/2 dq' dM/dt dq: dM/dt - 2 C is skew, a property the Christoffel form must have."""
    models = Models("manutec_r3", None)
    for q, dq in zip(models.q[:10], models.dq[:10], strict=True):
        dM = lagrangian.mass_matrix_derivative(models.rows, q) @ dq
        power = dq @ lagrangian.velocity_torque(models.rows, q, dq)
        assert power == pytest.approx(0.5 * dq @ dM @ dq, rel=1e-9, abs=1e-9)


def test_gravity_of_the_manutec_by_hand():
    """Straight up, joint 2 holds what stands off its axis: wrist bodies 155 mm behind it, body 6 50 mm less."""
    expected = 9.81 * (0.155 * (28.7 + 5.2) + 0.5 * (0.155 - 0.05))
    assert ArmModel(load_builtin("manutec_r3")).gravity(np.zeros(6))[1] == pytest.approx(expected, abs=1e-9)


def test_links_of_the_elastic_arm_are_those_of_the_rigid_one():
    """In the plant's elastic model the twists see the links alone, the motors links and rotors."""
    spec = load_builtin("manutec_r3")
    model = mujoco.MjModel.from_xml_string(build_mjcf(spec))
    data = mujoco.MjData(model)
    motors = [int(model.joint(f"j{i}").qposadr[0]) for i in range(1, 7)]
    gears = [int(model.joint(f"j{i}_gear").qposadr[0]) for i in (1, 2, 3)]
    q, twist = np.array([0.3, 0.4, -0.5, 0.6, 0.7, 0.8]), np.array([0.01, -0.02, 0.03])
    data.qpos[motors], data.qpos[gears] = q, twist
    mujoco.mj_forward(model, data)
    M = np.zeros((9, 9))
    mujoco.mj_fullM(model, data, M)
    links = ArmModel(spec).mass_matrix(q + np.array([*twist, 0.0, 0.0, 0.0]))
    np.testing.assert_allclose(M[np.ix_(motors, motors)], links + np.diag(spec_rotors(spec)), atol=1e-9)
    np.testing.assert_allclose(M[np.ix_(gears, gears)], links[:3, :3], atol=1e-9)
    np.testing.assert_allclose(M[np.ix_(motors, gears)], links[:, :3], atol=1e-9)
