"""Identification by accelerating and braking (docs/identification.md), and what the servo gains from it.

Friction and encoder steps are on in every experiment; the drive's current and its encoder are all that is read.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from robolang.identify import RubbingPlant, compensation_of, identify, passage, weight_of, with_errors
from robolang.project import load_project
from robolang.session import Session
from robolang.trial_motion import LEAST_STROKE, MARGIN, Request, plan, plan_table, posture
from runtime.controller import Controller
from runtime.dynamics.first_moments import scale
from runtime.faults import Fault
from runtime.motion.fine import FineInterpolator
from runtime.plant.mujoco_plant import MujocoPlant
from runtime.robot.kinematics import Kinematics
from runtime.robot.loader import load_builtin
from runtime.robot.model import ArmModel, spec_rotors
from runtime.robot.payload import NO_PAYLOAD, Payload
from runtime.robot.spec import inertia_defect
from runtime.servo.motor import encoder_resolution

ROOT = Path(__file__).parents[2]
SPEC = load_builtin("puma560")
N2 = SPEC.per_axis("motor", "gear_ratio") ** 2
SEEDS = (0, 3, 4, 8)


@cache
def experiment(robot="puma560", plant="mujoco", seed=None, axes=(0, 1, 2), mixed=False, positions=5, table=0):
    spec = load_builtin(robot)
    real = None if seed is None else with_errors(spec, seed, mixed=mixed)
    request = Request(robot=spec, axes=axes, plant=plant, real=real, positions=positions, table=table)
    return request, identify(request)


def off(results):
    """Largest relative distance of an identified inertia from the plant's, over all positions, one per axis."""
    return np.array([np.abs(found.identified / found.true - 1.0).max() for found in results])


# --- B6: the inertia is recovered ------------------------------------------------------------------------------------


@pytest.mark.slow
def test_rigid_arm_with_friction_is_recovered():
    """The rest is friction at the middle of a tick, extrapolated, and the other axes, which give way a little."""
    _, results = experiment(plant="rigid", axes=tuple(range(6)))
    assert (off(results) < 1e-3).all()


@pytest.mark.slow
def test_mujoco_is_recovered():
    """MuJoCo takes viscous friction at the end of a step: h N^2 B / (2 D') too much, 0.07 to 0.21 % on J1 to J3."""
    _, results = experiment(axes=tuple(range(6)))
    assert (off(results) < 3e-3).all()


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "most"), [("irb2400", 1e-3), ("manutec_r3", 8e-3)])
def test_other_robots_are_recovered(robot, most):
    """The gears of the Manutec are springs: the motor feels a little more than the links at the end of them."""
    _, results = experiment(robot=robot, axes=tuple(range(6)))
    assert (off(results) < most).all()


def test_a_payload_that_is_declared_is_not_compensated():
    payload = Payload(mass=2.0, cog=np.array([0.0, 0.0, 0.08]))
    request = Request(robot=SPEC, axes=(1,), plant="rigid", positions=2, payload=payload)
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
    with pytest.raises(ValueError, match="from below"):
        passage(np.linspace(1.0, 2.0, 400), np.zeros(400), 0.5, 50, 1e-3)


# --- spread: one number per axis -------------------------------------------------------------------------------------


def test_the_compensation_is_the_same_at_all_positions():
    """D_ii does not depend on the axis' own angle."""
    for plant in ("rigid", "mujoco"):
        _, results = experiment(plant=plant, axes=tuple(range(6)))
        assert all(found.spread < 5e-4 * found.true for found in results)


