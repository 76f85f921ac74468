"""The checks by themselves: limits of the file, first tick over a limit, regressor and residual."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.core.frames import pose, rotation_about
from runtime.core.tomlfile import FileFault, Source, Table
from runtime.core.units import DEG
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from runtime.settings.layers import read_layer, settle
from runtime.settings.supervision import SupervisionLimits
from runtime.supervision.drive_data import DriveData
from runtime.supervision.tick_monitor import Watch
from runtime.supervision.torque_observer import LoadModel, Observer
from tests.messages import numbers

SPEC = load_builtin("puma560")
TORQUE = SPEC.per_axis("limits", "torque")
RESOLUTION = np.full(6, 1e-6)
COG, FEWEST, MEMORY, TURNING = 0.1, 5, 12, 0.05
"""As numbers, so that a change of the constants of the observer fails here."""


def drives(lag: np.ndarray | None = None, friction: float = 0.0) -> DriveData:
    return DriveData(
        torque=TORQUE,
        resolution=RESOLUTION,
        lag=np.zeros(6) if lag is None else lag,
        ticks=8,
        tick_s=1e-3,
        friction=friction,
    )


def limits_of(values: dict) -> SupervisionLimits:
    table = Table(Source("x.cell.toml", ""), {"supervision": values}, ("controller",))
    return settle(read_layer(table)).profile.supervision


def test_an_empty_table_gives_the_defaults_and_every_key_is_read():
    assert limits_of({}) == SupervisionLimits()
    limits = limits_of({"collision": 0, "payload_mismatch": "off", "friction": 1, "overruns": 7, "enabled": False})
    assert (limits.collision, limits.payload_mismatch, limits.friction, limits.overruns) == (np.inf, "off", 1.0, 7)
    assert not limits.enabled


@pytest.mark.parametrize(
    "values", [{"payload_mismatch": "maybe"}, {"following_error_deg": 0}, {"friction": -1.0}, {"unknown": 1}]
)
def test_wrong_keys_are_refused(values):
    with pytest.raises(FileFault):
        limits_of(values)


def watch() -> Watch:
    return Watch(SPEC, SupervisionLimits(), drives())


def still() -> tuple[np.ndarray, np.ndarray]:
    """Return rows (8, 24) and commands (8, 6) of an arm that stands in the middle of its ranges."""
    q = np.tile((SPEC.lower + SPEC.upper) / 2.0, (8, 1))
    return np.hstack([np.zeros((8, 12)), q, np.zeros((8, 6))]), q


@pytest.mark.parametrize("value", [1.001 * DEG, -1.001 * DEG, np.nan])
def test_a_following_error_is_named_at_the_first_tick_over_the_limit(value):
    rows, q = still()
    assert watch().cycle(rows, q, np.zeros((8, 6)), 100) is None
    rows[5:, 12 + 3] -= value
    found = watch().cycle(rows, q, np.zeros((8, 6)), 100)
    assert (found.code, found.tick, found.axis) == ("RBL511" if value == value else "RBL514", 105, 3)


def test_the_following_error_may_grow_with_the_commanded_speed_and_the_limit_decays():
    rows, q = still()
    rows[:, 12 + 3] -= 1.5 * DEG
    speed = np.zeros((8, 6))
    one = watch()
    speed[0, 3] = 0.6 * DEG / SupervisionLimits().following_lag
    rows[:, 18 + 3] = speed[0, 3]
    assert one.cycle(rows, q, speed, 0) is None
    found = [one.cycle(rows, q, np.zeros((8, 6)), 8 * k) for k in range(1, 5)]
    assert found[0] is None
    assert found[3].code == "RBL511"


@pytest.mark.parametrize(
    ("column", "value", "code"),
    [
        (0, 1.01, "RBL512"),
        (18, 1.21, "RBL513"),
        (18, 3.01, "RBL515"),
        (12, 0.0, "RBL514"),
    ],
)
def test_excursions_and_saturation(column, value, code):
    rows, q = still()
    axis, one = 1, watch()
    rows[:, column + axis] = {
        0: value * TORQUE[axis],
        18: value * SPEC.axes[axis].limits.speed,
        12: SPEC.upper[axis] + 1.01 * DEG,
    }[column]
    q = rows[:, 12:18]
    found = [one.cycle(rows, q, np.zeros((8, 6)), 8 * k) for k in range(14)]
    first = next(item for item in found if item is not None)
    assert (first.code, first.axis) == (code, axis)
    assert first.tick == (100 if code == "RBL512" else 0)


@pytest.mark.parametrize("flange", [np.eye(4), pose([0.1, -0.2, 0.3], rotation_about(np.array([0.6, 0.8, 0.0]), 1.0))])
def test_the_regressor_is_the_derivative_of_the_torque(flange):
    rng = np.random.default_rng(5)
    spec = replace(SPEC, X_last_flange=flange)
    model, bare = LoadModel(spec), ArmModel(spec, rotors=spec_rotors(spec))
    for _ in range(10):
        q, dq, ddq = rng.uniform(-1, 1, (3, 6))
        model.torque(q, dq, ddq)
        mass, cog = rng.uniform(0.1, 2.0), rng.uniform(-0.1, 0.1, 3)
        same = np.eye(3)  # about the last joint's frame, with and without the mass
        bare.set_payload(Payload(mass=1e-12, cog=np.zeros(3), inertia=same))
        without = bare.torque(q, dq, ddq)
        R, p = flange[:3, :3], flange[:3, 3]
        r = p + R @ cog
        moved = R.T @ (same - mass * ((r @ r) * np.eye(3) - np.outer(r, r))) @ R
        bare.set_payload(Payload(mass=mass, cog=cog, inertia=moved))
        Y = model.regressor(q)
        np.testing.assert_allclose(bare.torque(q, dq, ddq) - without, Y @ [mass, *(mass * cog)], atol=1e-9)


def test_the_residual_of_an_exact_motion_vanishes_and_a_payload_is_weighed():
    observer = Observer(SPEC, SupervisionLimits(), drives())
    carried = ArmModel(SPEC, rotors=spec_rotors(SPEC))
    carried.set_payload(Payload(mass=1.3, cog=np.array([0.0, 0.0, 0.05])))
    t = np.arange(17)[:, None] * 1e-3
    for k in range(30):
        phase = np.arange(6) + 0.1 * k + t
        q, dq, ddq = 0.5 * np.sin(phase), 0.5 * np.cos(phase), -0.5 * np.sin(phase)
        for model, expected in ((ArmModel(SPEC, rotors=spec_rotors(SPEC)), 0.0), (carried, 1.3)):
            tau = np.array([model.torque(*row) for row in zip(q, dq, ddq, strict=True)])
            observer.update(0.5 * (tau + np.roll(tau, -1, axis=0)), q)
            if expected == 0.0:
                assert np.abs(observer.residual).max() < 2e-3
            else:
                observer.learn()
    mass, sigma = observer.estimate()
    assert mass == pytest.approx(1.3, abs=0.02)
    assert 0.0 < sigma < 0.1


# --- one cycle after another through the watch ------------------------------------------------------------------------


def turning(speed: float, axis: int = 3) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return rows (8, 24) and commands (8, 6) twice of an axis that turns evenly and is followed exactly, rad/s."""
    rows, q = still()
    dq = np.zeros((8, 6))
    dq[:, axis] = speed
    rows[:, 18 + axis] = speed
    return rows, q, dq


