"""The controller on the ideal arm: pipeline, idle budget, gains and what happens when a hand-over goes bad."""

import dataclasses
from collections.abc import Mapping

import numpy as np
import pytest

from robolang.project.project import builtin_cell
from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.program_line import ProgramLine
from runtime.motion.commands import MoveLinear
from runtime.plant.rigid_plant import RigidPlant
from runtime.robot.model.payload import Payload
from runtime.settings.profile import Profile, ServoOptions
from runtime.settings.supervision import SupervisionLimits
from tests.messages import fields

CELL = builtin_cell()
IDEAL = ServoOptions(friction_compensation=0.0)
"""The ideal arm has no friction to compensate."""


def controller(profile: Profile | None = None, plant=None, clock=None, servo: ServoOptions = IDEAL) -> Controller:
    profile = dataclasses.replace(profile or Profile(), servo=dataclasses.replace(servo, friction_compensation=0.0))
    plant = plant or RigidPlant(CELL.robot, CELL, profile.tick_s)
    return Controller(CELL.robot, plant, profile, CELL.hand.X_flange_tool, clock)


def down(robot: Controller, dz: float = -0.1) -> MoveLinear:
    X = robot.tool_poses(np.array(robot.areas.ina))
    X[2, 3] += dz
    return MoveLinear(X_world_tool=X)


def signals(robot: Controller) -> Mapping[str, Array]:
    return robot.signals()


def carried_payload() -> Payload:
    return Payload(mass=CELL.hand.mass, cog=CELL.hand.cog)


def test_a_set_point_is_sent_one_cycle_after_it_was_computed_and_played_one_cycle_later():
    robot = controller()
    plan = robot.move(down(robot))
    for _ in range(5):
        robot.cycle()
    log = signals(robot)
    np.testing.assert_array_equal(log["q_plan"][0], plan.setpoints[0])
    np.testing.assert_array_equal(log["q_plan"][8], plan.setpoints[1])
    np.testing.assert_array_equal(log["q_plan"][16], plan.setpoints[2])
    np.testing.assert_allclose(log["q_cmd"][24], plan.q[1], atol=1e-14)  # cycle 2 plays plan.q[0] to plan.q[1]


def test_the_command_ends_at_rest_exactly_at_the_end_of_the_plan():
    robot = controller()
    plan = robot.move(down(robot))
    while robot.moving:
        robot.cycle()
    log = signals(robot)
    np.testing.assert_array_equal(robot.areas.ina, plan.q[-1])
    np.testing.assert_allclose(log["q_cmd"][-1], plan.q[-1], atol=1e-15)
    assert np.abs(log["dq_cmd"][-1]).max() < 1e-12
    assert robot.recorder.cycle == len(plan.q) - 1 + 4


def test_interpolation_takes_its_time_from_the_dynamics_task():
    robot = controller(Profile(interpolation_cost_us=5000, axis_cost_us=2500))
    robot.load(carried_payload())
    robot.move(down(robot, -0.18))
    while robot.moving:
        robot.cycle()
    moving_ms = robot.areas.mean_refresh_us / 1000.0
    assert moving_ms == pytest.approx(40.0, rel=0.15)  # 6 * 2.5 * 8 / 3
    idle = controller(Profile(interpolation_cost_us=5000, axis_cost_us=2500))
    for _ in range(50):
        idle.cycle()
    assert idle.areas.mean_refresh_us == pytest.approx(15_000)  # nothing to interpolate: 6 * 2.5


@pytest.mark.parametrize("axis_cost_us", [1000, 24_000])
def test_a_set_point_leaves_every_8_ms_whatever_the_background_costs(axis_cost_us):
    robot = controller(Profile(axis_cost_us=axis_cost_us))
    plan = robot.move(down(robot))
    while robot.moving:
        robot.cycle()
    sent = signals(robot)["q_plan"][::8]
    np.testing.assert_array_equal(sent[: len(plan.q)], plan.setpoints)
    assert robot.recorder.tick == 8 * robot.recorder.cycle
    assert robot.overruns == 0


def test_the_brakes_open_onto_the_torque_that_holds_the_arm():
    robot = controller()
    robot.load(carried_payload())
    robot.cycle()
    first = signals(robot)["tau_sat"][0]
    bare = np.array([cell.T for cell in controller().areas.ita])
    np.testing.assert_allclose(first, bare, atol=0.02 * np.abs(bare).max())


@pytest.mark.parametrize("enabled", [True, False])
def test_a_controlled_stop_ends_whether_or_not_supervision_is_on(enabled):
    robot = controller(Profile(supervision=SupervisionLimits(enabled=enabled)))
    robot.load(carried_payload())
    robot.move(down(robot, -0.18))
    for _ in range(30):
        robot.cycle()
    robot.alarm("RBL530", "stopped by the test")
    cycles = 0
    while robot.cycle():
        cycles += 1
        assert cycles < 200
    assert robot.halted
    assert cycles > 5  # it came to rest on its path, not at once


def test_a_starved_task_leaves_old_loads_in_use_and_their_age_shows_it():
    robot = controller(Profile(interpolation_cost_us=8000))
    robot.move(down(robot))
    while robot.moving:
        robot.cycle()
    age = signals(robot)["D_age"]
    assert age.max() > 100.0
    assert np.array_equal(age, signals(robot)["T_age"])