def test_the_spread_of_a_wrong_model_stays_small():
    """The held axes give way more when the servo's rows are wrong; that is all that the positions differ by."""
    _, results = experiment(seed=4)
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
        errors.append([np.sqrt((((model + Jc) / true - 1.0) ** 2).mean())
                       for Jc in (scalar.compensation, found.compensation, by_posture)])  # fmt: skip
    return np.array(errors)


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_a_table_follows_what_a_constant_cannot(seed):
    """5 angles of each joint: 0.5 to 0.7 % at J1 where the constant leaves 2.5 to 3.5, 0.2 at J2 for 0.9 to 1.4."""
    request, results = experiment(plant="rigid", seed=seed, axes=(0, 1), positions=1, table=5)
    _, scalars = experiment(plant="rigid", seed=seed, axes=(0, 1), positions=1)
    errors = table_errors(request, results, scalars)
    assert (errors[:, 2] < errors[:, 0] / 4.0).all(), errors
    assert (errors[:, 2] < errors[:, 1] / 4.0).all(), errors
    assert (errors[:, 2] < [0.008, 0.003]).all(), errors


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
    requests = [Request(robot=SPEC, axes=(1, 5), plant="rigid", positions=2, table=table) for table in (0, 2)]
    without = identify(requests[0])
    with_it = identify(requests[1], lambda axis, number, q: told.append((axis, number)))
    for a, b in zip(without, with_it, strict=True):
        assert (a.identified.tobytes(), a.spread, a.model) == (b.identified.tobytes(), b.spread, b.model)
    assert with_it[1].table is None
    assert told == [(1, 1), (1, 2), (1, 3), (1, 4), (5, 1), (5, 2)]
    assert [requests[1].places(axis) for axis in (0, 1, 2, 5)] == [6, 4, 2, 2]


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


# --- test motions ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("robot", ["puma560", "manutec_r3", "irb2400"])
def test_test_motions_keep_every_limit(robot):
    spec = load_builtin(robot)
    request = Request(robot=spec, axes=(0,))
    for axis in range(spec.n):
        test = plan(request, NO_PAYLOAD, axis)
        for position in test.positions:
            starts = test.starts(float(position))
            for start in starts:
                assert start >= spec.lower[axis] + MARGIN - 1e-9
                assert start + test.stroke <= spec.upper[axis] - MARGIN + 1e-9
            assert starts[0] < position < starts[1] + test.stroke
        rows = test.rows[:, None]
        _, dq, ddq = FineInterpolator(8, 8e-3, rows[0]).expand(rows)
        assert np.abs(dq).max() <= 0.51 * spec.axes[axis].limits.speed
        assert np.abs(ddq).max() <= 0.51 * spec.axes[axis].limits.acceleration


def test_other_axes_stand_inside_their_ranges_where_the_inertia_is_near_its_mean():
    model, rng = ArmModel(SPEC), np.random.default_rng(3)
    D = np.array([np.diag(model.mass_matrix(q)) for q in rng.uniform(SPEC.lower, SPEC.upper, (500, 6))]).mean(axis=0)
    for axis in range(6):
        q, (low, high) = posture(SPEC, model, axis)
        assert model.inertia_column(q, axis)[axis] == pytest.approx(D[axis], rel=0.12)
        assert (q > SPEC.lower + MARGIN).all()
        assert (q < SPEC.upper - MARGIN).all()
        assert high - low > 0.85 * (SPEC.upper[axis] - SPEC.lower[axis])  # J2 would reach the ground


@pytest.mark.parametrize("robot", ["puma560", "irb2400", "manutec_r3"])
@pytest.mark.parametrize(("axis", "joints"), [(0, (1, 2)), (1, (2,))])
def test_the_postures_of_a_table_are_over_the_ground_with_all_of_their_motions(robot, axis, joints):
    spec = load_builtin(robot)
    kinematics = Kinematics(spec)
    request = Request(robot=spec, axes=(axis,), table=4)
    grid = plan_table(request, NO_PAYLOAD, plan(request, NO_PAYLOAD, axis))
    assert grid.joints == joints
    assert len(grid.tests) == 4 ** len(joints)
    for joint, angles in zip(joints, grid.angles, strict=True):
        assert np.ptp(np.diff(angles)) < np.radians(0.03)
        assert angles[0] > spec.lower[joint] + 0.9 * MARGIN
        assert angles[-1] < spec.upper[joint] - 0.9 * MARGIN
        assert np.ptp(angles) > 0.4 * (spec.upper[joint] - spec.lower[joint])
    for number, test in enumerate(grid.tests):
        index = np.unravel_index(number, (4,) * len(joints))
        assert [test.q[joint] for joint in joints] == [angles[k] for k, angles in zip(index, grid.angles, strict=True)]
        (position,) = test.positions
        for start in test.starts(position):
            q = np.tile(test.q, (len(test.rows), 1))
            q[:, axis] = start + test.rows
            assert (kinematics.forward(q)[:, 2, 3] > 0.19).all()


