"""Weight and friction from the passes of an identification."""

import numpy as np
import pytest

from robolang.experiments.excitation import Request
from robolang.experiments.identify import compensation_of, identify, weight_of
from runtime.dynamics.first_moments import scale
from runtime.robot.model.arm_model import ArmModel
from tests.campaign import some
from tests.robolang.experiments.identified import SEEDS, SPEC, experiment

pytestmark = pytest.mark.physics


def gravity_errors(request, moments):
    """RMS error of the gravity torque over 500 random postures, N m: model only, with first moments, all axes."""
    spec = request.robot
    postures = np.random.default_rng(1).uniform(spec.lower, spec.upper, (500, spec.n))
    real, *models = (
        np.array([arm.gravity(q) for q in postures])
        for arm in (ArmModel(request.real), ArmModel(spec), ArmModel(spec, first_moments=moments))
    )
    return [np.sqrt(((model - real) ** 2).mean(axis=0)) for model in models]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_weight_that_the_model_lacks_is_found(seed):
    """J2 4.5 -> 0.05 N m, J3 0.78 -> 0.02 with seed 8; with a wrist that is not tested it stays as the model has it."""
    request, results = experiment(seed=seed)
    moments = weight_of(request, results).first_moments
    without, with_it = gravity_errors(request, moments)
    assert (with_it[1:3] < without[1:3] / 20.0).all(), (without, with_it)
    assert (with_it[3:] < without[3:] + 0.02).all(), (without, with_it)
    np.testing.assert_array_equal(moments[0], 0.0)  # the axis of J1 stands upright


def test_friction_is_told_from_weight():
    """Coulomb and viscous friction of the robot file at the speed of the test, with a wrong weight beside it."""
    request, results = experiment(seed=8)
    weight = weight_of(request, results)
    for found in results:
        motor = SPEC.axes[found.axis].motor
        expected = motor.joint_coulomb_friction[0] + motor.joint_viscous_friction * found.speed.mean()
        assert weight.friction[found.axis] == pytest.approx(expected, rel=1e-3)
    assert (weight.friction[3:] == 0.0).all()
    assert weight.left < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("robot", some(["irb2400", "manutec_r3"], 1))
def test_the_weight_of_other_robots_is_found(robot):
    request, results = experiment(robot=robot, seed=3, axes=tuple(some(range(6), 2)))
    without, with_it = gravity_errors(request, weight_of(request, results).first_moments)
    known = some([1, 2], 1)
    assert (with_it[known] < without[known] / 50.0).all(), (without, with_it)


def test_a_perfect_model_lacks_no_weight():
    request, results = experiment(axes=tuple(some(range(6), 1, 5)))
    moments = weight_of(request, results).first_moments
    assert (np.linalg.norm(moments, axis=1) < 3e-3 * scale(SPEC) + 1e-9).all(), moments


def test_too_few_places_say_nothing_of_weight():
    request = Request(robot=SPEC, axes=(5,), plant="rigid", positions=2)
    results = identify(request)
    assert weight_of(request, results) is None
    assert compensation_of(request, results).first_moments == ()