def judged(cycles, one: Watch | None = None):
    """Judge cycles one after another; return the first finding."""
    one = one or watch()
    found = (one.cycle(rows, q, dq, 8 * k) for k, (rows, q, dq) in enumerate(cycles))
    return next((item for item in found if item is not None), None)


@pytest.mark.parametrize("axis", [0, 3, 5])
def test_a_reading_that_jumps_is_an_encoder_that_jumped_and_by_how_much_is_said(axis):
    limit = SPEC.axes[axis].limits.speed
    rows, q, dq = turning(0.0, axis)
    rows[6, 18 + axis] = -3.001 * limit
    found = judged([(rows, q, dq)])
    assert (found.code, found.axis, found.tick) == ("RBL515", axis, 6)
    assert numbers(found.message) == [axis + 1, pytest.approx(3.001 * limit * 1e-3 / DEG, abs=1e-3)]
    rows[6, 18 + axis] = 2.999 * limit
    found = judged([(rows, q, dq)])
    assert (found.code, found.axis, found.tick) == ("RBL513", axis, 6)


@pytest.mark.parametrize(
    ("column", "code", "value", "bound"),
    [
        (
            18,
            "RBL513",
            lambda axis: 1.21 * SPEC.axes[axis].limits.speed,
            lambda axis: 1.2 * SPEC.axes[axis].limits.speed,
        ),
        (
            12,
            "RBL514",
            lambda axis: SPEC.upper[axis] + 1.5 * DEG,
            lambda axis: (SPEC.upper[axis] - SPEC.lower[axis]) / 2.0 + DEG,
        ),
    ],
)
@pytest.mark.parametrize("axis", [0, 1, 4])
def test_an_excursion_is_said_with_its_axis_value_and_limit(axis, column, code, value, bound):
    rows, _ = still()
    rows[3:, column + axis] = value(axis)
    found = judged([(rows, rows[:, 12:18], np.zeros((8, 6)))])
    assert (found.code, found.axis, found.tick) == (code, axis, 3)
    middle = (SPEC.upper[axis] + SPEC.lower[axis]) / 2.0 if column == 12 else 0.0
    assert numbers(found.message) == [
        axis + 1,
        pytest.approx((value(axis) - middle) / DEG, abs=0.006),
        pytest.approx(bound(axis) / DEG, abs=0.006),
    ]