def test_a_table_shrinks_off_the_ground():
    """The shoulder of the Puma hangs the arm down at both ends of its range: the grid is what is left."""
    grid = plan_table(request := Request(robot=SPEC, axes=(0,), table=3), NO_PAYLOAD, plan(request, NO_PAYLOAD, 0))
    low, high = np.degrees(grid.angles[0][[0, -1]])
    assert -45.0 + 20.0 < low < high < 225.0 - 20.0


def test_a_table_without_room_is_refused_before_anything_moves(monkeypatch):
    request = Request(robot=SPEC, axes=(1,), table=2)
    test = plan(request, NO_PAYLOAD, 1)
    monkeypatch.setattr("robolang.trial_motion.CLEARANCE", 9.0)
    with pytest.raises(Fault, match="J2 has no room for a table over J3") as caught:
        plan_table(request, NO_PAYLOAD, test)
    assert caught.value.code == "RBL420"


def test_a_torque_that_is_not_there_at_a_posture_of_a_table_is_refused_with_it():
    request = Request(robot=changed(0, torque=35.0), axes=(0,), table=3)
    test = plan(Request(robot=SPEC, axes=(0,)), NO_PAYLOAD, 0)
    with pytest.raises(Fault, match=r"torque of J1 .*, in the posture J2 1\.3, J3 -?\d+\.\d deg of its table"):
        plan_table(request, NO_PAYLOAD, test)


def changed(axis, **limits):
    axes = list(SPEC.axes)
    axes[axis] = replace(axes[axis], limits=replace(axes[axis].limits, **limits))
    return replace(SPEC, axes=tuple(axes))


def test_an_axis_without_room_is_refused_before_anything_moves():
    spec = changed(2, lower=-1.6, upper=-1.6 + 2 * LEAST_STROKE + MARGIN)
    told = []
    with pytest.raises(Fault) as caught:
        identify(Request(robot=spec, axes=(0, 2)), lambda *where: told.append(where))
    assert caught.value.code == "RBL420"
    assert "J3" in caught.value.message
    assert caught.value.hint
    assert told == []  # not even the axis that could have been


def test_a_torque_that_is_not_there_is_refused_with_place_and_joint():
    spec = changed(1, torque=45.0)
    with pytest.raises(Fault, match=r"J2 at -?\d+\.\d deg: .* torque of J2 to -?\d+\.\d N m") as caught:
        identify(Request(robot=spec, axes=(1,)), lambda *where: pytest.fail("it moved"))
    assert caught.value.code == "RBL420"


def test_less_torque_makes_the_test_slower():
    fast, slow = (plan(Request(robot=spec, axes=(1,)), NO_PAYLOAD, 1) for spec in (SPEC, changed(1, torque=90.0)))
    assert len(slow.rows) > len(fast.rows)


def test_an_axis_that_is_not_there_is_refused():
    with pytest.raises(Fault) as caught:
        identify(Request(robot=SPEC, axes=(6,)))
    assert caught.value.code == "RBL420"


def test_a_plant_that_does_not_follow_stops_the_identification():
    real = with_errors(SPEC, 1, low=9.0, high=10.0)
    with pytest.raises(Fault, match=r"J2 at -?\d+\.\d deg: ") as caught:
        identify(Request(robot=SPEC, axes=(1,), real=real))
    assert caught.value.code in ("RBL511", "RBL512")


def test_a_contact_stops_the_identification(monkeypatch):
    """The Puma reaches the ground when nothing keeps it off."""
    monkeypatch.setattr("robolang.trial_motion.CLEARANCE", -9.0)
    with pytest.raises(Fault, match=r"J2 at -?\d+\.\d deg: floor touches \w+") as caught:
        identify(Request(robot=SPEC, axes=(1,)))
    assert caught.value.code == "RBL516"


