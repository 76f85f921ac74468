"""The order and the memory of supervision: what restarts it, what it counts, and at which bound it speaks."""

import numpy as np
import pytest

from runtime.robot.files.loader import load_builtin
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.load_rules import LoadMode
from runtime.robot.model.payload import Payload
from runtime.settings.supervision import SupervisionLimits
from runtime.supervision.drive_data import DriveData
from runtime.supervision.supervisor import Supervisor
from runtime.supervision.torque_observer import LoadModel, Observer
from tests.messages import numbers

SPEC = load_builtin("puma560")
TORQUE = SPEC.per_axis("limits", "torque")
TICKS, TICK_S = 8, 1e-3
FEWEST, STRIDE, CONFIRMED, SURE = 5, 2, 2, 0.08
"""As numbers, so that a change of the constants of supervision fails here."""
HEAVIER = Payload(mass=2.0, cog=np.array([0.0, 0.0, 0.1]))


def supervisor(model: LoadModel | None = None, **limits) -> Supervisor:
    return Supervisor(
        SPEC,
        SupervisionLimits(**limits),
        DriveData(
            torque=TORQUE, resolution=np.full(6, 1e-9), lag=np.zeros(6), ticks=TICKS, tick_s=TICK_S, friction=0.0
        ),
        model,
    )


def friction(speed: np.ndarray) -> np.ndarray:
    """Return the whole friction of the robot file at speeds (6,) rad/s, N m."""
    forward, backward = np.array([axis.motor.joint_coulomb_friction for axis in SPEC.axes]).T
    dry = np.where(speed > 0.0, forward, backward) * np.tanh(speed / 0.01)
    return dry + SPEC.per_axis("motor", "joint_viscous_friction") * speed


class Swing:
    """An arm that swings with ``carried`` on its flange and follows its command exactly; rows like the recorder's."""

    def __init__(
        self, carried: Payload, mode: LoadMode = "add", *, heavier: float = 1.0, friction: float = 0.0
    ) -> None:
        self._arm = ArmModel(SPEC, rotors=heavier * spec_rotors(SPEC))
        self._arm.set_payload(carried, mode)
        self._friction = friction
        self._rows: list[np.ndarray] = []
        self.tick = 0

    def cycle(self, judge: Supervisor, extra=0.0, axis=0):
        """Return what is found in the next cycle; ``extra`` N m on an axis comes from nothing that is known."""
        for _ in range(TICKS):
            phase = 2.0 * self.tick * TICK_S + np.arange(6)
            amplitude = 0.3 * (self.tick > 0)
            q, dq = amplitude * np.sin(phase), 2.0 * amplitude * np.cos(phase)
            middle = 2.0 * (self.tick + 0.5) * TICK_S + np.arange(6)
            tau = self._arm.torque(
                amplitude * np.sin(middle), 2.0 * amplitude * np.cos(middle), -4.0 * amplitude * np.sin(middle)
            )
            tau = tau + extra * (np.arange(6) == axis) + self._friction * friction(2.0 * amplitude * np.cos(middle))
            self._rows.append(np.concatenate([tau, tau, q, dq]))
            self.tick += 1
        rows = np.array(self._rows[-judge.observer.rows :])
        return judge.judge(rows, rows[-TICKS:, 12:18], rows[-TICKS:, 18:24], self.tick)

    def cycles(self, judge: Supervisor, most: int, extra=0.0, axis=0):
        """Return (finding, cycle) of the first finding in at most ``most`` cycles, or (None, most)."""
        for k in range(most):
            if (found := self.cycle(judge, extra, axis)) is not None:
                return found, k
        return None, most


def test_a_payload_that_is_right_is_never_reported():
    judge, arm = supervisor(), Swing(HEAVIER)
    judge.declare(HEAVIER, "add")
    assert arm.cycles(judge, 120) == (None, 120)


def test_the_arm_is_judged_by_what_is_known_of_it():
    """Friction of the profile, rotors of an identification, a payload in the place of the last link."""
    rough, known = Swing(HEAVIER, friction=1.0), supervisor(friction=1.0)
    heavy, identified = Swing(HEAVIER, heavier=2.0), supervisor(LoadModel(SPEC, 2.0 * spec_rotors(SPEC)))
    placed, replaced = Swing(HEAVIER, "replace"), supervisor()
    for arm, judge, mode in ((rough, known, "add"), (heavy, identified, "add"), (placed, replaced, "replace")):
        judge.declare(HEAVIER, mode)
        assert arm.cycles(judge, 100) == (None, 100)
        other = supervisor()
        other.declare(HEAVIER, "add")
        arm.cycles(other, 3)
        assert 10.0 * np.abs(judge.observer.residual).max() < np.abs(other.observer.residual).max()