def test_a_following_error_is_said_with_its_axis_its_limit_and_the_speed():
    rows, q, dq = turning(1.0, 3)
    rows[:, 12 + 2] -= 1.02 * DEG
    rows[:, 12 + 3] -= 3.0 * DEG  # 1 deg and 20 ms at 1 rad/s are allowed: 2.146 deg
    found = judged([(rows, q, dq)])
    # the axis that is furthest over its own limit: 3.0 / 2.146 is more than 1.02 / 1
    assert (found.code, found.axis, found.tick) == ("RBL511", 3, 0)
    limit = 1.0 + SupervisionLimits().following_lag / DEG
    expected = [4, 3.0, pytest.approx(limit, abs=1e-3), pytest.approx(1.0 / DEG, abs=0.06)]
    assert numbers(found.message) == expected


def test_the_axis_that_is_furthest_over_its_own_limit_is_named():
    rows, q, dq = turning(1.0, 3)
    rows[:, 12 + 2] -= 2.5 * DEG  # 2.5 times its limit of 1 deg
    rows[:, 12 + 3] -= 3.0 * DEG  # of 2.146 deg
    assert judged([(rows, q, dq)]).axis == 2


def test_saturation_is_said_with_its_axis_and_torques_and_counts_ticks_in_a_row():
    rows, q = still()
    rows[:, 2] = 1.5 * TORQUE[2]
    calm, one = still()[0], watch()
    nothing = np.zeros((8, 6))
    assert judged([(rows, q, nothing)] * 12, one) is None  # 96 ms
    assert judged([(calm, q, nothing)], one) is None
    assert judged([(rows, q, nothing)] * 12, one) is None  # counted anew
    found = judged([(rows, q, nothing)], one)
    assert (found.code, found.axis, found.tick) == ("RBL512", 2, 4)  # the 101st tick
    expected = [3, pytest.approx(TORQUE[2], abs=0.06), pytest.approx(1.5 * TORQUE[2], abs=0.06), 100.0]
    assert numbers(found.message) == expected
    part = calm.copy()
    part[:4, 2] = 1.5 * TORQUE[2]
    one = watch()
    assert judged([(rows, q, nothing)] * 11 + [(part, q, nothing)] + [(rows, q, nothing)] * 12, one) is None
    assert judged([(rows, q, nothing)], one).tick == 4  # the 101st tick after the four within the limit


