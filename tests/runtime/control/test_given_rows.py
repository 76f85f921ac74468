"""Set-points that are given: sent as they are, one in each cycle, where a planned move could have had them."""

import numpy as np
import pytest

from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.units import DEG
from runtime.motion.stop import stopping_rows
from runtime.settings.profile import Profile
from runtime.settings.supervision import SupervisionLimits
from tests.runtime.control.test_controller import CELL, carried_payload, controller, down, signals

SPEC = CELL.robot


def turned(robot: Controller, turn_deg: float, cycles: int = 60, axis: int = 0) -> np.ndarray:
    """A smooth turn of one axis from where the command stands, the last row its end."""
    s = np.arange(1, cycles + 1)[:, None] / cycles
    return robot.areas.ina + s**3 * (10.0 - 15.0 * s + 6.0 * s**2) * (turn_deg * DEG * np.eye(SPEC.n)[axis])


def test_rows_are_sent_from_the_next_cycle_on_and_then_the_command_rests():
    robot = controller()
    rows = turned(robot, 10.0)
    robot.play(rows)
    assert robot.moving
    for _ in rows:
        assert robot.cycle()
    np.testing.assert_array_equal(signals(robot)["q_plan"][::8], rows)
    left = 0
    while robot.moving:
        robot.cycle()
        left += 1
    assert left == 3  # segments that the fine interpolator still plays
    np.testing.assert_allclose(signals(robot)["q_cmd"][-1], rows[-1], atol=1e-15)
    robot.move(down(robot, -0.01))


def test_given_rows_cost_the_dynamics_task_nothing():
    played, idle = (controller(Profile(interpolation_cost_us=5000, axis_cost_us=2500)) for _ in range(2))
    played.play(turned(played, 10.0))
    for robot in (played, idle):
        for _ in range(50):
            robot.cycle()
    assert played.areas.mean_refresh_us == idle.areas.mean_refresh_us


def test_the_rows_belong_to_the_caller_until_they_are_given():
    robot = controller()
    rows = turned(robot, 10.0)
    sent = rows.copy()
    robot.play(rows)
    rows[:] = np.nan
    for _ in rows:
        robot.cycle()
    np.testing.assert_array_equal(signals(robot)["q_plan"][::8], sent)


def test_a_stop_of_given_rows_is_on_their_path_and_within_the_limits():
    robot = controller(Profile(supervision=SupervisionLimits(enabled=False)))
    robot.load(carried_payload())
    rows = turned(robot, 40.0, cycles=120)
    robot.play(rows)
    for _ in range(60):
        robot.cycle()
    limits = SPEC.per_axis("limits", "speed"), SPEC.per_axis("limits", "acceleration")
    path = np.concatenate([signals(robot)["q_plan"][:1], rows])
    expected = stopping_rows(path, 60, robot.drives.fine, *limits)
    robot.alarm("RBL530", "stopped by the test")
    while robot.cycle():
        pass
    np.testing.assert_array_equal(signals(robot)["q_plan"][60 * 8 :: 8][: len(expected)], expected)
    assert robot.halted


@pytest.mark.parametrize(
    ("rows", "what"),
    [
        (np.zeros(6), r"shape \(6,\)"),
        (np.zeros((3, 5)), r"shape \(3, 5\)"),
        (np.zeros((0, 6)), r"shape \(0, 6\)"),
        (np.array([[0.0] * 6, [0.0, 0.0, np.nan, 0.0, 0.0, 0.0]]), "set-point 1 of J3 is nan"),
        (np.array([[np.inf] + [0.0] * 5]), "set-point 0 of J1 is inf"),
    ],
)
@pytest.mark.parametrize("checked", [True, False])
def test_rows_that_are_no_set_points_are_refused(rows, what, checked):
    robot = controller()
    with pytest.raises(ValueError, match=what):
        robot.play(rows, checked)
    assert not robot.moving


@pytest.mark.parametrize(
    ("turn", "cycles", "axis", "code"),
    [
        (10.0, 1, 0, "RBL404"),  # at once
        (60.0, 40, 0, "RBL404"),  # 350 deg/s
        (10.0, 12, 1, "RBL404"),  # its speed would do
        (200.0, 400, 3, "RBL411"),
    ],
)
def test_rows_that_no_planner_would_make_are_refused_and_change_nothing(turn, cycles, axis, code):
    robot = controller()
    rows, ina = turned(robot, turn, cycles, axis), robot.areas.ina
    with pytest.raises(Fault) as fault:
        robot.play(rows)
    assert (fault.value.code, fault.value.message[:2]) == (code, f"J{axis + 1}")
    assert not robot.moving
    assert robot.areas.ina is ina
    robot.play(rows, checked=False)
    assert robot.moving