def test_a_wrong_payload_stops_and_an_undeclared_one_warns_once():
    arm, judge = Swing(HEAVIER), supervisor()
    found, _ = arm.cycles(judge, 120)
    assert (found.code, found.warning, found.tick, found.axis) == ("RBL517", True, arm.tick - 1, None)
    mass, sigma = judge.observer.estimate()
    assert numbers(found.message) == [pytest.approx(mass, abs=0.006), pytest.approx(sigma, abs=0.006)]
    assert mass == pytest.approx(2.0, abs=0.2)
    assert arm.cycles(judge, 120) == (None, 120)
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(Payload(mass=0.5, cog=np.zeros(3)), "add")
    found, _ = arm.cycles(judge, 120)
    assert (found.code, found.warning) == ("RBL517", False)
    assert numbers(found.message)[0] == 0.5


@pytest.mark.parametrize(("reaction", "expected"), [("warn", True), ("stop", False), ("off", None)])
def test_the_reaction_to_a_wrong_payload_is_that_of_the_profile(reaction, expected):
    arm, judge = Swing(HEAVIER), supervisor(payload_mismatch=reaction)
    judge.declare(Payload(mass=0.5, cog=np.zeros(3)), "add")
    found, _ = arm.cycles(judge, 120)
    assert (None if found is None else found.warning) is expected


@pytest.mark.parametrize("restart", [Supervisor.hand_moves, lambda judge: judge.declare(HEAVIER, "add")])
def test_hand_and_load_begin_the_estimate_anew_and_may_warn_again(restart):
    arm, judge = Swing(HEAVIER), supervisor()
    found, _ = arm.cycles(judge, 120)
    assert found.warning and judge.observer.steps >= FEWEST
    restart(judge)
    assert judge.observer.steps == 0
    judge.declare(Payload(mass=0.2, cog=np.zeros(3)), "add")
    judge.hand_moves()
    again, later = arm.cycles(judge, 120)
    assert again.code == "RBL517"
    # what was weighed before does not count: FEWEST steps, then CONFIRMED estimates in a row, each of two cycles
    assert 2 * STRIDE * (FEWEST + CONFIRMED - 2) < later + 1 <= 2 * STRIDE * (FEWEST + CONFIRMED - 1)


def test_an_unexplained_torque_is_a_collision_after_two_residuals_in_a_row():
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    assert arm.cycles(judge, 8) == (None, 8)  # too few for an estimate of the payload
    found, cycle = arm.cycles(judge, 20, extra=0.5 * TORQUE[0])
    assert (found.code, found.axis, found.tick) == ("RBL516", 0, arm.tick - 1)
    assert 2 * (CONFIRMED - 1) <= cycle <= 2 * CONFIRMED
    bound = 0.2 * TORQUE[0] + 2.0 * judge.observer.sigma[0]
    expected = [1, pytest.approx(0.5 * TORQUE[0], rel=0.01), pytest.approx(bound, abs=0.06)]
    assert numbers(found.message) == expected
    arm, judge = Swing(HEAVIER), supervisor(collision=np.inf, payload_mismatch="off")
    judge.declare(HEAVIER, "add")
    assert arm.cycles(judge, 40, extra=0.5 * TORQUE[0]) == (None, 40)


@pytest.mark.parametrize("axis", [0, 1, 2, 4])
@pytest.mark.parametrize(("share", "found"), [(0.2035, None), (0.2045, "RBL516")])
def test_a_torque_is_unexpected_from_the_share_and_twice_its_uncertainty_on(axis, share, found):
    """20 % of the torque limit, and twice 0.2 % of it."""
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    item, _ = arm.cycles(judge, 16, extra=share * TORQUE[axis], axis=axis)
    assert (item and item.code) == found
    if item:
        assert item.axis == axis
        assert numbers(item.message)[0] == axis + 1


