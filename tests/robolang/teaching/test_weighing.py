"""Weighing on a live controller: the true payload of the plant, whatever LOAD says, under the speed of MANUAL."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robolang.execution.rig import Rig, fitted, plant_of
from robolang.execution.session import Session
from robolang.execution.status import ENDED, State
from robolang.project.project import load_cell_and_settings, load_project
from robolang.teaching.weighing import weigh_plan, weigh_result
from runtime.core.faults import Fault
from runtime.core.linear import matmul
from runtime.core.units import DEG
from runtime.motion.speed_cap import MANUAL_SPEED
from runtime.robot.model.payload import Payload
from runtime.settings.profile import Profile
from tests.campaign import some
from tests.robolang.teaching.surroundings import surroundings

PROGRAMS = Path(__file__).parents[3] / "programs"
PUMA, MANUTEC = (
    load_cell_and_settings(PROGRAMS / f"{name}.rbl", None, None, None, {})[0]
    for name in ("pick_and_place", "manutec_pick_and_place")
)
COG = np.array([0.01, -0.02, 0.095])


def arm(cell, mass, said, *, physics=True):
    """A controller whose arm carries a true mass, kg, of which another may be declared; None: no LOAD."""
    cell, profile = replace(cell, parts=(), obstacles=()), fitted(Profile(), physics)
    loaded = replace(cell, hand=replace(cell.hand, mass=mass, cog=COG))
    controller = Rig.over(plant_of(loaded, profile.tick_s, physics), cell, profile).controller
    if said is not None:
        controller.load(Payload(mass=said, cog=np.array([0.0, 0.0, 0.06])))
    return controller


def moved(controller, *, weighing=True, physics=True):
    """Weigh, as the module says, and return the plan and the result."""
    plan = weigh_plan(controller)
    begun, controller.weighing = controller.recorder.tick, weighing
    controller.speed_cap = MANUAL_SPEED  # as in MANUAL: faster rows would be refused
    controller.play(plan.rows)
    for _ in plan.rows:
        if not controller.cycle() or controller.alarms:
            raise Fault(controller.alarms[0].code, controller.alarms[0].message)
    controller.weighing = False
    return plan, weigh_result(plan, controller.recorder.recent(controller.recorder.tick - begun), physics=physics)


CASES = [
    (PUMA, 2.3, 0.8, 0.02),
    (PUMA, 0.8, 2.3, 0.02),
    (MANUTEC, 2.3, 8.0, 0.1),
    (PUMA, 2.3, 2.3, 0.02),
    (PUMA, 0.8, None, 0.02),
    (MANUTEC, 13.5, None, 0.2),
]


@pytest.mark.physics
@pytest.mark.parametrize(("cell", "mass", "said", "within"), some(CASES, 2))
def test_the_true_payload_is_found_whatever_is_declared(cell, mass, said, within):
    controller = arm(cell, mass, said)
    start = np.array(controller.areas.ina)
    plan, result = moved(controller)
    assert result.found.mass == pytest.approx(mass, abs=within)
    assert result.found.mass == pytest.approx(mass, abs=3.0 * result.found.mass_sd)
    assert result.found.cog == pytest.approx(COG, abs=2e-3)
    assert result.load.text.startswith("LOAD (")
    assert float(result.load.text.rpartition(",")[2]) == pytest.approx(mass, abs=within)
    # it ends where it began, and keeps to the speed of MANUAL at every servo tick
    assert controller.areas.ina == pytest.approx(start, abs=1e-12)
    assert fastest(controller) <= MANUAL_SPEED
    assert plan.seconds == pytest.approx(12.4, abs=0.1)


def fastest(controller):
    """The largest speed of tool point and flange, m/s, of commands and of the true arm."""
    log = controller.signals()
    found = []
    for q in (log["q_cmd"], log["q_link"]):
        X = controller.kinematics.forward(q)
        for place in (X[:, :3, 3], matmul(X, controller.X_flange_tool)[:, :3, 3]):
            # over 5 ticks: differences of single ticks show the vibration of the gears
            found.append(np.linalg.norm(place[5:] - place[:-5], axis=1).max() / (5 * controller.profile.tick_s))
    return max(found)


@pytest.mark.physics
def test_a_wrong_load_stops_a_motion_that_does_not_weigh():
    with pytest.raises(Fault) as caught:
        moved(arm(PUMA, 2.3, 0.3), weighing=False)
    assert caught.value.code == "RBL517"


@pytest.mark.physics
def test_hand_and_held_part_of_a_cell_are_weighed(tmp_path):
    program = tmp_path / "p.rbl"
    program.write_text("LOAD (0, 0, 60), 0.8\nHAND OFF\nMOVE P1\nHAND ON\nLOAD (0, 0, 95), 2.3\nMOVE P2\n")
    project = load_project(program)
    session = Session(project)
    while session.executor.advance(200).state not in ENDED:
        pass
    controller = session.controller
    assert controller.plant.hand().holding == "part"
    plan, begun = weigh_plan(controller), controller.recorder.tick
    controller.weighing = True
    session.executor.play(plan.rows, None, "weigh")
    while session.executor.advance(200).state is State.RUNNING:
        pass
    controller.weighing = False
    assert not controller.alarms
    result = weigh_result(plan, controller.recorder.recent(controller.recorder.tick - begun), physics=True)
    hand, part = project.cell.hand, project.cell.parts[0]
    assert result.found.mass == pytest.approx(hand.mass + part.mass, abs=0.03)
    # the part hangs at the grip point, the hand in itself: the common centre is between them
    assert hand.cog[2] < result.found.cog[2] < hand.X_flange_tool[2, 3] + 0.02
    assert controller.plant.hand().holding == "part"


@pytest.mark.parametrize("robot", some(["puma560", "irb2400", "manutec_r3"], 1))
def test_the_ideal_arm(robot):
    around = surroundings(robot=robot)
    controller = arm(around.cell, 2.0, None, physics=False)
    plan, result = moved(controller, physics=False)
    assert result.found.mass == pytest.approx(2.0, rel=0.02)
    assert fastest(controller) <= MANUAL_SPEED
    assert plan.exercise.axes[0] > 0  # an upright waist feels no weight


def test_a_tool_too_long_for_the_speed():
    controller = arm(PUMA, 0.8, None, physics=False)
    X = np.eye(4)
    X[2, 3] = 4.0
    controller.use_tool(X)
    with pytest.raises(Fault) as caught:
        weigh_plan(controller)
    assert caught.value.code == "RBL411"


def test_a_posture_at_the_ends_of_the_ranges():
    spec = PUMA.robot
    controller = arm(replace(PUMA, home=spec.upper - 0.5 * DEG), 0.8, None, physics=False)
    with pytest.raises(Fault) as caught:
        weigh_plan(controller)
    assert caught.value.code == "RBL411"


def test_less_than_the_whole_motion_is_not_weighed():
    controller = arm(PUMA, 0.8, None, physics=False)
    plan = weigh_plan(controller)
    with pytest.raises(ValueError, match="not the whole motion"):
        weigh_result(plan, np.zeros((100, 24)), physics=False)
