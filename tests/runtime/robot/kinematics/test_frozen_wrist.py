"""The position-only solve: against forward kinematics, on both sides, closed form against Newton, and where it ends."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.core.frames import pose, pose_from_xyzrpy
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.frozen_wrist import FrozenWrist, Side
from runtime.robot.kinematics.kinematics import Kinematics

TOOL = pose_from_xyzrpy((0.03, -0.02, 0.2, 0.3, -0.4, 0.5))
ROBOTS = ["irb2400", "puma560", "manutec_r3"]


def arm(name: str) -> tuple[Kinematics, FrozenWrist]:
    kinematics = Kinematics(load_builtin(name))
    return kinematics, FrozenWrist(kinematics, TOOL)


def postures(kinematics: Kinematics, count: int) -> np.ndarray:
    spec = kinematics.spec
    return np.random.default_rng(9).uniform(spec.lower, spec.upper, (count, 6))


def numeric(kinematics: Kinematics) -> FrozenWrist:
    """The same arm as one that has no closed form."""
    found = FrozenWrist(kinematics, TOOL)
    found._opw = None
    return found


@pytest.mark.parametrize("name", ROBOTS)
def test_the_main_axes_of_a_posture_are_found_again_from_its_tool_point_and_wrist(name):
    kinematics, frozen = arm(name)
    worst = 0.0
    for q in postures(kinematics, 500):
        p = (kinematics.forward(q) @ TOOL)[None, :3, 3]
        found = frozen.solve(p, q[None, 3:], q + 0.01, frozen.side_of(q))[0]
        worst = float(np.maximum(worst, np.abs(found - q).max()))
    assert worst < 1e-7  # beside a stretched arm the digits are fewer; most are at 1e-15


@pytest.mark.parametrize("name", ROBOTS)
def test_every_side_meets_the_place_and_is_the_side_it_is_named(name):
    kinematics, frozen = arm(name)
    met = 0
    for q in postures(kinematics, 200):
        p = (kinematics.forward(q) @ TOOL)[None, :3, 3]
        for side in (Side(a, e) for a in (1, -1) for e in (1, -1)):
            found = frozen.solve(p, q[None, 3:], q, side)[0]
            if np.isfinite(found).all():
                met += 1
                np.testing.assert_allclose((kinematics.forward(found) @ TOOL)[:3, 3], p[0], atol=1e-12)
                assert frozen.side_of(found) == side
    assert met > 400


@pytest.mark.parametrize("name", ["irb2400", "puma560"])
def test_newton_finds_what_the_closed_form_finds(name):
    kinematics, frozen = arm(name)
    by_steps = numeric(kinematics)
    s, compared = np.linspace(0.0, 1.0, 60), 0
    for q0, q1 in zip(postures(kinematics, 30), postures(kinematics, 60)[30:], strict=True):
        q1 = q0 + 0.1 * (q1 - q0)
        p0, p1 = ((kinematics.forward(q) @ TOOL)[:3, 3] for q in (q0, q1))
        p, wrist = p0 + s[:, None] * (p1 - p0), q0[3:] + s[:, None] * (q1[3:] - q0[3:])
        exact = frozen.solve(p, wrist, q0, frozen.side_of(q0))
        if np.isfinite(exact).all() and np.abs(np.diff(exact, axis=0)).max() < 0.1:
            compared += 1
            np.testing.assert_allclose(by_steps.solve(p, wrist, q0, by_steps.side_of(q0)), exact, atol=1e-7)
    assert compared > 20


def test_out_of_reach_is_nan_and_nothing_else():
    kinematics, frozen = arm("irb2400")
    q = np.zeros(6)
    far = np.array([[5.0, 0.0, 1.0]])
    assert np.isnan(frozen.solve(far, q[None, 3:], q, frozen.side_of(q))[0, :3]).all()
    by_steps = numeric(kinematics)
    assert np.isnan(by_steps.solve(far, q[None, 3:], q, None)[0, :3]).all()


def test_turns_go_on_from_the_sample_before():
    kinematics, frozen = arm("irb2400")
    q = np.radians([170.0, 20.0, 10.0, 30.0, 40.0, 50.0])
    q_turned = q + np.array([2.0 * np.pi, 0, 0, 0, 0, 0])
    p = (kinematics.forward(q) @ TOOL)[None, :3, 3]
    assert frozen.solve(p, q[None, 3:], q_turned, frozen.side_of(q))[0, 0] == pytest.approx(q_turned[0])
    angles = np.radians(np.linspace(170.0, 200.0, 40))  # J1 passes half a turn on the way
    path = np.repeat(q[None], 40, axis=0)
    path[:, 0] = angles
    places = (kinematics.forward(path) @ TOOL)[:, :3, 3]
    found = frozen.solve(places, path[:, 3:], path[0], frozen.side_of(q))
    np.testing.assert_allclose(found[:, 0], angles, atol=1e-12)


def test_an_arm_without_three_main_axes_is_refused():
    kinematics, _ = arm("irb2400")
    kinematics.n = 5
    with pytest.raises(ValueError, match="5 axes"):
        FrozenWrist(kinematics, TOOL)


def test_frames_before_and_behind_the_closed_form_count():
    """An arm whose base and flange frames are its own: the closed form is found from its joint lines."""
    spec = load_builtin("irb2400")
    moved = pose_from_xyzrpy((0.1, 0.2, 0.3, 0.2, 0.1, 0.4))
    axes = (replace(spec.axes[0], placement=moved @ spec.axes[0].placement), *spec.axes[1:])
    X_last_flange = spec.X_last_flange @ pose((0.0, 0.01, 0.02))
    kinematics = Kinematics(replace(spec, axes=axes, opw=None, X_last_flange=X_last_flange))
    assert kinematics.closed_form
    frozen = FrozenWrist(kinematics, TOOL)
    for q in postures(kinematics, 50):
        p = (kinematics.forward(q) @ TOOL)[None, :3, 3]
        found = frozen.solve(p, q[None, 3:], q, frozen.side_of(q))[0]
        np.testing.assert_allclose((kinematics.forward(found) @ TOOL)[:3, 3], p[0], atol=1e-11)
