"""Cylinders as parts: they rest, are held by fingers, and roll or slide down a ramp as the formulas say."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.cell.cell import ObstacleSpec
from runtime.core.frames import pose_from_xyzrpy
from runtime.core.units import DEG, GRAVITY
from runtime.plant.inertia import part_inertia
from tests.runtime.plant.test_plant_grasp import CELL, Rig, slip

pytestmark = pytest.mark.physics

ROUND = replace(CELL.parts[0], shape="cylinder", size=np.array([0.04, 0.04, 0.08]))
RAMP = 20.0 * DEG


def test_the_inertia_is_that_of_the_volume():
    """Summed over small cubes of the cylinder, which knows no formula."""
    size, mass = np.array([0.04, 0.04, 0.1]), 1.5
    x, y, z = np.meshgrid(*(((np.arange(80) + 0.5) / 80 - 0.5) * edge for edge in size))
    inside = x**2 + y**2 <= (size[0] / 2.0) ** 2
    expected = [mass * np.mean((a**2 + b**2)[inside]) for a, b in ((y, z), (z, x), (x, y))]
    assert np.diag(part_inertia(replace(ROUND, mass=mass, size=size))) == pytest.approx(expected, rel=1e-3)


def test_it_rests_is_centred_and_stays_in_the_hand():
    X = np.array(ROUND.X_world_part)
    X[1, 3] += 0.01
    rig = Rig(replace(CELL, parts=(replace(ROUND, X_world_part=X),)))
    rig.hold(0.3)
    moved, turned = slip(X, rig.plant.parts()["part"])
    assert (moved < 1e-6, turned < 1e-5) == (True, True), (moved, turned)
    rig.pick()
    assert (rig.plant.hand().holding, rig.plant.hand().opening) == ("part", pytest.approx(0.04, abs=1e-4))
    held = rig.part_in_tool()
    assert held[1, 3] == pytest.approx(0.0, abs=1e-5)
    rig.carries(True)
    rig.go(480.0, -220.0, 850.0)
    moved, turned = slip(held, rig.part_in_tool())
    assert (moved < 1e-4, turned < 0.05 * DEG) == (True, True), (moved, turned)


@pytest.mark.parametrize(
    ("friction", "acceleration"),
    [
        (0.3, GRAVITY * np.sin(RAMP) * 2.0 / 3.0),
        (0.05, GRAVITY * (np.sin(RAMP) - 0.05 * np.cos(RAMP))),
    ],
)
def test_it_rolls_or_slides_down_a_ramp(friction, acceleration):
    """It rolls by 2/3 of the weight along the ramp while mu >= tan(angle) / 3 = 0.121, and slips beyond that."""
    X_ramp = pose_from_xyzrpy([3.0, 0.0, 1.0, 0.0, RAMP, 0.0])
    ramp = ObstacleSpec(name="ramp", size=np.array([1.0, 1.0, 0.1]), X_world_obstacle=X_ramp)
    X_part = X_ramp @ pose_from_xyzrpy([-0.3, 0.0, 0.07, 90.0 * DEG, 0.0, 0.0])
    rolling = replace(ROUND, X_world_part=X_part, friction=friction)
    rig = Rig(replace(CELL, parts=(rolling,), obstacles=(ramp,)))
    at, seconds = [], 0.15
    for _ in range(3):
        at.append(float((np.linalg.inv(X_ramp) @ rig.plant.parts()["part"])[0, 3]))
        rig.hold(seconds)
    # the second difference knows nothing of how it began
    assert (at[2] - 2.0 * at[1] + at[0]) / seconds**2 == pytest.approx(acceleration, rel=0.01)
