"""The scales of docs/weighing.md: what they reach on MuJoCo with friction and encoders, and what they refuse."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robolang.experiments import weigh as module
from robolang.experiments.weigh import Declaration, WeighRequest, carried, load_statement, plan_exercise, weigh
from robolang.project.project import load_cell_and_settings
from runtime.cell.cell import ObstacleSpec
from runtime.core.faults import Fault
from runtime.core.units import DEG
from runtime.dynamics.payload_identification import WeighedPayload
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.payload import Payload, declared
from runtime.settings.profile import Profile
from tests.campaign import some
from tests.messages import fields
from tests.robolang.helpers import checked

PROGRAMS = Path(__file__).parents[3] / "programs"
PUMA, MANUTEC = (
    load_cell_and_settings(PROGRAMS / f"{name}.rbl", None, None, None, {})[0]
    for name in ("pick_and_place", "manutec_pick_and_place")
)


def body(mass, *cog_mm):
    return Payload(mass=mass, cog=np.array(cog_mm) * 1e-3)


def at(cell, *joints_deg):
    """The cell without anything to strike, at another home."""
    return replace(cell, home=np.radians(joints_deg), parts=(), obstacles=())


def fine_encoders(cell):
    axes = tuple(replace(axis, motor=replace(axis.motor, encoder_counts=2**40)) for axis in cell.robot.axes)
    return replace(cell, robot=replace(cell.robot, axes=axes))


def without_drives(*_):
    pytest.fail("something moved")


@pytest.mark.parametrize("cell", some([PUMA, MANUTEC], 0), ids=lambda cell: cell.robot.name)
def test_the_ideal_arm_is_weighed_to_a_thousandth(cell):
    """Without friction and encoder steps; the larger part of what is left is half a tick between torque and motion."""
    result = weigh(WeighRequest(cell=fine_encoders(cell), added=body(1.0, 20.0, -30.0, 80.0), plant="rigid"))
    assert result.found.mass == pytest.approx(result.true.mass, rel=1e-3)
    assert result.found.cog == pytest.approx(result.true.cog, abs=2e-4)


ACCURACY = [
    (PUMA, None, None),
    (PUMA, None, body(1.5, 0.0, 0.0, 113.7)),
    (PUMA, None, body(1.5, 40.0, -30.0, 60.0)),
    (PUMA, (40.0, 60.0, -150.0, 30.0, -40.0, 90.0), body(1.5, 40.0, -30.0, 60.0)),
    (PUMA, (-100.0, 110.0, -200.0, -50.0, 60.0, 0.0), body(1.5, 0.0, 0.0, 113.7)),
    (MANUTEC, None, body(11.0, 0.0, 0.0, 157.0)),
    (MANUTEC, None, body(11.0, 60.0, -40.0, 90.0)),
    (MANUTEC, (60.0, -30.0, 80.0, 60.0, -50.0, 100.0), body(11.0, 60.0, -40.0, 90.0)),
    (MANUTEC, (-90.0, 40.0, 50.0, -70.0, 40.0, 0.0), body(11.0, 0.0, 0.0, 157.0)),
]


@pytest.mark.physics
@pytest.mark.parametrize(("cell", "home", "added"), some(ACCURACY, 4, 6))
def test_accuracy_with_friction_and_encoders(cell, home, added):
    """The goal is 2 % and 5 mm; what is reached, docs/weighing.md, leaves a factor of four and more."""
    result = weigh(WeighRequest(cell=cell if home is None else at(cell, *home), added=added))
    found, true = result.found, result.true
    assert found.mass == pytest.approx(true.mass, rel=5e-3)
    assert found.cog == pytest.approx(true.cog, abs=1.2e-3)
    assert abs(found.mass - true.mass) < 3.0 * found.mass_sd
    assert (np.abs(found.cog - true.cog) < 3.0 * found.cog_sd).all()
    assert found.mass_sd < 0.01 * true.mass
    assert found.cog_sd.max() < 1.5e-3


@pytest.mark.physics
@pytest.mark.parametrize(
    ("cell", "added"),
    some([(PUMA, body(1.5, 40.0, -30.0, 60.0)), (MANUTEC, body(11.0, 0.0, 0.0, 157.0))], 0),
)
def test_friction_of_which_the_controller_knows_nine_tenths_cancels(cell, added):
    watched = replace(Profile().supervision, friction=0.9)
    result = weigh(WeighRequest(cell=cell, added=added, profile=replace(Profile(), supervision=watched)))
    assert result.found.mass == pytest.approx(result.true.mass, rel=0.01)
    assert result.found.cog == pytest.approx(result.true.cog, abs=2.5e-3)
    assert result.found.friction[1:] == pytest.approx(np.full(5, 1.0 / 0.9 - 1.0), abs=0.03)


def test_the_true_load_is_hand_and_body():
    true = carried(WeighRequest(cell=PUMA, added=body(1.5, 0.0, 0.0, 113.7)))
    assert true.mass == pytest.approx(2.3)
    assert true.cog == pytest.approx([0.0, 0.0, (0.8 * 60.0 + 1.5 * 113.7) / 2.3e3])
    assert carried(WeighRequest(cell=PUMA)).mass == PUMA.hand.mass


# --- the exercise ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("cell", [PUMA, MANUTEC], ids=["puma560", "manutec_r3"])
def test_the_exercise_starts_and_ends_at_rest_and_keeps_the_limits(cell):
    exercise = plan_exercise(WeighRequest(cell=cell))
    assert exercise.axes == [1, 2, 3, 4, 5]  # the waist is upright: it feels no weight
    assert exercise.offsets[[0, -1]] == pytest.approx(np.zeros((2, 6)), abs=1e-12)
    q = cell.home + exercise.offsets
    assert (q >= cell.robot.lower).all()
    assert (q <= cell.robot.upper).all()
    speed = np.abs(np.diff(q, axis=0)).max(axis=0) / 8e-3
    assert (speed < cell.robot.per_axis("limits", "speed")).all()
    assert (np.abs(np.diff(q, 2, axis=0)).max(axis=0) / 8e-3**2 < cell.robot.per_axis("limits", "acceleration")).all()


def test_near_the_end_of_a_range_an_axis_swings_by_what_is_left():
    low = PUMA.robot.lower / DEG
    home = PUMA.home / DEG
    home[4] = low[4] + 11.0
    swings = plan_exercise(WeighRequest(cell=at(PUMA, *home))).amplitudes / DEG
    assert swings[[3, 4, 5]] == pytest.approx([25.0, 10.0, 50.0])
    home[4] = low[4] + 2.0
    assert plan_exercise(WeighRequest(cell=at(PUMA, *home))).axes == [1, 2, 3, 5]


def refused(monkeypatch, request):
    monkeypatch.setattr(module, "Controller", without_drives)
    with pytest.raises(Fault) as caught:
        weigh(request)
    return caught.value


def test_a_swing_out_of_the_range_is_refused_before_anything_moves(monkeypatch):
    fault = refused(monkeypatch, WeighRequest(cell=PUMA, amplitude=60.0 * DEG))
    assert fault.code == "RBL411"
    assert {"J5", "-133.9", "deg"} <= fields(fault.message)
    assert {"25", "deg"} <= fields(fault.hint)
    plan_exercise(WeighRequest(cell=PUMA, amplitude=25.0 * DEG))


def test_a_swing_that_is_too_fast_is_refused_before_anything_moves(monkeypatch):
    slow = tuple(replace(axis, limits=replace(axis.limits, speed=0.5)) for axis in PUMA.robot.axes)
    cell = replace(PUMA, robot=replace(PUMA.robot, axes=slow))
    fault = refused(monkeypatch, WeighRequest(cell=cell, amplitude=20.0 * DEG))
    assert fault.code == "RBL404"
    assert "J4" in fields(fault.message)
    assert (plan_exercise(WeighRequest(cell=cell)).amplitudes[3:] < [20.0 * DEG, 20.0 * DEG, 40.0 * DEG]).all()


def test_a_home_without_room_is_refused_before_anything_moves(monkeypatch):
    fault = refused(monkeypatch, WeighRequest(cell=at(PUMA, *(PUMA.robot.lower / DEG))))
    assert fault.code == "RBL411"
    assert "J5" not in fields(fault.message)  # no one axis is at fault


@pytest.mark.physics
def test_an_arm_that_strikes_something_is_not_weighed():
    """The tool stands at z = 840 mm; a box reaches up to 790 mm, which the fingers meet when the arm swings down."""
    X = np.eye(4)
    X[:3, 3] = 0.48, -0.22, 0.775
    box = ObstacleSpec(name="box", size=np.array([0.3, 0.3, 0.08]), X_world_obstacle=X)
    with pytest.raises(Fault) as caught:
        weigh(WeighRequest(cell=replace(PUMA, obstacles=(box,), parts=())))
    assert caught.value.code in ("RBL511", "RBL512", "RBL516")


# --- LOAD ------------------------------------------------------------------------------------------------------------


NONE = np.zeros(6)
WEIGHED = WeighedPayload(
    mass=2.30412,
    mass_sd=0.004,
    cog=np.array([-0.00002, 0.0123, 0.09504]),
    cog_sd=np.array([3e-5, 3e-4, 2e-3]),
    friction=NONE,
    left=NONE,
    peak=NONE,
    rows=NONE,
)


def test_the_load_is_rounded_to_what_is_known():
    for changes, load in (
        ({}, "LOAD (0, 12.3, 95), 2.304"),
        ({"mass_sd": 0.04}, "LOAD (0, 12.3, 95), 2.3"),
        ({"mass": 2.504}, "LOAD (0, 12.3, 95), 2.5"),
        ({"cog": None, "cog_sd": None, "mass": 0.001}, "LOAD (0, 0, 0), 0"),
    ):
        assert load_statement(replace(WEIGHED, **changes), 2.5) == Declaration(text=load)


@pytest.mark.parametrize(
    ("changes", "rated", "noted"),
    [
        ({"cog": np.array([2.0, 0.0, 0.0]), "cog_sd": np.array([5.0, 5.0, 5.0])}, 2.5, False),
        ({"mass": -0.5, "cog": None, "cog_sd": None}, 2.5, True),
        ({"mass": math.nan, "cog": None, "cog_sd": None}, 2.5, True),
        ({"mass": 1.6, "mass_sd": 0.6}, 1.7, False),  # 2 when it is rounded
    ],
)
def test_a_load_to_paste_is_one_that_a_program_may_declare(changes, rated, noted):
    load = load_statement(replace(WEIGHED, **changes), rated)
    assert checked(load.text, rated=rated) == []
    x, y, z, mass = map(float, re.fullmatch(r"LOAD \((\S+), (\S+), (\S+)\), (\S+)", load.text).groups())
    declared(mass, np.array([x, y, z]) * 1e-3, rated)
    assert bool(load.note) is noted


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"mass": 2.56}, "RBL402"),
        ({"mass": 500.0}, "RBL402"),
        ({"mass": math.nan}, "RBL402"),
        ({"cog": np.array([1.9, 1.9, 0.0])}, "RBL403"),
        ({"cog": np.array([math.nan, 0.0, 0.0])}, "RBL403"),
    ],
)
def test_what_no_program_may_declare_has_no_load_to_paste(changes, code):
    load = load_statement(replace(WEIGHED, **changes), 2.5)
    assert (load.text, load.code) == (None, code)
    assert load.note


def test_an_arm_that_feels_no_weight_is_refused(monkeypatch):
    """Two upright axes, as of a SCARA."""
    first, second = load_builtin("puma560").axes[:2]
    beside = np.eye(4)
    beside[0, 3] = 0.4
    upright = replace(PUMA.robot, axes=(first, replace(second, placement=beside)), opw=None)
    cell = replace(PUMA, robot=upright, home=PUMA.home[:2])
    assert "weight" in refused(monkeypatch, WeighRequest(cell=cell)).message
