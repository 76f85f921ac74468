"""What the servo gains from an identification, in the program of 1992 on a plant with other inertia."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.experiments.excitation import Request
from robolang.experiments.identify import compensation_of, identify, with_errors
from robolang.project.project import load_project
from runtime.control.controller import Controller
from runtime.plant.mujoco_plant import MujocoPlant
from runtime.robot.kinematics.kinematics import Kinematics
from tests.campaign import size
from tests.robolang.experiments.identified import ROOT, SPEC, experiment

pytestmark = pytest.mark.physics


@cache
def pick_and_place(real, rotors=(), first_moments=(), supervised=False):
    """Run the program with the nominal model on a plant of another robot; returns the result."""
    project = load_project(ROOT / "programs" / "pick_and_place.rbl")
    profile = project.profile
    profile = replace(profile, servo=replace(profile.servo, rotors=rotors, first_moments=first_moments))
    if not supervised:
        supervision = replace(profile.supervision, collision=np.inf, payload_mismatch="off")
        profile = replace(profile, supervision=supervision)
    session = Session(project.with_profile(profile))
    cell = project.cell
    robot = robot_of(real)
    plant = MujocoPlant(robot, replace(cell, robot=robot), profile.tick_s)
    session.record.controller = Controller(cell.robot, plant, session.controller.profile, cell.hand.X_flange_tool)
    return session.run()


def with_reducers(factor):
    """Return the robot with reducers, whose inertia the robot file does not have, on all motors."""
    motors = [replace(axis.motor, rotor_inertia=axis.motor.rotor_inertia * factor) for axis in SPEC.axes]
    return replace(SPEC, axes=tuple(replace(axis, motor=m) for axis, m in zip(SPEC.axes, motors, strict=True)))


def log_of(*words, **options):
    result = pick_and_place(*words, **options)
    assert result.ok, result.report["alarms"]
    return result.log


def error(log):
    return log["q_cmd"] - log["q_link"]


def tool_error(log):
    X = load_project(ROOT / "programs" / "pick_and_place.rbl").cell.hand.X_flange_tool
    commanded = Kinematics(SPEC).forward(log["q_cmd"]) @ X
    return float(np.linalg.norm(commanded[:, :3, 3] - log["X_world_tool"][:, :3, 3], axis=1).max())


def robot_of(real):
    return {"nominal": SPEC, "heavier": with_errors(SPEC, 8), "reducers": with_reducers(1.6)}[real]


def found_in_heavier():
    return compensation_of(*experiment(seed=8))


@pytest.mark.slow
def test_inertia_of_reducers_is_found_and_taken_off_the_tracking_error():
    """60 % more than the rotors of the file: as far as the arm can tell, the model is right again."""
    request = Request(robot=SPEC, axes=tuple(range(6)), real=robot_of("reducers"), positions=size(5, 1))
    found = compensation_of(request, identify(request))
    Jc = np.array([axis.compensation for axis in found.axes])
    np.testing.assert_allclose(Jc, 1.6 * SPEC.per_axis("motor", "rotor_inertia"), rtol=4e-3)
    exact, without, with_it = (log_of("nominal"), log_of("reducers"), log_of("reducers", tuple(found.rotors(SPEC))))
    rms = [np.sqrt((error(log) ** 2).mean(axis=0)) for log in (exact, without, with_it)]
    assert (rms[2][1:] < 0.7 * rms[1][1:]).all()
    assert (rms[2] < 1.02 * rms[0]).all()
    assert tool_error(with_it) < 0.75 * tool_error(without)


def test_inertia_alone_leaves_the_weight_and_no_wrong_feed_forward():
    """With 5 to 20 % heavier bodies most of the error is their weight, which Jc knows nothing of. J1 carries none: it
    moves as with the exact model again. The largest error of the tool gets smaller."""
    found = found_in_heavier()
    exact, without, with_it = log_of("nominal"), log_of("heavier"), log_of("heavier", tuple(found.rotors(SPEC)))
    ticks = min(len(log["t"]) for log in (exact, without, with_it))
    away = [np.sqrt(((error(log)[:ticks] - error(exact)[:ticks]) ** 2).mean(axis=0)) for log in (without, with_it)]
    assert away[1][0] < 0.6 * away[0][0]
    assert away[1][1] < 0.9 * away[0][1]
    assert tool_error(with_it) < 0.99 * tool_error(without)


@pytest.mark.slow
def test_inertia_and_weight_make_heavier_bodies_run_as_the_model_would():
    """The tool is no farther off its way than with the exact model, and supervision believes the payload again."""
    found = found_in_heavier()
    exact, without, with_it = (
        log_of("nominal"),
        log_of("heavier"),
        log_of("heavier", tuple(found.rotors(SPEC)), found.first_moments, supervised=True),
    )
    assert tool_error(without) > 1.6 * tool_error(exact)
    assert tool_error(with_it) < 1.02 * tool_error(exact)
    stopped = pick_and_place("heavier", supervised=True)
    assert [alarm["code"] for alarm in stopped.report["alarms"]] == ["RBL517"]