def test_a_drive_may_give_its_whole_torque_for_ever():
    rows, q = still()
    rows[:, :12] = np.tile(TORQUE, 2)
    assert judged([(rows, q, np.zeros((8, 6)))] * 20) is None


def test_a_cycle_at_the_whole_torque_is_one_in_which_all_is_well():
    whole = turning(FAST)
    whole[0][:, :12] = np.tile(TORQUE, 2)
    lost = catching_up(range(2, 3))
    assert judged([lost, whole, lost]) is None


FAST = 2.0 * 100.0 * 1e-6 / 1e-3
"""Twice the speed from which a reading that does not change is wrong, rad/s: 100 steps of 1e-6 rad a tick."""


def frozen(ticks: range, speed: float = FAST, axis: int = 3):
    """Return a cycle whose encoder repeats its reading in some ticks, and catches up after them."""
    rows, q, dq = turning(speed, axis)
    for tick in ticks:
        rows[tick, 18 + axis] = 0.0
    return rows, q, dq


def catching_up(ticks: range, after: float = 2.0):
    rows, q, dq = frozen(ticks)
    rows[ticks.stop, 18 + 3] = after * FAST
    return rows, q, dq


def test_an_encoder_that_stands_while_the_command_turns_is_stuck_after_24_ms():
    stands = frozen(range(8))
    found = judged([stands] * 4)
    assert (found.code, found.axis, found.tick) == ("RBL515", 3, 23)
    assert numbers(found.message) == [4, 24.0]
    assert judged([frozen(range(8), speed=0.49 * FAST)] * 6) is None  # below 100 steps a tick nothing is known
    assert judged([frozen(range(8), speed=0.51 * FAST)] * 6).code == "RBL515"
    moves = turning(FAST)
    assert judged([stands, stands, frozen(range(7)), stands, stands, moves]) is None  # 23 ticks, then a reading


@pytest.mark.parametrize("axis", range(6))
def test_an_encoder_that_moves_by_one_step_a_tick_does_not_stand(axis):
    """However fast the axis should turn: a drive that is too weak is no fault of the encoder."""
    rows, q, dq = turning(SPEC.axes[axis].limits.speed, axis)
    rows[:, 18 + axis] = RESOLUTION[axis] / 1e-3
    assert judged([(rows, q, dq)] * 12) is None


def test_a_reading_that_is_lost_twice_is_an_encoder_that_loses_samples():
    lost = catching_up(range(2, 3))
    found = judged([lost, turning(FAST), lost])
    assert found is None  # between them everything was well for a cycle: they are counted anew
    assert judged([catching_up(range(2, 3), 1.41)] * 2).code == "RBL515"
    found = judged([lost, lost])
    assert (found.code, found.axis, found.tick) == ("RBL515", 3, 11)
    assert numbers(found.message) == [4]


@pytest.mark.parametrize("after", [1.39, 1.0])
def test_a_reading_after_which_nothing_catches_up_is_no_lost_sample(after):
    assert judged([catching_up(range(2, 3), after)] * 4) is None


def test_an_encoder_that_has_stood_too_long_is_not_a_lost_sample():
    """An axis that starts again after a stand is not one whose samples are lost."""
    one = watch()
    one._longest_stand = 6
    long = catching_up(range(1, 7))
    found = judged([long], one)
    assert (found.code, found.tick) == ("RBL515", 6)


def test_what_was_counted_is_forgotten_when_all_is_well_for_a_cycle():
    stands, moves = frozen(range(8)), turning(FAST)
    assert judged([stands, stands, moves, stands, stands, moves, stands, stands]) is None


def test_the_peak_and_the_held_speed_are_those_of_the_command():
    rows, q, dq = turning(-0.5)
    one = watch()
    one.cycle(rows, q, dq, 0)
    assert one.peak[3] == one.speed[3] == 0.5
    calm, q = still()
    one.cycle(calm, q, np.zeros((8, 6)), 8)
    assert one.peak[3] == 0.0
    assert one.speed[3] == pytest.approx(0.5 * np.exp(-0.008 / 0.1))