def test_positions_are_equally_spaced_and_told():
    told = []
    request = Request(robot=SPEC, axes=(5,), plant="rigid", positions=3)
    (found,) = identify(request, lambda axis, number, q: told.append((axis, number, round(q, 9))))
    assert np.ptp(np.diff(found.positions)) < 1e-12
    assert told == [(5, k + 1, round(q, 9)) for k, q in enumerate(found.positions)]


def test_one_position_is_the_middle():
    (found,) = identify(Request(robot=SPEC, axes=(3,), plant="rigid", positions=1))
    assert found.positions == pytest.approx([np.radians(30.0)])
    assert found.spread == 0.0


def test_the_same_request_gives_the_same_bytes():
    request = Request(robot=SPEC, axes=(5,), positions=2)
    first, second = identify(request), identify(request)
    assert first[0].identified.tobytes() == second[0].identified.tobytes()


def test_friction_of_the_ideal_arm_brakes_it():
    cell = replace(load_project(ROOT / "programs/pick_and_place.rbl").cell, parts=(), obstacles=())
    plant = RubbingPlant(SPEC, cell, 1e-3)
    plant.dq[:] = 0.5
    model = ArmModel(SPEC, rotors=spec_rotors(SPEC))
    model.set_payload(Payload(mass=cell.hand.mass, cog=cell.hand.cog))
    before = plant.dq.copy()
    plant.step(model.torque(plant.q, plant.dq, np.zeros(6)))  # holds the speed but for friction
    work = (plant.dq - before) @ model.mass_matrix(plant.q) @ before
    assert work < 0.0


# --- in the controller -----------------------------------------------------------------------------------------------


@cache
def pick_and_place(real, rotors=(), first_moments=(), supervised=False):
    """Run the program with the nominal model on a plant of another robot; returns the result."""
    project = load_project(ROOT / "programs" / "pick_and_place.rbl")
    profile = project.profile
    profile = replace(profile, servo=replace(profile.servo, rotors=rotors, first_moments=first_moments))
    if not supervised:
        supervision = replace(profile.supervision, collision=np.inf, payload_mismatch="off")
        profile = replace(profile, supervision=supervision)
    session = Session(project.with_profile(profile))
    cell = project.cell
    robot = robot_of(real)
    plant = MujocoPlant(robot, replace(cell, robot=robot), profile.tick_s)
    session.controller = Controller(cell.robot, plant, session.controller.profile, cell.hand.X_flange_tool)
    session.record.controller = session.controller
    return session.run()


def with_reducers(factor):
    """Return the robot with reducers, whose inertia the robot file does not have, on all motors."""
    motors = [replace(axis.motor, rotor_inertia=axis.motor.rotor_inertia * factor) for axis in SPEC.axes]
    return replace(SPEC, axes=tuple(replace(axis, motor=m) for axis, m in zip(SPEC.axes, motors, strict=True)))


def log_of(*words, **options):
    result = pick_and_place(*words, **options)
    assert result.ok, result.report["alarms"]
    return result.log


def error(log):
    return log["q_cmd"] - log["q_link"]


def tool_error(log):
    X = load_project(ROOT / "programs" / "pick_and_place.rbl").cell.hand.X_flange_tool
    commanded = Kinematics(SPEC).forward(log["q_cmd"]) @ X
    return float(np.linalg.norm(commanded[:, :3, 3] - log["X_world_tool"][:, :3, 3], axis=1).max())


def robot_of(real):
    return {"nominal": SPEC, "heavier": with_errors(SPEC, 8), "reducers": with_reducers(1.6)}[real]


@cache
def found_for(real, axes):
    request = Request(robot=SPEC, axes=axes, real=robot_of(real))
    return compensation_of(request, identify(request))


