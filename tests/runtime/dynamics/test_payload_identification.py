"""Weighing on made-up readings: exact where the model is, friction that is wrong cancels, what is unknown says so."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.core.frames import pose_from_xyzrpy
from runtime.dynamics.payload_identification import BodyModel, Knowledge, identify_payload
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import NO_PAYLOAD, Payload

PUMA, MANUTEC = load_builtin("puma560"), load_builtin("manutec_r3")
HOME = {
    "puma560": np.radians([-8.0, 77.0, -183.0, 0.0, -74.0, -8.0]),
    "manutec_r3": np.radians([-22.8, 12.2, 109.0, 0.0, 58.8, -22.8]),
}
BODY = Payload(mass=2.3, cog=np.array([0.02, -0.013, 0.095]), inertia=np.diag([4e-3, 6e-3, 3e-3]))
TICK_S, TICKS = 1e-3, 8


def motion(spec, seconds=6.0, moving=None):
    """q, dq, ddq (N, n) of slow sines; axes not in ``moving`` stand."""
    t = np.arange(round(seconds / TICK_S))[:, None] * TICK_S
    w = 2.0 * np.pi * np.array([3, 2, 1, 4, 3, 1]) / seconds
    A = np.radians([5.0, 5.0, 5.0, 25.0, 25.0, 50.0])
    A = A if moving is None else np.where(np.isin(np.arange(6), moving), A, 0.0)
    return HOME[spec.name] + A * np.sin(w * t), A * w * np.cos(w * t), -A * w**2 * np.sin(w * t)


def readings(spec, body, friction=0.0, springs=False, moving=None):
    """Torques that the motion takes, in the middle of each tick as a motor gives them, and angles at its start."""
    model = ArmModel(spec, rotors=spec_rotors(spec))
    model.set_payload(body)
    q, dq, ddq = motion(spec, moving=moving)
    links = np.array([model.torque(*row) for row in zip(q, dq, ddq, strict=True)])
    coulomb = np.array([axis.motor.joint_coulomb_friction for axis in spec.axes])
    dry = np.where(dq > 0.0, coulomb[:, 0], np.where(dq < 0.0, -coulomb[:, 1], 0.0))
    tau = links + friction * (dry + spec.per_axis("motor", "joint_viscous_friction") * dq)
    rotors = np.array([axis.motor.reflected_inertia for axis in spec.axes])
    motor = q
    if springs:  # the motor is ahead by the twist, and so is the acceleration of its rotor
        twist = (links - rotors * ddq) / spec.per_axis("motor", "stiffness")
        motor = q + twist
        tau = tau + rotors * np.gradient(np.gradient(twist, TICK_S, axis=0), TICK_S, axis=0)
    return (tau[:-1] + tau[1:]) / 2.0, motor[:-1]


def weigh(spec, body, known_friction=None, friction=0.0, springs=False, assume_springs=None, moving=None):
    tau, q = readings(spec, body, friction, springs, moving)
    known = Knowledge(
        torque=spec.per_axis("limits", "torque"),
        friction=friction if known_friction is None else known_friction,
        springs=springs if assume_springs is None else assume_springs,
    )
    return identify_payload(spec, tau, q, ticks=TICKS, tick_s=TICK_S, known=known)


@pytest.mark.parametrize("spec", [PUMA, MANUTEC], ids=lambda spec: spec.name)
@pytest.mark.parametrize("body", [BODY, replace(BODY, cog=np.array([-0.1, 0.05, 0.3]))], ids=["near", "far"])
def test_it_is_exact_where_the_model_is(spec, body):
    found = weigh(spec, body)
    assert found.mass == pytest.approx(body.mass, rel=2e-4)
    assert found.cog == pytest.approx(body.cog, abs=2e-5)
    assert (found.left < 1e-3 * spec.per_axis("limits", "torque")).all()


def test_the_centre_of_gravity_is_in_the_flange_frame():
    """The flanges of the built-in robots stand in the origin of axis 6; this one is turned and 0.2 m away."""
    turned = replace(PUMA, X_last_flange=pose_from_xyzrpy([0.05, -0.1, 0.2, 0.3, -0.7, 1.1]))
    found = weigh(turned, BODY)
    assert found.mass == pytest.approx(BODY.mass, rel=2e-4)
    assert found.cog == pytest.approx(BODY.cog, abs=1e-4)


def test_known_friction_changes_nothing():
    found = weigh(PUMA, BODY, friction=1.0)
    assert found.mass == pytest.approx(BODY.mass, rel=5e-4)
    assert found.cog == pytest.approx(BODY.cog, abs=1e-4)
    assert found.friction == pytest.approx(np.zeros(6), abs=2e-3)


def test_friction_that_is_ten_percent_wrong_cancels_and_is_found():
    found = weigh(PUMA, BODY, friction=1.1, known_friction=1.0)
    assert found.mass == pytest.approx(BODY.mass, rel=5e-3)
    assert found.cog == pytest.approx(BODY.cog, abs=5e-4)
    assert found.friction == pytest.approx(np.full(6, 0.1), abs=0.01)


def test_a_torque_that_is_always_there_stays_within_the_uncertainty():
    tau, q = readings(PUMA, BODY)
    torque = PUMA.per_axis("limits", "torque")
    offset = 0.002 * torque * [1, -1, 1, -1, 1, -1]
    known = Knowledge(torque=torque, friction=0.0, springs=False)
    found = identify_payload(PUMA, tau + offset, q, ticks=TICKS, tick_s=TICK_S, known=known)
    assert abs(found.mass - BODY.mass) < 3.0 * found.mass_sd
    assert (np.abs(found.cog - BODY.cog) < 3.0 * found.cog_sd).all()


def test_noise_is_covered_by_the_uncertainty():
    tau, q = readings(PUMA, BODY)
    known = Knowledge(torque=PUMA.per_axis("limits", "torque"), friction=0.0, springs=False)
    off = []
    for seed in range(12):
        noise = np.random.default_rng(seed).normal(size=tau.shape) * 0.02 * known.torque
        found = identify_payload(PUMA, tau + noise, q, ticks=TICKS, tick_s=TICK_S, known=known)
        off += [(found.mass - BODY.mass) / found.mass_sd, *((found.cog - BODY.cog) / found.cog_sd)]
    assert 0.5 < np.sqrt(np.mean(np.square(off))) < 1.6


def test_gear_springs_matter_and_are_taken_into_account():
    with_springs = weigh(MANUTEC, BODY, springs=True)
    without = weigh(MANUTEC, BODY, springs=True, assume_springs=False)
    assert with_springs.mass == pytest.approx(BODY.mass, rel=2e-3)
    assert abs(without.mass - BODY.mass) > 5.0 * abs(with_springs.mass - BODY.mass)


def test_nothing_carried_has_no_centre_of_gravity():
    found = weigh(PUMA, NO_PAYLOAD)
    assert abs(found.mass) < 1e-3
    assert found.cog is None
    assert found.cog_sd is None


def test_an_axis_that_shows_nothing_leaves_a_large_uncertainty():
    """J2 and J3 alone move the tool in a plane: what is off it cannot be told."""
    whole, plane = weigh(PUMA, BODY), weigh(PUMA, BODY, moving=[1, 2])
    assert plane.mass_sd > whole.mass_sd
    assert (plane.rows > 0).tolist() == [False, True, True, False, False, False]
    assert plane.cog_sd.max() > 20.0 * whole.cog_sd.max()


def test_an_arm_that_stands_still_is_refused():
    tau, q = readings(PUMA, BODY, moving=[])
    with pytest.raises(ValueError, match="move"):
        identify_payload(PUMA, tau, q, ticks=TICKS, tick_s=TICK_S, known=Knowledge(torque=np.ones(6)))


def test_the_body_regressor_times_the_parameters_is_the_torque_of_the_body():
    rng = np.random.default_rng(1)
    q, dq, ddq = rng.uniform(-1.0, 1.0, (3, 6))
    bare, loaded = BodyModel(MANUTEC), ArmModel(MANUTEC)
    loaded.set_payload(BODY)
    rotors = np.array([axis.motor.reflected_inertia for axis in MANUTEC.axes])
    added = loaded.torque(q, dq, ddq) + rotors * ddq - bare.torque(q, dq, ddq)
    R, p = MANUTEC.X_last_flange[:3, :3], MANUTEC.X_last_flange[:3, 3]
    c = R @ BODY.cog + p
    inertia = R @ BODY.inertia @ R.T + BODY.mass * (c @ c * np.eye(3) - np.outer(c, c))
    parameters = np.r_[BODY.mass, BODY.mass * c, inertia[[0, 0, 1, 0, 1, 2], [0, 1, 1, 2, 2, 2]]]
    assert bare.body_regressor(q) @ parameters == pytest.approx(added, abs=1e-9)
