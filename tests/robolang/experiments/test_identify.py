"""Identification by accelerating and braking (docs/identification.md): what is found of the inertia.

Friction and encoder steps are on in every experiment; the drive's current and its encoder are all that is read.
"""

import numpy as np
import pytest

from robolang.experiments.excitation import Request
from robolang.experiments.identify import compensation_of, identify, passage, with_errors
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import inertia_defect
from runtime.servo.motor import encoder_resolution
from tests.campaign import size, some
from tests.robolang.experiments.identified import N2, SEEDS, SPEC, TABLE_AXES, WITH_TABLE, experiment

RIGID = {"plant": "rigid", "axes": tuple(some(range(6), 0, 3)), "positions": size(5, 2)}
MUJOCO = {"axes": tuple(some(range(6), 1, 5))}


def off(results):
    """Largest relative distance of an identified inertia from the plant's, over all positions, one per axis."""
    return np.array([np.abs(found.identified / found.true - 1.0).max() for found in results])


# --- B6: the inertia is recovered ------------------------------------------------------------------------------------


@pytest.mark.slow
def test_rigid_arm_with_friction_is_recovered():
    """The rest is friction at the middle of a tick, extrapolated, and the other axes, which give way a little."""
    _, results = experiment(**RIGID)
    assert (off(results) < 1e-3).all()


@pytest.mark.physics
@pytest.mark.slow
def test_mujoco_is_recovered():
    """MuJoCo takes viscous friction at the end of a step: h N^2 B / (2 D') too much, 0.07 to 0.21 % on J1 to J3."""
    _, results = experiment(**MUJOCO)
    assert (off(results) < 3e-3).all()


@pytest.mark.physics
@pytest.mark.slow
@pytest.mark.parametrize(("robot", "most"), [("irb2400", 1e-3), ("manutec_r3", 8e-3)])
def test_other_robots_are_recovered(robot, most):
    """The gears of the Manutec are springs: the motor feels a little more than the links at the end of them."""
    _, results = experiment(robot=robot, axes=tuple(some(range(6), 1)), positions=size(5, 2))
    assert (off(results) < most).all()


def test_a_payload_that_is_declared_is_not_compensated():
    payload = Payload(mass=2.0, cog=np.array([0.0, 0.0, 0.08]))
    request = Request(robot=SPEC, axes=(1,), plant="rigid", positions=size(2, 1), payload=payload)
    (found,) = identify(request)
    assert found.compensation == pytest.approx(SPEC.axes[1].motor.rotor_inertia, rel=0.01)


def test_the_estimator_cancels_gravity_and_friction_to_the_encoder():
    """A synthetic axis: gravity, Coulomb and viscous friction, encoder steps; J is known exactly."""
    J, B, F, G, h, stroke, cycles = 3.65, 5.8, 25.0, 46.0, 1e-3, 0.5, 94
    step = float(encoder_resolution(SPEC)[0])
    s = np.arange(8 * cycles + 1) / (8 * cycles)
    way = stroke * s**3 * (10 - 15 * s + 6 * s * s)
    means = []
    before = float(np.interp(0.2113, s, way))
    for start in (0.7 - before, 0.7 - (stroke - before)):
        q = start + way
        dq, ddq = np.gradient(q, h), np.zeros_like(q)
        ddq[1:-1] = (q[2:] - 2 * q[1:-1] + q[:-2]) / h**2
        tau = J * ddq + B * dq + F + G * np.cos(q)
        means.append(passage(np.rint(q / step) * step, tau, 0.7, 112, h))
    up, down = means
    assert up.alpha > 4.5
    assert down.alpha < -4.5
    assert up.speed == pytest.approx(down.speed, rel=1e-4)
    assert (up.tau - down.tau) / (up.alpha - down.alpha) == pytest.approx(J, rel=2e-5)


def test_a_pass_that_misses_the_position_is_an_error():
    with pytest.raises(ValueError, match="below"):
        passage(np.linspace(1.0, 2.0, 400), np.zeros(400), 0.5, 50, 1e-3)


# --- spread: one number per axis -------------------------------------------------------------------------------------


