"""The checks by themselves: limits of the file, first tick over a limit, regressor and residual."""

import numpy as np
import pytest

from runtime.profile import parse_profile
from runtime.robot.loader import load_builtin
from runtime.robot.model import ArmModel, spec_rotors
from runtime.robot.payload import Payload
from runtime.supervision.limits import SupervisionLimits
from runtime.supervision.observer import LoadModel, Observer
from runtime.supervision.watch import Watch
from runtime.tomlfile import FileFault, Source, Table
from runtime.units import DEG

SPEC = load_builtin("puma560")
TORQUE = SPEC.per_axis("limits", "torque")
RESOLUTION = np.full(6, 1e-6)


def limits_of(values: dict) -> SupervisionLimits:
    table = Table(Source("x.cell.toml", ""), {"supervision": values}, ("controller",))
    return parse_profile(table).supervision


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
    return Watch(SPEC, SupervisionLimits(), TORQUE, RESOLUTION, np.zeros(6), 8, 1e-3)


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


@pytest.mark.parametrize(("column", "value", "code"), [
    (0, 1.01, "RBL512"), (18, 1.21, "RBL513"), (18, 3.01, "RBL515"), (12, 0.0, "RBL514"),
])  # fmt: skip
def test_excursions_and_saturation(column, value, code):
    rows, q = still()
    axis, one = 1, watch()
    rows[:, column + axis] = {0: value * TORQUE[axis], 18: value * SPEC.axes[axis].limits.speed,
                              12: SPEC.upper[axis] + 1.01 * DEG}[column]  # fmt: skip
    q = rows[:, 12:18]
    found = [one.cycle(rows, q, np.zeros((8, 6)), 8 * k) for k in range(14)]
    first = next(item for item in found if item is not None)
    assert (first.code, first.axis) == (code, axis)
    assert first.tick == (100 if code == "RBL512" else 0)


def test_the_regressor_is_the_derivative_of_the_torque():
    rng = np.random.default_rng(5)
    model, bare = LoadModel(SPEC), ArmModel(SPEC, rotors=spec_rotors(SPEC))
    for _ in range(10):
        q, dq, ddq = rng.uniform(-1, 1, (3, 6))
        model.torque(q, dq, ddq)
        mass, cog = rng.uniform(0.1, 2.0), rng.uniform(-0.1, 0.1, 3)
        same = 0.1 * np.eye(3)  # about the flange, with and without the mass
        bare.set_payload(Payload(mass=1e-12, cog=np.zeros(3), inertia=same))
        without = bare.torque(q, dq, ddq)
        moved = same - mass * ((cog @ cog) * np.eye(3) - np.outer(cog, cog))
        bare.set_payload(Payload(mass=mass, cog=cog, inertia=moved))
        Y = model.regressor(q)
        np.testing.assert_allclose(bare.torque(q, dq, ddq) - without, Y @ [mass, *(mass * cog)], atol=1e-9)


def test_the_residual_of_an_exact_motion_vanishes_and_a_payload_is_weighed():
    observer = Observer(SPEC, SupervisionLimits(), TORQUE, 8, 1e-3, 0.0)
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
