"""Encoder, current limit and current loop, each against its own formula."""

import math

import numpy as np
import pytest

from runtime.robot.files.loader import load_builtin
from runtime.servo.motor import Encoders, Motors, current_limit, encoder_resolution, torque_limit

SPEC = load_builtin("puma560")
TICK_S = 1e-3


def motors(bandwidth: float = 2000.0) -> Motors:
    return Motors(np.array([10.0, 20.0]), np.array([5.0, 2.0]), np.full(2, bandwidth), TICK_S)


def test_the_encoder_counts_whole_steps_of_the_motor_turn_at_the_joint():
    resolution = encoder_resolution(SPEC)
    assert resolution[0] == pytest.approx(2 * math.pi / (131072 * 62.6111))
    out, q = np.zeros(6), np.linspace(-1.0, 1.3, 6)
    Encoders(resolution).read(q, out)
    steps = out / resolution
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
    assert (np.abs(out - q) <= resolution / 2 * (1 + 1e-9)).all()
    assert (out != q).any()


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_current_never_passes_its_limit_in_either_direction(sign):
    drive, out = motors(), np.zeros(2)
    for _ in range(50):
        drive.torque(sign * np.array([100.0, 100.0]), out)
        assert (np.abs(out) <= np.array([50.0, 40.0]) * (1 + 1e-12)).all()
    np.testing.assert_allclose(out, sign * np.array([50.0, 40.0]), rtol=1e-6)


def test_the_current_loop_is_a_first_order_lag_of_its_bandwidth():
    drive, out = motors(bandwidth=300.0), np.zeros(2)
    for k in range(1, 20):
        drive.torque(np.array([1.0, -1.0]), out)
        expected = 1.0 - math.exp(-300.0 * k * TICK_S)
        np.testing.assert_allclose(out, [10.0 * expected, -20.0 * expected], rtol=1e-12)


def test_the_lower_of_drive_current_and_joint_torque_limits_the_axis():
    for axis, current, torque in zip(SPEC.axes, current_limit(SPEC), torque_limit(SPEC), strict=True):
        assert torque <= axis.limits.torque * (1 + 1e-12)
        assert current <= axis.motor.max_current
        assert torque == pytest.approx(current * axis.motor.torque_constant * abs(axis.motor.gear_ratio))
