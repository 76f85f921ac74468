"""Experiments on arms with an axis that slides: m, N and kg by the same formulas, mm where people read them."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import robolang
from robolang.experiments.inertia import at_posture, extremes, over_plane
from robolang.experiments.step import StepRequest, as_json, step
from robolang.experiments.weigh import WeighRequest, exercise_about, main_axes, weigh
from robolang.project.project import builtin_cell
from runtime.core.faults import Fault
from runtime.core.tomlfile import Source
from runtime.core.units import GRAVITY, MM
from runtime.robot.files.estimate import estimate
from runtime.robot.files.importer import parse_model, with_sidecar
from runtime.robot.files.known import known_of
from runtime.robot.files.loader import load_builtin
from runtime.robot.files.sidecar import template
from runtime.robot.files.sidecar_file import read_sidecar
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from runtime.settings.profile import Profile
from tests.robolang.cli import commands
from tests.runtime.robot.files.test_sliding_import import RAIL

COBRA = load_builtin("cobra600")
Q = np.array([0.0, 0.5, 0.1, 0.0])
BODY = Payload(mass=1.0, cog=np.array([0.0, 0.0, 0.05]))
MASS = 1.6 + 0.4
"""Quill and roll of the Cobra, kg."""
REFLECTED = (2.0 * math.pi / 0.02) ** 2 * 1e-5
"""The rotor of the quill at its screw of 20 mm a turn, kg."""


@pytest.fixture(scope="module")
def stepped():
    request = StepRequest(robot=COBRA, axis=2, q=Q, size=0.5 * MM, carried=BODY, declared=BODY, ideal=False)
    return request, step(request)


def test_a_step_of_a_slide_is_in_mm_newton_and_kg(stepped):
    request, result = stepped
    assert result.stable
    assert result.inertia == pytest.approx(MASS + 1.0 + REFLECTED)
    assert result.gain_inertia == pytest.approx(result.inertia)
    assert result.response[-1] == pytest.approx(0.5 * MM, rel=0.01)
    found = as_json(request, result)
    assert found["size_mm"] == pytest.approx(0.5)
    assert found["inertia_kg"] == result.inertia
    assert found["peak_force_n"] == result.peak_torque >= (MASS + 1.0) * GRAVITY
    assert found["joints"] == pytest.approx([0.0, math.degrees(0.5), 100.0, 0.0])
    assert not [key for key in found if "deg" in key or "nm" in key]


def test_a_turn_of_an_arm_with_a_slide_has_the_keys_of_a_turn():
    request = StepRequest(robot=COBRA, axis=0, q=Q, size=math.radians(0.5))
    found = as_json(request, step(request))
    assert found["size_deg"] == pytest.approx(0.5)
    assert {"inertia_kg_m2", "peak_torque_nm", "droop_deg", "joints"} <= set(found)


def test_a_load_that_is_not_declared_droops_in_mm():
    light = StepRequest(robot=COBRA, axis=2, q=Q, size=0.0, carried=BODY, ideal=False)
    result = step(light)
    assert result.stable
    # positive is downwards: what is not declared pulls the quill beyond its command
    assert result.droop < -0.1 * MM
    assert as_json(light, result)["droop_mm"] == pytest.approx(result.droop / MM)


@pytest.mark.parametrize(("q3", "size"), [(0.2101, 0.0), (0.2, 0.0102), (math.nan, 0.0)])
def test_a_step_beyond_the_travel_is_refused(q3, size):
    q = np.array([0.0, 0.5, q3, 0.0])
    with pytest.raises(ValueError, match="mm"):
        step(StepRequest(robot=COBRA, axis=2, q=q, size=size))


def test_the_command_takes_mm_of_a_slide():
    words = ("step", "--robot", "cobra600", "--axis", "3", "--joints", "0,30,100,0", "--seconds", "0.3")
    found = json.loads(commands.robolang(*words, "--json").stdout)
    assert found["size_mm"] == 0.5
    lines = commands.robolang(*words).stdout
    assert f"{found['peak_force_n']:.1f} N" in lines
    assert "deg" not in lines
    refused = commands.robolang(*words, "--size", "150", code=2).stderr
    assert "250 mm" in refused
    assert "360 mm" in commands.robolang(*words, "--size", "361", code=2).stderr


def test_python_has_the_step_of_a_slide_in_mm():
    result = robolang.step("cobra600", 3, size_mm=0.2, size_deg=90.0, joints=(0, 30, 100, 0), seconds=0.3)
    assert result.response[-1] == pytest.approx(0.2 * MM, rel=0.05)


def test_inertia_of_a_slide_is_a_mass():
    quill = at_posture(COBRA, Q, BODY)[2]
    assert quill.link_inertia == pytest.approx(MASS + 1.0)
    assert quill.rotor_inertia == pytest.approx(REFLECTED)
    assert quill.motor_inertia == pytest.approx((MASS + 1.0) * (0.02 / (2.0 * math.pi)) ** 2 + 1e-5)
    assert quill.gravity == pytest.approx(-(MASS + 1.0) * GRAVITY)


def test_a_map_over_a_slide_is_in_mm(tmp_path):
    drawn = over_plane(COBRA, 0, (1, 2), Q, NO_PAYLOAD)
    at = extremes(drawn)["smallest"]
    assert at["joints"] == [-150.0, 0.0]
    assert drawn.y[-1] == pytest.approx(0.21)
    out = tmp_path / "m.svg"
    words = ("inertia", "--robot", "cobra600", "--map", "J2,J3", "--out", out)
    text = commands.robolang(*words).stdout
    assert "J2 -150.0 deg, J3 0.0 mm" in text
    assert "J3, mm" in out.read_text()
    # two joints that turn: the slide is among the others, which the first joint does not depend on
    assert "joints_deg" in extremes(over_plane(COBRA, 0, (1, 3), Q, NO_PAYLOAD))["smallest"]


def test_the_table_of_inertia_has_the_unit_of_each_axis():
    text = commands.robolang("inertia", "--robot", "cobra600", "--joints", "0,30,100,0").stdout
    row = next(line for line in text.splitlines() if line.strip().startswith("J3"))
    assert row.split()[1:3] == ["2", "kg"]
    found = json.loads(commands.robolang("inertia", "--robot", "cobra600", "--joints", "0,30,100,0", "--json").stdout)
    assert found["joints"] == pytest.approx([0.0, 30.0, 100.0, 0.0])
    assert [axis.get("kind") for axis in found["axes"]] == [None, None, "prismatic", None]


def rail():
    """Six axes on a rail, with estimated drives."""
    source = Source("a.urdf", RAIL)
    arm = parse_model(source)
    return with_sidecar(source, read_sidecar(Source("a.robot.toml", template(arm, estimate(known_of(arm)))), "a.urdf"))


def test_a_quill_alone_shows_no_centre_of_gravity():
    with pytest.raises(Fault, match="RBL411"):
        exercise_about(COBRA, Q, Profile())


@pytest.mark.physics
def test_an_arm_on_a_rail_weighs_while_the_rail_stands():
    robot = rail()
    assert list(main_axes(robot)) == [True] * 4 + [False] * 3
    home = np.array([0.3, 0.0, -0.7, 1.0, 0.2, 0.5, 0.0])
    cell = builtin_cell()
    request = WeighRequest(cell=_carrying(cell, robot, home))
    result = weigh(request)
    assert result.exercise.amplitudes[0] == 0.0
    assert result.found.mass == pytest.approx(0.8, abs=4.0 * result.found.mass_sd)
    assert result.found.cog == pytest.approx([0.01, -0.02, 0.06], abs=4e-3)


def _carrying(cell, robot, home):
    hand = replace(cell.hand, mass=0.8, cog=np.array([0.01, -0.02, 0.06]))
    return replace(cell, robot=robot, home=home, hand=hand, parts=(), obstacles=())