def test_a_lagging_servo_may_lag_and_stand_for_longer():
    lag = np.full(6, 0.05)
    one = Watch(SPEC, SupervisionLimits(), drives(lag=lag))
    rows, q, dq = turning(0.5)
    rows[:, 12 + 3] -= (1.0 * DEG + 0.5 * (0.02 + 0.05)) * 0.999
    assert judged([(rows, q, dq)], one) is None
    found = judged([frozen(range(8))] * 12, Watch(SPEC, SupervisionLimits(), drives(lag=lag)))
    assert (found.code, found.tick) == ("RBL515", 73)  # 24 ms and 50 ms


# --- the estimate -----------------------------------------------------------------------------------------------------


def test_what_was_weighed_is_forgotten_with_a_new_declaration():
    observer = Observer(SPEC, SupervisionLimits(), drives())
    observer.residual[:] = 1.0
    for _ in range(6):
        observer.learn()
    assert observer.steps == 6 and np.abs(observer.leftover).max() > 0.0
    observer.declare(Payload(mass=0.7, cog=np.array([0.0, 0.0, 0.1])), "add")
    assert observer.steps == 0 and np.abs(observer.leftover).max() == 0.0
    mass, sigma = observer.estimate()
    assert mass == 0.7  # nothing weighed: what was declared, as uncertain as the rated payload
    assert sigma == pytest.approx(SPEC.rated_payload)


def spin(speed, acceleration=0.0, q=0.3):
    """Return readings (17, 6) of joints that turn evenly, or ever faster, through q in the middle of two cycles."""
    t = np.arange(-8, 9)[:, None] * 1e-3
    return q + np.asarray(speed) * t + 0.5 * np.asarray(acceleration) * t**2


def test_an_identified_arm_is_judged_by_its_own_rotors_and_first_moments():
    rotors, first_moments = 1.3 * spec_rotors(SPEC), np.random.default_rng(3).normal(size=(6, 3))
    model, arm = LoadModel(SPEC, rotors, first_moments), ArmModel(SPEC, rotors=rotors, first_moments=first_moments)
    q, dq, ddq = np.random.default_rng(4).uniform(-1, 1, (3, 6))
    np.testing.assert_array_equal(model.torque(q, dq, ddq), arm.torque(q, dq, ddq))
    observer = Observer(SPEC, SupervisionLimits(), drives(), model)
    observer.update(np.tile(arm.torque(np.full(6, 0.3), dq, ddq), (17, 1)), spin(dq, ddq))
    np.testing.assert_allclose(observer.residual, 0.0, atol=1e-6)


@pytest.mark.parametrize("mode", ["add", "replace"])
def test_the_declared_payload_is_on_the_last_link_or_in_its_place(mode):
    payload, arm = Payload(mass=1.5, cog=np.array([0.1, 0.0, 0.1])), ArmModel(SPEC, rotors=spec_rotors(SPEC))
    observer = Observer(SPEC, SupervisionLimits(), drives())
    observer.declare(payload, mode)
    arm.set_payload(payload, mode)
    observer.update(np.tile(arm.gravity(np.full(6, 0.3)), (17, 1)), spin(np.zeros(6)))
    np.testing.assert_allclose(observer.residual, 0.0, atol=1e-9)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("direction", [np.ones(6), -np.ones(6), np.array([1, -1, 1, -1, 1, -1])])
def test_friction_of_an_even_motion_leaves_no_residual_and_is_known_to_its_share(share, direction):
    speed = 0.5 * direction
    motors = [axis.motor for axis in SPEC.axes]
    forward, backward = np.array([motor.joint_coulomb_friction for motor in motors]).T
    dry = np.where(speed > 0.0, forward, -backward)
    friction = share * (dry + SPEC.per_axis("motor", "joint_viscous_friction") * speed)
    arm, limits = ArmModel(SPEC, rotors=spec_rotors(SPEC)), SupervisionLimits()
    observer = Observer(SPEC, limits, drives(friction=share))
    observer.update(np.tile(arm.torque(np.full(6, 0.3), speed, np.zeros(6)) + friction, (17, 1)), spin(speed))
    np.testing.assert_allclose(observer.residual, 0.0, atol=1e-6)
    known = limits.torque_uncertainty * TORQUE + limits.friction_uncertainty * np.abs(friction)
    np.testing.assert_allclose(observer.sigma, known, rtol=1e-6)