@pytest.mark.physics
def test_the_compensation_is_the_same_at_all_positions():
    """D_ii does not depend on the axis' own angle."""
    for of_plant in (RIGID, MUJOCO):
        _, results = experiment(**of_plant)
        assert all(found.spread < 5e-4 * found.true for found in results)


@pytest.mark.physics
def test_the_spread_of_a_wrong_model_stays_small():
    """The held axes give way more when the servo's rows are wrong; that is all that the positions differ by."""
    _, results = experiment(seed=SEEDS[-1])
    assert all(found.spread < 7e-3 * found.true for found in results)
    assert (off(results) < 5e-3).all()


# --- B5: what it is worth --------------------------------------------------------------------------------------------


def rms_errors(request, results):
    """RMS relative error of the motor-side inertia over 500 random postures, axes 1 to 3: model only, compensated."""
    spec = request.robot
    postures = np.random.default_rng(1).uniform(spec.lower, spec.upper, (500, spec.n))
    model, real = (
        np.array([np.diag(arm.mass_matrix(q))[:3] for q in postures]) / N2[:3]
        for arm in (ArmModel(spec), ArmModel(request.real))
    )
    rotor = (spec_rotors(spec) / N2)[:3]
    Jc = np.array([found.compensation for found in results])
    true = real + rotor
    return [np.sqrt((((model + extra) / true - 1.0) ** 2).mean(axis=0)) for extra in (rotor, Jc)]


@pytest.mark.physics
@pytest.mark.parametrize("seed", SEEDS)
def test_the_error_of_the_inertia_is_several_times_smaller(seed):
    """Figures of the specification: 13.9, 8.0, 7.4 % -> 4.0, 2.1, 0.2 %, that is 3.5, 3.8 and 37 times."""
    without, with_it = rms_errors(*experiment(seed=seed))
    factor = without / with_it
    # J1 depends on how elbow and shoulder stand, which no constant can follow: seed 0 has errors for which the best
    # constant there is reaches 2.8 times (test below)
    assert (factor > ([3.0, 3.0, 10.0] if seed != 0 else [2.2, 3.0, 10.0])).all(), factor
    assert (with_it < [0.04, 0.021, 0.004]).all()
    assert (without > [0.05, 0.03, 0.03]).all()


@pytest.mark.physics
def test_a_constant_is_nearly_as_good_as_it_can_be():
    """The identified constant against the best one for these 500 postures, by weighted least squares."""
    for seed in SEEDS:
        request, results = experiment(seed=seed)
        postures = np.random.default_rng(1).uniform(SPEC.lower, SPEC.upper, (500, 6))
        model, real = (
            np.array([np.diag(arm.mass_matrix(q))[:3] for q in postures])
            for arm in (ArmModel(SPEC), ArmModel(request.real))
        )
        true = real + spec_rotors(SPEC)[:3]
        best = ((real - model) / true**2).sum(axis=0) / (1.0 / true**2).sum(axis=0)
        least = np.sqrt((((model + best + spec_rotors(SPEC)[:3]) / true - 1.0) ** 2).mean(axis=0))
        assert (rms_errors(request, results)[1] < 1.25 * least + 0.004).all()


def table_errors(request, results, scalars):
    """RMS relative error of the inertia over 500 random postures within the grid, by axis: scalar, table."""
    spec, errors = request.robot, []
    for found, scalar in zip(results, scalars, strict=True):
        axis, table = found.axis, found.table.compensation
        lower, upper = spec.lower.copy(), spec.upper.copy()
        joints = list(table.joints)
        lower[joints], upper[joints] = np.array([(grid[0], grid[-1]) for grid in table.grid]).T
        postures = np.random.default_rng(1).uniform(lower, upper, (500, spec.n))
        model, real = (
            np.array([arm.inertia_column(q, axis)[axis] for q in postures]) / N2[axis]
            for arm in (ArmModel(spec), ArmModel(request.real))
        )
        true = real + spec.axes[axis].motor.rotor_inertia
        by_posture = np.array([table.at(q) for q in postures])
        errors.append(
            [
                np.sqrt((((model + Jc) / true - 1.0) ** 2).mean())
                for Jc in (scalar.compensation, found.compensation, by_posture)
            ]
        )
    return np.array(errors)