def test_a_right_load_holds_the_arm_still_and_a_missing_one_lets_it_sag():
    still, sagging = (controller(servo=dataclasses.replace(IDEAL, coupling="diagonal")) for _ in range(2))
    still.load(carried_payload())
    for robot in (still, sagging):
        for _ in range(125):
            robot.cycle()
    assert np.degrees(still.position_error) < 0.0005
    kp_kv = CELL.robot.axes[1].bandwidths.position * CELL.robot.axes[1].bandwidths.velocity
    cell = sagging.areas.ita[1]
    missing = still.areas.ita[1].T - cell.T
    inertia = cell.D + CELL.robot.axes[1].motor.reflected_inertia
    droop = (sagging.signals()["q_cmd"] - signals(sagging)["q_fb"])[-1, 1]
    assert droop == pytest.approx(missing / (kp_kv * inertia), rel=0.01)  # docs/servo.md
    assert abs(np.degrees(droop)) > 0.01


@pytest.mark.parametrize("tick_us", [250, 500, 1000])
def test_every_servo_period_follows_the_same_path(tick_us):
    robot = controller(Profile(tick_us=tick_us))
    robot.load(carried_payload())
    robot.move(down(robot))
    worst = 0.0
    while robot.moving:
        robot.cycle()
        worst = max(worst, robot.position_error)
    assert np.degrees(worst) < 0.02


def test_fixed_gains_take_the_middle_of_the_inertia_range():
    robot = controller(servo=ServoOptions(mode="fixed"))
    lows, highs = 1.55, 5.6
    assert lows < robot.servo.held_inertia[0] < highs
    for _ in range(5):
        assert robot.cycle()


def test_a_refused_move_changes_nothing_and_the_next_one_runs():
    robot = controller()
    before = np.array(robot.areas.ina)
    with pytest.raises(Fault, match="RBL410"):
        robot.move(down(robot, -3.0))
    assert not robot.moving
    np.testing.assert_array_equal(robot.areas.ina, before)
    robot.move(down(robot))
    assert robot.moving
    with pytest.raises(RuntimeError):
        robot.move(down(robot))


class BrokenPlant(RigidPlant):
    """An ideal arm whose encoder reading, or whose own state, becomes NaN at a given tick."""

    def __init__(self, at_tick: int, what: str) -> None:
        super().__init__(CELL.robot, CELL)
        self.at_tick, self.what, self.count = at_tick, what, 0

    def step(self, tau: Array) -> bool:
        self.count += 1
        if self.count == self.at_tick and self.what == "state":
            self.dq[2] = np.nan
        ok = super().step(tau)
        if self.count == self.at_tick and self.what == "angle":
            self.q[1] = np.nan
        return ok


@pytest.mark.parametrize(
    ("what", "named", "axis"),
    [
        ("state", "", 2),
        ("angle", "q_fb J2", 1),
    ],
)
def test_a_state_that_is_not_finite_is_caught_in_its_tick_named_and_latched(what, named, axis):
    robot = controller(plant=BrokenPlant(at_tick=21, what=what))
    robot.statement = ProgramLine(line=7, number=70)
    robot.move(down(robot))
    while robot.cycle():
        pass
    (alarm,) = robot.alarms
    assert (alarm.code, alarm.statement, alarm.axis) == ("RBL510", robot.statement, axis)
    assert set(named.split()) <= fields(alarm.message)
    assert alarm.tick == (20 if what == "state" else 21)
    log = signals(robot)
    assert len(log["t"]) == alarm.tick
    assert all(np.isfinite(values).all() for values in log.values())
    assert not robot.cycle()
    assert len(robot.alarms) == 1


@pytest.mark.parametrize(("where", "named"), [("ita", "T ITA J4"), ("ina", "INA J4")])
def test_a_hand_over_that_is_not_finite_is_named(where, named):
    robot = controller()
    robot.cycle()
    if where == "ita":
        robot.processor.advance = lambda until_us: None  # keep the task from mending the cell
        robot.areas.ita[3] = dataclasses.replace(robot.areas.ita[3], T=np.nan)
    else:
        robot.areas.ina = np.array(robot.areas.ina)
        robot.areas.ina[3] = np.nan
    assert not robot.cycle()
    assert robot.alarms[0].code == "RBL510"
    assert set(named.split()) <= fields(robot.alarms[0].message)


class LateClock:
    """A wall clock that says every third cycle started late."""

    def __init__(self) -> None:
        self.calls = 0

    def wait_until(self, t_us: int) -> bool:
        self.calls += 1
        assert t_us == (self.calls - 1) * 8000
        return self.calls % 3 == 0


def test_late_cycles_are_counted_as_overruns():
    robot = controller(clock=LateClock())
    for _ in range(9):
        robot.cycle()
    assert robot.overruns == 3


def test_torque_never_passes_its_limit():
    weak = dataclasses.replace(
        CELL.robot,
        axes=tuple(
            dataclasses.replace(axis, limits=dataclasses.replace(axis.limits, torque=axis.limits.torque * 0.2))
            for axis in CELL.robot.axes
        ),
    )
    plant = RigidPlant(weak, CELL)
    robot = Controller(weak, plant, Profile(servo=IDEAL), CELL.hand.X_flange_tool)
    robot.move(down(robot))
    while robot.moving:
        robot.cycle()
    tau = np.abs(signals(robot)["tau_sat"])
    limit = weak.per_axis("limits", "torque")
    assert (tau <= limit * (1 + 1e-12)).all()
    assert np.isclose(tau.max(axis=0), limit).any()


def test_the_following_error_is_judged_by_the_bandwidth_in_force():
    """Without feed-forward an axis is v / Kp late: 0.27 s at Kp = 3.75, eight times that of the robot file."""
    slow = ServoOptions(velocity_feedforward=0.0, position_bandwidth=(3.75,), velocity_bandwidth=(15.0,))
    robot = controller(servo=slow)
    robot.load(carried_payload())
    robot.move(down(robot, -0.02))
    while robot.moving and robot.cycle():
        pass
    assert robot.alarms == []