@pytest.mark.slow
def test_inertia_of_reducers_is_found_and_taken_off_the_tracking_error():
    """60 % more than the rotors of the file: as far as the arm can tell, the model is right again."""
    found = found_for("reducers", tuple(range(6)))
    Jc = np.array([axis.compensation for axis in found.axes])
    np.testing.assert_allclose(Jc, 1.6 * SPEC.per_axis("motor", "rotor_inertia"), rtol=4e-3)
    exact, without, with_it = (
        log_of("nominal"), log_of("reducers"), log_of("reducers", tuple(found.rotors(SPEC)))
    )  # fmt: skip
    rms = [np.sqrt((error(log) ** 2).mean(axis=0)) for log in (exact, without, with_it)]
    assert (rms[2][1:] < 0.7 * rms[1][1:]).all()
    assert (rms[2] < 1.02 * rms[0]).all()
    assert tool_error(with_it) < 0.75 * tool_error(without)


def test_inertia_alone_leaves_the_weight_and_no_wrong_feed_forward():
    """With 5 to 20 % heavier bodies most of the error is their weight, which Jc knows nothing of. J1 carries none: it
    moves as with the exact model again. The largest error of the tool gets smaller."""
    found = found_for("heavier", (0, 1, 2))
    exact, without, with_it = log_of("nominal"), log_of("heavier"), log_of("heavier", tuple(found.rotors(SPEC)))
    ticks = min(len(log["t"]) for log in (exact, without, with_it))
    away = [np.sqrt(((error(log)[:ticks] - error(exact)[:ticks]) ** 2).mean(axis=0)) for log in (without, with_it)]
    assert away[1][0] < 0.6 * away[0][0]
    assert away[1][1] < 0.9 * away[0][1]
    assert tool_error(with_it) < 0.99 * tool_error(without)


@pytest.mark.slow
def test_inertia_and_weight_make_heavier_bodies_run_as_the_model_would():
    """The tool is no farther off its way than with the exact model, and supervision believes the payload again."""
    found = found_for("heavier", (0, 1, 2))
    exact, without, with_it = (
        log_of("nominal"), log_of("heavier"), log_of("heavier", tuple(found.rotors(SPEC)), found.first_moments)
    )  # fmt: skip
    assert tool_error(without) > 1.6 * tool_error(exact)
    assert tool_error(with_it) < 1.02 * tool_error(exact)
    stopped = pick_and_place("heavier", supervised=True)
    assert [alarm["code"] for alarm in stopped.report["alarms"]] == ["RBL517"]
    assert pick_and_place("heavier", tuple(found.rotors(SPEC)), found.first_moments, supervised=True).ok


# --- weight ----------------------------------------------------------------------------------------------------------


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
@pytest.mark.parametrize("robot", ["irb2400", "manutec_r3"])
def test_the_weight_of_other_robots_is_found(robot):
    request, results = experiment(robot=robot, seed=3, axes=tuple(range(6)))
    without, with_it = gravity_errors(request, weight_of(request, results).first_moments)
    assert (with_it[1:3] < without[1:3] / 50.0).all(), (without, with_it)


def test_a_perfect_model_lacks_no_weight():
    request, results = experiment()
    moments = weight_of(request, results).first_moments
    assert (np.linalg.norm(moments, axis=1) < 1e-3 * scale(SPEC) + 1e-9).all(), moments


def test_too_few_places_say_nothing_of_weight():
    request = Request(robot=SPEC, axes=(1,), plant="rigid", positions=2)
    results = identify(request)
    assert weight_of(request, results) is None
    assert compensation_of(request, results).first_moments == ()


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_a_table_is_three_times_better_over_whole_ranges(seed):
    """B5 with a table in place of the constant, 500 postures of which a third is beyond the grid: J1 3 % -> 1.2 %."""
    request, results = experiment(plant="rigid", seed=seed, axes=(0, 1), positions=1, table=5)
    found = compensation_of(request, results)
    postures = np.random.default_rng(1).uniform(SPEC.lower, SPEC.upper, (500, 6))
    rotor = spec_rotors(SPEC)
    errors = []
    for q in postures:
        D, real = (np.diag(ArmModel(spec).mass_matrix(q)) for spec in (SPEC, request.real))
        errors.append([(D + extra) / (real + rotor) - 1.0 for extra in (rotor, found.at(SPEC, q))])
    without, with_it = np.sqrt((np.array(errors) ** 2).mean(axis=0))[:, :2]
    assert (with_it < without / [5.0, 20.0]).all(), without / with_it