@pytest.mark.parametrize(("beyond", "refused"), [(-1e-6, False), (1e-8, True)])
def test_the_end_of_a_range_is_the_limit(beyond, refused):
    robot = controller()
    turn = (SPEC.upper[3] - robot.areas.ina[3] + beyond) / DEG
    rows = turned(robot, turn, 400, axis=3)
    if refused:
        with pytest.raises(Fault, match="RBL411"):
            robot.play(rows)
    else:
        robot.play(rows)


def test_a_planned_move_can_be_given_as_rows():
    """What a planner makes passes the check, on its limits as well."""
    planned, given = controller(), controller()
    plan = planned.move(down(planned, -0.18))
    given.play(plan.q[1:])


def test_nothing_is_given_while_something_moves_or_an_alarm_is_latched():
    robot = controller()
    robot.move(down(robot))
    for request in (lambda: robot.play(turned(robot, 1.0)), lambda: robot.jump(robot.areas.ina)):
        with pytest.raises(RuntimeError, match="a move is running"):
            request()
    robot.alarm("RBL530", "stopped by the test")
    with pytest.raises(RuntimeError, match="RBL530 is latched"):
        robot.play(turned(robot, 1.0))


# --- a step of the reference -----------------------------------------------------------------------------------------


def test_a_jump_is_in_the_command_at_once_exactly_and_without_speed():
    robot = controller(Profile(supervision=SupervisionLimits(enabled=False)))
    there = np.array(robot.areas.ina) + 0.01 * np.eye(6)[2] / 3.0
    robot.jump(there)
    for _ in range(5):
        robot.cycle()
    log = signals(robot)
    np.testing.assert_array_equal(log["q_cmd"], np.tile(there, (40, 1)))
    assert not log["dq_cmd"].any()
    assert not robot.moving
    robot.play(turned(robot, 5.0))  # interpolated again, from there
    for _ in range(30):
        robot.cycle()
    assert signals(robot)["dq_cmd"][-1, 0] > 0.1


@pytest.mark.parametrize("bad", [np.nan, 4.0])
def test_a_jump_to_nowhere_is_refused(bad):
    robot = controller()
    q = np.array(robot.areas.ina)
    q[4] = bad
    with pytest.raises(ValueError if np.isnan(bad) else Fault):
        robot.jump(q)
    assert np.isfinite(robot.areas.ina).all()


def test_held_rows_begin_to_stop_in_the_next_cycle_and_what_is_left_can_be_forgotten():
    robot, whole = controller(), controller()
    rows = turned(robot, 10.0)
    for each in (robot, whole):
        each.play(rows)
        for _ in range(30):
            each.cycle()
    robot.hold()
    with pytest.raises(RuntimeError):
        robot.set_aside()
    for each in (robot, robot, whole, whole):
        each.cycle()
    held, goes_on = (signals(each)["q_plan"][::8, 0] for each in (robot, whole))
    assert held[29] == goes_on[29] and held[30] != goes_on[30] and held[31] < goes_on[31]
    while not robot.hold():
        robot.cycle()
    rest = np.array(robot.areas.ina)
    robot.set_aside()
    robot.go_on()  # nothing is left
    robot.cycle()
    assert not robot.moving and (robot.areas.ina == rest).all()
    robot.play(turned(robot, -10.0))
    assert robot.moving


@pytest.mark.parametrize("beyond_deg", [0.0, 0.5])
def test_rows_lead_an_arm_back_from_a_limit_and_not_further_out(beyond_deg):
    robot = controller()
    limit = SPEC.upper[0] + beyond_deg * DEG
    q = np.array(robot.areas.ina)
    q[0] = limit
    robot.areas.ina = q
    robot.drives.fine.hold(q)
    with pytest.raises(Fault) as refused:
        robot.play(turned(robot, 0.01))
    assert refused.value.code == "RBL411"
    robot.play(turned(robot, -10.0))
