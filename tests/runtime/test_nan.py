"""NaN handed to the functions that decide: each refuses it, or ranks it as the worst. See tests/arch/test_nan.py."""

import math
from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import pose
from runtime.core.units import badness
from runtime.motion.cartesian_planner import CartesianPlanner
from runtime.motion.commands import MoveLinear
from runtime.motion.velocity_profile import SpeedLimits, bound, profile
from runtime.pulses.machine import Stand
from runtime.pulses.mechanism import load_builtin
from runtime.pulses.replay import MoveReplay
from runtime.robot.kinematics.newton import NewtonSolver
from runtime.robot.model.payload import declared
from runtime.settings.supervision import SupervisionLimits
from runtime.supervision.drive_data import DriveData
from runtime.supervision.supervisor import CONFIRMED, Supervisor
from runtime.supervision.torque_observer import Observer
from tests.runtime.motion.test_cartesian_planner import HOME, HOME_POSE, KINEMATICS, PROFILE, SPEC, TOOL

NAN = math.nan


@pytest.mark.parametrize("values", list(permutations((NAN, 1.0, -math.inf))))
def test_nan_is_the_worst_of_any_values_in_any_order(values):
    assert math.isnan(max(values, key=badness))
    assert min(values, key=badness) == -math.inf


@pytest.mark.parametrize("place", [(0, 3), (1, 3), (0, 0), (2, 1)])
def test_a_pose_of_nan_is_planned_by_nobody(place):
    X = HOME_POSE.copy()
    X[place] = NAN
    with pytest.raises((Fault, ValueError)):
        CartesianPlanner(SPEC, KINEMATICS, PROFILE).plan(HOME, MoveLinear(X_world_tool=X), TOOL)


def test_no_joint_angles_meet_a_pose_of_nan():
    solver = NewtonSolver([pose((0.1 * k, 0.2, 0.3)) for k in range(6)], pose((0.0, 0.0, 0.1)))
    q = np.full(6, 0.3)
    for place in ((0, 3), (0, 0), (1, 2)):
        X = pose((0.1, 0.2, 0.3))
        X[place] = NAN
        assert np.isnan(solver.solve(X, q)).all()


@pytest.mark.parametrize("key", ["speed", "acceleration", "jerk"])
def test_a_limit_of_nan_gives_no_profile(key):
    with pytest.raises(Fault, match=" nan s"):
        profile(replace(SpeedLimits(speed=1.0, acceleration=2.0, jerk=9.0), **{key: NAN}), 0.008)


@pytest.mark.parametrize("row", [0, 1])
@pytest.mark.parametrize("column", range(4))
def test_a_bound_of_nan_is_a_bound(row, column):
    extents = [[1.0, 1.0, 1.0, 1.0], [0.5, 1.0, 1.0, 1.0]]
    extents[row][column] = NAN
    found = bound([(a, b, c, d) for a, b, c, d in extents], "jerk")
    assert any(math.isnan(value) for value in (found.speed, found.acceleration, found.jerk))


def test_a_machine_goes_to_no_point_of_nan():
    machine = load_builtin("scara").placed(np.array([0.4, 0.1, 0.7]))
    for place in ((0, 3), (2, 3)):
        X = pose((0.4, 0.1, 0.7))
        X[place] = NAN
        with pytest.raises(Fault):
            machine.curve(Stand(q=machine.home.q), MoveLinear(X_world_tool=X)).joints(np.linspace(0.0, 1.0, 5))


@pytest.mark.parametrize("key", ["rows_mm", "between_mm", "end_mm"])
def test_an_error_of_nan_is_the_worst_of_a_replay(key):
    errors = {"rows_mm": 0.1, "between_mm": 0.2, "end_mm": 0.3, key: NAN}
    empty = dict.fromkeys(("move", "duration_s", "times", "pulses", "frequency", "points", "error_mm", "counts"))
    assert math.isnan(MoveReplay(**empty, **errors).worst_mm)


@pytest.mark.parametrize("values", [{"mass": NAN}, {"cog": (0.0, NAN, 0.0)}, {"inertia": np.full((3, 3), NAN)}])
def test_a_payload_of_nan_is_refused(values):
    with pytest.raises(Fault):
        declared(**{"mass": 1.0, "cog": (0.0, 0.0, 0.1), "rated": 2.5, **values})


@pytest.mark.parametrize("estimate", [(NAN, 0.01), (1.5, NAN), (NAN, NAN)])
def test_an_estimate_of_nan_is_no_declared_payload(estimate, monkeypatch):
    motors = {"torque": SPEC.per_axis("limits", "torque"), "resolution": np.full(6, 1e-6), "lag": np.zeros(6)}
    drives = DriveData(**motors, ticks=8, tick_s=1e-3, friction=0.0)
    supervisor = Supervisor(SPEC, SupervisionLimits(), drives)
    monkeypatch.setattr(Observer, "estimate", lambda self: estimate)
    found = [supervisor._weigh(tick) for tick in range(CONFIRMED)]
    assert found[:-1] == [None] * (CONFIRMED - 1)
    assert found[-1].code == "RBL517"