def test_a_torque_that_is_no_number_is_a_collision():
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    assert arm.cycles(judge, 20) == (None, 20)
    judge.watch.cycle = lambda *_: None
    found, _ = arm.cycles(judge, 20, extra=np.nan)
    assert found.code == "RBL516"


@pytest.mark.parametrize("before", [20, 21])
def test_rows_before_an_acknowledgement_no_longer_count(before):
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    arm.cycles(judge, before)
    arm.cycles(judge, 20, extra=0.5 * TORQUE[0])
    judge.restart(arm.tick)
    assert judge.observer.steps == 0
    found, cycle = arm.cycles(judge, 10, extra=5.0 * TORQUE[0])
    assert found.code == "RBL516"
    # a residual covers two cycles and a reading before them; CONFIRMED of them are needed, one every two cycles
    assert 3 + 2 * (CONFIRMED - 1) <= cycle + 1 <= 4 + 2 * (CONFIRMED - 1)


@pytest.mark.parametrize(
    ("oldest_us", "payload_us", "why"),
    [
        (400_000.0, 400_000.0, None),
        (700_000.0, 0.0, "inertia"),
        (400_000.2, 0.0, "inertia"),
        (np.nan, 0.0, "inertia"),
        (0.0, 900_000.0, "LOAD"),
        (0.0, 400_001.0, "LOAD"),
        (0.0, np.nan, "LOAD"),
    ],
)
def test_old_loads_and_a_load_that_does_not_arrive_are_stale(oldest_us, payload_us, why):
    found = supervisor().stale(oldest_us, payload_us, 7)
    if why is None:
        assert found is None
    else:
        assert (found.code, found.tick) == ("RBL521", 7)
        assert why in found.message
        age = [] if np.isnan(oldest_us + payload_us) else [(oldest_us + payload_us) / 1000.0]
        assert numbers(found.message) == [*age, 400.0]  # 400.001 is not printed as 400


def test_late_cycles_warn_first_and_stop_when_they_do_not_end():
    judge = supervisor(overruns=3)
    found = [judge.late(late, k) for k, late in enumerate([True, True, False, True, True, True, True])]
    assert [item and (item.code, item.warning, item.tick) for item in found] == [
        ("RBL520", True, 0),
        None,
        None,
        ("RBL520", True, 3),
        None,
        ("RBL520", False, 5),
        ("RBL520", False, 6),
    ]
    assert judge.was_late
    assert [numbers(item.message) for item in found if item] == [[], [], [3.0], [4.0]]
    judge.late(False, 7)
    assert not judge.was_late


def test_the_first_finding_of_a_cycle_hides_what_follows_from_it():
    judge, arm = supervisor(), Swing(HEAVIER)
    judge.declare(HEAVIER, "add")
    arm.cycles(judge, 20)
    rows = np.array(arm._rows[-judge.observer.rows :])
    command = rows[-TICKS:, 12:18] + 0.1
    found = judge.judge(rows, command, rows[-TICKS:, 18:24], arm.tick)
    assert (found.code, found.tick) == ("RBL511", arm.tick - TICKS)


@pytest.mark.parametrize(("error", "axis"), [(2.9, None), (3.1, 2), (np.nan, 2)])
def test_an_axis_that_loses_its_command_during_a_stop_is_named(error, axis):
    judge, arm = supervisor(), Swing(HEAVIER)
    for _ in range(3):
        arm.cycle(judge)
    rows = np.array(arm._rows[-TICKS:])
    command = rows[:, 12:18].copy()
    judge.watch.cycle(rows, command, np.zeros((TICKS, 6)), 0)
    command[-1, 2] += error * judge.watch.limit[2]
    judge.watch.cycle(rows, command, np.zeros((TICKS, 6)), 0)
    found = judge.watch.lost_track(3.0)
    assert found == axis


def test_of_a_torque_that_a_payload_explains_in_part_the_rest_is_said():
    """A torque on J3 looks like a payload; what that leaves is largest on J2, whose own residual is nothing."""
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    found, _ = arm.cycles(judge, 120, extra=0.1 * TORQUE[2], axis=2)
    assert (found.code, found.axis) == ("RBL516", 1)
    assert abs(judge.observer.residual[1]) < 0.01
    assert abs(numbers(found.message)[1]) > judge.observer.sigma[1]


