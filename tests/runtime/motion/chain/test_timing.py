"""A path timed as a whole: within every limit, in no more time than it needs, against other libraries' optimum."""

import numpy as np
import pytest
import ruckig

from runtime.core.faults import Fault
from runtime.motion.chain.chain_path import derivatives
from runtime.motion.chain.rates import Bounds
from runtime.motion.chain.timing import Limits, Path, timed

H = 0.008
SPEED, ACCELERATION = np.array([2.0, 1.5, 3.0]), np.array([8.0, 6.0, 15.0])


def limits(jerk_s: float = 0.0) -> Limits:
    jerk = ACCELERATION / jerk_s if jerk_s else np.full(3, np.inf)
    return Limits(speed=SPEED, acceleration=ACCELERATION, jerk=jerk, period_s=H)


def path(curve, length: float = 1.0, points: int = 400) -> Path:
    x = np.linspace(0.0, length, points + 1)
    along, across = derivatives(x, curve(x))
    fastest = ((SPEED / np.maximum(np.abs(along), 1e-9)) ** 2).min(axis=1)
    most = np.broadcast_to(ACCELERATION, along.shape)
    return Path(
        x=x, bounds=Bounds(along=along, across=across, beside=0 * along, most=most, fastest=fastest), joints=curve
    )


def wavy(seed: int):
    random = np.random.default_rng(seed)
    waves, size, phase = random.uniform(1.0, 7.0, 3), random.uniform(0.1, 0.6, 3), random.uniform(0.0, 6.0, 3)
    return lambda x: size * np.sin(phase + waves * x[:, None]) + 0.3 * x[:, None]


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("jerk_s", [0.0, 0.1])
def test_every_limit_is_kept_everywhere_and_one_is_reached(seed, jerk_s):
    found = timed(path(wavy(seed)), limits(jerk_s), jerk_s)
    shares = limits(jerk_s).passed(found.setpoints)
    assert max(share.max() for share in shares) <= 1.0 + 1e-9
    assert max(share.max() for share in shares) > 0.97
    passed = (found.setpoints[:-2] + 4.0 * found.setpoints[1:-1] + found.setpoints[2:]) / 6.0
    np.testing.assert_allclose(passed, wavy(seed)(found.x)[1:-1], atol=1e-13)
    np.testing.assert_array_equal(found.q, wavy(seed)(found.x))


@pytest.mark.parametrize("seed", range(12))
def test_without_a_limit_of_jerk_it_takes_hardly_longer_than_the_fastest_of_all(seed):
    """The fastest: the same bounds on a grid ten times as fine, where no cycle has to fit."""
    from runtime.motion.chain.rates import rates
    from runtime.motion.chain.time_law import TimeLaw

    fine = path(wavy(seed), points=4000)
    best = TimeLaw.of(fine.x, rates(fine.x, fine.bounds)).seconds
    found = timed(path(wavy(seed)), limits(), 0.0)
    assert (len(found.x) - 2) * H <= 1.05 * best


@pytest.mark.parametrize("seed", range(12))
def test_a_straight_line_of_the_joints_takes_the_optimum_of_another_library_and_a_cycle(seed):
    random = np.random.default_rng(seed)
    turn = random.uniform(-1.0, 1.0, 3) * 10.0 ** random.uniform(-2.0, 0.3)
    found = timed(path(lambda x: np.outer(x, turn), points=40), limits(0.1), 0.1)
    request = ruckig.InputParameter(1)
    request.target_position = [1.0]
    request.max_velocity = [float((SPEED / np.abs(turn)).min())]
    request.max_acceleration = [float((ACCELERATION / np.abs(turn)).min())]
    request.max_jerk = [float((ACCELERATION / 0.1 / np.abs(turn)).min())]
    trajectory = ruckig.Trajectory(1)
    ruckig.Ruckig(1).calculate(request, trajectory)
    assert trajectory.duration - H <= (len(found.x) - 1) * H <= 1.02 * trajectory.duration + H


def test_a_limit_that_binds_at_one_place_slows_the_motion_there_alone():
    whole = path(lambda x: np.outer(x, [1.0, 0.5, 0.2]), length=2.0)
    slow = whole.bounds.fastest.copy()
    slow[195:205] = 0.01
    narrow = Path(x=whole.x, bounds=whole.bounds.replaced(slow), joints=whole.joints)
    free, held = timed(whole, limits(0.1), 0.1), timed(narrow, limits(0.1), 0.1)
    speeds = np.diff(held.x) / H
    middle = 0.5 * (held.x[:-1] + held.x[1:])
    assert speeds[np.abs(middle - 1.0) < 0.02].max() < 0.11
    far = np.abs(middle - 1.0) > 0.5
    assert speeds[far].max() > 0.99 * (np.diff(free.x) / H).max()


def test_what_the_mean_carries_into_a_slow_place_is_braked_before_it(monkeypatch):
    """Without the room that ``narrow`` makes for it."""
    monkeypatch.setattr("runtime.motion.chain.timing.narrow", lambda x, b, mean_s: b)
    whole = path(lambda x: np.outer(x, [1.0, 0.5, 0.2]), length=2.0)
    slow = whole.bounds.fastest.copy()
    slow[195:205] = 0.01
    found = timed(Path(x=whole.x, bounds=whole.bounds.replaced(slow), joints=whole.joints), limits(0.1), 0.1)
    bounds = np.interp(found.x, whole.x, np.sqrt(slow))
    assert (np.diff(found.x) / H <= np.maximum(bounds[:-1], bounds[1:]) * (1.0 + 1e-6)).all()
    assert len(found.x) * H < 4.0


def test_the_same_path_is_timed_the_same():
    first, second = (timed(path(wavy(3)), limits(0.1), 0.1) for _ in range(2))
    assert first.setpoints.tobytes() == second.setpoints.tobytes()


def test_a_motion_of_hours_is_refused():
    with pytest.raises(Fault, match="RBL404"):
        timed(path(lambda x: np.outer(x, [5000.0, 0.0, 0.0])), limits(), 0.0)


def test_joints_of_nan_are_no_motion():
    whole = path(wavy(1))

    def lost(x):
        q = wavy(1)(x)
        q[len(q) // 2] = np.nan
        return q

    with pytest.raises(Fault, match="RBL404"):
        timed(Path(x=whole.x, bounds=whole.bounds, joints=lost), limits(), 0.0)
