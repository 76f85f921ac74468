"""The plant's model against the controller's: two engines, one robot, 1e-9."""

from collections.abc import Callable
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from robolang.project.builtin import cell_text
from runtime.core.frames import Array, frozen, pose, pose_from_xyzrpy
from runtime.core.tomlfile import Source
from runtime.plant.hand import hand_body
from runtime.plant.mjcf import build_mjcf
from runtime.robot.model.arm_model import ArmModel, spec_rotors
from runtime.robot.model.payload import Payload
from runtime.robot.model.spec import Body
from tests.runtime.from_texts import parse_cell

pytestmark = pytest.mark.physics

CELL = parse_cell(Source("cell.toml", cell_text()))
SPEC = CELL.robot
LOAD = Body(
    mass=2.3,
    cog=frozen([0.01, -0.02, 0.095]),
    inertia=frozen([[4e-3, 2e-4, -1e-4], [2e-4, 5e-3, 3e-4], [-1e-4, 3e-4, 3e-3]]),
)
POSES = np.random.default_rng(560).uniform(SPEC.lower, SPEC.upper, size=(200, SPEC.n))


def arm_model(load: Body | None) -> ArmModel:
    model = ArmModel(SPEC)
    if load is not None:
        model.set_payload(Payload(mass=load.mass, cog=load.cog, inertia=load.inertia))
    return model


def worst(
    text: str, load: Body | None, compare: Callable[..., float], fingers: float | None = None, poses: Array = POSES
) -> float:
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    ours = arm_model(load)
    errors = []
    for q in poses:
        data.qpos[: SPEC.n] = q
        if fingers is not None:
            data.qpos[SPEC.n : SPEC.n + 2] = fingers
        mujoco.mj_forward(model, data)
        errors.append(compare(model, data, ours, q))
    return float(max(errors))


def mass_matrix_error(model: mujoco.MjModel, data: mujoco.MjData, ours: ArmModel, q: Array) -> float:
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    expected = ours.mass_matrix(q) + np.diag(spec_rotors(SPEC))
    return float(np.abs(M[: SPEC.n, : SPEC.n] - expected).max())


def gravity_error(model: mujoco.MjModel, data: mujoco.MjData, ours: ArmModel, q: Array) -> float:
    return float(np.abs(data.qfrc_bias[: SPEC.n] - ours.gravity(q)).max())


def flange_error(model: mujoco.MjModel, data: mujoco.MjData, ours: ArmModel, q: Array) -> float:
    site = data.site("tool")
    return float(np.abs(pose(site.xpos, site.xmat.reshape(3, 3)) - ours.flange(q)).max())


@pytest.mark.parametrize("load", [None, LOAD], ids=["bare", "payload"])
@pytest.mark.parametrize("compare", [mass_matrix_error, gravity_error, flange_error])
def test_bare_arm_agrees_with_pinocchio(compare: Callable[..., float], load: Body | None) -> None:
    assert worst(build_mjcf(SPEC, payload=load), load, compare) < 1e-9


def test_the_comparison_notices_a_gram() -> None:
    light = replace(LOAD, mass=LOAD.mass - 1e-3)
    assert worst(build_mjcf(SPEC, payload=light), LOAD, gravity_error) > 1e-3
    assert worst(build_mjcf(SPEC, payload=light), LOAD, mass_matrix_error) > 1e-6


@pytest.mark.parametrize("opening", [0.0, 0.08])
def test_the_hand_in_the_cell_weighs_what_the_cell_says(opening: float) -> None:
    """Palm and two fingers on slides against one rigid body of the stated mass and centre of gravity."""
    text, body = build_mjcf(SPEC, CELL), hand_body(CELL.hand, opening)
    assert (body.mass, list(body.cog)) == (CELL.hand.mass, list(CELL.hand.cog))
    assert worst(text, body, gravity_error, opening / 2.0) < 1e-9
    assert worst(text, body, mass_matrix_error, opening / 2.0) < 1e-9


def test_a_turned_flange_and_an_odd_hand_agree_too() -> None:
    hand = replace(
        CELL.hand,
        cog=frozen([0.01, -0.02, 0.07]),
        X_flange_tool=frozen(pose_from_xyzrpy([0.01, 0.02, 0.12, 0.3, -0.2, 0.9])),
    )
    text = build_mjcf(SPEC, replace(CELL, hand=hand))
    assert worst(text, hand_body(hand, 0.06), gravity_error, 0.03) < 1e-9
    assert worst(text, hand_body(hand, 0.06), mass_matrix_error, 0.03) < 1e-9


def test_coriolis_torques_agree() -> None:
    model = mujoco.MjModel.from_xml_string(build_mjcf(SPEC, payload=LOAD))
    data, ours = mujoco.MjData(model), arm_model(LOAD)
    speeds = np.random.default_rng(1).uniform(-2.0, 2.0, size=POSES.shape)
    for q, dq in zip(POSES, speeds, strict=True):
        data.qpos[:], data.qvel[:] = q, dq
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.qfrc_bias, ours.torque(q, dq, np.zeros(SPEC.n)), atol=1e-9)