@pytest.mark.parametrize("axis", [0, 1, 5])
def test_a_torque_that_no_payload_explains_is_named_though_it_is_below_the_collision_limit(axis):
    """A steady torque of 10 % of the axis' limit, half of what a collision takes: no payload has that."""
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    found, _ = arm.cycles(judge, 120, extra=0.1 * TORQUE[axis], axis=axis)
    assert (found.code, found.axis, found.tick, found.warning) == ("RBL516", axis, arm.tick - 1, False)
    leftover = abs(judge.observer.leftover[axis])
    expected = [axis + 1, pytest.approx(judge.observer.unexplained[axis], abs=0.06), pytest.approx(leftover, abs=0.06)]
    assert numbers(found.message) == expected
    assert leftover > 4.0


@pytest.mark.parametrize(("mass", "found"), [(2.0 - 0.43, None), (2.0 - 0.5, "RBL517"), (2.0 + 0.5, "RBL517")])
def test_a_difference_counts_from_the_tolerance_of_the_rated_payload_on(mass, found):
    """17.5 % of 2.5 kg are 0.4375 kg."""
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(Payload(mass=mass, cog=HEAVIER.cog), "add")
    item, _ = arm.cycles(judge, 200)
    assert (None if item is None else item.code) == found


@pytest.mark.parametrize(("share", "weighed"), [(0.019, False), (0.021, True)])
def test_an_arm_that_hardly_moves_is_not_weighed(share, weighed):
    judge = supervisor()
    arm = Swing(HEAVIER)
    judge.watch.cycle = lambda *_: None
    judge.watch.peak[:] = share * SPEC.per_axis("limits", "speed").min()
    arm.cycles(judge, 12)
    assert (judge.observer.steps > 0) is weighed


TOLERANCE = SupervisionLimits().payload_tolerance * SPEC.rated_payload
CLEAR, LARGEST = 2.0, SURE * SPEC.rated_payload
"""A mass that is none of those declared below, kg, and the largest standard deviation that is believed."""


@pytest.mark.parametrize(
    ("declared", "estimates", "needed"),
    [
        (1.0, [(CLEAR, 0.1)] * 2, 2),
        (1.0, [(CLEAR, 0.1), (1.0, 0.1), (CLEAR, 0.1), (CLEAR, 0.1)], 4),  # in a row
        (1.0, [(CLEAR, 0.1), (CLEAR, 1.001 * LARGEST), (CLEAR, 0.1), (CLEAR, LARGEST)], 4),  # what is not sure is not
        (1.0, [(1.0 + TOLERANCE, 0.1)] * 4, None),
        (1.0, [(1.0 + 1.001 * TOLERANCE, 0.1)] * 4, 2),
        (1.0, [(1.0 - 1.001 * TOLERANCE, 0.1)] * 4, 2),
        (None, [(1.2, 0.1)] * 4, 2),
        (None, [(0.9 * TOLERANCE, 0.1)] * 4, None),
    ],
)
def test_two_estimates_in_a_row_that_are_sure_and_off_the_declared_payload_are_a_finding(declared, estimates, needed):
    arm, judge = Swing(HEAVIER), supervisor(collision=np.inf)
    if declared is not None:
        judge.declare(Payload(mass=declared, cog=np.zeros(3)), "add")
    left = list(estimates)
    judge.observer.estimate = lambda: left.pop(0)
    while left and (found := arm.cycle(judge)) is None:
        pass
    assert len(estimates) - len(left) == (needed or len(estimates))
    assert (found is not None) is (needed is not None)
    if found:
        assert (found.code, found.warning) == ("RBL517", declared is None)
        said = numbers(found.message)
        mass, sigma = estimates[needed - 1]
        assert said == [*([] if declared is None else [declared]), pytest.approx(mass, abs=0.006), round(sigma, 2)]
        assert ("LOAD" in found.message) is (declared is None)


@pytest.mark.parametrize(("leftover", "found"), [(3.99, None), (4.01, "RBL516"), (np.nan, "RBL516")])
def test_four_standard_deviations_that_no_payload_explains_are_a_finding(leftover, found, monkeypatch):
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    monkeypatch.setattr(Observer, "leftover", property(lambda _: leftover * (np.arange(6) == 2)))
    item, _ = arm.cycles(judge, 40)
    assert (item and (item.code, item.axis)) == (found and (found, 0 if np.isnan(leftover) else 2))