@pytest.mark.parametrize(
    ("speed", "rests"),
    [(0.0, True), (0.99 * TURNING, True), (-0.99 * TURNING, True), (1.01 * TURNING, False), (-1.01 * TURNING, False)],
)
def test_near_rest_the_dry_friction_may_have_any_of_its_values(speed, rests):
    limits = SupervisionLimits()
    observer = Observer(SPEC, limits, drives(friction=0.5))
    observer.update(np.zeros((17, 6)), spin(np.full(6, speed)))
    dry = 0.5 * np.array([max(axis.motor.joint_coulomb_friction) for axis in SPEC.axes])
    resting = limits.torque_uncertainty * TORQUE + dry
    assert (observer.sigma == pytest.approx(resting)) is rests
    assert (observer.sigma <= resting * (1.0 + 1e-12)).all()


def test_the_sign_of_the_friction_fades_out_towards_standing():
    """At 0.01 rad/s it is tanh 1 of what it is in motion: no step where an axis turns back."""
    one, other = (Observer(SPEC, SupervisionLimits(), drives(friction=share)) for share in (0.0, 1.0))
    for each in (one, other):
        each.update(np.zeros((17, 6)), spin(np.full(6, 0.01)))
    forward = np.array([axis.motor.joint_coulomb_friction[0] for axis in SPEC.axes])
    expected = np.tanh(1.0) * forward + 0.01 * SPEC.per_axis("motor", "joint_viscous_friction")
    np.testing.assert_allclose(one.residual - other.residual, expected, rtol=1e-6)


def test_the_estimate_is_the_least_squares_of_the_last_steps_and_what_is_known_before_them():
    """Against NumPy: every axis a row that weighs 1 / sigma, each step 1 / 12 of its mean, and the two priors."""
    declared = Payload(mass=0.7, cog=np.array([0.02, -0.04, 0.1]))
    observer, model = Observer(SPEC, SupervisionLimits(), drives(friction=0.5)), LoadModel(SPEC)
    observer.declare(declared, "add")
    model.set_payload(declared, "add")
    rated = SPEC.rated_payload
    prior = np.vstack([[1.0, 0, 0, 0], np.column_stack([-declared.cog, np.eye(3)]) / COG]) / rated
    random, shares, steps, leftover = np.random.default_rng(8), np.zeros(0), [], np.zeros(6)
    for step in range(1, MEMORY + 4):
        q, dq, ddq = random.uniform(-1, 1, (3, 6))
        observer.update(random.normal(size=(17, 6)) * TORQUE / 10.0, spin(dq, ddq, q))
        observer.learn()
        model.torque(q, dq, ddq)
        steps.append((model.regressor(q) / observer.sigma[:, None], observer.residual / observer.sigma))
        share = 1.0 / min(step, MEMORY)
        shares = np.append(shares * (1.0 - share), share)
        weights = np.sqrt(shares)
        rows = np.vstack([prior, *(w * Y for w, (Y, _) in zip(weights, steps, strict=True))])
        seen = np.concatenate([np.zeros(4), *(w * r for w, (_, r) in zip(weights, steps, strict=True))])
        difference = np.linalg.lstsq(rows, seen, rcond=None)[0]
        mass, sigma = observer.estimate()
        assert mass == pytest.approx(declared.mass + difference[0], rel=1e-6)
        assert sigma == pytest.approx(np.sqrt(np.linalg.inv(rows.T @ rows)[0, 0]), rel=1e-6)
        if step >= FEWEST:
            Y, r = steps[-1]
            rest = r - Y @ difference
            leftover += share * (rest - leftover)
            np.testing.assert_allclose(observer.unexplained, observer.sigma * rest, rtol=1e-5, atol=1e-9)
        np.testing.assert_allclose(observer.leftover, leftover, rtol=1e-5, atol=1e-9)