@pytest.mark.slow
@pytest.mark.parametrize("seed", WITH_TABLE)
def test_a_table_follows_what_a_constant_cannot(seed):
    """5 angles of each joint: 0.5 to 0.7 % at J1 where the constant leaves 2.5 to 3.5, 0.2 at J2 for 0.9 to 1.4."""
    request, results = experiment(plant="rigid", seed=seed, axes=TABLE_AXES, positions=1, table=5)
    _, scalars = experiment(plant="rigid", seed=seed, axes=TABLE_AXES, positions=1)
    errors = table_errors(request, results, scalars)
    assert (errors[:, 2] < errors[:, 0] / 4.0).all(), errors
    assert (errors[:, 2] < errors[:, 1] / 4.0).all(), errors
    assert (errors[:, 2] < np.array([0.008, 0.003])[[*TABLE_AXES]]).all(), errors


@pytest.mark.physics
def test_a_table_on_mujoco_finds_what_the_plant_has_at_each_posture():
    request, (found,) = experiment(seed=4, axes=(1,), positions=1, table=3)
    table = found.table
    assert (np.abs(table.identified / table.true - 1.0) < 5e-3).all()
    assert np.ptp(table.true) > 0.3 * table.true.mean()
    assert found.compensation == pytest.approx(table.compensation.mean)
    assert found.means == pytest.approx([x.mean() for x in (table.identified, table.model, table.true)])
    (entry,) = (axis for axis in compensation_of(request, [found]).axes if axis.table is not None)
    assert entry.identified - entry.model == pytest.approx(entry.compensation)
    assert entry.table == table.compensation


def test_a_table_leaves_the_positions_as_they_were():
    """They come first and are told first; other axes have no table."""
    told = []
    many = size(2, 1)
    requests = [Request(robot=SPEC, axes=(1, 5), plant="rigid", positions=many, table=table) for table in (0, 2)]
    without = identify(requests[0])
    with_it = identify(requests[1], lambda axis, number, q: told.append((axis, number)))
    for a, b in zip(without, with_it, strict=True):
        assert (a.identified.tobytes(), a.spread, a.model) == (b.identified.tobytes(), b.spread, b.model)
    assert with_it[1].table is None
    assert told == [(1, k + 1) for k in range(many + 2)] + [(5, k + 1) for k in range(many)]
    assert [requests[1].places(axis) - many for axis in (0, 1, 2, 5)] == [4, 2, 0, 0]


def test_errors_are_physical_and_of_their_size():
    for mixed in (False, True):
        for seed in range(20):
            for axis, real in zip(SPEC.axes, with_errors(SPEC, seed, mixed=mixed).axes, strict=True):
                share = real.body.mass / axis.body.mass - 1.0
                assert 0.05 <= abs(share) <= 0.2
                assert inertia_defect(real.body.inertia) <= 1e-12
                assert mixed or share > 0.0
                np.testing.assert_array_equal(real.body.cog, axis.body.cog)
    np.testing.assert_array_equal(with_errors(SPEC, 7).axes[2].body.inertia, with_errors(SPEC, 7).axes[2].body.inertia)


@pytest.mark.slow
@pytest.mark.parametrize("seed", WITH_TABLE)
def test_a_table_is_three_times_better_over_whole_ranges(seed):
    """B5 with a table in place of the constant, 500 postures of which a third is beyond the grid: J1 3 % -> 1.2 %."""
    request, results = experiment(plant="rigid", seed=seed, axes=TABLE_AXES, positions=1, table=5)
    found = compensation_of(request, results)
    postures = np.random.default_rng(1).uniform(SPEC.lower, SPEC.upper, (500, 6))
    rotor = spec_rotors(SPEC)
    arms = ArmModel(SPEC), ArmModel(request.real)
    errors = []
    for q in postures:
        D, real = (np.diag(arm.mass_matrix(q)) for arm in arms)
        errors.append([(D + extra) / (real + rotor) - 1.0 for extra in (rotor, found.at(SPEC, q))])
    without, with_it = np.sqrt((np.array(errors) ** 2).mean(axis=0))[:, TABLE_AXES]
    assert (with_it < without / np.array([5.0, 20.0])[[*TABLE_AXES]]).all(), without / with_it
