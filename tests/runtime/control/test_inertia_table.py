"""A table of compensation in the running controller: D that is published follows it, from power-up on."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.dynamics.equations import axis_inertia
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.joint_table import JointTable
from runtime.settings.profile import Profile
from tests.runtime.control.test_controller import CELL, IDEAL, carried_payload, controller, down, signals

TABLE = JointTable(
    joints=(1, 2), grid=((-2.0, 0.0, 3.0), (-4.0, 0.0, 2.0)), values=(0.1, 0.5, -0.2, -0.3, 0.4, 0.2, 0.0, -0.1, 0.3)
)
WITH_TABLE = replace(IDEAL, rotors=tuple(spec_rotors(CELL.robot)), rotor_tables=(TABLE, *(None,) * 5))


def published(robot):
    return np.array([cell.D for cell in robot.areas.ita])


def expected(q, payload=None):
    model = ArmModel(CELL.robot)
    if payload is not None:
        model.set_payload(payload)
    D = np.array([axis_inertia(model, q, axis) for axis in range(6)])
    return D + np.array([TABLE.at(q), *[0.0] * 5])


def test_the_first_cells_have_the_table_and_the_task_goes_on_from_them():
    robot = controller(servo=WITH_TABLE)
    np.testing.assert_array_equal(published(robot), expected(CELL.home))
    first = published(robot)
    for _ in range(3):
        robot.cycle()
    np.testing.assert_allclose(published(robot), first, atol=2e-3)  # the hand is not declared: it sags


@pytest.mark.parametrize("source", ["pass", "recursion", "matrix"])
def test_the_published_inertia_follows_the_table(source):
    robot = controller(Profile(inertia_source=source), servo=WITH_TABLE)
    robot.load(carried_payload())
    for _ in range(3):
        robot.cycle()
    before = TABLE.at(robot.servo.alpha)
    robot.move(down(robot))
    while robot.moving:
        assert robot.cycle(), robot.alarms
    for _ in range(40):
        assert robot.cycle(), robot.alarms
    assert abs(TABLE.at(robot.servo.alpha) - before) > 0.01  # it moved over the table
    np.testing.assert_allclose(published(robot), expected(robot.servo.alpha, carried_payload()), rtol=0, atol=1e-7)
    log = signals(robot)
    model = ArmModel(CELL.robot)
    model.set_payload(carried_payload())
    late = 20  # ms: an inertia is read a refresh before it is sent
    for k in range(100, len(log["t"]), 97):
        q = log["q_fb"][k - late : k]
        seen = np.array([axis_inertia(model, one, 0) + TABLE.at(one) for one in q])
        assert seen.min() - 1e-4 <= log["D"][k, 0] <= seen.max() + 1e-4
    assert all(cell.row[cell_axis] == cell.D for cell_axis, cell in enumerate(robot.areas.ita))


def test_the_inertia_after_an_acknowledged_alarm_has_the_table():
    robot = controller(servo=WITH_TABLE)
    robot.cycle()
    robot.alarm("RBL516", "test")
    while not robot.halted:
        robot.cycle()
    robot.acknowledge()
    np.testing.assert_allclose(published(robot), expected(robot.plant.q), rtol=1e-12)


def test_a_table_of_nothing_changes_nothing():
    """Torques of a run with a table of zeros are those of a run without one."""
    nothing = replace(WITH_TABLE, rotor_tables=(replace(TABLE, values=(0.0,) * 9), *(None,) * 5))
    logs = []
    for servo in (IDEAL, nothing):
        robot = controller(servo=servo)
        robot.load(carried_payload())
        robot.move(down(robot))
        while robot.moving:
            robot.cycle()
        logs.append(signals(robot)["tau_cmd"])
    np.testing.assert_array_equal(*logs)
