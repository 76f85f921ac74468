"""The payload that is felt, against the true one of the plant, declared right and wrong."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robolang.execution.rig import Rig, fitted, plant_of
from robolang.project.project import load_cell_and_settings
from robolang.teaching.felt_payload import MOST, PayloadSense
from runtime.core.units import DEG
from runtime.motion.commands import MoveJoint
from runtime.robot.model.payload import Payload
from runtime.settings.profile import Profile

PROGRAM = Path(__file__).parents[3] / "programs" / "pick_and_place.rbl"
CELL = load_cell_and_settings(PROGRAM, None, None, None, {})[0]
COG = np.array([0.0, 0.0, 0.095])
BY = np.array([20.0, 10.0, -10.0, 20.0, 20.0, 30.0]) * DEG
HORIZONTAL = np.array([0.0, 90.0, -60.0, 0.0, -30.0, 0.0]) * DEG


def light_gears(cell, share):
    """The cell with a robot whose gears have a share of the dry friction."""

    def axis_of(axis):
        dry = tuple(share * each for each in axis.motor.coulomb_friction)
        return replace(axis, motor=replace(axis.motor, coulomb_friction=dry))

    return replace(cell, robot=replace(cell.robot, axes=tuple(map(axis_of, cell.robot.axes))))


def arm(true, said, *, physics=True, cell=CELL, home=None):
    """A controller whose arm carries a true mass, kg, of which another may be declared; None: no LOAD."""
    cell = replace(cell, parts=(), obstacles=(), home=cell.home if home is None else home)
    profile = Profile()
    profile = fitted(replace(profile, supervision=replace(profile.supervision, payload_mismatch="off")), physics)
    loaded = replace(cell, hand=replace(cell.hand, mass=true, cog=COG))
    controller = Rig.over(plant_of(loaded, profile.tick_s, physics), cell, profile).controller
    if said is not None:
        controller.load(Payload(mass=said, cog=COG))
    return controller


def wait(controller, cycles=60):
    for _ in range(cycles):
        assert controller.cycle()


def begin(controller):
    controller.move(MoveJoint(q_end=np.array(controller.areas.ina) + BY, speed=0.3))


def swing(controller):
    begin(controller)
    while controller.moving:
        assert controller.cycle()


CASES = [(0.8, 0.8), (2.3, 2.3), (2.3, 0.8), (0.8, 2.3), (2.3, None)]


@pytest.mark.physics
@pytest.mark.parametrize(("true", "said"), CASES)
def test_a_motion_tells_the_true_mass_whatever_is_declared(true, said):
    controller = arm(true, said)
    sense = PayloadSense(controller)
    wait(controller)
    # at rest the friction of this robot carries more than any payload
    assert sense.felt() is None
    begin(controller)
    wait(controller, 30)
    moving = sense.felt()
    wait(controller, 120)
    assert not controller.moving
    for found in (moving, sense.felt()):
        assert found.source == "motion"
        assert 0.0 < found.deviation <= 0.12
        assert found.mass == pytest.approx(true, abs=3.0 * found.deviation)


@pytest.mark.physics
def test_hand_and_load_begin_anew():
    controller = arm(2.3, 2.3)
    sense = PayloadSense(controller)
    swing(controller)
    assert sense.felt() is not None
    controller.load(Payload(mass=0.8, cog=COG))
    assert sense.felt() is None


@pytest.mark.physics
@pytest.mark.parametrize(("true", "said"), CASES)
@pytest.mark.parametrize("home", [None, HORIZONTAL], ids=["home", "horizontal"])
def test_an_arm_with_light_gears_is_felt_at_rest(true, said, home):
    controller = arm(true, said, cell=light_gears(CELL, 0.05), home=home)
    sense = PayloadSense(controller)
    wait(controller)
    found = sense.felt()
    assert found.source == "rest"
    assert found.deviation <= MOST * CELL.robot.rated_payload
    assert found.mass == pytest.approx(true, abs=3.0 * found.deviation)


@pytest.mark.parametrize(("true", "said"), CASES)
def test_the_ideal_arm_is_felt_at_rest(true, said):
    controller = arm(true, said, physics=False, home=HORIZONTAL)
    sense = PayloadSense(controller)
    wait(controller)
    found = sense.felt()
    assert found.source == "rest"
    assert found.mass == pytest.approx(true, abs=max(0.05, 3.0 * found.deviation))


def test_nothing_is_felt_before_the_window_is_full_and_with_the_brakes_on():
    controller = arm(2.3, 0.8, physics=False, home=HORIZONTAL)
    sense = PayloadSense(controller)
    wait(controller, 20)
    assert sense.felt() is None
    wait(controller, 20)
    assert sense.felt() is not None
    controller.halt()
    assert sense.felt() is None


def test_an_arm_that_accelerates_is_not_weighed_as_if_it_stood():
    controller = arm(2.3, 2.3, physics=False, home=HORIZONTAL)
    sense = PayloadSense(controller)
    wait(controller, 30)
    # before the supervision has weighed it
    begin(controller)
    wait(controller, 14)
    assert controller.drives.supervisor.observer.steps < 5
    assert sense.felt() is None


def test_feeling_changes_nothing():
    controllers = [arm(2.3, 0.8, physics=False) for _ in range(2)]
    sense = PayloadSense(controllers[0])
    for controller in controllers:
        for _ in range(3):
            begin(controller)
            wait(controller, 120)
            if controller is controllers[0]:
                sense.felt()
    one, other = (each.signals() for each in controllers)
    assert all(np.array_equal(one[name], other[name]) for name in one)
