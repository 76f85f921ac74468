"""The order and the memory of supervision: what restarts it, what it counts, and at which bound it speaks."""

import numpy as np
import pytest

from runtime.robot.loader import load_builtin
from runtime.robot.model import ArmModel, spec_rotors
from runtime.robot.payload import Payload
from runtime.supervision.limits import SupervisionLimits
from runtime.supervision.observer import FEWEST, STRIDE
from runtime.supervision.supervisor import CONFIRMED, Supervisor
from tests.runtime.supervision.test_supervision import numbers

SPEC = load_builtin("puma560")
TORQUE = SPEC.per_axis("limits", "torque")
TICKS, TICK_S = 8, 1e-3
HEAVIER = Payload(mass=2.0, cog=np.array([0.0, 0.0, 0.1]))


def supervisor(**limits) -> Supervisor:
    return Supervisor(SPEC, SupervisionLimits(**limits), torque=TORQUE, resolution=np.full(6, 1e-9), lag=np.zeros(6),
                      ticks=TICKS, tick_s=TICK_S, friction=0.0)  # fmt: skip


class Swing:
    """An arm that swings with ``carried`` on its flange and follows its command exactly; rows like the recorder's."""

    def __init__(self, carried: Payload) -> None:
        self._arm = ArmModel(SPEC, rotors=spec_rotors(SPEC))
        self._arm.set_payload(carried)
        self._rows: list[np.ndarray] = []
        self.tick = 0

    def cycle(self, judge: Supervisor, extra=0.0):
        """Return what is found in the next cycle; ``extra`` N m on J1 comes from nothing that is known."""
        for _ in range(TICKS):
            phase = 2.0 * self.tick * TICK_S + np.arange(6)
            amplitude = 0.3 * (self.tick > 0)
            q, dq = amplitude * np.sin(phase), 2.0 * amplitude * np.cos(phase)
            middle = 2.0 * (self.tick + 0.5) * TICK_S + np.arange(6)
            tau = self._arm.torque(amplitude * np.sin(middle), 2.0 * amplitude * np.cos(middle),
                                   -4.0 * amplitude * np.sin(middle))  # fmt: skip
            tau = tau + extra * (np.arange(6) == 0)
            self._rows.append(np.concatenate([tau, tau, q, dq]))
            self.tick += 1
        rows = np.array(self._rows[-judge.observer.rows :])
        return judge.judge(rows, rows[-TICKS:, 12:18], rows[-TICKS:, 18:24], self.tick)

    def cycles(self, judge: Supervisor, most: int, extra=0.0):
        """Return (finding, cycle) of the first finding in at most ``most`` cycles, or (None, most)."""
        for k in range(most):
            if (found := self.cycle(judge, extra)) is not None:
                return found, k
        return None, most


def test_a_payload_that_is_right_is_never_reported():
    judge, arm = supervisor(), Swing(HEAVIER)
    judge.declare(HEAVIER, "add")
    assert arm.cycles(judge, 120) == (None, 120)


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
    assert 2 * STRIDE * (FEWEST + CONFIRMED - 2) < later + 1 <= 2 * STRIDE * (FEWEST + CONFIRMED)


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


def test_a_torque_that_is_no_number_is_a_collision():
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    assert arm.cycles(judge, 20) == (None, 20)
    judge.watch.cycle = lambda *_: None
    found, _ = arm.cycles(judge, 20, extra=np.nan)
    assert found.code == "RBL516"


def test_rows_before_an_acknowledgement_no_longer_count():
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    arm.cycles(judge, 20)
    arm.cycles(judge, 20, extra=0.5 * TORQUE[0])
    judge.restart(arm.tick)
    assert judge.observer.steps == 0
    first, second = (arm.cycle(judge, extra=5.0 * TORQUE[0]) for _ in range(2))
    assert (first, second) == (None, None)  # a residual covers two cycles, and two of them are needed
    assert arm.cycles(judge, 6, extra=5.0 * TORQUE[0])[0].code == "RBL516"


@pytest.mark.parametrize(
    ("oldest_us", "payload_us", "why"),
    [
        (400_000.0, 400_000.0, None),
        (700_000.0, 0.0, "inertia"),
        (400_001.0, 0.0, "inertia"),
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
        ("RBL520", True, 0), None, None, ("RBL520", True, 3), None, ("RBL520", False, 5), ("RBL520", False, 6),
    ]  # fmt: skip
    assert judge.was_late
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


def test_a_torque_that_no_payload_explains_is_named_though_it_is_below_the_collision_limit():
    """A steady torque on J1 of 10 % of its limit, half of what a collision takes: no payload has that."""
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(HEAVIER, "add")
    found, _ = arm.cycles(judge, 120, extra=0.1 * TORQUE[0])
    assert (found.code, found.axis, found.tick, found.warning) == ("RBL516", 0, arm.tick - 1, False)
    leftover = abs(judge.observer.leftover[0])
    expected = [1, pytest.approx(judge.observer.residual[0], abs=0.06), pytest.approx(leftover, abs=0.06)]
    assert numbers(found.message) == expected
    assert leftover > 4.0


@pytest.mark.parametrize(("mass", "found"), [(2.0 - 0.43, None), (2.0 - 0.5, "RBL517"), (2.0 + 0.5, "RBL517")])
def test_a_difference_counts_from_the_tolerance_of_the_rated_payload_on(mass, found):
    """17.5 % of 2.5 kg are 0.4375 kg."""
    arm, judge = Swing(HEAVIER), supervisor()
    judge.declare(Payload(mass=mass, cog=HEAVIER.cog), "add")
    item, _ = arm.cycles(judge, 200)
    assert (None if item is None else item.code) == found


def test_an_arm_that_hardly_moves_is_not_weighed():
    judge = supervisor()
    arm = Swing(HEAVIER)
    judge.watch.cycle = lambda *_: None
    judge.watch.peak[:] = 0.019 * SPEC.per_axis("limits", "speed").min()
    assert arm.cycles(judge, 60) == (None, 60)
    assert judge.observer.steps == 0
