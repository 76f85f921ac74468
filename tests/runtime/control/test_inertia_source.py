"""The three sources of inertia: the same D, the same torques, through a LOAD and a move."""

import dataclasses
from collections.abc import Mapping

import numpy as np
import pytest

from runtime.settings.profile import Profile
from runtime.settings.supervision import SupervisionLimits
from tests.runtime.control.test_controller import carried_payload, controller, down, signals


def log_of(source: str, load_mode: str = "add") -> Mapping[str, np.ndarray]:
    watched = SupervisionLimits(enabled=False)  # the arm carries less than is declared
    robot = controller(Profile(inertia_source=source, load_mode=load_mode, supervision=watched))
    for _ in range(5):
        robot.cycle()
    robot.load(dataclasses.replace(carried_payload(), mass=2.0))
    robot.move(down(robot))
    while robot.moving:
        assert robot.cycle(), robot.alarms
    return signals(robot)


@pytest.mark.parametrize("load_mode", ["add", "replace"])
@pytest.mark.parametrize("source", ["recursion", "matrix"])
def test_every_source_gives_the_inertia_and_the_torques_of_the_pass(source, load_mode):
    by_pass, other = log_of("pass", load_mode), log_of(source, load_mode)
    assert by_pass["D"].std(axis=0)[0] > 1e-3  # it moves
    np.testing.assert_allclose(other["D"], by_pass["D"], rtol=0, atol=1e-10)
    np.testing.assert_allclose(other["tau_cmd"], by_pass["tau_cmd"], rtol=0, atol=1e-6)
